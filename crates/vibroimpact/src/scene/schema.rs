//! JSON Schemas of the files that come in, from the types that read them: descriptions are the doc comments, ranges
//! those that the messages state. An editor that knows the schema completes names and marks slips while one writes.

use std::ops::Bound;

use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use schemars::{JsonSchema, Schema};
use serde_json::{Map, Value, json};

use super::{FORMAT_VERSION, Scene, fields};

/// The JSON Schema (draft 2020-12) of scene files. What it lets pass has the right shape; quantities that can be given in
/// more than one way, and ranges that depend on other fields, are left to [`Scene::impact`].
///
/// ```
/// let schema = vibroimpact::scene::schema::of_scenes();
/// assert_eq!(schema["properties"]["location_m"]["type"][0], "number");
/// ```
pub fn of_scenes() -> Value {
    of::<Scene>(FORMAT_VERSION)
}

/// The schema of a type that is read from a whole file of this format version.
pub(crate) fn of<T: JsonSchema>(version: u64) -> Value {
    let settings = SchemaSettings::draft2020_12().with_transform(RecursiveTransform(refine));
    let mut schema = settings.into_generator().into_root_schema_for::<T>();
    if let Some(properties) = schema.get_mut("properties").and_then(Value::as_object_mut) {
        let address = json!({ "type": "string", "description": "Where this schema stands, for editors" });
        properties.insert("$schema".to_owned(), address);
        let described = "Version of the format; 1 when left out";
        properties.insert("version".to_owned(), json!({ "const": version, "description": described }));
    }
    schema.to_value()
}

/// What the derived schema does not know: ranges by the names of fields, and that a law of contact takes no fields
/// beside its own. Links in the doc comments become plain text.
fn refine(schema: &mut Schema) {
    if let Some(Value::String(text)) = schema.get_mut("description") {
        *text = text.replace("[`", "`").replace("`]", "`").replace("(crate::Scene::read)", "");
    }
    let Some(Value::Object(properties)) = schema.get_mut("properties") else { return };
    for (name, property) in properties.iter_mut() {
        let Value::Object(property) = property else { continue };
        bound(property, name);
        if let Some(Value::Object(items)) = property.get_mut("items") {
            bound(items, &format!("{name}[]"));
        }
    }
    if properties.contains_key("law") {
        schema.insert("unevaluatedProperties".to_owned(), false.into());
    }
}

/// Writes the range of a number into its schema.
fn bound(schema: &mut Map<String, Value>, name: &str) {
    let is_number = |kind: &Value| kind == "number" || kind == "integer";
    let numeric = match schema.get("type") {
        Some(Value::Array(kinds)) => kinds.iter().any(is_number),
        Some(kind) => is_number(kind),
        None => false,
    };
    // a machine's own size of an integer is no part of the format
    schema.remove("format");
    let Some((least, most)) = fields::range(name).filter(|_| numeric) else { return };
    for (bound, inclusive, exclusive) in [(least, "minimum", "exclusiveMinimum"), (most, "maximum", "exclusiveMaximum")]
    {
        match bound {
            Bound::Included(value) => schema.insert(inclusive.to_owned(), json!(value)),
            Bound::Excluded(value) => schema.insert(exclusive.to_owned(), json!(value)),
            Bound::Unbounded => continue,
        };
        if matches!(bound, Bound::Excluded(_)) {
            schema.remove(inclusive);
        }
    }
}

/// The schema as the text of a file.
pub fn text(schema: &Value) -> String {
    format!("{schema:#}\n")
}

#[cfg(test)]
mod tests {
    #[test]
    fn descriptions_hold_no_links() {
        let text = super::text(&super::of_scenes());
        assert!(!text.contains("[`") && !text.contains("]("), "{text}");
    }
}
