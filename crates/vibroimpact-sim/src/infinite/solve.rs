//! Contacts and flights, one after the other.

use super::contact::{Ending, March};
use super::history::History;
use super::problem::{S_RANGE, Settings, Structure};
use super::solution::{Course, Flight, Outcome, Solution, SubImpact};
use super::units::Touch;
use crate::StopReason;
use invalid_input::InvalidInput;

/// Solves the impact for one value of `S` (within [`S_RANGE`]).
///
/// # Errors
/// [`InvalidInput`] if `s` or a setting is out of range.
pub fn solve(structure: Structure, s: f64, settings: &Settings) -> Result<Solution, InvalidInput> {
    InvalidInput::unless(S_RANGE.contains(&s), "s", s, "a number from 1e-12 to 1e8")?;
    settings.check()?;
    let mut solution = run(structure, s, settings);
    if settings.estimate_uncertainty {
        solution.compare(&run(structure, s, &finer(settings)), settings.tolerance);
    }
    Ok(solution)
}

/// The settings of the solution with which one is compared.
pub(super) fn finer(settings: &Settings) -> Settings {
    Settings { nodes: (settings.nodes + 4).min(32), tolerance: (0.1 * settings.tolerance).max(1e-14), ..*settings }
}

/// Solves once, without error estimate.
pub(super) fn run(structure: Structure, s: f64, settings: &Settings) -> Solution {
    let mut solution = Solution::empty(Some(structure), Some(s), settings.nodes);
    let mut history = History::default();
    let mut touch = Touch { s, time: 0.0, closing: 1.0, body: 1.0 };
    let mut body_travel = 0.0;
    loop {
        let mut march = March::new(structure, settings, touch, std::mem::take(&mut history));
        let ending = march.run(false, settings.max_panels.saturating_sub(solution.panels_tried));
        solution.panels_tried += march.trials;
        solution.panels += march.pieces.len();
        let (duration, outcome) = match ending {
            Ending::Separated(duration) => (duration, Outcome::Rebound),
            Ending::Sustained(duration) => (duration, Outcome::Sustained),
            Ending::Minimum(_) => (0.0, Outcome::Stopped(StopReason::Steps)),
            Ending::Limit(duration) => (duration, Outcome::Stopped(StopReason::Steps)),
        };
        let ended = matches!(ending, Ending::Separated(_));
        let departure = march.departure();
        let body = departure.body;
        let end = touch.time + duration;
        solution.push_turns(touch.time, &march.turns);
        let contact = SubImpact {
            start: touch.time,
            end: ended.then_some(end),
            duration: ended.then_some(duration),
            closing_speed: touch.closing,
            striker_velocity_at_start: -touch.body,
            striker_velocity_at_end: ended.then_some(-body),
        };
        history = march.history;
        solution.push_contact(contact, march.units, march.pieces, body_travel);
        solution.known_until = end;
        solution.outcome = outcome;
        if !ended {
            return solution;
        }
        body_travel = solution.body_travel_at_end();
        let next = departure.next_contact();
        solution.flights.push(Flight { start: end, body_travel, course: Course::Hertz(departure) });
        let Some((time, closing)) = solution.go_on(next, false, settings) else { return solution };
        body_travel += body * time;
        history.rest(time);
        touch = Touch { s, time: end + time, closing, body };
    }
}

/// The smooth function of `S` whose root is the `n`-th turning point: the minimum of the
/// compression that ends contact `n` or falls within it, over the largest compression in that
/// contact. `None` if there are fewer than `n` contacts, or the limit was reached.
pub(super) fn nth_minimum(s: f64, n: usize, settings: &Settings) -> Option<f64> {
    let mut history = History::default();
    let mut touch = Touch { s, time: 0.0, closing: 1.0, body: 1.0 };
    for k in 1..=n {
        let mut march = March::new(Structure::Beam, settings, touch, std::mem::take(&mut history));
        let ending = march.run(k == n, settings.max_panels);
        let duration = match ending {
            Ending::Separated(duration) => duration,
            Ending::Minimum(minimum) if k == n => return Some(minimum / largest(&march)),
            _ => return None,
        };
        let departure = march.departure();
        if k == n {
            return Some(departure.least_compression() / largest(&march));
        }
        let (time, closing) = departure.next_contact()?;
        history = march.history;
        history.rest(time);
        touch = Touch { s, time: touch.time + duration + time, closing, body: departure.body };
    }
    None
}

/// Speed of the body towards the beam after the first contact; `None` if it does not end.
pub(super) fn speed_after_first(s: f64, settings: &Settings) -> Option<f64> {
    let touch = Touch { s, time: 0.0, closing: 1.0, body: 1.0 };
    let mut march = March::new(Structure::Beam, settings, touch, History::default());
    match march.run(false, settings.max_panels) {
        Ending::Separated(_) => Some(march.body_speed()),
        _ => None,
    }
}

fn largest(march: &March<'_>) -> f64 {
    march.turns.iter().map(|turn| turn.compression).fold(f64::MIN_POSITIVE, f64::max)
}
