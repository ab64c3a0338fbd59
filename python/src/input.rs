//! Input from Python: mappings, and names of files.

use std::path::{Path, PathBuf};

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyMapping;
use vibroimpact::assembly::{AnyScene, AssemblyScene};
use vibroimpact::identify::Data;
use vibroimpact::sweep::Sweep;
use vibroimpact::{Scene, SceneError};

use crate::errors::Fault;

/// A mapping, as JSON text, or the name of a file.
pub enum Source {
    /// JSON text.
    Text(String),
    /// A file.
    File(PathBuf),
}

impl<'a, 'py> FromPyObject<'a, 'py> for Source {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Source> {
        if given.cast::<PyMapping>().is_ok() {
            let convert = given.py().import("vibroimpact._convert")?;
            return Ok(Source::Text(convert.call_method1("to_json", (given,))?.extract()?));
        }
        path(given, "a mapping").map(Source::File)
    }
}

/// The name of a file, if another type would have been accepted too.
fn path(given: Borrowed<'_, '_, PyAny>, or: &str) -> PyResult<PathBuf> {
    given.extract().map_err(|_| {
        let kind = given.get_type().name().map_or_else(|_| String::new(), |name| format!(", not {name}"));
        PyTypeError::new_err(format!("expected {or} or the path of a file{kind}"))
    })
}

/// Columns, as a table of comma-separated values, or the name of a file.
pub enum Columns {
    /// The table.
    Text(String),
    /// A file.
    File(PathBuf),
}

impl<'a, 'py> FromPyObject<'a, 'py> for Columns {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Columns> {
        // A mapping, or an object with columns as in pandas.
        if given.hasattr("keys")? {
            let convert = given.py().import("vibroimpact._convert")?;
            return Ok(Columns::Text(convert.call_method1("to_csv", (given,))?.extract()?));
        }
        path(given, "a mapping of columns").map(Columns::File)
    }
}

impl Columns {
    /// Measured impacts. Force histories that the table names are in its folder, or in the current folder.
    pub fn measured(&self) -> Result<Data, SceneError> {
        match self {
            Columns::Text(table) => Data::from_table(table.as_bytes(), Path::new("")),
            Columns::File(path) => Data::read(path),
        }
    }

    /// Possible experiments.
    pub fn candidates(&self) -> Result<Data, SceneError> {
        match self {
            Columns::Text(table) => Data::parse_candidates(table.as_bytes()),
            Columns::File(path) => Data::read_candidates(path),
        }
    }
}

impl Source {
    /// The scene, of one impact or of bodies.
    pub fn any_scene(&self) -> Result<AnyScene, SceneError> {
        match self {
            Source::Text(text) => {
                let mut scene = AnyScene::from_json(text)?;
                scene.read_tables(Path::new(""))?;
                Ok(scene)
            }
            Source::File(path) => AnyScene::read(path),
        }
    }

    /// The scene, which must be one of bodies.
    pub fn bodies(&self) -> Result<AssemblyScene, SceneError> {
        match self {
            Source::Text(text) => {
                let mut scene = AssemblyScene::from_json(text)?;
                scene.read_tables(Path::new(""))?;
                Ok(scene)
            }
            Source::File(path) => AssemblyScene::read(path),
        }
    }

    /// The scene, which must be one of one impact.
    pub fn scene(&self) -> Result<Scene, Fault> {
        match self {
            Source::Text(text) => {
                let mut scene = Scene::from_json(text)?;
                scene.read_modes_file(Path::new(""))?;
                Ok(scene)
            }
            Source::File(path) => Ok(Scene::read(path)?),
        }
    }

    /// The sweep.
    pub fn sweep(&self) -> Result<Sweep, Fault> {
        match self {
            Source::Text(text) => Ok(Sweep::from_json(text)?),
            Source::File(path) => Ok(Sweep::read(path)?),
        }
    }
}
