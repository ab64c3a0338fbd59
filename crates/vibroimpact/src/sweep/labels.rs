//! Names of the varied fields of a sweep in its figures.

use serde_json::Value;

use super::row::cell;
use crate::plot::Axis;
use crate::scene::FieldPath;

/// The axis of a field.
pub(super) fn axis(field: &FieldPath, log: bool, integers: bool) -> Axis {
    let (label, unit) = label_and_unit(field);
    Axis { logarithmic: log, integers, ..Axis::new(label).unit(unit) }
}

/// A value as a short text.
pub(super) fn short(value: &Value) -> String {
    let name = ["law", "kind", "description"].iter().find_map(|key| value.get(key)?.as_str());
    name.map_or_else(|| cell(value), str::to_owned).chars().take(24).collect()
}

/// Units by the end of a field's name, longer ends first.
const UNITS: [(&str, &str); 22] = [
    ("_n_m1_5", "N/m^1.5"),
    ("_n_m_n", "N/m^n"),
    ("_m_s2", "m/s²"),
    ("_kg_m3", "kg/m³"),
    ("_n_m2", "N m²"),
    ("_n_s_m", "N s/m"),
    ("_kg_m", "kg/m"),
    ("_rad_s", "rad/s"),
    ("_n_m", "N/m"),
    ("_n_s", "N s"),
    ("_m_s", "m/s"),
    ("_m_n", "m/N"),
    ("_s_m", "s/m"),
    ("_pa", "Pa"),
    ("_deg", "degrees"),
    ("_kg", "kg"),
    ("_hz", "Hz"),
    ("_m", "m"),
    ("_n", "N"),
    ("_s", "s"),
    ("_j", "J"),
    ("_w", "W"),
];

/// The name of an axis: `striker.mass_kg` is `striker mass` in `kg`.
pub(super) fn label_and_unit(field: &FieldPath) -> (String, &'static str) {
    let path = field.to_string();
    named(["structure.", "bodies."].iter().find_map(|object| path.strip_prefix(object)).unwrap_or(&path))
}

/// The axis of a result: `largest_force_n` is `largest force` in `N`.
pub(super) fn axis_of_result(column: &str) -> Axis {
    let (label, unit) = named(column);
    Axis::new(label).unit(unit)
}

fn named(path: &str) -> (String, &'static str) {
    // theta_m of the hysteretic law is a mean, not a length
    let unit = UNITS.iter().find(|(end, _)| path.ends_with(end) && !path.ends_with("theta_m"));
    let (name, unit) = unit.map_or((path, ""), |(end, unit)| (&path[..path.len() - end.len()], *unit));
    (name.replace(['.', '_'], " "), unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_become_labels_with_units() {
        let of = |text: &str| label_and_unit(&FieldPath::parse(text).unwrap());
        assert_eq!(of("striker.mass_kg"), ("striker mass".into(), "kg"));
        assert_eq!(of("location_m"), ("location".into(), "m"));
        assert_eq!(of("structure.segments[0].density_kg_m3"), ("segments[0] density".into(), "kg/m³"));
        assert_eq!(of("contact.stiffness_n_m1_5"), ("contact stiffness".into(), "N/m^1.5"));
        assert_eq!(of("contact.theta_m"), ("contact theta m".into(), ""));
        assert_eq!(of("bodies.ball.velocity_m_s"), ("ball velocity".into(), "m/s"));
        assert_eq!(of("loads[0].frequency_hz"), ("loads[0] frequency".into(), "Hz"));
        assert_eq!(of("modes"), ("modes".into(), ""));
    }
}
