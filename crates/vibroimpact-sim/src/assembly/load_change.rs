//! Derivatives of the effect of loads with respect to a parameter.
//!
//! The motion under loads has a closed form ([`super::load`]). Under a harmonic load it is `Re(G e^{i Omega t})`, whose derivative at a
//! fixed time is `Re((dG + i t dOmega G) e^{i Omega t})`, with `dOmega` the slope through four neighbouring values of the parameter. `G` is
//! the quotient of the load on a mode and its dynamic stiffness, of which each has a slope, near resonance too. A slope of the motion itself
//! would be wrong at late times, when the neighbours are out of phase, and lost in rounding at early times, when the motion is small
//! compared with `G`. The motion under piecewise linear loads is simple enough for its slope through the neighbours. If the time itself
//! is shifted, the rate of the motion times the shift has to be added; the caller does so.

use super::load::{HarmonicLoad, Loads, stiffness, swept};
use super::problem::Posed;
use super::stencil::Stencil;
use super::system::{Link, Span, System};
use num_complex::Complex64;
use std::array;

/// The loads at four neighbouring values of a parameter.
#[derive(Clone)]
pub(crate) struct LoadChange {
    harmonics: Vec<HarmonicChange>,
    /// With the piecewise linear loads alone.
    neighbours: [(System, Loads); 4],
    stencil: Stencil<4>,
}

/// Harmonic loads of one frequency.
#[derive(Clone)]
struct HarmonicChange {
    omega_rad_s: f64,
    omega_change: f64,
    modes: Vec<Gain>,
    contacts: Vec<Gain>,
}

/// The steady motion `G` of a mode or an overlap, and its change.
#[derive(Clone, Copy)]
struct Gain {
    value: Complex64,
    change: Complex64,
}

/// Harmonic loads that have the same frequency at each neighbour.
struct NearHarmonics {
    omega_rad_s: [f64; 4],
    /// The forces on each mode, in the order of the system.
    modes: Vec<[Complex64; 4]>,
}

impl Gain {
    const ZERO: Gain = Gain { value: Complex64::ZERO, change: Complex64::ZERO };
}

impl HarmonicChange {
    /// The change of a motion, and the part of its rate by the change of the frequency.
    fn at(&self, gain: &Gain, time_s: f64) -> [Complex64; 2] {
        let turn = Complex64::cis(self.omega_rad_s * time_s);
        let drift = Complex64::i() * self.omega_change * gain.value * turn;
        [gain.change * turn + drift * time_s, drift]
    }

    /// The change of a motion and of its rate.
    fn motion(&self, gain: &Gain, time_s: f64) -> (f64, f64) {
        let [change, drift] = self.at(gain, time_s);
        (change.re, (drift + Complex64::i() * self.omega_rad_s * change).re)
    }

    /// The change of the motion from a time on, `h` seconds later, and of its rate then.
    fn moved(&self, gain: &Gain, time_s: f64, h: f64) -> (f64, f64) {
        let [change, drift] = self.at(gain, time_s);
        let swept = swept(self.omega_rad_s * h);
        let drift = drift * (1.0 + swept);
        let moved = change * swept + drift * h;
        (moved.re, (drift + Complex64::i() * self.omega_rad_s * (change + moved)).re)
    }
}

impl LoadChange {
    /// With the change of each contact's weights. `None` if there are no loads.
    pub fn new(system: &System, psi: &[Vec<Span>], posed: [&Posed; 4], stencil: Stencil<4>) -> Option<LoadChange> {
        if posed.iter().all(|posed| posed.loads.is_empty()) {
            return None;
        }
        let neighbours = posed.map(|posed| {
            let system = System::new(posed);
            let lines = posed.loads.iter().filter(|load| HarmonicLoad::of(load).is_none());
            let loads = Loads::new(lines, &system);
            (system, loads)
        });
        let mut change = LoadChange { harmonics: Vec::new(), neighbours, stencil };
        change.harmonics = harmonics(system, posed).iter().map(|near| change.harmonic(system, psi, near)).collect();
        Some(change)
    }

    fn harmonic(&self, system: &System, psi: &[Vec<Span>], near: &NearHarmonics) -> HarmonicChange {
        let omega = near.omega_rad_s;
        let omega_rad_s = self.stencil.value(omega);
        // `G = f/D`: near resonance the force and the dynamic stiffness of a mode are smooth where their quotient is not
        let gain = |place: usize, places: [usize; 4]| {
            let force = near.modes[place];
            if force == [Complex64::ZERO; 4] {
                // the frequency of a mode that is not excited may be that of the load
                return Gain::ZERO;
            }
            let near_stiffness = array::from_fn(|n| stiffness(&self.neighbours[n].0.modes[places[n]], omega[n]));
            let stiffness = stiffness(&system.modes[place], omega_rad_s);
            let value = by_parts(force, |values| self.stencil.value(values)) / stiffness;
            let slope = |values| by_parts(values, |values| self.stencil.slope(values));
            Gain { value, change: (slope(force) - value * slope(near_stiffness)) / stiffness }
        };
        let mut modes = vec![Gain::ZERO; system.modes.len()];
        for (body, places) in system.place.iter().enumerate() {
            for (k, &place) in places.iter().enumerate() {
                modes[place] = gain(place, array::from_fn(|n| self.neighbours[n].0.place[body][k]));
            }
        }
        // from the modes, so that their errors and those of the relative motion cancel
        let sum = |spans: &[Span], part: &dyn Fn(&Gain) -> Complex64| {
            let parts = spans.iter().flat_map(|span| modes[span.modes.clone()].iter().zip(&span.psi));
            parts.map(|(gain, psi)| part(gain) * *psi).sum::<Complex64>()
        };
        let contact = |(link, by): (&Link, &Vec<Span>)| Gain {
            value: sum(&link.spans, &|gain| gain.value),
            change: sum(&link.spans, &|gain| gain.change) + sum(by, &|gain| gain.value),
        };
        let contacts = system.links.iter().zip(psi).map(contact).collect();
        HarmonicChange { omega_rad_s, omega_change: self.stencil.slope(omega), modes, contacts }
    }

    fn slope(&self, of: impl Fn(&System, &Loads) -> f64) -> f64 {
        self.stencil.slope(self.neighbours.each_ref().map(|(system, loads)| of(system, loads)))
    }

    /// Whether breaks of the loads at hand coincide, or lie at the start, and do not at neighbouring values.
    pub fn splits(&self, loads: &Loads) -> bool {
        self.neighbours.iter().any(|(_, near)| near.break_count() != loads.break_count())
    }

    /// The changes of motions of all modes, in the order of a system with the same modes.
    fn of_modes(&self, system: &System, motions: &[(Vec<f64>, Vec<f64>); 4]) -> (Vec<f64>, Vec<f64>) {
        let [mut amplitude, mut rate] = [(); 2].map(|()| vec![0.0; system.modes.len()]);
        for (body, places) in system.place.iter().enumerate() {
            for (k, &place) in places.iter().enumerate() {
                let own: [usize; 4] = array::from_fn(|i| self.neighbours[i].0.place[body][k]);
                amplitude[place] = self.stencil.slope(array::from_fn(|i| motions[i].0[own[i]]));
                rate[place] = self.stencil.slope(array::from_fn(|i| motions[i].1[own[i]]));
            }
        }
        (amplitude, rate)
    }

    /// Changes of the steady motion.
    pub fn steady(&self, system: &System, time_s: f64) -> (Vec<f64>, Vec<f64>) {
        let motions = self.neighbours.each_ref().map(|(system, loads)| {
            let [mut amplitude, mut rate] = [(); 2].map(|()| vec![0.0; system.modes.len()]);
            loads.shift_modes(system, time_s, 1.0, &mut amplitude, &mut rate);
            (amplitude, rate)
        });
        let (mut amplitude, mut rate) = self.of_modes(system, &motions);
        for harmonic in &self.harmonics {
            for ((amplitude, rate), gain) in amplitude.iter_mut().zip(&mut rate).zip(&harmonic.modes) {
                let (change, faster) = harmonic.motion(gain, time_s);
                *amplitude += change;
                *rate += faster;
            }
        }
        (amplitude, rate)
    }

    /// Change of [`Loads::overlap`].
    pub fn overlap(&self, contact: usize, time_s: f64) -> [f64; 2] {
        let by_lines = |loads: &Loads| loads.overlap(contact, time_s);
        let (overlap, rate) =
            self.with_harmonics(by_lines, |harmonic| harmonic.motion(&harmonic.contacts[contact], time_s));
        [overlap, rate]
    }

    /// Change of [`Loads::moved`].
    pub fn moved(&self, contact: usize, time_s: f64, h: f64) -> (f64, f64) {
        let by_lines = |loads: &Loads| loads.moved(contact, time_s, h);
        self.with_harmonics(by_lines, |harmonic| harmonic.moved(&harmonic.contacts[contact], time_s, h))
    }

    /// Change of a motion and of its rate: the slope of that under the other loads, and those of the harmonic ones.
    fn with_harmonics(
        &self,
        of: impl Fn(&Loads) -> (f64, f64),
        by: impl Fn(&HarmonicChange) -> (f64, f64),
    ) -> (f64, f64) {
        let found = self.neighbours.each_ref().map(|(_, loads)| of(loads));
        let slopes = (self.stencil.slope(found.map(|pair| pair.0)), self.stencil.slope(found.map(|pair| pair.1)));
        self.harmonics.iter().map(by).fold(slopes, |sum, more| (sum.0 + more.0, sum.1 + more.1))
    }

    /// Change of the piecewise linear force on a rigid mode at `time_s`, and of its slope.
    pub fn line(&self, k: usize, system: &System, time_s: f64) -> (f64, f64) {
        let body = system.bodies.iter().position(|modes| modes.contains(&k)).unwrap_or_default();
        let number = system.place[body].iter().position(|place| *place == k).unwrap_or_default();
        let of = |part: fn((f64, f64)) -> f64| {
            self.slope(|system, loads| part(loads.line(system.place[body][number], time_s)))
        };
        (of(|pair| pair.0), of(|pair| pair.1))
    }

    /// Change of the time of the next break.
    pub fn next_break_s(&self) -> f64 {
        self.slope(|_, loads| loads.next_break_s())
    }

    /// Passes the break: the derivative of the jump of the relative motion.
    pub fn pass_break(&mut self, system: &System) -> (Vec<f64>, Vec<f64>) {
        let motions = self.neighbours.each_mut().map(|(system, loads)| {
            let [mut amplitude, mut rate] = [(); 2].map(|()| vec![0.0; system.modes.len()]);
            loads.pass_break(system, loads.next_break_s(), &mut amplitude, &mut rate);
            (amplitude, rate)
        });
        self.of_modes(system, &motions)
    }
}

/// A linear function of four numbers, of complex ones.
fn by_parts(values: [Complex64; 4], of: impl Fn([f64; 4]) -> f64) -> Complex64 {
    Complex64::new(of(values.map(|value| value.re)), of(values.map(|value| value.im)))
}

/// The harmonic loads of the neighbours. Two that differ in frequency at one of them alone stay apart.
fn harmonics(system: &System, posed: [&Posed; 4]) -> Vec<NearHarmonics> {
    let mut found: Vec<NearHarmonics> = Vec::new();
    let mut lists = posed.map(|posed| posed.loads.iter().filter_map(HarmonicLoad::of));
    while let [Some(a), Some(b), Some(c), Some(d)] = lists.each_mut().map(Iterator::next) {
        let near = [a, b, c, d];
        let omega_rad_s = near.map(|load| load.omega_rad_s);
        let at = found.iter().position(|one| one.omega_rad_s == omega_rad_s).unwrap_or(found.len());
        if at == found.len() {
            found.push(NearHarmonics { omega_rad_s, modes: vec![[Complex64::ZERO; 4]; system.modes.len()] });
        }
        for (k, &place) in system.place[a.body].iter().enumerate() {
            for (force, load) in found[at].modes[place].iter_mut().zip(near) {
                *force += load.phasor * load.shape[k];
            }
        }
    }
    found
}
