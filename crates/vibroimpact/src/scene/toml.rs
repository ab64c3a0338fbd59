//! TOML as a second format of scenes: converts text to the same tree as JSON, and back.

use invalid_input::{InvalidInput, Path, Step};
use serde_json::{Map, Number, Value};

use super::error::SceneError;
use super::fields;
use super::told::shorten;

/// Parses TOML text. The format itself rejects keys that occur twice.
pub(crate) fn parse(text: &str) -> Result<Value, SceneError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let table: toml::Table = text.parse().map_err(|fault| syntax_error(text, &fault))?;
    Ok(tree(toml::Value::Table(table), &Path::default())?)
}

fn syntax_error(text: &str, fault: &toml::de::Error) -> SceneError {
    let at = fault.span().map_or(0, |span| span.start).min(text.len());
    let before = text.get(..at).unwrap_or_default();
    let line_start = before.rfind('\n').map_or(0, |end| end + 1);
    let rest = &text[before.len()..];
    let word = &rest[..rest.find(|c| !is_word(c)).unwrap_or(rest.len())];
    let (field, reason) = match fault.message() {
        "duplicate key" => (Path::default(), format!("the key {word:?} occurs twice")),
        // each way to read a whole number has an error of its own for it
        _ if is_large(word) => {
            let key =
                before.trim_end().strip_suffix('=').map(|before| before.trim_end().rsplit(|c| !is_word(c)).next());
            let field = key.flatten().map_or_else(Path::default, Path::from);
            (field, format!("the whole number {} has more than 64 bits; as 1e20 it is a number", shorten(word)))
        }
        told => (Path::default(), told.trim_end().replace('\n', "; ")),
    };
    SceneError::Syntax {
        line: before.matches('\n').count() + 1,
        column: before[line_start..].chars().count() + 1,
        field,
        reason,
    }
}

/// Whether this is a part of a bare key or of a number.
fn is_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '+')
}

/// Whether this is a whole number that TOML does not have.
fn is_large(word: &str) -> bool {
    let digits = word.trim_start_matches(['+', '-']);
    let whole = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit() || byte == b'_');
    whole && word.replace('_', "").parse::<i64>().is_err()
}

/// The tree as JSON. Numbers that are not finite are reported as values of their field; dates become texts.
fn tree(value: toml::Value, path: &Path) -> Result<Value, InvalidInput> {
    Ok(match value {
        toml::Value::String(text) => Value::String(text),
        toml::Value::Integer(number) => number.into(),
        toml::Value::Float(number) => Number::from_f64(number).map(Value::Number).ok_or_else(|| {
            InvalidInput::new(path.clone(), number.to_string(), fields::allowed_at(path).unwrap_or("a finite number"))
        })?,
        toml::Value::Boolean(value) => Value::Bool(value),
        toml::Value::Datetime(date) => Value::String(date.to_string()),
        toml::Value::Array(items) => {
            let item = |(i, item)| tree(item, &Path::from(Step::Index(i)).within(path.clone()));
            Value::Array(items.into_iter().enumerate().map(item).collect::<Result<_, _>>()?)
        }
        toml::Value::Table(entries) => {
            let entry = |(key, value): (String, toml::Value)| {
                let value = tree(value, &Path::from(key.as_str()).within(path.clone()))?;
                Ok((key, value))
            };
            Value::Object(entries.into_iter().map(entry).collect::<Result<Map<_, _>, InvalidInput>>()?)
        }
    })
}

/// The text of a tree in which nothing is null.
pub(crate) fn write(tree: &Value) -> Result<String, InvalidInput> {
    let written = toml::Table::try_from(tree).and_then(|table| toml::to_string(&table));
    written.map_err(|fault| {
        InvalidInput::new(
            "the scene",
            fault.to_string(),
            "without whole numbers of 2^63 and above, which TOML does not have",
        )
    })
}
