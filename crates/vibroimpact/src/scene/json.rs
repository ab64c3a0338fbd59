//! Converts text to typed values. Every error (of syntax, or a repeated key, a missing, unknown or mistyped field) has the path
//! of its field.

use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;

use invalid_input::{InvalidInput, Path, Step};
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{DeserializeOwned, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};
use serde_path_to_error::Segment;

use super::error::SceneError;
use super::fields;
use super::from_tree::{Fault, from_tree};
use super::material::names_beside;
use super::told::{did_you_mean, did_you_mean_one_of, shorten};
pub(crate) use super::told::{number, quote};

/// A JSON tree in which no key occurs twice (a plain `Value` keeps the last silently).
struct Tree(Value);

struct TreeVisitor;

impl<'de> Deserialize<'de> for Tree {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Tree, D::Error> {
        deserializer.deserialize_any(TreeVisitor).map(Tree)
    }
}

impl<'de> Visitor<'de> for TreeVisitor {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_bool<E: Error>(self, value: bool) -> Result<Value, E> {
        Ok(Value::Bool(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Value, E> {
        Number::from_f64(value).map(Value::Number).ok_or_else(|| E::custom("number out of range"))
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_unit<E: Error>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Value, A::Error> {
        let mut list = Vec::new();
        while let Some(Tree(item)) = items.next_element()? {
            list.push(item);
        }
        Ok(Value::Array(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        let mut map = Map::new();
        while let Some(key) = entries.next_key::<String>()? {
            let Tree(value) = entries.next_value()?;
            if map.insert(key.clone(), value).is_some() {
                return Err(A::Error::custom(format!("the key {key:?} occurs twice")));
            }
        }
        Ok(Value::Object(map))
    }
}

/// Parses JSON text, which should hold `what`. Numbers that are not finite (`NaN`, `1e999`) are reported as values of
/// their field.
pub(crate) fn parse(text: &str, what: &str) -> Result<Value, SceneError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut source = serde_json::Deserializer::from_str(text);
    match serde_path_to_error::deserialize::<_, Tree>(&mut source) {
        Ok(Tree(value)) => {
            source.end().map(|()| value).map_err(|fault| syntax_error(text, what, Path::default(), &fault))
        }
        Err(fault) => Err(syntax_error(text, what, render(fault.path()), fault.inner())),
    }
}

fn syntax_error(text: &str, what: &str, field: Path, fault: &serde_json::Error) -> SceneError {
    let word = word_at(text, fault.line(), fault.column());
    if !field.is_empty() && word.parse::<f64>().is_ok_and(|number| !number.is_finite()) {
        let allowed = fields::allowed_at(&field).unwrap_or("a finite number");
        return InvalidInput::new(field, shorten(word), allowed).into();
    }
    let (line, column) = (fault.line(), fault.column());
    let told = fault.to_string();
    // the error states line and column separately
    let told = told.strip_suffix(&format!(" at line {line} column {column}")).unwrap_or(&told);
    let reason = if fault.is_eof() {
        format!("the text ends too early ({told}); {what} is one complete JSON object")
    } else {
        told.to_owned()
    };
    SceneError::Syntax { line, column, field, reason }
}

/// The word of letters, digits and signs around a place in the text.
fn word_at(text: &str, line: usize, column: usize) -> &str {
    let Some(line) = text.lines().nth(line.saturating_sub(1)) else { return "" };
    let is_word = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '+' | '-');
    let place = (0..=column.saturating_sub(1).min(line.len())).rev().find(|&i| line.is_char_boundary(i)).unwrap_or(0);
    let before = line[..place].rsplit(|c| !is_word(c)).next().map_or(0, str::len);
    let after = line[place..].split(|c| !is_word(c)).next().map_or(0, str::len);
    &line[place - before..place + after]
}

/// A `T` written as a JSON object. (Derived readers take a bare list of a struct's values as well, which a scene
/// should not.)
struct Object<T>(T);

struct ObjectVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Object<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Object<T>, D::Error> {
        deserializer.deserialize_map(ObjectVisitor(PhantomData)).map(Object)
    }
}

impl<'de, T: Deserialize<'de>> Visitor<'de> for ObjectVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, entries: A) -> Result<T, A::Error> {
        T::deserialize(MapAccessDeserializer::new(entries))
    }
}

/// For `deserialize_with`: a struct that must be written as an object.
pub(crate) fn object<'de, T: Deserialize<'de>, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    Object::deserialize(deserializer).map(|Object(inner)| inner)
}

/// For `deserialize_with`: a list of structs that must be written as objects.
pub(crate) fn objects<'de, T: Deserialize<'de>, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<T>, D::Error> {
    Vec::deserialize(deserializer).map(|items| items.into_iter().map(|Object(inner)| inner).collect())
}

/// For `deserialize_with`: structs by name that must be written as objects.
pub(crate) fn named_objects<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<BTreeMap<String, T>, D::Error> {
    let items = BTreeMap::<String, Object<T>>::deserialize(deserializer)?;
    Ok(items.into_iter().map(|(name, Object(inner))| (name, inner)).collect())
}

/// Reads a `T` from a tree that must be an object; faults carry the path within `value`.
pub(crate) fn read<T: DeserializeOwned>(value: &Value) -> Result<T, InvalidInput> {
    read_beside(value, &[])
}

/// As [`read`], for an object whose fields are read in two parts: the message about an unknown field also lists the fields of
/// the other part.
pub(crate) fn read_beside<T: DeserializeOwned>(value: &Value, beside: &[&str]) -> Result<T, InvalidInput> {
    read_told(value, beside, fields::allowed_at)
}

/// As [`read`], for the object in the field of this name; faults carry the path from there.
pub(crate) fn read_field<T: DeserializeOwned>(value: &Value, name: &str) -> Result<T, InvalidInput> {
    let allowed_at = |field: &Path| if field.is_empty() { fields::allowed(name) } else { fields::allowed_at(field) };
    read_told(value, &[], allowed_at).map_err(|fault| fault.within(name))
}

/// As [`read`]; an error of the whole object refers to it as `what`.
pub(crate) fn read_whole<T: DeserializeOwned>(value: &Value, what: &str) -> Result<T, InvalidInput> {
    of_whole(read(value), what)
}

/// As [`read_whole`], for a file whose fields are not those of a scene: `allowed_at` gives the allowed values of a field.
pub(crate) fn read_other<T: DeserializeOwned>(
    value: &Value,
    what: &str,
    allowed_at: impl Fn(&Path) -> Option<&'static str>,
) -> Result<T, InvalidInput> {
    of_whole(read_told(value, &[], allowed_at), what)
}

fn of_whole<T>(read: Result<T, InvalidInput>, what: &str) -> Result<T, InvalidInput> {
    read.map_err(|fault| if fault.field.is_empty() { fault.in_place(what) } else { fault })
}

/// As [`read_beside`], with the allowed values of each field.
pub(crate) fn read_told<T: DeserializeOwned>(
    value: &Value,
    beside: &[&str],
    allowed_at: impl Fn(&Path) -> Option<&'static str>,
) -> Result<T, InvalidInput> {
    // following the path doubles the cost of reading, and only an error needs it
    if let Ok(Object(inner)) = Object::deserialize(value) {
        return Ok(inner);
    }
    from_tree(value).map(|Object(inner)| inner).map_err(|fault| {
        let path = fault.path().clone();
        match fault.into_inner() {
            Fault::Missing(name) => {
                let field = Path::from(name).within(render(&path));
                let allowed = allowed_at(&field).unwrap_or("given");
                InvalidInput::missing(field, allowed)
            }
            Fault::Unknown { name, known } => {
                // the path may or may not end in the unknown name
                let holder = render(&path);
                let field =
                    if holder.last() == Some(&name) { holder } else { Path::from(name.as_str()).within(holder) };
                let found = at(value, &path).map(|inner| inner.get(&name).unwrap_or(inner));
                let beside = if field.steps().len() == 1 { beside } else { &[] };
                unknown_field(field, found.unwrap_or(&Value::Null), known.iter().chain(beside).copied())
            }
            Fault::NotAllowed { allowed } => {
                let field = render(&path);
                let found = at(value, &path);
                let mut allowed = allowed_at(&field).map_or(allowed, str::to_owned);
                if let Some(Value::String(word)) = found {
                    allowed += &did_you_mean_one_of(word, &allowed);
                }
                InvalidInput::new(field, found.map_or_else(String::new, quote), allowed)
            }
        }
    })
}

/// A name that its object does not have, and those that it has.
pub(crate) fn unknown_field<'a>(field: Path, value: &Value, known: impl Iterator<Item = &'a str>) -> InvalidInput {
    let mut names: Vec<&str> = known.collect();
    names.extend(names_beside(&names));
    let meant = did_you_mean(field.last().unwrap_or_default(), names.iter().copied());
    let allowed = format!("one of {}{meant}", names.join(", "));
    InvalidInput::unknown(field, quote(value), allowed)
}

/// A fault of a field that may be missing.
pub(crate) fn found(field: impl Into<Path>, value: Option<&Value>, allowed: impl Into<String>) -> InvalidInput {
    match value {
        Some(value) => InvalidInput::new(field, quote(value), allowed),
        None => InvalidInput::missing(field, allowed),
    }
}

/// Takes the entry `tag`, which names the kind of an object, out of the object; the rest are the fields of this kind.
pub(crate) fn split_tag<'k>(
    value: &Value,
    tag: &str,
    kinds: &[&'k str],
) -> Result<(&'k str, Map<String, Value>), InvalidInput> {
    let fault = |field: Path, value: Option<&Value>| {
        let mut allowed = fields::allowed(tag).unwrap_or_default().to_owned();
        allowed += &value.and_then(Value::as_str).map_or_else(String::new, |word| did_you_mean(word, kinds.to_vec()));
        found(field, value, allowed)
    };
    let Value::Object(map) = value else { return Err(fault(Path::default(), Some(value))) };
    let mut rest = map.clone();
    let named = rest.remove(tag);
    let kind = kinds.iter().find(|kind| named.as_ref().is_some_and(|named| named == *kind));
    kind.map(|kind| (*kind, rest)).ok_or_else(|| fault(tag.into(), named.as_ref()))
}

/// The path without the part that serde could not name.
fn render(path: &serde_path_to_error::Path) -> Path {
    let step = |segment: &Segment| match segment {
        Segment::Seq { index } => Some(Step::Index(*index)),
        Segment::Map { key } => Some(Step::Field(key.clone())),
        Segment::Enum { .. } | Segment::Unknown => None,
    };
    path.iter().filter_map(step).collect()
}

fn at<'a>(value: &'a Value, path: &serde_path_to_error::Path) -> Option<&'a Value> {
    path.iter().try_fold(value, |inner, segment| match segment {
        Segment::Seq { index } => inner.get(index),
        Segment::Map { key } => inner.get(key),
        Segment::Enum { .. } | Segment::Unknown => Some(inner),
    })
}
