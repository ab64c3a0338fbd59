//! The JSON Schema of scenes of bodies beyond the fields of each type: the fields of each kind.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde_json::{Map, Value, json};

use super::body::{Body, Elastic, Mass, STRUCTURES};
use super::rod::Rod;
use crate::scene::Structure;

impl JsonSchema for Body {
    fn schema_name() -> Cow<'static, str> {
        "Body".into()
    }

    /// One form for each kind: the fields of the structure, and those of a body.
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let rod = (Rod::json_schema(generator).to_value(), true);
        let forms = Structure::json_schema(generator).to_value();
        let forms = forms["oneOf"].as_array().cloned().unwrap_or_default();
        let structures = STRUCTURES.iter().filter_map(|(kind, computed)| {
            let form = forms.iter().find(|form| form["properties"]["kind"]["const"] == *kind)?;
            Some((form.clone(), *computed))
        });
        let beside = Elastic::json_schema(generator).to_value();
        let elastic = std::iter::once(rod).chain(structures).map(|(form, computed)| body(form, &beside, computed));
        let forms: Vec<Value> = std::iter::once(Mass::json_schema(generator).to_value()).chain(elastic).collect();
        schemars::json_schema!({ "description": "A body, of the kind that `\"kind\"` names.", "type": "object", "oneOf": forms })
    }
}

/// The form of a structure with the fields of a body. Where modes are computed their number is needed and their
/// participation is not; beams alone have remainder modes.
fn body(mut form: Value, beside: &Value, computed: bool) -> Value {
    let mut fields = beside["properties"].as_object().cloned().unwrap_or_default();
    let kind = form["properties"]["kind"]["const"].clone();
    if computed {
        fields.remove("gravity_participation_kg0_5");
        fields["modes"]["type"] = "integer".into();
        if let Some(required) = form["required"].as_array_mut() {
            required.push("modes".into());
        }
    }
    if kind != "beam" {
        fields.insert("residual_compliance".to_owned(), json!({ "const": false }));
    }
    if let Some(properties) = form["properties"].as_object_mut() {
        properties.extend(fields);
    }
    form
}

/// The ways to state a function of time: an amplitude with a frequency, or without one where it may be
/// `constant`; a list of values at times; a table.
pub(super) fn courses(amplitudes: &[&str], values: &str, constant: bool) -> Value {
    let all = [amplitudes, &["frequency_hz", "phase_deg", "file"]].concat();
    let absent = |free: &[&str]| {
        let rest = all.iter().filter(|field| !free.contains(field));
        rest.map(|field| ((*field).to_owned(), json!({ "type": "null" }))).collect::<Map<String, Value>>()
    };
    let lists =
        |of_each: &str, number: u64| ["times_s", values].map(|field| (field.to_owned(), json!({ of_each: number })));
    // without lists; in addition to the given fields, the optional ones are allowed
    let way = |given: &[(&str, &str)], free: &[&str]| {
        let required: Vec<&str> = given.iter().map(|(field, _)| *field).collect();
        let mut properties = absent(&[&required, free].concat());
        properties.extend(given.iter().map(|(field, kind)| ((*field).to_owned(), json!({ "type": kind }))));
        properties.extend(lists("maxItems", 0));
        json!({ "required": required, "properties": properties })
    };
    let mut ways = vec![way(&[("file", "string")], &[])];
    for amplitude in amplitudes {
        let harmonic = [(*amplitude, "number"), ("frequency_hz", "number")];
        ways.push(way(&harmonic, &["phase_deg"]));
        if constant {
            ways.push(way(&harmonic[..1], &[]));
        }
    }
    let mut sampled = absent(&[]);
    sampled.extend(lists("minItems", 2));
    ways.push(json!({ "required": ["times_s", values], "properties": sampled }));
    ways.into()
}
