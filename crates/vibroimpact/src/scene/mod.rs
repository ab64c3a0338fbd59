//! Scenes: an impact as a JSON or TOML file poses it.
//!
//! The types mirror the file field by field; [`Scene::impact`] turns them into the solver's terms. Fields are
//! required unless a default is stated. Lengths are in metres, and so on: every name carries its unit. A file may say
//! `"version": 1`, the version of this format, and an editor may find the schema by its `"$schema"`. Where an object
//! takes numbers of a material, it may name one of [`MATERIALS`] instead: `"material": "steel"`.
//!
//! A scene can as well be put together in Rust:
//!
//! ```
//! use vibroimpact::model::Modes;
//! use vibroimpact::scene::{Beam, Contact, End, HertzStiffness, Scene, Segment, Striker};
//!
//! let beam = Beam {
//!     segments: vec![Segment::rectangular(1.0, 2e11, 7800.0, 0.011323, 0.011323)],
//!     damping_ratio: 0.02,
//!     ..Beam::new([End::Pinned, End::Pinned])
//! };
//! let scene = Scene {
//!     location_m: Some(0.6180339887498949.into()),
//!     modes: Modes::Count(100),
//!     residual_compliance: Some(true),
//!     ..Scene::new(beam, Striker::sphere(7800.0, 0.015, 1.0), Contact::Hertz(HertzStiffness::of_material(2e11, 0.3)))
//! };
//! let solution = scene.impact()?.solve()?;
//! assert!((solution.restitution.unwrap() - 0.142555).abs() < 2e-6);
//! # Ok::<(), vibroimpact::InvalidInput>(())
//! ```

mod beam;
mod contact;
mod dropped_rod;
mod error;
pub(crate) mod fields;
mod fittings;
mod infinite;
pub(crate) mod json;
mod known;
mod location;
mod material;
mod materials;
mod modal;
mod modes_file;
mod path;
mod plate;
mod remainder;
pub mod schema;
mod segment;
pub(crate) mod sets;
mod start;
mod striker;
mod string;
mod structure;
mod theory;
pub(crate) mod told;
pub(crate) mod toml;

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value;

use crate::model::{Model, Modes};

pub use beam::{Beam, End};
pub use contact::Contact;
pub use dropped_rod::DroppedRod;
pub use error::SceneError;
pub(crate) use error::{as_json, require_positive};
pub use fittings::{Attachment, Support};
pub use infinite::{InfiniteBeam, InfinitePlate};
pub use invalid_input::InvalidInput;
pub(crate) use known::KnownModes;
pub use location::Location;
pub use material::{MATERIALS, NamedMaterial};
pub use materials::{HertzStiffness, Materials};
pub use modal::{Modal, Point};
pub use modes_file::ModesFile;
pub use path::FieldPath;
pub use plate::{CONVERGED_FREQUENCY, Edge, Plate, PlateTheory};
pub(crate) use remainder::{COMPLETE, require_elastic};
pub use segment::Segment;
pub use start::{MovingMode, Start};
pub use striker::Striker;
pub use string::TautString;
pub use structure::{MOST_MODES, Structure};
pub use theory::{BeamTheory, TheoryVariant};

use crate::input::read_bytes;
pub(crate) use material::numbers_of_materials;
pub(crate) use modes_file::table_path;
pub(crate) use structure::{Place, require_count};

/// The newest version of the scene format that is understood; a file without a version has version 1.
pub const FORMAT_VERSION: u64 = 1;

/// What a scene file holds, in messages.
pub(crate) const A_SCENE: &str = "a scene";

/// One impact: what is struck, by what, how they touch, where.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Scene {
    /// A text for the reader; may be left out.
    pub description: Option<String>,
    /// What is struck.
    pub structure: Structure,
    /// What strikes it.
    pub striker: Striker,
    /// The law of the contact.
    pub contact: Contact,
    /// Location of the impact (m): from the left end of a beam or string; on a plate two numbers, `[x, y]` from a corner.
    /// Required for these; other structures have none.
    pub location_m: Option<Location>,
    /// Name of the point that is struck. Required for a modal structure with named points; other structures have none.
    pub location: Option<String>,
    /// Which model answers, [`Scene::answer`]; the program's choice when left out.
    #[serde(default, skip_serializing_if = "Model::is_auto")]
    pub model: Model,
    /// Modes retained, from the lowest: a number (0 is an immovable structure), or the program's choice when left out.
    #[serde(default, skip_serializing_if = "Modes::is_auto")]
    pub modes: Modes,
    /// Whether remainder modes represent the truncated modes, so that the restitution converges in the number of modes. When left
    /// out: `true` where the program chooses the modes (and knows the static compliance), `false` where their number is given.
    pub residual_compliance: Option<bool>,
    /// Motion of the structure before the impact; at rest and touched by the striker when left out.
    pub start: Option<Start>,
    /// Accuracy aimed at in the restitution. When left out: 1e-3, truncation included, where the program chooses the
    /// modes; 1e-9, that of the solver alone, where the modes are given.
    pub tolerance: Option<f64>,
    /// Yield strength of the softer body (Pa), against which the pressure in the contact is judged; it changes no result.
    pub yield_strength_pa: Option<f64>,
}

/// The file before its two tagged objects are read, so that a fault in them keeps its path.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Outline {
    description: Option<String>,
    structure: Value,
    #[serde(rename = "$schema")]
    _schema: Option<String>,
    #[serde(rename = "version")]
    _version: Option<u64>,
    #[serde(deserialize_with = "json::object")]
    striker: Striker,
    contact: Value,
    location_m: Option<Location>,
    location: Option<String>,
    #[serde(default)]
    model: Model,
    #[serde(default)]
    modes: Modes,
    residual_compliance: Option<bool>,
    start: Option<Value>,
    tolerance: Option<f64>,
    yield_strength_pa: Option<f64>,
}

impl Scene {
    /// A scene of these, with all else left out.
    pub fn new(structure: impl Into<Structure>, striker: Striker, contact: Contact) -> Scene {
        Scene {
            description: None,
            structure: structure.into(),
            striker,
            contact,
            location_m: None,
            location: None,
            model: Model::Auto,
            modes: Modes::Auto,
            residual_compliance: None,
            start: None,
            tolerance: None,
            yield_strength_pa: None,
        }
    }

    /// Accepts a yield strength that can be one.
    pub(crate) fn require_yield_strength(&self) -> Result<(), InvalidInput> {
        self.yield_strength_pa.map_or(Ok(()), |strength| error::require_positive("yield_strength_pa", strength))
    }

    /// Reads a scene from JSON text.
    ///
    /// # Errors
    /// Text that is not JSON, a key that occurs twice, a newer version of the format, a field that is missing,
    /// unknown, or of the wrong type. Values out of range are found by [`Scene::impact`].
    ///
    /// ```
    /// let fault = vibroimpact::Scene::from_json(r#"{ "structure": { "kind": "bem" } }"#).unwrap_err();
    /// assert!(fault.to_string().contains("striker is missing"));
    /// ```
    pub fn from_json(text: &str) -> Result<Scene, SceneError> {
        Ok(Scene::from_value(&json::parse(text, A_SCENE)?)?)
    }

    /// Reads a scene from TOML text, which holds the same fields.
    ///
    /// # Errors
    /// As [`Scene::from_json`].
    ///
    /// ```
    /// let scene = vibroimpact::Scene::from_toml(r#"
    ///     structure = { kind = "modal", omega_rad_s = [100, 400], shape_at_location = [1, 1] }
    ///     striker = { mass_kg = 1, speed_m_s = 1 }
    ///     contact = { law = "hertz", stiffness_n_m1_5 = 1e10 }
    /// "#)?;
    /// assert_eq!(scene, vibroimpact::Scene::from_json(&scene.to_json())?);
    /// # Ok::<(), vibroimpact::SceneError>(())
    /// ```
    pub fn from_toml(text: &str) -> Result<Scene, SceneError> {
        Ok(Scene::from_value(&toml::parse(text)?)?)
    }

    /// Reads a scene from a JSON tree.
    ///
    /// # Errors
    /// As [`Scene::from_json`], text aside.
    pub fn from_value(value: &Value) -> Result<Scene, InvalidInput> {
        check_version(value, FORMAT_VERSION, "scene")?;
        if let Some(bodies) = value.get("bodies") {
            let allowed = "left out: this asks for a scene of one impact, with structure and striker; `vibroimpact \
                           simulate` takes scenes of bodies";
            return Err(InvalidInput::new("bodies", json::quote(bodies), allowed));
        }
        let value = numbers_of_materials(value)?;
        let outline: Outline = json::read_whole(&value, "the scene")?;
        let start = outline.start.as_ref().map(json::read).transpose().map_err(|fault| fault.within("start"))?;
        let mut scene = Scene {
            description: outline.description,
            structure: Structure::from_value(&outline.structure).map_err(|fault| fault.within("structure"))?,
            striker: outline.striker,
            contact: Contact::from_value(&outline.contact).map_err(|fault| fault.within("contact"))?,
            location_m: outline.location_m,
            location: outline.location,
            model: outline.model,
            modes: outline.modes,
            residual_compliance: outline.residual_compliance,
            start,
            tolerance: outline.tolerance,
            yield_strength_pa: outline.yield_strength_pa,
        };
        let stated = !crate::model::chooses_modes(&scene);
        if let Structure::Beam(beam) = &mut scene.structure
            && stated
        {
            beam.as_the_thesis();
        }
        Ok(scene)
    }

    /// Reads a scene from a file: TOML if its name ends in `.toml`, JSON otherwise. A table of modes that the scene
    /// names is read too, and its numbers take its place.
    ///
    /// # Errors
    /// As [`Scene::from_json`], a file that cannot be read, or a table of modes that cannot be used.
    pub fn read(path: &Path) -> Result<Scene, SceneError> {
        let mut scene = Scene::from_value(&read_tree(path, A_SCENE)?)?;
        scene.read_modes_file(path.parent().unwrap_or(Path::new("")))?;
        Ok(scene)
    }

    /// Puts the numbers of a structure's `modes-file` in its place; `folder` is that of the scene. Other structures
    /// stay as they are.
    ///
    /// # Errors
    /// A table that cannot be read or used, with its line.
    pub fn read_modes_file(&mut self, folder: &Path) -> Result<(), SceneError> {
        if let Structure::ModesFile(named) = &self.structure {
            self.structure = Structure::Modal(named.load(folder)?);
        }
        Ok(())
    }

    /// The scene as JSON text, with its version and without the fields that are left out. A number that is not finite
    /// has no JSON form and is left out.
    pub fn to_json(&self) -> String {
        format!("{:#}", self.tree())
    }

    /// The scene as TOML text, likewise.
    ///
    /// # Errors
    /// A whole number that TOML cannot hold, which is never one that a scene may have.
    pub fn to_toml(&self) -> Result<String, InvalidInput> {
        toml::write(&self.tree())
    }

    /// The scene as a JSON tree, with its version and without the fields that are left out.
    pub(crate) fn tree(&self) -> Value {
        versioned_tree(self)
    }

    /// Where the structure is struck.
    pub(crate) fn place(&self) -> Place<'_> {
        Place { location_m: self.location_m, location: self.location.as_deref() }
    }
}

/// A scene as a tree, with its version and without the fields that are left out.
pub(crate) fn versioned_tree(scene: &impl Serialize) -> Value {
    let mut tree = plain_tree(scene);
    if let Value::Object(entries) = &mut tree {
        entries.insert("version".to_owned(), FORMAT_VERSION.into());
    }
    tree
}

/// A part of a scene as a tree without the fields that are left out.
pub(crate) fn plain_tree(part: &impl Serialize) -> Value {
    let mut tree = serde_json::to_value(part).unwrap_or_default();
    drop_nulls(&mut tree);
    tree
}

/// The tree of a file, which should hold `what`: TOML if its name ends in `.toml`, JSON otherwise.
pub(crate) fn read_tree(path: &Path, what: &str) -> Result<Value, SceneError> {
    let text = utf8(read_bytes(path)?, path)?;
    let is_toml = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
    if is_toml {
        toml::parse(&text).map_err(|found| hinted(found, json::parse(&text, what).is_ok(), "JSON", ".json"))
    } else {
        let is_toml = || !text.trim().is_empty() && toml::parse(&text).is_ok();
        json::parse(&text, what).map_err(|found| hinted(found, is_toml(), "TOML", ".toml"))
    }
}

/// The bytes of a file as text.
pub(crate) fn utf8(bytes: Vec<u8>, path: &Path) -> Result<String, SceneError> {
    String::from_utf8(bytes).map_err(|fault| SceneError::Read {
        path: path.to_owned(),
        source: std::io::Error::new(std::io::ErrorKind::InvalidData, format!("the text is not UTF-8: {fault}")),
    })
}

/// A fault in the syntax of a text that would be none in another format: the name decides the format.
fn hinted(found: SceneError, is_other: bool, format: &str, ending: &str) -> SceneError {
    match found {
        SceneError::Syntax { line, column, field, reason } if is_other => SceneError::Syntax {
            line,
            column,
            field,
            reason: format!("{reason}; the text is {format}, which is read from a file whose name ends in {ending}"),
        },
        other => other,
    }
}

/// Puts the numbers of a `modes-file` into the tree of a scene that stands in `folder`. The tree need not be a whole
/// scene.
pub(crate) fn read_modes_into(tree: &mut Value, folder: &Path) -> Result<(), SceneError> {
    let Some(structure) = tree.get_mut("structure") else { return Ok(()) };
    if structure.get("kind").is_some_and(|kind| kind == "modes-file")
        && let Structure::ModesFile(named) =
            Structure::from_value(structure).map_err(|fault| fault.within("structure"))?
    {
        *structure = plain_tree(&Structure::Modal(named.load(folder)?));
    }
    Ok(())
}

/// A file of a newer format is told as that, before any field that only the newer format knows.
pub(crate) fn check_version(value: &Value, newest: u64, what: &str) -> Result<(), InvalidInput> {
    match value.get("version") {
        Some(version) if version.as_u64().is_some_and(|version| version > newest) => {
            let allowed = format!(
                "this program understands versions of the {what} format up to {newest}; the file was written for a \
                 newer vibroimpact, which can read it"
            );
            Err(InvalidInput::new("version", json::quote(version), allowed))
        }
        Some(version) if version.as_u64() != Some(newest) => {
            Err(InvalidInput::new("version", json::quote(version), fields::allowed("version").unwrap_or_default()))
        }
        _ => Ok(()),
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
