//! Modes of a plate and their evaluation.

use super::definition::Plate;
use super::line::Line;
use crate::point_mode::{PointMode, point_modes};
use crate::string::{sine_mean, sine_of};
use invalid_input::InvalidInput;

/// Natural modes of a plate, in ascending order of frequency; rigid-body modes first, with `omega = 0`.
///
/// Shapes are mass-normalised, `int rho h phi_i phi_j dA = delta_ij`, and in kg^(-1/2); with Mindlin's theory the mass includes
/// rotary inertia. Signs are determined by the first coefficient in the basis that is larger than half of the largest.
#[derive(Debug, Clone)]
pub struct PlateModes {
    pub(super) plate: Plate,
    pub(super) rigid: usize,
    pub(super) omega_rad_s: Vec<f64>,
    pub(super) change: Vec<f64>,
    pub(super) kind: Kind,
}

/// Representation of the shapes.
#[derive(Debug, Clone)]
pub(super) enum Kind {
    /// Products of sines.
    Sines(Vec<Sine>),
    /// Products of polynomials up to these degrees.
    Polynomials { degrees: [usize; 2], shapes: Vec<Product> },
}

/// `size sin(m pi x/a) sin(n pi y/b)`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sine {
    pub m: usize,
    pub n: usize,
    pub omega_rad_s: f64,
    pub size: f64,
}

/// A sum over products of the functions of two classes.
#[derive(Debug, Clone)]
pub(super) struct Product {
    pub classes: [usize; 2],
    /// Coefficients row by row; the index of the second direction varies fastest.
    pub coefficients: Vec<f64>,
}

impl Product {
    /// The sum for these values of the functions in either direction.
    fn sum(&self, [along, across]: &[Line; 2], [values_along, values_across]: &[Vec<f64>; 2]) -> f64 {
        let (rows, columns) = (&along.classes[self.classes[0]], &across.classes[self.classes[1]]);
        let row = |(i, coefficients): (&usize, &[f64])| {
            let sum: f64 = columns.iter().zip(coefficients).map(|(j, c)| c * values_across[*j]).sum();
            values_along[*i] * sum
        };
        rows.iter().zip(self.coefficients.chunks(columns.len().max(1))).map(row).sum()
    }
}

impl PlateModes {
    /// Number of modes.
    pub fn len(&self) -> usize {
        self.omega_rad_s.len()
    }

    /// Whether no mode was requested.
    pub fn is_empty(&self) -> bool {
        self.omega_rad_s.is_empty()
    }

    /// Number of rigid-body modes.
    pub fn rigid_body_count(&self) -> usize {
        self.rigid
    }

    /// Natural frequencies, rad/s.
    pub fn omega_rad_s(&self) -> &[f64] {
        &self.omega_rad_s
    }

    /// Relative increase of each frequency, at most, if the degree of the polynomials were two less in both directions: a
    /// measure of the possible change by a higher degree. It is at least 1e-11, for rounding, and zero for modes in closed
    /// form.
    pub fn change(&self) -> &[f64] {
        &self.change
    }

    /// Number of converged modes, from the lowest: each changes by less than this share.
    pub fn converged(&self, share: f64) -> usize {
        self.change.iter().take_while(|change| **change < share).count()
    }

    /// Shapes of all modes at a location, kg^(-1/2).
    ///
    /// # Errors
    /// [`InvalidInput`] for a location outside the plate.
    pub fn shapes_at(&self, x_m: f64, y_m: f64) -> Result<Vec<f64>, InvalidInput> {
        let (x, y) = self.plate.place(x_m, y_m)?;
        Ok(match &self.kind {
            Kind::Sines(sines) => {
                sines.iter().map(|sine| sine.size * sine_of(sine.m, x) * sine_of(sine.n, y)).collect()
            }
            Kind::Polynomials { degrees, shapes } => {
                let lines = lines(&self.plate, *degrees);
                let here = [lines[0].values(2.0 * x - 1.0), lines[1].values(2.0 * y - 1.0)];
                shapes.iter().map(|product| product.sum(&lines, &here)).collect()
            }
        })
    }

    /// All modes as excited by a force at a location.
    ///
    /// # Errors
    /// As for [`shapes_at`](Self::shapes_at).
    pub fn seen_from(&self, x_m: f64, y_m: f64) -> Result<Vec<PointMode>, InvalidInput> {
        Ok(point_modes(&self.omega_rad_s, self.shapes_at(x_m, y_m)?))
    }

    /// Participation `int rho h phi dA` of every mode in a uniform acceleration across the plate, kg^(1/2).
    pub fn participation_kg0_5(&self) -> Vec<f64> {
        let Plate { length_m, width_m, thickness_m, density_kg_m3, .. } = self.plate;
        let mass = density_kg_m3 * thickness_m * length_m * width_m;
        let means: Vec<f64> = match &self.kind {
            Kind::Sines(sines) => sines.iter().map(|sine| sine.size * sine_mean(sine.m) * sine_mean(sine.n)).collect(),
            Kind::Polynomials { degrees, shapes } => {
                let lines = lines(&self.plate, *degrees);
                let means = [lines[0].means(), lines[1].means()];
                shapes.iter().map(|product| product.sum(&lines, &means)).collect()
            }
        };
        means.into_iter().map(|mean| mass * mean).collect()
    }
}

/// The polynomials along and across a plate.
pub(super) fn lines(plate: &Plate, degrees: [usize; 2]) -> [Line; 2] {
    let [left, right, low, high] = plate.edges;
    [Line::new([left, right], degrees[0]), Line::new([low, high], degrees[1])]
}
