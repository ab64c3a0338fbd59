//! Material, dimensions and boundary conditions of a plate.

use crate::location::require_on;
use invalid_input::{InvalidInput, most_extreme};

/// The boundary condition at an edge of a plate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Edge {
    /// Zero displacement and slope.
    Clamped,
    /// Zero displacement and moment (simply supported).
    Pinned,
    /// Zero moment and shear force.
    Free,
}

invalid_input::names!(Edge, "edge", { Clamped: "clamped", Pinned: "pinned", Free: "free" });

/// The theory of bending.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum PlateTheory {
    /// Thin plate: normals stay normal, and there is no rotary inertia.
    Kirchhoff,
    /// Shear and rotary inertia, for a plate that is pinned along all edges, with this shear coefficient `kappa`. A point load
    /// has no finite static deflection in this theory: it grows as the logarithm of the highest wave number.
    Mindlin {
        /// Shear coefficient; see [`Plate::shear_coefficient`].
        shear_coefficient: f64,
    },
}

/// A uniform, isotropic rectangular plate.
///
/// `x` runs along `length_m`, `y` along `width_m`, both from a corner.
///
/// ```
/// use beam_modes::{Edge, Plate, PlateTheory};
///
/// let plate = Plate {
///     length_m: 0.4,
///     width_m: 0.3,
///     thickness_m: 0.005,
///     youngs_modulus_pa: 2e11,
///     poissons_ratio: 0.3,
///     density_kg_m3: 7800.0,
///     edges: [Edge::Clamped, Edge::Free, Edge::Free, Edge::Free],
///     theory: PlateTheory::Kirchhoff,
/// };
/// let modes = plate.modes(10)?;
/// // 3.4711 sqrt(D/(rho h))/a^2 for a square; a wider plate is stiffer across
/// assert!(modes.omega_rad_s()[0] > 100.0 && modes.rigid_body_count() == 0);
/// let tip = modes.shapes_at(0.4, 0.15)?;
/// let sum: f64 = modes.omega_rad_s().iter().zip(&tip).map(|(omega, phi)| (phi / omega).powi(2)).sum();
/// assert!(plate.static_compliance(0.4, 0.15)? > sum);
/// # Ok::<(), beam_modes::InvalidInput>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Plate {
    /// Length `a`, along `x` (m).
    pub length_m: f64,
    /// Width `b`, along `y` (m).
    pub width_m: f64,
    /// Thickness `h` (m).
    pub thickness_m: f64,
    /// Young's modulus (Pa).
    pub youngs_modulus_pa: f64,
    /// Poisson's ratio, greater than -1 and not greater than 0.5.
    pub poissons_ratio: f64,
    /// Density (kg/m^3).
    pub density_kg_m3: f64,
    /// The edges at `x = 0`, `x = length_m`, `y = 0`, `y = width_m`.
    pub edges: [Edge; 4],
    /// The theory of bending.
    pub theory: PlateTheory,
}

impl Plate {
    /// The shear coefficient of a plate that agrees best with elasticity for long and short waves, `5/(6 - nu)` (N. G. Stephen,
    /// *J. Sound Vib.* 202 (1997) 539).
    pub fn shear_coefficient(poissons_ratio: f64) -> f64 {
        5.0 / (6.0 - poissons_ratio)
    }

    /// Flexural rigidity `D = E h^3 / (12 (1 - nu^2))` (N m).
    pub fn flexural_rigidity_n_m(&self) -> f64 {
        self.youngs_modulus_pa * self.thickness_m.powi(3) / (12.0 * (1.0 - self.poissons_ratio.powi(2)))
    }

    /// Mass per area `rho h` (kg/m^2).
    pub fn mass_per_area_kg_m2(&self) -> f64 {
        self.density_kg_m3 * self.thickness_m
    }

    /// Mass (kg).
    pub fn mass_kg(&self) -> f64 {
        self.mass_per_area_kg_m2() * self.length_m * self.width_m
    }

    /// Number of rigid-body motions: 3 if the plate is free, 1 if a single edge is pinned and the others are free.
    pub fn rigid_body_count(&self) -> usize {
        let count = |edge: Edge| self.edges.iter().filter(|here| **here == edge).count();
        match (count(Edge::Clamped), count(Edge::Pinned)) {
            (0, 0) => 3,
            (0, 1) => 1,
            _ => 0,
        }
    }

    pub(super) fn pinned_all_round(&self) -> bool {
        self.edges == [Edge::Pinned; 4]
    }

    /// Accepts a plate that can be computed.
    ///
    /// # Errors
    /// A length, modulus or density that is not positive, a Poisson's ratio or shear coefficient out of range, Mindlin's theory
    /// for a plate that is not pinned along all edges, or a ratio of length and width beyond 10,000.
    pub fn checked(&self) -> Result<(), InvalidInput> {
        let sizes = [
            ("length_m", self.length_m),
            ("width_m", self.width_m),
            ("thickness_m", self.thickness_m),
            ("youngs_modulus_pa", self.youngs_modulus_pa),
            ("density_kg_m3", self.density_kg_m3),
        ];
        for (field, value) in sizes {
            InvalidInput::require_positive(field, value)?;
        }
        let nu = self.poissons_ratio;
        if !(nu > -1.0 && nu <= 0.5) {
            let allowed = "a number greater than -1 and not greater than 0.5";
            return Err(InvalidInput::new("poissons_ratio", nu, allowed));
        }
        if let PlateTheory::Mindlin { shear_coefficient } = self.theory {
            let in_range = shear_coefficient > 0.0 && shear_coefficient <= 2.0;
            let allowed = "a number greater than 0 and not greater than 2";
            InvalidInput::unless(in_range, "shear_coefficient", shear_coefficient, allowed)?;
            if !self.pinned_all_round() {
                let allowed = "\"kirchhoff\" for a plate that is not pinned along all four edges";
                return Err(InvalidInput::new("theory", "mindlin", allowed));
            }
        }
        if !(1e-4..=1e4).contains(&(self.width_m / self.length_m)) {
            let allowed = "from a ten-thousandth of length_m to ten thousand times length_m";
            return Err(InvalidInput::new("width_m", self.width_m, allowed));
        }
        let (rigidity, mass) = (self.flexural_rigidity_n_m(), self.mass_kg());
        let largest = (rigidity / self.mass_per_area_kg_m2()).sqrt() / self.length_m.min(self.width_m).powi(2);
        let products = [rigidity, mass, largest, 1.0 / mass, self.length_m.max(self.width_m).powi(2) / rigidity];
        if products.iter().all(|product| (1e-200..1e200).contains(product)) {
            return Ok(());
        }
        let (field, value) = most_extreme(sizes).unwrap_or_default();
        Err(InvalidInput::new(field, value, "part of a plate whose modes double precision can represent"))
    }

    /// A location as shares of length and width.
    pub(super) fn place(&self, x_m: f64, y_m: f64) -> Result<(f64, f64), InvalidInput> {
        let x_m = require_on("x_m", x_m, self.length_m)?;
        let y_m = require_on("y_m", y_m, self.width_m)?;
        Ok((x_m / self.length_m, y_m / self.width_m))
    }
}
