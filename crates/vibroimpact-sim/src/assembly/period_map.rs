//! The map `P` of the state over a period of the loads, by time integration, and its derivative `DP`.

use super::orbit_settings::OrbitSettings;
use super::period::CommonPeriod;
use super::problem::{Assembly, Force, Settings};
use super::solution::{Interval, Motion, Observer, Outcome, Run};
use super::solve::{Solver, run};
use contact_models::ContactLaw;
use invalid_input::InvalidInput;
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Step of finite differences, relative to the size of the motion.
const DIFFERENCE: f64 = 1e-5;
/// States are not compared within a shorter part of the period, as between two stops of which one opens where the other closes.
const LEAST_OPEN: f64 = 1e-9;

/// The map of the state over a period of the loads.
pub(crate) struct PeriodMap<'s, L> {
    pub stop: &'s dyn Fn() -> bool,
    pub assembly: Assembly<L>,
    settings: Settings,
    forcing_period_s: f64,
    /// Periods of the slowest load in it.
    pub cycles: u32,
    pub forcing_periods: u32,
    pub phase_s: f64,
}

pub(super) type Reached<T> = Result<Result<T, Outcome>, InvalidInput>;

impl<'s, L: ContactLaw + Clone> PeriodMap<'s, L> {
    pub fn new(
        assembly: Assembly<L>,
        settings: &OrbitSettings,
        stop: &'s dyn Fn() -> bool,
    ) -> Result<PeriodMap<'s, L>, InvalidInput> {
        assembly.check()?;
        let CommonPeriod { period_s: forcing_period_s, cycles } = CommonPeriod::of(&assembly.loads)?;
        if let Some(i) = assembly.loads.iter().position(|load| matches!(load.force, Force::Sampled { .. })) {
            let allowed = "a constant or harmonic load, because a sampled load is not periodic";
            return Err(InvalidInput::new(("loads", i), "a sampled load", allowed));
        }
        let mut runs = Settings::until(forcing_period_s * f64::from(settings.forcing_periods));
        runs.tolerance = settings.tolerance;
        runs.stop_at_rest = false;
        runs.check()?;
        let forcing_periods = settings.forcing_periods;
        Ok(PeriodMap { stop, assembly, settings: runs, forcing_period_s, cycles, forcing_periods, phase_s: 0.0 })
    }

    pub fn period_s(&self) -> f64 {
        self.settings.end_s
    }

    /// The same map with the states taken at another moment of the loads' period.
    pub fn at_phase(mut self, phase_s: f64) -> PeriodMap<'s, L> {
        self.set_phase(phase_s);
        self
    }

    fn set_phase(&mut self, phase_s: f64) {
        for load in &mut self.assembly.loads {
            if let Force::Harmonic { omega_rad_s, phase_rad, .. } = &mut load.force {
                *phase_rad += *omega_rad_s * (phase_s - self.phase_s);
            }
        }
        self.phase_s = phase_s;
    }

    fn posed(&self, state: &DVector<f64>) -> Assembly<L> {
        let mut assembly = self.assembly.clone();
        let n = state.len() / 2;
        let mut next = 0;
        for body in &mut assembly.bodies {
            for k in 0..body.modes.len() {
                (body.amplitude[k], body.rate[k]) = (state[next], state[n + next]);
                next += 1;
            }
        }
        assembly
    }

    fn state_of(amplitude: &[Vec<f64>], rate: &[Vec<f64>]) -> DVector<f64> {
        let values = amplitude.iter().chain(rate).flatten().copied();
        DVector::from_vec(values.collect())
    }

    pub fn run(&self, state: &DVector<f64>, end_s: f64, observer: &mut dyn Observer) -> Result<Run, InvalidInput> {
        let settings = Settings { end_s, ..self.settings };
        run(&self.posed(state), &settings, &mut Stoppable { stop: self.stop, observer })
    }

    pub fn follow(&self, state: &DVector<f64>, end_s: f64, observer: &mut dyn Observer) -> Reached<DVector<f64>> {
        let found = self.run(state, end_s, observer)?;
        Ok(match found.outcome {
            Outcome::End => Ok(Self::state_of(&found.amplitude, &found.rate)),
            other => Err(other),
        })
    }

    /// `P(x)`.
    pub fn apply(&self, state: &DVector<f64>) -> Reached<DVector<f64>> {
        self.follow(state, self.settings.end_s, &mut ())
    }

    /// The assembly's own start.
    pub fn start(&self) -> DVector<f64> {
        let of =
            |part: fn(&super::Body) -> &Vec<f64>| self.assembly.bodies.iter().map(part).cloned().collect::<Vec<_>>();
        Self::state_of(&of(|body| &body.amplitude), &of(|body| &body.rate))
    }

    /// Follows a state for some periods and moves the phase to the middle of the longest time without contact.
    pub fn transient(&mut self, mut state: DVector<f64>, periods: u32) -> Reached<DVector<f64>> {
        if periods > 0 {
            let span = f64::from(periods) * self.forcing_period_s;
            match self.follow(&state, span, &mut ())? {
                Ok(reached) => state = reached,
                Err(outcome) => return Ok(Err(outcome)),
            }
        }
        let all: BTreeSet<usize> = (0..self.assembly.contacts.len()).collect();
        let by = match self.to_opening(&state, &all)? {
            Ok(by) => by,
            Err(outcome) => return Ok(Err(outcome)),
        };
        self.turn(state, by)
    }

    /// The part of a period of the loads until the middle of the longest time at which these contacts are open; zero if there is none.
    pub fn to_opening(&self, state: &DVector<f64>, contacts: &BTreeSet<usize>) -> Reached<f64> {
        let mut closed = Closed { contacts, intervals: Vec::new() };
        let reached = self.follow(state, self.settings.end_s, &mut closed)?;
        Ok(reached.map(|_| closed.middle_of_longest_gap(self.settings.end_s) / self.forcing_period_s))
    }

    /// Follows a state for a part of a period of the loads, and moves the phase with it.
    pub fn turn(&mut self, state: DVector<f64>, part: f64) -> Reached<DVector<f64>> {
        if part <= 0.0 {
            return Ok(Ok(state));
        }
        let turned = self.follow(&state, part * self.forcing_period_s, &mut ())?;
        self.set_phase((self.phase_s + part * self.forcing_period_s) % self.forcing_period_s);
        Ok(turned)
    }

    /// Scales of the state: the largest rate for all rates, and the corresponding amplitude for each mode.
    pub fn scales(&self, state: &DVector<f64>, image: &DVector<f64>) -> DVector<f64> {
        let n = state.len() / 2;
        let omega: Vec<f64> =
            self.assembly.bodies.iter().flat_map(|body| body.modes.iter().map(|mode| mode.omega_rad_s)).collect();
        let base = TAU / self.forcing_period_s;
        let speed =
            |x: &DVector<f64>| (0..n).map(|k| x[n + k].abs().max(omega[k].max(base) * x[k].abs())).fold(0.0, f64::max);
        let speed = speed(state).max(speed(image)).max(1e-30);
        DVector::from_fn(2 * n, |i, _| if i < n { speed / omega[i].max(base) } else { speed })
    }

    pub fn distance(&self, difference: &DVector<f64>, scales: &DVector<f64>) -> f64 {
        difference.iter().zip(scales.iter()).map(|(d, scale)| (d / scale).abs()).fold(0.0, f64::max)
    }

    /// `DP`: the tangent of the motion, or, at a graze, where that does not exist, central differences.
    pub fn derivative(&self, state: &DVector<f64>, scales: &DVector<f64>) -> Reached<DMatrix<f64>> {
        let assembly = self.posed(state);
        match Solver::new(&assembly)?.monodromy(&self.settings)? {
            (Outcome::End, Ok(columns)) => Ok(Ok(DMatrix::from_fn(state.len(), state.len(), |i, j| columns[j][i]))),
            (Outcome::End, Err(_)) => self.differences(state, scales),
            (outcome, _) => Ok(Err(outcome)),
        }
    }

    fn differences(&self, state: &DVector<f64>, scales: &DVector<f64>) -> Reached<DMatrix<f64>> {
        let n = state.len();
        let mut jacobian = DMatrix::zeros(n, n);
        for i in 0..n {
            let step = DIFFERENCE * scales[i];
            let mut sides = [None, None];
            for (side, sign) in sides.iter_mut().zip([1.0, -1.0]) {
                let mut moved = state.clone();
                moved[i] += sign * step;
                match self.apply(&moved)? {
                    Ok(image) => *side = Some(image),
                    Err(outcome) => return Ok(Err(outcome)),
                }
            }
            if let [Some(above), Some(below)] = sides {
                jacobian.set_column(i, &((above - below) / (2.0 * step)));
            }
        }
        Ok(Ok(jacobian))
    }
}

/// An observer whose run can be stopped from outside.
struct Stoppable<'a> {
    stop: &'a dyn Fn() -> bool,
    observer: &'a mut dyn Observer,
}

impl Observer for Stoppable<'_> {
    fn interval(&mut self, contact: usize, interval: &Interval) {
        self.observer.interval(contact, interval);
    }

    fn panel(&mut self, panel: &dyn Motion) {
        self.observer.panel(panel);
    }

    fn wants_panels(&self) -> bool {
        self.observer.wants_panels()
    }

    fn interrupts(&mut self) -> bool {
        (self.stop)()
    }
}

/// When any of some contacts is closed.
struct Closed<'a> {
    contacts: &'a BTreeSet<usize>,
    intervals: Vec<(f64, f64)>,
}

impl Observer for Closed<'_> {
    fn interval(&mut self, contact: usize, interval: &Interval) {
        if self.contacts.contains(&contact) {
            self.intervals.push((interval.start_s, interval.end_s.unwrap_or(f64::INFINITY)));
        }
    }
}

impl Closed<'_> {
    fn middle_of_longest_gap(mut self, end_s: f64) -> f64 {
        self.intervals.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut open_since, mut best) = (0.0, (LEAST_OPEN * end_s, 0.0));
        for (start, end) in self.intervals.into_iter().chain([(end_s, end_s)]) {
            if start - open_since > best.0 {
                best = (start - open_since, 0.5 * (start + open_since));
            }
            open_since = f64::max(open_since, end);
        }
        best.1
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Body, BodyMode, Contact, Load, Point};
    use super::*;
    use contact_models::{Law, LinearSpring};

    /// Two bodies of two modes, a spring between them and one at the ground, two loads.
    fn rattling() -> Assembly<Law> {
        let body = |omega: f64| {
            let mode = |omega_rad_s: f64| BodyMode { omega_rad_s, damping_ratio: 0.03 };
            Body::at_rest(vec![mode(omega), mode(2.7 * omega)])
        };
        let point = |body: usize, first: f64| Point::OfBody { body, shape: vec![first, -0.7 * first] };
        let contacts = vec![
            Contact { sides: [point(0, 1.0), point(1, 1.2)], gap_m: 1e-3, law: LinearSpring::new(4e3).unwrap().into() },
            Contact { sides: [point(1, 1.2), Point::Ground], gap_m: 2e-3, law: LinearSpring::new(6e3).unwrap().into() },
        ];
        let load = |body: usize, force| Load { body, shape: vec![1.0, 0.5], force };
        let driving = Force::Harmonic { force_n: 3.0, omega_rad_s: 11.0, phase_rad: 0.2 };
        let loads = vec![load(0, driving), load(1, Force::Constant { force_n: -0.3 })];
        Assembly { bodies: vec![body(9.0), body(14.0)], contacts, loads }
    }

    #[test]
    fn the_tangent_of_a_period_is_that_of_differences() {
        let map =
            PeriodMap::new(rattling(), &OrbitSettings { tolerance: 1e-12, ..OrbitSettings::default() }, &|| false)
                .unwrap();
        let state = map.start();
        let mut closed = Closed { contacts: &BTreeSet::from([0, 1, 2]), intervals: Vec::new() };
        map.follow(&state, map.period_s(), &mut closed).unwrap().unwrap();
        assert!(closed.intervals.len() > 2, "{:?}", closed.intervals);
        let scales = map.scales(&state, &map.apply(&state).unwrap().unwrap());
        let exact = map.derivative(&state, &scales).unwrap().unwrap();
        let differences = map.differences(&state, &scales).unwrap().unwrap();
        let n = state.len();
        for i in 0..n {
            for j in 0..n {
                let error = (exact[(i, j)] - differences[(i, j)]).abs() * scales[j] / scales[i];
                assert!(error < 1e-4, "{i} {j}: {} {}", exact[(i, j)], differences[(i, j)]);
            }
        }
        // only the damping of the modes reduces the volume in the space of states; springs do not
        let damping: f64 =
            map.assembly.bodies.iter().flat_map(|body| &body.modes).map(|mode| 0.06 * mode.omega_rad_s).sum();
        let volume = (-damping * map.period_s()).exp();
        assert!((exact.determinant() / volume - 1.0).abs() < 1e-8, "{} {volume}", exact.determinant());
    }
}
