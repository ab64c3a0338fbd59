//! A location on a structure, by its distance along it or by two coordinates.

use std::borrow::Cow;

use invalid_input::InvalidInput;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::json::number;

/// A location on a structure (m): a distance from the left end of a beam or string, or the two coordinates of a location on a
/// plate, from a corner along length and width.
///
/// ```
/// use vibroimpact::scene::Location;
///
/// assert_eq!(Location::from(0.4), Location::Along(0.4));
/// assert_eq!(serde_json::from_str::<Location>("[0.2, 0.15]").unwrap(), Location::On([0.2, 0.15]));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Location {
    /// Distance from the left end (m).
    Along(f64),
    /// Coordinates along length and width (m).
    On([f64; 2]),
}

impl From<f64> for Location {
    fn from(x_m: f64) -> Location {
        Location::Along(x_m)
    }
}

impl From<[f64; 2]> for Location {
    fn from(place_m: [f64; 2]) -> Location {
        Location::On(place_m)
    }
}

impl Location {
    /// The distance along a beam or string.
    pub(crate) fn along(self) -> Result<f64, InvalidInput> {
        match self {
            Location::Along(x_m) => Ok(x_m),
            Location::On(_) => {
                let allowed = "a single number, the distance from the left end";
                Err(InvalidInput::new("location_m", self.to_string(), allowed))
            }
        }
    }

    /// The coordinates on a plate.
    pub(crate) fn on(self) -> Result<[f64; 2], InvalidInput> {
        match self {
            Location::On(place_m) => Ok(place_m),
            Location::Along(_) => {
                let allowed = "two numbers, [x, y] from a corner of the plate";
                Err(InvalidInput::new("location_m", self.to_string(), allowed))
            }
        }
    }
}

impl std::fmt::Display for Location {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Location::Along(x_m) => f.write_str(&number(*x_m)),
            Location::On([x_m, y_m]) => write!(f, "[{}, {}]", number(*x_m), number(*y_m)),
        }
    }
}

impl JsonSchema for Location {
    fn schema_name() -> Cow<'static, str> {
        "Location".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": ["number", "array"], "items": { "type": "number" }, "minItems": 2, "maxItems": 2 })
    }
}
