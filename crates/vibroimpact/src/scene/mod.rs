//! Scenes: an impact as a JSON file poses it.
//!
//! The types mirror the file field by field; [`Scene::impact`] turns them into the solver's terms. Fields are
//! required unless a default is stated. Lengths are in metres, and so on: every name carries its unit.

mod contact;
mod error;
mod fields;
mod infinite;
pub(crate) mod json;
mod materials;
mod sets;
mod striker;
mod structure;

use std::fs::File;
use std::io::Read;
use std::path::Path;

use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value;

use crate::model::{Model, Modes};

pub use contact::Contact;
pub use error::{InvalidInput, SceneError};
pub use infinite::{InfiniteBeam, InfinitePlate};
pub use materials::{HertzStiffness, Materials};
pub use striker::Striker;
pub use structure::{Beam, End, Modal, Segment, Structure};

/// Largest scene file that is read (bytes).
const MAX_FILE_BYTES: u64 = 64 << 20;

/// One impact: what is struck, by what, how they touch, where.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scene {
    /// A text for the reader; may be left out.
    pub description: Option<String>,
    /// What is struck.
    pub structure: Structure,
    /// What strikes it.
    pub striker: Striker,
    /// The law of the contact.
    pub contact: Contact,
    /// Place of the impact, from the left end (m). Required for a beam; a modal structure has none.
    pub location_m: Option<f64>,
    /// Which model answers, [`Scene::answer`]; the program's choice when left out.
    #[serde(skip_serializing_if = "Model::is_auto")]
    pub model: Model,
    /// Modes kept, from the lowest: a number (0 is an immovable structure), or the program's choice when left out.
    #[serde(skip_serializing_if = "Modes::is_auto")]
    pub modes: Modes,
    /// Whether the modes left out answer with their static compliance. When left out: `true` where the program
    /// chooses the modes (and knows that compliance), `false` where their number is given.
    pub residual_compliance: Option<bool>,
    /// Accuracy aimed at in the restitution. When left out: 1e-3, truncation included, where the program chooses the
    /// modes of a beam; that of [`vibroimpact_sim::modal::Settings`] where the modes are given.
    pub tolerance: Option<f64>,
}

/// The file before its two tagged objects are read, so that a fault in them keeps its path.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Outline {
    description: Option<String>,
    structure: Value,
    #[serde(deserialize_with = "json::object")]
    striker: Striker,
    contact: Value,
    location_m: Option<f64>,
    #[serde(default)]
    model: Model,
    #[serde(default)]
    modes: Modes,
    residual_compliance: Option<bool>,
    tolerance: Option<f64>,
}

impl Scene {
    /// Reads a scene from JSON text.
    ///
    /// # Errors
    /// Text that is not JSON, a key that occurs twice, a field that is missing, unknown, or of the wrong type. Values
    /// out of range are found by [`Scene::impact`].
    ///
    /// ```
    /// let fault = vibroimpact::Scene::from_json(r#"{ "structure": { "kind": "bem" } }"#).unwrap_err();
    /// assert!(fault.to_string().contains("striker is missing"));
    /// ```
    pub fn from_json(text: &str) -> Result<Scene, SceneError> {
        Ok(Scene::from_value(&json::parse(text)?)?)
    }

    /// Reads a scene from a JSON tree.
    ///
    /// # Errors
    /// As [`Scene::from_json`], text aside.
    pub fn from_value(value: &Value) -> Result<Scene, InvalidInput> {
        let outline: Outline = json::read(value)?;
        Ok(Scene {
            description: outline.description,
            structure: Structure::from_value(&outline.structure).map_err(|fault| fault.within("structure"))?,
            striker: outline.striker,
            contact: Contact::from_value(&outline.contact).map_err(|fault| fault.within("contact"))?,
            location_m: outline.location_m,
            model: outline.model,
            modes: outline.modes,
            residual_compliance: outline.residual_compliance,
            tolerance: outline.tolerance,
        })
    }

    /// Reads a scene from a JSON file.
    ///
    /// # Errors
    /// As [`Scene::from_json`], or a file that cannot be read.
    pub fn read(path: &Path) -> Result<Scene, SceneError> {
        let fault = |source| SceneError::Read { path: path.to_owned(), source };
        let mut text = String::new();
        File::open(path).map_err(fault)?.take(MAX_FILE_BYTES).read_to_string(&mut text).map_err(fault)?;
        Scene::from_json(&text)
    }

    /// The scene as JSON text, without the fields that are left out.
    ///
    /// # Errors
    /// Never for a scene that was read; a number that is not finite has no JSON form and is left out.
    pub fn to_json(&self) -> String {
        let mut tree = serde_json::to_value(self).unwrap_or_default();
        drop_nulls(&mut tree);
        format!("{tree:#}")
    }
}

impl<'de> Deserialize<'de> for Scene {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Scene, D::Error> {
        Scene::from_value(&Value::deserialize(deserializer)?).map_err(serde::de::Error::custom)
    }
}

fn drop_nulls(tree: &mut Value) {
    match tree {
        Value::Object(entries) => {
            entries.retain(|_, value| !value.is_null());
            entries.values_mut().for_each(drop_nulls);
        }
        Value::Array(items) => items.iter_mut().for_each(drop_nulls),
        _ => {}
    }
}
