//! Models that do not resolve the motion in time: the rigid structure, and EMOC with its default parameters.

use super::sweep::{laws, sweep};
use crate::outcome::Outcome;
use crate::problem::{Family, Problem};
use emoc::{Impact, Parameters, Site};
use work_precision::measure::Effort;

/// All runs: one for each model, since they have no setting.
pub(super) fn runs(problem: &Problem, effort: &Effort) -> Vec<Outcome> {
    let [contact] = problem.contacts.as_slice() else { return Vec::new() };
    let named = |name: &Option<String>| Some(problem.body(name.as_deref()?).ok()?.1);
    let lower = named(&contact.lower);
    let Some((striker, mass_kg)) = named(&contact.upper).and_then(|body| Some((body, body.free_mass_kg()?))) else {
        return Vec::new();
    };
    let speed_m_s = -striker.at_point(&striker.rate);
    let at_ground = matches!(problem.family, Family::Law | Family::Restitution);
    if !(at_ground || problem.family == Family::Structure) || speed_m_s <= 0.0 {
        return Vec::new();
    }
    let rigid = sweep(problem, "vibroimpact, rigid", &[0.0], effort, |_, _| {
        if let Some(restitution) = problem.wanted_restitution() {
            return Ok(vec![restitution * speed_m_s]);
        }
        let law = *laws(problem).and_then(|laws| laws.first().copied()).as_ref().ok_or("no law")?;
        Ok(vec![speed_m_s * law.wall_restitution(mass_kg, speed_m_s).map_err(|error| error.to_string())?])
    });
    let emoc = lower.map(|structure| {
        sweep(problem, "vibroimpact, EMOC", &[0.0], effort, |_, _| {
            let text = |error: emoc::InvalidInput| error.to_string();
            let impact = Impact::new(mass_kg, &Site::new(&structure.shape).map_err(text)?).map_err(text)?;
            let found = Parameters::default().rebound(&impact).map_err(text)?;
            Ok(vec![speed_m_s * found.restitution])
        })
    });
    [rigid, emoc.unwrap_or_default()].concat()
}
