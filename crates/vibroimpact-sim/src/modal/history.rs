//! The whole motion of an impact, at any time, and where its energy went.

use super::behind::Behind;
use super::legendre::{BASIS, Nodal, derivative, dot, evaluate};
use super::motion::{ContactPiece, Motion, Piece};
use super::oscillator::{Propagator, propagate, response};
use super::problem::{Mode, Start, Striker};
use super::solution::{Outcome, Solution};
use super::solve::Solver;
use contact_models::ContactLaw;

/// Motion and force at one time. Displacements are positive away from the side that is struck.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time since the clock started (s).
    pub time_s: f64,
    /// Displacement of the structure at the contact (m).
    pub structure_displacement_m: f64,
    /// Its velocity (m/s).
    pub structure_velocity_m_s: f64,
    /// Displacement of the striker (m).
    pub striker_displacement_m: f64,
    /// Its velocity (m/s).
    pub striker_velocity_m_s: f64,
    /// Compression of the contact, negative when the surfaces are apart (m).
    pub compression_m: f64,
    /// Contact force (N).
    pub force_n: f64,
}

/// Where the energy went (J).
#[derive(Debug, Clone, PartialEq)]
pub struct EnergyLedger {
    /// Kinetic energy of the striker and energy of the structure when the clock starts.
    pub initial_j: f64,
    /// Kinetic energy of the striker at the end.
    pub striker_j: f64,
    /// Energy of each mode at the end, in the order of `Structure::modes`.
    pub modes_j: Vec<f64>,
    /// Lost to modal damping, from the modes' velocities.
    pub modal_damping_j: f64,
    /// Work that the contact law took up over the compression: dissipated, where all contacts have ended.
    pub contact_j: f64,
    /// What is missing: initial less all others. Measures the defect of the collocated force.
    pub residual_j: f64,
}

/// The recorded motion of one impact; evaluates itself exactly at any time, given its contact force.
pub struct History<L> {
    law: L,
    striker: Striker,
    start: Start,
    modes: Vec<Mode>,
    place: Vec<Option<usize>>,
    elastic: Vec<Mode>,
    residual_compliance: f64,
    mu: f64,
    pieces: Vec<Piece>,
    end_s: f64,
    /// Up to here the motion is known (s).
    known_until_s: f64,
    end: (Vec<f64>, Vec<f64>, f64),
}

/// A moment of the motion: compression (m) and force (N) of the contact.
struct Moment {
    motion: Motion,
    compression: f64,
    force: f64,
}

impl<L: ContactLaw> History<L> {
    pub(crate) fn new(
        solver: &Solver,
        striker: Striker,
        law: L,
        start: Start,
        pieces: Vec<Piece>,
        solution: &Solution,
    ) -> History<L> {
        History {
            law,
            striker,
            start,
            modes: solver.modes().to_vec(),
            place: solver.places().to_vec(),
            elastic: solver.elastic().to_vec(),
            residual_compliance: solver.residual_compliance_m_n(),
            mu: solver.inverse_mass(&striker),
            pieces,
            end_s: solution.end_s,
            known_until_s: match solution.outcome {
                Outcome::Rebound | Outcome::NoContact => f64::INFINITY,
                _ => solution.end_s,
            },
            end: (solution.amplitude.clone(), solution.rate.clone(), solution.striker_velocity_m_s),
        }
    }

    /// Time of the last event (s), or up to which a contact that lasts was followed.
    pub fn duration_s(&self) -> f64 {
        self.end_s
    }

    /// Up to this time (s) the motion is known; later ones are answered as this one. Infinite after a rebound, which free
    /// motion follows for ever. A contact that lasts is followed at least up to [`Settings::until_s`](super::Settings).
    pub fn known_until_s(&self) -> f64 {
        self.known_until_s
    }

    /// Times worth drawing between 0 and `until_s`: `count` equal intervals, and every step made in contact.
    pub fn times(&self, until_s: f64, count: usize) -> Vec<f64> {
        let mut times: Vec<f64> = (0..=count.max(1)).map(|i| until_s * i as f64 / count.max(1) as f64).collect();
        for piece in &self.pieces {
            if let Some(contact) = &piece.contact {
                times.extend(BASIS.nodes.iter().map(|c| piece.start.time + c * contact.length));
            }
            times.push(piece.start.time);
        }
        times.retain(|t| (0.0..=until_s).contains(t));
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// Motion and force at `time_s` (s); times before 0 and not-a-number are answered as 0, those beyond
    /// [`known_until_s`](History::known_until_s) as that. The force is that of the law at the compression and its rate, and
    /// so is never negative.
    pub fn at(&self, time_s: f64) -> Sample {
        let moment = self.moment(time_s);
        let motion = &moment.motion;
        let (displacement, velocity) = self.structure(motion);
        let gap = motion.gap();
        Sample {
            time_s: motion.time,
            structure_displacement_m: displacement,
            structure_velocity_m_s: velocity,
            striker_displacement_m: displacement - gap,
            striker_velocity_m_s: velocity - motion.gap_rate(),
            compression_m: moment.compression,
            force_n: moment.force,
        }
    }

    /// Energy of each mode at `time_s` (J), in the order of `Structure::modes`.
    pub fn modal_energies_j(&self, time_s: f64) -> Vec<f64> {
        let motion = self.moment(time_s).motion;
        let (amplitude, rate) = super::solve::modal_state(&self.modes, &self.place, &motion, &self.start);
        self.energies(&amplitude, &rate)
    }

    /// Amplitude of each mode at `time_s` (m kg^1/2), in the order of `Structure::modes`.
    pub fn amplitudes(&self, time_s: f64) -> Vec<f64> {
        super::solve::modal_state(&self.modes, &self.place, &self.moment(time_s).motion, &self.start).0
    }

    /// Where the energy went until the last event. The dissipation is integrated from the motion, independently of
    /// the balance: `residual_j` can fail to vanish.
    pub fn energy_ledger(&self) -> EnergyLedger {
        let kinetic = |speed: f64| if self.mu_striker() > 0.0 { 0.5 * speed * speed / self.mu_striker() } else { 0.0 };
        let initial_j = kinetic(self.striker.speed_m_s)
            + self.energies(&self.start.amplitude, &self.start.rate).iter().sum::<f64>();
        let striker_j = kinetic(self.end.2);
        let modes_j = self.energies(&self.end.0, &self.end.1);

        let (mut modal_damping_j, mut contact_j, mut stored) = (self.spectators_loss(), 0.0, 0.0);
        let mut panel = Panel { length: 0.0, modes: vec![] };
        for (i, piece) in self.pieces.iter().enumerate() {
            match &piece.contact {
                None => {
                    stored = 0.0;
                    // a free mode loses what its exact motion loses
                    let next = self.pieces.get(i + 1).map_or(&piece.start, |next| &next.start);
                    modal_damping_j += self.elastic_energy(&piece.start) - self.elastic_energy(next);
                }
                Some(contact) => {
                    let (damped, taken) = self.dissipation(piece, contact, &mut panel);
                    modal_damping_j += damped;
                    contact_j += taken;
                    stored = 0.5 * self.residual_compliance * evaluate(&contact.force, 1.0).powi(2);
                }
            }
        }
        let residual_j = initial_j - striker_j - modes_j.iter().sum::<f64>() - modal_damping_j - contact_j - stored;
        EnergyLedger { initial_j, striker_j, modes_j, modal_damping_j, contact_j, residual_j }
    }

    /// Energy lost to modal damping and taken up by the law over one step in contact, by fine quadrature on equal
    /// panels, in each of which no mode turns by more than a few radians. The tables of the last panel length are kept.
    fn dissipation(&self, piece: &Piece, contact: &ContactPiece, panel: &mut Panel) -> (f64, f64) {
        let fastest = self.elastic.iter().map(|mode| mode.omega_rad_s).fold(0.0, f64::max);
        let panels = (fastest * contact.length / 6.0).ceil().clamp(1.0, 1e4) as usize;
        let length = contact.length / panels as f64;
        if panel.length != length {
            *panel = Panel { length, modes: self.elastic.iter().map(|mode| Panel::of(mode, length)).collect() };
        }
        let (mut damped, mut taken) = (0.0, 0.0);
        let mut motion = piece.start.clone();
        for number in 0..panels {
            let part = |s: f64| (number as f64 + s) / panels as f64;
            let force: Nodal = BASIS.nodes.map(|c| evaluate(&contact.force, part(c)));
            let start = motion.clone();
            let places = BASIS.fine.iter().copied().chain([(1.0, 0.0)]);
            for (q, (s, w)) in places.enumerate() {
                let coefficients = BASIS.coefficients(&BASIS.restrict(&force, s));
                motion.carry_on_from(&start);
                motion.advance_drift(s * length, &coefficients, self.mu);
                let mut lost = 0.0;
                for (k, mode) in self.elastic.iter().enumerate() {
                    let (free, displacement, velocity) = &panel.modes[k][q];
                    let (a, b) = (start.vibration.alpha[k], start.vibration.beta[k]);
                    let weight = mode.shape * mode.shape;
                    let (alpha, beta) = free.apply(a, b);
                    motion.vibration.alpha[k] = alpha - weight * dot(displacement, &coefficients);
                    let beta = beta - weight * dot(velocity, &coefficients);
                    motion.vibration.beta[k] = beta;
                    lost += 2.0 * mode.damping_ratio * mode.omega_rad_s * (beta * beta / weight);
                }
                let compression = motion.gap() - self.residual_compliance * evaluate(&contact.force, part(s));
                let rate = motion.gap_rate() - self.residual_compliance * contact.force_rate(part(s));
                damped += w * length * lost;
                taken += w * length * self.law.force(&contact.branch, compression, rate).force_n * rate;
            }
        }
        (damped, taken)
    }

    /// What the elastic modes that the contact does not excite lose until the end.
    fn spectators_loss(&self) -> f64 {
        let before = self.energies(&self.start.amplitude, &self.start.rate);
        let after = self.energies(&self.end.0, &self.end.1);
        let spectators = (0..self.modes.len()).filter(|&k| self.place[k].is_none() && !self.modes[k].is_rigid());
        spectators.map(|k| before[k] - after[k]).sum()
    }

    fn mu_striker(&self) -> f64 {
        self.striker.mass_kg.recip()
    }

    fn energies(&self, amplitude: &[f64], rate: &[f64]) -> Vec<f64> {
        let energy = |(k, mode): (usize, &Mode)| 0.5 * (rate[k].powi(2) + (mode.omega_rad_s * amplitude[k]).powi(2));
        self.modes.iter().enumerate().map(energy).collect()
    }

    fn elastic_energy(&self, motion: &Motion) -> f64 {
        let state = &motion.vibration;
        let energy = |(k, mode): (usize, &Mode)| {
            0.5 * ((state.beta[k] / mode.shape).powi(2) + (mode.omega_rad_s * state.alpha[k] / mode.shape).powi(2))
        };
        self.elastic.iter().enumerate().map(energy).sum()
    }

    /// Displacement and velocity of the structure at the contact.
    fn structure(&self, motion: &Motion) -> (f64, f64) {
        let (amplitude, rate) = super::solve::modal_state(&self.modes, &self.place, motion, &self.start);
        let sum = |values: &[f64]| self.modes.iter().zip(values).map(|(mode, a)| mode.shape * a).sum();
        (sum(&amplitude), sum(&rate))
    }

    fn moment(&self, time_s: f64) -> Moment {
        let time_s = if time_s > 0.0 { time_s.min(self.known_until_s) } else { 0.0 };
        let after = self.pieces.partition_point(|piece| piece.start.time <= time_s);
        let piece = &self.pieces[after.saturating_sub(1)];
        self.within(piece, time_s - piece.start.time)
    }

    /// The motion `t` seconds into a piece: free motion, plus the exact response to the force until then.
    fn within(&self, piece: &Piece, t: f64) -> Moment {
        let mut motion = piece.start.clone();
        for (k, mode) in self.elastic.iter().enumerate() {
            let (a, b) = (piece.start.vibration.alpha[k], piece.start.vibration.beta[k]);
            let p = propagate(mode, t);
            (motion.vibration.alpha[k], motion.vibration.beta[k]) = p.apply(a, b);
        }
        let Some(contact) = &piece.contact else {
            motion.coast(t);
            return Moment { compression: motion.gap(), motion, force: 0.0 };
        };
        let t = t.min(contact.length);
        let part = t / contact.length;
        let nodal: Nodal = BASIS.nodes.map(|c| evaluate(&contact.force, part * c));
        let force = BASIS.coefficients(&nodal);
        for (k, mode) in self.elastic.iter().enumerate().filter(|_| t > 0.0) {
            let (displacement, velocity) = response(mode, t);
            motion.vibration.alpha[k] -= mode.shape.powi(2) * dot(&displacement, &force);
            motion.vibration.beta[k] -= mode.shape.powi(2) * dot(&velocity, &force);
        }
        motion.advance_drift(t, &force, self.mu);
        let (compression, force) = self.contact(contact, &motion, part);
        Moment { motion, compression, force }
    }

    /// Compression and force within a step: what the law says of the motion, as the polynomial through the nodes need not
    /// meet it between them, and at a touch may even be negative.
    fn contact(&self, contact: &ContactPiece, motion: &Motion, part: f64) -> (f64, f64) {
        let collocated = evaluate(&contact.force, part);
        let (gap, compliance) = (motion.gap(), self.residual_compliance);
        let rate = motion.gap_rate() - compliance * contact.force_rate(part);
        let estimate = gap - compliance * collocated;
        let compression = if compliance > 0.0 {
            let behind = Behind { law: &self.law, branch: &contact.branch, compliance };
            behind.compression(gap, estimate, rate)
        } else {
            estimate
        };
        (compression, self.law.force(&contact.branch, compression, rate).force_n.max(0.0))
    }
}

/// One mode at one place of a panel: free motion from its start, and the displacement and velocity that unit Legendre
/// forces between start and place have caused.
type Place = (Propagator, Nodal, Nodal);

/// A piece of a step, with the motion of every mode at the nodes of the fine rule and at its end.
struct Panel {
    length: f64,
    modes: Vec<Vec<Place>>,
}

impl Panel {
    fn of(mode: &Mode, length: f64) -> Vec<Place> {
        let places = BASIS.fine.iter().map(|(s, _)| *s).chain([1.0]);
        let place = |s: f64| {
            let (displacement, velocity) = response(mode, s * length);
            (propagate(mode, s * length), displacement, velocity)
        };
        places.map(place).collect()
    }
}

impl ContactPiece {
    /// Rate of the force (N/s) at this part of the step.
    fn force_rate(&self, part: f64) -> f64 {
        evaluate(&derivative(&self.force), part) / self.length
    }
}
