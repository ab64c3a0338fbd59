//! A structure given by its modes.

use std::collections::BTreeMap;

use invalid_input::{InvalidInput, Path, Step};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use vibroimpact_sim::modal::{Mode, Structure};

use super::error::require_positive;
use super::extreme::such_that;
use super::fields;
use super::json::{named_objects, number, read_beside};
use super::sets::none_stated;
use super::told::did_you_mean;

/// A structure given by its modes, measured or from finite elements: frequencies and damping ratios once, and shapes
/// either at the one location of the impact (`shape_at_location`), or at several `points` of which the scene's `location`
/// names the one that is struck. All lists run over the same modes, in any order. The number of a mode counts from the lowest
/// frequency, as for every structure; of modes of the same frequency the first in the lists comes first.
///
/// ```
/// use vibroimpact::scene::{Modal, Point};
///
/// let shapes = [("tip", vec![2.0, -2.0]), ("middle", vec![0.68, 1.43])];
/// let cantilever = Modal {
///     omega_rad_s: vec![58.2, 364.7],
///     damping_ratios: vec![0.01, 0.01],
///     points: shapes.map(|(name, shape)| (name.to_owned(), Point { shape, ..Point::default() })).into(),
///     ..Modal::default()
/// };
/// # assert_eq!(cantilever.points["tip"].shape[1], -2.0);
/// ```
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = shape_or_points()))]
pub struct Modal {
    /// Angular frequencies (rad/s); 0 for a rigid-body mode.
    #[schemars(length(min = 1))]
    pub omega_rad_s: Vec<f64>,
    /// Damping ratios, one for each mode; all 0 when left out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub damping_ratios: Vec<f64>,
    /// Modal masses to which the shapes are normalised (kg), one for each mode. When left out, shapes are mass-normalised: 1 kg
    /// each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub modal_mass_kg: Vec<f64>,
    /// Shapes at the point of impact: mass-normalised (kg^-1/2), or normalised to `modal_mass_kg`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shape_at_location: Vec<f64>,
    /// Static compliance at the point of impact (m/N) of the whole elastic structure, modes beyond the list
    /// included; needed for `"residual_compliance": true` only.
    pub static_compliance_m_n: Option<f64>,
    /// Static compliance (m/N) of the modes beyond the list alone, in place of `static_compliance_m_n`. It stays the same if the
    /// listed modes vary.
    pub residual_compliance_m_n: Option<f64>,
    /// Points of the structure by their names, in place of `shape_at_location` and the compliance there.
    #[schemars(extend("minProperties" = 1))]
    #[serde(default, deserialize_with = "named_objects", skip_serializing_if = "BTreeMap::is_empty")]
    pub points: BTreeMap<String, Point>,
}

/// Schema: either the shapes at one location with one of two compliances, or points, each of which has its own.
fn shape_or_points() -> Value {
    json!([
        { "required": ["shape_at_location"], "properties": { "points": false }, "anyOf": one_compliance() },
        { "required": ["points"], "properties": { "shape_at_location": false }, "allOf": [none_stated(&COMPLIANCES)] },
    ])
}

/// Schema: at most one of the two compliances.
fn one_compliance() -> Value {
    COMPLIANCES.iter().map(|field| none_stated(&[*field])).collect()
}

const COMPLIANCES: [&str; 2] = ["static_compliance_m_n", "residual_compliance_m_n"];

/// A point of a structure that is given by its modes.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("anyOf" = one_compliance()))]
pub struct Point {
    /// Shapes at the point: mass-normalised (kg^-1/2), or normalised to `modal_mass_kg`.
    pub shape: Vec<f64>,
    /// Static compliance at the point (m/N) of the whole elastic structure, modes beyond the list included; needed for
    /// `"residual_compliance": true` only.
    pub static_compliance_m_n: Option<f64>,
    /// Static compliance (m/N) of the modes beyond the list alone, in place of `static_compliance_m_n`. It stays the same if the
    /// listed modes vary.
    pub residual_compliance_m_n: Option<f64>,
}

/// The shapes and the compliances at one location, and their path in the scene.
struct Seen<'a> {
    shape: &'a [f64],
    static_compliance_m_n: Option<f64>,
    residual_compliance_m_n: Option<f64>,
    /// Path of the object that contains the compliances and the shape.
    place: Path,
    shape_name: &'static str,
}

impl Seen<'_> {
    fn field(&self, name: &str) -> Path {
        Path::from(name).within(self.place.clone())
    }

    fn shape_field(&self) -> Path {
        self.field(self.shape_name)
    }
}

impl Modal {
    pub(super) fn from_value(value: &Value, beside: &[&str]) -> Result<Modal, InvalidInput> {
        let modal: Modal = read_beside(value, beside)?;
        if modal.omega_rad_s.is_empty() {
            let allowed = "a list of at least one frequency; an immovable surface is described by a striker with \"immovable\": true";
            return Err(InvalidInput::new("omega_rad_s", "[]", allowed));
        }
        if modal.points.is_empty() && value.get("points").is_some() {
            let allowed =
                "an object with at least one named point and its shape, or left out in favour of shape_at_location";
            return Err(InvalidInput::new("points", "{}", allowed));
        }
        if modal.shape_at_location.is_empty() && modal.points.is_empty() {
            let allowed =
                "a list of finite numbers, one for each mode, unless the structure has points with shapes of their own";
            return Err(match value.get("shape_at_location") {
                Some(_) => InvalidInput::new("shape_at_location", "[]", allowed),
                None => InvalidInput::missing("shape_at_location", allowed),
            });
        }
        Ok(modal)
    }

    fn seen_from(&self, location: Option<&str>) -> Result<Seen<'_>, InvalidInput> {
        let left_out = |field: &str, value: String| {
            Err(InvalidInput::new(
                ["structure", field],
                value,
                "left out in the presence of points, each of which has its own",
            ))
        };
        match (location, self.points.is_empty()) {
            (None, true) => Ok(Seen {
                shape: &self.shape_at_location,
                static_compliance_m_n: self.static_compliance_m_n,
                residual_compliance_m_n: self.residual_compliance_m_n,
                place: Path::default(),
                shape_name: "shape_at_location",
            }),
            (Some(name), true) => {
                let allowed = "left out, because the modal structure has no points, only shape_at_location";
                Err(InvalidInput::new("location", format!("{name:?}"), allowed))
            }
            (_, false) if !self.shape_at_location.is_empty() => {
                left_out("shape_at_location", format!("{} values", self.shape_at_location.len()))
            }
            (_, false) if self.static_compliance_m_n.is_some() => {
                left_out("static_compliance_m_n", number(self.static_compliance_m_n.unwrap_or_default()))
            }
            (_, false) if self.residual_compliance_m_n.is_some() => {
                left_out("residual_compliance_m_n", number(self.residual_compliance_m_n.unwrap_or_default()))
            }
            (name, false) => {
                let names = || format!("one of the structure's points {}", shown(self.points.keys()));
                let name = name.ok_or_else(|| InvalidInput::missing("location", names()))?;
                let missing = || {
                    let meant = did_you_mean(name, self.points.keys().map(String::as_str));
                    InvalidInput::new("location", format!("{name:?}"), names() + &meant)
                };
                let point = self.points.get(name).ok_or_else(missing)?;
                Ok(Seen {
                    shape: &point.shape,
                    static_compliance_m_n: point.static_compliance_m_n,
                    residual_compliance_m_n: point.residual_compliance_m_n,
                    place: ["points", name].into(),
                    shape_name: "shape",
                })
            }
        }
    }

    /// For each listed mode its place among all of them by frequency.
    pub(super) fn ranks(&self) -> Vec<usize> {
        let mut ranks = vec![0; self.omega_rad_s.len()];
        self.by_frequency().into_iter().enumerate().for_each(|(rank, listed)| ranks[listed] = rank);
        ranks
    }

    /// The places in the lists, by ascending frequency.
    fn by_frequency(&self) -> Vec<usize> {
        let mut places: Vec<usize> = (0..self.omega_rad_s.len()).collect();
        places.sort_by(|a, b| self.omega_rad_s[*a].total_cmp(&self.omega_rad_s[*b]));
        places
    }

    /// All modes with their shapes at a point, by ascending frequency.
    pub(super) fn modes(&self, location: Option<&str>) -> Result<Vec<Mode>, InvalidInput> {
        let seen = self.seen_from(location)?;
        self.modes_of(&seen).map_err(|fault| fault.within("structure"))
    }

    fn modes_of(&self, seen: &Seen) -> Result<Vec<Mode>, InvalidInput> {
        let listed = self.omega_rad_s.len();
        for (field, length, needed) in [
            (&seen.shape_field(), seen.shape.len(), true),
            (&"damping_ratios".into(), self.damping_ratios.len(), false),
            (&"modal_mass_kg".into(), self.modal_mass_kg.len(), false),
        ] {
            if length != listed && (needed || length > 0) {
                let allowed = format!("a list as long as omega_rad_s, which has {listed}");
                return Err(InvalidInput::new(field.clone(), format!("{length} values"), allowed));
            }
        }
        for (k, &mass) in self.modal_mass_kg.iter().enumerate() {
            require_positive(("modal_mass_kg", k), mass)?;
        }
        let mode = |k: usize| Mode {
            omega_rad_s: self.omega_rad_s[k],
            damping_ratio: self.damping_ratios.get(k).copied().unwrap_or_default(),
            shape: seen.shape[k] / self.modal_mass_kg.get(k).map_or(1.0, |mass| mass.sqrt()),
        };
        let modes: Vec<Mode> = (0..listed).map(mode).collect();
        // the solver checks the ranges; its error is reported with the list that contains the number
        let structure = Structure { modes };
        structure.check().map_err(|fault| self.in_lists(seen, fault))?;
        Ok(self.by_frequency().into_iter().map(|listed| structure.modes[listed]).collect())
    }

    fn in_lists(&self, seen: &Seen, fault: InvalidInput) -> InvalidInput {
        let [_, Step::Index(k), Step::Field(quantity)] = fault.field.steps() else { return fault };
        let (list, values) = match quantity.as_str() {
            "shape" => (seen.shape_field(), seen.shape),
            "damping_ratio" => ("damping_ratios".into(), self.damping_ratios.as_slice()),
            _ => ("omega_rad_s".into(), self.omega_rad_s.as_slice()),
        };
        let allowed = match quantity.as_str() {
            "shape" if !self.modal_mass_kg.is_empty() => {
                such_that("the shape over the square root of modal_mass_kg", &fault)
            }
            _ => fault.allowed,
        };
        let (field, value) = ((list, *k).into(), values.get(*k).map(|value| number(*value).into()));
        InvalidInput { field, value, allowed, ..fault }
    }

    /// Whether a compliance at a point is stated, with any value.
    pub(crate) fn gives_compliance(&self, location: Option<&str>) -> bool {
        let given = |seen: Seen| seen.static_compliance_m_n.or(seen.residual_compliance_m_n).is_some();
        self.seen_from(location).is_ok_and(given)
    }

    /// The static compliance at a point, stated or that of the listed modes and the residual one.
    pub(super) fn static_compliance_m_n(&self, location: Option<&str>) -> Result<f64, InvalidInput> {
        let seen = self.seen_from(location)?;
        let field = |name: &str| seen.field(name).within("structure");
        let allowed = || format!("{}, because residual_compliance needs it", fields::NOT_NEGATIVE);
        let (name, value, listed) = match (seen.static_compliance_m_n, seen.residual_compliance_m_n) {
            (Some(whole), None) => ("static_compliance_m_n", whole, 0.0),
            (None, Some(residual)) => {
                let compliance = |mode: &Mode| {
                    if mode.omega_rad_s > 0.0 { (mode.shape / mode.omega_rad_s).powi(2) } else { 0.0 }
                };
                ("residual_compliance_m_n", residual, self.modes(location)?.iter().map(compliance).sum())
            }
            (Some(_), Some(residual)) => {
                let allowed = "left out in the presence of static_compliance_m_n, which contains it";
                return Err(InvalidInput::new(field("residual_compliance_m_n"), number(residual), allowed));
            }
            (None, None) => return Err(InvalidInput::missing(field("static_compliance_m_n"), allowed())),
        };
        if value >= 0.0 && value.is_finite() {
            Ok(value + listed)
        } else {
            Err(InvalidInput::new(field(name), number(value), allowed()))
        }
    }
}

/// Names in the form of a list in a message.
fn shown<'a>(names: impl Iterator<Item = &'a String>) -> String {
    const MOST: usize = 12;
    let mut names: Vec<String> = names.take(MOST + 1).map(|name| format!("{name:?}")).collect();
    if names.len() > MOST {
        names[MOST] = "...".to_owned();
    }
    names.join(", ")
}
