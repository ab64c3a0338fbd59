//! A rod along `x`, in axial vibration.

use std::f64::consts::PI;

use beam_modes::{Modes, RodEnd, RodSegment};
use invalid_input::{InvalidInput, Path, Step};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::scene::fields::{allowed_at, look_up, name_at};
use crate::scene::json::{objects, read_told};
use crate::scene::sets::{one_of_sets, schema_of_sets};
use crate::scene::{follows_from, require_positive};

/// A straight rod of uniform segments along `x`, whose points move along it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rod {
    /// `"rod"`.
    pub kind: RodKind,
    /// How the ends at `location_m` 0 and at the full length are held.
    pub ends: [AxialEnd; 2],
    /// The segments; at least one.
    #[serde(deserialize_with = "objects")]
    #[schemars(length(min = 1))]
    pub segments: Vec<AxialSegment>,
    /// Damping ratio of every mode; 0 when left out.
    #[serde(default)]
    pub damping_ratio: f64,
}

/// The name of the kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum RodKind {
    /// `"rod"`
    Rod,
}

/// How an end of a rod is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum AxialEnd {
    /// No displacement.
    Fixed,
    /// No force.
    Free,
}

invalid_input::names!(AxialEnd, "end", { Fixed: "fixed", Free: "free" });

/// A uniform piece of a rod: its length, and its section in one of three ways: axial rigidity and mass per length;
/// material and area; or material and diameter.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = schema_of_sets(&SECTIONS)))]
pub struct AxialSegment {
    /// Length (m).
    pub length_m: f64,
    /// Axial rigidity `EA` (N).
    pub axial_rigidity_n: Option<f64>,
    /// Mass per length (kg/m).
    pub mass_per_length_kg_m: Option<f64>,
    /// Young's modulus (Pa).
    pub youngs_modulus_pa: Option<f64>,
    /// Density (kg/m^3).
    pub density_kg_m3: Option<f64>,
    /// Area of the section (m^2).
    pub area_m2: Option<f64>,
    /// Diameter of a circular section (m).
    pub diameter_m: Option<f64>,
}

/// The ways to give a section.
const SECTIONS: [&[&str]; 3] = [
    &["axial_rigidity_n", "mass_per_length_kg_m"],
    &["youngs_modulus_pa", "density_kg_m3", "area_m2"],
    &["youngs_modulus_pa", "density_kg_m3", "diameter_m"],
];

/// Allowed values of the ends, whose names differ from those of a beam.
const ENDS: [(&str, &str); 2] =
    [("ends", "a list of two, the left and the right end, each one of fixed, free"), ("ends[]", "one of fixed, free")];

impl Rod {
    pub(super) fn from_value_beside(value: &Value, beside: &[&str]) -> Result<Rod, InvalidInput> {
        let allowed_at = |field: &Path| look_up(&ENDS, &name_at(field)).or_else(|| allowed_at(field));
        read_told(value, beside, allowed_at)
    }

    /// The rod as input of [`beam_modes`].
    ///
    /// # Errors
    /// A segment whose section is not given in exactly one way, or by numbers that are not positive.
    pub fn to_rod(&self) -> Result<beam_modes::Rod, InvalidInput> {
        let segment =
            |(i, segment): (usize, &AxialSegment)| segment.to_segment().map_err(|fault| fault.at(i).within("segments"));
        Ok(beam_modes::Rod {
            segments: self.segments.iter().enumerate().map(segment).collect::<Result<_, _>>()?,
            ends: self.ends.map(|end| match end {
                AxialEnd::Fixed => RodEnd::Fixed,
                AxialEnd::Free => RodEnd::Free,
            }),
        })
    }

    /// The first `count` modes.
    pub(super) fn modes(&self, count: usize) -> Result<Modes, InvalidInput> {
        self.to_rod()?.modes(count).map_err(|fault| {
            let [Step::Field(_), Step::Index(i), Step::Field(_)] = *fault.field.steps() else { return fault };
            let own = self.segments.get(i).and_then(|segment| segment.in_given_fields(&fault));
            own.map_or(fault, |own| own.at(i).within("segments"))
        })
    }
}

impl AxialSegment {
    /// The error of a property of the section as that of a field from which it follows; `None` if the segment gives it.
    fn in_given_fields(&self, fault: &InvalidInput) -> Option<InvalidInput> {
        let (quantity, material) = match fault.field.last() {
            Some("axial_rigidity_n") => ("axial rigidity", ("youngs_modulus_pa", self.youngs_modulus_pa)),
            Some("mass_per_length_kg_m") => ("mass per length", ("density_kg_m3", self.density_kg_m3)),
            _ => return None,
        };
        let given = [material, ("area_m2", self.area_m2), ("diameter_m", self.diameter_m)];
        let fields: Vec<(&str, f64)> = given.into_iter().filter_map(|(field, value)| Some((field, value?))).collect();
        follows_from(quantity, fault, &fields)
    }

    fn to_segment(self) -> Result<RodSegment, InvalidInput> {
        let given = [
            ("axial_rigidity_n", self.axial_rigidity_n),
            ("mass_per_length_kg_m", self.mass_per_length_kg_m),
            ("youngs_modulus_pa", self.youngs_modulus_pa),
            ("density_kg_m3", self.density_kg_m3),
            ("area_m2", self.area_m2),
            ("diameter_m", self.diameter_m),
        ];
        let set = one_of_sets(&given, &SECTIONS)?;
        for (field, value) in std::iter::once(("length_m", Some(self.length_m))).chain(given) {
            value.map_or(Ok(()), |value| require_positive(field, value))?;
        }
        let [rigidity, mass, modulus, density, area, diameter] = given.map(|(_, value)| value.unwrap_or_default());
        let area_m2 = if set == 1 { area } else { PI / 4.0 * diameter.powi(2) };
        Ok(match set {
            0 => RodSegment { length_m: self.length_m, axial_rigidity_n: rigidity, mass_per_length_kg_m: mass },
            _ => RodSegment {
                length_m: self.length_m,
                axial_rigidity_n: modulus * area_m2,
                mass_per_length_kg_m: density * area_m2,
            },
        })
    }
}
