//! Contacts and flights, one after the other.

use super::contact::{Contact, Ending, Touch};
use super::kernel::Kernel;
use super::law::Scaled;
use crate::StopReason;
use crate::infinite::history::History;
use crate::infinite::problem::Settings;
use crate::infinite::receptance::{Receptance, Scale};
use crate::infinite::solution::{Course, Flight, Outcome, Solution, SubImpact};
use crate::infinite::solve::finer;
use crate::modal::Striker;
use contact_models::{ContactLaw, Memory};
use invalid_input::InvalidInput;

/// Closing speeds up to this part of that of the impact are rounding, where the speed of the striker is one minus all impulses.
const SLOWEST: f64 = 1e-14;

/// Solves the impact of a striker on an infinite structure with any contact law. The solution is in the units of
/// [`Receptance::scale`]; its [`s`](Solution::s) is `None`, as a law other than Hertz's has no such number.
///
/// Hertz contact with a beam or a plate is solved by [`solve`](crate::infinite::solve()) in a fraction of the time, and
/// that solver also detects sustained contact. Here a contact that lasts is computed for 300 of its natural times and up to
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
    let scaled = Scaled { law, scale: receptance.scale(striker)? };
    let mut solution = run(receptance, &scaled, settings);
    if settings.estimate_uncertainty {
        solution.compare(&run(receptance, &scaled, &finer(settings)), settings.tolerance);
    }
    Ok(solution)
}

/// Solves once, without error estimate.
fn run(receptance: &Receptance, law: &Scaled<'_>, settings: &Settings) -> Solution {
    let Scale { displacement_m, .. } = law.scale;
    let kernel = Kernel::new(receptance, &law.scale, settings.nodes);
    let mut solution = Solution::empty(None, None, settings.nodes);
    let mut history = History::default();
    let mut touch = Touch { time: 0.0, closing: 1.0, body: 1.0, memory: Memory::default() };
    let mut body_travel = 0.0;
    loop {
        let mut contact = Contact::new(&kernel, law, settings, touch, std::mem::take(&mut history));
        let ending = contact.run(settings.max_panels.saturating_sub(solution.panels_tried));
        solution.panels_tried += contact.trials;
        solution.panels += contact.pieces.len();
        let duration = contact.now;
        let end = touch.time + duration;
        solution.push_turns(touch.time, &contact.turns);
        let (pieces, peak_force) = (std::mem::take(&mut contact.pieces), contact.peak_force);
        let (departure, past) = contact.departure();
        let ended = matches!(ending, Ending::Released(_));
        let sub_impact = SubImpact {
            start: touch.time,
            end: ended.then_some(end),
            duration: ended.then_some(duration),
            closing_speed: touch.closing,
            striker_velocity_at_start: -touch.body,
            striker_velocity_at_end: ended.then_some(-departure.body),
        };
        solution.push_general(sub_impact, pieces, peak_force, body_travel);
        solution.known_until = end;
        let memory = match ending {
            Ending::Released(memory) => memory,
            Ending::Stopped(reason) => {
                solution.outcome = Outcome::Stopped(reason);
                return solution;
            }
        };
        solution.outcome = Outcome::Rebound;
        body_travel = solution.body_travel_at_end();
        let body = departure.body;
        let next = departure.next_touch(memory.touch_m / displacement_m, 1e-6 * duration);
        let opens = departure.rate < 0.0;
        solution.flights.push(Flight { start: end, body_travel, course: Course::General(departure) });
        if !opens {
            solution.outcome = Outcome::Stopped(StopReason::DigitsExhausted);
            return solution;
        }
        // without a velocity that follows the force at once, and without an indentation that stays, slow contacts keep their digits
        let slowest = if kernel.instant() == 0.0 && memory.touch_m == 0.0 { 0.0 } else { SLOWEST };
        let rounding = next.is_some_and(|(_, closing)| closing.is_nan() || closing <= slowest);
        let Some((time, closing)) = solution.go_on(next, rounding, settings) else { return solution };
        body_travel += body * time;
        history = past;
        history.rest(time);
        touch = Touch { time: end + time, closing, body, memory };
    }
}
