//! Evaluates a law along a prescribed motion.

use crate::quadrature::between_events;
use crate::range::LARGEST;
use crate::{After, Boundary, Branch, ContactLaw, Memory, boundaries};
use invalid_input::InvalidInput;

/// The contact at one instant of a prescribed motion.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct TracePoint {
    /// Time (s).
    pub time_s: f64,
    /// Compression `xi` (m), negative while the surfaces are separate.
    pub compression_m: f64,
    /// Rate of compression (m/s).
    pub rate_m_s: f64,
    /// Force (N).
    pub force_n: f64,
    /// Work (J) that the motion has done on the contact since the first time.
    pub work_j: f64,
    /// Energy (J) stored in the contact.
    pub stored_energy_j: f64,
}

/// Largest number of changes of branch between two neighbouring times. A law has few branches at one state; the limit only
/// excludes a law that changes them forever.
pub(crate) const MOST_EVENTS: usize = 32;

/// A contact during its motion.
#[derive(Clone, Copy)]
pub(crate) enum State {
    Apart(Memory),
    Touching(Branch),
}

impl State {
    /// Its branch while the surfaces are in contact.
    pub fn branch(&self) -> Option<Branch> {
        match self {
            State::Apart(_) => None,
            State::Touching(branch) => Some(*branch),
        }
    }

    /// The half planes within which the state is valid.
    pub fn boundaries(&self, law: &impl ContactLaw) -> Vec<Boundary> {
        match self {
            State::Apart(memory) => vec![Boundary::compression_rises_to(memory.touch_m)],
            State::Touching(branch) => boundaries(law, branch).collect(),
        }
    }

    pub fn next(&self, law: &impl ContactLaw, which: usize, (xi, rate): (f64, f64)) -> State {
        match self {
            State::Apart(memory) => State::Touching(law.touch(memory, rate.max(0.0))),
            State::Touching(branch) => match law.cross(branch, which, xi, rate) {
                After::Continue(branch) => State::Touching(branch),
                After::Release(memory) => State::Apart(memory),
            },
        }
    }

    fn force(&self, law: &impl ContactLaw, (xi, rate): (f64, f64)) -> f64 {
        match self {
            State::Apart(_) => 0.0,
            State::Touching(branch) => law.force(branch, xi, rate).force_n,
        }
    }
}

/// Evaluates a law along a prescribed motion, which gives compression (m) and its rate (m/s) at a time (s), from a fresh
/// surface. The result has a point at each of `times_s` and one just after each change of branch in between, located to
/// rounding.
///
/// Between two neighbouring times the motion should reach the end of a branch at most once, as it does if the times resolve its
/// oscillations. Work is integrated by a 12-point Gauss rule on each piece, with a substitution for forces that begin and end
/// as a power 3/2.
///
/// # Errors
/// Times that are not finite or do not increase, or a motion that is not within 1e30 of zero, the range of the laws.
///
/// ```
/// use contact_models::{LinearSpring, trace};
/// use std::f64::consts::PI;
///
/// // press a spring by 1 mm and let go
/// let times: Vec<f64> = (0..=100).map(|i| 0.01 * f64::from(i)).collect();
/// let press = |t: f64| (1e-3 * (PI * t).sin(), 1e-3 * PI * (PI * t).cos());
/// let path = trace(&LinearSpring::new(1e6)?, &times, press)?;
/// let peak = path.iter().find(|point| point.time_s == 0.5).unwrap();
/// assert!((peak.force_n - 1e3).abs() < 1e-9 && (peak.work_j - 0.5).abs() < 1e-12);
/// assert!(path.last().unwrap().work_j.abs() < 1e-12);
/// # Ok::<(), contact_models::InvalidInput>(())
/// ```
pub fn trace(
    law: &impl ContactLaw,
    times_s: &[f64],
    motion: impl Fn(f64) -> (f64, f64),
) -> Result<Vec<TracePoint>, InvalidInput> {
    let mut state = State::Apart(Memory::default());
    let mut work_j = 0.0;
    let mut path = Vec::with_capacity(times_s.len());
    let mut previous: Option<f64> = None;
    for &end in times_s {
        let increases = end.is_finite() && previous.is_none_or(|t| t < end);
        InvalidInput::unless(increases, "times_s", end, "finite and greater than the time before")?;
        let (xi, rate) = motion(end);
        for (field, value) in [("compression_m", xi), ("rate_m_s", rate)] {
            InvalidInput::unless(value.abs() <= LARGEST, field, value, "a number from -1e30 to 1e30 at every time")?;
        }
        let mut start = previous.unwrap_or(end);
        for _ in 0..MOST_EVENTS {
            let met = first_met(&state.boundaries(law), start, end, &motion);
            let stop = met.map_or(end, |(time, _)| time);
            work_j += between_events(start, stop, |t| {
                let (xi, rate) = motion(t);
                state.force(law, (xi, rate)) * rate
            });
            start = stop;
            let Some((time, which)) = met else { break };
            state = state.next(law, which, motion(time));
            if time < end {
                path.push(point(law, &state, time, motion(time), work_j));
            }
        }
        path.push(point(law, &state, end, (xi, rate), work_j));
        previous = Some(end);
    }
    Ok(path)
}

fn point(law: &impl ContactLaw, state: &State, time_s: f64, (xi, rate): (f64, f64), work_j: f64) -> TracePoint {
    let stored_energy_j = match state {
        State::Apart(_) => 0.0,
        State::Touching(branch) => law.stored_energy_j(branch, xi),
    };
    let force_n = state.force(law, (xi, rate));
    TracePoint { time_s, compression_m: xi, rate_m_s: rate, force_n, work_j, stored_energy_j }
}

/// The first time in the interval at which the motion is beyond a boundary, and which boundary.
pub(crate) fn first_met(
    boundaries: &[Boundary],
    start: f64,
    end: f64,
    motion: &impl Fn(f64) -> (f64, f64),
) -> Option<(f64, usize)> {
    let beyond = |boundary: &Boundary, t: f64| {
        let (xi, rate) = motion(t);
        boundary.margin(xi, rate) < 0.0
    };
    let mut met: Option<(f64, usize)> = None;
    for (which, boundary) in boundaries.iter().enumerate() {
        if !beyond(boundary, end) {
            continue;
        }
        let (mut low, mut high) = (start, if beyond(boundary, start) { start } else { end });
        // Located to the rounding of the interval.
        for _ in 0..54 {
            let middle = low + 0.5 * (high - low);
            *(if beyond(boundary, middle) { &mut high } else { &mut low }) = middle;
        }
        if met.is_none_or(|(earlier, _)| high < earlier) {
            met = Some((high, which));
        }
    }
    met
}
