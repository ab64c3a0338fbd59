//! The BDF of variable order of `diffsol`, with its own root finding and an exact Jacobian, as in `work-precision`: for one
//! striker that touches a structure at rest.

use super::own::Single;
use super::{laws, sweep};
use crate::outcome::Outcome;
use crate::problem::Problem;
use work_precision::impact::{Flight, Impact, bdf, follow};
use work_precision::measure::Effort;

/// All runs.
pub(super) fn runs(problem: &Problem, effort: &Effort) -> Vec<Outcome> {
    let Some(Single { structure, striker, law }) = laws(problem).and_then(|laws| Single::of(problem, &laws)) else {
        return Vec::new();
    };
    let impact = Impact { name: "", about: "", structure, striker, law };
    sweep(problem, "diffsol, BDF", &effort.tolerances(4, 12), effort, |tolerance, deadline| {
        let (found, _) = follow(&impact, &mut bdf(tolerance), Flight::Integrated, problem.end_s, deadline)?;
        Ok(vec![found.restitution * striker.speed_m_s])
    })
}
