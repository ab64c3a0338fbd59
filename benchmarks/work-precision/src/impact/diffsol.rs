//! The implicit solvers of `diffsol`, variable-order BDF and ESDIRK, with its own root finding and our Jacobian.

use super::definition::{Impact, Outcome};
use super::drive::{Flight, Integrator, follow};
use super::system::Equations;
use crate::measure::{Effort, Found, Origin, Row, Solver, sweep};
use diffsol::{
    DiffsolError, NalgebraLU, NalgebraMat, OdeBuilder, OdeEquationsImplicit, OdeSolverMethod, OdeSolverStopReason,
    Vector,
};
use std::time::Instant;

type Matrix = NalgebraMat<f64>;
type Linear = NalgebraLU<f64>;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Formula {
    Bdf,
    Esdirk34,
}

struct Diffsol {
    formula: Formula,
    tolerance: f64,
}

/// Steps until an event or the end; returns the event.
fn run<'a, E, S>(mut solver: S, t: &mut f64, y: &mut [f64], deadline: Instant) -> Result<Option<usize>, String>
where
    E: OdeEquationsImplicit<M = Matrix, T = f64, V = <Matrix as diffsol::MatrixCommon>::V> + 'a,
    S: OdeSolverMethod<'a, E>,
{
    let text = |error: DiffsolError| error.to_string();
    loop {
        match solver.step().map_err(text)? {
            OdeSolverStopReason::InternalTimestep => {
                if Instant::now() > deadline {
                    return Err("too slow".into());
                }
            }
            OdeSolverStopReason::RootFound(time, which) => {
                y.copy_from_slice(&solver.interpolate(time).map_err(text)?.clone_as_vec());
                *t = time;
                return Ok(Some(which));
            }
            OdeSolverStopReason::TstopReached => {
                y.copy_from_slice(&solver.state().y.clone_as_vec());
                *t = solver.state().t;
                return Ok(None);
            }
        }
    }
}

impl Integrator for Diffsol {
    fn advance(
        &mut self,
        equations: &Equations<'_>,
        t_s: &mut f64,
        y: &mut [f64],
        end_s: f64,
        deadline: Instant,
    ) -> Result<Option<usize>, String> {
        let start = y.to_vec();
        let n = equations.len();
        let problem = OdeBuilder::<Matrix>::new()
            .rtol(1e-14)
            .atol(equations.tolerances(self.tolerance))
            .h0(equations.first_step(self.tolerance).unwrap_or(1e-7))
            .rhs_implicit(
                |x: &[f64], _p: &[f64], _t: f64, dy: &mut [f64]| equations.rates(x, dy),
                |x: &[f64], _p: &[f64], _t: f64, v: &[f64], jv: &mut [f64]| equations.jacobian_times(x, v, jv),
            )
            .init(|_p: &[f64], _t: f64, x: &mut [f64]| x.copy_from_slice(&start), n)
            .root(|x: &[f64], _p: &[f64], _t: f64, g: &mut [f64]| g.copy_from_slice(&equations.margins(x)), 2)
            .build()
            .map_err(|error| error.to_string())?;
        // Time is counted from the start of the phase, so that short steps are not lost in it.
        let mut elapsed = 0.0;
        let end = end_s - *t_s;
        let text = |error: DiffsolError| error.to_string();
        let met = match self.formula {
            Formula::Bdf => {
                let mut solver = problem.bdf::<Linear>().map_err(text)?;
                solver.set_stop_time(end).map_err(text)?;
                run(solver, &mut elapsed, y, deadline)?
            }
            Formula::Esdirk34 => {
                let mut solver = problem.esdirk34::<Linear>().map_err(text)?;
                solver.set_stop_time(end).map_err(text)?;
                run(solver, &mut elapsed, y, deadline)?
            }
        };
        *t_s += elapsed;
        Ok(met)
    }
}

/// The sweeps of tolerances of both formulas.
pub(super) fn rows(
    impact: &Impact,
    flight: Flight,
    end_s: f64,
    effort: &Effort,
    judge: impl Fn(Outcome, u64) -> Found,
) -> Vec<Row> {
    let mut rows = Vec::new();
    // Free flight with all modes takes an implicit solver seconds, so that there are fewer settings.
    let tolerances: Vec<f64> = match flight {
        Flight::Integrated => effort.tolerances(3, 12).into_iter().step_by(if effort.quick { 1 } else { 3 }).collect(),
        Flight::Exact => effort.tolerances(4, 13),
    };
    for (formula, names) in [
        (Formula::Bdf, ["diffsol BDF", "diffsol BDF + exact flight"]),
        (Formula::Esdirk34, ["diffsol ESDIRK34", "diffsol ESDIRK34 + exact flight"]),
    ] {
        let (name, origin) = match flight {
            Flight::Integrated => (names[0], Origin::Peer),
            Flight::Exact => (names[1], Origin::Assisted),
        };
        let solver = Solver { name, origin, cost_unit: "right-hand sides" };
        rows.extend(sweep(impact.name, solver, &tolerances, effort, |tolerance| {
            let deadline = Instant::now() + effort.cap;
            follow(impact, &mut Diffsol { formula, tolerance }, flight, end_s, deadline)
                .map(|(outcome, cost)| judge(outcome, cost))
        }));
    }
    rows
}
