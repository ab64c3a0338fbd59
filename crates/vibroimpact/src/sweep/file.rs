//! The sweep file, field by field, and its reading.

use std::path::Path;

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Map, Value};

use super::error::SweepError;
use super::uncertain::{self, SamplingEntry, Told, Uncertain, UncertainEntry};
use super::values::{Axis, AxisValues, Interval, MAX_POINTS, Random, Scale};
use crate::assembly;
use crate::scene::FieldPath;
use crate::scene::fields::{look_up, name_at};
use crate::scene::json::{self, number, quote};
use crate::scene::{A_SCENE, InvalidInput, SceneError, check_version, read_modes_into, read_tree};

/// The newest supported version of the sweep format; a file without a version has version 1.
pub const FORMAT_VERSION: u64 = 1;
/// Name of the content of a sweep file in messages.
pub(super) const A_SWEEP: &str = "a sweep";

const FIELD: &str = "the path of a field of the scene, as in striker.mass_kg or structure.segments[0].length_m";

/// A field and its allowed values.
const FIELDS: &[(&str, &str)] = &[
    ("", "an object with scene or scene_file, and vary, random or uncertain"),
    ("$schema", "a text, the address of the schema of sweeps"),
    ("version", "the whole number 1, the version of the format"),
    ("description", "a text"),
    ("scene", "a scene as an object, unless scene_file takes its place"),
    ("scene_file", "the name of a scene file, relative to the folder of the sweep file"),
    ("vary", "a list of axes, each an object with field and either values or from, to and count"),
    ("vary[]", "an object with field and either values or from, to and count"),
    ("field", FIELD),
    ("from", "a finite number, greater than 0 on a logarithmic scale"),
    ("to", "a finite number other than from, greater than 0 on a logarithmic scale"),
    ("count", "a whole number from 2 to 1e12"),
    ("scale", "linear or log"),
    ("whole_numbers", "true or false"),
    ("values", "a list of at least one value, without from, to, count, scale and whole_numbers beside it"),
    ("random", "an object with seed, draws and fields"),
    ("seed", "a whole number from 0 to 18446744073709551615"),
    ("draws", "a whole number from 1 to 1e12"),
    ("fields", "a list of at least one object with field, from and to"),
    ("fields[]", "an object with field, from and to"),
    (
        "sampling",
        "an object with seed, draws, sequence, replicates, outputs, sampling_error and indices, each of which may be left out",
    ),
    ("sequence", "sobol or random"),
    ("replicates", "a whole number from 2 to 1000"),
    ("outputs", "a list of results of the sweep"),
    ("outputs[]", "the name of a result of the sweep"),
    ("sampling_error", "a number greater than 0, or an object with outputs and such numbers"),
    ("indices", "true or false"),
    ("reliability", "true or false"),
];

fn fault(field: impl Into<invalid_input::Path>, value: impl Into<String>) -> InvalidInput {
    let field = field.into();
    let allowed = look_up(FIELDS, &name_at(&field)).unwrap_or_default();
    InvalidInput::new(field, value.into(), allowed)
}

fn missing(field: impl Into<invalid_input::Path>) -> InvalidInput {
    let field = field.into();
    let allowed = look_up(FIELDS, &name_at(&field)).unwrap_or_default();
    InvalidInput::missing(field, allowed)
}

/// Many scenes that differ in some fields.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Sweep", extend("oneOf" = [{ "required": ["scene"] }, { "required": ["scene_file"] }],
           "anyOf" = [{ "required": ["vary"] }, { "required": ["random"] }, { "required": ["uncertain"] }],
           "dependentRequired" = { "sampling": ["uncertain"] }))]
pub(super) struct SweepFile {
    /// A text for the reader, the title of report and pictures; may be left out.
    description: Option<String>,
    #[serde(rename = "$schema")]
    #[schemars(skip)]
    _schema: Option<String>,
    #[serde(rename = "version")]
    #[schemars(skip)]
    _version: Option<f64>,
    /// The scene; it may leave out the varied fields.
    #[schemars(with = "Option<Map<String, Value>>")]
    scene: Option<Value>,
    /// The name of a scene file in place of the scene, relative to the folder of the sweep file.
    scene_file: Option<String>,
    /// The axes of a grid, whose last axis runs fastest.
    #[serde(default, deserialize_with = "json::objects")]
    #[schemars(length(min = 1))]
    vary: Vec<AxisEntry>,
    /// Random draws at each point of the grid.
    #[schemars(with = "Option<RandomEntry>")]
    random: Option<Value>,
    /// Fields that are given as distributions, at each point of the grid; the outputs are then distributions too.
    #[schemars(with = "Option<UncertainEntry>")]
    uncertain: Option<Value>,
    /// How uncertain fields are drawn.
    #[schemars(with = "Option<SamplingEntry>")]
    sampling: Option<Value>,
    /// Whether the column `reliable_until_s` is computed for scenes of bodies, which takes a second run with a thousandth of the
    /// tolerance; `false` when left out.
    #[serde(default)]
    reliability: bool,
}

/// A field that runs through values: `values`, or `from`, `to` and `count`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Axis",
           extend("oneOf" = [{ "required": ["values"], "maxProperties": 2 }, { "required": ["from", "to", "count"], "not": { "required": ["values"] } }]))]
struct AxisEntry {
    /// The path of a field of the scene, as in striker.mass_kg or structure.segments[0].length_m.
    field: String,
    /// The first value.
    from: Option<f64>,
    /// The last value.
    to: Option<f64>,
    /// Number of values, both ends included.
    #[schemars(range(min = 2, max = 1_000_000_000_000u64))]
    count: Option<u64>,
    /// Equal differences (linear, when left out) or equal ratios (log).
    scale: Option<Scale>,
    /// Whether values are rounded to whole numbers.
    whole_numbers: Option<bool>,
    /// The values themselves: numbers, texts, or whole objects.
    #[schemars(length(min = 1))]
    values: Option<Vec<Value>>,
}

/// Fields that are drawn at random; the draws are the same at every point of the grid.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Random")]
struct RandomEntry {
    /// Seed of the draws, which depend only on it and on their number.
    #[schemars(range(min = 0))]
    seed: u64,
    /// Number of draws.
    #[schemars(range(min = 1, max = 1_000_000_000_000u64))]
    draws: u64,
    /// The fields, each with the interval it is drawn from.
    #[serde(deserialize_with = "json::objects")]
    #[schemars(length(min = 1))]
    fields: Vec<IntervalEntry>,
}

/// A field and the interval it is drawn from.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Interval")]
struct IntervalEntry {
    /// The path of a field of the scene.
    field: String,
    /// One end.
    from: f64,
    /// The other end.
    to: f64,
    /// Uniform in the value (linear, when left out) or in its logarithm (log).
    #[serde(default)]
    scale: Scale,
    /// Whether values are rounded to whole numbers.
    #[serde(default)]
    whole_numbers: bool,
}

/// The content of a sweep file, not yet checked against the scene.
pub(super) struct Contents {
    pub description: Option<String>,
    pub scene: Value,
    pub axes: Vec<Axis>,
    pub random: Option<Random>,
    pub uncertain: Option<Uncertain>,
    pub told: Told,
    /// Whether `reliable_until_s` is computed.
    pub reliability: bool,
    /// The file as a tree, with the scene in it.
    pub canonical: Value,
}

/// Reads a sweep file, the scene file that it names, and the table of modes that the scene names.
pub(super) fn read(path: &Path) -> Result<Contents, SweepError> {
    let mut tree = read_tree(path, A_SWEEP)?;
    check_version(&tree, FORMAT_VERSION, "sweep")?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let name = tree.get("scene_file").and_then(Value::as_str).map(str::to_owned);
    if let (Some(name), Some(map)) = (name, tree.as_object_mut()) {
        if let Some(scene) = map.get("scene") {
            return Err(InvalidInput::new("scene", quote(scene), "left out in the presence of scene_file").into());
        }
        let file = folder.join(name);
        let mut scene = read_tree(&file, A_SCENE)?;
        read_tables_into(&mut scene, file.parent().unwrap_or(Path::new("")))?;
        map.remove("scene_file");
        map.insert("scene".to_owned(), scene);
    } else if let Some(scene) = tree.get_mut("scene") {
        read_tables_into(scene, folder)?;
    }
    Ok(from_tree(tree)?)
}

/// Inserts the numbers of tables that the scene names. An error of the scene's own fields has their path.
pub(super) fn read_tables_into(scene: &mut Value, folder: &Path) -> Result<(), SceneError> {
    let read = match scene.get("bodies") {
        Some(_) => assembly::read_tables_into(scene, folder),
        None => read_modes_into(scene, folder),
    };
    read.map_err(|found| match found {
        SceneError::Invalid(fault)
            if ["structure", "bodies", "loads", "ground_motion"]
                .iter()
                .any(|name| fault.field.first() == Some(name)) =>
        {
            fault.within("scene").into()
        }
        other => other,
    })
}

/// Reads a sweep whose scene is in it.
pub(super) fn from_tree(mut canonical: Value) -> Result<Contents, InvalidInput> {
    check_version(&canonical, FORMAT_VERSION, "sweep")?;
    let file: SweepFile = typed(&canonical)?;
    // neither has an influence on the results
    for key in ["$schema", "version"] {
        canonical.as_object_mut().and_then(|map| map.remove(key));
    }
    if let Some(name) = file.scene_file {
        let allowed = "left out of a sweep without a file, which contains its scene";
        return Err(InvalidInput::new("scene_file", quote(&name.into()), allowed));
    }
    let scene = file.scene.ok_or_else(|| missing("scene"))?;
    if !scene.is_object() {
        return Err(fault("scene", quote(&scene)));
    }
    let axes = file.vary.into_iter().enumerate().map(|(i, entry)| axis(("vary", i).into(), entry));
    let axes = axes.collect::<Result<Vec<_>, _>>()?;
    let random = file.random.map(|value| random(&value).map_err(|found| found.within("random"))).transpose()?;
    let sampling = file.sampling.as_ref();
    let (uncertain, told) = match &file.uncertain {
        Some(uncertain) => Some(uncertain::read(uncertain, sampling, typed)?),
        None if sampling.is_some() => {
            return Err(InvalidInput::missing("uncertain", "an object with the fields that are to be drawn"));
        }
        None => None,
    }
    .unzip();
    let told: Told = told.unwrap_or_default();
    if axes.is_empty() && random.is_none() && uncertain.is_none() {
        return Err(InvalidInput::missing(
            "vary",
            "given, unless random or uncertain is, because some field has to change",
        ));
    }
    if uncertain.is_some() && random.is_some() {
        let allowed = "left out in the presence of uncertain, which makes all draws";
        return Err(InvalidInput::new("random", "{...}", allowed));
    }
    if let Some(error) =
        canonical.pointer("/sampling/sampling_error").filter(|_| told.is_adaptive() && !axes.is_empty())
    {
        let allowed = "left out in the presence of vary, because every point of a grid has the same draws";
        return Err(InvalidInput::new(["sampling", "sampling_error"], quote(error), allowed));
    }
    let (description, reliability) = (file.description, file.reliability);
    Ok(Contents { description, scene, axes, random, uncertain, told, reliability, canonical })
}

/// Reads an object; messages describe the allowed values of sweep files.
fn typed<T: serde::de::DeserializeOwned>(value: &Value) -> Result<T, InvalidInput> {
    json::read_other(value, "the sweep", |field| look_up(FIELDS, &name_at(field)))
}

fn axis(place: invalid_input::Path, entry: AxisEntry) -> Result<Axis, InvalidInput> {
    let AxisEntry { field, from, to, count, scale, whole_numbers, values } = entry;
    let at = |name: &str| invalid_input::Path::from(name).within(place.clone());
    let path = field_path(at("field"), field)?;
    let values = match values {
        Some(values) => {
            let range = from.is_some() || to.is_some() || count.is_some() || scale.is_some() || whole_numbers.is_some();
            if range || values.is_empty() {
                return Err(fault(at("values"), quote(&Value::Array(values))));
            }
            AxisValues::List(values)
        }
        None => {
            let from = from.ok_or_else(|| missing(at("from")))?;
            let to = to.ok_or_else(|| missing(at("to")))?;
            let count = count.ok_or_else(|| missing(at("count")))?;
            let scale = scale.unwrap_or_default();
            if !(2..=MAX_POINTS).contains(&count) {
                return Err(fault(at("count"), count.to_string()));
            }
            let whole_numbers = whole_numbers.unwrap_or_default();
            AxisValues::Range(interval(&place, Interval { from, to, scale, whole_numbers })?, count)
        }
    };
    Ok(Axis { field: path, values })
}

fn random(value: &Value) -> Result<Random, InvalidInput> {
    let RandomEntry { seed, draws, fields } = typed(value)?;
    if !(1..=MAX_POINTS).contains(&draws) {
        return Err(fault("draws", draws.to_string()));
    }
    if fields.is_empty() {
        return Err(fault("fields", "[]"));
    }
    let field = |(i, entry): (usize, IntervalEntry)| {
        let place = invalid_input::Path::from(("fields", i));
        let IntervalEntry { field, from, to, scale, whole_numbers } = entry;
        let path = field_path(invalid_input::Path::from("field").within(place.clone()), field)?;
        Ok::<_, InvalidInput>((path, interval(&place, Interval { from, to, scale, whole_numbers })?))
    };
    let fields = fields.into_iter().enumerate().map(field).collect::<Result<_, _>>()?;
    Ok(Random { seed, draws, fields })
}

fn field_path(place: invalid_input::Path, text: String) -> Result<FieldPath, InvalidInput> {
    FieldPath::parse(&text).ok_or_else(|| fault(place, quote(&text.into())))
}

fn interval(place: &invalid_input::Path, interval: Interval) -> Result<Interval, InvalidInput> {
    let Interval { from, to, scale, .. } = interval;
    let usable = |value: f64| value.is_finite() && (scale == Scale::Linear || value > 0.0);
    for (name, value, good) in [("from", from, usable(from)), ("to", to, usable(to) && to != from)] {
        if !good {
            return Err(fault(invalid_input::Path::from(name).within(place.clone()), number(value)));
        }
    }
    Ok(interval)
}

/// The canonical text of a tree: sorted keys, no spaces.
pub(super) fn canonical_text(tree: &Value) -> String {
    fn sorted(tree: &Value) -> Value {
        match tree {
            Value::Object(map) => {
                let mut entries: Vec<_> = map.iter().map(|(key, value)| (key.clone(), sorted(value))).collect();
                entries.sort_by(|a, b| a.0.cmp(&b.0));
                Value::Object(Map::from_iter(entries))
            }
            Value::Array(items) => Value::Array(items.iter().map(sorted).collect()),
            other => other.clone(),
        }
    }
    sorted(tree).to_string()
}
