//! The equations of an impact in the form for general solvers: one smooth phase at a time.
//!
//! The state is `[z, z', a_1 .. a_N, a_1' .. a_N']`, with `z` positive away from the structure. In a phase the contact force is
//! a smooth function of the state; the phase ends when an event function becomes negative.

use super::definition::Impact;
use contact_models::{Boundary, Branch, ContactLaw, Force};
use std::cell::Cell;

/// The state of contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Phase {
    /// Separate, until the surfaces meet.
    Flight,
    /// In contact, on this branch of the law.
    Contact(Branch),
}

/// Right-hand side, Jacobian and events of one phase.
#[derive(Debug)]
pub struct Equations<'a> {
    impact: &'a Impact,
    phase: Phase,
    shape: &'a [f64],
    stiffness: &'a [f64],
    damping: &'a [f64],
    /// Subtracted from the event functions: their initial values, if a phase begins on its own boundary.
    offset: [f64; 2],
    evaluations: &'a Cell<u64>,
}

/// The numbers of the modes as arrays, and the count of evaluations, for all phases of one run.
#[derive(Debug)]
pub(super) struct Tables {
    shape: Vec<f64>,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    pub evaluations: Cell<u64>,
}

impl Tables {
    pub fn new(impact: &Impact) -> Tables {
        let modes = &impact.structure.modes;
        Tables {
            shape: modes.iter().map(|mode| mode.shape).collect(),
            stiffness: modes.iter().map(|mode| mode.omega_rad_s.powi(2)).collect(),
            damping: modes.iter().map(|mode| 2.0 * mode.damping_ratio * mode.omega_rad_s).collect(),
            evaluations: Cell::new(0),
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl<'a> Equations<'a> {
    pub(super) fn new(impact: &'a Impact, tables: &'a Tables, phase: Phase, start: &[f64]) -> Equations<'a> {
        let Tables { shape, stiffness, damping, evaluations } = tables;
        let mut equations = Equations { impact, phase, shape, stiffness, damping, offset: [0.0; 2], evaluations };
        // A phase that begins beyond its own boundary by rounding does not end there.
        equations.offset = equations.margins(start).map(|margin| margin.min(0.0));
        equations
    }

    /// Number of unknowns, `2 N + 2`.
    pub fn len(&self) -> usize {
        2 * self.shape.len() + 2
    }

    /// Whether there are no unknowns; never.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Compression and its rate.
    pub fn compression(&self, y: &[f64]) -> (f64, f64) {
        let (a, b) = y[2..].split_at(self.shape.len());
        (dot(self.shape, a) - y[0], dot(self.shape, b) - y[1])
    }

    fn force(&self, y: &[f64]) -> Force {
        match &self.phase {
            Phase::Flight => Force::ZERO,
            Phase::Contact(branch) => {
                let (xi, rate) = self.compression(y);
                self.impact.law.force(branch, xi, rate)
            }
        }
    }

    /// `y'`.
    pub fn rates(&self, y: &[f64], dy: &mut [f64]) {
        self.evaluations.set(self.evaluations.get() + 1);
        let n = self.shape.len();
        let force = self.force(y).force_n;
        let (a, b) = y[2..].split_at(n);
        (dy[0], dy[1]) = (y[1], force / self.impact.striker.mass_kg);
        let (da, db) = dy[2..].split_at_mut(n);
        da.copy_from_slice(b);
        for k in 0..n {
            db[k] = -self.damping[k] * b[k] - self.stiffness[k] * a[k] - self.shape[k] * force;
        }
    }

    /// The Jacobian at `y` times `v`.
    pub fn jacobian_times(&self, y: &[f64], v: &[f64], jv: &mut [f64]) {
        let n = self.shape.len();
        let force = self.force(y);
        let (xi, rate) = self.compression(v);
        let force = force.per_compression_n_m * xi + force.per_rate_n_s_m * rate;
        let (a, b) = v[2..].split_at(n);
        (jv[0], jv[1]) = (v[1], force / self.impact.striker.mass_kg);
        let (da, db) = jv[2..].split_at_mut(n);
        da.copy_from_slice(b);
        for k in 0..n {
            db[k] = -self.damping[k] * b[k] - self.stiffness[k] * a[k] - self.shape[k] * force;
        }
    }

    /// Event functions of the phase, positive inside it.
    pub fn margins(&self, y: &[f64]) -> [f64; 2] {
        let (xi, rate) = self.compression(y);
        let margins = match &self.phase {
            Phase::Flight => [-xi, 1.0],
            // No law here has more than two.
            Phase::Contact(branch) => [0, 1].map(|which| {
                let boundary = self.impact.law.boundary(branch, which).unwrap_or(Boundary::NEVER);
                boundary.margin(xi, rate)
            }),
        };
        [margins[0] - self.offset[0], margins[1] - self.offset[1]]
    }

    /// Absolute tolerances for which every component contributes equally to the error of the force: for velocities relative to
    /// the striker's, for displacements relative to its distance travelled in the relevant time.
    pub fn tolerances(&self, tolerance: f64) -> Vec<f64> {
        let speed = self.impact.striker.speed_m_s;
        let modal = speed * self.impact.striker.mass_kg.sqrt();
        let contact_time_s = 1e-4;
        let displacements = self.stiffness.iter().map(|k| modal * (1.0 / k.sqrt()).min(contact_time_s));
        let speeds = self.shape.iter().map(|_| modal);
        let all = [speed * contact_time_s, speed].into_iter().chain(displacements).chain(speeds);
        all.map(|scale| tolerance * scale).collect()
    }

    /// A first step after touch that does not spoil the following ones: the force begins as a power 3/2 of time, so that the
    /// error of a step from its start is the power 5/2 of its length for any order, which error estimates do not detect.
    pub fn first_step(&self, tolerance: f64) -> Option<f64> {
        matches!(self.phase, Phase::Contact(_)).then(|| 3e-5 * tolerance.powf(0.4))
    }
}
