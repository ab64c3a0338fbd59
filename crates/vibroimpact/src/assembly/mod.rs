//! Scenes of many bodies and contacts under loads, over long times.
//!
//! Such a scene has `bodies` in place of the `structure` and the `striker` of a scene of one impact. Everything moves
//! along one axis `x`, in SI units:
//!
//! | field | meaning |
//! |---|---|
//! | `bodies` | the bodies by their names: [`Body`] |
//! | `contacts` | the points at which they may touch each other or the ground: [`Contact`] |
//! | `gravity_m_s2` | gravity along `-x` on every body; default 0 |
//! | `loads` | forces: [`Load`] |
//! | `ground_motion` | a motion of the ground: [`GroundMotion`] |
//! | `static_start` | whether elastic modes start at their deflection under the constant loads; default `false` |
//! | `end_s` | time at which the run ends |
//! | `statistics_from_s` | time from which statistics of the contacts are taken; default 0 |
//! | `tolerance` | requested accuracy of the impulses; default 1e-9 |
//!
//! Bodies start undeformed and at rest unless the scene states another start.

mod body;
mod compression;
mod contact;
pub(crate) mod fields;
#[cfg(feature = "files")]
mod files;
mod load;
#[cfg(feature = "files")]
mod pictures;
mod pose;
#[cfg(feature = "files")]
mod report;
mod rod;
mod schema;
mod seen;
mod simulate;
mod spectrum;
mod steady;
mod summary;
mod text;
mod watch;

use std::collections::BTreeMap;
use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

pub use body::{Body, Elastic, Elastics, Mass, MassKind, Start};
pub use contact::{Contact, Ground, Point, Side};
#[cfg(feature = "files")]
pub use files::{IntervalFiles, NAMES, files, history};
pub use load::{GroundMotion, Load};
#[cfg(feature = "files")]
pub use pictures::picture;
pub use pose::Posed;
#[cfg(feature = "files")]
pub use report::report;
pub use rod::{AxialEnd, AxialSegment, Rod, RodKind};
pub use simulate::{MOST_INTERVALS, Simulation, Wanted};
pub use spectrum::SpectrumSamples;
pub use steady::SteadyMotion;
pub use summary::{BodyEnergy, Cost, Energy, Interval, Point as EndPoint, Statistics, Summary};
pub use text::{headline, result};
pub use watch::{Course, Row, Sink};

use crate::scene::{
    A_SCENE, FORMAT_VERSION, InvalidInput, Scene, SceneError, check_version, json, numbers_of_materials, plain_tree,
    read_tree, toml, versioned_tree,
};

/// A scene file: one impact, or bodies, contacts and loads.
#[derive(Debug, Clone, PartialEq)]
pub enum AnyScene {
    /// A scene with a structure and a striker.
    Impact(Box<Scene>),
    /// A scene with bodies.
    Bodies(Box<AssemblyScene>),
}

impl AnyScene {
    /// Reads a scene from a JSON tree.
    ///
    /// # Errors
    /// As [`Scene::from_value`] and [`AssemblyScene::from_value`].
    pub fn from_value(value: &Value) -> Result<AnyScene, InvalidInput> {
        // a scene with contacts but without a structure is missing its bodies, which the error then names
        let of_bodies =
            value.get("bodies").is_some() || value.get("contacts").is_some() && value.get("structure").is_none();
        Ok(match of_bodies {
            true => AnyScene::Bodies(Box::new(AssemblyScene::from_value(value)?)),
            false => AnyScene::Impact(Box::new(Scene::from_value(value)?)),
        })
    }

    /// Reads a scene from a file: TOML if its name ends in `.toml`, JSON otherwise. Tables that the scene names are read
    /// too, and their numbers take their place.
    ///
    /// # Errors
    /// A file that cannot be read, and as [`AnyScene::from_value`].
    pub fn read(path: &Path) -> Result<AnyScene, SceneError> {
        let mut scene = AnyScene::from_value(&read_tree(path, A_SCENE)?)?;
        scene.read_tables(path.parent().unwrap_or(Path::new("")))?;
        Ok(scene)
    }

    /// Reads a scene from JSON text. Tables that it names are left to [`AnyScene::read_tables`].
    ///
    /// # Errors
    /// Text that is not JSON, and as [`AnyScene::from_value`].
    pub fn from_json(text: &str) -> Result<AnyScene, SceneError> {
        Ok(AnyScene::from_value(&json::parse(text, A_SCENE)?)?)
    }

    /// Replaces the names of tables by their numbers; `folder` is that of the scene.
    ///
    /// # Errors
    /// A table that cannot be read or used, with its line.
    pub fn read_tables(&mut self, folder: &Path) -> Result<(), SceneError> {
        match self {
            AnyScene::Impact(scene) => scene.read_modes_file(folder),
            AnyScene::Bodies(scene) => scene.read_tables(folder),
        }
    }
}

/// Many bodies and contacts under loads.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct AssemblyScene {
    /// A text for the reader; may be left out.
    pub description: Option<String>,
    /// The bodies by their names.
    #[schemars(extend("minProperties" = 1, "propertyNames" = { "not": { "enum": ["", "ground"] } }))]
    pub bodies: BTreeMap<String, Body>,
    /// Where they may touch each other or the ground.
    pub contacts: Vec<Contact>,
    /// Gravity along `-x` on every body (m/s^2); 0 when left out. A structure that is given by its modes then states its
    /// `gravity_participation_kg0_5`.
    #[serde(default)]
    pub gravity_m_s2: f64,
    /// Forces on the bodies; several on one body add up.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<Load>,
    /// A motion of the ground; at rest when left out.
    pub ground_motion: Option<GroundMotion>,
    /// Whether elastic modes start at their static deflection under gravity and the constant loads, without the contacts; `false`,
    /// undeformed, when left out.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub static_start: bool,
    /// Time at which the run ends (s).
    pub end_s: f64,
    /// Time from which statistics of the contacts are taken (s), before `end_s`, as after a transient motion; 0 when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub statistics_from_s: Option<f64>,
    /// Allowed error of the impulse on a step, relative to the largest momentum exchanged by its contact so far, 1e-13 to 0.1;
    /// 1e-9 when left out.
    #[schemars(range(min = 1e-13, max = 0.1))]
    pub tolerance: Option<f64>,
}

/// The file before its bodies and contacts are read, so that a fault in them keeps its path.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Outline {
    description: Option<String>,
    #[serde(rename = "$schema")]
    _schema: Option<String>,
    #[serde(rename = "version")]
    _version: Option<f64>,
    bodies: Map<String, Value>,
    contacts: Vec<Value>,
    #[serde(default)]
    gravity_m_s2: f64,
    #[serde(default, deserialize_with = "json::objects")]
    loads: Vec<Load>,
    ground_motion: Option<Value>,
    #[serde(default)]
    static_start: bool,
    end_s: f64,
    statistics_from_s: Option<f64>,
    tolerance: Option<f64>,
}

impl AssemblyScene {
    /// Reads a scene from JSON text.
    ///
    /// # Errors
    /// Text that is not JSON, a key that occurs twice, a newer version of the format, a field that is missing,
    /// unknown, or of the wrong type. Values out of range are found by [`AssemblyScene::pose`].
    pub fn from_json(text: &str) -> Result<AssemblyScene, SceneError> {
        Ok(AssemblyScene::from_value(&json::parse(text, A_SCENE)?)?)
    }

    /// Reads a scene from TOML text, which holds the same fields.
    ///
    /// # Errors
    /// As [`AssemblyScene::from_json`].
    pub fn from_toml(text: &str) -> Result<AssemblyScene, SceneError> {
        Ok(AssemblyScene::from_value(&toml::parse(text)?)?)
    }

    /// Reads a scene from a JSON tree.
    ///
    /// # Errors
    /// As [`AssemblyScene::from_json`], except for the text.
    pub fn from_value(value: &Value) -> Result<AssemblyScene, InvalidInput> {
        check_version(value, FORMAT_VERSION, "scene")?;
        if value.get("bodies").is_none()
            && let Some(structure) = value.get("structure")
        {
            let allowed = "left out, because a scene of bodies is needed here, with bodies, contacts and end_s; \
                           `vibroimpact simulate` takes scenes of one impact";
            return Err(InvalidInput::new("structure", json::quote(structure), allowed));
        }
        let value = numbers_of_materials(value)?;
        let outline: Outline = json::read_whole(&value, "the scene")?;
        let body = |(name, value): (String, Value)| {
            let body = Body::from_value(&value).map_err(|fault| fault.within(["bodies", &name]))?;
            Ok((name, body))
        };
        let contact =
            |(i, value): (usize, &Value)| Contact::from_value(value).map_err(|fault| fault.at(i).within("contacts"));
        let motion = |value: &Value| json::read_field(value, "ground_motion");
        Ok(AssemblyScene {
            description: outline.description,
            bodies: outline.bodies.into_iter().map(body).collect::<Result<_, InvalidInput>>()?,
            contacts: outline.contacts.iter().enumerate().map(contact).collect::<Result<_, _>>()?,
            gravity_m_s2: outline.gravity_m_s2,
            loads: outline.loads,
            ground_motion: outline.ground_motion.as_ref().map(motion).transpose()?,
            static_start: outline.static_start,
            end_s: outline.end_s,
            statistics_from_s: outline.statistics_from_s,
            tolerance: outline.tolerance,
        })
    }

    /// Reads a scene from a file: TOML if its name ends in `.toml`, JSON otherwise. Tables that the scene names are read
    /// too, and their numbers take their place.
    ///
    /// # Errors
    /// As [`AssemblyScene::from_json`], or a file or a table that cannot be read.
    pub fn read(path: &Path) -> Result<AssemblyScene, SceneError> {
        let mut scene = AssemblyScene::from_value(&read_tree(path, A_SCENE)?)?;
        scene.read_tables(path.parent().unwrap_or(Path::new("")))?;
        Ok(scene)
    }

    /// Replaces the names of tables of modes and of histories by their numbers; `folder` is that of the scene.
    ///
    /// # Errors
    /// A table that cannot be read or used, with its line.
    pub fn read_tables(&mut self, folder: &Path) -> Result<(), SceneError> {
        for (name, body) in &mut self.bodies {
            body.read_table(folder).map_err(|fault| of_table(fault, ["bodies", name]))?;
        }
        for (i, load) in self.loads.iter_mut().enumerate() {
            load.read_table(folder).map_err(|fault| of_table(fault, ("loads", i)))?;
        }
        match &mut self.ground_motion {
            Some(motion) => motion.read_table(folder).map_err(|fault| of_table(fault, "ground_motion")),
            None => Ok(()),
        }
    }

    /// The scene as JSON text, with its version and without the fields that are left out.
    pub fn to_json(&self) -> String {
        format!("{:#}", versioned_tree(self))
    }

    /// The scene as TOML text, in the same form.
    ///
    /// # Errors
    /// A whole number that TOML cannot hold, which is never one that a scene may have.
    pub fn to_toml(&self) -> Result<String, InvalidInput> {
        toml::write(&versioned_tree(self))
    }
}

/// Inserts the numbers of tables into the tree of a scene of bodies in `folder`. The tree may be incomplete; objects that name no
/// table are not changed.
pub(crate) fn read_tables_into(tree: &mut Value, folder: &Path) -> Result<(), SceneError> {
    fn replace<T: Serialize>(
        value: &mut Value,
        path: impl Into<invalid_input::Path>,
        read: impl FnOnce(&Value) -> Result<T, SceneError>,
    ) -> Result<(), SceneError> {
        if value.get("file").is_some() {
            *value = plain_tree(&read(value).map_err(|fault| of_table(fault, path))?);
        }
        Ok(())
    }
    for (name, body) in tree.get_mut("bodies").and_then(Value::as_object_mut).into_iter().flatten() {
        replace(body, ["bodies", name.as_str()], |value| {
            let mut body = Body::from_value(value)?;
            body.read_table(folder)?;
            Ok(body)
        })?;
    }
    for (i, load) in tree.get_mut("loads").and_then(Value::as_array_mut).into_iter().flatten().enumerate() {
        replace(load, ("loads", i), |value| {
            let mut load: Load = json::read(value)?;
            load.read_table(folder)?;
            Ok(load)
        })?;
    }
    let Some(motion) = tree.get_mut("ground_motion") else { return Ok(()) };
    replace(motion, "ground_motion", |value| {
        let mut motion: GroundMotion = json::read(value)?;
        motion.read_table(folder)?;
        Ok(motion)
    })
}

/// An error of a field with the path of its object; an error within the table names the table.
fn of_table(fault: SceneError, path: impl Into<invalid_input::Path>) -> SceneError {
    match fault {
        SceneError::Invalid(fault) if !fault.field.has_place() => fault.within(path).into(),
        other => other,
    }
}
