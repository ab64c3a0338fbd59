//! Effect of loads on modes and contacts, in closed form.
//!
//! - Constant and sampled loads are linear in time until the next break: `f_k(t) = f0_k + f1_k (t - t0)`. An elastic mode moves
//!   about `f_k/omega_k^2 - 2 zeta_k f1_k/omega_k^3`, which is linear too, and is computed relative to it. The motion of a rigid
//!   mode is not split: over `h` seconds the load moves it by `f h^2/2 + f1 h^3/6`.
//! - Under a harmonic load each mode, and therefore each contact, follows one sinusoid, `Re(G e^{i Omega t})` with
//!   `G_k = -i e^{i phase} f_k / (omega_k^2 - Omega^2 + 2 i zeta_k omega_k Omega)`; modes are computed relative to it.
//!
//! The relative motion of an elastic mode is therefore free. The effect of the loads on a contact is a cubic and some sinusoids.

use super::problem::{Force, Load};
use super::system::{Link, Span, System};
use super::wave::turned_mean;
use crate::panel::legendre::{BASIS, Legendre, Q, TAYLOR, dot, work_of_unit_forces};
use crate::panel::oscillator::BodyMode;
use num_complex::Complex64;

/// Phases of the harmonic loads on a panel, for all contacts: `e^{i Omega t}` at its start, and `e^{i Omega (t' - t)} - 1` at the
/// nodes and at the end.
#[derive(Default)]
pub(crate) struct Turns {
    start: Vec<Complex64>,
    swept: [Vec<Complex64>; Q + 1],
}

/// The part of a panel of `h` up to a node, by its number, or all of it.
fn part(place: usize, h: f64) -> f64 {
    BASIS.nodes.get(place).map_or(h, |node| node * h)
}

/// A harmonic load.
#[derive(Clone, Copy)]
pub(crate) struct HarmonicLoad<'a> {
    pub body: usize,
    pub shape: &'a [f64],
    pub omega_rad_s: f64,
    /// The force is the real part of this, turned by `e^{i Omega t}` (N).
    pub phasor: Complex64,
}

impl<'a> HarmonicLoad<'a> {
    /// `None` if it is not harmonic.
    pub fn of(load: &'a Load) -> Option<HarmonicLoad<'a>> {
        let Force::Harmonic { force_n, omega_rad_s, phase_rad } = load.force else { return None };
        let phasor = -Complex64::i() * Complex64::cis(phase_rad) * force_n;
        Some(HarmonicLoad { body: load.body, shape: &load.shape, omega_rad_s, phasor })
    }
}

/// Loads of one frequency.
#[derive(Debug, Clone)]
pub(crate) struct Harmonic {
    pub omega_rad_s: f64,
    /// The steady motion `G` of each mode (m kg^1/2), and of the overlap of each contact (m).
    pub modes: Vec<Complex64>,
    pub contacts: Vec<Complex64>,
}

impl Harmonic {
    /// `e^{i Omega t}`.
    pub fn turn(&self, time_s: f64) -> Complex64 {
        Complex64::cis(self.omega_rad_s * time_s)
    }
}

/// Effect of piecewise linear loads on one contact, from the time `t0` of the last break.
#[derive(Debug, Clone, Copy, Default)]
struct Line {
    /// Shift of the elastic modes (m) and its rate (m/s).
    shift: f64,
    shift_rate: f64,
    /// Acceleration of the rigid modes (m/s^2) and its rate (m/s^3).
    acceleration: f64,
    jerk: f64,
}

/// One load in the order of the modes.
#[derive(Debug, Clone)]
struct Source {
    span: Span,
    force: Force,
}

/// All loads.
#[derive(Debug, Clone)]
pub(crate) struct Loads {
    pub harmonics: Vec<Harmonic>,
    lines: Vec<Source>,
    /// Breaks of the piecewise linear loads, ascending (s).
    breaks: Vec<f64>,
    next: usize,
    since_s: f64,
    /// Modal forces at `since_s` and their rates; empty without piecewise linear loads.
    force: Vec<f64>,
    force_rate: Vec<f64>,
    /// Modes that are rigid and loaded.
    pub rigid: Vec<usize>,
    contacts: Vec<Line>,
}

impl Loads {
    pub fn new<'l>(given: impl IntoIterator<Item = &'l Load>, system: &System) -> Loads {
        let mut loads = Loads {
            harmonics: Vec::new(),
            lines: Vec::new(),
            breaks: Vec::new(),
            next: 0,
            since_s: 0.0,
            force: Vec::new(),
            force_rate: Vec::new(),
            rigid: Vec::new(),
            contacts: vec![Line::default(); system.links.len()],
        };
        for load in given {
            let span = system.span(load.body, &load.shape);
            match HarmonicLoad::of(load) {
                Some(harmonic) => loads.add_harmonic(system, &span, &harmonic),
                None => {
                    let force = &load.force;
                    if let Force::Sampled { times_s, .. } = force {
                        loads.breaks.extend(times_s.iter().filter(|time| **time > 0.0));
                    }
                    loads.lines.push(Source { span, force: force.clone() });
                }
            }
        }
        for harmonic in &mut loads.harmonics {
            let amplitude = |link: &Link, part: fn(&Complex64) -> f64| {
                let values: Vec<f64> = harmonic.modes.iter().map(part).collect();
                link.sum(&values)
            };
            let of = |link| Complex64::new(amplitude(link, |g| g.re), amplitude(link, |g| g.im));
            harmonic.contacts = system.links.iter().map(of).collect();
        }
        loads.breaks.sort_by(f64::total_cmp);
        loads.breaks.dedup();
        loads.set_lines(system, 0.0);
        loads
    }

    fn add_harmonic(&mut self, system: &System, span: &Span, &HarmonicLoad { omega_rad_s, phasor, .. }: &HarmonicLoad) {
        let found = self.harmonics.iter().position(|harmonic| harmonic.omega_rad_s == omega_rad_s);
        let at = found.unwrap_or(self.harmonics.len());
        if found.is_none() {
            let modes = vec![Complex64::ZERO; system.modes.len()];
            self.harmonics.push(Harmonic { omega_rad_s, modes, contacts: Vec::new() });
        }
        for (k, shape) in span.modes.clone().zip(&span.psi).filter(|(_, shape)| **shape != 0.0) {
            self.harmonics[at].modes[k] += phasor * *shape / stiffness(&system.modes[k], omega_rad_s);
        }
    }

    /// Sets the linear pieces that begin at `time_s`.
    fn set_lines(&mut self, system: &System, time_s: f64) {
        if self.lines.is_empty() {
            return;
        }
        self.since_s = time_s;
        self.force = vec![0.0; system.modes.len()];
        self.force_rate = vec![0.0; system.modes.len()];
        for Source { span, force } in &self.lines {
            let (value, rate) = line_at(force, time_s);
            for (k, shape) in span.modes.clone().zip(&span.psi) {
                self.force[k] += shape * value;
                self.force_rate[k] += shape * rate;
            }
        }
        self.rigid = (0..system.modes.len())
            .filter(|&k| system.modes[k].is_rigid() && (self.force[k] != 0.0 || self.force_rate[k] != 0.0))
            .collect();
        self.contacts = system.links.iter().map(|link| self.line_of(system, link)).collect();
    }

    fn line_of(&self, system: &System, link: &Link) -> Line {
        let mut line = Line::default();
        for &(k, psi) in &link.rigid {
            line.acceleration += psi * self.force[k];
            line.jerk += psi * self.force_rate[k];
        }
        for &(k, psi) in &link.elastic {
            let (shift, rate) = self.shift(system, k);
            line.shift += psi * shift;
            line.shift_rate += psi * rate;
        }
        line
    }

    /// Modal force of the piecewise linear loads at `time_s`, and its rate.
    pub fn line(&self, k: usize, time_s: f64) -> (f64, f64) {
        if self.force.is_empty() {
            return (0.0, 0.0);
        }
        (self.force[k] + self.force_rate[k] * (time_s - self.since_s), self.force_rate[k])
    }

    /// Quasi-static displacement of an elastic mode by the piecewise linear loads at the last break, and its rate.
    pub fn shift(&self, system: &System, k: usize) -> (f64, f64) {
        if self.force.is_empty() {
            return (0.0, 0.0);
        }
        let (omega, zeta) = (system.modes[k].omega_rad_s, system.modes[k].damping_ratio);
        let rate = self.force_rate[k] / (omega * omega);
        (self.force[k] / (omega * omega) - 2.0 * zeta / omega * rate, rate)
    }

    /// The time of the next break, infinite if there is none.
    pub fn next_break_s(&self) -> f64 {
        self.breaks.get(self.next).copied().unwrap_or(f64::INFINITY)
    }

    /// Number of breaks after the start.
    pub fn break_count(&self) -> usize {
        self.breaks.len()
    }

    /// Number of breaks that these loads have passed and others, of the same system, have not.
    pub fn breaks_since(&self, others: &Loads) -> usize {
        self.next - others.next
    }

    /// Passes the break that has been reached: the total motion is continuous, the relative motion of the elastic modes jumps.
    pub fn pass_break(&mut self, system: &System, time_s: f64, amplitude: &mut [f64], rate: &mut [f64]) {
        self.next += 1;
        self.add_shifts(system, time_s, 1.0, amplitude, rate);
        self.set_lines(system, time_s);
        self.add_shifts(system, time_s, -1.0, amplitude, rate);
    }

    fn add_shifts(&self, system: &System, time_s: f64, sign: f64, amplitude: &mut [f64], rate: &mut [f64]) {
        for k in (0..self.force.len()).filter(|&k| !system.modes[k].is_rigid()) {
            let (shift, slope) = self.shift(system, k);
            amplitude[k] += sign * (shift + slope * (time_s - self.since_s));
            rate[k] += sign * slope;
        }
    }

    /// From the total motion of the modes at `time_s` to the relative motion (`sign` -1), or back (`sign` 1).
    pub fn shift_modes(&self, system: &System, time_s: f64, sign: f64, amplitude: &mut [f64], rate: &mut [f64]) {
        self.add_shifts(system, time_s, sign, amplitude, rate);
        for harmonic in &self.harmonics {
            let turn = harmonic.turn(time_s);
            for (k, gain) in harmonic.modes.iter().enumerate() {
                let moved = gain * turn;
                amplitude[k] += sign * moved.re;
                rate[k] -= sign * harmonic.omega_rad_s * moved.im;
            }
        }
    }

    /// Acceleration of the steady motion.
    pub fn add_accelerations(&self, time_s: f64, factor: f64, rate: &mut [f64]) {
        for harmonic in &self.harmonics {
            let turn = -factor * harmonic.omega_rad_s * harmonic.omega_rad_s * harmonic.turn(time_s);
            rate.iter_mut().zip(&harmonic.modes).for_each(|(rate, gain)| *rate += (gain * turn).re);
        }
    }

    /// Effect of the piecewise linear loads on the rigid modes over `h` seconds from `time_s` on.
    pub fn push_rigid(&self, time_s: f64, h: f64, amplitude: &mut [f64], rate: &mut [f64]) {
        for &k in &self.rigid {
            let (force, slope) = self.line(k, time_s);
            amplitude[k] += h * h * (0.5 * force + h * slope / 6.0);
            rate[k] += h * (force + 0.5 * h * slope);
        }
    }

    /// Contribution of the steady motion to the overlap of a contact and its rate at `time_s`.
    pub fn overlap(&self, contact: usize, time_s: f64) -> (f64, f64) {
        let line = &self.contacts[contact];
        let mut overlap = (line.shift + line.shift_rate * (time_s - self.since_s), line.shift_rate);
        for harmonic in &self.harmonics {
            let moved = harmonic.contacts[contact] * harmonic.turn(time_s);
            overlap.0 += moved.re;
            overlap.1 -= harmonic.omega_rad_s * moved.im;
        }
        overlap
    }

    /// Contribution of the steady motion to displacement and velocity of one side of a contact at `time_s`.
    pub fn side(&self, system: &System, side: &Span, time_s: f64) -> (f64, f64) {
        let (mut amplitude, mut rate) = (vec![0.0; system.modes.len()], vec![0.0; system.modes.len()]);
        self.shift_modes(system, time_s, 1.0, &mut amplitude, &mut rate);
        (side.sum(&amplitude), side.sum(&rate))
    }

    /// Change of the overlap of a contact by the loads within `h` seconds from `time_s` on, and of its rate, beyond the free motion
    /// of the modes from `time_s`.
    pub fn moved(&self, contact: usize, time_s: f64, h: f64) -> (f64, f64) {
        if self.is_empty() {
            return (0.0, 0.0);
        }
        let turns = self.harmonics.iter().map(|harmonic| (harmonic.turn(time_s), swept(harmonic.omega_rad_s * h)));
        self.moved_by(contact, time_s, h, turns)
    }

    /// Phases of the harmonic loads on a panel of `h`.
    pub fn turn(&self, time_s: f64, h: f64, turns: &mut Turns) {
        if self.harmonics.is_empty() {
            return;
        }
        turns.start.clear();
        turns.start.extend(self.harmonics.iter().map(|harmonic| harmonic.turn(time_s)));
        for (place, swept_to) in turns.swept.iter_mut().enumerate() {
            swept_to.clear();
            swept_to.extend(self.harmonics.iter().map(|harmonic| swept(harmonic.omega_rad_s * part(place, h))));
        }
    }

    /// [`Loads::moved`] up to a node of a panel of `h`, by its number, or to its end.
    #[inline]
    pub fn moved_on(&self, contact: usize, (time_s, h): (f64, f64), turns: &Turns, place: usize) -> (f64, f64) {
        if self.is_empty() {
            return (0.0, 0.0);
        }
        let turns = turns.start.iter().copied().zip(turns.swept[place].iter().copied());
        self.moved_by(contact, time_s, part(place, h), turns)
    }

    /// What quadrature ([`work_of_unit_forces`]) misses of the work of a contact's force over the sinusoids on a panel of `h` (J). The
    /// quadrature is exact for polynomials, and a sinusoid that turns far is none.
    pub fn work_missed_j(&self, contact: usize, h: f64, turns: &Turns, force: &Legendre) -> f64 {
        let of = |(j, harmonic): (usize, &Harmonic)| {
            let now = harmonic.contacts[contact] * turns.start[j];
            let moved = |place: usize| (now * turns.swept[place][j]).re;
            let angle = harmonic.omega_rad_s * h;
            let by_quadrature = work_of_unit_forces(&std::array::from_fn(moved), moved(Q));
            -angle * (now * turned_mean(angle, force)).im - dot(&force.0, &by_quadrature)
        };
        self.harmonics.iter().enumerate().map(of).sum()
    }

    fn moved_by(
        &self,
        contact: usize,
        time_s: f64,
        h: f64,
        turns: impl Iterator<Item = (Complex64, Complex64)>,
    ) -> (f64, f64) {
        let line = &self.contacts[contact];
        let acceleration = self.acceleration(contact, time_s);
        let mut moved = h * (line.shift_rate + h * (0.5 * acceleration + h * line.jerk / 6.0));
        let mut rate = line.shift_rate + h * (acceleration + 0.5 * h * line.jerk);
        for (harmonic, (turn, swept)) in self.harmonics.iter().zip(turns) {
            let now = harmonic.contacts[contact] * turn;
            let swept = now * swept;
            moved += swept.re;
            rate -= harmonic.omega_rad_s * (now + swept).im;
        }
        (moved, rate)
    }

    /// A bound on the change of the overlap of a contact by the loads within `h` seconds from `time_s` on (m).
    pub fn most_moved(&self, contact: usize, time_s: f64, h: f64) -> f64 {
        let line = &self.contacts[contact];
        let acceleration = self.acceleration(contact, time_s).abs();
        let lines = h * (line.shift_rate.abs() + h * (0.5 * acceleration + h * line.jerk.abs() / 6.0));
        let of = |harmonic: &Harmonic| harmonic.contacts[contact].norm() * (harmonic.omega_rad_s * h).min(2.0);
        lines + self.harmonics.iter().map(of).sum::<f64>()
    }

    /// Derivative of [`Loads::moved`] within `h` seconds with respect to the time of its start.
    pub fn moved_later(&self, contact: usize, time_s: f64, h: f64) -> (f64, f64) {
        let jerk = self.contacts[contact].jerk;
        let (mut moved, mut rate) = (0.5 * h * h * jerk, h * jerk);
        for harmonic in &self.harmonics {
            let omega = harmonic.omega_rad_s;
            let now = harmonic.contacts[contact] * harmonic.turn(time_s);
            let swept = now * swept(omega * h);
            moved -= omega * swept.im;
            rate -= omega * omega * (now + swept).re;
        }
        (moved, rate)
    }

    /// Acceleration of the overlap by the harmonic loads alone (m/s^2).
    pub fn bend(&self, contact: usize, time_s: f64) -> f64 {
        let of = |harmonic: &Harmonic| {
            let moved = harmonic.contacts[contact] * harmonic.turn(time_s);
            -harmonic.omega_rad_s * harmonic.omega_rad_s * moved.re
        };
        self.harmonics.iter().map(of).sum()
    }

    /// Acceleration of the overlap by the piecewise linear loads on the rigid modes (m/s^2).
    pub fn acceleration(&self, contact: usize, time_s: f64) -> f64 {
        self.contacts[contact].acceleration + self.contacts[contact].jerk * (time_s - self.since_s)
    }

    /// Adds `g^(p)/p!` of the contribution of the loads to the overlap of a contact.
    pub fn add_series(&self, contact: usize, time_s: f64, series: &mut [f64; TAYLOR]) {
        let line = &self.contacts[contact];
        series[1] += line.shift_rate;
        series[2] += 0.5 * self.acceleration(contact, time_s);
        series[3] += line.jerk / 6.0;
        for harmonic in &self.harmonics {
            let mut term = harmonic.contacts[contact] * harmonic.turn(time_s);
            for (p, value) in series.iter_mut().enumerate().skip(1) {
                term *= Complex64::i() * harmonic.omega_rad_s / p as f64;
                *value += term.re;
            }
        }
    }

    /// Whether no load changes any more.
    pub fn are_constant(&self) -> bool {
        self.harmonics.is_empty() && self.next == self.breaks.len() && self.force_rate.iter().all(|rate| *rate == 0.0)
    }

    /// Whether there are any.
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty() && self.harmonics.is_empty()
    }

    /// The fastest of the loads (rad/s).
    pub fn fastest_rad_s(&self) -> f64 {
        self.harmonics.iter().map(|harmonic| harmonic.omega_rad_s).fold(0.0, f64::max)
    }
}

/// Dynamic stiffness of a mode: `omega^2 - Omega^2 + 2 i zeta omega Omega`.
pub(crate) fn stiffness(mode: &BodyMode, omega_rad_s: f64) -> Complex64 {
    let BodyMode { omega_rad_s: omega, damping_ratio } = *mode;
    let square = (omega - omega_rad_s) * (omega + omega_rad_s);
    Complex64::new(square, 2.0 * damping_ratio * omega * omega_rad_s)
}

/// `e^{ix} - 1` without cancellation.
pub(crate) fn swept(angle: f64) -> Complex64 {
    let half = (0.5 * angle).sin_cos();
    Complex64::new(-2.0 * half.0 * half.0, 2.0 * half.0 * half.1)
}

/// Value and slope of a constant or sampled load just after `time_s`.
fn line_at(force: &Force, time_s: f64) -> (f64, f64) {
    match force {
        Force::Constant { force_n } => (*force_n, 0.0),
        Force::Sampled { times_s, forces_n } => {
            let after = times_s.partition_point(|time| *time <= time_s);
            if after == 0 || after == times_s.len() {
                return (0.0, 0.0);
            }
            let (from, to) = (times_s[after - 1], times_s[after]);
            let slope = (forces_n[after] - forces_n[after - 1]) / (to - from);
            (forces_n[after - 1] + slope * (time_s - from), slope)
        }
        Force::Harmonic { .. } => (0.0, 0.0),
    }
}
