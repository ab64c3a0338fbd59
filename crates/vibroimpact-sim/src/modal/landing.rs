//! The short last step of a branch, whose length is unknown: it ends where the branch meets its boundary.
//!
//! It is shorter than the period of every mode, so free motion and impulse responses are Taylor series, whose terms
//! at the contact are the same few numbers whatever the length tried.

use super::ladder::{Ladder, Vibration};
use super::legendre::{BASIS, Nodal, Q, TAYLOR, dot, evaluate};
use super::solution::Counts;
use super::step::{Collocated, Given, collocate};
use contact_models::{Boundary, Branch, ContactLaw};

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
pub(crate) struct Landed {
    pub length: f64,
    pub step: Collocated,
    /// Legendre coefficients of the force.
    pub force: Nodal,
    /// Compression and rate on arrival.
    pub compression: f64,
    pub rate: f64,
}

impl<L: ContactLaw> Approach<'_, L> {
    /// The step of this length: its force, its end, and the margin of the boundary there.
    fn attempt(&self, length: f64, guess: Nodal, counts: &mut Counts) -> Option<(Landed, f64)> {
        let basis = &*BASIS;
        let mut response = [[0.0; Q]; Q];
        let (mut end_response, mut end_rate_response) = ([0.0; Q], [0.0; Q]);
        let mut power = length;
        // the series of the kernel begins with p = 1; its terms fall, and the small ones are left out
        let least = 1e-18 * (self.kernel[1] * length * length).abs();
        for p in 0..TAYLOR {
            let kernel = self.kernel[p] * power;
            if kernel.abs() > least {
                for i in 0..Q {
                    for j in 0..Q {
                        response[i][j] -= kernel * basis.power[p][i][j];
                    }
                    end_response[i] -= kernel * basis.power_end[p][i];
                }
            }
            if p > 0 {
                let kernel = self.kernel[p] * power / length;
                for i in 0..Q {
                    end_rate_response[i] -= kernel * basis.power_end[p - 1][i];
                }
            }
            power *= length;
        }
        let free = basis.nodes.map(|c| self.free(c * length).0);
        let given = Given {
            h: length,
            start_compression: self.start_compression,
            free,
            response: &response,
            residual_compliance: self.residual_compliance,
            needs_rate: self.needs_rate,
            accuracy: self.accuracy / length,
        };
        let step = collocate(self.law, self.branch, &given, guess, counts)?;
        let force = basis.coefficients(&step.force);
        let (free_gap, free_rate) = self.free(length);
        let (gap, gap_rate) =
            (free_gap + dot(&end_response, &step.force), free_rate + dot(&end_rate_response, &step.force));
        let (compression, rate) = if self.residual_compliance == 0.0 {
            (gap, gap_rate)
        } else {
            let slope = basis.end_slope_from_start * self.start_compression
                + dot(&basis.end_slope_from_nodes, &step.compression);
            (gap - self.residual_compliance * evaluate(&force, 1.0), slope / length)
        };
        let margin = self.boundary().margin(compression, rate);
        Some((Landed { length, step, force, compression, rate }, margin))
    }

    /// Gap and its rate after `t` of free motion.
    fn free(&self, t: f64) -> (f64, f64) {
        let (mut value, mut slope) = (0.0, 0.0);
        for p in (0..TAYLOR).rev() {
            slope = slope * t + value;
            value = value * t + self.gap[p];
        }
        (value, slope)
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
            let (gap, rate) = self.free(length);
            let next = length - boundary.margin(gap, rate) / (boundary.per_compression * rate);
            if !(next > 0.0 && next < longest) {
                break;
            }
            length = next;
        }
        length
    }

    /// Searches `(0, longest]` for the length at which the boundary is met, starting near `expected`; `None` if the
    /// branch does not end there.
    pub fn land(&self, expected: f64, longest: f64, counts: &mut Counts) -> Option<Landed> {
        let start = self.free(0.0);
        let initial = self.boundary().margin(self.start_compression, start.1).max(0.0);
        let (mut low, mut low_margin) = (0.0, initial);
        let mut high = self.without_force(expected, longest);
        let mut guess = [0.0; Q];
        let mut side = 0;
        let (mut best, mut best_margin) = loop {
            let (landed, margin) = self.attempt(high, guess, counts)?;
            guess = landed.step.force;
            if margin <= 0.0 {
                break (landed, margin);
            }
            if high >= longest {
                return None;
            }
            (low, low_margin) = (high, margin);
            high = (2.0 * high).min(longest);
        };
        let mut high_margin = best_margin;
        // Newton's method on the length where the margin's slope is at hand, regula falsi where it is not, both
        // kept within the bracket
        let per = self.boundary();
        for _ in 0..60 {
            let slope = if per.per_rate == 0.0 { per.per_compression * best.rate } else { 0.0 };
            let newton = best.length - best_margin / slope;
            let secant = (low * high_margin - high * low_margin) / (high_margin - low_margin);
            let next = [newton, secant, 0.5 * (low + high)].into_iter().find(|x| *x > low && *x < high);
            let Some(next) = next else { break };
            let moved = (best.length - next).abs();
            (best, best_margin) = self.attempt(next, best.step.force, counts)?;
            // what follows does not depend on where within these last digits the branch is left
            if moved <= 1e-13 * high || best_margin.abs() <= 1e-13 * initial {
                break;
            }
            if best_margin <= 0.0 {
                (high, high_margin, low_margin) =
                    (next, best_margin, if side < 0 { 0.5 * low_margin } else { low_margin });
                side = -1;
            } else {
                (low, low_margin, high_margin) =
                    (next, best_margin, if side > 0 { 0.5 * high_margin } else { high_margin });
                side = 1;
            }
        }
        Some(best)
    }
}

/// How many terms of the series a motion that turns by `angle` (rad) needs to be exact to rounding.
fn terms(angle: f64) -> usize {
    let (mut terms, mut size) = (2, angle);
    while terms < TAYLOR && size > 1e-17 {
        size *= angle / terms as f64;
        terms += 1;
    }
    terms
}

/// `g^(p)/p!` of the structure's free motion at the contact.
pub(crate) fn taylor_of_free_motion(ladder: &Ladder, state: &Vibration) -> [f64; TAYLOR] {
    let mut here = state.alpha.clone();
    let mut next = state.beta.clone();
    let mut series = [0.0; TAYLOR];
    let mut factorial = 1.0;
    for (p, value) in series.iter_mut().enumerate() {
        if p > 1 {
            factorial *= p as f64;
        }
        *value = here.iter().sum::<f64>() / factorial;
        for ((mode, a), b) in ladder.modes.iter().zip(&mut here).zip(&mut next) {
            let after = -mode.omega_rad_s * (2.0 * mode.damping_ratio * *b + mode.omega_rad_s * *a);
            (*a, *b) = (*b, after);
        }
    }
    series
}

/// Advances the modes over a landing of this length under these nodal forces.
pub(crate) fn advance(ladder: &Ladder, state: &mut Vibration, length: f64, force: &Nodal) {
    // free motion and impulse response both follow the derivatives of the mode's own equation
    let (mut moments, mut powers) = ([0.0; TAYLOR], [0.0; TAYLOR]);
    let (mut undivided, mut divided) = (length, 1.0);
    let terms = terms(ladder.fastest_rad_s * length);
    for p in 0..terms {
        (moments[p], powers[p]) = (undivided * dot(&BASIS.power_end[p], force), divided);
        undivided *= length;
        divided *= length / (p + 1) as f64;
    }
    for (k, mode) in ladder.modes.iter().enumerate() {
        let (drag, square) = (2.0 * mode.damping_ratio * mode.omega_rad_s, mode.omega_rad_s * mode.omega_rad_s);
        let (mut free, mut free_next) = (state.alpha[k], state.beta[k]);
        let (mut forced, mut forced_next) = (0.0, -ladder.weight[k]);
        let (mut alpha, mut beta) = (0.0, 0.0);
        for p in 0..terms {
            alpha += free * powers[p] + forced * moments[p];
            beta += free_next * powers[p] + forced_next * moments[p];
            (free, free_next) = (free_next, -drag * free_next - square * free);
            (forced, forced_next) = (forced_next, -drag * forced_next - square * forced);
        }
        (state.alpha[k], state.beta[k]) = (alpha, beta);
    }
}
