//! The derivatives of one random impact at a tolerance of 1e-9, compared with differences in 32 digits.

use serde::{Deserialize, Serialize};
use vibroimpact_sim::modal::{Derivative, Outcome};

use super::posed::Posed;

/// The tolerance of the impacts.
const TOLERANCE: f64 = 1e-9;
/// Error of a derivative that counts as correct, relative to its size.
const CORRECT: f64 = 1e-6;
/// Derivatives below this share of the natural size of the output are compared with that.
const LEAST: f64 = 1e-3;
/// Impacts with at most this number of contacts are counted apart: every further contact magnifies the error of the motion.
pub const FEW: usize = 15;
/// Names of the tallies.
pub const OUTPUTS: [&str; 3] = ["final velocity", "times", "impulses"];

/// One impact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    pub number: u32,
    /// Whether it ends with a rebound; otherwise nothing is compared.
    pub rebounds: bool,
    pub contacts: usize,
    /// Number of parameters by which it has another number of contacts in 32 digits.
    pub lost: usize,
    /// Number of parameters whose derivatives are not known to a millionth in 32 digits.
    pub unknown: usize,
    pub outputs: [Tally; 3],
}

/// Numbers of derivatives.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Tally {
    pub compared: usize,
    /// Correct to a millionth, within the stated uncertainty, neither, and without a stated uncertainty.
    pub near: usize,
    pub covered: usize,
    pub silent: usize,
    pub uncertain: usize,
    /// The largest error relative to the derivative.
    pub worst: f64,
}

impl Tally {
    /// Compares a derivative with one of this accuracy; errors below a millionth of `least` do not count.
    fn compare(&mut self, derivative: Derivative, [reference, known]: [f64; 2], least: f64) {
        let (error, size) = ((derivative.value - reference).abs(), reference.abs().max(least));
        let near = error <= CORRECT * size + known;
        let covered = derivative.uncertainty.is_some_and(|uncertainty| error <= uncertainty + known);
        self.compared += 1;
        self.near += usize::from(near);
        self.covered += usize::from(covered);
        self.silent += usize::from(!near && !covered && derivative.uncertainty.is_some());
        self.uncertain += usize::from(derivative.uncertainty.is_none());
        self.worst = self.worst.max((error - known).max(0.0) / size);
    }

    /// Both together.
    pub fn with(self, other: &Tally) -> Tally {
        Tally {
            compared: self.compared + other.compared,
            near: self.near + other.near,
            covered: self.covered + other.covered,
            silent: self.silent + other.silent,
            uncertain: self.uncertain + other.uncertain,
            worst: self.worst.max(other.worst),
        }
    }
}

/// Compares one impact.
pub fn row(number: u32, posed: &Posed) -> Row {
    let found = posed.differentiate(TOLERANCE);
    let (contacts, end_s) = (found.solution.sub_impacts.len(), found.solution.end_s);
    let rebounds = found.solution.outcome == Outcome::Rebound;
    let mut row = Row { number, rebounds, contacts, lost: 0, unknown: 0, outputs: Default::default() };
    if !rebounds {
        return row;
    }
    let [velocities, times, impulses] = &mut row.outputs;
    let (speed, momentum) = (posed.striker.speed_m_s, posed.striker.mass_kg * posed.striker.speed_m_s);
    for (derivatives, reference) in found.derivatives.iter().zip(posed.in_32_digits(contacts, end_s)) {
        let Ok(derivatives) = derivatives else { continue };
        let Some(reference) = reference else {
            row.lost += 1;
            continue;
        };
        let [velocity, known] = reference.velocity;
        if known > CORRECT * velocity.abs().max(LEAST * speed) {
            row.unknown += 1;
            continue;
        }
        velocities.compare(derivatives.striker_velocity_m_s, reference.velocity, LEAST * speed);
        for (own, [start, end, impulse]) in derivatives.sub_impacts.iter().zip(&reference.intervals) {
            times.compare(own.start_s, *start, LEAST * end_s);
            times.compare(own.end_s, *end, LEAST * end_s);
            impulses.compare(own.impulse_n_s, *impulse, LEAST * momentum);
        }
    }
    row
}
