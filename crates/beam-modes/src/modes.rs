//! Natural modes, and their evaluation.

use crate::location::require_on;
use crate::piece::Piece;
use crate::point_mode::{PointMode, point_modes};
use crate::span::{RESOLVABLE, Span, Units, locate};
use invalid_input::InvalidInput;

/// Natural modes of a beam or a rod, in ascending order of frequency.
///
/// Shapes are mass-normalised, `int m phi_i phi_j dx = delta_ij` (thesis Eq. 4.4), so that their unit is kg^(-1/2). The sign of
/// a shape is determined at the left end: the lowest derivative that is not zero there is positive (displacement at a free or
/// guided end, slope at a pinned or, for rods, fixed end, curvature at a clamped end). The rotation of a free-free beam has
/// positive slope. At held ends and supports shapes are exactly zero.
#[derive(Debug, Clone)]
pub struct Modes {
    spans: Vec<Span>,
    units: Units,
    omega_rad_s: Vec<f64>,
    rigid: usize,
    /// Dimensionless shapes, mode by mode and span by span.
    pieces: Vec<Piece>,
    /// Masses attached to the structure: span, location within it, mass; dimensionless.
    fixed: Vec<(usize, f64, f64)>,
    /// Held ends and supports, where every shape is exactly zero; dimensionless.
    held: Vec<f64>,
}

/// Limits the memory: `count` modes of `spans` pieces each.
pub(crate) fn require_count(count: usize, spans: usize) -> Result<(), InvalidInput> {
    const MOST: usize = 100_000;
    const MOST_PIECES: usize = 20_000_000;
    if count > MOST || count.saturating_mul(spans) > MOST_PIECES {
        return Err(InvalidInput::new(
            "count",
            count,
            "at most 100000, and at most 20 million divided by the number of segments",
        ));
    }
    Ok(())
}

/// The locations of the ends that do not move, dimensionless.
pub(crate) fn held_ends([left, right]: [bool; 2]) -> Vec<f64> {
    [(left, 0.0), (right, 1.0)].into_iter().filter(|(held, _)| *held).map(|(_, x)| x).collect()
}

impl Modes {
    /// From dimensionless, mass-normalised shapes: rigid-body motions first, then elastic modes with their frequencies.
    pub(crate) fn assemble(
        spans: Vec<Span>,
        units: Units,
        rigid: Vec<Vec<Piece>>,
        omega_rad_s: impl Iterator<Item = f64>,
        elastic: Vec<Vec<Piece>>,
        held: Vec<f64>,
    ) -> Result<Self, InvalidInput> {
        let omega_rad_s: Vec<f64> = std::iter::repeat_n(0.0, rigid.len()).chain(omega_rad_s).collect();
        let modes = Self {
            rigid: rigid.len(),
            pieces: rigid.into_iter().chain(elastic).flatten().collect(),
            spans,
            units,
            omega_rad_s,
            fixed: Vec::new(),
            held,
        };
        let resolved = modes.pieces.len() == modes.len() * modes.spans.len()
            && modes.pieces.iter().all(|p| p.size().is_finite())
            && modes.omega_rad_s.iter().all(|omega| omega.is_finite());
        if resolved { Ok(modes) } else { Err(InvalidInput::new("segments", "as given", RESOLVABLE)) }
    }

    /// With masses attached to the structure, on which a uniform acceleration also acts.
    pub(crate) fn with_fixed(self, fixed: Vec<(usize, f64, f64)>) -> Self {
        Self { fixed, ..self }
    }

    /// Number of modes.
    pub fn len(&self) -> usize {
        self.omega_rad_s.len()
    }

    /// Whether no mode was requested.
    pub fn is_empty(&self) -> bool {
        self.omega_rad_s.is_empty()
    }

    /// Number of rigid-body modes; these come first and have `omega = 0`.
    pub fn rigid_body_count(&self) -> usize {
        self.rigid
    }

    /// Length of the structure, m.
    pub fn length_m(&self) -> f64 {
        self.units.length_m
    }

    /// Natural frequencies, rad/s.
    pub fn omega_rad_s(&self) -> &[f64] {
        &self.omega_rad_s
    }

    /// Shape of mode `k` (from 0) at `x_m`, kg^(-1/2).
    ///
    /// # Errors
    /// [`InvalidInput`] for a mode that does not exist or a location outside the structure. The same applies to
    /// [`slope`](Self::slope) and [`curvature`](Self::curvature).
    pub fn shape(&self, k: usize, x_m: f64) -> Result<f64, InvalidInput> {
        let shape = self.quantity(0, k, x_m, Piece::displacement)?;
        Ok(if self.holds(x_m) { 0.0 } else { shape })
    }

    /// Slope of mode `k` at `x_m`, kg^(-1/2)/m.
    ///
    /// # Errors
    /// As for [`shape`](Self::shape).
    pub fn slope(&self, k: usize, x_m: f64) -> Result<f64, InvalidInput> {
        self.quantity(1, k, x_m, Piece::slope)
    }

    /// Rotation of the sections in mode `k` at `x_m`, kg^(-1/2)/m: the slope, except for beams with shear.
    ///
    /// # Errors
    /// As for [`shape`](Self::shape).
    pub fn rotation(&self, k: usize, x_m: f64) -> Result<f64, InvalidInput> {
        self.quantity(1, k, x_m, Piece::rotation)
    }

    /// Derivative of the rotation of mode `k` at `x_m`, kg^(-1/2)/m^2 (without shear, the second derivative of the shape);
    /// times `E I` it is the bending moment. At a step, where it jumps, this is the value on the right.
    ///
    /// # Errors
    /// As for [`shape`](Self::shape).
    pub fn curvature(&self, k: usize, x_m: f64) -> Result<f64, InvalidInput> {
        self.quantity(2, k, x_m, Piece::curvature)
    }

    /// Shapes of all modes at `x_m`, kg^(-1/2).
    ///
    /// # Errors
    /// [`InvalidInput`] for a location outside the structure.
    pub fn shapes_at(&self, x_m: f64) -> Result<Vec<f64>, InvalidInput> {
        let (span, x) = self.place(x_m)?;
        if self.holds(x_m) {
            return Ok(vec![0.0; self.len()]);
        }
        let unit = self.unit(0);
        Ok(self.pieces.chunks(self.spans.len()).map(|mode| unit * mode[span].displacement(x)).collect())
    }

    /// All modes as excited by a force at `x_m`.
    ///
    /// # Errors
    /// As for [`shapes_at`](Self::shapes_at).
    pub fn seen_from(&self, x_m: f64) -> Result<Vec<PointMode>, InvalidInput> {
        Ok(point_modes(&self.omega_rad_s, self.shapes_at(x_m)?))
    }

    /// Participation `int m phi_k dx` of every mode in a uniform acceleration, kg^(1/2): the modal force of the weight divided
    /// by the acceleration of gravity. The squares of all of them add up to the mass. In a structure that is free to translate,
    /// only rigid-body modes participate.
    ///
    /// ```
    /// use beam_modes::{Beam, End, Segment};
    /// let segment = Segment { length_m: 1.0, flexural_rigidity_n_m2: 275.0, mass_per_length_kg_m: 2.0 };
    /// let beam = Beam { segments: vec![segment], ends: [End::Pinned, End::Pinned] };
    /// let participation = beam.modes(2)?.participation_kg0_5();
    /// // a half sine of amplitude sqrt(2 / (m L)), and a full one
    /// assert!((participation[0] - 2.0 * 2.0 / std::f64::consts::PI).abs() < 1e-14);
    /// assert!(participation[1].abs() < 1e-14);
    /// # Ok::<(), beam_modes::InvalidInput>(())
    /// ```
    pub fn participation_kg0_5(&self) -> Vec<f64> {
        let Units { length_m, mass_per_length_kg_m, .. } = self.units;
        let unit = length_m.sqrt() * mass_per_length_kg_m.sqrt();
        let whole = |mode: &[Piece]| -> f64 {
            self.spans.iter().zip(mode).map(|(span, piece)| span.mass * piece.integral()).sum()
        };
        let fixed = |mode: &[Piece]| -> f64 {
            self.fixed.iter().map(|&(span, x, mass)| mass * mode[span].displacement(x)).sum()
        };
        self.pieces.chunks(self.spans.len()).map(|mode| unit * (whole(mode) + fixed(mode))).collect()
    }

    fn quantity(&self, order: i32, k: usize, x_m: f64, value: fn(&Piece, f64) -> f64) -> Result<f64, InvalidInput> {
        if k >= self.len() {
            return Err(InvalidInput::new("k", k, "the index of a mode, from 0 to len() - 1"));
        }
        let (span, x) = self.place(x_m)?;
        Ok(self.unit(order) * value(&self.pieces[k * self.spans.len() + span], x))
    }

    /// Whether a held end or a support is here, to rounding.
    fn holds(&self, x_m: f64) -> bool {
        self.held.iter().any(|held| (x_m / self.units.length_m - held).abs() <= f64::EPSILON)
    }

    fn place(&self, x_m: f64) -> Result<(usize, f64), InvalidInput> {
        let x_m = require_on("x_m", x_m, self.units.length_m)?;
        Ok(locate(&self.spans, x_m / self.units.length_m))
    }

    /// From dimensionless shapes to kg^(-1/2) m^(-order).
    fn unit(&self, order: i32) -> f64 {
        let Units { length_m, mass_per_length_kg_m, .. } = self.units;
        length_m.powi(-order) / (length_m.sqrt() * mass_per_length_kg_m.sqrt())
    }
}
