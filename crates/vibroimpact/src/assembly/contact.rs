//! The contacts of an assembly.

use contact_models::Law;
use invalid_input::Path;
use schemars::JsonSchema;
use serde::ser::{Serialize, Serializer};
use serde::{Deserialize, Serialize as DeriveSerialize};
use serde_json::{Map, Value};

use super::fields::{BETWEEN, FIELDS};
use crate::scene::fields::{POSITIVE, look_up};
use crate::scene::json::{quote, read};
use crate::scene::require_positive;
use crate::scene::{self, InvalidInput, Location, Striker};

/// A contact of two points along `x`.
///
/// Of `between`, the first, A, lies on the side of greater `x` and the second, B, on the side of smaller `x`. With `u` the
/// displacements along `x`, the compression is `xi = u_B - u_A - gap_m`, and the force pushes A along `+x` and B along
/// `-x`.
#[derive(Debug, Clone, PartialEq, DeriveSerialize, JsonSchema)]
#[schemars(rename = "BodyContact")]
pub struct Contact {
    /// Its name in the results.
    #[schemars(length(min = 1))]
    pub name: String,
    /// The two sides, not both the ground.
    #[schemars(extend("not" = { "items": { "const": "ground" } }))]
    pub between: [Side; 2],
    /// Distance of the surfaces when both bodies are undeformed and in place (m), negative for an interference; 0 when left
    /// out.
    #[serde(default)]
    #[schemars(schema_with = "any_number")]
    pub gap_m: f64,
    /// Whether a second contact stands on the other side of A, at the same distance and with the same law, as in a
    /// clearance; `false` when left out. `NAME+` is the contact as it is given here, which pushes A along `+x`, `NAME-` the one
    /// that pushes A along `-x`.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub two_sided: bool,
    /// Relative radius of curvature at the contact, `1/R = 1/R_A + 1/R_B` (m); needed where the stiffness comes from
    /// materials.
    pub radius_m: Option<f64>,
    /// Speed of approach to which a `restitution` belongs, if the law needs one (m/s).
    pub approach_speed_m_s: Option<f64>,
    /// Mass to which the `restitution` of a Kelvin-Voigt contact belongs, `1/m = 1/m_A + 1/m_B` (kg).
    pub reduced_mass_kg: Option<f64>,
    /// The law, with its parameters beside it.
    #[serde(flatten)]
    pub law: scene::Contact,
}

/// A gap may be negative, unlike that of a scene of one impact.
fn any_number(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
    schemars::json_schema!({ "anyOf": [{ "type": "number" }], "default": 0 })
}

/// One side of a contact.
#[derive(Debug, Clone, PartialEq, JsonSchema)]
#[schemars(untagged)]
pub enum Side {
    /// The ground, which does not move.
    Ground(Ground),
    /// A point of a body.
    Body(Point),
}

/// The name of the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema)]
#[schemars(rename_all = "lowercase")]
pub enum Ground {
    /// `"ground"`
    Ground,
}

/// A point of a body.
#[derive(Debug, Clone, Default, PartialEq, DeriveSerialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "BodyPoint")]
pub struct Point {
    /// Name of the body.
    pub body: String,
    /// Location on a beam, string or rod, from its left end (m); on a plate `[x, y]`.
    pub location_m: Option<Location>,
    /// Name of the point of a modal structure.
    pub location: Option<String>,
}

impl Serialize for Side {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Side::Ground(_) => serializer.serialize_str("ground"),
            Side::Body(point) => point.serialize(serializer),
        }
    }
}

impl Side {
    fn from_value(value: &Value) -> Result<Side, InvalidInput> {
        match value {
            Value::String(name) if name == "ground" => Ok(Side::Ground(Ground::Ground)),
            Value::Object(_) => read(value).map(Side::Body),
            _ => {
                Err(InvalidInput::new(Path::default(), quote(value), look_up(FIELDS, "between[]").unwrap_or_default()))
            }
        }
    }
}

/// Fields in addition to those of the law.
#[derive(Deserialize)]
struct Beside {
    name: String,
    between: Value,
    #[serde(default)]
    gap_m: f64,
    #[serde(default)]
    two_sided: bool,
    radius_m: Option<f64>,
    approach_speed_m_s: Option<f64>,
    reduced_mass_kg: Option<f64>,
}

const BESIDE: [&str; 7] =
    ["name", "between", "gap_m", "two_sided", "radius_m", "approach_speed_m_s", "reduced_mass_kg"];

impl Contact {
    pub(super) fn from_value(value: &Value) -> Result<Contact, InvalidInput> {
        let Some(entries) = value.as_object() else {
            return Err(InvalidInput::new(
                Path::default(),
                quote(value),
                look_up(FIELDS, "contacts[]").unwrap_or_default(),
            ));
        };
        let (beside, law): (Map<String, Value>, Map<String, Value>) =
            entries.clone().into_iter().partition(|(field, _)| BESIDE.contains(&field.as_str()));
        let Beside { name, between, gap_m, two_sided, radius_m, approach_speed_m_s, reduced_mass_kg } =
            read(&Value::Object(beside)).map_err(|fault: InvalidInput| match fault.field.first() {
                Some("gap_m") => {
                    InvalidInput { allowed: "a finite number; negative for an interference".into(), ..fault }
                }
                _ => fault,
            })?;
        let law = scene::Contact::from_value_beside(&Value::Object(law), &BESIDE)?;
        let between = match between.as_array().map(Vec::as_slice) {
            Some([a, b]) => {
                let side = |i: usize, side| Side::from_value(side).map_err(|f| f.at(i).within("between"));
                [side(0, a)?, side(1, b)?]
            }
            _ => return Err(InvalidInput::new("between", quote(&between), BETWEEN)),
        };
        Ok(Contact { name, between, gap_m, two_sided, radius_m, approach_speed_m_s, reduced_mass_kg, law })
    }

    /// Its name in the results, or those of its two.
    pub fn names(&self) -> Vec<String> {
        match self.two_sided {
            false => vec![self.name.clone()],
            true => ["+", "-"].map(|side| format!("{}{side}", self.name)).to_vec(),
        }
    }

    /// The law with its parameters.
    pub(super) fn to_law(&self) -> Result<Law, InvalidInput> {
        for (field, value) in self.references() {
            value.map_or(Ok(()), |value| require_positive(field, value))?;
        }
        let striker = Striker {
            mass_kg: Some(self.reduced_mass_kg.unwrap_or(f64::NAN)),
            radius_m: self.radius_m,
            ..Striker::default()
        };
        let speed_m_s = self.approach_speed_m_s.unwrap_or(f64::NAN);
        self.law.law(&striker, speed_m_s).map_err(|fault| self.own(fault))
    }

    /// A quantity to which a restitution or materials refer: its field here, and the value.
    fn references(&self) -> [(&'static str, Option<f64>); 3] {
        [
            ("reduced_mass_kg", self.reduced_mass_kg),
            ("radius_m", self.radius_m),
            ("approach_speed_m_s", self.approach_speed_m_s),
        ]
    }

    /// An error of the law, with the field names of a contact here.
    fn own(&self, fault: InvalidInput) -> InvalidInput {
        let fault = fault.without("contact").without("striker");
        let place = ["mass_kg", "radius_m", "speed_m_s"].iter().position(|name| fault.field == *name);
        match place.map(|place| self.references()[place]) {
            Some((field, None)) => {
                let needed_for = match field {
                    "radius_m" => "stiffness from materials",
                    _ => "damping from restitution",
                };
                InvalidInput::missing(field, format!("{POSITIVE}, because the {needed_for} needs it"))
            }
            Some((field, Some(_))) => fault.under(field),
            None => fault,
        }
    }
}
