//! Contacts and flights, one after the other.

use super::contact::{Contact, Ending, Extent, Touch};
use super::history::History;
use super::kernel::Kernel;
use super::law::Scaled;
use super::problem::{NODES, S_RANGE, Settings, Structure};
use super::receptance::{Receptance, Scale, Term, UNIT};
use super::solution::{Flight, Outcome, Solution, SubImpact};
use crate::StopReason;
use crate::modal::Striker;
use contact_models::{ContactLaw, Hertz};
use invalid_input::InvalidInput;

/// Closing speeds up to this part of that of the impact are rounding, where the speed of the striker is one minus all impulses.
const SLOWEST: f64 = 1e-14;
/// The rounding of a compression, as a part of it. Two solutions may round alike, and an indentation that stays leaves the little
/// that is recovered with few digits: the force of the solution with which one is compared is that of a compression which is as
/// much larger. Errors up to 10 times the spacing of numbers were found.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Part of a contact's duration from which on the next touch is looked for.
const SOONEST: f64 = 1e-6;

/// Solves the impact of a striker on an infinite structure with any contact law. The solution is in the units of
/// [`Receptance::scale`]; its [`s`](Solution::s) is `None`, as a law other than Hertz's has no such number.
///
/// Whether a contact that lasts ever ends is known for Hertz contact only (see [`solve`]). Here it is computed for 300 times
/// the sum of its natural time, the relaxation time of its damping and, on a plate, the unit of time, and up to
/// [`horizon`](Settings::horizon), and the run then stops ([`StopReason::ContactLasts`]).
///
/// # Errors
/// [`InvalidInput`] if a setting, mass or speed is out of range.
///
/// ```
/// use contact_models::KelvinVoigt;
/// use vibroimpact_sim::infinite::{Outcome, Receptance, Settings, solve_law};
/// use vibroimpact_sim::modal::Striker;
///
/// // a 4.5 g ball on a 3 mm steel plate, by spring and dashpot
/// let plate = Receptance::plate(494.5, 23.4)?;
/// let ball = Striker { mass_kg: 4.5e-3, speed_m_s: 1.0 };
/// let law = KelvinVoigt::new(1e6, 10.0)?;
/// let solution = solve_law(&plate, &ball, &law, &Settings::default())?;
/// assert_eq!(solution.outcome, Outcome::Rebound);
/// assert!(solution.rebound_ratio().is_some_and(|e| (e - 0.7077).abs() < 1e-4));
/// # Ok::<(), vibroimpact_sim::InvalidInput>(())
/// ```
pub fn solve_law(
    receptance: &Receptance,
    striker: &Striker,
    law: &dyn ContactLaw,
    settings: &Settings,
) -> Result<Solution, InvalidInput> {
    settings.check()?;
    let scaled = Scaled { law, scale: receptance.scale(striker)?, rounding: 0.0 };
    Ok(solved(&Problem { receptance, law: &scaled, hertz: None }, settings))
}

/// Solves the impact for one value of `S` (within [`S_RANGE`]).
///
/// # Errors
/// [`InvalidInput`] if `s` or a setting is out of range.
pub fn solve(structure: Structure, s: f64, settings: &Settings) -> Result<Solution, InvalidInput> {
    settings.check()?;
    with_hertz(structure, s, |problem| solved(problem, settings))
}

/// What is struck, by what, and the number `S` of Hertz contact.
pub(super) struct Problem<'a> {
    receptance: &'a Receptance,
    law: &'a Scaled<'a>,
    hertz: Option<(Structure, f64)>,
}

impl Problem<'_> {
    fn kernel(&self, settings: &Settings) -> Kernel {
        Kernel::new(self.receptance, &self.law.scale, settings.nodes)
    }
}

/// The impact whose mass, speed and impulse response are 1, and whose Hertz stiffness is `sqrt(S)`.
fn with_hertz<R>(structure: Structure, s: f64, then: impl FnOnce(&Problem<'_>) -> R) -> Result<R, InvalidInput> {
    InvalidInput::unless(S_RANGE.contains(&s), "s", s, "a number from 1e-12 to 1e10")?;
    let power = match structure {
        Structure::Beam => 0.5,
        Structure::Plate => 0.0,
    };
    let receptance = Receptance::new(&[Term { coefficient: 1.0, power }])?;
    let law = Scaled { law: &Hertz::new(s.sqrt())?, scale: receptance.scale(&UNIT)?, rounding: 0.0 };
    Ok(then(&Problem { receptance: &receptance, law: &law, hertz: Some((structure, s)) }))
}

/// The solution, with an error estimate if that is wanted.
fn solved(problem: &Problem<'_>, settings: &Settings) -> Solution {
    let mut solution = run(problem, settings);
    if settings.estimate_uncertainty {
        let law = Scaled { rounding: ROUNDING, ..*problem.law };
        solution.compare(&run(&Problem { law: &law, ..*problem }, &other(settings)), settings.tolerance);
    }
    solution
}

/// The settings of the solution with which one is compared: four more nodes, or four fewer where more are not allowed, since
/// the same nodes at the smallest tolerance would repeat the solution to the last bit.
fn other(settings: &Settings) -> Settings {
    let more = settings.nodes + 4;
    let nodes = if NODES.contains(&more) { more } else { settings.nodes - 4 };
    Settings { nodes, tolerance: (0.1 * settings.tolerance).max(1e-14), ..*settings }
}

/// Solves once, without error estimate.
fn run(problem: &Problem<'_>, settings: &Settings) -> Solution {
    let Scale { displacement_m, .. } = problem.law.scale;
    let kernel = problem.kernel(settings);
    let (structure, s) = problem.hertz.unzip();
    let mut solution = Solution::empty(structure, s, settings.nodes);
    let (mut past, mut touch, mut body_travel) = (History::default(), Touch::first(), 0.0);
    loop {
        let mut contact = Contact::new(&kernel, problem.law, settings, touch, past);
        let budget = settings.max_panels.saturating_sub(solution.panels_tried);
        let ending = contact.run(Extent::new(problem.hertz, touch.time), budget);
        let (duration, travel) = (contact.now(), contact.body_travel());
        let end = touch.time + duration;
        solution.panels_tried += contact.trials;
        solution.known_until = end;
        let record = contact.record(body_travel);
        let mut sub_impact = SubImpact {
            start: touch.time,
            end: None,
            duration: None,
            closing_speed: touch.closing,
            striker_velocity_at_start: -touch.body,
            striker_velocity_at_end: None,
        };
        let memory = match ending {
            Ending::Released(memory) => memory,
            Ending::Ended(outcome) => {
                solution.push(sub_impact, record);
                solution.outcome = outcome;
                return solution;
            }
        };
        let (departure, behind) = contact.departure();
        sub_impact.end = Some(end);
        sub_impact.duration = Some(duration);
        sub_impact.striker_velocity_at_end = Some(-departure.body);
        solution.push(sub_impact, record);
        solution.outcome = Outcome::Rebound;
        body_travel += travel;
        let body = departure.body;
        let next = departure.next_touch(memory.touch_m / displacement_m, SOONEST * duration);
        let known = departure.is_known();
        solution.flights.push(Flight { start: end, body_travel, course: departure });
        if !known {
            solution.outcome = Outcome::Stopped(StopReason::DigitsExhausted);
            return solution;
        }
        // without a velocity that follows the force at once, and without an indentation that stays, slow contacts keep their digits
        let slowest = if kernel.instant() == 0.0 && memory.touch_m == 0.0 { 0.0 } else { SLOWEST };
        let rounding = next.is_some_and(|(_, closing)| closing.is_nan() || closing <= slowest);
        let Some((time, closing)) = solution.go_on(next, rounding, settings) else { return solution };
        body_travel += body * time;
        past = behind;
        past.rest(time);
        touch = Touch { time: end + time, closing, body, memory };
    }
}

/// The smooth function of `S` whose root is the `n`-th turning point: the minimum of the
/// compression that ends contact `n` or falls within it, over the largest compression in that
/// contact. `None` if there are fewer than `n` contacts, or the limit was reached.
pub(super) fn nth_minimum(s: f64, n: usize, settings: &Settings) -> Option<f64> {
    let following = |problem: &Problem<'_>| {
        let kernel = problem.kernel(settings);
        let (mut past, mut touch) = (History::default(), Touch::first());
        for _ in 1..n {
            let mut contact = Contact::new(&kernel, problem.law, settings, touch, past);
            let Ending::Released(memory) = contact.run(Extent::new(problem.hertz, touch.time), settings.max_panels)
            else {
                return None;
            };
            let duration = contact.now();
            let (departure, behind) = contact.departure();
            let (time, closing) = departure.next_touch(0.0, SOONEST * duration)?;
            past = behind;
            past.rest(time);
            touch = Touch { time: touch.time + duration + time, closing, body: departure.body, memory };
        }
        let mut contact = Contact::new(&kernel, problem.law, settings, touch, past);
        let ending = contact.run(Extent::new(problem.hertz, touch.time).until_minimum(), settings.max_panels);
        let largest = contact.turns.iter().map(|turn| turn.compression).fold(f64::MIN_POSITIVE, f64::max);
        let soonest = SOONEST * contact.now();
        let least = match ending {
            Ending::Released(_) => contact.departure().0.least_compression(soonest),
            Ending::Ended(_) => contact.first_minimum()?,
        };
        Some(least / largest)
    };
    with_hertz(Structure::Beam, s, following).ok()?
}

/// Speed of the body towards the beam after the first contact; `None` if it does not end.
pub(super) fn speed_after_first(s: f64, settings: &Settings) -> Option<f64> {
    let following = |problem: &Problem<'_>| {
        let kernel = problem.kernel(settings);
        let mut contact = Contact::new(&kernel, problem.law, settings, Touch::first(), History::default());
        let ending = contact.run(Extent::new(problem.hertz, 0.0), settings.max_panels);
        matches!(ending, Ending::Released(_)).then(|| contact.departure().0.body)
    };
    with_hertz(Structure::Beam, s, following).ok()?
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No solution is compared with itself.
    #[test]
    fn the_other_solution_is_another() {
        for nodes in NODES {
            let settings = Settings { nodes, tolerance: 1e-14, ..Settings::default() };
            let compared = other(&settings);
            assert!(compared.nodes != nodes && NODES.contains(&compared.nodes), "{nodes}");
        }
    }
}
