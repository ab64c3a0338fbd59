//! A scene at neighbouring values of one of its numbers.

use std::cmp::Ordering;

use invalid_input::Path;
use serde_json::Value;
use vibroimpact_sim::modal::{Derivative, Stencil};

use super::sides::stay;
use super::table::LeftOut;
use crate::scene::json::{number, quote};
use crate::scene::told::did_you_mean_one_of;
use crate::scene::{FieldPath, InvalidInput};

/// Distance of neighbours relative to the value: the first hundreds of modes change smoothly over it, and it costs five of their
/// digits. Modes that change more need a smaller one: remainder modes near an end or a support change with their distance from
/// it, which may be any share of the value.
const STEPS: [f64; 5] = [1e-5, 1e-7, 1e-9, 1e-11, 1e-13];
/// The same where the value is zero, in its unit.
const STEPS_AT_ZERO: [f64; 3] = [1e-6, 1e-9, 1e-12];
/// Neighbours on both sides, or on one side of a bound, in steps.
const PLACES: [[f64; 4]; 3] = [[-2.0, -1.0, 1.0, 2.0], [1.0, 2.0, 3.0, 4.0], [-4.0, -3.0, -2.0, -1.0]];

/// The problem of a scene at four neighbouring values of a field.
pub(super) struct Neighbours<T> {
    pub field: String,
    pub value: f64,
    pub offsets: [f64; 4],
    pub at: [T; 4],
}

/// The neighbours for some fields, and the fields without neighbours, which were not named by the user.
pub(super) struct Around<T> {
    pub near: Vec<Neighbours<T>>,
    pub left_out: Vec<LeftOut>,
    /// Whether the user named the fields.
    pub named: bool,
}

/// Computes the problem of a scene, and gives its modes the order and the signs of those of the scene itself.
pub(super) struct Posing<'a, T> {
    pub pose: &'a dyn Fn(&Value) -> Result<T, InvalidInput>,
    pub sort: &'a dyn Fn(&mut T) -> Result<(), &'static str>,
    /// The sides of corners on which the scene's points lie.
    pub sides: &'a dyn Fn(&Value) -> Vec<Ordering>,
}

impl<T> Neighbours<T> {
    /// Computes the neighbours, and checks that they differ only continuously.
    fn of(tree: &Value, field: &str, by: &Posing<T>) -> Result<Neighbours<T>, InvalidInput> {
        let named = |value: &str, allowed: String| InvalidInput::new("--by", format!("{value} of {field}"), allowed);
        let numbers = all_numbers(tree).0;
        let number_of_scene = numbers.iter().find(|number| number.to_string() == field).cloned();
        let path = number_of_scene.or_else(|| FieldPath::parse(field)).ok_or_else(|| {
            InvalidInput::new("--by", quote(&field.into()), "the path of a field, such as striker.mass_kg")
        })?;
        let known = || {
            let numbers = numbers.iter().map(FieldPath::to_string).collect::<Vec<_>>().join(", ");
            let known = format!("the path of a number that the scene states, one of {numbers}");
            let meant = did_you_mean_one_of(field, &known);
            known + &meant
        };
        let stated = path.get(tree).ok_or_else(|| InvalidInput::new("--by", quote(&field.into()), known()))?;
        let value = stated.as_f64().ok_or_else(|| named(&quote(stated), known()))?;
        let found = Neighbours::beside(tree, (&path, value), by);
        found.map_err(|why| named(&number(value), format!("a field that can vary continuously ({why})")))
    }

    /// The same for a number of the scene, or the reason why it has no neighbours.
    fn beside(tree: &Value, (path, value): (&FieldPath, f64), by: &Posing<T>) -> Result<Neighbours<T>, String> {
        let steps: &[f64] = if value == 0.0 { &STEPS_AT_ZERO } else { &STEPS.map(|step| step * value.abs()) };
        if steps.iter().any(|step| *step < f64::MIN_POSITIVE) {
            return Err("it is so small that its neighbours cannot be distinguished from it".to_owned());
        }
        let here = (by.sides)(tree);
        let mut reason = String::new();
        for step in steps {
            let (mut faults, mut differs) = (Vec::new(), false);
            for places in PLACES {
                let (mut posed, mut sides) = (Vec::with_capacity(4), Vec::with_capacity(4));
                for place in places {
                    let near = changed(tree, path, value + place * step).and_then(|tree| {
                        let posed = (by.pose)(&tree)?;
                        sides.push((by.sides)(&tree));
                        Ok(posed)
                    });
                    match near {
                        Ok(near) => posed.push(near),
                        Err(fault) => {
                            faults.push(fault);
                            break;
                        }
                    }
                }
                let Ok(mut at) = <[T; 4]>::try_from(posed) else { continue };
                if !stay(&here, &sides) {
                    (reason, differs) = ("a point passes a corner of the modes".to_owned(), true);
                    continue;
                }
                match at.iter_mut().try_for_each(by.sort) {
                    Ok(()) => {
                        // the value is an integer or a float as in the file, and so are its neighbours
                        let offsets = places.map(|place| (value + place * step) - value);
                        return Ok(Neighbours { field: path.to_string(), value, offsets, at });
                    }
                    Err(why) => (reason, differs) = (why.to_owned(), true),
                }
                break;
            }
            if !differs {
                return Err(told(&faults, path));
            }
        }
        Err(reason)
    }

    /// The problem at four sizes of something that is zero here.
    pub fn of_size(offsets: [f64; 4], with: impl Fn(f64) -> T) -> Neighbours<T> {
        Neighbours { field: String::new(), value: 0.0, offsets, at: offsets.map(with) }
    }

    /// Another view of the same problems.
    pub fn map<U>(&self, of: impl Fn(&T) -> U) -> Neighbours<U> {
        let Neighbours { field, value, offsets, at } = self;
        Neighbours { field: field.clone(), value: *value, offsets: *offsets, at: at.each_ref().map(of) }
    }

    /// Error of a derivative with respect to the field, per error of the values at the neighbours.
    pub fn magnification(&self) -> f64 {
        Stencil::new(self.offsets).magnification()
    }

    /// A number here and at the neighbours, in the order of the field.
    pub fn in_order(&self, here: f64, of: impl Fn(&T) -> f64) -> [f64; 5] {
        let mut all = [(0.0, here); 5];
        all.iter_mut().zip(self.offsets.iter().zip(&self.at)).for_each(|(one, (offset, at))| *one = (*offset, of(at)));
        all.sort_by(|one, other| one.0.total_cmp(&other.0));
        all.map(|(_, value)| value)
    }

    /// Derivative of a smooth function of the problem, whose value here is `here` and whose values have this error beside that of
    /// rounding: slope of the polynomial through the value and its neighbours, and its difference from that through the nearest
    /// neighbours.
    pub fn derivative(&self, here: f64, of: impl Fn(&T) -> f64, error: f64) -> Derivative {
        let values = self.at.each_ref().map(of);
        let mut around: [(f64, f64); 4] = std::array::from_fn(|i| (self.offsets[i], values[i]));
        around.sort_by(|one, other| one.0.abs().total_cmp(&other.0.abs()));
        let [one, two, three, four] = around;
        let here = (0.0, here);
        let (all, few) = (slope([here, one, two, three, four]), slope([here, one, two]));
        let errors = self.magnification() * (error + 4.0 * f64::EPSILON * here.1.abs());
        Derivative { value: all, uncertainty: Some((all - few).abs() + errors) }
    }
}

/// The reason why a number cannot change. Beyond a bound the error is that of the number itself, which says nothing about the other
/// side of the bound.
fn told(faults: &[InvalidInput], path: &FieldPath) -> String {
    let own = |fault: &&InvalidInput| fault.field == *path.path();
    match faults.iter().find(|fault| !own(fault)).or(faults.first()) {
        Some(fault) if !own(&fault) => fault.to_string(),
        Some(fault) => format!("it must be {}", fault.allowed),
        None => String::new(),
    }
}

/// Independent errors of five values at equal distances, relative to their size. Through the values of a smooth function there is
/// hardly any fourth difference, so that it is that of the errors, apart from that of a wave with these first and second
/// differences.
pub(super) fn roughness([a, b, c, d, e]: [f64; 5], size: f64) -> f64 {
    const NORM: f64 = 8.366_600_265_340_756; // of the weights 1, -4, 6, -4, 1
    let size = size.abs().max(f64::MIN_POSITIVE);
    let [first, second] = [(e - a) / 4.0, (a - 2.0 * c + e) / 4.0].map(|difference| (difference / size).abs());
    let fourth = ((a - 4.0 * b + 6.0 * c - 4.0 * d + e) / size).abs();
    (fourth - 3.0 * second * (first * first + second)).max(0.0) / NORM
}

/// Slope of the polynomial through these locations and values.
fn slope<const N: usize>(points: [(f64, f64); N]) -> f64 {
    Stencil::new(points.map(|point| point.0)).slope(points.map(|point| point.1))
}

fn changed(tree: &Value, path: &FieldPath, value: f64) -> Result<Value, InvalidInput> {
    let mut tree = tree.clone();
    // the field exists, since it was read from the same tree
    path.set(&mut tree, value.into()).map_err(|why| {
        InvalidInput::new(path.path().clone(), number(value), format!("a field of the scene, but {why}"))
    })?;
    Ok(tree)
}

/// The neighbouring problems for these fields; or, if none is named, for all numbers that the scene states.
pub(super) fn around<T>((tree, fields): (&Value, &[String]), by: &Posing<T>) -> Result<Around<T>, InvalidInput> {
    if !fields.is_empty() {
        let mut near: Vec<Neighbours<T>> = Vec::with_capacity(fields.len());
        for field in fields {
            let found = Neighbours::of(tree, field, by)?;
            if near.iter().any(|known| known.field == found.field) {
                return Err(InvalidInput::new("--by", field.as_str(), "stated only once"));
            }
            near.push(found);
        }
        return Ok(Around { near, left_out: Vec::new(), named: true });
    }
    let (numbers, mut left_out) = all_numbers(tree);
    let mut near = Vec::new();
    for path in numbers {
        let Some(value) = path.get(tree).and_then(Value::as_f64) else { continue };
        match Neighbours::beside(tree, (&path, value), by) {
            Ok(found) => near.push(found),
            Err(reason) => left_out.push(LeftOut { path: path.to_string(), reason }),
        }
    }
    Ok(Around { near, left_out, named: false })
}

/// Every number of a scene that may vary continuously, and the lists that are too long to be included.
fn all_numbers(tree: &Value) -> (Vec<FieldPath>, Vec<LeftOut>) {
    let (mut found, mut left_out) = (Vec::new(), Vec::new());
    let mut open = vec![(Path::default(), tree)];
    while let Some((path, value)) = open.pop() {
        match value {
            Value::Object(entries) => {
                for (key, value) in entries.iter().rev() {
                    open.push((Path::from(key.as_str()).within(path.clone()), value));
                }
            }
            Value::Array(list) if list.len() > LONG && list.iter().any(Value::is_number) => {
                let reason = format!("a list of {} numbers; --by {path}[0] and so on selects some of them", list.len());
                left_out.push(LeftOut { path: path.to_string(), reason });
            }
            Value::Array(list) => {
                for (i, value) in list.iter().enumerate().rev() {
                    open.push(((path.clone(), i).into(), value));
                }
            }
            Value::Number(_) => found.push(FieldPath::of(path)),
            _ => {}
        }
    }
    found.retain(|path| !path.is_setting());
    (found, left_out)
}

/// Lists of more numbers are left out, unless the user names some of them.
const LONG: usize = 20;
