//! Energy minimisation under outward constraints for several contacts and a structure already vibrating.

use crate::engine::Engine;
use crate::scaled::Scaled;
use crate::{Outcome, Problem, Solution};
use alloc::vec;
use core::fmt;
use invalid_input::InvalidInput;

/// Why a contact problem has no solution to report.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum SolveError {
    /// The input is outside the model's range.
    Invalid(InvalidInput),
    /// The quadratic program's solver stopped without a solution, for numbers at the limits of its precision.
    Stopped(&'static str),
}

impl fmt::Display for SolveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SolveError::Invalid(error) => error.fmt(f),
            SolveError::Stopped(reason) => write!(f, "the quadratic program was not solved: {reason}"),
        }
    }
}

impl core::error::Error for SolveError {}

impl From<InvalidInput> for SolveError {
    fn from(error: InvalidInput) -> SolveError {
        SolveError::Invalid(error)
    }
}

/// Solves impacts at several contacts. Keep one for a sequence of impacts of the same kind (the same friction at
/// the same number of contacts, the same number of modes): it then starts from the rows that were active last
/// time, and while these stay the same, one factorisation replaces the iteration and proves the result. Where
/// they have changed too much, Clarabel runs with its ordering, symbolic factorisation and memory kept; an
/// interior-point iteration itself has no warm start. Solutions differ from those of a new solver by rounding, or
/// near the tolerance where no proof was reached; impulses that `W` leaves undetermined may differ.
#[derive(Default)]
pub struct Solver {
    emoc: Engine,
    least_energy: Engine,
}

impl fmt::Debug for Solver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Solver").finish_non_exhaustive()
    }
}

impl Solver {
    /// A solver with nothing to reuse yet.
    pub fn new() -> Solver {
        Solver::default()
    }

    /// Least kinetic energy under the outward constraints of each closing contact.
    ///
    /// The energy does not grow and no contact closes afterwards, whatever the coefficients: where the rebound
    /// demanded cannot be had, all demands are lowered together ([`Outcome::Relaxed`]).
    pub fn solve(&mut self, problem: &Problem) -> Result<Solution, SolveError> {
        problem.validate()?;
        let Some(scaled) = Scaled::new(problem)? else { return Ok(unchanged(problem)) };
        // what the least-energy impact attains is within reach whatever was demanded
        let reference = scaled.least_energy(&mut self.least_energy)?;
        let attained = scaled.attained(&reference);
        match scaled.attempt(&mut self.emoc, &attained, 1.0) {
            Ok(point) if scaled.admissible(&point) => return Ok(scaled.solution(Outcome::Solved, &point)),
            _ => {}
        }
        // The set of shares that can be met is an interval from 0, as rows and energy are convex: halve it.
        let (mut met, mut too_much) = (0.0, 1.0);
        let mut best = reference;
        for _ in 0..HALVINGS {
            let share = 0.5 * (met + too_much);
            match scaled.attempt(&mut self.emoc, &attained, share) {
                Ok(point) if scaled.admissible(&point) => (met, best) = (share, point),
                _ => too_much = share,
            }
        }
        Ok(scaled.solution(Outcome::Relaxed { share: met }, &best))
    }

    /// Todorov's impact (thesis 5.3): the least kinetic energy that impulses within the friction cones can
    /// reach, the modes taking the impulse at once. No rebound is demanded, and without friction there is none.
    pub fn least_energy(&mut self, problem: &Problem) -> Result<Solution, SolveError> {
        problem.validate()?;
        let Some(scaled) = Scaled::new(problem)? else { return Ok(unchanged(problem)) };
        let point = scaled.least_energy(&mut self.least_energy)?;
        Ok(scaled.solution(Outcome::Solved, &point))
    }
}

/// Halvings of the share: it is found to 1e-6.
const HALVINGS: usize = 20;

fn unchanged(problem: &Problem) -> Solution {
    let rates = problem.modes.iter().map(|mode| mode.rate).collect();
    problem.solution(Outcome::NoImpact, vec![0.0; problem.coordinates()], rates)
}
