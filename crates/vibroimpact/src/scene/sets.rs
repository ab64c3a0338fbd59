//! Quantities that can be given in more than one way, each way a set of fields.

use invalid_input::InvalidInput;
use serde_json::{Map, Value, json};

use super::json::number;

/// Finds the one of `sets` that the given fields form. Exactly one set must be complete, without further fields; otherwise the
/// error names the missing or superfluous field of the closest set.
pub(crate) fn one_of_sets(given: &[(&str, Option<f64>)], sets: &[&[&str]]) -> Result<usize, InvalidInput> {
    let here: Vec<(&str, f64)> = given.iter().filter_map(|&(field, value)| value.map(|value| (field, value))).collect();
    let in_common = |set: &[&str]| here.iter().filter(|(name, _)| set.contains(name)).count();
    // of the sets that have most fields in common with the given ones, the one with the fewest missing fields
    let nearest = (0..sets.len()).min_by_key(|&i| (usize::MAX - in_common(sets[i]), sets[i].len())).unwrap_or(0);
    let set = sets.get(nearest).copied().unwrap_or(&[]);
    let ways = || sets.iter().map(|set| set.join(" and ")).collect::<Vec<_>>().join(", or ");
    if let Some(field) = set.iter().find(|field| here.iter().all(|(name, _)| name != *field)) {
        return Err(InvalidInput::missing(
            *field,
            format!("given, unless another of these sets of fields is complete: {}", ways()),
        ));
    }
    if let Some(&(field, value)) = here.iter().find(|(name, _)| !set.contains(name)) {
        let allowed = format!(
            "left out in the presence of {}; the sets of fields that may be given are {}",
            set.join(" and "),
            ways()
        );
        return Err(InvalidInput::new(field, number(value), allowed));
    }
    Ok(nearest)
}

/// Schema: exactly one of the sets of fields is given, and no field of the others. A field that is null is not given.
pub(crate) fn schema_of_sets(sets: &[&[&str]]) -> Value {
    let all = sets.concat();
    let set = |set: &&[&str]| {
        let kind = |field: &str| if set.contains(&field) { "number" } else { "null" };
        let properties: Map<String, Value> =
            all.iter().map(|field| ((*field).to_owned(), json!({ "type": kind(field) }))).collect();
        json!({ "required": set, "properties": properties })
    };
    sets.iter().map(set).collect()
}

/// Schema: all of these fields are given.
pub(crate) fn all_stated(fields: &[&str]) -> Value {
    let given: Map<String, Value> =
        fields.iter().map(|field| ((*field).to_owned(), json!({ "not": { "type": "null" } }))).collect();
    json!({ "required": fields, "properties": given })
}

/// Schema: none of these fields is given.
pub(crate) fn none_stated(fields: &[&str]) -> Value {
    json!({ "properties": absent(fields) })
}

/// Schema: the properties of fields that are not given.
pub(crate) fn absent(fields: &[&str]) -> Map<String, Value> {
    fields.iter().map(|field| ((*field).to_owned(), json!({ "type": "null" }))).collect()
}

/// Schema: this field is given, and its value is of this schema.
pub(crate) fn stated_as(field: &str, value: Value) -> Value {
    json!({ "required": [field], "properties": { field: value } })
}

/// Schema: at least one of these fields is given.
pub(crate) fn any_stated(fields: &[&str]) -> Value {
    json!({ "anyOf": fields.iter().map(|field| all_stated(&[*field])).collect::<Vec<_>>() })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SETS: &[&[&str]] = &[&["a"], &["b", "c"], &["b", "c", "d"]];

    fn of(a: Option<f64>, b: Option<f64>, c: Option<f64>, d: Option<f64>) -> Result<usize, (String, bool)> {
        one_of_sets(&[("a", a), ("b", b), ("c", c), ("d", d)], SETS)
            .map_err(|e| (e.field.to_string(), e.value.is_some()))
    }

    #[test]
    fn a_whole_set_and_nothing_else_is_taken() {
        let x = Some(1.0);
        assert_eq!(of(x, None, None, None), Ok(0));
        assert_eq!(of(None, x, x, None), Ok(1));
        assert_eq!(of(None, x, x, x), Ok(2));
    }

    #[test]
    fn the_missing_or_superfluous_field_is_named() {
        let x = Some(1.0);
        assert_eq!(of(None, None, None, None), Err(("a".into(), false)));
        assert_eq!(of(None, x, None, None), Err(("c".into(), false)));
        assert_eq!(of(None, x, None, x), Err(("c".into(), false)));
        assert_eq!(of(x, x, x, None), Err(("a".into(), true)));
        assert_eq!(of(x, x, None, None), Err(("b".into(), true)));
    }
}
