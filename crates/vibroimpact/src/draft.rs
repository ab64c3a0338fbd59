//! A scene whose fields can still be changed. It is read from a file, a stream or a text, changed field by field, and then
//! checked as a scene.

use std::io::Read;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::assembly::{AnyScene, AssemblyScene};
use crate::input::read_all;
use crate::scene::{A_SCENE, FieldPath, InvalidInput, Scene, SceneError, json, read_tree, toml, utf8};

/// The fields of a scene before they are checked.
///
/// ```
/// use vibroimpact::draft::Draft;
///
/// let mut draft = Draft::from_text(r#"
///     location_m = 0.3
///     modes = 20
///     structure = { kind = "string", length_m = 1, tension_n = 100, mass_per_length_kg_m = 0.01 }
///     striker = { mass_kg = 0.01, speed_m_s = 1 }
///     contact = { law = "hertz", stiffness_n_m1_5 = 1e7 }
/// "#)?;
/// draft.set("striker.speed_m_s=2.5")?;
/// assert_eq!(draft.impact()?.striker.speed_m_s, 2.5);
/// # Ok::<(), vibroimpact::SceneError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Draft {
    tree: Value,
    /// The folder of the tables that the scene names.
    folder: PathBuf,
    /// The file from which it was read; none for a stream or a text.
    file: Option<PathBuf>,
}

impl Draft {
    /// Reads a file: TOML if its name ends in `.toml`, JSON otherwise.
    ///
    /// # Errors
    /// A file that cannot be read, or text that is neither JSON nor TOML.
    pub fn read(path: &Path) -> Result<Draft, SceneError> {
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        Ok(Draft { tree: read_tree(path, A_SCENE)?, folder, file: Some(path.to_owned()) })
    }

    /// Reads a stream to its end: JSON if it begins with `{` or if all of it is JSON, TOML otherwise. Messages refer to the
    /// stream as `name`. Tables that the scene names are read from the current folder.
    ///
    /// # Errors
    /// As [`Draft::read`].
    pub fn from_reader(source: impl Read, name: &str) -> Result<Draft, SceneError> {
        let name = Path::new(name);
        Draft::from_text(&utf8(read_all(source, name)?, name)?)
    }

    /// Reads text in the same way.
    ///
    /// # Errors
    /// Text that is neither JSON nor TOML.
    pub fn from_text(text: &str) -> Result<Draft, SceneError> {
        let begins = text.trim_start_matches('\u{feff}').trim_start();
        let tree = match json::parse(text, A_SCENE) {
            Ok(tree) => tree,
            // an empty text is not a scene in either format; JSON's message states this
            Err(fault) if begins.is_empty() || begins.starts_with('{') => return Err(fault),
            Err(fault) => match toml::parse(text) {
                // a broken list of JSON
                Err(_) if begins.starts_with('[') && !names_a_table(begins) => return Err(fault),
                read => read?,
            },
        };
        Ok(Draft { tree, folder: PathBuf::new(), file: None })
    }

    /// Sets one field, as in `striker.speed_m_s=2`, `structure.segments[0].material=steel` or
    /// `structure.ends=["clamped","free"]`. The value is JSON; anything else is treated as a text. Missing objects on the path are
    /// created.
    ///
    /// # Errors
    /// A missing `=`, an invalid path, an index beyond the end of a list, or invalid JSON after a bracket or quotation mark. An
    /// unknown field is reported when the scene is read.
    pub fn set(&mut self, assignment: &str) -> Result<(), InvalidInput> {
        let fault = |allowed: &str| InvalidInput::new("--set", assignment, allowed);
        let (field, text) = assignment.split_once('=').ok_or_else(|| fault(ASSIGNMENT))?;
        let field = FieldPath::parse(field.trim()).ok_or_else(|| fault(ASSIGNMENT))?;
        let text = text.trim();
        let value = match json::parse(text, "a value") {
            Ok(value) => value,
            Err(_) if text.starts_with(['{', '[', '"']) => {
                return Err(fault("FIELD=VALUE, in which a value that begins with {, [ or \" is complete JSON"));
            }
            Err(_) => Value::String(text.to_owned()),
        };
        field.set_or_insert(&mut self.tree, value).map_err(|reason| fault(&format!("{ASSIGNMENT}, but {reason}")))
    }

    /// The present fields, and the folder of the tables that they name.
    pub(crate) fn tree(&self) -> (&Value, &Path) {
        (&self.tree, &self.folder)
    }

    /// The files from which the scene is read: its own, if there is one, and the tables that it names.
    pub fn files(&self) -> Vec<PathBuf> {
        let mut tables = Vec::new();
        collect_tables(&self.tree, &mut tables);
        self.file.iter().cloned().chain(tables.into_iter().map(|name| self.folder.join(name))).collect()
    }

    /// The scene of one impact.
    ///
    /// # Errors
    /// As [`Scene::read`].
    pub fn impact(&self) -> Result<Scene, SceneError> {
        let mut scene = Scene::from_value(&self.tree)?;
        scene.read_modes_file(&self.folder)?;
        Ok(scene)
    }

    /// The scene of bodies.
    ///
    /// # Errors
    /// As [`AssemblyScene::read`].
    pub fn bodies(&self) -> Result<AssemblyScene, SceneError> {
        let mut scene = AssemblyScene::from_value(&self.tree)?;
        scene.read_tables(&self.folder)?;
        Ok(scene)
    }

    /// The scene, of either kind.
    ///
    /// # Errors
    /// As [`AnyScene::read`].
    pub fn any(&self) -> Result<AnyScene, SceneError> {
        let mut scene = AnyScene::from_value(&self.tree)?;
        scene.read_tables(&self.folder)?;
        Ok(scene)
    }
}

/// The names of all tables below a field. In every object of a scene that has one, it is the value of `file`.
fn collect_tables<'a>(field: &'a Value, tables: &mut Vec<&'a str>) {
    match field {
        Value::Object(fields) => {
            tables.extend(fields.get("file").and_then(Value::as_str));
            fields.values().for_each(|field| collect_tables(field, tables));
        }
        Value::Array(items) => items.iter().for_each(|item| collect_tables(item, tables)),
        _ => {}
    }
}

/// Whether the first line is the name of a table of TOML, with or without a comment.
fn names_a_table(text: &str) -> bool {
    let line = text.lines().next().unwrap_or_default();
    line.split('#').next().is_some_and(|name| name.trim_end().ends_with(']'))
}

const ASSIGNMENT: &str = "FIELD=VALUE with the path of a field, as in striker.speed_m_s=2";
