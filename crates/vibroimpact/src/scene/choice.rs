//! The choices that a scene may leave to the program: the model, and the number of modes.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Unexpected;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

use super::from_tree::whole;

/// The scene field `"model"`, and the model that an answer came from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Model {
    /// The program chooses.
    #[default]
    Auto,
    /// The location does not move: the law's restitution at a wall.
    Rigid,
    /// A beam without ends, [`vibroimpact_sim::infinite`]; for an infinite plate, the plate.
    InfiniteBeam,
    /// Modes and resolved contacts, [`vibroimpact_sim::modal`].
    Modal,
    /// A law for the net restitution, without integration in time.
    Emoc,
}

invalid_input::names!(Model, "model", {
    Auto: "auto",
    Rigid: "rigid",
    InfiniteBeam: "infinite-beam",
    Modal: "modal",
    Emoc: "emoc",
});

impl Model {
    pub(crate) fn is_auto(&self) -> bool {
        *self == Model::Auto
    }
}

/// The scene field `"modes"`: `"auto"`, or how many modes the structure is stated to have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Modes {
    /// As many as the restitution needs to converge.
    #[default]
    Auto,
    /// This many, from the lowest.
    Count(usize),
}

impl Modes {
    /// The number, if one is stated.
    pub fn count(self) -> Option<usize> {
        match self {
            Modes::Auto => None,
            Modes::Count(count) => Some(count),
        }
    }

    pub(crate) fn is_auto(&self) -> bool {
        *self == Modes::Auto
    }
}

impl Serialize for Modes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Modes::Auto => serializer.serialize_str("auto"),
            Modes::Count(count) => serializer.serialize_u64(*count as u64),
        }
    }
}

impl<'de> Deserialize<'de> for Modes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Modes, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Written {
            Count(usize),
            Number(f64),
            Word(String),
        }
        match Written::deserialize(deserializer) {
            Ok(Written::Count(count)) => Ok(Modes::Count(count)),
            Ok(Written::Number(number)) if whole(number).is_some() => Ok(Modes::Count(number as usize)),
            Ok(Written::Word(word)) if word == "auto" => Ok(Modes::Auto),
            _ => {
                let allowed = "\"auto\", or a whole number from 0 to 10000";
                Err(de::Error::invalid_value(Unexpected::Other("another value"), &allowed))
            }
        }
    }
}

impl JsonSchema for Modes {
    fn schema_name() -> Cow<'static, str> {
        "Modes".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "\"auto\", or how many modes the structure is stated to have",
            "anyOf": [{ "const": "auto" }, { "type": "integer", "minimum": 0, "maximum": 10000 }]
        })
    }
}
