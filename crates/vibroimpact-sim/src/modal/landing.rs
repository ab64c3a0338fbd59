//! The short last step of a branch, whose length is unknown: it ends where the branch meets its boundary.
//!
//! It is shorter than the period of every mode, so free motion and impulse responses are Taylor series, whose terms
//! at the contact are the same few numbers whatever the length tried.

use super::behind::Behind;
use super::ladder::{Ladder, Vibration};
use super::legendre::{BASIS, Matrix, Nodal, Q, RECIPROCAL, TAYLOR, dot, evaluate};
use super::solution::Counts;
use super::step::{Collocated, Given, collocate};
use contact_models::{Boundary, Branch, ContactLaw};
use std::array;

/// The series is used while the fastest motion turns by at most this many radians.
pub(crate) const REACH: f64 = 0.7;

/// The state at the start of a landing.
pub(crate) struct Approach<'a, L> {
    pub law: &'a L,
    pub branch: &'a Branch,
    /// Which of the branch's boundaries is met.
    pub which: usize,
    pub needs_rate: bool,
    /// Impulse to which the nodal forces are wanted (N s).
    pub accuracy: f64,
    /// Compression at the start (m), and the gap's derivatives in free motion, `g^(p)/p!`.
    pub start_compression: f64,
    pub gap: [f64; TAYLOR],
    /// Derivatives of the impulse response at the contact, striker included.
    pub kernel: [f64; TAYLOR],
    pub residual_compliance: f64,
}

/// A landing found.
#[derive(Clone, Copy)]
pub(crate) struct Landed {
    pub length: f64,
    pub step: Collocated,
    /// Legendre coefficients of the force.
    pub force: Nodal,
    /// Compression and rate on arrival.
    pub compression: f64,
    pub rate: f64,
    /// The gap there (m).
    pub gap: f64,
    /// Distance to the boundary there, and how fast it changes; 0 where that is not known.
    margin: f64,
    margin_rate: f64,
}

/// A force that the law fixed on one length serves for others while it need not be carried on by more than this part of
/// it, nor any node be left outside.
const CARRIED: f64 = 0.05;

impl<L: ContactLaw> Approach<'_, L> {
    /// The step of this length: its force, its end, and the margin of the boundary there.
    fn attempt(&self, length: f64, guess: Nodal, counts: &mut Counts) -> Option<Landed> {
        let basis = &*BASIS;
        let (kernel, terms) = self.scaled_kernel(length);
        let response: Matrix = array::from_fn(|j| {
            let mut column = [0.0; Q];
            for (kernel, power) in kernel[..terms].iter().zip(&basis.power) {
                for i in 0..Q {
                    column[i] -= kernel * length * power[j][i];
                }
            }
            column
        });
        let free = basis.nodes.map(|c| self.free(c * length)[0]);
        let given = Given {
            h: length,
            start_compression: self.start_compression,
            start_gap: self.gap[0],
            free,
            response: &response,
            residual_compliance: self.residual_compliance,
            needs_rate: self.needs_rate,
            accuracy: self.accuracy / length,
        };
        let step = collocate(self.law, self.branch, &given, guess, counts)?;
        Some(self.arrive(length, step))
    }

    /// The end of a step of this length and these forces.
    fn arrive(&self, length: f64, step: Collocated) -> Landed {
        let basis = &*BASIS;
        let (kernel, terms) = self.scaled_kernel(length);
        let force = basis.coefficients(&step.force);
        let mut moments = [0.0; TAYLOR];
        for (moment, power) in moments[..terms].iter_mut().zip(&basis.power_end) {
            *moment = dot(power, &step.force);
        }
        let [mut gap, mut rate, mut bend] = self.free(length);
        bend -= kernel[1] / length * evaluate(&force, 1.0);
        for p in 1..terms {
            gap -= kernel[p] * length * moments[p];
            rate -= kernel[p] * moments[p - 1];
            if p > 1 {
                bend -= kernel[p] / length * moments[p - 2];
            }
        }
        let behind = self.behind();
        let end = behind.end_of_step((gap, rate), self.start_compression, &step, &force, length);
        let (margin, margin_rate) = behind.margin(&self.boundary(), [gap, rate, bend], end);
        Landed { length, step, force, compression: end.0, rate: end.1, gap, margin, margin_rate }
    }

    /// The derivatives of the impulse response times `length^p`, and how many matter: their series begins with `p` = 1,
    /// its terms fall, and the small ones are left out.
    fn scaled_kernel(&self, length: f64) -> ([f64; TAYLOR], usize) {
        let mut kernel = self.kernel;
        let least = 1e-18 * (kernel[1] * length).abs();
        let mut power = 1.0;
        for value in &mut kernel {
            *value *= power;
            power *= length;
        }
        let terms = 1 + kernel.iter().rposition(|value| value.abs() > least).unwrap_or(0);
        (kernel, terms)
    }

    fn behind(&self) -> Behind<'_, L> {
        Behind { law: self.law, branch: self.branch, compliance: self.residual_compliance }
    }

    /// Gap, its rate and the rate of that after `t` of free motion.
    fn free(&self, t: f64) -> [f64; 3] {
        let (mut value, mut slope, mut bend) = (0.0, 0.0, 0.0);
        for p in (0..TAYLOR).rev() {
            bend = bend * t + slope;
            slope = slope * t + value;
            value = value * t + self.gap[p];
        }
        [value, slope, 2.0 * bend]
    }

    fn boundary(&self) -> Boundary {
        self.law.boundaries(self.branch)[self.which]
    }

    /// Where free motion would meet the boundary. Near a separation the force is too small to matter much, and brings
    /// it only a little forward.
    fn without_force(&self, expected: f64, longest: f64) -> f64 {
        let boundary = self.boundary();
        let mut length = expected.clamp(1e-3 * longest, longest);
        for _ in 0..if boundary.per_rate == 0.0 { 3 } else { 0 } {
            let [gap, rate, _] = self.free(length);
            let next = length - boundary.margin(gap, rate) / (boundary.per_compression * rate);
            if !(next > 0.0 && next < longest) {
                break;
            }
            length = next;
        }
        length
    }

    /// The force of a landing, cut short or carried on to where it meets the boundary itself, if that is near enough for
    /// the law to hold there as it does at the nodes. Behind a compliance the law has to be solved at the very end.
    fn carried(&self, from: &Landed) -> Option<Landed> {
        if self.residual_compliance > 0.0 {
            return None;
        }
        let range = BASIS.nodes[Q - 1] * from.length..=(1.0 + CARRIED) * from.length;
        let carry = |coefficients: &Nodal, part: f64| BASIS.nodes.map(|c| evaluate(coefficients, c * part));
        let mut landed = *from;
        for _ in 0..8 {
            let next = landed.length - landed.margin / landed.margin_rate;
            if !range.contains(&next) {
                return None;
            }
            let (moved, part) = ((next - landed.length).abs(), next / from.length);
            let force = carry(&from.force, part);
            landed = self.arrive(next, Collocated { force, ..from.step });
            // the next of Newton's steps would be the square of this one
            if moved <= 1e-7 * next {
                landed.step.compression = carry(&BASIS.coefficients(&from.step.compression), part);
                if self.needs_rate {
                    landed.step.rate = carry(&BASIS.coefficients(&from.step.rate), part);
                }
                return Some(landed);
            }
        }
        None
    }

    /// Searches `(0, longest]` for the length at which the boundary is met, starting near `expected`; `None` if the
    /// branch does not end there.
    pub fn land(&self, expected: f64, longest: f64, counts: &mut Counts) -> Option<Landed> {
        let start = self.free(0.0);
        let (margin, _) = self.behind().margin(&self.boundary(), start, (self.start_compression, start[1]));
        let initial = margin.max(0.0);
        let (mut low, mut low_margin) = (0.0, initial);
        let mut high = self.without_force(expected, longest);
        let mut guess = [0.0; Q];
        let mut side = 0;
        let mut best = loop {
            let landed = self.attempt(high, guess, counts)?;
            if let Some(landed) = self.carried(&landed) {
                return (landed.length <= longest).then_some(landed);
            }
            guess = landed.step.force;
            if landed.margin <= 0.0 {
                break landed;
            }
            if high >= longest {
                return None;
            }
            (low, low_margin) = (high, landed.margin);
            high = (2.0 * high).min(longest);
        };
        let mut high_margin = best.margin;
        // Newton's method on the length where the margin's slope is at hand, regula falsi where it is not, both
        // kept within the bracket
        for _ in 0..60 {
            let newton = best.length - best.margin / best.margin_rate;
            let secant = (low * high_margin - high * low_margin) / (high_margin - low_margin);
            let next = [newton, secant, 0.5 * (low + high)].into_iter().find(|x| *x > low && *x < high);
            let Some(next) = next else { break };
            let moved = (best.length - next).abs();
            best = self.attempt(next, best.step.force, counts)?;
            if let Some(landed) = self.carried(&best) {
                return Some(landed);
            }
            // what follows does not depend on where within these last digits the branch is left
            if moved <= 1e-13 * high || best.margin.abs() <= 1e-13 * initial {
                break;
            }
            if best.margin <= 0.0 {
                (high, high_margin, low_margin) =
                    (next, best.margin, if side < 0 { 0.5 * low_margin } else { low_margin });
                side = -1;
            } else {
                (low, low_margin, high_margin) =
                    (next, best.margin, if side > 0 { 0.5 * high_margin } else { high_margin });
                side = 1;
            }
        }
        Some(best)
    }
}

/// Rate at the end of a step of `h` of the polynomial with these values at its start and at the nodes.
pub(crate) fn end_slope(start: f64, nodal: &Nodal, h: f64) -> f64 {
    (BASIS.end_slope_from_start * start + dot(&BASIS.end_slope_from_nodes, nodal)) / h
}

/// `g^(p)/p!` of the structure's free motion at the contact, to be used up to `reach` (s).
pub(crate) fn taylor_of_free_motion(ladder: &Ladder, state: &Vibration, reach: f64) -> [f64; TAYLOR] {
    let mut sums = [[0.0; LANES]; TAYLOR];
    let mut terms = 2;
    for k in (0..ladder.modes.len()).step_by(LANES) {
        terms = BASIS.terms::<TAYLOR>(turning(ladder, k) * reach, terms);
        let (drag, square) = (lanes(&ladder.drag, k), lanes(&ladder.square, k));
        let (mut here, mut next) = (lanes(&state.alpha, k), lanes(&state.beta, k));
        for sum in &mut sums[..terms] {
            for l in 0..LANES {
                sum[l] += here[l];
                (here[l], next[l]) = (next[l], -drag[l] * next[l] - square[l] * here[l]);
            }
        }
    }
    let mut divided = 1.0;
    array::from_fn(|p| {
        divided *= if p > 1 { RECIPROCAL[p] } else { 1.0 };
        divided * sums[p].iter().sum::<f64>()
    })
}

/// Modes taken at a time, for the vector units.
const LANES: usize = 2;

/// One value of each of the modes from `k` on; zeros beyond the last.
fn lanes(values: &[f64], k: usize) -> [f64; LANES] {
    array::from_fn(|l| values.get(k + l).copied().unwrap_or(0.0))
}

/// The fastest motion (rad/s) of the modes up to those taken from `k` on.
fn turning(ladder: &Ladder, k: usize) -> f64 {
    ladder.turning[(k + LANES).min(ladder.turning.len()) - 1]
}

/// Advances the modes over a landing of this length under these nodal forces.
pub(crate) fn advance(ladder: &Ladder, state: &mut Vibration, length: f64, force: &Nodal) {
    // with `S` the motion after a unit velocity, its derivatives at the start are to be summed with `length^p/p!`, which
    // gives `S` at the end, and with the moments of the force, which give the response to it
    let mut weights = [(0.0, 0.0); TAYLOR];
    let (mut divided, mut undivided) = (1.0, length);
    for (p, weight) in weights.iter_mut().enumerate() {
        *weight = (divided, undivided * dot(&BASIS.power_end[p], force));
        divided *= length * RECIPROCAL[p + 1];
        undivided *= length;
    }
    let mut terms = 2;
    for k in (0..ladder.modes.len()).step_by(LANES) {
        terms = BASIS.terms::<TAYLOR>(turning(ladder, k) * length, terms);
        let (drag, square) = (lanes(&ladder.drag, k), lanes(&ladder.square, k));
        let (mut here, mut next) = ([0.0; LANES], [1.0; LANES]);
        // `S` and the displacement forced; their rates
        let [mut s, mut forced, mut s_rate, mut forced_rate] = [[0.0; LANES]; 4];
        for (power, moment) in &weights[..terms] {
            for l in 0..LANES {
                s[l] += here[l] * power;
                forced[l] += here[l] * moment;
                s_rate[l] += next[l] * power;
                forced_rate[l] += next[l] * moment;
                (here[l], next[l]) = (next[l], -drag[l] * next[l] - square[l] * here[l]);
            }
        }
        let modes = state.alpha.iter_mut().zip(&mut state.beta).zip(&ladder.weight).skip(k).take(LANES);
        for (l, ((alpha, beta), weight)) in modes.enumerate() {
            let (a, b) = (*alpha, *beta);
            *alpha = (s_rate[l] + drag[l] * s[l]) * a + s[l] * b - weight * forced[l];
            *beta = s_rate[l] * b - square[l] * s[l] * a - weight * forced_rate[l];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::oscillator::{propagate, response};
    use super::super::problem::Mode;
    use super::*;

    /// Five modes, so that the last lane stays empty, of very different dampings.
    fn ladder() -> Ladder {
        let mode = |(omega_rad_s, damping_ratio)| Mode { omega_rad_s, damping_ratio, shape: 0.8 };
        Ladder::new([(1.0, 0.0), (30.0, 3.0), (90.0, 0.02), (150.0, 1.0), (280.0, 0.0)].map(mode).to_vec())
    }

    fn vibration() -> Vibration {
        Vibration { alpha: vec![1.0, -0.3, 0.2, 0.1, -0.05], beta: vec![0.5, 3.0, -7.0, 2.0, 11.0] }
    }

    #[test]
    fn a_landing_moves_each_mode_as_its_closed_form_does() {
        let (ladder, force) = (ladder(), [3.0, -1.0, 4.0, 1.0, -5.0, 9.0, 2.0, 6.0]);
        for length in [0.0, 1e-6, 5e-4, REACH / ladder.fastest_rad_s] {
            let (before, mut after) = (vibration(), vibration());
            advance(&ladder, &mut after, length, &force);
            let coefficients = BASIS.coefficients(&force);
            for (k, mode) in ladder.modes.iter().enumerate() {
                let p = propagate(mode, length);
                let (a, b, w) = (before.alpha[k], before.beta[k], ladder.weight[k]);
                let (mut alpha, mut beta) = p.apply(a, b);
                if length > 0.0 {
                    let (displacement, velocity) = response(mode, length);
                    alpha -= w * dot(&displacement, &coefficients);
                    beta -= w * dot(&velocity, &coefficients);
                }
                assert!((after.alpha[k] - alpha).abs() < 1e-13, "{length} {k}: {} {alpha}", after.alpha[k]);
                assert!((after.beta[k] - beta).abs() < 1e-12 * (1.0 + mode.omega_rad_s), "{length} {k}");
            }
        }
    }

    #[test]
    fn the_series_of_the_gap_follows_free_motion() {
        let ladder = ladder();
        let reach = REACH / ladder.fastest_rad_s;
        let series = taylor_of_free_motion(&ladder, &vibration(), reach);
        for t in [0.0, 0.3 * reach, reach] {
            let sum = series.iter().rev().fold(0.0, |sum, term| sum * t + term);
            let state = vibration();
            let exact: f64 = (0..5)
                .map(|k| {
                    let p = propagate(&ladder.modes[k], t);
                    p.apply(state.alpha[k], state.beta[k]).0
                })
                .sum();
            assert!((sum - exact).abs() < 1e-13, "{t}: {sum} {exact}");
        }
    }
}
