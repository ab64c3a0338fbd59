//! The energy balance of a run, part by part.
//!
//! # Parts
//! - Energy of a body, of the whole motion: `sum (a'^2 + omega^2 a^2)/2` over its modes.
//! - Work of a contact: `int F xi' dt` with the force that drives the modes and the overlap under this force. The part that is not
//!   stored at the end of the run is lost.
//! - Modal damping: `int 2 zeta omega a'^2 dt`.
//! - Work of the loads: `int f a' dt`.
//!
//! The motion of a mode is the sum of the relative motion (`a_c`, with rate `b_c`) and the steady motion under piecewise linear
//! and harmonic loads (`load.rs`), `a' = b_c + s + sum_j Re(i Omega_j G_j e^{i Omega_j t})`, where `s` is the slope of the
//! linear part. The dissipation is therefore that of `b_c` alone and a remainder.
//!
//! # Panel by panel
//! - Free relative motion, `int 2 zeta omega b_c^2 dt`: the difference of its energy between the start and the end of the
//!   flight, exactly.
//! - The same under contact forces: the forms of `damping.rs`.
//! - Piecewise linear loads on rigid modes, whose whole motion is relative: with `a'' = sum_n g_n P_n + f_0 + f_1 tau` on a panel
//!   of `h`, `int a' d tau = h a'_0 + h^2 (g_0/2 - g_1/6 + f_0/2 + f_1 h/6)` and
//!   `int tau a' d tau = h^2 a'_0/2 + h^3 (g_0/3 - g_1/12 - g_2/60 + f_0/3 + f_1 h/8)`.
//!
//! # Piece by piece
//! Between breaks of the loads everything else follows from the relative motion at the two ends and from `int F dt` and
//! `int F e^{i Omega t} dt` of each contact:
//!
//! ```text
//! omega^2 int a_c = int g - [b_c + 2 zeta omega a_c]
//! K int b_c e^{i Omega t} = [(omega^2 a_c + i Omega b_c) e^{i Omega t}] - i Omega int g e^{i Omega t}
//! K = omega^2 - Omega^2 - 2 i zeta omega Omega
//! ```
//!
//! (the modal equation times 1 and times `e^{i Omega t}`, by parts; `g` is the force of the contacts, on a rigid mode with
//! that of the linear loads). Products of two sinusoids are elementary, and computed once for the whole run.
//!
//! # Residual and rounding
//! Only `unaccounted_j` is the difference of the other parts, and consists of their rounding. A contact's work is computed by
//! quadrature of its overlap, and exactly for harmonic loads and for the modes that turn fast on a panel (`excess.rs`). Each panel
//! rounds the parts relative to the energy of the relative motion. That energy is large if a sampled load changes within a small part
//! of a slow mode's period, or if the frequency of a harmonic load is nearly that of an undamped mode: the steady motion is then
//! large, and free motion of the same size cancels it. Errors of two parts can cancel in `unaccounted_j`, so `rounding_j` states their
//! bound.

use super::damping_series::lost_within;
use super::load::Loads;
use super::problem::Body;
use super::solution::Ledger;
use super::system::System;
use super::tables::Tables;
use super::wave::{Wave, integral, turned_mean};
use crate::panel::legendre::Legendre;
use num_complex::Complex64;
use std::ops::{AddAssign, Range};

/// Relative modal state at a moment.
#[derive(Clone, Copy)]
pub(crate) struct Moment<'a> {
    pub system: &'a System,
    pub loads: &'a Loads,
    pub time_s: f64,
    pub amplitude: &'a [f64],
    pub rate: &'a [f64],
}

impl Moment<'_> {
    /// Energy of the relative motion of a mode (J).
    fn carried_energy(&self, k: usize) -> f64 {
        0.5 * (self.rate[k].powi(2) + self.system.square[k] * self.amplitude[k].powi(2))
    }

    fn carried_energy_of_all(&self) -> f64 {
        (0..self.amplitude.len()).map(|k| self.carried_energy(k)).sum()
    }
}

/// The energy balance during a run.
pub(crate) struct Account {
    bodies_j: Vec<f64>,
    stored_j: f64,
    damping: Dissipation,
    load_work_j: Sum,
    /// Largest energy of the relative motion at the ends of the pieces, or stored in the contacts at the start (J).
    carried_j: f64,
    /// Number of panels, each of which rounds the parts once.
    panels: u64,
    piece: Piece,
}

/// Energy that the relative motion loses to modal damping.
pub(crate) struct Dissipation {
    /// Bodies with damped modes.
    damped: Vec<Range<usize>>,
    /// Energy of the relative motion of the damped modes at the start of the flight (J).
    flying_j: Option<f64>,
    /// The loss until the start of this flight, or of the next panel (J).
    pub lost_j: Sum,
}

/// A sum of millions of terms, with what its additions have rounded away.
#[derive(Default)]
pub(crate) struct Sum {
    sum: f64,
    rounded: f64,
}

impl AddAssign<f64> for Sum {
    fn add_assign(&mut self, term: f64) {
        let sum = self.sum + term;
        // the part of the term that the sum contains
        let taken = sum - self.sum;
        self.rounded += (self.sum - (sum - taken)) + (term - taken);
        self.sum = sum;
    }
}

impl Sum {
    pub fn total(&self) -> f64 {
        self.sum + self.rounded
    }
}

/// Since the last break of the loads.
#[derive(Default)]
struct Piece {
    since_s: f64,
    amplitude: Vec<f64>,
    rate: Vec<f64>,
    /// `int F dt`, and `int F e^{i Omega t} dt` by frequency, of each contact.
    impulse: Vec<f64>,
    turned: Vec<Vec<Complex64>>,
}

impl Dissipation {
    pub fn new(system: &System) -> Dissipation {
        let drags = |body: &&Range<usize>| (*body).clone().any(|k| system.drag[k] > 0.0);
        Dissipation {
            damped: system.bodies.iter().filter(drags).cloned().collect(),
            flying_j: None,
            lost_j: Sum::default(),
        }
    }

    /// Adds a panel of `h`, with the contact forces.
    pub fn panel(&mut self, start: &Moment, tables: &Tables, h: f64, contacts: &[usize], force: &[Legendre]) {
        if self.damped.is_empty() {
            return;
        }
        if contacts.is_empty() {
            self.flying_j.get_or_insert_with(|| damped_energy(&self.damped, start));
            return;
        }
        self.land(start);
        let (system, motion) = (start.system, (start.amplitude, start.rate));
        self.lost_j += match tables.steps.level_of(h) {
            Some(level) => tables.damping(system, level, contacts).lost(system, &self.damped, motion, contacts, force),
            None => lost_within(system, &self.damped, h, motion, contacts, force),
        };
    }

    /// Ends a flight, if there is one.
    pub fn land(&mut self, now: &Moment) {
        if let Some(energy) = self.flying_j.take() {
            self.lost_j += energy - damped_energy(&self.damped, now);
        }
    }
}

impl Account {
    /// The balance at the start; `stored_j` is the energy stored in the contacts.
    pub fn open(bodies: &[Body], start: &Moment, stored_j: f64) -> Account {
        let mut account = Account {
            bodies_j: bodies.iter().map(energy).collect(),
            stored_j,
            damping: Dissipation::new(start.system),
            load_work_j: Sum::default(),
            carried_j: stored_j,
            panels: 0,
            piece: Piece::default(),
        };
        account.begin_piece(start);
        account
    }

    /// Adds a panel of `h` that is about to be accepted, with the contact forces.
    pub fn panel(&mut self, start: &Moment, tables: &Tables, h: f64, contacts: &[usize], force: &[Legendre]) {
        self.panels += 1;
        self.damping.panel(start, tables, h, contacts, force);
        if start.loads.is_empty() {
            return;
        }
        for &k in &start.loads.rigid {
            self.load_work_j += work_on_rigid(start, h, k, contacts, force);
        }
        for (&c, force) in contacts.iter().zip(force) {
            self.piece.impulse[c] += h * force.mean();
            for (harmonic, turned) in start.loads.harmonics.iter().zip(&mut self.piece.turned) {
                turned[c] += harmonic.turn(start.time_s) * h * turned_mean(harmonic.omega_rad_s * h, force);
            }
        }
    }

    /// Begins a new piece with the present relative motion.
    pub fn begin_piece(&mut self, now: &Moment) {
        self.carried_j = self.carried_j.max(now.carried_energy_of_all());
        if now.loads.is_empty() {
            return;
        }
        let contacts = now.system.links.len();
        self.piece = Piece {
            since_s: now.time_s,
            amplitude: now.amplitude.to_vec(),
            rate: now.rate.to_vec(),
            impulse: vec![0.0; contacts],
            turned: vec![vec![Complex64::ZERO; contacts]; now.loads.harmonics.len()],
        };
    }

    /// Ends a piece at a break of the loads or at the end of the run.
    pub fn end_piece(&mut self, now: &Moment) {
        self.damping.land(now);
        self.carried_j = self.carried_j.max(now.carried_energy_of_all());
        if now.loads.is_empty() {
            return;
        }
        let (system, loads) = (now.system, now.loads);
        let impulse = on_modes(system, &self.piece.impulse, 0.0);
        let waves: Vec<Wave> = loads
            .harmonics
            .iter()
            .map(|harmonic| Wave::over(harmonic.omega_rad_s, self.piece.since_s, now.time_s))
            .collect();
        let turned: Vec<Vec<Complex64>> =
            self.piece.turned.iter().map(|moments| on_modes(system, moments, Complex64::ZERO)).collect();
        for k in 0..system.modes.len() {
            let (a, b) = ([self.piece.amplitude[k], now.amplitude[k]], [self.piece.rate[k], now.rate[k]]);
            let (damping, work) = self.of_piece(now, k, (a, b), impulse[k], &waves, |j| turned[j][k]);
            self.damping.lost_j += damping;
            self.load_work_j += work;
        }
    }

    /// Adds the dissipation and the work of the loads in a piece, mode by mode, that its panels do not include.
    fn of_piece(
        &self,
        now: &Moment,
        k: usize,
        (a, b): ([f64; 2], [f64; 2]),
        impulse: f64,
        waves: &[Wave],
        turned: impl Fn(usize) -> Complex64,
    ) -> (f64, f64) {
        let mode = &now.system.modes[k];
        let (square, drag) = (now.system.square[k], now.system.drag[k]);
        let length = now.time_s - self.piece.since_s;
        let (f0, slope) = now.loads.line(k, self.piece.since_s);
        let (f1, _) = now.loads.line(k, now.time_s);
        let rising = if mode.is_rigid() { 0.0 } else { now.loads.shift(now.system, k).1 };
        let (mut damping, mut work) = (0.0, 0.0);
        if !mode.is_rigid() && (f0 != 0.0 || slope != 0.0) {
            let moved = a[1] - a[0];
            damping += drag * rising * (2.0 * moved + rising * length);
            work += if slope == 0.0 {
                f0 * moved
            } else {
                let integral = (impulse - (b[1] - b[0]) - drag * moved) / square;
                f1 * a[1] - f0 * a[0] - slope * integral + 0.5 * (f0 + f1) * length * rising
            };
        }
        for (j, (harmonic, wave)) in now.loads.harmonics.iter().zip(waves).enumerate() {
            let (gain, omega, [from, to]) = (harmonic.modes[k], harmonic.omega_rad_s, wave.ends);
            if gain == Complex64::ZERO {
                continue;
            }
            let i_omega = Complex64::new(0.0, omega);
            let stiffness = Complex64::new((mode.omega_rad_s - omega) * (mode.omega_rad_s + omega), drag * omega);
            // the force of the linear loads acts on the relative motion of a rigid mode
            let by_lines = if mode.is_rigid() { f0 * wave.mean + slope * wave.first } else { Complex64::ZERO };
            let at = |i: usize| square * a[i] + i_omega * b[i];
            let seen = (at(1) * to - at(0) * from - i_omega * (turned(j) + by_lines)) / stiffness.conj();
            // rate times `e^{i Omega t}`, of all but the harmonic motion
            let seen = seen + rising * wave.mean;
            damping += 2.0 * drag * (i_omega * gain * seen).re;
            work += (stiffness * gain * seen).re;
            // straight lines on the harmonic motion
            work += f1 * (gain * to).re - f0 * (gain * from).re - slope * (gain * wave.mean).re;
        }
        (damping, work)
    }

    /// The final balance; `stored_j` is the energy stored in the contacts, and `contact_work_j` the work on them.
    pub fn close(mut self, end: &Moment, stored_j: f64, contact_work_j: f64) -> Ledger {
        self.end_piece(end);
        let (damping, work) = of_harmonics(end);
        let modal_damping_j = self.damping.lost_j.total() + damping;
        let load_work_j = self.load_work_j.total() + work;
        let bodies_j: Vec<[f64; 2]> =
            self.bodies_j.iter().zip(energies(end)).map(|(start, end)| [*start, end]).collect();
        let gained: f64 = bodies_j.iter().map(|[start, end]| end - start).sum();
        Ledger {
            bodies_j,
            stored_j: [self.stored_j, stored_j],
            load_work_j,
            modal_damping_j,
            contact_loss_j: contact_work_j + self.stored_j - stored_j,
            unaccounted_j: load_work_j - gained - modal_damping_j - contact_work_j,
            rounding_j: f64::EPSILON * (self.panels + 4) as f64 * self.carried_j,
        }
    }
}

/// Energy of a body at the start.
fn energy(body: &Body) -> f64 {
    let motion = body.amplitude.iter().zip(&body.rate);
    body.modes.iter().zip(motion).map(|(mode, (a, b))| 0.5 * (b.powi(2) + (mode.omega_rad_s * a).powi(2))).sum()
}

/// Energy of each body now, by the whole motion.
fn energies(now: &Moment) -> Vec<f64> {
    let (mut amplitude, mut rate) = (now.amplitude.to_vec(), now.rate.to_vec());
    now.loads.shift_modes(now.system, now.time_s, 1.0, &mut amplitude, &mut rate);
    let of = |k: usize| 0.5 * (rate[k].powi(2) + now.system.square[k] * amplitude[k].powi(2));
    now.system.bodies.iter().map(|body| body.clone().map(of).sum()).collect()
}

/// Energy of the relative motion of the damped modes.
fn damped_energy(damped: &[Range<usize>], now: &Moment) -> f64 {
    damped.iter().cloned().flatten().filter(|&k| now.system.drag[k] > 0.0).map(|k| now.carried_energy(k)).sum()
}

/// Work of the straight lines on a rigid mode within a panel of `h`.
fn work_on_rigid(start: &Moment, h: f64, k: usize, contacts: &[usize], force: &[Legendre]) -> f64 {
    let (f0, slope) = start.loads.line(k, start.time_s);
    let mut pushed = [0.0; 3];
    for (&c, force) in contacts.iter().zip(force) {
        for span in start.system.links[c].spans.iter().filter(|span| span.modes.contains(&k)) {
            let psi = span.psi[k - span.modes.start];
            pushed.iter_mut().zip(&force.0).for_each(|(pushed, force)| *pushed -= psi * force);
        }
    }
    let [g0, g1, g2] = pushed;
    let rate = start.rate[k];
    let moved = h * (rate + h * (g0 / 2.0 - g1 / 6.0 + f0 / 2.0 + slope * h / 6.0));
    let later = h * h * (rate / 2.0 + h * (g0 / 3.0 - g1 / 12.0 - g2 / 60.0 + f0 / 3.0 + slope * h / 8.0));
    f0 * moved + slope * later
}

/// `-sum_c psi_kc values_c`.
fn on_modes<T>(system: &System, values: &[T], zero: T) -> Vec<T>
where
    T: Copy + std::ops::SubAssign + std::ops::Mul<f64, Output = T>,
{
    let mut sums = vec![zero; system.modes.len()];
    for (link, value) in system.links.iter().zip(values) {
        for span in &link.spans {
            sums[span.modes.clone()].iter_mut().zip(&span.psi).for_each(|(sum, psi)| *sum -= *value * *psi);
        }
    }
    sums
}

/// Damping and load work of the harmonic steady motion by itself, over the whole run.
fn of_harmonics(end: &Moment) -> (f64, f64) {
    let (mut damping, mut work) = (0.0, 0.0);
    for one in &end.loads.harmonics {
        for other in &end.loads.harmonics {
            let sum = integral(one.omega_rad_s + other.omega_rad_s, 0.0, end.time_s);
            let difference = integral(one.omega_rad_s - other.omega_rad_s, 0.0, end.time_s);
            let product = |x: Complex64, y: Complex64| 0.5 * (x * y * sum + x * y.conj() * difference).re;
            for (k, mode) in end.system.modes.iter().enumerate() {
                let drag = end.system.drag[k];
                let square = (mode.omega_rad_s - one.omega_rad_s) * (mode.omega_rad_s + one.omega_rad_s);
                let force = Complex64::new(square, drag * one.omega_rad_s) * one.modes[k];
                let [first, second] = [one, other].map(|wave| Complex64::new(0.0, wave.omega_rad_s) * wave.modes[k]);
                damping += drag * product(first, second);
                work += product(force, second);
            }
        }
    }
    (damping, work)
}
