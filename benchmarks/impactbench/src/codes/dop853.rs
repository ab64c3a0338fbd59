//! The explicit eighth-order pair of Dormand and Prince with its dense output: a general solver that integrates the equations
//! phase by phase and locates the events itself.

use super::phases::{End, Phase, follow};
use super::sweep::{Answer, TOO_SLOW, laws, sweep};
use crate::outcome::Outcome;
use crate::problem::Problem;
use contact_models::Law;
use ivp::dense::StepInterpolant;
use ivp::methods::{DOP853, Tolerance};
use ivp::prelude::{ControlFlag, FirstOrderSystem};
use ivp::solout::SolOut;
use std::convert::Infallible;
use std::time::Instant;
use work_precision::measure::Effort;

/// All runs.
pub(super) fn runs(problem: &Problem, effort: &Effort) -> Vec<Outcome> {
    let Some(laws) = laws(problem).filter(|laws| !laws.is_empty()) else { return Vec::new() };
    sweep(problem, "DOP853", &effort.tolerances(4, 14), effort, |tolerance, deadline| {
        solve(problem, &laws, tolerance, deadline)
    })
}

/// The result at a tolerance.
///
/// # Errors
/// The reason why it could not continue.
pub fn solve(problem: &Problem, laws: &[Law], tolerance: f64, deadline: Instant) -> Answer {
    follow(problem, laws, tolerance, |phase, tolerances, y| {
        let mut watch = Watch { phase, end: (0.0, None), y: y.to_vec(), late: false, deadline };
        let solver = DOP853 {
            dense_output: true,
            max_steps: 10_000_000,
            stiff_test: usize::MAX,
            first_step: phase.first_step_s(tolerance),
            ..DOP853::default()
        };
        let (rtol, atol) = (Tolerance::Scalar(0.0), Tolerance::Vector(tolerances.to_vec()));
        // Time is counted from the start of the phase, so that short steps are not lost in it.
        let found = solver.solve(phase, 0.0, y, phase.left_s, rtol, atol, Some(&mut watch));
        let status = found.map_err(|error| error.to_string())?.status;
        if !status.is_success() {
            return Err(format!("{status:?}"));
        }
        if watch.late {
            return Err(TOO_SLOW.into());
        }
        y.copy_from_slice(&watch.y);
        Ok(watch.end)
    })
}

impl FirstOrderSystem for Phase<'_> {
    fn derivative(&self, time_s: f64, y: &[f64], dy: &mut [f64]) {
        self.derivative(time_s, y, dy);
    }
}

/// Searches each step for the first end of the phase.
struct Watch<'a> {
    phase: &'a Phase<'a>,
    end: End,
    y: Vec<f64>,
    late: bool,
    deadline: Instant,
}

impl SolOut for Watch<'_> {
    fn solout(
        &mut self,
        before: f64,
        x: &mut f64,
        y: &mut [f64],
        interpolant: Option<&StepInterpolant<'_>>,
    ) -> ControlFlag {
        self.late = Instant::now() > self.deadline;
        self.end = (*x, None);
        self.y.copy_from_slice(y);
        if let Some(interpolant) = interpolant {
            let at = |time_s: f64, inside: &mut [f64]| {
                interpolant.interpolate(time_s, inside);
                Ok::<_, Infallible>(())
            };
            if let Ok(Some(end)) = self.phase.first_end((before, *x), y, at) {
                self.end = end;
                interpolant.interpolate(end.0, &mut self.y);
            }
        }
        if self.end.1.is_some() || self.late { ControlFlag::Interrupt } else { ControlFlag::Continue }
    }
}
