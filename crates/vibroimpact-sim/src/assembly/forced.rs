//! Free motion of every mode over a panel, its response to unit Legendre forces, and the response of one contact to the force of
//! another, which is a sum over the modes.

use super::excess::Pushed;
use super::system::{Span, System};
use crate::panel::dyadic::Rotation;
use crate::panel::forcing::{ByParts, Compliance, Order, Way, by_quadrature, by_series};
use crate::panel::legendre::{BASIS, Legendre, Matrix, Nodal, Q, add_motion, apply, dot, work_of_unit_forces};
use crate::panel::oscillator::{BodyMode, Propagator, propagate};
use crate::panel::rows::Rows;
use crate::panel::vector::{LANES, sum_over, vectorized};
use std::array;
use std::ops::Range;
use std::sync::OnceLock;

/// Response of one contact's overlap to the force of another.
#[derive(Clone, Copy, Default)]
pub(crate) struct Response {
    /// At the nodes, to nodal forces (m/N).
    pub nodes: Matrix,
    /// At the end, to Legendre forces (m/N), and its rate (m/(N s)).
    pub end: Nodal,
    pub end_rate: Nodal,
}

/// Free motion and forced responses of all modes on a panel.
#[derive(Default)]
pub(crate) struct Forced {
    /// Displacement of free motion at the nodes, from amplitude and from rate, mode by mode.
    pub at_nodes: Vec<(Nodal, Nodal)>,
    /// Amplitude and rate at the end, a row for each unit Legendre force on the modes.
    amplitude: Rows<Q>,
    rate: Rows<Q>,
}

/// Free motion over `h`, from its table if there is one; the bits are the same.
pub(crate) struct Over<'a> {
    pub h: f64,
    pub known: Option<&'a Rotation>,
}

impl Over<'_> {
    /// Without a table.
    pub fn any(h: f64) -> Over<'static> {
        Over { h, known: None }
    }

    #[inline(always)]
    fn of(&self, system: &System, k: usize) -> Propagator {
        self.known.map_or_else(|| propagate(&system.modes[k], self.h), |rotation| rotation.of(k))
    }
}

/// `state[k] -= psi[k] sum_n table[n][k] force[n]`, in one pass.
#[inline(always)]
fn accumulate(state: &mut [f64], psi: &[f64], table: &Rows<Q>, first: usize, force: &Legendre) {
    let n = psi.len();
    let state = &mut state[..n];
    let [t0, t1, t2, t3, t4, t5, t6, t7] = table.part(first, n);
    let [f0, f1, f2, f3, f4, f5, f6, f7] = force.0;
    for k in 0..n {
        let response =
            (t0[k] * f0 + t1[k] * f1 + t2[k] * f2 + t3[k] * f3) + (t4[k] * f4 + t5[k] * f5 + t6[k] * f6 + t7[k] * f7);
        state[k] -= psi[k] * response;
    }
}

/// The modes of a body in order: at most [`LANES`] successive ones that are integrated by parts, or a single one.
fn alike(modes: &[BodyMode], body: Range<usize>, h: f64) -> impl Iterator<Item = (Range<usize>, Way)> {
    let (mut next, end) = (body.start, body.end);
    std::iter::from_fn(move || {
        let first = next;
        let way = Way::of(modes[..end].get(first)?, h);
        next += 1;
        while way == Way::ByParts && next < end.min(first + LANES) && Way::of(&modes[next], h) == way {
            next += 1;
        }
        Some((first..next, way))
    })
}

impl Forced {
    /// Every mode on a panel, with responses at the nodes summed over the modes with these weights, gathered in one
    /// pass; `half` is free motion over half of it. Rigid modes take no part in the responses.
    pub fn new(system: &System, panel: &Over, half: &Over, weights: &[Vec<f64>]) -> (Forced, Vec<[Nodal; Q]>) {
        let (n, h) = (system.modes.len(), panel.h);
        let mut forced =
            Forced { at_nodes: vec![([0.0; Q], [0.0; Q]); n], amplitude: Rows::new(n), rate: Rows::new(n) };
        let mut sums = Sums::new(system, h, (weights, Order::Displacement));
        vectorized(
            #[inline(always)]
            || {
                for body in &system.bodies {
                    let mut terms = 2;
                    for (modes, way) in alike(&system.modes, body.clone(), h) {
                        let first = modes.start;
                        let mode = &system.modes[first];
                        let part = match way {
                            Way::ByParts => {
                                let by_parts = lanes_by_parts(system, modes.clone(), panel);
                                sums.add_by_parts(modes.clone(), &by_parts);
                                let (displacement, velocity) = by_parts.end();
                                forced.amplitude.set_lanes(first, modes.len(), &displacement);
                                forced.rate.set_lanes(first, modes.len(), &velocity);
                                for (l, at_nodes) in forced.at_nodes[modes].iter_mut().enumerate() {
                                    *at_nodes = by_parts.at_nodes(l);
                                }
                                continue;
                            }
                            Way::Series => by_series(mode, h, &half.of(system, first), &mut terms),
                            Way::Quadrature => by_quadrature(mode, h),
                        };
                        sums.add_one(first, way);
                        forced.at_nodes[first] = part.at_nodes;
                        forced.amplitude.set(first, part.end.0);
                        forced.rate.set(first, part.end.1);
                    }
                    sums.end_body();
                }
            },
        );
        (forced, sums.at_nodes())
    }

    /// Response of the elastic modes with these weights at the end.
    pub fn end(&self, system: &System, weights: &[f64]) -> (Nodal, Nodal) {
        let elastic = |(weight, mode): (&f64, &BodyMode)| if mode.is_rigid() { 0.0 } else { -weight };
        let weights: Vec<f64> = weights.iter().zip(&system.modes).map(elastic).collect();
        let rows = |table: &Rows<Q>| {
            let rows = table.part(0, weights.len());
            vectorized(
                #[inline(always)]
                || {
                    let mut sums = [0.0; Q];
                    for n in 0..Q {
                        [sums[n]] = sum_over(
                            [&weights, rows[n]],
                            #[inline(always)]
                            |[weight, response]| [weight * response],
                        );
                    }
                    sums
                },
            )
        };
        (rows(&self.amplitude), rows(&self.rate))
    }

    /// Motion of a mode at the end under unit Legendre forces.
    #[inline(always)]
    pub fn pushed(&self, k: usize) -> Pushed {
        Pushed { amplitude: self.amplitude.at(k), rate: self.rate.at(k) }
    }

    /// Change of `sum_k psi_k a_k` by free motion at the nodes.
    pub fn free_at_nodes(&self, spans: &[Span], amplitude: &[f64], rate: &[f64]) -> Nodal {
        vectorized(
            #[inline(always)]
            || {
                let mut moved = [0.0; Q];
                for Span { modes, psi } in spans {
                    let motion = (&amplitude[modes.clone()], &rate[modes.clone()]);
                    add_motion(&mut moved, &self.at_nodes[modes.clone()], psi, motion);
                }
                moved
            },
        )
    }

    /// [`Forced::free_at_nodes`], and the rate of the sum there: free motion from a rate and an acceleration.
    pub fn free_with_rates(&self, system: &System, spans: &[Span], amplitude: &[f64], rate: &[f64]) -> (Nodal, Nodal) {
        vectorized(
            #[inline(always)]
            || {
                let (mut moved, mut start, mut sped) = ([0.0; Q], 0.0, [0.0; Q]);
                for Span { modes, psi } in spans {
                    let n = psi.len();
                    let [a, b, drag, square] =
                        [amplitude, rate, &system.drag, &system.square].map(|row| &row[modes.clone()][..n]);
                    let at_nodes = &self.at_nodes[modes.clone()][..n];
                    for k in 0..n {
                        let (a, b) = (psi[k] * a[k], psi[k] * b[k]);
                        let bend = -drag[k] * b - square[k] * a;
                        let (from_a, from_b) = &at_nodes[k];
                        start += b;
                        for i in 0..Q {
                            moved[i] += from_a[i] * a + from_b[i] * b;
                            sped[i] += from_a[i] * b + from_b[i] * bend;
                        }
                    }
                }
                (moved, sped.map(|sped| start + sped))
            },
        )
    }

    /// Adds the effect of a contact force on the modes within a panel.
    pub fn push(&self, spans: &[Span], force: &Legendre, amplitude: &mut [f64], rate: &mut [f64]) {
        vectorized(
            #[inline(always)]
            || {
                for Span { modes, psi } in spans {
                    accumulate(&mut amplitude[modes.clone()], psi, &self.amplitude, modes.start, force);
                    accumulate(&mut rate[modes.clone()], psi, &self.rate, modes.start, force);
                }
            },
        );
    }
}

/// Responses at the nodes summed over the modes with other weights, of a panel again, or their rates: the responses are to the last bit
/// those of [`Forced::new`].
pub(crate) fn again(
    system: &System,
    panel: &Over,
    sums: (&[Vec<f64>], Order),
    by_parts: &OnceLock<Vec<ByParts>>,
) -> Vec<[Nodal; Q]> {
    let h = panel.h;
    let groups = || system.bodies.iter().flat_map(|body| alike(&system.modes, body.clone(), h));
    let new = |(modes, _)| {
        vectorized(
            #[inline(always)]
            || lanes_by_parts(system, modes, panel),
        )
    };
    let by_parts = by_parts.get_or_init(|| groups().filter(|(_, way)| *way == Way::ByParts).map(new).collect());
    let mut by_parts = by_parts.iter();
    let mut sums = Sums::new(system, h, sums);
    for body in &system.bodies {
        for (modes, way) in alike(&system.modes, body.clone(), h) {
            if way != Way::ByParts {
                sums.add_one(modes.start, way);
            } else if let Some(by_parts) = by_parts.next() {
                vectorized(
                    #[inline(always)]
                    || sums.add_by_parts(modes, by_parts),
                );
            }
        }
        sums.end_body();
    }
    sums.at_nodes()
}

/// At most [`LANES`] modes by parts; the last ones are padded by modes that get no weight.
#[inline(always)]
fn lanes_by_parts(system: &System, modes: Range<usize>, panel: &Over) -> ByParts {
    let mut padded = [system.modes[modes.start]; LANES];
    padded[..modes.len()].copy_from_slice(&system.modes[modes.clone()]);
    let mut over_panel = [panel.of(system, modes.start); LANES];
    for l in 1..modes.len() {
        over_panel[l] = panel.of(system, modes.start + l);
    }
    ByParts::new(&padded, &over_panel, panel.h)
}

/// Partial sums of responses over the modes, for each list of weights.
struct Sums<'a> {
    system: &'a System,
    h: f64,
    weights: &'a [Vec<f64>],
    compliances: Vec<Compliance>,
    /// The first slow modes that are not added yet.
    waiting: [usize; LANES],
    count: usize,
}

impl Sums<'_> {
    fn new<'a>(system: &'a System, h: f64, (weights, order): (&'a [Vec<f64>], Order)) -> Sums<'a> {
        let compliances = weights.iter().map(|_| Compliance::new(order)).collect();
        Sums { system, h, weights, compliances, waiting: [0; LANES], count: 0 }
    }

    /// Adds a mode that is not integrated by parts; rigid ones take no part.
    fn add_one(&mut self, k: usize, way: Way) {
        let mode = &self.system.modes[k];
        if mode.is_rigid() {
            return;
        }
        if way == Way::Series {
            self.waiting[self.count] = k;
            self.count += 1;
            if self.count == LANES {
                self.add_waiting();
            }
            return;
        }
        for (compliance, weights) in self.compliances.iter_mut().zip(self.weights).filter(|(_, all)| all[k] != 0.0) {
            compliance.add_by_quadrature(mode, weights[k], self.h);
        }
    }

    /// Adds at most [`LANES`] modes that are integrated by parts.
    #[inline(always)]
    fn add_by_parts(&mut self, modes: Range<usize>, by_parts: &ByParts) {
        for (compliance, all) in self.compliances.iter_mut().zip(self.weights) {
            let mut weights = [0.0; LANES];
            weights[..modes.len()].copy_from_slice(&all[modes.clone()]);
            compliance.add_by_parts(by_parts, &weights);
        }
    }

    fn add_waiting(&mut self) {
        let (count, h) = (std::mem::take(&mut self.count), self.h);
        // the last modes of a body are padded by modes without weight
        let modes = array::from_fn(|l| self.system.modes[self.waiting[l.min(count - 1)]]);
        for (compliance, weights) in self.compliances.iter_mut().zip(self.weights) {
            let weights = array::from_fn(|l| if l < count { weights[self.waiting[l]] } else { 0.0 });
            if weights != [0.0; LANES] {
                vectorized(
                    #[inline(always)]
                    || compliance.add_slow(&modes, &weights, h),
                );
            }
        }
    }

    fn end_body(&mut self) {
        if self.count > 0 {
            self.add_waiting();
        }
        self.compliances.iter_mut().for_each(Compliance::end_body);
    }

    fn at_nodes(&self) -> Vec<[Nodal; Q]> {
        self.compliances.iter().map(|compliance| compliance.at_nodes(self.h)).collect()
    }
}

/// Rates at the nodes summed over the elastic modes with these weights, on a panel of `h`.
pub(crate) fn rates_at_nodes(system: &System, h: f64, weights: &[Vec<f64>]) -> Vec<Matrix> {
    again(system, &Over::any(h), (weights, Order::Velocity), &OnceLock::new())
}

/// Responses at the nodes, or their rates, with those of rigid modes of this inverse mass (1/kg) added, on a panel of `h`.
pub(crate) fn with_rigid_modes(mut nodes: Matrix, order: Order, inverse_mass: f64, h: f64) -> Matrix {
    let (moved, integrals) = match order {
        Order::Displacement => (inverse_mass * h * h, &BASIS.power[1]),
        Order::Velocity => (inverse_mass * h, &BASIS.power[0]),
    };
    for (row, integrals) in nodes.iter_mut().zip(integrals) {
        row.iter_mut().zip(integrals).for_each(|(value, integral)| *value -= moved * integral);
    }
    nodes
}

impl Response {
    /// With that of rigid modes of this inverse mass (1/kg) added, on a panel of `h`.
    pub fn with_rigid(&self, inverse_mass: f64, h: f64) -> Response {
        let Response { nodes, mut end, mut end_rate } = *self;
        let nodes = with_rigid_modes(nodes, Order::Displacement, inverse_mass, h);
        let moved = inverse_mass * h * h;
        // int (1-s) P_n ds is 1/2, -1/6 and 0 from then on
        end[0] -= moved / 2.0;
        end[1] += moved / 6.0;
        end_rate[0] -= inverse_mass * h;
        Response { nodes, end, end_rate }
    }

    /// Work of unit Legendre forces of one contact over the motion by those of the other, by quadrature: `[m][n]` of `P_n` over the
    /// motion by `P_m`.
    pub fn works(&self) -> Matrix {
        array::from_fn(|m| work_of_unit_forces(&apply(&self.nodes, &BASIS.derivatives[0][m]), self.end[m]))
    }

    /// Overlap and its rate at the end of a panel, to a force.
    pub fn at_end(&self, Legendre(force): &Legendre) -> (f64, f64) {
        (dot(&self.end, force), dot(&self.end_rate, force))
    }
}
