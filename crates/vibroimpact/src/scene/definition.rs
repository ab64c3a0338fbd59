//! A scene as it is stated in its file.

use std::path::Path;

use invalid_input::InvalidInput;
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value;

use super::choice::{Model, Modes};
use super::contact::Contact;
use super::error::{self, SceneError};
use super::files::{A_SCENE, FORMAT_VERSION, check_version, plain_tree, read_tree, versioned_tree};
use super::location::Location;
use super::material::numbers_of_materials;
use super::place::Place;
use super::start::Start;
use super::striker::Striker;
use super::structure::Structure;
use super::{json, toml};

/// One impact: the structure, the striker, the law of their contact, and the location.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Scene {
    /// A text for the reader; may be left out.
    pub description: Option<String>,
    /// The struck structure.
    pub structure: Structure,
    /// The striker.
    pub striker: Striker,
    /// The law of the contact.
    pub contact: Contact,
    /// Location of the impact (m): from the left end of a beam or string; on a plate two numbers, `[x, y]` from a corner.
    /// Required for these; other structures have none.
    pub location_m: Option<Location>,
    /// Name of the point that is struck. Required for a modal structure with named points; other structures have none.
    pub location: Option<String>,
    /// The model, see [`Scene::answer`]; chosen by the program when left out.
    #[serde(default, skip_serializing_if = "Model::is_auto")]
    pub model: Model,
    /// Modes retained, from the lowest: a number (0 is an immovable structure); chosen by the program when left out.
    #[serde(default, skip_serializing_if = "Modes::is_auto")]
    pub modes: Modes,
    /// Whether remainder modes represent the truncated modes, so that the restitution converges in the number of modes. When left
    /// out: `true` where the program chooses the modes (and knows the static compliance), `false` where their number is given.
    pub residual_compliance: Option<bool>,
    /// Motion of the structure before the impact; at rest and touched by the striker when left out.
    pub start: Option<Start>,
    /// Acceleration of gravity (m/s^2) for a striker that falls on the structure; 0 when left out. The impact then ends with the first
    /// flight that rises above the undeflected structure by more than a hundredth of the height of the fall, and the restitution is that
    /// of a drop test.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub gravity_m_s2: f64,
    /// Requested accuracy of the restitution. When left out: 1e-3, which includes truncation, where the program chooses the
    /// modes; 1e-9, of the solver alone, where the modes are given.
    pub tolerance: Option<f64>,
    /// Yield strength of the softer body (Pa), against which the pressure in the contact is judged; it changes no result.
    pub yield_strength_pa: Option<f64>,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
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
    _version: Option<f64>,
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
    #[serde(default)]
    gravity_m_s2: f64,
    tolerance: Option<f64>,
    yield_strength_pa: Option<f64>,
}

impl Scene {
    /// A scene with these parts and defaults for all other fields.
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
            gravity_m_s2: 0.0,
            tolerance: None,
            yield_strength_pa: None,
        }
    }

    /// Whether the structure is infinite: [`Scene::infinite_impact`] is then the way to solve the scene, and
    /// [`Scene::impact`] is not.
    pub fn is_infinite(&self) -> bool {
        matches!(self.structure, Structure::InfiniteBeam(_) | Structure::InfinitePlate(_))
    }

    /// Checks the yield strength.
    pub(crate) fn require_yield_strength(&self) -> Result<(), InvalidInput> {
        self.yield_strength_pa.map_or(Ok(()), |strength| error::require_positive("yield_strength_pa", strength))
    }

    /// Whether the striker falls: the impact is under gravity.
    pub(crate) fn falls(&self) -> bool {
        self.gravity_m_s2 != 0.0
    }

    /// Whether the start is more than the height from which the striker falls.
    pub(crate) fn starts_in_motion(&self) -> bool {
        self.start.as_ref().is_some_and(|start| !self.falls() || start.moves())
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
    /// As [`Scene::from_json`], except for the text.
    pub fn from_value(value: &Value) -> Result<Scene, InvalidInput> {
        check_version(value, FORMAT_VERSION, "scene")?;
        if let Some(bodies) = value.get("bodies") {
            let allowed = "left out, because a scene of one impact is needed here, with structure and striker; \
                           `vibroimpact simulate` takes scenes of bodies";
            return Err(InvalidInput::new("bodies", json::quote(bodies), allowed));
        }
        let value = numbers_of_materials(value)?;
        let outline: Outline = json::read_whole(&value, "the scene")?;
        let start = outline.start.as_ref().map(|start| json::read_field(start, "start")).transpose()?;
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
            gravity_m_s2: outline.gravity_m_s2,
            tolerance: outline.tolerance,
            yield_strength_pa: outline.yield_strength_pa,
        };
        let stated = !chooses_modes(&scene);
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

    /// Replaces a structure's `modes-file` by its numbers; `folder` is that of the scene. Other structures are not changed.
    ///
    /// # Errors
    /// A table that cannot be read or used, with its line.
    pub fn read_modes_file(&mut self, folder: &Path) -> Result<(), SceneError> {
        if let Structure::ModesFile(named) = &self.structure {
            self.structure = Structure::Modal(named.load(folder)?);
        }
        Ok(())
    }

    /// The scene as JSON text, with its version and without the fields that are left out. A number that is not finite has no JSON
    /// form and is omitted.
    pub fn to_json(&self) -> String {
        format!("{:#}", self.tree())
    }

    /// The scene as TOML text, in the same form.
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

    /// The location of impact.
    pub(crate) fn place(&self) -> Place<'_> {
        Place { location_m: self.location_m, location: self.location.as_deref() }
    }
}

/// Inserts the numbers of a `modes-file` into the tree of a scene in `folder`. The tree may be incomplete.
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

impl<'de> Deserialize<'de> for Scene {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Scene, D::Error> {
        Scene::from_value(&Value::deserialize(deserializer)?).map_err(serde::de::Error::custom)
    }
}

/// The reason why there is no choice and the stated modes are used. `None` for a structure at rest that is struck by a body of
/// finite mass, to which every model may apply.
pub(crate) fn modal_only(scene: &Scene) -> Option<&'static str> {
    if matches!(scene.structure, Structure::DroppedRod(_)) {
        Some("a dropped rod is resolved in its modes")
    } else if scene.starts_in_motion() {
        Some("the structure moves before the impact")
    } else if scene.striker.immovable {
        Some("the striker is an immovable stop")
    } else {
        None
    }
}

/// Whether the program chooses the number of modes: none is stated, and the restitution has a limit for many modes.
pub(crate) fn chooses_modes(scene: &Scene) -> bool {
    let settles = match &scene.structure {
        Structure::Modal(listed) => listed.gives_compliance(scene.location.as_deref()),
        computed => computed.is_computed(),
    };
    settles && scene.modes == Modes::Auto && modal_only(scene).is_none()
}
