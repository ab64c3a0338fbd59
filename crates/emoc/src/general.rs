//! Energy minimisation under outward constraints for several contacts and a structure that vibrates already.

use crate::engine::Engine;
use crate::scaled::Scaled;
use crate::{Outcome, Problem, Solution};
use alloc::vec;
use core::fmt;
use invalid_input::InvalidInput;

/// The reason why a contact problem has no solution.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum SolveError {
    /// The input is outside the range of the model.
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

/// Solves impacts at several contacts. Reuse one solver for a sequence of impacts of the same kind (the same friction at the
/// same number of contacts, the same number of modes): it then starts from the rows that were active last time, and while these
/// stay the same, one factorisation replaces the iteration and proves the result. If they have changed too much, Clarabel runs
/// and reuses its ordering, symbolic factorisation and memory; an interior-point iteration itself has no warm start. Solutions
/// differ from those of a new solver by rounding, or, if no proof was reached, by about the tolerance; impulses that `W` does
/// not determine may differ.
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
    /// The energy does not grow and no contact closes afterwards, for any coefficients: if the demanded rebound cannot be
    /// reached, all demands are lowered together ([`Outcome::Relaxed`]).
    ///
    /// # Errors
    /// [`SolveError::Invalid`] as [`Problem::validate`], and [`SolveError::Stopped`] if the quadratic program of the least
    /// energy cannot be solved in double precision.
    pub fn solve(&mut self, problem: &Problem) -> Result<Solution, SolveError> {
        problem.validate()?;
        let Some(scaled) = Scaled::new(problem)? else { return Ok(unchanged(problem)) };
        // The result of the least-energy impact is always feasible.
        let reference = scaled.least_energy(&mut self.least_energy)?;
        let attained = scaled.attained(&reference);
        if let Some(point) = scaled.attempt(&mut self.emoc, &attained, 1.0) {
            return Ok(scaled.solution(Outcome::Solved, &point));
        }
        // The set of feasible shares is an interval from 0, since rows and energy are convex, and is found by bisection.
        let (mut met, mut too_much) = (0.0, 1.0);
        let mut best = reference;
        for _ in 0..HALVINGS {
            let share = 0.5 * (met + too_much);
            match scaled.attempt(&mut self.emoc, &attained, share) {
                Some(point) => (met, best) = (share, point),
                None => too_much = share,
            }
        }
        // The first attempt had no active rows of a neighbour to begin with, and may have stopped for that.
        if too_much == 1.0
            && let Some(point) = scaled.attempt(&mut self.emoc, &attained, 1.0)
        {
            return Ok(scaled.solution(Outcome::Solved, &point));
        }
        Ok(scaled.solution(Outcome::Relaxed { share: met }, &best))
    }

    /// Todorov's impact (thesis 5.3): the minimum of the kinetic energy over impulses within the friction cones, where the
    /// modes take up the impulse instantaneously. No rebound is demanded, and without friction there is none.
    ///
    /// # Errors
    /// As [`Solver::solve`].
    pub fn least_energy(&mut self, problem: &Problem) -> Result<Solution, SolveError> {
        problem.validate()?;
        let Some(scaled) = Scaled::new(problem)? else { return Ok(unchanged(problem)) };
        let point = scaled.least_energy(&mut self.least_energy)?;
        Ok(scaled.solution(Outcome::Solved, &point))
    }
}

/// Number of bisections of the share, which is found to 1e-6.
const HALVINGS: usize = 20;

fn unchanged(problem: &Problem) -> Solution {
    problem.solution(Outcome::NoImpact, vec![0.0; problem.coordinates()], &vec![0.0; problem.modes.len()])
}
