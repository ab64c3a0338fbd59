//! Several contacts at once, in contact coordinates.

use crate::Coefficients;
use crate::matrix::{self, symmetric_consistent};
use alloc::vec;
use alloc::vec::Vec;
use core::fmt;
use invalid_input::InvalidInput;

/// Friction at a contact, which also determines its number of coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Friction {
    /// No friction: one coordinate, along the normal.
    None,
    /// Coulomb friction in a plane: two coordinates, normal and tangent; `|tau| <= mu p`.
    Planar {
        /// Coefficient of friction `mu`.
        coefficient: f64,
    },
    /// Coulomb friction in space: three coordinates, normal and two tangents at right angles. The cone is
    /// replaced by the pyramid with `facets` sides inscribed in it, so that `|tau| <= mu p` always holds.
    Spatial {
        /// Coefficient of friction `mu`.
        coefficient: f64,
        /// Number of sides of the pyramid, 3 to 64.
        facets: usize,
    },
}

impl Friction {
    /// Number of coordinates of the contact: 1, 2 or 3.
    pub const fn coordinates(&self) -> usize {
        match self {
            Friction::None => 1,
            Friction::Planar { .. } => 2,
            Friction::Spatial { .. } => 3,
        }
    }

    /// `mu`, zero without friction.
    pub const fn coefficient(&self) -> f64 {
        match self {
            Friction::None => 0.0,
            Friction::Planar { coefficient } | Friction::Spatial { coefficient, .. } => *coefficient,
        }
    }
}

/// One contact: its friction and its coefficients in the outward inequalities.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Contact {
    /// Friction, and with it the number of coordinates.
    pub friction: Friction,
    /// `ebar`, `beta_0`, `beta_1` of this contact.
    pub coefficients: Coefficients<f64>,
}

/// One mode of the vibrating structure.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Mode {
    /// Modal speed `a_k'` before the impact (kg^1/2 m/s).
    pub rate: f64,
    /// Mass-normalised mode shape in each contact coordinate (kg^-1/2).
    pub shape: Vec<f64>,
}

/// Strikers that meet a structure at one or more contacts at the same time.
///
/// The contact coordinates of all contacts are stacked, contact by contact, normal first. In each, a positive velocity of the
/// striker points away from the structure, and the structure's own velocity `sum_k shape_k a_k'` counts in the same direction,
/// so that the contact opens at `g = velocity - sum_k shape_k a_k'`. Every contact in the list is closed at the instant of
/// impact.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Problem {
    /// The contacts.
    pub contacts: Vec<Contact>,
    /// `W`, the inverse of the contact inertia `M_C` of Eq. 5.1 (1/kg): impulses `P` change the strikers'
    /// contact velocities by `W P`. Symmetric, positive semidefinite, row by row.
    pub inverse_inertia_per_kg: Vec<f64>,
    /// Velocities of the strikers' contact points before the impact (m/s), which must be in the range of `W`.
    pub velocity_m_s: Vec<f64>,
    /// The structure's modes; none for a rigid one.
    pub modes: Vec<Mode>,
}

impl Problem {
    /// The problem of bodies with `n` velocities, an `n` by `n` mass matrix, and the Jacobian (one row of `n` per contact
    /// coordinate) that maps those velocities to contact velocities: `W = J M^-1 J^T`.
    ///
    /// # Errors
    /// [`InvalidInput`] for a mass matrix that is not symmetric and positive definite, a size that does not match, or a number
    /// beyond 1e100 in magnitude; and as [`Problem::validate`].
    pub fn from_bodies(
        contacts: Vec<Contact>,
        mass_matrix: &[f64],
        jacobian: &[f64],
        body_velocity: &[f64],
        modes: Vec<Mode>,
    ) -> Result<Problem, InvalidInput> {
        let n = body_velocity.len();
        let d = coordinates(&contacts);
        matrix::require_finite("mass_matrix", mass_matrix, n * n)?;
        matrix::require_finite("jacobian", jacobian, d * n)?;
        matrix::require_finite("body_velocity", body_velocity, n)?;
        matrix::require_symmetric("mass_matrix", mass_matrix, n)?;
        let factor = matrix::factor_positive_definite("mass_matrix", mass_matrix, n)?;
        let mut inverse_inertia_per_kg = vec![0.0; d * d];
        for (j, row) in rows(jacobian, n).enumerate() {
            let mut column = row.to_vec();
            matrix::solve_factored(&factor, n, &mut column);
            for (i, other) in rows(jacobian, n).enumerate().take(j + 1) {
                let w = matrix::dot(other, &column);
                inverse_inertia_per_kg[i * d + j] = w;
                inverse_inertia_per_kg[j * d + i] = w;
            }
        }
        let velocity_m_s = rows(jacobian, n).map(|row| matrix::dot(row, body_velocity)).collect();
        let problem = Problem { contacts, inverse_inertia_per_kg, velocity_m_s, modes };
        problem.validate()?;
        Ok(problem)
    }

    /// Number of contact coordinates.
    pub fn coordinates(&self) -> usize {
        coordinates(&self.contacts)
    }

    /// Index of each contact's normal among the contact coordinates.
    pub fn normals(&self) -> Vec<usize> {
        let mut place = 0;
        let mut normals = Vec::with_capacity(self.contacts.len());
        for contact in &self.contacts {
            normals.push(place);
            place += contact.friction.coordinates();
        }
        normals
    }

    /// Checks sizes, ranges, that `W` is symmetric and positive semidefinite, and that the velocities are in its range;
    /// otherwise an immovable body would move, with infinite energy.
    ///
    /// Entries of `W` below 1e-10 of the largest are its rounding. A body that is 1e10 times as heavy as the lightest therefore counts as
    /// immovable, and has to be at rest. State such a body as a part of the structure, or the impacts of the two as problems of their own.
    ///
    /// # Errors
    /// [`InvalidInput`] names the first number, list or matrix that fails a check.
    pub fn validate(&self) -> Result<(), InvalidInput> {
        for (index, contact) in self.contacts.iter().enumerate() {
            let within = |error: InvalidInput| error.at(index).within("contacts");
            contact.coefficients.validate().map_err(|error| within(error.within("coefficients")))?;
            let mu = contact.friction.coefficient();
            crate::require::require_non_negative("coefficient", mu)
                .map_err(|error| within(error.within("friction")))?;
            if let Friction::Spatial { facets, .. } = contact.friction {
                let holds = (3..=64).contains(&facets);
                InvalidInput::unless(
                    holds,
                    ("contacts", index, ["friction", "facets"]),
                    facets,
                    "a number from 3 to 64",
                )?;
            }
        }
        let d = self.coordinates();
        matrix::require_finite("inverse_inertia_per_kg", &self.inverse_inertia_per_kg, d * d)?;
        matrix::require_finite("velocity_m_s", &self.velocity_m_s, d)?;
        for (index, mode) in self.modes.iter().enumerate() {
            matrix::require_finite("shape", &mode.shape, d).map_err(|error| error.at(index).within("modes"))?;
            InvalidInput::require_finite(("modes", index, "rate"), mode.rate)?;
        }
        symmetric_consistent(&self.inverse_inertia_per_kg, &self.velocity_m_s)
    }

    /// Velocity at which each contact coordinate opens, from the strikers' velocities and the modal speeds.
    pub(crate) fn opening(&self, velocity: &[f64], rates: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut opening = velocity.to_vec();
        for (mode, rate) in self.modes.iter().zip(rates) {
            for (g, shape) in opening.iter_mut().zip(&mode.shape) {
                *g -= shape * rate;
            }
        }
        opening
    }

    /// The state after impulses `impulse` and these changes of the modal speeds. With the changes the energy that the bodies exchange
    /// keeps its digits where the structure has much more.
    pub(crate) fn solution(&self, outcome: Outcome, impulse: Vec<f64>, rate_changes: &[f64]) -> Solution {
        let d = self.coordinates();
        let mut velocity = self.velocity_m_s.clone();
        let mut energy = 0.0;
        for i in 0..d {
            let change = matrix::dot(&self.inverse_inertia_per_kg[i * d..(i + 1) * d], &impulse);
            energy += impulse[i] * (self.velocity_m_s[i] + 0.5 * change);
            velocity[i] += change;
        }
        let mut rates = Vec::with_capacity(self.modes.len());
        for (mode, change) in self.modes.iter().zip(rate_changes) {
            energy += change * (mode.rate + 0.5 * change);
            rates.push(mode.rate + change);
        }
        let opening_m_s = self.opening(&velocity, rates.iter().copied());
        Solution {
            outcome,
            impulse_n_s: impulse,
            velocity_m_s: velocity,
            opening_m_s,
            modal_rate: rates,
            energy_change_j: energy,
        }
    }

    /// Changes of the modal speeds if the impulses act on the structure instantaneously: `sum_j shape_kj (-P_j)`.
    pub(crate) fn struck_changes(&self, impulse: &[f64]) -> Vec<f64> {
        self.modes.iter().map(|mode| -matrix::dot(&mode.shape, impulse)).collect()
    }

    /// `G = W + Phi^T Phi`, the inverse inertia of the contact points with the structure's modes included.
    pub(crate) fn combined_inverse_inertia(&self) -> Vec<f64> {
        let d = self.coordinates();
        let mut g = self.inverse_inertia_per_kg.clone();
        for mode in &self.modes {
            for i in 0..d {
                for j in 0..d {
                    g[i * d + j] += mode.shape[i] * mode.shape[j];
                }
            }
        }
        g
    }
}

/// The kind of a solution.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Outcome {
    /// No contact is closing: nothing happens.
    NoImpact,
    /// The model's inequalities are satisfied as stated.
    Solved,
    /// The demanded rebound is not possible: it would need more energy than is available, bodies are wedged, or the numbers are
    /// beyond the solver. All demands were lowered by a common share, between the least-energy impact (0) and those stated (1).
    Relaxed {
        /// The share of the demands, 0 to 1.
        share: f64,
    },
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Outcome::NoImpact => f.pad("no impact"),
            Outcome::Solved => f.pad("solved"),
            Outcome::Relaxed { share } => write!(f, "relaxed to {share} of the demanded restitution"),
        }
    }
}

/// State after an impact at one or more contacts.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Solution {
    /// Kind of the solution.
    pub outcome: Outcome,
    /// Impulses on the strikers in the contact coordinates (N s). Not unique where `W` is singular.
    pub impulse_n_s: Vec<f64>,
    /// Velocities of the strikers' contact points (m/s).
    pub velocity_m_s: Vec<f64>,
    /// Velocities at which the contacts open, the structure's vibration included (m/s).
    pub opening_m_s: Vec<f64>,
    /// Modal speeds of the structure (kg^1/2 m/s).
    pub modal_rate: Vec<f64>,
    /// Kinetic energy after minus before (J), of strikers and structure together.
    pub energy_change_j: f64,
}

fn coordinates(contacts: &[Contact]) -> usize {
    contacts.iter().map(|contact| contact.friction.coordinates()).sum()
}

/// The rows of a matrix with `n` columns; none if it has no column.
fn rows(matrix: &[f64], n: usize) -> core::slice::ChunksExact<'_, f64> {
    matrix.chunks_exact(n.max(1))
}
