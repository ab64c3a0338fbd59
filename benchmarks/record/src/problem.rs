//! A problem of the record: the work that is run, the result that is expected, and the cost.

use std::hint::black_box;
use tasks::Failure;

/// Results of a run, and the costs that the solver itself counts.
pub struct Found {
    /// Results, each of which is compared with its reference.
    pub values: Vec<f64>,
    /// Names and counts of steps, iterations or evaluations. Empty if the solver counts nothing.
    pub costs: Vec<(&'static str, u64)>,
}

/// The work of a problem, which returns numbers.
type Run<T> = Box<dyn Fn() -> Result<T, Failure>>;

/// Where the true results come from.
pub enum Reference {
    /// Known in closed form, or to more digits than doubles hold.
    Exact(Vec<f64>),
    /// Computed once by a tighter run and kept in a file, so that a change of the solver cannot move it.
    Tighter(Run<Vec<f64>>),
}

/// A problem with fixed settings.
pub struct Problem {
    /// `solver/problem/settings`.
    pub name: String,
    /// Errors up to this size are due to rounding and count as zero.
    pub rounding: f64,
    /// The work that is measured.
    pub run: Run<Found>,
    /// The expected results.
    pub reference: Reference,
}

impl Problem {
    /// A problem whose results are known.
    pub fn exact(
        name: impl Into<String>,
        values: Vec<f64>,
        run: impl Fn() -> Result<Found, Failure> + 'static,
    ) -> Problem {
        Problem { name: name.into(), rounding: ROUNDING, run: Box::new(run), reference: Reference::Exact(values) }
    }

    /// A problem whose reference results come from a run of the same solver with a tighter tolerance.
    pub fn against_tighter(
        name: impl Into<String>,
        tighter: impl Fn() -> Result<Vec<f64>, Failure> + 'static,
        run: impl Fn() -> Result<Found, Failure> + 'static,
    ) -> Problem {
        let reference = Reference::Tighter(Box::new(tighter));
        Problem { name: name.into(), rounding: ROUNDING, run: Box::new(run), reference }
    }

    /// The same, where the problem amplifies rounding.
    pub fn rounding(self, rounding: f64) -> Problem {
        Problem { rounding, ..self }
    }
}

/// Rounding error of a well-conditioned result.
const ROUNDING: f64 = 1e-13;

/// The largest error of the values: relative where the reference is above one in size, absolute below.
pub fn error(values: &[f64], reference: &[f64]) -> Result<f64, Failure> {
    if values.len() != reference.len() {
        return Err(format!("{} values where the reference has {}", values.len(), reference.len()).into());
    }
    let errors = values.iter().zip(reference).map(|(v, r)| (v - r).abs() / r.abs().max(1.0));
    match errors.reduce(f64::max) {
        Some(error) if values.iter().all(|v| v.is_finite()) => Ok(error),
        _ => Err(format!("a value that is not finite, or none at all: {values:?}").into()),
    }
}

/// Runs the problem. This function is never inlined, so that callgrind can count its instructions by name.
#[inline(never)]
pub fn measured_problem(problem: &Problem) -> Result<Found, Failure> {
    black_box((problem.run)())
}
