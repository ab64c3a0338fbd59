//! Maps of predictability: the spread of the outcome over one or two fields of a scene, for stated uncertainties of fields.

use invalid_input::{InvalidInput, Path, Step};
use serde_json::{Map, Value, json};

use super::definition::Sweep;
use super::error::SweepError;
use super::file::read_tables_into;
use super::values::Scale;
use crate::draft::Draft;
use crate::scene::FieldPath;
use crate::scene::fields::POSITIVE;
use crate::scene::json::{number, quote};

/// A field over which the spread is mapped.
#[derive(Debug, Clone, PartialEq)]
pub struct Over {
    /// The path of the field.
    pub field: String,
    /// First value.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// Number of values.
    pub count: u64,
    /// Equal differences or equal ratios.
    pub scale: Scale,
}

/// The uncertainty of a field.
#[derive(Debug, Clone, PartialEq)]
pub struct Blur {
    /// The path of the field.
    pub field: String,
    /// The standard deviation about its value.
    pub width: BlurWidth,
}

/// The standard deviation of a field about its value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BlurWidth {
    /// In the unit of the field; it is normally distributed.
    Absolute(f64),
    /// As a share of its value; its logarithm is normally distributed.
    Relative(f64),
}

impl Sweep {
    /// The sweep that maps the spread of the restitution of a scene over one or two fields (`over`), if some fields have a
    /// standard deviation (`blur`) about the value on the map, or about that of the scene. For a scene of bodies it maps the
    /// default outputs of its sweeps. Every point has the same number of draws with the same `seed`.
    ///
    /// # Errors
    /// A scene, field or number that is invalid; the error names the option of the command `predictability`.
    pub fn predictability(
        draft: &Draft,
        over: &[Over],
        blur: &[Blur],
        draws: u64,
        seed: u64,
    ) -> Result<Sweep, SweepError> {
        let (tree, folder) = draft.tree();
        let mut scene = tree.clone();
        read_tables_into(&mut scene, folder)?;
        if !(1..=2).contains(&over.len()) {
            let allowed = "stated for one or two fields, each with its values";
            return Err(InvalidInput::new("--over", format!("{} fields", over.len()), allowed).into());
        }
        let stated_twice = |option: &str, field: &String| {
            InvalidInput::new(option, quote(&json!(field)), "stated only once for each field")
        };
        if let [first, second] = over
            && first.field == second.field
        {
            return Err(stated_twice("--over", &second.field).into());
        }
        // JSON has no numbers that are not finite
        for Over { field, from, to, .. } in over {
            for (end, value) in [("from", *from), ("to", *to)] {
                InvalidInput::require_finite(end, value).map_err(|fault| fault.in_place(format!("--over {field}")))?;
            }
        }
        let mut uncertain = Map::new();
        for Blur { field, width } in blur {
            let (size, shown) = match *width {
                BlurWidth::Absolute(size) => (size, number(size)),
                BlurWidth::Relative(share) => (share, format!("{}%", number(100.0 * share))),
            };
            let ok = size > 0.0 && size.is_finite();
            InvalidInput::unless(ok, format!("--blur {field}"), shown, POSITIVE)?;
            let about = if over.iter().any(|over| over.field == *field) { None } else { Some(value(&scene, field)?) };
            let distribution = match width {
                BlurWidth::Absolute(sd) => json!({ "normal": [about.unwrap_or(0.0), sd] }),
                BlurWidth::Relative(share) => json!({ "lognormal": [about.unwrap_or(1.0), share] }),
            };
            if uncertain.insert(field.clone(), distribution).is_some() {
                return Err(stated_twice("--blur", field).into());
            }
        }
        let axis = |Over { field, from, to, count, scale }: &Over| {
            let scale = if *scale == Scale::Log { "log" } else { "linear" };
            json!({ "field": field, "from": from, "to": to, "count": count, "scale": scale })
        };
        let sweep = json!({
            "description": "Predictability under uncertain fields",
            "scene": scene,
            "vary": over.iter().map(axis).collect::<Vec<_>>(),
            "uncertain": uncertain,
            "sampling": { "draws": draws, "seed": seed },
        });
        Sweep::from_value(&sweep).map_err(|fault| of_option(fault, over).into())
    }
}

/// The number in a field of the scene.
fn value(scene: &Value, field: &str) -> Result<f64, InvalidInput> {
    let found = FieldPath::parse(field).and_then(|path| path.get(scene).cloned());
    found.as_ref().and_then(Value::as_f64).ok_or_else(|| {
        let allowed = "a field in which the scene has a number, or one that --over varies";
        InvalidInput::new("--blur", quote(&json!(field)), allowed)
    })
}

/// An error of the sweep with the name of the option that caused it.
fn of_option(fault: InvalidInput, over: &[Over]) -> InvalidInput {
    match fault.field.steps() {
        [Step::Field(list), Step::Index(i), inner @ ..] if list == "vary" && !inner.is_empty() => {
            let inner = Path::from(inner);
            let option = over.get(*i).map_or_else(String::new, |over| format!("--over {}", over.field));
            fault.under(inner).in_place(option)
        }
        [Step::Field(name), field] if name == "uncertain" => {
            let option = format!("--blur {}", Path::from(field.clone()));
            fault.under(option)
        }
        [Step::Field(name)] if name == "uncertain" => fault.under("--blur"),
        [Step::Field(name), Step::Field(draws)] if name == "sampling" && draws == "draws" => fault.under("--draws"),
        _ => fault.without("scene"),
    }
}
