//! The short last step of a branch, whose length is unknown: it ends where the branch meets its boundary.
//!
//! No mode turns by more than a few radians in it, so free motion and impulse responses are Taylor series, whose terms
//! at the contact are the same few numbers whatever the length tried.

use super::ladder::{Ladder, Vibration, sum};
use super::legendre::{BASIS, Nodal, Q, TAYLOR, add_multiple, dot, evaluate};
use super::solution::Counts;
use super::step::{Collocated, Given, collocate};
use contact_models::{Boundary, Branch, ContactLaw};

/// The series is used while the fastest motion turns by at most this many radians: the last term kept is rounding,
/// and so is what the largest one loses.
pub(crate) const REACH: f64 = 3.0;

/// A landing whose length changes by less than this part keeps its force: near a separation almost nothing is left of
/// it, elsewhere it is smooth.
const NEAR: f64 = 1e-2;
/// More turns between force and length than this mean that the branch does not end here.
const TURNS: u32 = 5;

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
    /// How many terms of the series matter over the longest step to be tried.
    pub terms: usize,
    /// Derivatives of the impulse response at the contact, striker included.
    pub kernel: [f64; TAYLOR],
    pub residual_compliance: f64,
    /// Rounding of the gap (m).
    pub noise: f64,
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
    /// The nodal values of a step of this length.
    fn solve(&self, length: f64, guess: Nodal, counts: &mut Counts) -> Option<Collocated> {
        let basis = &*BASIS;
        let mut response = [[0.0; Q]; Q];
        let mut power = length;
        // the series of the kernel begins with p = 1; its terms fall, and the small ones are left out
        let least = 1e-16 * (self.kernel[1] * length * length).abs();
        for p in 0..self.terms {
            let kernel = self.kernel[p] * power;
            if kernel.abs() > least {
                add_multiple(&mut response, -kernel, &basis.power[p]);
            }
            power *= length;
        }
        let given = Given {
            h: length,
            start_compression: self.start_compression,
            free: basis.nodes.map(|c| self.free(c * length).0),
            response: &response,
            residual_compliance: self.residual_compliance,
            needs_rate: self.needs_rate,
            accuracy: self.accuracy / length,
        };
        collocate(self.law, self.branch, &given, guess, counts)
    }

    /// Compression and rate after this time under these nodal forces.
    fn arrive(&self, length: f64, force: &Nodal) -> (f64, f64) {
        let basis = &*BASIS;
        let (mut gap, mut gap_rate) = self.free(length);
        // sum_p k^(p) L^p M_p with the moments M_p of the force over a step of unit length
        let (mut power, mut moment_before) = (length, 0.0);
        for p in 0..self.terms {
            let moment = dot(&basis.power_end[p], force);
            gap -= self.kernel[p] * power * moment;
            gap_rate -= self.kernel[p] * power / length * moment_before;
            (power, moment_before) = (power * length, moment);
        }
        if self.residual_compliance == 0.0 {
            return (gap, gap_rate);
        }
        // d/ds P_n(2s-1) at s = 1 is n (n+1)
        let coefficients = basis.coefficients(force);
        let slope: f64 = (0..Q).map(|n| (n * (n + 1)) as f64 * coefficients[n]).sum();
        let c = self.residual_compliance;
        (gap - c * evaluate(&coefficients, 1.0), gap_rate - c * slope / length)
    }

    /// Gap and its rate after `t` of free motion.
    fn free(&self, t: f64) -> (f64, f64) {
        let (mut value, mut slope) = (0.0, 0.0);
        for p in (0..self.terms).rev() {
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
    /// branch does not end there. Two searches take turns: the nodal forces of a step of a given length, and the
    /// moment at which the motion under this force, a polynomial in time, meets the boundary. `foreseen` is the force
    /// to begin with, after so many seconds.
    pub fn land(
        &self,
        expected: f64,
        longest: f64,
        foreseen: impl Fn(f64) -> f64,
        counts: &mut Counts,
    ) -> Option<Landed> {
        let basis = &*BASIS;
        let mut length = self.without_force(expected, longest);
        let mut guess = basis.nodes.map(|c| foreseen(c * length));
        if let Some(next) = self.meet(&guess, length, longest) {
            (guess, length) = (basis.restrict(&guess, next / length), next);
        }
        for _ in 0..TURNS {
            let step = self.solve(length, guess, counts)?;
            let at = self.meet(&step.force, length, longest);
            if at.is_none() && length >= longest {
                return None;
            }
            let next = at.unwrap_or(longest);
            let part = next / length;
            guess = basis.restrict(&step.force, part);
            if at.is_some() && (part - 1.0).abs() <= NEAR {
                let step = Collocated {
                    force: guess,
                    compression: basis.restrict(&step.compression, part),
                    rate: basis.restrict(&step.rate, part),
                };
                let (compression, rate) = self.arrive(next, &step.force);
                return Some(Landed { length: next, force: basis.coefficients(&step.force), step, compression, rate });
            }
            length = next;
        }
        None
    }

    /// When the motion under a force, given at the nodes of a step of `length`, meets the boundary: the first change
    /// of sign seen on the way from `length` to either end of `(0, longest]`.
    fn meet(&self, force: &Nodal, length: f64, longest: f64) -> Option<f64> {
        let boundary = self.boundary();
        let coefficients = BASIS.coefficients(force);
        let margin = |t: f64| {
            let there = BASIS.nodes.map(|c| evaluate(&coefficients, t / length * c));
            let (compression, rate) = self.arrive(t, &there);
            (boundary.margin(compression, rate), boundary.per_compression * rate)
        };
        let initial = boundary.margin(self.start_compression, self.free(0.0).1).max(0.0);
        let (mut low, mut low_margin) = (0.0, initial);
        let (mut high, mut high_margin) = (length, f64::NAN);
        let (mut at, mut bracketed, mut side) = (length, false, 0);
        // what follows does not depend on where within these last digits the branch is left
        let settled = (1e-14 * initial).max(boundary.per_compression.abs() * self.noise);
        for _ in 0..60 {
            let (here, slope) = margin(at);
            if here > 0.0 {
                (low, low_margin) = (at, here);
                if side > 0 {
                    high_margin *= 0.5;
                }
                side = 1;
            } else {
                (high, high_margin) = (at, here);
                if side < 0 {
                    low_margin *= 0.5;
                }
                (bracketed, side) = (true, -1);
            }
            // Newton's method where the margin's slope is at hand, regula falsi where it is not
            let newton = if boundary.per_rate == 0.0 && slope < 0.0 { at - here / slope } else { f64::NAN };
            let next = if bracketed {
                let secant = (low * high_margin - high * low_margin) / (high_margin - low_margin);
                [newton, secant, 0.5 * (low + high)].into_iter().find(|x| *x > low && *x < high)?
            } else if at >= longest {
                return None;
            } else if newton > at {
                newton.min(longest)
            } else {
                (1.5 * at).min(longest)
            };
            if bracketed && ((next - at).abs() <= 1e-14 * high || here.abs() <= settled) {
                return Some(next);
            }
            at = next;
        }
        Some(at)
    }
}

/// `g^(p)/p!` of the structure's free motion at the contact, as far as they matter within `longest`.
pub(crate) fn taylor_of_free_motion(ladder: &Ladder, state: &Vibration, longest: f64) -> [f64; TAYLOR] {
    let n = state.alpha.len();
    let (square, drag) = (&ladder.square[..n], &ladder.drag[..n]);
    let (mut here, mut next) = (state.alpha.clone(), state.beta.clone());
    let mut series = [0.0; TAYLOR];
    let mut factorial = 1.0;
    for (p, first) in ladder.needing(longest).into_iter().enumerate().take_while(|(_, first)| *first < n) {
        if p > 1 {
            factorial *= p as f64;
        }
        series[p] = sum(&here[first..]) / factorial;
        let (a, b) = (&mut here[first..n], &mut next[first..n]);
        let (square, drag) = (&square[first..n], &drag[first..n]);
        for k in 0..n - first {
            let after = -(drag[k] * b[k] + square[k] * a[k]);
            a[k] = b[k];
            b[k] = after;
        }
    }
    series
}

/// The modes after `length` of free motion from `state`, within reach of the power series.
pub(crate) fn coast(ladder: &Ladder, state: &Vibration, end: &mut Vibration, length: f64) {
    horner(ladder, state, end, length, &[0.0; TAYLOR]);
}

/// The modes after a landing of this length from `state` under these nodal forces.
pub(crate) fn advance(ladder: &Ladder, state: &Vibration, end: &mut Vibration, length: f64, force: &Nodal) {
    let mut power = length;
    let moments = std::array::from_fn(|p| {
        let moment = power * dot(&BASIS.power_end[p], force);
        power *= length;
        moment
    });
    horner(ladder, state, end, length, &moments);
}

/// With `A` the matrix of a mode's equation `y' = A y - (0, w) F`, `y = (alpha, alpha')`, and the force's moments
/// `M_p = int (L-s)^p/p! F ds`: `y(L) = sum_p A^p (y L^p/p! - (0, w) M_p)`, by Horner's scheme.
fn horner(ladder: &Ladder, state: &Vibration, end: &mut Vibration, length: f64, moments: &[f64; TAYLOR]) {
    let n = state.alpha.len();
    let (square, drag, weight) = (&ladder.square[..n], &ladder.drag[..n], &ladder.weight[..n]);
    let (alpha, beta) = (&state.alpha[..n], &state.beta[..n]);
    let (alpha_end, beta_end) = (&mut end.alpha[..n], &mut end.beta[..n]);
    let mut powers = [1.0; TAYLOR];
    for p in 1..TAYLOR {
        powers[p] = powers[p - 1] * length / p as f64;
    }
    alpha_end.fill(0.0);
    beta_end.fill(0.0);
    for (p, first) in ladder.needing(length).into_iter().enumerate().rev() {
        let (power, moment) = (powers[p], moments[p]);
        for k in first..n {
            let (a, b) = (alpha_end[k], beta_end[k]);
            alpha_end[k] = alpha[k] * power + b;
            beta_end[k] = (beta[k] * power - weight[k] * moment) - (drag[k] * b + square[k] * a);
        }
    }
}
