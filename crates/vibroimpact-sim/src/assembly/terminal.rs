//! Panels of any length, for the step that ends at an event.
//!
//! Such a panel is shorter than a period of every mode and load, so free motion and responses are Taylor series. Their
//! coefficients at the contacts do not depend on the trial length.

use super::collocate::{Collocated, Mobility, Newton, Unknown, collocate};
use super::load::Loads;
use super::solution::Counts;
use super::system::{Link, Span, System};
use super::tables::Tables;
use crate::panel::legendre::{BASIS, Legendre, Matrix, Nodal, Q, RECIPROCAL, TAYLOR, apply, dot, leave_out_infinite};
use crate::panel::vector::{LANES, vectorized};

/// The series are used while the fastest motion turns by at most this many radians.
pub(crate) const REACH: f64 = 2.8;

/// A shorter reach, as a share of the longest. Half of the powers suffice within it.
pub(crate) const SHORT: f64 = 0.25;
/// The power [`TAYLOR`] of this frequency (rad/s) is well within the range of numbers. Faster vibrations have the shorter reach.
const FASTEST: f64 = 1e10;

pub(crate) type Series = [f64; TAYLOR];

/// Longest time (s) for which the series of a motion hold whose fastest vibration has this frequency.
pub(crate) fn reach_s(fastest_rad_s: f64) -> f64 {
    let reach = if fastest_rad_s <= FASTEST { REACH } else { SHORT * REACH };
    if fastest_rad_s > 0.0 { reach / fastest_rad_s } else { f64::INFINITY }
}

/// A terminal panel whose length is not known yet: the state of some contacts at its start.
pub(crate) struct TerminalPanel {
    /// Closed contacts, then open ones that are watched.
    pub contacts: Vec<usize>,
    pub closed: usize,
    reach: f64,
    /// `g^(p)/p!` of the free motion of each contact's overlap.
    pub free: Vec<Series>,
    /// Derivatives of the responses, `[c * closed + c']`; zero where no body is shared.
    kernels: Vec<Kernel>,
}

/// Derivatives of a response, of which those from `powers` on are zero.
struct Kernel {
    derivatives: Series,
    powers: usize,
}

/// A solved terminal panel.
#[derive(Debug)]
pub(crate) struct Solved {
    pub length: f64,
    /// Of the closed contacts: values at the nodes, and the force.
    pub collocated: Vec<Collocated>,
    pub force: Vec<Legendre>,
    moments: Vec<Series>,
    /// Increase of the overlap of every contact of the panel from the start to the nodes.
    pub moved: Vec<Nodal>,
    /// Overlap and its first two derivatives at the end.
    pub end: Vec<[f64; 3]>,
}

impl TerminalPanel {
    /// `overlaps` are those of the closed contacts now; the panel will be no longer than `reach` (s).
    pub fn new(
        system: &System,
        tables: &Tables,
        loads: &Loads,
        (contacts, overlaps, reach): (Vec<usize>, &[f64], f64),
        moment: (f64, &[f64], &[f64]),
    ) -> TerminalPanel {
        let closed = contacts.len();
        let mut panel = TerminalPanel { contacts, closed, reach, free: Vec::new(), kernels: Vec::new() };
        for (i, overlap) in overlaps.iter().enumerate() {
            panel.expand(system, tables, loads, (panel.contacts[i], *overlap), moment);
        }
        panel
    }

    /// Adds an open contact with its overlap now.
    pub fn add(
        &mut self,
        system: &System,
        tables: &Tables,
        loads: &Loads,
        (c, overlap): (usize, f64),
        moment: (f64, &[f64], &[f64]),
    ) {
        self.contacts.push(c);
        self.expand(system, tables, loads, (c, overlap), moment);
    }

    fn expand(
        &mut self,
        system: &System,
        tables: &Tables,
        loads: &Loads,
        (c, overlap): (usize, f64),
        moment: (f64, &[f64], &[f64]),
    ) {
        let mut series = series_of(system, loads, c, moment, self.reach);
        series[0] = overlap;
        self.free.push(series);
        for other in &self.contacts[..self.closed] {
            let derivatives = tables.kernel(system, c, *other);
            self.kernels.push(Kernel { derivatives, powers: powers(&derivatives) });
        }
    }

    /// Finds the overlaps of contacts that were added after the panel was solved.
    pub fn look(&self, solved: &mut Solved) {
        for c in solved.moved.len()..self.free.len() {
            let mut moved = increase(&self.free[c], solved.length);
            let kernels = &self.kernels[c * self.closed..(c + 1) * self.closed];
            let responses: Vec<Option<Matrix>> = kernels.iter().map(|kernel| response(kernel, solved.length)).collect();
            respond(&mut moved, &responses, &solved.collocated);
            solved.moved.push(moved);
            let end = self.end(solved, c, solved.length);
            solved.end.push(end);
        }
    }

    /// Solves the panel of this length.
    pub fn attempt(
        &self,
        length: f64,
        unknowns: &mut [Unknown],
        newton: &mut Newton,
        counts: &mut Counts,
    ) -> Option<Solved> {
        let (free, responses) = (self.free_at_nodes(length), self.responses(length));
        for (unknown, series) in unknowns.iter_mut().zip(&self.free) {
            unknown.free = increase(series, length);
            if let Some(rate) = &mut unknown.free_rate {
                *rate = values(&slope(series), length);
            }
        }
        let of_contact = |(unknown, kernels): (&Unknown, &[Kernel])| -> Vec<Option<Matrix>> {
            kernels.iter().map(|kernel| unknown.free_rate.and_then(|_| rates(kernel, length))).collect()
        };
        let kernels = self.kernels.chunks(self.closed.max(1));
        let rates: Vec<Option<Matrix>> = unknowns.iter().zip(kernels).flat_map(of_contact).collect();
        let mut solved = Vec::new();
        let response = |c: usize, other: usize| {
            let pair = c * self.closed + other;
            Some(Mobility { nodes: responses[pair].as_ref()?, rates: rates[pair].as_ref() })
        };
        if !collocate(unknowns, response, (newton, &mut solved), counts) {
            return None;
        }
        Some(self.arrive(length, solved, free, &responses))
    }

    fn free_at_nodes(&self, length: f64) -> Vec<Nodal> {
        self.free.iter().map(|series| increase(series, length)).collect()
    }

    fn responses(&self, length: f64) -> Vec<Option<Matrix>> {
        self.kernels.iter().map(|kernel| response(kernel, length)).collect()
    }

    /// The panel under known forces: the increases of the overlaps up to the nodes and the overlaps at the end.
    fn arrive(
        &self,
        length: f64,
        collocated: Vec<Collocated>,
        mut moved: Vec<Nodal>,
        responses: &[Option<Matrix>],
    ) -> Solved {
        let force = collocated.iter().map(|own| Legendre::through(&own.acting)).collect();
        for (c, moved) in moved.iter_mut().enumerate() {
            respond(moved, &responses[c * self.closed..(c + 1) * self.closed], &collocated);
        }
        let moments = collocated.iter().map(|own| self.moments(&own.acting)).collect();
        let mut solved = Solved { length, collocated, force, moments, moved, end: Vec::new() };
        solved.end = (0..self.free.len()).map(|c| self.end(&solved, c, length)).collect();
        solved
    }

    /// Overlap of a contact and its first two derivatives at the end, if these forces are truncated or extrapolated to another
    /// length. Those that end as `t^(3/2)` are stretched, since they end with the panel.
    pub fn end(&self, from: &Solved, c: usize, length: f64) -> [f64; 3] {
        let mut end = value(&self.free[c], length);
        let part = length / from.length;
        for (other, force) in from.force.iter().enumerate() {
            let ends = from.collocated[other].ends;
            let moments = match ends.at_end || part == 1.0 {
                true => from.moments[other],
                false => self.moments(&force.at_each(&BASIS.nodes.map(|s| s * part))),
            };
            let last = if ends.at_end { 0.0 } else { force.at(part) };
            add_end(&self.kernels[c * self.closed + other], length, &moments, last, &mut end);
        }
        end
    }

    /// Integrals of `(1 - s)^p/p!` times a force with these nodal values over a panel, as many as the responses need.
    fn moments(&self, nodal: &Nodal) -> Series {
        let powers = self.kernels.iter().map(|kernel| kernel.powers).max().unwrap_or(0);
        let integrals = &BASIS.power_end[..powers];
        vectorized(
            #[inline(always)]
            || {
                let mut moments = [0.0; TAYLOR];
                for (moment, integral) in moments.iter_mut().zip(integrals) {
                    *moment = dot(integral, nodal);
                }
                moments
            },
        )
    }

    /// Advances the modes to the end of a solved panel.
    pub fn advance(&self, system: &System, solved: &Solved, amplitude: &mut [f64], rate: &mut [f64]) {
        coast(system, solved.length, amplitude, rate);
        for (c, moments) in self.contacts[..self.closed].iter().zip(&solved.moments) {
            push(system, &system.links[*c], solved.length, moments, amplitude, rate);
        }
    }

    /// The same forces on another length.
    pub fn with_length(&self, from: &Solved, length: f64) -> Solved {
        let places = BASIS.nodes.map(|s| s * (length / from.length));
        let carry = |nodal: &Nodal| Legendre::through(nodal).at_each(&places);
        let carried = |(solved, free): (&Collocated, &Series)| {
            let moved = carry(&solved.moved);
            Collocated {
                force: if solved.ends.at_end { solved.force } else { carry(&solved.force) },
                ends: solved.ends,
                acting: if solved.ends.at_end { solved.acting } else { carry(&solved.acting) },
                compression: moved.map(|moved| free[0] + moved),
                moved,
                rate: carry(&solved.rate),
            }
        };
        let solved = from.collocated.iter().zip(&self.free).map(carried).collect();
        self.arrive(length, solved, self.free_at_nodes(length), &self.responses(length))
    }
}

/// Adds the effect of the closed contacts' forces on an overlap at the nodes.
fn respond(overlap: &mut Nodal, responses: &[Option<Matrix>], solved: &[Collocated]) {
    for (response, solved) in responses.iter().zip(solved) {
        if let Some(response) = response {
            let moved = apply(response, &solved.acting);
            (0..Q).for_each(|i| overlap[i] += moved[i]);
        }
    }
}

/// How many powers a series has; rigid bodies move along short ones.
fn powers(series: &Series) -> usize {
    series.iter().rposition(|term| *term != 0.0).map_or(0, |last| last + 1)
}

/// The increase of a series from the start to the nodes of a panel of this length.
fn increase(series: &Series, length: f64) -> Nodal {
    let mut moved = *series;
    moved[0] = 0.0;
    values(&moved, length)
}

/// A series at the nodes of a panel of this length.
fn values(series: &Series, length: f64) -> Nodal {
    let t = BASIS.nodes.map(|s| s * length);
    let mut values = [0.0; Q];
    for term in series[..powers(series)].iter().rev() {
        for i in 0..Q {
            values[i] = values[i] * t[i] + term;
        }
    }
    values
}

/// Value, first and second derivative of a series at `t`.
pub(crate) fn value(series: &Series, t: f64) -> [f64; 3] {
    let (mut value, mut slope, mut bend) = (0.0, 0.0, 0.0);
    for p in (0..powers(series)).rev() {
        bend = bend * t + slope;
        slope = slope * t + value;
        value = value * t + series[p];
    }
    [value, slope, 2.0 * bend]
}

/// Derivatives of a response times `length^p`, and the number of significant ones.
fn scaled(kernel: &Kernel, length: f64) -> (Series, usize) {
    let mut scaled = kernel.derivatives;
    let mut power = 1.0;
    for value in &mut scaled[..kernel.powers] {
        *value *= power;
        power *= length;
    }
    let least = 1e-18 * scaled[1].abs();
    let terms = scaled[..kernel.powers].iter().rposition(|value| value.abs() > least).map_or(0, |last| last + 1);
    (scaled, terms)
}

/// Overlap at the nodes to nodal forces; `None` where there is no response at all.
fn response(kernel: &Kernel, length: f64) -> Option<Matrix> {
    let (scaled, terms) = scaled(kernel, length);
    (terms > 0).then(|| summed(&scaled[..terms], length))
}

/// Its rate.
fn rates(kernel: &Kernel, length: f64) -> Option<Matrix> {
    let (scaled, terms) = scaled(kernel, length);
    // the impulse response begins at zero
    (terms > 1).then(|| summed(&scaled[1..terms], 1.0))
}

/// Minus the integrals of powers of the time with these factors, times the nodal forces.
fn summed(factors: &[f64], scale: f64) -> Matrix {
    vectorized(
        #[inline(always)]
        || {
            let mut sum = [[0.0; Q]; Q];
            for (factor, power) in factors.iter().zip(&BASIS.power) {
                let factor = factor * scale;
                for j in 0..Q {
                    for i in 0..Q {
                        sum[j][i] -= factor * power[j][i];
                    }
                }
            }
            sum
        },
    )
}

/// The derivative of a series.
fn slope(series: &Series) -> Series {
    std::array::from_fn(|p| series.get(p + 1).map_or(0.0, |term| (p + 1) as f64 * term))
}

/// Adds overlap, rate and acceleration at the end under a force with these moments, whose value at the end is `last`.
fn add_end(kernel: &Kernel, length: f64, moments: &Series, last: f64, end: &mut [f64; 3]) {
    let (scaled, terms) = scaled(kernel, length);
    end[2] -= scaled[1] / length * last;
    for p in 1..terms {
        end[0] -= scaled[p] * length * moments[p];
        end[1] -= scaled[p] * moments[p - 1];
        if p > 1 {
            end[2] -= scaled[p] / length * moments[p - 2];
        }
    }
}

/// `g^(p)/p!` of the free motion of a contact's overlap under the loads, valid up to `reach` (s); the value at zero is that of the
/// modes alone.
pub(crate) fn series_of(
    system: &System,
    loads: &Loads,
    contact: usize,
    (time_s, amplitude, rate): (f64, &[f64], &[f64]),
    reach: f64,
) -> Series {
    let basis = &*BASIS;
    let sums = vectorized(
        #[inline(always)]
        || {
            let mut sums = [[0.0; LANES]; TAYLOR];
            for Span { modes, psi } in &system.links[contact].spans {
                let mut terms = 2;
                for k in (0..psi.len()).step_by(LANES) {
                    let at = modes.start + k;
                    terms = basis.terms::<TAYLOR>(turning(system, at, modes.end) * reach, terms);
                    // one by one: what `map` returns is copied
                    let (drag, square) = (lanes(&system.drag[..modes.end], at), lanes(&system.square[..modes.end], at));
                    let (a, b) = (lanes(&amplitude[..modes.end], at), lanes(&rate[..modes.end], at));
                    let psi = lanes(psi, k);
                    let (mut here, mut next) = ([0.0; LANES], [0.0; LANES]);
                    for l in 0..LANES {
                        (here[l], next[l]) = (psi[l] * a[l], psi[l] * b[l]);
                    }
                    for sum in &mut sums[..terms] {
                        for l in 0..LANES {
                            sum[l] += here[l];
                            (here[l], next[l]) = (next[l], -drag[l] * next[l] - square[l] * here[l]);
                        }
                    }
                }
            }
            sums
        },
    );
    let mut series = sums.map(|sum| sum.iter().sum());
    leave_out_infinite(&mut series);
    let mut divided = 1.0;
    for (p, value) in series.iter_mut().enumerate().skip(2) {
        divided *= RECIPROCAL[p];
        *value *= divided;
    }
    loads.add_series(contact, time_s, &mut series);
    series
}

/// One value of each of the modes from `k` on; zeros beyond the last.
#[inline(always)]
fn lanes(values: &[f64], k: usize) -> [f64; LANES] {
    match values[k..].first_chunk() {
        Some(chunk) => *chunk,
        None => {
            let mut padded = [0.0; LANES];
            padded[..values.len() - k].copy_from_slice(&values[k..]);
            padded
        }
    }
}

/// The fastest motion (rad/s) of the modes up to those taken from `k` on, of a body whose modes end at `end`.
fn turning(system: &System, k: usize, end: usize) -> f64 {
    system.turning[(k + LANES).min(end) - 1]
}

/// Free motion of all modes over `length`.
pub(crate) fn coast(system: &System, length: f64, amplitude: &mut [f64], rate: &mut [f64]) {
    let basis = &*BASIS;
    vectorized(
        #[inline(always)]
        || {
            for body in &system.bodies {
                let mut terms = 2;
                for k in body.clone().step_by(LANES) {
                    terms = basis.terms::<TAYLOR>(turning(system, k, body.end) * length, terms);
                    let (drag, square) = (lanes(&system.drag[..body.end], k), lanes(&system.square[..body.end], k));
                    let (mut here, mut next) = (lanes(&amplitude[..body.end], k), lanes(&rate[..body.end], k));
                    let (mut a, mut b) = (here, next);
                    // here and next are the terms of amplitude and rate
                    for n in &RECIPROCAL[1..terms] {
                        let part = length * n;
                        for l in 0..LANES {
                            (here[l], next[l]) = (part * next[l], -part * (drag[l] * next[l] + square[l] * here[l]));
                            a[l] += here[l];
                            b[l] += next[l];
                        }
                    }
                    for l in 0..LANES.min(body.end - k) {
                        (amplitude[k + l], rate[k + l]) = (a[l], b[l]);
                    }
                }
            }
        },
    )
}

/// Adds the effect of a contact force with these moments on the modes within a panel of `length`.
fn push(system: &System, link: &Link, length: f64, moments: &Series, amplitude: &mut [f64], rate: &mut [f64]) {
    // the response of a mode is the sum of the derivatives of its impulse response, times powers of the length, times the moments
    let basis = &*BASIS;
    vectorized(
        #[inline(always)]
        || {
            for Span { modes, psi } in &link.spans {
                let mut terms = 2;
                for k in (0..psi.len()).step_by(LANES) {
                    let at = modes.start + k;
                    terms = basis.terms::<TAYLOR>(turning(system, at, modes.end) * length, terms);
                    let (drag, square) = (lanes(&system.drag[..modes.end], at), lanes(&system.square[..modes.end], at));
                    let (mut here, mut next) = ([0.0; LANES], [length; LANES]);
                    let (mut a, mut b) = ([0.0; LANES], [0.0; LANES]);
                    for moment in &moments[..terms] {
                        for l in 0..LANES {
                            a[l] += here[l] * moment;
                            b[l] += next[l] * moment;
                            let bend = drag[l] * next[l] + square[l] * here[l];
                            (here[l], next[l]) = (length * next[l], -length * bend);
                        }
                    }
                    for l in 0..LANES.min(psi.len() - k) {
                        amplitude[at + l] -= psi[k + l] * a[l];
                        rate[at + l] -= psi[k + l] * b[l];
                    }
                }
            }
        },
    )
}
