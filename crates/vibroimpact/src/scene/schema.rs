//! JSON Schemas of the input files, generated from the types that read them: descriptions are the doc comments, and ranges those of
//! the messages. With the schema an editor completes names and marks errors.

use std::ops::Bound;

use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use schemars::{JsonSchema, Schema};
use serde_json::{Map, Value, json};

use super::material::{MATERIAL, MATERIALS, NUMBERS, names_beside};
use super::segment::SECTIONS;
use super::sets::{absent, all_stated, any_stated, none_stated, schema_of_sets, stated_as};
use super::{FORMAT_VERSION, Scene, fields};
use crate::assembly::AssemblyScene;

/// The JSON Schema (draft 2020-12) of scene files, with `bodies` and of one impact. A file that it accepts has the right form, a
/// location if the structure needs one, and mass, sections, contacts and loads that are each stated in one way. The schema cannot
/// compare different fields: [`Scene::impact`] and [`AssemblyScene::pose`] check that a location lies on the beam, that lists
/// have the same length, and that a name is one of the points or bodies.
///
/// ```
/// let schema = vibroimpact::scene::schema::of_scenes();
/// assert_eq!(schema["$defs"]["Scene"]["properties"]["location_m"]["type"][0], "number");
/// assert_eq!(schema["$defs"]["AssemblyScene"]["properties"]["end_s"]["exclusiveMinimum"], 0.0);
/// ```
pub fn of_scenes() -> Value {
    let mut generator = settings().into_generator();
    let [impact, bodies] = [generator.subschema_for::<Scene>(), generator.subschema_for::<AssemblyScene>()];
    let mut definitions = Value::Object(generator.take_definitions(true));
    for name in ["Scene", "AssemblyScene"] {
        versioned(&mut definitions[name], FORMAT_VERSION);
    }
    name_materials(&mut definitions);
    definitions["CompleteLaw"] = json!({ "allOf": complete_law() });
    definitions["Scene"]["allOf"] = dependent_fields();
    definitions["BodyContact"]["allOf"] = contact_of_bodies();
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Scene",
        "description": "One impact, or many bodies and contacts under loads",
        "type": "object",
        // stated for an absent field, so that it holds if none is required
        "if": { "properties": { "bodies": false } },
        "then": impact,
        "else": bodies,
        "$defs": definitions,
    })
}

/// Conditions of the kind of structure on other fields.
fn dependent_fields() -> Value {
    let of_kind = |kinds: &[&str], structure: Value, then: Value| {
        let kind = stated_as("kind", json!({ "enum": kinds }));
        let here = stated_as("structure", json!({ "allOf": [kind, structure] }));
        json!({ "if": here, "then": then })
    };
    let any = || json!({});
    let with_points = || json!({ "required": ["points"] });
    let placed = |field: &str, kind: &str, other: &str| {
        let mut properties = absent(&[other]);
        properties.insert(field.to_owned(), json!({ "type": kind }));
        json!({ "required": [field], "properties": properties })
    };
    let mass_or_sphere = schema_of_sets(&[&["mass_kg"], &["density_kg_m3", "radius_m"]]);
    // a radius may be combined with a mass, for the contact
    let mut mass_or_sphere = without(mass_or_sphere, 0, "radius_m");
    or_material(&mut mass_or_sphere);
    let immovable = stated_as("immovable", json!({ "const": true }));
    let mut stop = absent(&["mass_kg", "density_kg_m3", "material"]);
    stop.insert("immovable".to_owned(), json!({ "const": true }));
    stop.insert("speed_m_s".to_owned(), json!({ "const": 0 }));
    let striker = json!({
        "if": immovable,
        "then": { "properties": stop },
        "else": { "oneOf": mass_or_sphere }
    });
    let mut infinite = absent(&["location_m", "location", "start", "tolerance"]);
    let mut rod = absent(&["location_m", "location", "start", "residual_compliance"]);
    for without in [&mut infinite, &mut rod] {
        without.insert("gravity_m_s2".to_owned(), json!({ "const": 0 }));
    }
    let mut faller = absent(&["mass_kg", "density_kg_m3", "radius_m", "material"]);
    let mut finite_striker = Map::new();
    for striker in [&mut faller, &mut finite_striker] {
        striker.insert("immovable".to_owned(), json!({ "not": { "const": true } }));
        striker.insert("speed_m_s".to_owned(), json!({ "exclusiveMinimum": 0 }));
    }
    rod.insert("striker".to_owned(), json!({ "properties": faller }));
    infinite.insert("striker".to_owned(), json!({ "properties": finite_striker }));
    infinite.insert("residual_compliance".to_owned(), json!({ "not": { "const": true } }));
    let modal_only = json!({ "properties": { "model": { "enum": ["auto", "modal"] } } });
    for (without, model) in [(&mut infinite, "infinite-beam"), (&mut rod, "modal")] {
        without.insert("model".to_owned(), json!({ "enum": ["auto", model] }));
        without.insert("modes".to_owned(), json!({ "not": { "type": "integer" } }));
    }
    let modes_stated = stated_as("modes", json!({ "type": "integer" }));
    let stops = stated_as("striker", immovable);
    let falls = stated_as("gravity_m_s2", json!({ "exclusiveMinimum": 0 }));
    // in a fall a start may be the height alone
    let listed =
        ["amplitude_m_kg0_5", "rate_m_kg0_5_s", "moving_modes"].map(|list| stated_as(list, json!({ "minItems": 1 })));
    let moves = json!({ "properties": { "start": { "anyOf": listed } } });
    let in_motion = json!({ "allOf": [all_stated(&["start"]), { "anyOf": [{ "not": falls }, moves] }] });
    let moves_or_stops = json!({ "anyOf": [in_motion, stops] });
    let mindlin = stated_as("theory", json!({ "const": "mindlin" }));
    let struck = ["beam", "string", "plate", "modal", "modes-file", "infinite-beam", "infinite-plate"];
    json!([
        of_kind(&["beam", "string"], any(), placed("location_m", "number", "location")),
        of_kind(&["plate"], any(), placed("location_m", "array", "location")),
        of_kind(&["modes-file"], any(), placed("location", "string", "location_m")),
        of_kind(&["modal"], with_points(), placed("location", "string", "location_m")),
        of_kind(
            &["modal"],
            json!({ "not": with_points() }),
            json!({ "properties": absent(&["location_m", "location"]) })
        ),
        of_kind(&["infinite-beam", "infinite-plate"], any(), json!({ "properties": infinite })),
        of_kind(&["dropped-rod"], any(), json!({ "properties": rod })),
        of_kind(&struck, any(), json!({ "properties": { "striker": striker, "contact": { "$ref": COMPLETE_LAW } } })),
        of_kind(
            &struck,
            any(),
            json!({ "if": stated_as("contact", by_materials()),
                    "then": { "properties": { "striker": all_stated(&["radius_m"]) } } })
        ),
        { "if": moves_or_stops, "then": modal_only },
        { "if": falls, "then": modal_only },
        of_kind(
            &["string", "plate", "modal", "modes-file"],
            any(),
            json!({ "properties": { "model": { "not": { "const": "infinite-beam" } } } })
        ),
        // where the program does not choose the modes
        of_kind(&["beam", "string", "plate"], any(), json!({ "if": moves_or_stops, "then": modes_stated })),
        of_kind(&["plate"], mindlin, modes_stated),
    ])
}

/// Laws that are Hertzian whatever their fields are.
const HERTZIAN: [&str; 5] = ["hertz", "viscous", "hysteretic", "lankarani-nikravesh", "flores"];
const STIFFNESS: &str = "stiffness_n_m1_5";
/// Stiffness and exponent of the law `hunt-crossley` where it is not Hertzian.
const GENERAL: [&str; 2] = ["stiffness_n_m_n", "exponent"];
const OF_STRUCTURE: [&str; 3] = ["youngs_modulus_pa", "poissons_ratio", MATERIAL];
const OF_STRIKER: [&str; 3] = ["striker_youngs_modulus_pa", "striker_poissons_ratio", "striker_material"];

/// The stiffness of a contact follows from materials.
fn by_materials() -> Value {
    any_stated(&[OF_STRUCTURE, OF_STRIKER].concat())
}

/// A condition on the contacts of some laws. (Fields in a condition that holds count as known, so that each law has its own.)
fn of_law(laws: &[&str], then: Value) -> Value {
    json!({ "if": stated_as("law", json!({ "enum": laws })), "then": then })
}

const COMPLETE_LAW: &str = "#/$defs/CompleteLaw";

/// The stiffness of a contact is stated in one way, and its damping in one way.
fn complete_law() -> Value {
    // modulus and ratio, each by its number or by the name of the material
    let complete = |[modulus, ratio, name]: [&str; 3]| json!({ "allOf": [any_stated(&[modulus, name]), any_stated(&[ratio, name])] });
    let materials =
        json!({ "allOf": [complete(OF_STRUCTURE)], "if": any_stated(&OF_STRIKER), "then": complete(OF_STRIKER) });
    let all_materials = [OF_STRUCTURE, OF_STRIKER].concat();
    let alone = |given: Value, others: &[&str]| json!({ "allOf": [given, none_stated(others)] });
    let hertzian = [alone(all_stated(&[STIFFNESS]), &all_materials), alone(materials.clone(), &[STIFFNESS])];
    let mut ways = hertzian.clone().map(|way| alone(way, &GENERAL)).to_vec();
    ways.push(alone(all_stated(&GENERAL), &[&all_materials[..], &[STIFFNESS]].concat()));
    let damping = |field: &str| json!({ "oneOf": [all_stated(&[field]), all_stated(&["restitution"])] });
    json!([
        of_law(&HERTZIAN, json!({ "oneOf": hertzian })),
        of_law(&["hunt-crossley"], json!({ "oneOf": ways })),
        of_law(&["elastoplastic"], materials),
        of_law(&["viscous", "hunt-crossley"], damping("damping_s_m")),
        of_law(&["kelvin-voigt"], damping("damping_n_s_m")),
    ])
}

/// A contact of bodies in addition has the quantities to which its materials and its restitution refer.
fn contact_of_bodies() -> Value {
    let needs = |given: Value, field: &str| json!({ "if": given, "then": all_stated(&[field]) });
    let by_restitution = all_stated(&["restitution"]);
    json!([
        { "$ref": COMPLETE_LAW },
        of_law(&[&HERTZIAN[..], &["hunt-crossley", "elastoplastic"]].concat(), needs(by_materials(), "radius_m")),
        of_law(&["viscous", "hunt-crossley"], needs(by_restitution.clone(), "approach_speed_m_s")),
        of_law(&["kelvin-voigt"], needs(by_restitution, "reduced_mass_kg")),
    ])
}

/// The alternative sets of fields, with an optional field.
fn without(mut sets: Value, number: usize, field: &str) -> Value {
    if let Some(properties) = sets.pointer_mut(&format!("/{number}/properties")).and_then(Value::as_object_mut) {
        properties.remove(field);
    }
    sets
}

/// Allows a material in every object that needs its numbers. (The derived schema has only the numbers, which replace the name
/// before a scene is read.)
fn name_materials(schema: &mut Value) {
    match schema {
        Value::Object(map) => {
            map.values_mut().for_each(name_materials);
            let is_object = map.get("type").is_some_and(|kind| kind == "object");
            let Some(Value::Object(properties)) = map.get_mut("properties").filter(|_| is_object) else { return };
            let known: Vec<&str> = properties.keys().map(String::as_str).collect();
            let names = names_beside(&known);
            if names.is_empty() {
                return;
            }
            let materials: Vec<&str> = MATERIALS.iter().map(|material| material.name).collect();
            for name in names {
                let whose = if name == MATERIAL { "Material" } else { "Material of the striker" };
                let described = format!("{whose}, in place of its numbers; a number beside it takes precedence");
                let property = json!({ "enum": materials.iter().map(|name| json!(name)).chain([Value::Null]).collect::<Vec<_>>(),
                                       "description": described });
                properties.insert(name.to_owned(), property);
            }
            if let Some(Value::Array(required)) = map.get_mut("required") {
                let (numbers, others): (Vec<Value>, Vec<Value>) = std::mem::take(required)
                    .into_iter()
                    .partition(|field| NUMBERS.iter().any(|number| field == number));
                *required = others;
                if !numbers.is_empty() {
                    let named = stated_as(MATERIAL, json!({ "type": "string" }));
                    map.insert("anyOf".to_owned(), json!([{ "required": numbers }, named]));
                }
            }
            if let Some(sets) = map.get_mut("oneOf") {
                or_material(sets);
            }
        }
        Value::Array(items) => items.iter_mut().for_each(name_materials),
        _ => {}
    }
}

/// The sets of fields, and those in which a material replaces its numbers.
fn or_material(sets: &mut Value) {
    let Value::Array(sets) = sets else { return };
    let mut named = Vec::new();
    for set in sets.iter_mut() {
        let mut with_name = set.clone();
        set["properties"][MATERIAL] = json!({ "type": "null" });
        let Some(Value::Array(required)) = with_name.get_mut("required") else { continue };
        let before = required.len();
        required.retain(|field| NUMBERS.iter().all(|number| field != number));
        if required.len() < before {
            required.push(json!(MATERIAL));
            with_name["properties"][MATERIAL] = json!({ "type": "string" });
            for number in NUMBERS {
                if let Some(property) = with_name["properties"].get_mut(number) {
                    *property = json!({ "type": ["number", "null"] });
                }
            }
            named.push(with_name);
        }
    }
    sets.extend(named);
}

fn settings() -> SchemaSettings {
    SchemaSettings::draft2020_12().with_transform(RecursiveTransform(refine))
}

/// The schema of a type that is read from a complete file of this format version.
pub(crate) fn of<T: JsonSchema>(version: u64) -> Value {
    let mut schema = settings().into_generator().into_root_schema_for::<T>().to_value();
    versioned(&mut schema, version);
    schema
}

/// Adds the fields that every file may have.
fn versioned(schema: &mut Value, version: u64) {
    let address = json!({ "type": "string", "description": "Address of this schema, for editors" });
    schema["properties"]["$schema"] = address;
    let described = "Version of the format; 1 when left out";
    schema["properties"]["version"] = json!({ "const": version, "description": described });
}

/// Adds what the derived schema does not contain: ranges by the names of fields, and that an object with a contact law has no other
/// fields. Links in the doc comments become plain text.
fn refine(schema: &mut Schema) {
    if let Some(Value::String(text)) = schema.get_mut("description") {
        *text = text.replace("[`", "`").replace("`]", "`").replace("(crate::Scene::read)", "");
    }
    let is_law = |form: &Value| form.pointer("/properties/law").is_some();
    if schema.get("oneOf").and_then(Value::as_array).is_some_and(|forms| forms.iter().all(is_law)) {
        schema.insert("unevaluatedProperties".to_owned(), false.into());
    }
    let Some(Value::Object(properties)) = schema.get_mut("properties") else { return };
    for (name, property) in properties.iter_mut() {
        let Value::Object(property) = property else { continue };
        bound(property, name);
        if let Some(Value::Object(items)) = property.get_mut("items") {
            bound(items, &format!("{name}[]"));
        }
    }
    let has_section = SECTIONS.concat().iter().all(|field| properties.contains_key(*field));
    // the parts inserted below are not objects of the format, and are processed again
    if has_section && schema.get("type").is_some() {
        schema.insert("oneOf".to_owned(), schema_of_sets(&SECTIONS));
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
    // the size of an integer on a machine is not part of the format
    schema.remove("format");
    let Some((least, most)) = fields::range(name).filter(|_| numeric) else { return };
    for (bound, inclusive, exclusive) in [(least, "minimum", "exclusiveMinimum"), (most, "maximum", "exclusiveMaximum")]
    {
        // a type may state a narrower range itself
        let stated = schema.get(inclusive).and_then(Value::as_f64);
        let narrower =
            |value: f64| stated.is_some_and(|own| if inclusive == "minimum" { own > value } else { own < value });
        match bound {
            Bound::Included(value) if !narrower(value) => schema.insert(inclusive.to_owned(), json!(value)),
            Bound::Excluded(value) if !narrower(value) => {
                schema.remove(inclusive);
                schema.insert(exclusive.to_owned(), json!(value))
            }
            _ => continue,
        };
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
