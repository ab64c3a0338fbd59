//! Paths of fields, as in `structure.segments[0].length_m`.

use std::fmt;

use invalid_input::{Path, Step};
use serde_json::{Map, Value};

use super::told::counted;

/// The path of a field in a scene file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FieldPath(Path);

/// Names of numbers that are settings.
const SETTINGS: [&str; 6] = ["version", "modes", "mode", "tolerance", "bending_modes", "axial_modes"];

impl FieldPath {
    /// Reads a path; `None` for an invalid one.
    pub(crate) fn parse(text: &str) -> Option<FieldPath> {
        let mut steps = Vec::new();
        for piece in text.split('.') {
            let (key, mut rest) = piece.split_at(piece.find('[').unwrap_or(piece.len()));
            if key.is_empty() || key.contains(']') {
                return None;
            }
            steps.push(Step::Field(key.to_owned()));
            while !rest.is_empty() {
                let (index, after) = rest.strip_prefix('[')?.split_once(']')?;
                if !index.bytes().all(|byte| byte.is_ascii_digit()) {
                    return None;
                }
                steps.push(Step::Index(index.parse().ok()?));
                rest = after;
            }
        }
        Some(FieldPath(steps.into_iter().collect()))
    }

    /// The field at these steps. Unlike in a text, the name of a body may contain dots and brackets.
    pub(crate) fn of(steps: Path) -> FieldPath {
        FieldPath(steps)
    }

    /// The value at this path.
    pub(crate) fn get<'a>(&self, tree: &'a Value) -> Option<&'a Value> {
        self.0.steps().iter().try_fold(tree, |place, step| match step {
            Step::Field(key) => place.get(key),
            Step::Index(index) => place.get(index),
            _ => None,
        })
    }

    /// Sets the value at this path. The objects that contain the field must exist; the field itself need not.
    ///
    /// # Errors
    /// Names the missing object.
    pub(crate) fn set(&self, tree: &mut Value, value: Value) -> Result<(), String> {
        let mut place = tree;
        for (depth, step) in self.0.steps().iter().enumerate() {
            let last = depth + 1 == self.0.steps().len();
            place = match (step, place) {
                (Step::Field(key), Value::Object(map)) => {
                    if last {
                        map.entry(key.clone()).or_insert(Value::Null)
                    } else {
                        map.get_mut(key).ok_or_else(|| format!("the scene has no {}", self.upto(depth)))?
                    }
                }
                (Step::Index(index), Value::Array(list)) => {
                    let length = list.len();
                    list.get_mut(*index).ok_or_else(|| {
                        format!(
                            "{} has {}, counted from 0",
                            self.upto(depth - 1),
                            counted(length as u64, "entry", "entries")
                        )
                    })?
                }
                (Step::Field(_), _) if depth == 0 => return Err("the scene is not an object".to_owned()),
                (Step::Field(_), Value::Array(_)) => {
                    let list = self.upto(depth - 1);
                    return Err(format!("{list} is a list, whose first entry is {list}[0]"));
                }
                (Step::Field(_), _) => return Err(format!("{} is not an object", self.upto(depth - 1))),
                (Step::Index(_), _) => return Err(format!("{} is not a list", self.upto(depth - 1))),
                _ => return Err(format!("{self} is not the path of a field")),
            };
        }
        *place = value;
        Ok(())
    }

    /// As [`FieldPath::set`], but missing objects on the path are created. Unknown names are reported later, when the scene is
    /// read, with a list of the allowed names.
    ///
    /// # Errors
    /// Names a value that is not an object, or a list that is too short.
    pub(crate) fn set_or_insert(&self, tree: &mut Value, value: Value) -> Result<(), String> {
        for depth in 1..self.0.steps().len() {
            let object =
                matches!(self.0.steps()[depth], Step::Field(_)) && matches!(self.0.steps()[depth - 1], Step::Field(_));
            let holder = self.upto(depth - 1);
            if object && holder.get(tree).is_none_or(Value::is_null) {
                holder.set(tree, Value::Object(Map::new()))?;
            }
        }
        self.set(tree, value)
    }

    /// Whether this is a setting of the solution and not a part of the problem, which cannot vary continuously.
    pub(crate) fn is_setting(&self) -> bool {
        self.0.last().is_some_and(|name| SETTINGS.contains(&name))
    }

    /// Whether the other field is this one or part of it.
    pub(crate) fn holds(&self, other: &Path) -> bool {
        other.steps().starts_with(self.0.steps())
    }

    /// The steps to the field.
    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    /// The path up to and including the step at `depth`.
    fn upto(&self, depth: usize) -> FieldPath {
        FieldPath(self.0.steps().iter().take(depth + 1).cloned().collect())
    }
}

impl fmt::Display for FieldPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn paths_are_read_and_written_back() {
        for text in ["location_m", "striker.mass_kg", "structure.segments[12].length_m", "a[0][3].b"] {
            assert_eq!(FieldPath::parse(text).unwrap().to_string(), text);
        }
        for text in ["", ".", "a.", "[0]", "a[", "a[x]", "a[+1]", "a[0]b", "a[-1]", "a]", "a[99999999999999999999]"] {
            assert_eq!(FieldPath::parse(text), None, "{text}");
        }
    }

    #[test]
    fn values_are_put_where_a_place_is() {
        let mut tree = json!({ "a": { "b": [1, { "c": 2 }] } });
        let mut set = |text: &str| FieldPath::parse(text).unwrap().set(&mut tree, json!(7));
        assert_eq!(set("a.b[1].c"), Ok(()));
        assert_eq!(set("a.new"), Ok(()));
        assert_eq!(set("a.x.y").unwrap_err(), "the scene has no a.x");
        assert_eq!(set("a.b[2]").unwrap_err(), "a.b has 2 entries, counted from 0");
        assert_eq!(set("a.b.c").unwrap_err(), "a.b is a list, whose first entry is a.b[0]");
        assert_eq!(set("a.b[0].c").unwrap_err(), "a.b[0] is not an object");
        assert_eq!(set("a[0]").unwrap_err(), "a is not a list");
        assert_eq!(tree, json!({ "a": { "b": [1, { "c": 7 }], "new": 7 } }));
    }

    #[test]
    fn objects_on_the_way_are_made_and_lists_are_not() {
        let mut tree = json!({ "a": [1], "n": null });
        let mut set = |text: &str| FieldPath::parse(text).unwrap().set_or_insert(&mut tree, json!(7));
        assert_eq!(set("b.c.d"), Ok(()));
        assert_eq!(set("n.x"), Ok(()));
        assert_eq!(set("a[1]").unwrap_err(), "a has 1 entry, counted from 0");
        assert_eq!(set("a.x").unwrap_err(), "a is a list, whose first entry is a[0]");
        assert_eq!(set("list[0]").unwrap_err(), "the scene has no list");
        assert_eq!(tree, json!({ "a": [1], "n": { "x": 7 }, "b": { "c": { "d": 7 } } }));
    }
}
