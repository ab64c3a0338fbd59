//! The search for a periodic motion: Newton's method from where the start leads, then from near returns of a long motion.
//!
//! A motion that converges to a periodic one may need thousands of periods, and a chaotic one never converges. Both come near
//! periodic motions, stable or not, and then nearly repeat themselves. Of a long motion the states once in each period of the loads
//! are compared with those `n` periods later, and Newton's method begins at the nearest returns. The first stable motion that it finds
//! is the result, or else the first motion: which returns are nearest depends on rounding if the motion is chaotic.

use super::orbit::{OrbitOutcome, Recurrence, refine};
use super::orbit_settings::OrbitSettings;
use super::period_map::{PeriodMap, Reached};
use super::problem::Assembly;
use super::solution::{Motion, Observer, Outcome, Reason};
use contact_models::ContactLaw;
use invalid_input::InvalidInput;
use nalgebra::DVector;
use std::collections::BTreeSet;

/// Returns after up to this many periods are reported.
const MOST_PERIODS: usize = 16;
/// Number of near returns from which Newton's method begins.
const STARTS: usize = 32;
/// Tolerance of the long motion, which only yields first approximations.
const COARSE: f64 = 1e-6;
/// A motion has converged if it repeats itself to this share of its size over [`LAST`] periods.
const CONVERGED: f64 = 1e-4;
const LAST: usize = 16;
/// Distance of a nearby motion, relative to the size of the motion, and the periods over which it is followed.
const NEARBY: f64 = 1e-6;
const FOLLOWED: u32 = 100;

/// Finds a periodic motion near where a transient from the assembly's start leads.
///
/// # Errors
/// If the input is invalid, or if there is no harmonic load, or several whose frequencies are not multiples of one frequency.
pub fn find_orbit<L: ContactLaw + Clone>(
    assembly: &Assembly<L>,
    settings: &OrbitSettings,
) -> Result<OrbitOutcome, InvalidInput> {
    find_orbit_until(assembly, settings, &|| false)
}

/// As [`find_orbit`]; `stop` is called from time to time, and ends the search with its best result so far.
///
/// # Errors
/// As [`find_orbit`].
pub fn find_orbit_until<L: ContactLaw + Clone>(
    assembly: &Assembly<L>,
    settings: &OrbitSettings,
    stop: &dyn Fn() -> bool,
) -> Result<OrbitOutcome, InvalidInput> {
    settings.check()?;
    let start = PeriodMap::new(assembly.clone(), settings, stop)?.start();
    match from_start(assembly, settings, stop, start, settings.transient_periods)? {
        OrbitOutcome::NotFound { closure, .. } if settings.search_periods > 0 => {
            from_returns(assembly, settings, stop, closure)
        }
        found => Ok(found),
    }
}

/// Newton's method from where a state leads.
fn from_start<L: ContactLaw + Clone>(
    assembly: &Assembly<L>,
    settings: &OrbitSettings,
    stop: &dyn Fn() -> bool,
    start: DVector<f64>,
    transient_periods: u32,
) -> Result<OrbitOutcome, InvalidInput> {
    let mut map = PeriodMap::new(assembly.clone(), settings, stop)?;
    let mut state = match map.transient(start, transient_periods)? {
        Ok(state) => state,
        Err(outcome) => return Ok(OrbitOutcome::Stopped(outcome)),
    };
    let mut remembering = BTreeSet::new();
    loop {
        match refine(&map, state.clone(), settings)? {
            OrbitOutcome::Remembers { contact } if remembering.insert(contact) => {}
            found => return Ok(found),
        }
        let turned = match map.to_opening(&state, &remembering)? {
            Ok(part) => map.turn(state, part)?,
            Err(outcome) => Err(outcome),
        };
        match turned {
            Ok(turned) => state = turned,
            Err(outcome) => return Ok(OrbitOutcome::Stopped(outcome)),
        }
    }
}

/// Newton's method from the nearest returns of a long motion; `closure` is the best distance so far.
fn from_returns<L: ContactLaw + Clone>(
    assembly: &Assembly<L>,
    settings: &OrbitSettings,
    stop: &dyn Fn() -> bool,
    mut closure: f64,
) -> Result<OrbitOutcome, InvalidInput> {
    let of_one = OrbitSettings { forcing_periods: 1, ..*settings };
    let coarse = OrbitSettings { tolerance: settings.tolerance.max(COARSE), ..of_one };
    let map = PeriodMap::new(assembly.clone(), &coarse, stop)?;
    let stopped = |outcome: Outcome, closure: f64| match outcome {
        Outcome::Stopped(Reason::Interrupted) => {
            OrbitOutcome::Interrupted { closure, state: map.start().iter().copied().collect() }
        }
        other => OrbitOutcome::Stopped(other),
    };
    let section = match section(&map, settings)? {
        Ok(section) => section,
        Err(outcome) => return Ok(stopped(outcome, closure)),
    };
    let (mut unstable, mut remembers) = (None, None);
    for k in section.nearest_returns(settings.forcing_periods as usize) {
        match from_start(assembly, settings, stop, section.states[k].clone(), 0)? {
            OrbitOutcome::NotFound { closure: found, .. } => closure = closure.min(found),
            OrbitOutcome::Stopped(outcome) if outcome != Outcome::Stopped(Reason::Interrupted) => {}
            OrbitOutcome::Found(orbit) if !orbit.stable => unstable = unstable.or(Some(OrbitOutcome::Found(orbit))),
            OrbitOutcome::Remembers { contact } => remembers = remembers.or(Some(OrbitOutcome::Remembers { contact })),
            found => return Ok(found),
        }
    }
    if let Some(found) = unstable.or(remembers) {
        return Ok(found);
    }
    let map = PeriodMap::new(assembly.clone(), &of_one, stop)?;
    Ok(match section.separation(&map)? {
        Ok(separation) => OrbitOutcome::NotFound { closure, recurrence: section.recurrence(separation) },
        Err(outcome) => stopped(outcome, closure),
    })
}

/// The states of a long motion, once in each period of the loads, with their scales.
struct Section {
    states: Vec<DVector<f64>>,
    scales: DVector<f64>,
}

/// The section of the motion from the start, after its transient.
fn section<L: ContactLaw + Clone>(
    map: &PeriodMap<'_, L>,
    settings: &OrbitSettings,
) -> Result<Result<Section, Outcome>, InvalidInput> {
    let mut watch = Watch { period_s: map.period_s(), next: settings.transient_periods, states: Vec::new() };
    let periods = f64::from(settings.transient_periods) + f64::from(settings.search_periods);
    Ok(map.follow(&map.start(), periods * map.period_s(), &mut watch)?.map(|last| {
        let states: Vec<DVector<f64>> = watch.states.into_iter().chain([last]).collect();
        let scales = states.iter().map(|state| map.scales(state, state)).reduce(|one, other| one.sup(&other));
        Section { scales: scales.unwrap_or_default(), states }
    }))
}

/// Collects the states at multiples of a period.
struct Watch {
    period_s: f64,
    next: u32,
    states: Vec<DVector<f64>>,
}

impl Observer for Watch {
    fn panel(&mut self, panel: &dyn Motion) {
        while f64::from(self.next) * self.period_s < panel.end_s() {
            let (amplitude, rate) = panel.modes(f64::from(self.next) * self.period_s);
            self.states.push(DVector::from_vec([amplitude, rate].concat()));
            self.next += 1;
        }
    }

    fn wants_panels(&self) -> bool {
        true
    }
}

impl Section {
    /// Distance between two states, relative to the size of the motion.
    fn distance(&self, one: &DVector<f64>, other: &DVector<f64>) -> f64 {
        (one - other).component_div(&self.scales).amax()
    }

    /// Distances of all states from those `n` periods later.
    fn returns(&self, n: usize) -> Vec<f64> {
        let later = self.states.iter().skip(n);
        self.states.iter().zip(later).map(|(now, later)| self.distance(now, later)).collect()
    }

    /// The states that are nearest to those `n` periods later, the nearest first, no two of them within `n` periods.
    fn nearest_returns(&self, n: usize) -> Vec<usize> {
        let returns = self.returns(n);
        let mut order: Vec<usize> = (0..returns.len()).collect();
        order.sort_by(|&i, &j| returns[i].total_cmp(&returns[j]));
        let mut nearest: Vec<usize> = Vec::new();
        for k in order {
            if nearest.len() < STARTS && nearest.iter().all(|&other| k.abs_diff(other) >= n) {
                nearest.push(k);
            }
        }
        nearest
    }

    /// Factor by which a motion near the last state moves away from it in a period.
    fn separation<L: ContactLaw + Clone>(&self, map: &PeriodMap<'_, L>) -> Reached<f64> {
        let Some(mut state) = self.states.last().cloned() else { return Ok(Ok(1.0)) };
        let mut aside = NEARBY * &self.scales;
        let mut growth = 0.0;
        for period in 0..2 * FOLLOWED {
            let (next, beside) = match (map.apply(&state)?, map.apply(&(&state + &aside))?) {
                (Ok(next), Ok(beside)) => (next, beside),
                (Err(outcome), _) | (_, Err(outcome)) => return Ok(Err(outcome)),
            };
            let distance = self.distance(&next, &beside).max(f64::MIN_POSITIVE);
            // the first half turns the difference to the direction in which motions separate
            if period >= FOLLOWED {
                growth += (distance / NEARBY).ln();
            }
            aside = (beside - &next) * (NEARBY / distance);
            state = next;
        }
        Ok(Ok((growth / f64::from(FOLLOWED)).exp()))
    }

    fn recurrence(&self, separation_per_period: f64) -> Option<Recurrence> {
        let of = |n: usize| {
            let returns = self.returns(n);
            let last = returns.len().checked_sub(LAST)?;
            let has_converged = returns[last..].iter().all(|distance| *distance < CONVERGED);
            let distance = returns.into_iter().fold(f64::INFINITY, f64::min);
            Some(Recurrence { forcing_periods: n as u32, distance, has_converged, separation_per_period })
        };
        let all: Vec<Recurrence> = (1..=MOST_PERIODS).filter_map(of).collect();
        let converged = all.iter().find(|recurrence| recurrence.has_converged);
        converged.or_else(|| all.iter().min_by(|a, b| a.distance.total_cmp(&b.distance))).copied()
    }
}
