//! Periodic motions under harmonic loads.
//!
//! After `n` common periods of the loads the state `x = (a, b)` of all modes becomes `P(x)`, computed by time integration. A periodic
//! motion is a fixed point, found by Newton's method, `(DP - 1) dx = x - P(x)`. The eigenvalues of `DP` there are its Floquet
//! multipliers, and it is stable if none exceeds 1 in size. `DP` is the tangent of the motion, composed of its exact pieces
//! ([`Solver::differentiate`] computes the same for other parameters). At grazing contacts the map has no derivative. Central
//! differences then replace it, and Newton's method may fail to converge.
//!
//! The states are compared at a moment at which every contact is open, if there is one, or else every contact that turns out to have
//! internal variables, because those of a closed contact are not part of `x`. Neither is the indentation of an open one. If the motion
//! depends on either, a fixed point of the map is not a periodic motion ([`OrbitOutcome::Remembers`]).

use super::orbit_settings::OrbitSettings;
use super::period_map::PeriodMap;
#[cfg(doc)]
use super::problem::Assembly;
use super::solution::{Outcome, Reason};
#[cfg(doc)]
use super::solve::Solver;
use super::survey::{SideMotion, Survey};
use contact_models::ContactLaw;
use invalid_input::InvalidInput;
use nalgebra::{DMatrix, DVector};
use std::fmt;

/// Newton's method is given up after this many iterations in a row that hardly reduce the distance, by less than this factor.
const STALLED: u32 = 5;
const HARDLY: f64 = 0.9;
/// A motion counts as unstable if a multiplier exceeds 1 by more than this, which is the accuracy at grazing contacts.
const MARGINAL: f64 = 1e-6;

/// A periodic motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Orbit {
    /// Period of the motion (s), `forcing_periods` times that of the loads.
    pub period_s: f64,
    /// Common periods of the loads in it.
    pub forcing_periods: u32,
    /// The moment of the loads' period at which the state is given (s).
    pub phase_s: f64,
    /// The state then: amplitudes of all modes, body by body, then their rates.
    pub state: Vec<f64>,
    /// `|P(x) - x|`, relative to the size of the motion.
    pub closure: f64,
    /// Floquet multipliers, real and imaginary part, the largest first.
    pub floquet_multipliers: Vec<[f64; 2]>,
    /// Whether no multiplier lies outside the unit circle.
    pub stable: bool,
    /// Intervals of contact that begin within a period, contact by contact; 1 for a contact that stays closed.
    pub intervals_per_period: Vec<u64>,
    /// Motion of both sides of every contact.
    pub sides: Vec<[SideMotion; 2]>,
    /// Their displacements (m) at `phase_s` of each period of the loads, period by period and contact by contact.
    pub section_m: Vec<Vec<[f64; 2]>>,
    /// Newton iterations that led here.
    pub iterations: u32,
}

/// How nearly the motion from the start repeats itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recurrence {
    /// Periods of the loads after which it is nearest to an earlier state, up to 16.
    pub forcing_periods: u32,
    /// The distance from that state, relative to the size of the motion.
    pub distance: f64,
    /// Whether it repeats itself after so many periods from then on: it has converged to a periodic motion.
    pub has_converged: bool,
    /// Factor by which nearby motions separate in a period of the loads, on average over some periods after the search. Above 1 the
    /// motion is chaotic there; it may still converge later.
    pub separation_per_period: f64,
}

/// Outcome of the search for a periodic motion.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum OrbitOutcome {
    /// A periodic motion was found.
    Found(Box<Orbit>),
    /// Newton's method did not converge; this was the closest approach to a motion that repeats itself.
    NotFound {
        /// `|P(x) - x|`, relative to the size of the motion.
        closure: f64,
        /// The returns of the motion from the start, if it was followed in search of them.
        recurrence: Option<Recurrence>,
    },
    /// A motion was found that would repeat itself if this contact forgot all earlier motion once in each period. It does not
    /// ([`ContactEnd::remembers`](super::ContactEnd::remembers)): its surfaces keep an indentation, or its law has
    /// internal variables, and it is closed all the time, or whenever another one of this kind is open. The real motion differs.
    Remembers {
        /// Index of the contact in [`Assembly::contacts`], from 0.
        contact: usize,
    },
    /// A run of a period stopped before its end.
    Stopped(Outcome),
    /// The observer interrupted the search at this distance.
    Interrupted {
        /// `|P(x) - x|`, relative to the size of the motion.
        closure: f64,
        /// The state then, in the order of [`Orbit::state`].
        state: Vec<f64>,
    },
}

impl fmt::Display for OrbitOutcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            OrbitOutcome::Found(orbit) => write!(f, "found: a period of {} s", orbit.period_s),
            OrbitOutcome::NotFound { closure, .. } => {
                write!(f, "not found: the motion repeats itself to {closure:e} at best")
            }
            OrbitOutcome::Remembers { contact } => {
                write!(f, "not found: the motion depends on what contact {contact} keeps from earlier periods")
            }
            OrbitOutcome::Stopped(outcome) => write!(f, "a period did not end: {outcome}"),
            OrbitOutcome::Interrupted { closure, .. } => write!(f, "interrupted at a closure of {closure:e}"),
        }
    }
}

/// Newton's method from a state near an orbit.
pub(crate) fn refine<L: ContactLaw + Clone>(
    map: &PeriodMap<'_, L>,
    mut state: DVector<f64>,
    settings: &OrbitSettings,
) -> Result<OrbitOutcome, InvalidInput> {
    let mut image = match map.apply(&state)? {
        Ok(image) => image,
        Err(outcome) => return Ok(OrbitOutcome::Stopped(outcome)),
    };
    let (mut iterations, mut stalled, mut before) = (0, 0, f64::INFINITY);
    loop {
        let scales = map.scales(&state, &image);
        let closure = map.distance(&(&image - &state), &scales);
        let interrupted = || OrbitOutcome::Interrupted { closure, state: state.iter().copied().collect() };
        if (map.stop)() {
            return Ok(interrupted());
        }
        let jacobian = match map.derivative(&state, &scales)? {
            Ok(jacobian) => jacobian,
            Err(Outcome::Stopped(Reason::Interrupted)) => return Ok(interrupted()),
            Err(outcome) => return Ok(OrbitOutcome::Stopped(outcome)),
        };
        if closure <= settings.closure {
            return describe(map, state, closure, &jacobian, iterations);
        }
        stalled = if closure > HARDLY * before { stalled + 1 } else { 0 };
        before = closure;
        if iterations == settings.max_iterations || stalled == STALLED {
            return Ok(OrbitOutcome::NotFound { closure, recurrence: None });
        }
        iterations += 1;
        let matrix = &jacobian - DMatrix::identity(state.len(), state.len());
        let Some(step) = matrix.lu().solve(&(&state - &image)) else {
            return Ok(OrbitOutcome::NotFound { closure, recurrence: None });
        };
        // a full step, or a shorter one that reduces the distance
        let mut part = 1.0;
        let next = loop {
            if (map.stop)() {
                return Ok(interrupted());
            }
            let trial = &state + part * &step;
            if let Ok(after) = map.apply(&trial)?
                && (map.distance(&(&after - &trial), &scales) < closure || part < 1e-3)
            {
                break Some((trial, after));
            }
            part *= 0.5;
            if part < 1e-4 {
                break None;
            }
        };
        match next {
            Some((trial, after)) => (state, image) = (trial, after),
            None => return Ok(OrbitOutcome::NotFound { closure, recurrence: None }),
        }
    }
}

/// The orbit through a state, with all that is reported of it.
fn describe<L: ContactLaw + Clone>(
    map: &PeriodMap<'_, L>,
    state: DVector<f64>,
    closure: f64,
    jacobian: &DMatrix<f64>,
    iterations: u32,
) -> Result<OrbitOutcome, InvalidInput> {
    let periods = (map.forcing_periods as usize, map.cycles as usize);
    let mut survey = Survey::new(map.assembly.contacts.len(), periods, map.period_s());
    let period = map.run(&state, map.period_s(), &mut survey)?;
    if period.outcome != Outcome::End {
        return Ok(OrbitOutcome::Stopped(period.outcome));
    }
    if let Some(contact) = period.contacts.iter().position(|contact| contact.remembers) {
        return Ok(OrbitOutcome::Remembers { contact });
    }
    let eigenvalues = jacobian.complex_eigenvalues();
    let mut floquet_multipliers: Vec<[f64; 2]> = eigenvalues.iter().map(|value| [value.re, value.im]).collect();
    floquet_multipliers.sort_by(|a, b| b[0].hypot(b[1]).total_cmp(&a[0].hypot(a[1])));
    let stable = floquet_multipliers.iter().all(|value| value[0].hypot(value[1]) <= 1.0 + MARGINAL);
    let sides = survey.sides();
    Ok(OrbitOutcome::Found(Box::new(Orbit {
        period_s: map.period_s(),
        forcing_periods: map.forcing_periods,
        phase_s: map.phase_s,
        state: state.iter().copied().collect(),
        closure,
        floquet_multipliers,
        stable,
        intervals_per_period: survey.intervals,
        sides,
        section_m: survey.section_m,
        iterations,
    })))
}
