//! Derivatives of the modes and of the forces on one panel, without shifts of events.

use super::expansion::Expansion;
use super::walk::{LAW_STEP, Moved, Walk, numbers, shifted, size_of};
use crate::assembly::collocate::Mobility;
use crate::assembly::dense::{Acting, Stretch};
use crate::assembly::forced::Forced;
use crate::assembly::stencil::Stencil;
use crate::assembly::system::Span;
use crate::panel::ends::Ends;
use crate::panel::legendre::{BASIS, Legendre, Matrix, Nodal, Q, add, apply, dot, slopes};
use crate::panel::vector::vectorized;
use contact_models::{Branch, ContactLaw, Force};
use std::array;

/// Wide and near steps of a number of a branch relative to its distance from the anchor, and the smallest steps relative to its size.
const ANCHOR_STEPS: [f64; 2] = [0.01, 5e-4];
const LEAST_LAW_STEPS: [f64; 2] = [1e-9, 1e-12];
/// Rounding of a force relative to itself, at most.
const LAW_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The closed contacts of a panel, as the record has them.
pub(super) struct Solved {
    pub contact: usize,
    pub branch: Branch,
    /// How the law's force begins and ends.
    pub ends: Ends,
    /// The polynomial that moves the modes; at the nodes that force, `F'`, `t F` and `t F'`.
    pub force: Legendre,
    pub nodal: Nodal,
    pub force_rate: Nodal,
    pub timed: Nodal,
    pub timed_rate: Nodal,
    /// Whether the force may depend on the rate of compression.
    pub by_rate: bool,
    /// Rate of compression at the start; compression and rate at the nodes, with the law there.
    pub start_rate: f64,
    pub compression: Nodal,
    pub rate: Nodal,
    pub law: [Force; Q],
    /// State of all modes at the end of the panel for unit weights: under `F`, `t F` and `t F' + 2 F`.
    pub driven: [Motion; 3],
}

/// Amplitudes and rates of all modes.
pub(super) type Motion = [Vec<f64>; 2];

/// A panel of the record, from one stretch to the next, with the data for all derivatives.
pub(super) struct Passage<'a> {
    pub from: &'a Stretch,
    /// Amplitudes and rates at its end.
    pub to: [&'a [f64]; 2],
    pub expansion: &'a Expansion,
    pub solved: &'a [Solved],
    /// Accelerations of all modes at its start and at its end.
    pub bends: [Vec<f64>; 2],
}

/// Derivative of the overlap of a contact by free motion: at the start and from there to the nodes, and the part multiplied by the
/// time, with their rates where they are asked for.
#[derive(Default)]
struct Seen {
    start: f64,
    moved: Nodal,
    rate: Nodal,
    timed_start: f64,
    timed: Nodal,
    timed_rate: Nodal,
}

fn times(one: &Nodal, other: &Nodal) -> Nodal {
    array::from_fn(|i| one[i] * other[i])
}

impl Walk<'_> {
    pub fn solved(&self, stretch: &Stretch, expansion: &Expansion) -> Vec<Solved> {
        let (h, n) = (stretch.length_s, stretch.forces.len());
        let place = BASIS.nodes.map(|s| s * h);
        let of = |(p, Acting { contact: c, force, ends, by_rate }): (usize, &Acting)| {
            let (link, followed) = (&self.system.links[*c], &self.contacts[*c]);
            let branch = stretch.contacts[*c].branch?;
            let (spans, amplitude, rate) = (&link.spans, &stretch.amplitude, &stretch.rate);
            let (mut compression, mut rate) = match by_rate {
                true => expansion.forced.free_with_rates(self.system, spans, amplitude, rate),
                false => (expansion.forced.free_at_nodes(spans, amplitude, rate), [0.0; Q]),
            };
            for i in 0..Q {
                let (moved, faster) = self.loads.moved(*c, stretch.start_s, BASIS.nodes[i] * h);
                compression[i] += moved;
                rate[i] += faster;
            }
            for (q, other) in stretch.forces.iter().enumerate() {
                let (Mobility { nodes, rates }, nodal) = (expansion.mobility(p * n + q), other.force.nodal());
                add(&mut compression, 1.0, &apply(nodes, &nodal));
                if let Some(rates) = rates {
                    add(&mut rate, 1.0, &apply(rates, &nodal));
                }
            }
            if !by_rate {
                // the value at the start is added later, since slopes would magnify its rounding on short panels
                rate = slopes(0.0, &compression, h);
            }
            compression.iter_mut().for_each(|value| *value += followed.overlap);
            let law = self.posed.laws[*c];
            let nodal = force.nodal();
            let force_rate = force.derivative().nodal().map(|slope| slope / h);
            let (timed, timed_rate) = (times(&place, &nodal), times(&place, &force_rate));
            let driven = |nodal: &Nodal| {
                let [mut amplitude, mut rate] = [(); 2].map(|()| vec![0.0; self.system.modes.len()]);
                let force = Legendre::through(nodal);
                expansion.forced.push(&self.units[*c], &force, &mut amplitude, &mut rate);
                [amplitude, rate]
            };
            let driven_by_timed = |nodal: &Nodal| if self.modes_move { driven(nodal) } else { Motion::default() };
            let again: Nodal = array::from_fn(|i| timed_rate[i] + 2.0 * nodal[i]);
            Some(Solved {
                contact: *c,
                branch,
                ends: *ends,
                force: *force,
                driven: [driven(&nodal), driven_by_timed(&timed), driven_by_timed(&again)],
                timed,
                timed_rate,
                nodal,
                force_rate,
                by_rate: *by_rate,
                start_rate: followed.rate,
                law: array::from_fn(|i| law.force(&branch, compression[i], rate[i])),
                compression,
                rate,
            })
        };
        stretch.forces.iter().enumerate().filter_map(of).collect()
    }

    /// Acceleration of the relative motion of all modes in a state, under these forces at a point of the panel.
    pub fn acceleration(&self, time_s: f64, [a, b]: [&[f64]; 2], solved: &[Solved], place: f64) -> Vec<f64> {
        let system = self.system;
        let mut bend: Vec<f64> =
            (0..system.modes.len()).map(|k| -system.drag[k] * b[k] - system.square[k] * a[k]).collect();
        self.loads.rigid.iter().for_each(|&k| bend[k] += self.loads.line(k, time_s).0);
        for solved in solved {
            let force = solved.force.at(place);
            for span in &system.links[solved.contact].spans {
                span.modes.clone().zip(&span.psi).for_each(|(k, psi)| bend[k] -= psi * force);
            }
        }
        bend
    }

    /// A panel of unchanged length, into memory that is used again.
    pub fn moved(&self, d: usize, passage: &Passage, into: &mut Moved) {
        let (system, change, tangent) = (self.system, &self.changes[d], &self.tangents[d]);
        let Passage { from, expansion, solved, .. } = passage;
        let (h, n) = (from.length_s, solved.len());
        let (a, b) = (from.amplitude.as_slice(), from.rate.as_slice());
        let modes_move = change.moves_modes;
        let (fade, stretches) = (&change.fade, &change.stretch);
        let Moved { amplitude, rate, law, force, overlap } = into;
        // y and y' at the start
        amplitude.clone_from(&tangent.amplitude);
        rate.clone_from(&tangent.rate);
        law.clear();
        force.clear();
        overlap.clear();
        if modes_move {
            vectorized(
                #[inline(always)]
                || {
                    let held = fade.iter().zip(a).zip(stretches.iter().zip(b));
                    for (rate, ((fade, a), (stretch, b))) in rate.iter_mut().zip(held) {
                        *rate += fade * a - stretch * b;
                    }
                },
            );
        }
        for (p, own) in solved.iter().enumerate() {
            let c = own.contact;
            let Seen { start, moved: mut found, rate: mut found_rate, timed_start, mut timed, mut timed_rate } =
                self.seen(d, own, &expansion.forced, [amplitude, rate], [a, b, &passage.bends[0]]);
            let start = start + self.beyond(d, c, from.start_s)[0];
            timed.iter_mut().for_each(|value| *value += timed_start);
            for (q, other) in solved.iter().enumerate() {
                let places = expansion.changed[(d * n + p) * n + q];
                let respond = |responses: &[Matrix], found: &mut Nodal, timed: &mut Nodal| {
                    let [of_force, of_timed, of_timed_rate] = places.map(|place| responses.get(place?));
                    if let Some(response) = of_force {
                        add(found, 1.0, &apply(response, &other.nodal));
                    }
                    if let Some(response) = of_timed {
                        add(found, 1.0, &apply(response, &other.timed));
                        add(timed, -1.0, &apply(response, &other.nodal));
                    }
                    if let Some(response) = of_timed_rate {
                        add(found, -1.0, &apply(response, &other.timed_rate));
                        add(timed, 1.0, &apply(response, &other.force_rate));
                    }
                };
                respond(&expansion.responses, &mut found, &mut timed);
                if own.by_rate {
                    respond(&expansion.rates, &mut found_rate, &mut timed_rate);
                }
            }
            for i in 0..Q {
                let s = BASIS.nodes[i] * h;
                found[i] += s * timed[i];
                found_rate[i] += timed[i] + s * timed_rate[i];
            }
            for (k, by_zeta, mode) in expansion.critical(change) {
                let weight = by_zeta * system.links[c].weight(k);
                add(&mut found, weight * a[k], &mode.at_nodes.0);
                add(&mut found, weight * b[k], &mode.at_nodes.1);
                add(&mut found_rate, weight * a[k], &mode.rates.0);
                add(&mut found_rate, weight * b[k], &mode.rates.1);
            }
            for (i, s) in BASIS.nodes.iter().enumerate().filter(|_| !self.loads.is_empty()) {
                let (moved, faster) = self.loads.moved_later(c, from.start_s, s * h);
                found[i] += tangent.time_s * moved;
                found_rate[i] += tangent.time_s * faster;
            }
            if let Some(loads) = &self.load_changes[d] {
                for (i, s) in BASIS.nodes.iter().enumerate() {
                    let (moved, faster) = loads.moved(c, from.start_s, s * h);
                    found[i] += moved;
                    found_rate[i] += faster;
                }
            }
            found.iter_mut().for_each(|value| *value += start);
            let by_law = self.force_change(d, own);
            law.push(array::from_fn(|i| {
                let by_motion = own.law[i].per_compression_n_m * found[i] + own.law[i].per_rate_n_s_m * found_rate[i];
                by_motion + by_law[i]
            }));
            overlap.push(found);
        }
        if n > 0 {
            self.blocks.solve(law);
        }
        force.extend(solved.iter().zip(&*law).map(|(own, law)| own.ends.acting(law)));
        for (p, found) in overlap.iter_mut().enumerate() {
            for (q, force) in force.iter().enumerate() {
                add(found, 1.0, &apply(&expansion.responses[p * n + q], force));
            }
        }
        // y at the end
        expansion.rotation.apply(amplitude, rate);
        for (own, force) in solved.iter().zip(&*force) {
            let c = own.contact;
            let link = &system.links[c];
            expansion.forced.push(&link.spans, &Legendre::through(force), amplitude, rate);
            for (Span { modes, psi }, Span { psi: by, .. }) in link.spans.iter().zip(&change.psi[c]) {
                for (order, moved) in [&mut *amplitude, &mut *rate].into_iter().enumerate() {
                    let driven = own.driven.each_ref().map(|motion| motion[order].get(modes.clone()).unwrap_or(&[]));
                    let moved = &mut moved[modes.clone()];
                    let factors = modes_move.then(|| [&change.fade, &change.stretch].map(|row| &row[modes.clone()]));
                    add_driven(moved, (psi, by), factors, driven);
                }
            }
        }
        let rigid = (0..a.len()).filter(|&k| system.modes[k].is_rigid());
        if !self.loads.is_empty() || self.load_changes[d].is_some() {
            for k in rigid {
                let changes = self.load_changes[d].as_ref();
                let (push, slope) = changes.map_or((0.0, 0.0), |loads| loads.line(k, system, from.start_s));
                let push = push + tangent.time_s * self.loads.line(k, from.start_s).1;
                amplitude[k] += h * h * (0.5 * push + h * slope / 6.0);
                rate[k] += h * (push + 0.5 * h * slope);
            }
        }
        if modes_move {
            let ([a, b], bend) = (passage.to, &passage.bends[1]);
            vectorized(
                #[inline(always)]
                || {
                    let motion = a.iter().zip(b).zip(bend).zip(fade.iter().zip(stretches));
                    for ((amplitude, rate), (((a, b), bend), (fade, stretch))) in
                        amplitude.iter_mut().zip(rate.iter_mut()).zip(motion)
                    {
                        let moving = stretch * b - fade * a;
                        *amplitude += h * moving;
                        *rate += moving + h * (stretch * bend - fade * b);
                    }
                },
            );
        }
        for (k, by_zeta, mode) in expansion.critical(change) {
            let [mut by_mode, mut by_mode_rate] = mode.free.map(|[by_a, by_b]| by_a * a[k] + by_b * b[k]);
            for own in solved.iter() {
                let psi = system.links[own.contact].weight(k);
                by_mode -= psi * dot(&mode.end.0, &own.force.0);
                by_mode_rate -= psi * dot(&mode.end.1, &own.force.0);
            }
            amplitude[k] += by_zeta * by_mode;
            rate[k] += by_zeta * by_mode_rate;
        }
    }

    /// Derivative of the overlap of a contact by free motion from `y` and from the state, in one pass over the modes.
    fn seen(&self, d: usize, own: &Solved, forced: &Forced, y: [&[f64]; 2], [a, b, bend]: [&[f64]; 3]) -> Seen {
        let (system, change) = (self.system, &self.changes[d]);
        let mut seen = Seen::default();
        let spans = system.links[own.contact].spans.iter().zip(&change.psi[own.contact]);
        for (Span { modes, psi }, Span { psi: by, .. }) in spans {
            let at_nodes = &forced.at_nodes[modes.clone()];
            let [drag, square, ya, yb, a, b, bend, fade, stretch] =
                [&system.drag, &system.square, y[0], y[1], a, b, bend, &change.fade, &change.stretch]
                    .map(|values| values.get(modes.clone()).unwrap_or(&[]));
            let moves = |[psi, by, ya, yb, a, b]: [f64; 6]| (psi * ya + by * a, psi * yb + by * b);
            let rows = [psi, by, ya, yb, a, b];
            let (start, moved) = swept(at_nodes, rows, moves);
            seen.start += start;
            add(&mut seen.moved, 1.0, &moved);
            if own.by_rate {
                add(&mut seen.rate, 1.0, &swept_rates(at_nodes, rows, moves, [drag, square]));
            }
            if change.moves_modes {
                let moves = |[psi, fade, stretch, a, b, bend]: [f64; 6]| {
                    (psi * (stretch * b - fade * a), psi * (stretch * bend - fade * b))
                };
                let rows = [psi, fade, stretch, a, b, bend];
                let (start, timed) = swept(at_nodes, rows, moves);
                seen.timed_start += start;
                add(&mut seen.timed, 1.0, &timed);
                if own.by_rate {
                    add(&mut seen.timed_rate, 1.0, &swept_rates(at_nodes, rows, moves, [drag, square]));
                }
            }
        }
        seen
    }

    /// Change of a contact's force at the nodes where the overlap does not change: by its law and its branch.
    fn force_change(&self, d: usize, own: &Solved) -> Nodal {
        let (change, c) = (&self.changes[d], own.contact);
        let mut found = [0.0; Q];
        let at = |law: &dyn ContactLaw, branch: &Branch, i: usize| {
            law.force(branch, own.compression[i], own.rate[i]).force_n
        };
        if let Some(laws) = &change.laws {
            for i in 0..Q {
                found[i] += change.stencil.slope(laws[c].map(|law| at(law, &own.branch, i)));
            }
        }
        let law = self.posed.laws[c];
        for (which, by) in self.tangents[d].contacts[c].branch.iter().enumerate().filter(|(_, by)| **by != 0.0) {
            let size = size_of(&own.branch, which, &self.contacts[c]);
            let value = numbers(own.branch.anchor_m, own.branch.internal)[which];
            for i in 0..Q {
                // a law may have a kink at its anchor, which the neighbouring values must not cross; and its force may depend on the
                // distance of another number from the anchor
                let other = if which == 0 { own.compression[i] } else { value };
                let apart = (other - own.branch.anchor_m).abs();
                let slope = |step: f64| {
                    let stencil = Stencil::around(value, step);
                    let forces = stencil.offsets.map(|offset| at(law, &shifted(&own.branch, which, offset), i));
                    let largest = forces.iter().fold(0.0f64, |most, force| most.max(force.abs()));
                    (stencil.slope(forces), LAW_ROUNDING * largest * stencil.magnification())
                };
                let [wide, near] =
                    array::from_fn(|k| (ANCHOR_STEPS[k] * apart).clamp(LEAST_LAW_STEPS[k] * size, LAW_STEP * size));
                let by_number = if near == wide {
                    slope(wide).0
                } else {
                    // rounding disturbs the wider step less, where the law is smooth over it
                    let ((wide, _), (near, rounding)) = (slope(wide), slope(near));
                    if (near - wide).abs() <= rounding { wide } else { near }
                };
                found[i] += by * by_number;
            }
        }
        found
    }

    /// Derivative of the state at the end of a panel with respect to its length. The nodes move with the end. The law's force there
    /// changes by `f = F_xi (s xi' + R g) + ..`, and the polynomial that moves the modes by `g = T f - s F'` at unchanged times.
    pub fn slide(&self, passage: &Passage) -> Moved {
        let Passage { from, to, expansion, solved, bends } = passage;
        let (h, n) = (from.length_s, solved.len());
        let [mut amplitude, mut rate] = [(); 2].map(|()| vec![0.0; to[0].len()]);
        let carried: Vec<Nodal> = solved.iter().map(|own| times(&BASIS.nodes, &own.force_rate)).collect();
        let respond = |responses: &[Matrix], p: usize, force: &[Nodal]| {
            let mut moved = [0.0; Q];
            for (response, force) in responses.iter().skip(p * n).zip(force) {
                add(&mut moved, 1.0, &apply(response, force));
            }
            moved
        };
        let by_law = |(p, own): (usize, &Solved)| -> Nodal {
            let [moved, slope] = [&expansion.responses, &expansion.rates].map(|table| respond(table, p, &carried));
            let bend = slopes(own.start_rate, &own.rate, h);
            array::from_fn(|i| {
                let (law, s) = (&own.law[i], BASIS.nodes[i]);
                law.per_compression_n_m * (s * own.rate[i] - moved[i]) + law.per_rate_n_s_m * (s * bend[i] - slope[i])
            })
        };
        let mut law: Vec<Nodal> = solved.iter().enumerate().map(by_law).collect();
        if n > 0 {
            self.blocks.solve(&mut law);
        }
        let acting = |((own, law), carried): ((&Solved, &Nodal), &Nodal)| -> Nodal {
            let acting = own.ends.acting(law);
            array::from_fn(|i| acting[i] - carried[i])
        };
        let force: Vec<Nodal> = solved.iter().zip(&law).zip(&carried).map(acting).collect();
        let overlap = (0..n).map(|p| respond(&expansion.responses, p, &force)).collect();
        for (own, force) in solved.iter().zip(&force) {
            let spans = &self.system.links[own.contact].spans;
            expansion.forced.push(spans, &Legendre::through(force), &mut amplitude, &mut rate);
        }
        for k in 0..amplitude.len() {
            amplitude[k] += to[1][k];
            rate[k] += bends[1][k];
        }
        Moved { amplitude, rate, law, force, overlap }
    }
}

/// `moved -= by F + c_1 psi (t F) - c_2 psi (t F' + 2 F)`, where each force stands for the motion of the modes under it. The
/// last two terms are for parameters that change frequencies or dampings.
fn add_driven(moved: &mut [f64], (psi, by): (&[f64], &[f64]), factors: Option<[&[f64]; 2]>, driven: [&[f64]; 3]) {
    let n = moved.len();
    let [by_force, by_timed, by_again] = driven;
    vectorized(
        #[inline(always)]
        || {
            let (by, by_force) = (&by[..n], &by_force[..n]);
            (0..n).for_each(|k| moved[k] -= by[k] * by_force[k]);
            if let Some([fade, stretch]) = factors {
                let [psi, fade, stretch, by_timed, by_again] =
                    [psi, fade, stretch, by_timed, by_again].map(|row| &row[..n]);
                (0..n).for_each(|k| moved[k] -= psi[k] * (fade[k] * by_timed[k] - stretch[k] * by_again[k]));
            }
        },
    );
}

/// Displacement of the sum of all modes by free motion at the nodes, and that sum at the start. The amplitude and the rate of
/// each mode are functions of its numbers.
fn swept<const N: usize>(
    at_nodes: &[(Nodal, Nodal)],
    rows: [&[f64]; N],
    motion: impl Fn([f64; N]) -> (f64, f64),
) -> (f64, Nodal) {
    vectorized(
        #[inline(always)]
        || {
            let n = at_nodes.len();
            let rows = rows.map(|row| &row[..n]);
            let (mut start, mut moved) = (0.0, [0.0; Q]);
            for k in 0..n {
                let (a, b) = motion(rows.map(|row| row[k]));
                let (from_a, from_b) = &at_nodes[k];
                start += a;
                for i in 0..Q {
                    moved[i] += from_a[i] * a + from_b[i] * b;
                }
            }
            (start, moved)
        },
    )
}

/// The rate of this sum at the nodes: free motion from the rates and accelerations of the modes at the start.
fn swept_rates(
    at_nodes: &[(Nodal, Nodal)],
    [one, two, three, four, five, six]: [&[f64]; 6],
    motion: impl Fn([f64; 6]) -> (f64, f64),
    [drag, square]: [&[f64]; 2],
) -> Nodal {
    let rows = [one, two, three, four, five, six, drag, square];
    let (start, moved) = swept(at_nodes, rows, |[one, two, three, four, five, six, drag, square]| {
        let (a, b) = motion([one, two, three, four, five, six]);
        (b, -drag * b - square * a)
    });
    moved.map(|moved| start + moved)
}
