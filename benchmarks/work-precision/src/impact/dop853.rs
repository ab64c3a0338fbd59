//! The explicit eighth-order pair of Dormand and Prince (DOP853), the fastest general solver for these systems.
//!
//! Events: a sign change over a step is located by repeating the step with other lengths, which keeps the full order and saves
//! the three evaluations of dense output in every other step.

use super::definition::{Impact, Outcome};
use super::drive::{Flight, Integrator, follow};
use super::system::Equations;
use crate::measure::{Effort, Found, Origin, Row, Solver, sweep};
use ivp::dense::StepInterpolant;
use ivp::methods::{DOP853, Tolerance};
use ivp::prelude::{ControlFlag, FirstOrderSystem};
use ivp::solout::SolOut;
use ivp::status::Status;
use std::time::Instant;

struct Dop853 {
    tolerance: f64,
}

struct System<'a, 'b>(&'a Equations<'b>);

impl FirstOrderSystem for System<'_, '_> {
    fn derivative(&self, _: f64, y: &[f64], dy: &mut [f64]) {
        self.0.rates(y, dy);
    }
}

/// Checks for sign changes after every step, and stores the state before it.
struct Watch<'a, 'b> {
    equations: &'a Equations<'b>,
    before: (f64, Vec<f64>),
    now: (f64, Vec<f64>),
    met: bool,
    late: bool,
    deadline: Instant,
}

impl SolOut for Watch<'_, '_> {
    fn solout(&mut self, _: f64, x: &mut f64, y: &mut [f64], _: Option<&StepInterpolant<'_>>) -> ControlFlag {
        std::mem::swap(&mut self.before, &mut self.now);
        self.now.0 = *x;
        self.now.1.copy_from_slice(y);
        self.met = self.equations.margins(y).iter().any(|margin| *margin < 0.0);
        self.late = Instant::now() > self.deadline;
        if self.met || self.late { ControlFlag::Interrupt } else { ControlFlag::Continue }
    }
}

impl Dop853 {
    /// State after a single step of this length.
    fn step(&self, equations: &Equations<'_>, from: &[f64], length: f64, y: &mut [f64]) -> Result<(), String> {
        struct End<'c>(&'c mut [f64]);
        impl SolOut for End<'_> {
            fn solout(&mut self, _: f64, _: &mut f64, y: &mut [f64], _: Option<&StepInterpolant<'_>>) -> ControlFlag {
                self.0.copy_from_slice(y);
                ControlFlag::Continue
            }
        }
        let solver = DOP853 { first_step: Some(length), dense_output: false, ..DOP853::default() };
        // The step was accepted at its full length.
        let (rtol, atol) = (Tolerance::Scalar(0.0), Tolerance::Scalar(f64::MAX));
        let end = solver.solve(&System(equations), 0.0, from, length, rtol, atol, Some(&mut End(y)));
        end.map(|_| ()).map_err(|error| error.to_string())
    }

    /// Time within the step of `length` after `from` at which the first event function becomes negative, and its number.
    fn locate(
        &self,
        equations: &Equations<'_>,
        from: &[f64],
        length: f64,
        y: &mut [f64],
    ) -> Result<(f64, usize), String> {
        let margins = equations.margins(y);
        let mut first: Option<(f64, usize)> = None;
        for which in (0..2).filter(|&i| margins[i] < 0.0) {
            let (mut low, mut high) = (0.0, length);
            let (mut at_low, mut at_high) = (equations.margins(from)[which], margins[which]);
            if at_low <= 0.0 {
                // The function begins at zero, becomes positive and returns within one step.
                low = 1e-3 * length;
                self.step(equations, from, low, y)?;
                at_low = equations.margins(y)[which];
                if at_low <= 0.0 {
                    (low, high) = (0.0, 0.0);
                }
            }
            // Regula falsi with the Illinois rule.
            let mut side = 0;
            for _ in 0..60 {
                if high - low <= 1e-15 * length {
                    break;
                }
                let middle = (low * at_high - high * at_low) / (at_high - at_low);
                let middle = if middle > low && middle < high { middle } else { 0.5 * (low + high) };
                self.step(equations, from, middle, y)?;
                let value = equations.margins(y)[which];
                if value < 0.0 {
                    (high, at_high) = (middle, value);
                    at_low *= if side == 1 { 0.5 } else { 1.0 };
                    side = 1;
                } else {
                    (low, at_low) = (middle, value);
                    at_high *= if side == -1 { 0.5 } else { 1.0 };
                    side = -1;
                }
                if value.abs() < 1e-17 {
                    high = middle;
                    break;
                }
            }
            if first.is_none_or(|(time, _)| high < time) {
                first = Some((high, which));
            }
        }
        let (time, which) = first.ok_or("an event that is none")?;
        if time > 0.0 {
            self.step(equations, from, time, y)?;
        } else {
            y.copy_from_slice(from);
        }
        Ok((time, which))
    }
}

impl Integrator for Dop853 {
    fn advance(
        &mut self,
        equations: &Equations<'_>,
        t_s: &mut f64,
        y: &mut [f64],
        end_s: f64,
        deadline: Instant,
    ) -> Result<Option<usize>, String> {
        let solver = DOP853 {
            dense_output: false,
            max_steps: 10_000_000,
            // The test for stiffness would only stop the run.
            stiff_test: usize::MAX,
            first_step: equations.first_step(self.tolerance),
            ..DOP853::default()
        };
        let start = (0.0, y.to_vec());
        let mut watch = Watch { equations, before: start.clone(), now: start, met: false, late: false, deadline };
        let (rtol, atol) = (Tolerance::Scalar(0.0), Tolerance::Vector(equations.tolerances(self.tolerance)));
        // Time is counted from the start of the phase, so that short steps are not lost in it.
        let length = end_s - *t_s;
        let result = solver
            .solve(&System(equations), 0.0, &watch.now.1.clone(), length, rtol, atol, Some(&mut watch))
            .map_err(|error| error.to_string())?;
        if watch.late {
            return Err("too slow".into());
        }
        if watch.met {
            let (before, from) = watch.before;
            y.copy_from_slice(&watch.now.1);
            let (time, which) = self.locate(equations, &from, watch.now.0 - before, y)?;
            *t_s += before + time;
            return Ok(Some(which));
        }
        if result.status != Status::Success {
            return Err(format!("{:?}", result.status));
        }
        y.copy_from_slice(&watch.now.1);
        *t_s = end_s;
        Ok(None)
    }
}

/// The sweep of tolerances.
pub(super) fn rows(
    impact: &Impact,
    flight: Flight,
    end_s: f64,
    effort: &Effort,
    judge: impl Fn(Outcome, u64) -> Found,
) -> Vec<Row> {
    let (name, origin) = match flight {
        Flight::Integrated => ("DOP853", Origin::Peer),
        Flight::Exact => ("DOP853 + exact flight", Origin::Assisted),
    };
    let solver = Solver { name, origin, cost_unit: "right-hand sides" };
    sweep(impact.name, solver, &effort.tolerances(4, 15), effort, |tolerance| {
        let deadline = Instant::now() + effort.cap;
        follow(impact, &mut Dop853 { tolerance }, flight, end_s, deadline).map(|(outcome, cost)| judge(outcome, cost))
    })
}
