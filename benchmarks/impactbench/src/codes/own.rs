//! The solvers of this workspace: the assembly, the single impact on a structure, and the infinite beam.

use super::sweep::{Answer, laws, sweep};
use crate::outcome::Outcome;
use crate::problem::{Body, Contact, Problem};
use crate::system::{answers, assembly as assembly_of};
use contact_models::{Law, LinearSpring, Wanted};
use vibroimpact_sim::assembly::{Outcome as End, Settings, run};
use vibroimpact_sim::{infinite, modal};
use work_precision::measure::Effort;

/// All runs.
pub(super) fn runs(problem: &Problem, effort: &Effort) -> Vec<Outcome> {
    let tolerances = effort.tolerances(1, 12);
    if let Some(s) = problem.infinite_beam_s {
        return sweep(problem, "vibroimpact, infinite beam", &tolerances, effort, |tolerance, _| {
            let settings =
                infinite::Settings { max_sub_impacts: 1, tolerance, estimate_uncertainty: false, ..Default::default() };
            let solution = infinite::solve(infinite::Structure::Beam, s, &settings).map_err(|e| e.to_string())?;
            Ok(vec![solution.first_rebound_ratio().ok_or("no separation")?])
        });
    }
    let Some(laws) = laws(problem).or_else(|| made_to_measure(problem)) else { return Vec::new() };
    let mut outcomes = sweep(problem, "vibroimpact, assembly", &tolerances, effort, |tolerance, _| {
        assembly(problem, &laws, tolerance)
    });
    if let Some(single) = Single::of(problem, &laws) {
        outcomes
            .extend(sweep(problem, "vibroimpact, modal", &tolerances, effort, |tolerance, _| single.solve(tolerance)));
    }
    outcomes
}

/// The assembly at a tolerance.
///
/// # Errors
/// The reason why it could not be solved.
pub fn assembly(problem: &Problem, laws: &[Law], tolerance: f64) -> Answer {
    let assembly = assembly_of(problem, laws)?;
    let settings = Settings { tolerance, stop_at_rest: false, ..Settings::until(problem.end_s) };
    let found = run(&assembly, &settings, &mut ()).map_err(|error| error.to_string())?;
    if let End::Stopped(reason) = found.outcome {
        return Err(reason.as_str().to_owned());
    }
    let y: Vec<f64> = found.amplitude.concat().into_iter().chain(found.rate.concat()).collect();
    answers(problem, &y)
}

/// A law with the requested restitution: that of Hunt and Crossley, so stiff that the contact is short; `None` below 0.001.
fn made_to_measure(problem: &Problem) -> Option<Vec<Law>> {
    let [ball] = problem.bodies.as_slice() else { return None };
    let (restitution, mass_kg) = (problem.wanted_restitution()?, ball.free_mass_kg()?);
    let speed_m_s = ball.at_point(&ball.rate).abs();
    let wanted = Wanted { restitution, mass_kg, speed_m_s, compression_m: 1e-5 * speed_m_s };
    if restitution == 1.0 {
        return LinearSpring::new(mass_kg * 1e10).ok().map(|law| vec![law.into()]);
    }
    wanted.hunt_crossley(1.5).ok().map(|law| vec![law.into()])
}

/// One striker that touches a structure at rest.
pub(super) struct Single {
    pub structure: modal::Structure,
    pub striker: modal::Striker,
    pub law: Law,
}

impl Single {
    pub fn of(problem: &Problem, laws: &[Law]) -> Option<Single> {
        let ([law], [contact]) = (laws, problem.contacts.as_slice()) else { return None };
        let Contact { upper: Some(upper), upper_shape: None, lower, lower_shape: None, gap_m: 0.0, .. } = contact
        else {
            return None;
        };
        let named = |name: &String| Some(problem.body(name).ok()?.1);
        let striker = named(upper)?;
        let still = |body: &&Body| body.rate.iter().chain(&body.amplitude).all(|value| *value == 0.0);
        let modes = match lower {
            Some(name) => named(name).filter(still)?,
            None => &Body { omega_rad_s: vec![], damping_ratio: vec![], shape: vec![], ..striker.clone() },
        };
        let asked = problem.quantities.iter().all(|quantity| quantity.body == *upper && quantity.shape.is_none());
        let stated = asked
            && problem.loads.is_empty()
            && problem.gravity_m_s2 == 0.0
            && striker.amplitude.iter().all(|a| *a == 0.0);
        let mass_kg = striker.free_mass_kg().filter(|_| stated && problem.bodies.len() <= 2)?;
        let mode = |((&omega_rad_s, &damping_ratio), &shape)| modal::Mode { omega_rad_s, damping_ratio, shape };
        let modes = modes.omega_rad_s.iter().zip(&modes.damping_ratio).zip(&modes.shape).map(mode).collect();
        Some(Single {
            structure: modal::Structure { modes },
            striker: modal::Striker { mass_kg, speed_m_s: -striker.at_point(&striker.rate) },
            law: *law,
        })
    }

    fn solve(&self, tolerance: f64) -> Answer {
        let text = |error: vibroimpact_sim::InvalidInput| error.to_string();
        let settings = modal::Settings { tolerance, estimate_uncertainty: false, ..Default::default() };
        let solver = modal::Solver::new(&self.structure).map_err(text)?;
        let found = solver.solve(&self.striker, &self.law, None, &settings).map_err(text)?;
        Ok(vec![found.striker_velocity_m_s])
    }
}
