//! A scene at neighbouring values of one of its numbers.

use serde_json::Value;
use vibroimpact_sim::modal::{Derivative, Mode, Stencil};

use crate::impact::Impact;
use crate::scene::json::{number, quote};
use crate::scene::{FieldPath, InvalidInput};

/// Number of modes, from the lowest, whose frequencies and shapes are differentiated too.
pub(super) const MODES: usize = 10;

/// Distance of neighbours relative to the value: the first hundreds of modes change smoothly over it, and it costs five of their
/// digits.
const STEP: f64 = 1e-5;
/// Relative accuracy of frequencies and shapes.
const KNOWN: f64 = 2e-13;
/// The same where the value is zero, in its unit.
const STEP_AT_ZERO: f64 = 1e-6;

/// The problem of a scene at four neighbouring values of a field.
pub(super) struct Neighbours<T> {
    pub field: String,
    pub value: f64,
    pub offsets: [f64; 4],
    pub at: [T; 4],
}

impl<T> Neighbours<T> {
    /// Computes the neighbours, and checks that they differ only continuously; their modes may be sorted for that.
    pub fn of(
        tree: &Value,
        field: &str,
        pose: &dyn Fn(&Value) -> Result<T, InvalidInput>,
        is_near: &dyn Fn(&mut T) -> bool,
    ) -> Result<Neighbours<T>, InvalidInput> {
        let named = |value: &str, allowed: String| InvalidInput::new("--by", format!("{value} of {field}"), allowed);
        let path = FieldPath::parse(field).ok_or_else(|| {
            InvalidInput::new("--by", quote(&field.into()), "the path of a field, such as striker.mass_kg")
        })?;
        let known = || format!("the path of a number that the scene states: {}", all_numbers(tree).join(", "));
        let stated = path.get(tree).ok_or_else(|| InvalidInput::new("--by", quote(&field.into()), known()))?;
        let value = stated.as_f64().ok_or_else(|| named(&quote(stated), known()))?;
        let step = if value == 0.0 { STEP_AT_ZERO } else { STEP * value.abs() };
        let mut fault = None;
        // on both sides, or on one side of a bound
        for places in [[-2.0, -1.0, 1.0, 2.0], [1.0, 2.0, 3.0, 4.0], [-4.0, -3.0, -2.0, -1.0]] {
            let offsets = places.map(|place| place * step);
            let mut posed = Vec::with_capacity(4);
            for offset in offsets {
                match changed(tree, &path, value + offset).and_then(|tree| pose(&tree)) {
                    Ok(near) => posed.push(near),
                    Err(refused) => {
                        fault.get_or_insert(refused);
                        break;
                    }
                }
            }
            if let Ok(mut at) = <[T; 4]>::try_from(posed) {
                if !at.iter_mut().all(is_near) {
                    let allowed = "a field with which the modes change smoothly: here two modes swap their order";
                    return Err(named(&number(value), allowed.to_owned()));
                }
                // the value is an integer or a float as in the file, and so are its neighbours
                let offsets = places.map(|place| (value + place * step) - value);
                return Ok(Neighbours { field: field.to_owned(), value, offsets, at });
            }
        }
        let why = fault.map_or_else(String::new, |fault| format!(": {fault}"));
        Err(named(&number(value), format!("a field that can vary continuously{why}")))
    }

    /// The effect of errors of the modes, all of the same size and of either sign; the size is treated like a field.
    pub fn with_errors(with: impl Fn(&mut dyn FnMut() -> f64) -> T) -> Neighbours<T> {
        let offsets = [-2e-6, -1e-6, 1e-6, 2e-6];
        let at = offsets.map(|size| {
            // a linear congruential generator is random enough for signs
            let mut random = 2019u64;
            with(&mut || {
                random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                1.0 + if random >> 63 == 0 { size } else { -size }
            })
        });
        Neighbours { field: String::new(), value: 0.0, offsets, at }
    }

    /// A derivative with the possible effect of errors of the modes, if errors of unit size change the output by this amount.
    pub fn widened(&self, derivative: Derivative, by_errors: Derivative) -> Derivative {
        let nearest = self.offsets.iter().fold(f64::INFINITY, |least, offset| least.min(offset.abs()));
        let of_modes = KNOWN / nearest * by_errors.value.abs();
        Derivative { uncertainty: derivative.uncertainty.map(|own| own + of_modes), ..derivative }
    }

    /// Derivative of a smooth function of the problem, whose value here is `value`.
    pub fn derivative(&self, value: f64, of: impl Fn(&T) -> f64) -> Derivative {
        self.slope(value, self.at.each_ref().map(of))
    }

    /// Slope of the polynomial through the value and its neighbours, and its difference from that through the nearest neighbours.
    fn slope(&self, value: f64, at: [f64; 4]) -> Derivative {
        let mut around: [(f64, f64); 4] = std::array::from_fn(|i| (self.offsets[i], at[i]));
        around.sort_by(|one, other| one.0.abs().total_cmp(&other.0.abs()));
        let [one, two, three, four] = around;
        let here = (0.0, value);
        let (all, few) = (slope([here, one, two, three, four]), slope([here, one, two]));
        let rounding = 4.0 * f64::EPSILON * value.abs() / one.0.abs();
        Derivative { value: all, uncertainty: Some((all - few).abs() + rounding) }
    }
}

impl Neighbours<Impact> {
    /// The impact with errors of its modes.
    pub fn with_errors_of(base: &Impact) -> Neighbours<Impact> {
        Neighbours::with_errors(|error| {
            let mut impact = base.clone();
            for mode in &mut impact.structure.modes {
                mode.omega_rad_s *= error();
                mode.shape *= error();
            }
            impact
        })
    }

    /// Frequencies and shapes of the lowest modes.
    pub fn of_modes(&self, base: &Impact) -> Vec<(String, Derivative)> {
        let mut found = Vec::new();
        for k in 0..base.kept_modes().min(MODES) {
            let of = |quantity: fn(&Mode) -> f64| {
                let at = |impact: &Impact| quantity(&impact.structure.modes[k]);
                self.derivative(at(base), at)
            };
            found.push((format!("omega_rad_s[{k}]"), of(|mode| mode.omega_rad_s)));
            found.push((format!("shape[{k}]"), of(|mode| mode.shape)));
        }
        found
    }
}

/// Slope of the polynomial through these locations and values.
fn slope<const N: usize>(points: [(f64, f64); N]) -> f64 {
    Stencil::new(points.map(|point| point.0)).slope(points.map(|point| point.1))
}

fn changed(tree: &Value, path: &FieldPath, value: f64) -> Result<Value, InvalidInput> {
    let mut tree = tree.clone();
    // the field exists, since it was read from the same tree
    path.set(&mut tree, value.into()).map_err(|why| InvalidInput::new(path.path().clone(), number(value), why))?;
    Ok(tree)
}

/// The neighbouring problems for these fields; or, if none is named, for all numbers that the scene states, without those that
/// cannot vary continuously.
pub(super) fn around<T>(
    (tree, fields): (&Value, &[String]),
    pose: &dyn Fn(&Value) -> Result<T, InvalidInput>,
    is_near: &dyn Fn(&mut T) -> bool,
) -> Result<(Vec<Neighbours<T>>, Vec<String>), InvalidInput> {
    let of = |field: &String| Neighbours::of(tree, field, pose, is_near);
    if !fields.is_empty() {
        return Ok((fields.iter().map(of).collect::<Result<_, _>>()?, Vec::new()));
    }
    let (mut around, mut left_out) = (Vec::new(), Vec::new());
    for field in all_numbers(tree) {
        match of(&field) {
            Ok(near) => around.push(near),
            Err(_) => left_out.push(field),
        }
    }
    Ok((around, left_out))
}

/// Every number of a scene that can vary continuously, without lists of numbers.
fn all_numbers(tree: &Value) -> Vec<String> {
    let mut found = Vec::new();
    let mut open = vec![(String::new(), tree)];
    while let Some((path, value)) = open.pop() {
        match value {
            Value::Object(entries) => {
                for (key, value) in entries.iter().rev() {
                    let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                    open.push((path, value));
                }
            }
            Value::Array(list) if list.iter().any(Value::is_object) => {
                for (i, value) in list.iter().enumerate().rev() {
                    open.push((format!("{path}[{i}]"), value));
                }
            }
            Value::Number(_) if !CHOICES.contains(&path.rsplit('.').next().unwrap_or_default()) => found.push(path),
            _ => {}
        }
    }
    found
}

/// Numbers that are settings of the solution and not part of the problem.
const CHOICES: [&str; 6] = ["version", "modes", "mode", "tolerance", "bending_modes", "axial_modes"];
