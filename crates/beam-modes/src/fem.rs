//! Hermite finite elements for the same beams: an independent reference, and the model of thesis appendix A.4.
//!
//! Two-node elements with displacement and rotation at each node, cubic shape functions and consistent mass; the
//! generalised eigenproblem `K v = omega^2 M v` is reduced by the Cholesky factor of `M`. Frequencies converge from
//! above with the fourth power of the element length.

use crate::definition::{Beam, End};
use crate::dense::{cholesky, eigen, solve_lower, solve_upper};
use crate::location::require_on;
use crate::point_mode::{PointMode, point_modes};
use faer::Mat;
use invalid_input::InvalidInput;

/// The quantity of a degree of freedom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Coordinate {
    /// Displacement of the node, m.
    Displacement,
    /// Rotation of the node, rad.
    Rotation,
}

invalid_input::names!(Coordinate, "coordinate", { Displacement: "displacement", Rotation: "rotation" });

/// A beam divided into elements.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// Locations of the nodes, m.
    pub nodes_m: Vec<f64>,
    /// Node and kind of every degree of freedom that the ends do not constrain.
    pub dofs: Vec<(usize, Coordinate)>,
    /// Stiffness matrix, row by row, `dofs.len()` squared; N/m, N, N m by kind.
    pub stiffness: Vec<f64>,
    /// Consistent mass matrix, row by row; kg, kg m, kg m^2 by kind.
    pub mass: Vec<f64>,
    rigid: usize,
}

/// Modes of a [`Model`], mass-normalised, with the largest nodal displacement positive.
#[derive(Debug, Clone)]
pub struct ModelModes {
    nodes_m: Vec<f64>,
    omega_rad_s: Vec<f64>,
    /// Displacement and rotation of every node, mode by mode, constrained ones included.
    nodal: Vec<Vec<[f64; 2]>>,
}

impl Model {
    /// Divides every segment of the beam into the same number of equal elements.
    ///
    /// # Errors
    /// [`InvalidInput`] for an invalid beam, for no elements, and for more than 2,000 in total.
    pub fn new(beam: &Beam, elements_per_segment: usize) -> Result<Self, InvalidInput> {
        beam.checked()?;
        let elements = beam.segments.len().saturating_mul(elements_per_segment);
        if !(1..=2000).contains(&elements) {
            let allowed = "at least 1, with at most 2000 elements in the whole beam";
            return Err(InvalidInput::new("elements_per_segment", elements_per_segment, allowed));
        }
        let full = 2 * (elements + 1);
        let held = |end: End, first: usize| match end {
            End::Clamped => vec![first, first + 1],
            End::Pinned => vec![first],
            End::Guided => vec![first + 1],
            End::Free => vec![],
        };
        let mut fixed = held(beam.ends[0], 0);
        fixed.extend(held(beam.ends[1], full - 2));
        let kept: Vec<usize> = (0..full).filter(|dof| !fixed.contains(dof)).collect();
        let mut place = vec![None; full];
        kept.iter().enumerate().for_each(|(row, &dof)| place[dof] = Some(row));

        let n = kept.len();
        let (mut stiffness, mut mass) = (vec![0.0; n * n], vec![0.0; n * n]);
        let mut nodes_m = vec![0.0];
        let mut start_m = 0.0;
        for segment in &beam.segments {
            let h = segment.length_m / elements_per_segment as f64;
            let (k, m) = element(h, segment.flexural_rigidity_n_m2, segment.mass_per_length_kg_m);
            for e in 1..=elements_per_segment {
                let first = 2 * (nodes_m.len() - 1);
                nodes_m.push(start_m + h * e as f64);
                for a in 0..4 {
                    for b in 0..4 {
                        if let (Some(i), Some(j)) = (place[first + a], place[first + b]) {
                            stiffness[i * n + j] += k[a][b];
                            mass[i * n + j] += m[a][b];
                        }
                    }
                }
            }
            start_m += segment.length_m;
        }
        let coordinate =
            |dof: usize| if dof.is_multiple_of(2) { Coordinate::Displacement } else { Coordinate::Rotation };
        let dofs = kept.into_iter().map(|dof| (dof / 2, coordinate(dof))).collect();
        Ok(Self { nodes_m, dofs, stiffness, mass, rigid: beam.rigid_body_count() })
    }

    /// All modes of the model, as many as degrees of freedom; rigid-body motions have `omega = 0` exactly.
    ///
    /// ```
    /// use beam_modes::{Beam, End, Segment, fem};
    /// let segment = Segment { length_m: 1.0, flexural_rigidity_n_m2: 275.0, mass_per_length_kg_m: 1.0 };
    /// let beam = Beam { segments: vec![segment], ends: [End::Clamped, End::Free] };
    /// let discrete = fem::Model::new(&beam, 20)?.modes()?;
    /// assert_eq!(discrete.omega_rad_s().len(), 40);
    /// let exact = beam.modes(1)?.omega_rad_s()[0];
    /// assert!((discrete.omega_rad_s()[0] / exact - 1.0).abs() < 1e-7);
    /// # Ok::<(), beam_modes::InvalidInput>(())
    /// ```
    ///
    /// # Errors
    /// [`InvalidInput`] if segments differ so much that the mass matrix is singular to rounding.
    pub fn modes(&self) -> Result<ModelModes, InvalidInput> {
        let n = self.dofs.len();
        let unsolved = || {
            InvalidInput::new(
                "segments",
                "as given",
                "a list without contrasts so large that the mass matrix is ill-conditioned",
            )
        };
        let mut omega_rad_s = Vec::with_capacity(n);
        let mut nodal = Vec::with_capacity(n);
        if n > 0 {
            // Displacements and rotations differ in size: without scaling, the reduction would lose digits.
            let scale: Vec<f64> = (0..n).map(|i| 1.0 / self.mass[i * n + i].sqrt()).collect();
            let stiffness = Mat::from_fn(n, n, |i, j| self.stiffness[i * n + j] * scale[i] * scale[j]);
            let mass = Mat::from_fn(n, n, |i, j| self.mass[i * n + j] * scale[i] * scale[j]);
            let lower = cholesky(mass.as_ref()).ok_or_else(unsolved)?;
            // L^-1 K L^-T, whose eigenvectors y give v = L^-T y.
            let mut reduced = stiffness;
            solve_lower(lower.as_ref(), reduced.as_mut());
            let mut reduced = reduced.transpose().to_owned();
            solve_lower(lower.as_ref(), reduced.as_mut());
            let (values, mut vectors) = eigen(reduced.as_ref()).ok_or_else(unsolved)?;
            solve_upper(lower.transpose(), vectors.as_mut());
            for k in 0..n {
                let lambda = values[k].max(0.0);
                omega_rad_s.push(if k < self.rigid { 0.0 } else { lambda.sqrt() });
                nodal.push(self.spread(|row| scale[row] * vectors[(row, k)]));
            }
        }
        if omega_rad_s.iter().all(|w| w.is_finite()) {
            Ok(ModelModes { nodes_m: self.nodes_m.clone(), omega_rad_s, nodal })
        } else {
            Err(unsolved())
        }
    }

    /// An eigenvector at all nodes, with its largest displacement positive.
    fn spread(&self, value: impl Fn(usize) -> f64) -> Vec<[f64; 2]> {
        let mut nodal = vec![[0.0; 2]; self.nodes_m.len()];
        for (row, &(node, coordinate)) in self.dofs.iter().enumerate() {
            nodal[node][usize::from(coordinate == Coordinate::Rotation)] = value(row);
        }
        let largest = nodal.iter().fold(0.0, |best: f64, n| if n[0].abs() > best.abs() { n[0] } else { best });
        if largest < 0.0 {
            nodal.iter_mut().flatten().for_each(|v| *v = -*v);
        }
        nodal
    }
}

impl ModelModes {
    /// Natural frequencies in ascending order, rad/s.
    pub fn omega_rad_s(&self) -> &[f64] {
        &self.omega_rad_s
    }

    /// Shape of mode `k` at `x_m`, kg^(-1/2), by the element's cubics.
    ///
    /// # Errors
    /// [`InvalidInput`] for a mode that does not exist or a location outside the beam.
    pub fn shape(&self, k: usize, x_m: f64) -> Result<f64, InvalidInput> {
        let length_m = self.nodes_m.last().copied().unwrap_or(0.0);
        let x_m = require_on("x_m", x_m, length_m)?;
        let Some(nodal) = self.nodal.get(k) else {
            return Err(InvalidInput::new("k", k, "the index of a mode, counted from 0"));
        };
        let right = self.nodes_m.partition_point(|&node| node <= x_m).clamp(1, nodal.len() - 1);
        let h = self.nodes_m[right] - self.nodes_m[right - 1];
        let s = (x_m - self.nodes_m[right - 1]) / h;
        let ([w0, t0], [w1, t1]) = (nodal[right - 1], nodal[right]);
        let r = 1.0 - s;
        Ok(r * r * (1.0 + 2.0 * s) * w0 + s * r * r * h * t0 + s * s * (1.0 + 2.0 * r) * w1 - s * s * r * h * t1)
    }

    /// Shapes of all modes at `x_m`, kg^(-1/2).
    ///
    /// # Errors
    /// [`InvalidInput`] for a location outside the beam.
    pub fn shapes_at(&self, x_m: f64) -> Result<Vec<f64>, InvalidInput> {
        (0..self.nodal.len()).map(|k| self.shape(k, x_m)).collect()
    }

    /// All modes as excited by a force at `x_m`.
    ///
    /// # Errors
    /// As for [`shapes_at`](Self::shapes_at).
    pub fn seen_from(&self, x_m: f64) -> Result<Vec<PointMode>, InvalidInput> {
        Ok(point_modes(&self.omega_rad_s, self.shapes_at(x_m)?))
    }
}

/// Stiffness and consistent mass of one element.
fn element(h: f64, rigidity: f64, mass_per_length: f64) -> ([[f64; 4]; 4], [[f64; 4]; 4]) {
    let scale = [1.0, h, 1.0, h];
    let stiffness = [[12.0, 6.0, -12.0, 6.0], [6.0, 4.0, -6.0, 2.0], [-12.0, -6.0, 12.0, -6.0], [6.0, 2.0, -6.0, 4.0]];
    let mass =
        [[156.0, 22.0, 54.0, -13.0], [22.0, 4.0, 13.0, -3.0], [54.0, 13.0, 156.0, -22.0], [-13.0, -3.0, -22.0, 4.0]];
    let (k, m) = (rigidity / h.powi(3), mass_per_length * h / 420.0);
    let entry = |table: [[f64; 4]; 4], factor: f64| {
        [0, 1, 2, 3].map(|a: usize| [0, 1, 2, 3].map(|b: usize| factor * table[a][b] * scale[a] * scale[b]))
    };
    (entry(stiffness, k), entry(mass, m))
}
