//! Allowed values of the fields that only scenes of bodies have.

use crate::scene::ranges::{NOT_NEGATIVE, POSITIVE};

/// A field and its allowed values.
pub(crate) const FIELDS: &[(&str, &str)] = &[
    ("bodies", "an object with one object for each named body, which has the field kind"),
    ("contacts", "a list of contacts, each an object with name, between, gap_m, and a law with its parameters"),
    ("contacts[]", "an object with name, between, gap_m, and a law with its parameters"),
    ("name", CONTACT_NAME),
    ("between", BETWEEN),
    ("between[]", "an object with body and, unless that is a mass, location_m or location; or \"ground\""),
    ("two_sided", "true or false"),
    ("reduced_mass_kg", POSITIVE),
    ("approach_speed_m_s", POSITIVE),
    ("body", "the name of one of the bodies"),
    ("gravity_m_s2", NOT_NEGATIVE),
    ("loads", "a list of loads, each an object with body, its location, and a force"),
    ("loads[]", "an object with body, its location, and a force"),
    ("force_n", "a finite number"),
    ("frequency_hz", FREQUENCY),
    ("phase_deg", "a finite number"),
    ("times_s", "a list of finite numbers in ascending order; equal neighbours make a jump"),
    ("times_s[]", "a finite number not less than the one before"),
    ("forces_n", "a list of finite numbers, one for each time"),
    ("forces_n[]", "a finite number"),
    (
        "ground_motion",
        "an object with displacement_m or acceleration_m_s2 and frequency_hz, or a measured acceleration",
    ),
    ("acceleration_m_s2", "a finite number"),
    ("accelerations_m_s2", "a list of finite numbers, one for each time"),
    ("accelerations_m_s2[]", "a finite number"),
    ("static_start", "true or false"),
    ("end_s", "a number greater than 0 and not greater than 1e12"),
    ("statistics_from_s", "a number not less than 0 and less than end_s"),
    ("position_m", "a finite number"),
    ("gravity_participation_kg0_5", "a list of finite numbers, one for each mode"),
    ("gravity_participation_kg0_5[]", "a finite number"),
    ("axial_rigidity_n", POSITIVE),
    ("area_m2", POSITIVE),
];

/// The name of a contact.
pub(crate) const CONTACT_NAME: &str = "a text without control characters that is the name of no other contact";

/// The frequency of a harmonic load: its longest period is that of the longest run.
pub(crate) const FREQUENCY: &str = "a number from 1e-12 to 1e30";

/// The two sides of a contact.
pub(crate) const BETWEEN: &str = "a list of two, each an object with body and its location, or \"ground\"; the first lies on \
                                  the side of greater x";

/// The kinds of bodies.
pub(crate) const KINDS: &str = "one of mass, rod, beam, string, plate, modal, modes-file";
