//! The JSON Schema of sweep files, which contains that of scenes.

use serde_json::Value;

use super::file::{FORMAT_VERSION, SweepFile};
use crate::scene::schema::{of, of_scenes};

/// The JSON Schema (draft 2020-12) of sweep files; [`of_scenes`] is that of scenes. A scene in a sweep may omit the varied fields,
/// so that no field is required.
///
/// ```
/// let schema = vibroimpact::sweep::schema();
/// assert_eq!(schema["$defs"]["Scene"]["properties"]["striker"]["$ref"], "#/$defs/Striker");
/// ```
pub fn schema() -> Value {
    let mut sweep = of::<SweepFile>(FORMAT_VERSION);
    let mut scene = of_scenes();
    relax(&mut scene);
    let Some(scene) = scene.as_object_mut() else { return sweep };
    let definitions = scene.remove("$defs");
    for key in ["$schema", "title"] {
        scene.remove(key);
    }
    scene.insert("description".to_owned(), "The scene; it may leave out the varied fields.".into());
    if let (Some(Value::Object(all)), Some(Value::Object(of_scene))) = (sweep.get_mut("$defs"), definitions) {
        all.extend(of_scene);
    }
    sweep["properties"]["scene"] = Value::Object(std::mem::take(scene));
    sweep
}

/// Makes every field optional. More than one form of an object may then match, and conditions between fields, which are in `allOf`,
/// cannot be checked, because any of them may vary.
fn relax(schema: &mut Value) {
    match schema {
        Value::Object(map) => {
            map.remove("allOf");
            if map.get("required").is_some_and(Value::is_array) {
                map.remove("required");
            }
            if let Some(forms @ Value::Array(_)) = map.remove("oneOf") {
                map.insert("anyOf".to_owned(), forms);
            }
            map.values_mut().for_each(relax);
        }
        Value::Array(items) => items.iter_mut().for_each(relax),
        _ => {}
    }
}
