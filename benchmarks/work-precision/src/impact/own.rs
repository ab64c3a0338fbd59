//! The workspace's own solver.

use super::definition::{Impact, Outcome};
use crate::measure::{Effort, Found, Origin, Row, Solver, sweep};
use vibroimpact_sim::modal::{self, Settings, Solution};

/// The result in terms of the norms.
pub(super) fn outcome(solution: &Solution) -> Result<Outcome, String> {
    Ok(Outcome {
        restitution: solution.restitution.ok_or_else(|| solution.outcome.as_str().to_string())?,
        contact_times_s: solution.sub_impacts.iter().flat_map(|contact| [contact.start_s, contact.end_s]).collect(),
        impulses_n_s: solution.sub_impacts.iter().map(|contact| contact.impulse_n_s).collect(),
    })
}

/// The sweep of tolerances: once with all tables built for every impact, once with the tables cached from the last one, as for
/// many impacts on one beam. No uncertainty is estimated, since no peer estimates one.
pub(super) fn rows(impact: &Impact, effort: &Effort, judge: impl Fn(Outcome, u64) -> Found) -> Vec<Row> {
    let cost_unit = "evaluations of the law";
    let settings = |tolerance| Settings { tolerance, estimate_uncertainty: false, ..Settings::default() };
    let tolerances = effort.tolerances(2, 13);
    let solve = |solver: &mut modal::Solver, tolerance: f64| {
        let solution = solver.solve(&impact.striker, &impact.law, None, &settings(tolerance));
        let solution = solution.map_err(|error| error.to_string())?;
        Ok(judge(outcome(&solution)?, solution.counts.law_evaluations))
    };
    let cold = Solver { name: "vibroimpact", origin: Origin::Own, cost_unit };
    let mut rows = sweep(impact.name, cold, &tolerances, effort, |tolerance| {
        solve(&mut modal::Solver::new(&impact.structure).map_err(|error| error.to_string())?, tolerance)
    });
    let Ok(mut kept) = modal::Solver::new(&impact.structure) else { return rows };
    let warm = Solver { name: "vibroimpact, tables kept", origin: Origin::Own, cost_unit };
    rows.extend(sweep(impact.name, warm, &tolerances, effort, |tolerance| solve(&mut kept, tolerance)));
    rows
}
