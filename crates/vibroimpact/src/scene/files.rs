//! Files of scenes: their text, their tree, their version.

use std::path::Path;

use invalid_input::InvalidInput;
use serde::Serialize;
use serde_json::Value;

use super::error::SceneError;
use super::{fields, json, toml};
use crate::input::read_bytes;

/// The newest supported version of the scene format; a file without a version has version 1.
pub const FORMAT_VERSION: u64 = 1;

/// Name of the content of a scene file in messages.
pub(crate) const A_SCENE: &str = "a scene";

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

/// The tree of a file, whose expected content is `what`: TOML if its name ends in `.toml`, JSON otherwise.
pub(crate) fn read_tree(path: &Path, what: &str) -> Result<Value, SceneError> {
    let text = utf8(read_bytes(path)?, path)?;
    let is_toml = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
    let read = if is_toml {
        toml::parse(&text).map_err(|found| hinted(found, json::parse(&text, what).is_ok(), "JSON", ".json"))
    } else {
        let is_toml = || !text.trim().is_empty() && toml::parse(&text).is_ok();
        json::parse(&text, what).map_err(|found| hinted(found, is_toml(), "TOML", ".toml"))
    };
    read.map_err(|found| in_file(path, found))
}

/// A syntax error with the name of its file.
fn in_file(path: &Path, found: SceneError) -> SceneError {
    match found {
        SceneError::Syntax { line, column, field, reason } => {
            SceneError::Syntax { line, column, field, reason: format!("{reason} (in {})", path.display()) }
        }
        other => other,
    }
}

/// The bytes of a file as text.
pub(crate) fn utf8(bytes: Vec<u8>, path: &Path) -> Result<String, SceneError> {
    String::from_utf8(bytes).map_err(|fault| SceneError::Read {
        path: path.to_owned(),
        source: std::io::Error::new(std::io::ErrorKind::InvalidData, format!("the text is not UTF-8: {fault}")),
    })
}

/// A syntax error of a text that would be valid in the other format; the file name determines the format.
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

/// Rejects a file in a newer format, before any unknown field is reported.
pub(crate) fn check_version(value: &Value, newest: u64, what: &str) -> Result<(), InvalidInput> {
    // 1.0 is a whole number too, as in the schema
    let whole = |version: &Value| version.as_f64().filter(|number| number.fract() == 0.0);
    let newest_number = newest as f64;
    match value.get("version") {
        Some(version) if whole(version).is_some_and(|version| version > newest_number) => {
            let allowed = format!(
                "at most {newest}, the newest version of the {what} format that this program understands; a newer vibroimpact, \
                 for which the file was written, can read it"
            );
            Err(InvalidInput::new("version", json::quote(version), allowed))
        }
        Some(version) if whole(version) != Some(newest_number) => {
            Err(InvalidInput::new("version", json::quote(version), fields::allowed("version").unwrap_or_default()))
        }
        _ => Ok(()),
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
