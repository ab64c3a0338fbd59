//! A problem as a general solver takes it: all modes in one list, `[a_1 .. a_N, a_1' .. a_N']`.

use crate::problem::{Power, Problem};
use vibroimpact_sim::assembly::{Force, Point};

/// A contact, and the modes that it sees, which follow each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Its law.
    pub law: Power,
    /// Gap (m).
    pub gap_m: f64,
    /// The first mode that it sees.
    pub first: usize,
    /// By how much each adds to the overlap (kg^-1/2).
    pub psi: Vec<f64>,
}

/// A harmonic load.
#[derive(Debug, Clone, PartialEq)]
pub struct Harmonic {
    /// Frequency (rad/s).
    pub omega_rad_s: f64,
    /// Phase (rad).
    pub phase_rad: f64,
    /// Modal forces.
    pub amplitude: Vec<f64>,
}

/// The system.
#[derive(Debug, Clone, PartialEq)]
pub struct System {
    /// Squares of the frequencies.
    pub omega_2: Vec<f64>,
    /// `2 zeta omega`.
    pub damping: Vec<f64>,
    /// The state at the start.
    pub start: Vec<f64>,
    /// Constant modal forces.
    pub constant: Vec<f64>,
    /// The contacts.
    pub contacts: Vec<Row>,
    /// Harmonic loads.
    pub harmonics: Vec<Harmonic>,
    /// When the run ends (s).
    pub end_s: f64,
}

impl System {
    /// The system of a problem.
    pub fn of(problem: &Problem) -> System {
        let bodies = &problem.assembly.bodies;
        let first: Vec<usize> =
            (0..bodies.len()).map(|i| bodies[..i].iter().map(|body| body.modes.len()).sum()).collect();
        let modes = || bodies.iter().flat_map(|body| &body.modes);
        let count = modes().count();
        let spread = |body: usize, shape: &[f64], scale: f64, into: &mut Vec<f64>| {
            for (sum, shape) in into[first[body]..].iter_mut().zip(shape) {
                *sum += scale * shape;
            }
        };
        let (mut constant, mut harmonics) = (vec![0.0; count], Vec::new());
        for load in &problem.assembly.loads {
            match load.force {
                Force::Constant { force_n } => spread(load.body, &load.shape, force_n, &mut constant),
                Force::Harmonic { force_n, omega_rad_s, phase_rad } => {
                    let mut amplitude = vec![0.0; count];
                    spread(load.body, &load.shape, force_n, &mut amplitude);
                    harmonics.push(Harmonic { omega_rad_s, phase_rad, amplitude });
                }
                // no problem has any other
                _ => {}
            }
        }
        let rows = problem.assembly.contacts.iter().zip(&problem.laws).map(|(contact, law)| {
            let mut psi = vec![0.0; count];
            for (side, sign) in contact.sides.iter().zip([-1.0, 1.0]) {
                if let Point::OfBody { body, shape } = side {
                    spread(*body, shape, sign, &mut psi);
                }
            }
            let seen = |psi: &f64| *psi != 0.0;
            let (first, end) =
                (psi.iter().position(seen).unwrap_or(0), psi.iter().rposition(seen).map_or(0, |k| k + 1));
            Row { law: *law, gap_m: contact.gap_m, first, psi: psi[first..end].to_vec() }
        });
        let states = |of: fn(&vibroimpact_sim::assembly::Body) -> &Vec<f64>| bodies.iter().flat_map(of).copied();
        System {
            omega_2: modes().map(|mode| mode.omega_rad_s.powi(2)).collect(),
            damping: modes().map(|mode| 2.0 * mode.damping_ratio * mode.omega_rad_s).collect(),
            start: states(|body| &body.amplitude).chain(states(|body| &body.rate)).collect(),
            constant,
            contacts: rows.collect(),
            harmonics,
            end_s: problem.end_s,
        }
    }

    /// Number of modes.
    pub fn modes(&self) -> usize {
        self.omega_2.len()
    }

    /// The overlap of a contact.
    pub fn overlap(&self, contact: usize, y: &[f64]) -> f64 {
        let Row { gap_m, first, psi, .. } = &self.contacts[contact];
        psi.iter().zip(&y[*first..]).map(|(psi, a)| psi * a).sum::<f64>() - gap_m
    }

    /// `y'` at a time, with these contacts closed.
    pub fn rates(&self, t_s: f64, y: &[f64], closed: &[bool], dy: &mut [f64]) {
        let n = self.modes();
        let (a, b) = y.split_at(n);
        let (da, db) = dy.split_at_mut(n);
        da.copy_from_slice(b);
        for k in 0..n {
            db[k] = self.constant[k] - self.damping[k] * b[k] - self.omega_2[k] * a[k];
        }
        for load in &self.harmonics {
            let now = (load.omega_rad_s * t_s + load.phase_rad).sin();
            for (rate, amplitude) in db.iter_mut().zip(&load.amplitude) {
                *rate += now * amplitude;
            }
        }
        for (c, Row { law, first, psi, .. }) in self.contacts.iter().enumerate().filter(|(c, _)| closed[*c]) {
            let xi = self.overlap(c, y);
            let elastic =
                if law.exponent == 1.0 { law.stiffness * xi } else { law.stiffness * xi.max(0.0) * xi.max(0.0).sqrt() };
            let mut force = elastic;
            if law.damping_s_m != 0.0 {
                let rate: f64 = psi.iter().zip(&b[*first..]).map(|(psi, b)| psi * b).sum();
                force *= 1.0 + law.damping_s_m * rate;
            }
            for (rate, psi) in db[*first..].iter_mut().zip(psi) {
                *rate -= psi * force;
            }
        }
    }

    /// The root of twice the energy of a state.
    pub fn size(&self, y: &[f64]) -> f64 {
        let (a, b) = y.split_at(self.modes());
        let energy = (0..a.len()).map(|k| b[k] * b[k] + self.omega_2[k] * a[k] * a[k]);
        energy.sum::<f64>().sqrt()
    }

    /// Absolute tolerances by which errors of all components weigh alike in the energy.
    pub fn tolerances(&self, tolerance: f64, size: f64) -> Vec<f64> {
        let displacement = self.omega_2.iter().map(|omega_2| tolerance * size / omega_2.sqrt().max(1.0));
        displacement.chain(self.omega_2.iter().map(|_| tolerance * size)).collect()
    }
}
