//! Allowed values of each field of a scene, for the messages about missing and mistyped fields. (Numbers out of range are found,
//! and described, by the crates that use them.)

use std::ops::Bound::{self, Excluded, Included, Unbounded};

use invalid_input::{Path, Step};

pub(crate) use super::ranges::{DAMPING, MOST_DAMPING, NOT_NEGATIVE, POSITIVE};

/// A field and its allowed values.
const FIELDS: &[(&str, &str)] = &[
    ("", "an object with structure, striker and contact"),
    ("$schema", "a text, the address of the schema of scenes"),
    ("version", "the whole number 1, the version of the format"),
    ("description", "a text"),
    (
        "structure",
        "an object with the field kind, one of beam, string, plate, modal, modes-file, infinite-beam, infinite-plate, dropped-rod",
    ),
    ("kind", "one of beam, string, plate, modal, modes-file, infinite-beam, infinite-plate, dropped-rod"),
    ("striker", "an object with mass_kg (or density_kg_m3 and radius_m) and speed_m_s"),
    ("contact", "an object with the field law and the parameters of that law"),
    (
        "law",
        "one of hertz, viscous, hysteretic, linear-spring, power, felt, kelvin-voigt, hunt-crossley, lankarani-nikravesh, flores, elastoplastic",
    ),
    ("location_m", "a finite number from 0 to the length of the beam or string, or for a plate a list of two, [x, y]"),
    ("location", "the name of one of the structure's points"),
    ("model", "one of auto, rigid, infinite-beam, modal, emoc"),
    ("modes", "\"auto\" or a whole number from 0 to 10000"),
    ("residual_compliance", "true or false"),
    ("gravity_m_s2", NOT_NEGATIVE),
    ("tolerance", "a number from 1e-13 to 0.1, or from 1e-10 to 0.5 where the program chooses the modes"),
    ("yield_strength_pa", POSITIVE),
    ("ends", "a list of two, the left and the right end, each one of clamped, pinned, free, guided"),
    ("ends[]", "one of clamped, pinned, free, guided"),
    ("segments", "a list of segments, each an object with length_m and a section"),
    ("segments[]", "an object with length_m and a section"),
    ("edges", "a list of four, at x = 0, x = length, y = 0, y = width, each one of clamped, pinned, free"),
    ("edges[]", "one of clamped, pinned, free"),
    ("theory", "one of euler-bernoulli, timoshenko, auto (for beams), kirchhoff, mindlin (for plates)"),
    ("tension_n", POSITIVE),
    ("damping_ratio", DAMPING),
    ("rayleigh_mass_per_s", NOT_NEGATIVE),
    ("rayleigh_stiffness_s", NOT_NEGATIVE),
    ("attachments", "a list of objects, each with location_m and the properties of what is attached there"),
    (
        "attachments[]",
        "an object with location_m and any of mass_kg, rotary_inertia_kg_m2, spring_n_m, rotational_spring_n_m_rad",
    ),
    ("supports", "a list of objects, each with location_m"),
    ("supports[]", "an object with location_m"),
    ("rotary_inertia_kg_m2", NOT_NEGATIVE),
    ("spring_n_m", NOT_NEGATIVE),
    ("rotational_spring_n_m_rad", NOT_NEGATIVE),
    ("axial_force_n", "a finite number, positive in tension, and 0 with Timoshenko's theory"),
    ("foundation_n_m2", NOT_NEGATIVE),
    ("shear_coefficient", "a number greater than 0 and not greater than 2"),
    ("shear_rigidity_n", POSITIVE),
    ("rotary_inertia_kg_m", NOT_NEGATIVE),
    ("length_m", POSITIVE),
    ("flexural_rigidity_n_m2", POSITIVE),
    ("mass_per_length_kg_m", POSITIVE),
    ("youngs_modulus_pa", POSITIVE),
    ("density_kg_m3", POSITIVE),
    ("width_m", POSITIVE),
    ("thickness_m", POSITIVE),
    ("diameter_m", POSITIVE),
    ("omega_rad_s", "a list of finite numbers not less than 0"),
    ("omega_rad_s[]", NOT_NEGATIVE),
    ("shape_at_location", "a list of finite numbers, one for each mode"),
    ("shape_at_location[]", "a finite number"),
    (
        "damping_ratios",
        "a list of numbers from 0 to 1e6, one for each mode, or for a beam one for each of its first elastic modes",
    ),
    ("damping_ratios[]", DAMPING),
    ("modal_mass_kg", "a list of finite numbers greater than 0, one for each mode"),
    ("modal_mass_kg[]", POSITIVE),
    ("points", "an object with one object for each named point, which contains the shape at this point"),
    ("shape", "a list of finite numbers, one for each mode"),
    ("shape[]", "a finite number"),
    ("static_compliance_m_n", NOT_NEGATIVE),
    ("residual_compliance_m_n", NOT_NEGATIVE),
    ("file", "the path of a table in the folder of the scene or below, without .."),
    ("static_compliances_m_n", "an object with a number for each named point"),
    ("inclination_deg", "a number from 0 to 90"),
    ("bending_modes", "a whole number from 0 to 10000"),
    ("axial_modes", "a whole number from 0 to 10000"),
    ("immovable", "true or false"),
    ("start", "an object with gap_m, moving_modes, amplitude_m_kg0_5, rate_m_kg0_5_s, any of which may be left out"),
    ("gap_m", NOT_NEGATIVE),
    ("amplitude_m_kg0_5", "a list of finite numbers, for the first modes"),
    ("amplitude_m_kg0_5[]", "a finite number"),
    ("rate_m_kg0_5_s", "a list of finite numbers, for the first modes"),
    ("rate_m_kg0_5_s[]", "a finite number"),
    ("moving_modes", "a list of objects, each with mode and displacement_m or velocity_m_s"),
    ("moving_modes[]", "an object with mode and displacement_m or velocity_m_s"),
    ("mode", "a whole number from 1"),
    ("displacement_m", "a finite number"),
    ("velocity_m_s", "a finite number"),
    ("mass_kg", POSITIVE),
    ("radius_m", POSITIVE),
    ("speed_m_s", "a finite number, positive towards the structure"),
    ("stiffness_n_m1_5", POSITIVE),
    ("stiffness_n_m", POSITIVE),
    ("stiffness_n_m_n", POSITIVE),
    ("exponent", "a number from 1 to 6, and for the law felt from 2"),
    ("retardation_time_s", POSITIVE),
    ("damping_s_m", NOT_NEGATIVE),
    ("damping_n_s_m", POSITIVE),
    ("restitution", "a coefficient of restitution from 0.001 to 1"),
    ("lowest_approach_speed_m_s", POSITIVE),
    ("theta_m", POSITIVE),
    ("beta", "a number from 0 to 1 + theta_m"),
    ("k_bar", "a number greater than 0 and not greater than 1000"),
    ("epsilon_m", NOT_NEGATIVE),
    ("yield_pressure_pa", POSITIVE),
    ("effective_modulus_pa", POSITIVE),
    ("effective_radius_m", POSITIVE),
    ("striker_youngs_modulus_pa", POSITIVE),
    ("striker_poissons_ratio", "a number greater than -1 and not greater than 0.5"),
    ("poissons_ratio", "a number greater than -1 and not greater than 0.5"),
];

/// Allowed values of the field of this name. (`name[]` are the items of a list.)
pub(crate) fn allowed(name: &str) -> Option<&'static str> {
    look_up(FIELDS, name).or_else(|| look_up(crate::assembly::fields::FIELDS, name))
}

/// Allowed values of the field at the end of this path.
pub(crate) fn allowed_at(path: &Path) -> Option<&'static str> {
    allowed(&name_at(path))
}

/// The entry of a table of fields for this name.
pub(crate) fn look_up(fields: &[(&str, &'static str)], name: &str) -> Option<&'static str> {
    fields.iter().find(|(field, _)| *field == name).map(|(_, allowed)| *allowed)
}

/// The name at the end of a path; for an item of a list the name of the list; empty for the whole scene.
pub(crate) fn name_at(path: &Path) -> String {
    match path.steps() {
        [.., Step::Field(name)] => name.clone(),
        [.., Step::Field(list), Step::Index(_)] => format!("{list}[]"),
        _ => String::new(),
    }
}

/// The range of a number in the field of this name, if it has one. It is used in the schema, which tests compare with the values
/// that are rejected. (`name[]` are the items of a list.)
pub(crate) fn range(name: &str) -> Option<(Bound<f64>, Bound<f64>)> {
    let of_text = |text: &str| match text {
        POSITIVE => Some((Excluded(0.0), Unbounded)),
        NOT_NEGATIVE => Some((Included(0.0), Unbounded)),
        DAMPING => Some((Included(0.0), Included(MOST_DAMPING))),
        _ => None,
    };
    match name {
        "modes" | "bending_modes" | "axial_modes" => Some((Included(0.0), Included(10_000.0))),
        "mode" => Some((Included(1.0), Unbounded)),
        "tolerance" => Some((Included(1e-13), Included(0.5))),
        "exponent" => Some((Included(1.0), Included(6.0))),
        "restitution" => Some((Included(1e-3), Included(1.0))),
        "k_bar" => Some((Excluded(0.0), Included(1000.0))),
        "beta" => Some((Included(0.0), Unbounded)),
        "poissons_ratio" | "striker_poissons_ratio" => Some((Excluded(-1.0), Included(0.5))),
        "shear_coefficient" => Some((Excluded(0.0), Included(2.0))),
        "inclination_deg" => Some((Included(0.0), Included(90.0))),
        "statistics_from_s" => Some((Included(0.0), Excluded(1e12))),
        "end_s" => Some((Excluded(0.0), Included(1e12))),
        "frequency_hz" => Some((Included(1e-12), Included(1e30))),
        _ => allowed(name).and_then(of_text),
    }
}
