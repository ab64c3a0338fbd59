//! Errors of quantities that follow from several fields: they name the field that is the most extreme.

use invalid_input::{InvalidInput, Path, Step, Value, most_extreme};
use serde::Serialize;
use serde_json::Value as Tree;

use super::json::number;
use super::path::FieldPath;

/// Usual sizes of the numbers that make other quantities large or small, in the units of their names: a modulus of 2e11 Pa is not
/// extreme. Fields that are not listed, such as ratios, are not named.
const USUAL: [(&str, f64); 21] = [
    ("length_m", 1.0),
    ("width_m", 1e-2),
    ("thickness_m", 1e-2),
    ("diameter_m", 1e-2),
    ("radius_m", 1e-2),
    ("area_m2", 1e-4),
    ("youngs_modulus_pa", 1e11),
    ("striker_youngs_modulus_pa", 1e11),
    ("density_kg_m3", 1e4),
    ("flexural_rigidity_n_m2", 1e2),
    ("axial_rigidity_n", 1e7),
    ("mass_per_length_kg_m", 1.0),
    ("tension_n", 1e2),
    ("axial_force_n", 1e2),
    ("foundation_n_m2", 1e5),
    ("spring_n_m", 1e5),
    ("rotational_spring_n_m_rad", 1e3),
    ("rotary_inertia_kg_m2", 1e-4),
    ("mass_kg", 0.1),
    ("speed_m_s", 1.0),
    ("stiffness_n_m1_5", 1e10),
];

/// The same of the fields by which the damping ratio of a mode grows without limit.
const RAYLEIGH: [(&str, f64); 2] = [("rayleigh_mass_per_s", 10.0), ("rayleigh_stiffness_s", 1e-5)];

/// A longer number is shown with a power of ten (characters).
const LONGEST_PLAIN: usize = 8;

/// A field with its value, and this value relative to its usual one.
type Relative<F> = ((F, f64), f64);

/// Checks that a quantity which follows from several fields is finite and greater than zero.
pub(super) fn require_product(quantity: &str, found: f64, fields: &[(&str, f64)]) -> Result<(), InvalidInput> {
    if found > 0.0 && found.is_finite() {
        return Ok(());
    }
    Err(of_product(quantity, found, fields, "neither infinite nor zero"))
}

/// The error of a quantity that follows from several fields and is not as it is allowed to be, as that of the most extreme of them.
pub(super) fn of_product(quantity: &str, found: f64, fields: &[(&str, f64)], allowed: &str) -> InvalidInput {
    let relative = |&(field, value): &(&str, f64)| -> Relative<String> {
        ((field.to_owned(), value), value / usual_size(&USUAL, Some(field)).unwrap_or(1.0))
    };
    let (field, value) = most_extreme(fields.iter().map(relative)).unwrap_or_default().0;
    let all = fields.iter().map(|(field, _)| *field).collect::<Vec<_>>().join(", ");
    let allowed = such_that(&format!("the {quantity}"), &InvalidInput::new("", found, allowed));
    InvalidInput::new(field, number(value), format!("{allowed}; it follows from {all}"))
}

/// The error of such a quantity as that of the most extreme of the fields; `None` without a field or a number.
pub(crate) fn follows_from(quantity: &str, fault: &InvalidInput, fields: &[(&str, f64)]) -> Option<InvalidInput> {
    let Some(Value::Number(found)) = fault.value else { return None };
    (!fields.is_empty()).then(|| of_product(quantity, found, fields, &fault.allowed))
}

/// The values that a field is allowed to have so that a quantity which follows from it is allowed too: this error is that of the
/// quantity.
pub(crate) fn such_that(quantity: &str, fault: &InvalidInput) -> String {
    let found = match &fault.value {
        Some(Value::Number(found)) => first_digits(*found),
        Some(found) => found.to_string(),
        None => "missing".to_owned(),
    };
    format!("such that {quantity}, now {found}, is {}", fault.allowed)
}

/// As many digits as tell how far a number is out of range.
fn first_digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    let plain = rounded.to_string();
    if plain.len() <= LONGEST_PLAIN { plain } else { format!("{rounded:e}") }
}

/// The most extreme of the numbers in a scene, or in a part of it, whose paths count.
pub(crate) fn most_extreme_in(tree: &Tree, counts: impl Fn(&Path) -> bool) -> Option<(Path, f64)> {
    let counted = relative_numbers(tree, &USUAL).filter(|((path, _), _)| counts(path));
    Some(most_extreme(counted)?.0)
}

/// The error of a number of a mode that was computed, as that of a field of the scene from which it follows.
pub(crate) fn of_computed_mode(fault: InvalidInput, scene: &impl Serialize) -> InvalidInput {
    let [parent @ .., Step::Field(list), Step::Index(k), Step::Field(quantity)] = fault.field.steps() else {
        return fault;
    };
    let (Ok(tree), parent) = (serde_json::to_value(scene), Path::from(parent)) else { return fault };
    let Some(structure) = FieldPath::of(parent.clone()).get(&tree).filter(|_| list == "modes") else { return fault };
    let found = match quantity.as_str() {
        // it may only be too large
        "damping_ratio" => {
            relative_numbers(structure, &RAYLEIGH).max_by(|one, other| one.1.total_cmp(&other.1)).map(|most| most.0)
        }
        _ => most_extreme_in(structure, |_| true),
    };
    let Some((path, value)) = found else { return fault };
    let allowed = such_that(&format!("{quantity} of mode {}", k + 1), &fault);
    InvalidInput::new(path.within(parent), number(value), allowed)
}

/// The numbers of a tree that have a usual size and are not zero.
fn relative_numbers(tree: &Tree, usual: &'static [(&str, f64)]) -> impl Iterator<Item = Relative<Path>> {
    numbers(tree).into_iter().filter(|(_, value)| *value != 0.0).filter_map(|(path, value)| {
        let size = usual_size(usual, path.last())?;
        Some(((path, value), value / size))
    })
}

/// The usual size of a field in a list.
fn usual_size(usual: &[(&str, f64)], field: Option<&str>) -> Option<f64> {
    usual.iter().find(|(name, _)| field == Some(*name)).map(|(_, size)| *size)
}

/// All numbers of a tree with their paths.
fn numbers(tree: &Tree) -> Vec<(Path, f64)> {
    let within = |step: Step, part: &Tree| {
        numbers(part).into_iter().map(move |(path, number)| (path.within(step.clone()), number))
    };
    match tree {
        Tree::Number(number) => number.as_f64().map(|number| (Path::default(), number)).into_iter().collect(),
        Tree::Object(fields) => {
            fields.iter().flat_map(|(name, value)| within(Step::Field(name.clone()), value)).collect()
        }
        Tree::Array(items) => items.iter().enumerate().flat_map(|(i, item)| within(Step::Index(i), item)).collect(),
        _ => Vec::new(),
    }
}
