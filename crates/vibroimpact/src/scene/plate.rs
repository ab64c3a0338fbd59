//! A rectangular plate.

use invalid_input::InvalidInput;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use vibroimpact_sim::modal::{Mode, Structure};

use super::damping::require_damping;
use super::sets::{none_stated, stated_as};

/// A frequency has converged if more polynomials would change it by a smaller share than this.
pub const CONVERGED_FREQUENCY: f64 = 1e-5;

/// A uniform rectangular plate, [`beam_modes::Plate`].
///
/// ```
/// use vibroimpact::scene::{Edge, Plate, PlateTheory};
///
/// let plate = Plate {
///     length_m: 0.4,
///     width_m: 0.3,
///     thickness_m: 0.005,
///     youngs_modulus_pa: 2e11,
///     poissons_ratio: 0.3,
///     density_kg_m3: 7800.0,
///     edges: [Edge::Pinned; 4],
///     theory: PlateTheory::Kirchhoff,
///     shear_coefficient: None,
///     damping_ratio: 0.01,
/// };
/// assert!((plate.to_plate()?.modes(1)?.omega_rad_s()[0] - 1312.8).abs() < 0.1);
/// # Ok::<(), vibroimpact::InvalidInput>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("allOf" = theory_and_fields()))]
pub struct Plate {
    /// Length, along x (m).
    pub length_m: f64,
    /// Width, along y (m).
    pub width_m: f64,
    /// Thickness, in the direction of the impact (m).
    pub thickness_m: f64,
    /// Young's modulus (Pa).
    pub youngs_modulus_pa: f64,
    /// Poisson's ratio.
    pub poissons_ratio: f64,
    /// Density (kg/m^3).
    pub density_kg_m3: f64,
    /// How the edges at x = 0, x = length, y = 0 and y = width are held.
    pub edges: [Edge; 4],
    /// The theory of bending; Kirchhoff's when left out.
    #[serde(default)]
    pub theory: PlateTheory,
    /// Shear coefficient of Mindlin's theory; 5/(6 - Poisson's ratio) when left out.
    pub shear_coefficient: Option<f64>,
    /// Damping ratio of every mode; 0 when left out.
    #[serde(default)]
    pub damping_ratio: f64,
}

/// Schema: Mindlin's theory is for plates that are pinned along all edges, and the shear coefficient is its own.
fn theory_and_fields() -> Value {
    json!([{
        "if": stated_as("theory", json!({ "const": "mindlin" })),
        "then": { "properties": { "edges": { "items": { "const": "pinned" } } } },
        "else": none_stated(&["shear_coefficient"]),
    }])
}

/// How an edge of a plate is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Edge {
    /// Neither displacement nor slope.
    Clamped,
    /// No displacement, no moment.
    Pinned,
    /// No moment, no shear force.
    Free,
}

invalid_input::names!(Edge, "edge", { Clamped: "clamped", Pinned: "pinned", Free: "free" });

/// Theory of bending of a plate.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum PlateTheory {
    /// Kirchhoff's theory of thin plates, without shear and rotary inertia.
    #[default]
    Kirchhoff,
    /// Mindlin's theory, with shear and rotary inertia, for a plate that is pinned along all edges and whose number of modes is
    /// stated.
    Mindlin,
}

invalid_input::names!(PlateTheory, "theory", { Kirchhoff: "kirchhoff", Mindlin: "mindlin" });

impl Plate {
    /// The plate in the terms of [`beam_modes`].
    ///
    /// # Errors
    /// A value out of range, or a theory that does not hold for these edges.
    pub fn to_plate(&self) -> Result<beam_modes::Plate, InvalidInput> {
        let edges = self.edges.map(|edge| match edge {
            Edge::Clamped => beam_modes::Edge::Clamped,
            Edge::Pinned => beam_modes::Edge::Pinned,
            Edge::Free => beam_modes::Edge::Free,
        });
        let standard = beam_modes::Plate::shear_coefficient(self.poissons_ratio);
        let theory = match self.theory {
            PlateTheory::Kirchhoff => beam_modes::PlateTheory::Kirchhoff,
            PlateTheory::Mindlin => {
                beam_modes::PlateTheory::Mindlin { shear_coefficient: self.shear_coefficient.unwrap_or(standard) }
            }
        };
        if let (PlateTheory::Kirchhoff, Some(value)) = (self.theory, self.shear_coefficient) {
            let allowed = "left out, unless \"theory\" is \"mindlin\"";
            return Err(InvalidInput::new("shear_coefficient", value.to_string(), allowed));
        }
        let Plate { length_m, width_m, thickness_m, youngs_modulus_pa, poissons_ratio, density_kg_m3, .. } = *self;
        let plate = beam_modes::Plate {
            length_m,
            width_m,
            thickness_m,
            youngs_modulus_pa,
            poissons_ratio,
            density_kg_m3,
            edges,
            theory,
        };
        plate.checked()?;
        Ok(plate)
    }

    /// The first `count` modes, with shapes at any location.
    pub(super) fn modes(&self, count: usize) -> Result<beam_modes::PlateModes, InvalidInput> {
        require_damping(self.damping_ratio).map_err(|fault| fault.within("structure"))?;
        let plate = self.to_plate().map_err(|fault| fault.within("structure"))?;
        plate.modes(count).map_err(in_structure)
    }

    /// Number of converged modes among the first `count`; `None` if they have a closed form.
    pub(crate) fn converged_modes(&self, count: usize) -> Result<Option<usize>, InvalidInput> {
        if self.edges == [Edge::Pinned; 4] {
            return Ok(None);
        }
        Ok(Some(self.modes(count)?.converged(CONVERGED_FREQUENCY)))
    }

    /// The modes with their shapes at a location.
    pub(super) fn seen_from(
        &self,
        modes: &beam_modes::PlateModes,
        [x_m, y_m]: [f64; 2],
    ) -> Result<Vec<Mode>, InvalidInput> {
        let seen = modes.seen_from(x_m, y_m).map_err(in_structure)?;
        Ok(Structure::from_modes(seen, self.damping_ratio).modes)
    }

    /// Static compliance at a location, and its uncertainty (m/N).
    pub(super) fn static_compliance_with_uncertainty_m_n(
        &self,
        [x_m, y_m]: [f64; 2],
    ) -> Result<(f64, f64), InvalidInput> {
        let plate = self.to_plate().map_err(|fault| fault.within("structure"))?;
        plate.static_compliance_with_uncertainty(x_m, y_m).map_err(in_structure)
    }

    /// Frequency of mode `n` by Weyl's law (rad/s), and mean contribution of `n` modes to the inverse mass of a location inside
    /// (1/kg).
    pub(crate) fn estimate(&self, n: usize) -> (f64, f64) {
        let area = self.length_m * self.width_m;
        let rigidity = self.youngs_modulus_pa * self.thickness_m.powi(2) / (12.0 * (1.0 - self.poissons_ratio.powi(2)));
        let omega = 4.0 * std::f64::consts::PI * n as f64 / area * (rigidity / self.density_kg_m3).sqrt();
        (omega, n as f64 / (self.density_kg_m3 * self.thickness_m * area))
    }
}

fn in_structure(fault: InvalidInput) -> InvalidInput {
    match fault.field.first() {
        Some("x_m") => fault.under(("location_m", 0)),
        Some("y_m") => fault.under(("location_m", 1)),
        Some("count") => fault.under("modes"),
        _ => fault.within("structure"),
    }
}
