//! Solves one case and checks conditions that hold for every impact.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

use contact_models::Law;
use emoc::{SingleImpact, Solver as NetSolver};
use vibroimpact::Scene;
use vibroimpact_sim::StopReason;
use vibroimpact_sim::infinite;
use vibroimpact_sim::modal::{Outcome, Settings, Solution, Solver, Start};

use super::cases::{Case, Modal};

/// Seconds after which an impact counts as hung, on a machine that is busy with others.
const HANG_S: f64 = 60.0;
/// Largest number of solutions of one impact: the impact itself, and up to three for its uncertainty.
const MOST_SOLUTIONS: u64 = 4;
/// Rounding error of the sum of the energies, relative to the sum.
const ROUNDING: f64 = 1e-11;

/// Result of one case.
#[derive(Debug, Clone)]
pub struct Verdict {
    pub kind: &'static str,
    pub outcome: &'static str,
    pub contacts: usize,
    /// Steps or panels tried, as a deterministic cost.
    pub steps: u64,
    /// Gain of energy relative to the initial energy; negative for a loss.
    pub energy_gain: f64,
    /// Gain of energy relative to the gain that the tolerance allows.
    pub gain_over_allowed: f64,
    /// For impacts without dissipation: change of the energy relative to the change that the tolerance allows.
    pub residual_over_allowed: f64,
    /// If it was computed: error of the restitution relative to the stated uncertainty.
    pub error_over_stated: f64,
    pub seconds: f64,
    /// The conditions that are violated.
    pub fault: Option<String>,
}

/// Solves and checks a case.
pub fn judge(case: &Case) -> Verdict {
    let start = Instant::now();
    let kind = match case {
        Case::Modal(_) => "modal",
        Case::Rod(_) | Case::Refused(_) => "rod",
        Case::Scene(_) => "scene",
        Case::Infinite(..) => "infinite",
        Case::Net(_) => "net",
        Case::Single(..) => "single",
    };
    let empty = Verdict {
        kind,
        outcome: "failed",
        contacts: 0,
        steps: 0,
        energy_gain: f64::NEG_INFINITY,
        gain_over_allowed: f64::NEG_INFINITY,
        residual_over_allowed: f64::NEG_INFINITY,
        error_over_stated: f64::NEG_INFINITY,
        seconds: 0.0,
        fault: None,
    };
    let solved = catch_unwind(AssertUnwindSafe(|| {
        let mut verdict = empty.clone();
        verdict.fault = match case {
            Case::Modal(modal) | Case::Rod(modal) => modal_impact(modal, &mut verdict),
            Case::Refused(why) => Err(format!("a sound impact was refused: {why}")),
            Case::Scene(tree) => scene(tree, &mut verdict),
            Case::Infinite(structure, s) => infinite_impact(*structure, *s, &mut verdict),
            Case::Net(problem) => net(problem, &mut verdict),
            Case::Single(phi, coefficients) => single(phi, *coefficients, &mut verdict),
        }
        .err();
        verdict
    }));
    let mut verdict = solved.unwrap_or_else(|payload| {
        let text = payload.downcast_ref::<String>().map(String::as_str).or(payload.downcast_ref::<&str>().copied());
        Verdict { fault: Some(format!("panic: {}", text.unwrap_or("without a message"))), ..empty }
    });
    verdict.seconds = start.elapsed().as_secs_f64();
    if verdict.seconds > HANG_S && verdict.fault.is_none() {
        verdict.fault = Some(format!("took {:.0} s", verdict.seconds));
    }
    verdict
}

/// Notes a complaint unless `holds`.
fn check(holds: bool, fault: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(fault()) }
}

fn finite(name: &str, values: impl IntoIterator<Item = f64>) -> Result<(), String> {
    values.into_iter().try_for_each(|value| check(value.is_finite(), || format!("{name} = {value}")))
}

fn scene(tree: &serde_json::Value, verdict: &mut Verdict) -> Result<(), String> {
    verdict.outcome = "refused";
    let scene = Scene::from_json(&tree.to_string()).map_err(|fault| format!("a sound scene was refused: {fault}"))?;
    // values can be invalid in combination (contrasts of segments, a striker on an immovable point)
    let Ok(impact) = scene.impact() else { return Ok(()) };
    let settings = Settings { max_steps: 2_000, max_sub_impacts: 500, ..impact.settings };
    let modal = Modal { structure: impact.structure, striker: impact.striker, law: impact.law, start: None, settings };
    modal_impact(&modal, verdict)
}

fn modal_impact(case: &Modal, verdict: &mut Verdict) -> Result<(), String> {
    let Modal { structure, striker, law, start, settings } = case;
    verdict.outcome = "refused";
    let refused = |fault| format!("a sound impact was refused: {fault}");
    let solver = Solver::new(structure).map_err(refused)?;
    let solution = solver.solve(striker, law, start.as_ref(), settings).map_err(refused)?;
    verdict.outcome = solution.outcome.stopped_by().map_or(solution.outcome.as_str(), StopReason::as_str);
    verdict.contacts = solution.sub_impacts.len();
    let counts = solution.counts;
    verdict.steps = counts.steps();
    // each solution stops at the limits on its contacts and on its flights
    check(verdict.steps <= MOST_SOLUTIONS * (2 * settings.max_steps + 4), || format!("{} steps", verdict.steps))?;
    sound_numbers(&solution)?;
    contacts_in_order(&solution)?;
    energy(case, &solution, verdict)?;
    // one in sixteen, selected by its values, so that the sequence of cases does not change
    if solution.outcome == Outcome::Rebound && settings.tolerance.to_bits() % 16 == 0 {
        let tighter = Settings { tolerance: (1e-3 * settings.tolerance).max(1e-13), max_steps: 20_000, ..*settings };
        let reference = solver.solve(striker, law, start.as_ref(), &tighter).map_err(refused)?;
        if let (Outcome::Rebound, Some(e), Some(stated), Some(f)) =
            (reference.outcome, solution.restitution, solution.restitution_uncertainty, reference.restitution)
        {
            let known = stated + reference.restitution_uncertainty.unwrap_or(0.0);
            verdict.error_over_stated = if e == f { 0.0 } else { (e - f).abs() / known };
        }
    }
    Ok(())
}

fn sound_numbers(solution: &Solution) -> Result<(), String> {
    finite("amplitude", solution.amplitude.iter().copied())?;
    finite("rate", solution.rate.iter().copied())?;
    finite("striker_velocity_m_s", [solution.striker_velocity_m_s])?;
    finite("end_s", [solution.end_s])?;
    finite("restitution", solution.restitution)?;
    finite("restitution_uncertainty", solution.restitution_uncertainty)?;
    check(solution.restitution_uncertainty.is_none_or(|value| value >= 0.0), || "a negative uncertainty".into())?;
    let touched = solution.outcome != Outcome::NoContact || solution.sub_impacts.is_empty();
    check(touched, || "contacts without contact".into())
}

fn contacts_in_order(solution: &Solution) -> Result<(), String> {
    let mut now = 0.0;
    for (i, contact) in solution.sub_impacts.iter().enumerate() {
        let told = [contact.impulse_n_s, contact.peak_force_n, contact.peak_compression_m];
        finite(&format!("contact {i}"), told)?;
        let ordered = contact.start_s >= now && contact.end_s >= contact.start_s && contact.end_s <= solution.end_s;
        check(ordered, || format!("contact {i} from {} to {} after {now}", contact.start_s, contact.end_s))?;
        now = contact.end_s;
    }
    Ok(())
}

fn energy(case: &Modal, solution: &Solution, verdict: &mut Verdict) -> Result<(), String> {
    let Modal { structure, striker, law, start, settings } = case;
    let at_rest = Start::at_rest(structure.modes.len());
    let start = start.as_ref().unwrap_or(&at_rest);
    let modes = |amplitude: &[f64], rate: &[f64]| -> f64 {
        let each = structure.modes.iter().zip(amplitude).zip(rate);
        each.map(|((mode, a), b)| 0.5 * (mode.omega_rad_s * a).powi(2) + 0.5 * b * b).sum()
    };
    // a surface that cannot move cannot release energy
    let kinetic = |speed: f64| if speed == 0.0 { 0.0 } else { 0.5 * striker.mass_kg * speed * speed };
    let before = kinetic(striker.speed_m_s) + modes(&start.amplitude, &start.rate);
    let after = kinetic(solution.striker_velocity_m_s) + modes(&solution.amplitude, &solution.rate);
    // The error of each impulse should be below `tolerance` times the momentum P of the approach. An error d does work
    // on surfaces that move with v, and moves them by d sum phi^2 itself.
    let excited = structure.modes.iter().zip(&start.rate).zip(&start.amplitude);
    let surface: f64 = excited.map(|((mode, b), a)| (mode.shape * (b.abs() + mode.omega_rad_s * a.abs())).abs()).sum();
    let mobility = |rigid_only: bool| -> f64 {
        let modes = structure.modes.iter().filter(|mode| mode.omega_rad_s == 0.0 || !rigid_only);
        striker.mass_kg.recip() + modes.map(|mode| mode.shape * mode.shape).sum::<f64>()
    };
    let speed = striker.speed_m_s.abs() + surface;
    let mut contacts = 1.0 + solution.sub_impacts.len() as f64;
    if matches!(solution.outcome, Outcome::Stopped(_)) {
        // a contact that was abandoned after thousands of steps may have an error of a tenth of the tolerance per step
        contacts += 0.1 * solution.counts.contact_steps as f64;
    }
    let wrong = settings.tolerance * speed / mobility(true) * contacts;
    let allowed = wrong * (speed + wrong * mobility(false)) + ROUNDING * before;
    verdict.energy_gain = if before > 0.0 { after / before - 1.0 } else { 0.0 };
    verdict.gain_over_allowed = if allowed > 0.0 { (after - before) / allowed } else { 0.0 };
    check(after - before <= allowed, || format!("energy from {before:e} J to {after:e} J"))?;
    let elastic = matches!(law, Law::Hertz(_) | Law::LinearSpring(_) | Law::Power(_));
    let undamped = structure.modes.iter().all(|mode| mode.damping_ratio == 0.0);
    if elastic && undamped && solution.outcome == Outcome::Rebound {
        verdict.residual_over_allowed = if allowed > 0.0 { (after - before).abs() / allowed } else { 0.0 };
        check(before - after <= allowed, || format!("energy lost without a cause, from {before:e} J to {after:e} J"))?;
    }
    for (i, contact) in solution.sub_impacts.iter().enumerate() {
        // a force is never negative, but the sign of an impulse below the tolerance is not determined
        let impulse = contact.impulse_n_s;
        check(impulse >= -wrong, || format!("contact {i} pulls with {impulse:e} N s"))?;
    }
    if let (Some(e), true) = (solution.restitution, start == &at_rest) {
        // energy of the relative motion, which may be a small part of the total energy
        let excess = 1.0 + settings.tolerance * contacts + ROUNDING;
        check(e.abs() <= excess, || format!("restitution {e}"))?;
    }
    Ok(())
}

fn infinite_impact(structure: infinite::Structure, s: f64, verdict: &mut Verdict) -> Result<(), String> {
    verdict.outcome = "refused";
    let settings = infinite::Settings { max_panels: 500, ..infinite::Settings::default() };
    let solved = infinite::solve(structure, s.clamp(1e-12, 1e8), &settings);
    let solution = solved.map_err(|fault| format!("a sound S was refused: {fault}"))?;
    verdict.outcome = solution.outcome.stopped_by().map_or(solution.outcome.as_str(), StopReason::as_str);
    verdict.contacts = solution.sub_impacts.len();
    verdict.steps = solution.panels_tried as u64;
    check(solution.panels_tried <= settings.max_panels + 1_000, || format!("{} panels", solution.panels_tried))?;
    let (mut now, mut speed) = (0.0, 1.0);
    for (i, contact) in solution.sub_impacts.iter().enumerate() {
        finite(&format!("contact {i}"), [contact.start, contact.closing_speed, contact.striker_velocity_at_start])?;
        finite(
            &format!("contact {i}"),
            contact.end.into_iter().chain(contact.duration).chain(contact.striker_velocity_at_end),
        )?;
        let ordered = contact.start >= now && contact.closing_speed > 0.0 && contact.duration.is_none_or(|d| d > 0.0);
        check(ordered, || format!("{contact:?} after {now}"))?;
        // a compressive force can only slow the body down
        let slower = contact.striker_velocity_at_end.map_or(speed, |velocity| -velocity);
        check(slower <= speed && slower >= -1.0, || format!("body speed from {speed} to {slower}"))?;
        (now, speed) = (contact.end.unwrap_or(now), slower);
    }
    verdict.energy_gain = speed * speed - 1.0;
    check(solution.rebound_ratio().is_none_or(|e| (0.0..=1.0).contains(&e)), || "rebound beyond 0 to 1".into())?;
    check(solution.relative_uncertainty.is_none_or(|error| error >= 0.0), || {
        format!("error {:?}", solution.relative_uncertainty)
    })
}

/// Compares the closed form with the quadratic program in two unknowns.
fn single(phi: &[f64], coefficients: emoc::Coefficients<f64>, verdict: &mut Verdict) -> Result<(), String> {
    verdict.outcome = "refused";
    let impact = SingleImpact { mass_kg: 1.0, phi, coefficients };
    let z: f64 = phi.iter().map(|phi| phi * phi).sum();
    let rebound = coefficients.rebound(z).map_err(|fault| format!("sound coefficients were refused: {fault}"))?;
    let emoc::Coefficients { ebar, .. } = coefficients;
    let e = rebound.restitution;
    verdict.energy_gain = e * e + rebound.modal_energy_fraction(z) - 1.0;
    check((0.0..=ebar).contains(&e), || format!("restitution {e} of {ebar}"))?;
    check(verdict.energy_gain <= 1e-12, || format!("energy grows by {:e}", verdict.energy_gain))?;
    verdict.outcome = match impact.solve_reduced() {
        Ok(found) => {
            check((found.restitution - e).abs() < 1e-6, || {
                format!("{} by the program, {e} in closed form", found.restitution)
            })?;
            "solved"
        }
        Err(emoc::SolveError::Stopped(_)) => "stopped",
        Err(fault) => return Err(format!("a sound program was refused: {fault}")),
    };
    Ok(())
}

fn net(problem: &emoc::Problem, verdict: &mut Verdict) -> Result<(), String> {
    let mut solver = NetSolver::new();
    verdict.outcome = "refused";
    let solution = match solver.solve(problem) {
        Ok(solution) => solution,
        Err(emoc::SolveError::Stopped(_)) => {
            verdict.outcome = "stopped";
            return Ok(());
        }
        Err(fault) => return Err(format!("a sound problem was refused: {fault}")),
    };
    verdict.outcome = match solution.outcome {
        emoc::Outcome::NoImpact => "no contact",
        emoc::Outcome::Solved => "solved",
        _ => "relaxed",
    };
    verdict.contacts = problem.contacts.len();
    finite("impulse", solution.impulse_n_s.iter().copied())?;
    finite("modal rate", solution.modal_rate.iter().copied())?;
    // impulses on wedged bodies may be large and cancel each other, and the rounding error grows with them
    let weight = problem.inverse_inertia_per_kg.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
    let pressing = weight * solution.impulse_n_s.iter().fold(0.0_f64, |m, p| m.max(p.abs()));
    let vibration: f64 = problem.modes.iter().map(|mode| mode.rate * mode.rate).sum();
    let allowed = (1e-8 + 1e-10 * pressing) * (vibration + 1.0 / weight.max(1e-300));
    verdict.energy_gain = solution.energy_change_j * weight;
    verdict.gain_over_allowed = solution.energy_change_j / allowed;
    check(solution.energy_change_j <= allowed, || format!("energy grows by {:e} J", solution.energy_change_j))?;
    for &i in &problem.normals() {
        let opening = solution.opening_m_s[i];
        let closes = solution.outcome != emoc::Outcome::NoImpact && opening < -1e-7 - 1e-9 * pressing;
        check(!closes, || format!("contact coordinate {i} closes at {opening:e} m/s"))?;
    }
    Ok(())
}
