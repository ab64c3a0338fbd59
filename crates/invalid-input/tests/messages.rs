//! The text of an error, and how its path grows.

use invalid_input::{InvalidInput, Path, Step, Value, cut, most_extreme, printable};

#[test]
fn a_path_grows_from_the_inside_out() {
    let fault = InvalidInput::require_positive("mass_kg", -1.0).unwrap_err();
    assert_eq!(fault.field, "mass_kg");
    let fault = fault.at(2).within("strikers");
    assert_eq!(fault.field, "strikers[2].mass_kg");
    assert_eq!(fault.field, Path::from(("strikers", 2, "mass_kg")));
    assert_ne!(fault.field, "strikers[2].mass");
    assert_ne!(fault.field, "strikers[2].mass_kg_m");
    assert_eq!(fault.to_string(), "strikers[2].mass_kg = -1 is not allowed; it must be a finite number greater than 0");
}

#[test]
fn places_come_before_the_fields_within_them() {
    let fault = InvalidInput::missing("mass_kg", "a number").in_line(3).in_place("data.csv");
    assert_eq!(fault.to_string(), "data.csv, line 3, mass_kg is missing; it must be a number");
    assert_eq!(fault.field.first(), None);
}

#[test]
fn a_field_that_does_not_apply_or_is_unknown_is_told_as_such() {
    let fault = InvalidInput::new(["contact", "restitution"], 0.5, "left out, because the law is hertz");
    let told = "contact.restitution = 0.5 is not allowed; it must be left out, because the law is hertz";
    assert_eq!(fault.to_string(), told);
    let unknown = InvalidInput::unknown("mass", 2_usize, "one of mass_kg, speed_m_s");
    assert_eq!(unknown.to_string(), "mass = 2 is not a known field; it must be one of mass_kg, speed_m_s");
    assert_eq!(fault.within(Path::default()).field.first(), Some("contact"));
}

#[test]
fn steps_distinguish_what_a_text_would_not() {
    // A name given by the user may contain the characters by which a path is written.
    let path = Path::from_iter([Step::Field("a.b[0]".into()), Step::Index(1)]);
    assert_eq!(path, "a.b[0][1]");
    assert_eq!(path.steps().len(), 2);
    assert_eq!(path.first(), Some("a.b[0]"));
}

#[test]
fn numbers_are_short() {
    for (number, text) in [
        (1.0, "1"),
        (0.1, "0.1"),
        (1e-12, "0.000000000001"),
        (1e-30, "1e-30"),
        (-1.5e300, "-1.5e+300"),
        (123_456_789_012_345.6, "123456789012345.6"),
        (f64::NAN, "NaN"),
        (f64::NEG_INFINITY, "-inf"),
    ] {
        assert_eq!(Value::from(number).to_string(), text);
    }
    assert_eq!(Value::from(7_usize).to_string(), "7");
}

#[test]
fn messages_are_short_and_cannot_control_a_terminal() {
    let long = "9".repeat(400);
    let fault = InvalidInput::new(format!("a\u{1b}{long}"), long.clone(), "less");
    let told = fault.to_string();
    assert!(told.chars().count() < 190, "{told}");
    assert!(told.starts_with("a\\u{1b}99"), "{told}");
    let once = cut(&long, 60).to_string();
    assert_eq!((once.chars().count(), cut(&once, 60).to_string()), (60, once.clone()));
    assert_eq!(cut("short", 5).to_string(), "short");
    assert_eq!(printable("a\tb\u{202e}").to_string(), "a\tb\\u{202e}");
    assert_eq!(
        InvalidInput::missing(Path::default(), "an object").to_string(),
        "the input is missing; it must be an object"
    );
}

#[test]
fn a_parent_can_be_removed() {
    let fault = InvalidInput::new(("segments", 0, "length_m"), 0_usize, "more");
    let within = fault.clone().within("structure");
    assert_eq!(within.clone().without("segments"), within);
    assert_eq!(within.without("structure"), fault);
}

#[test]
fn the_most_extreme_field_is_farthest_from_one() {
    let named = |values: &[f64]| most_extreme(values.iter().copied().enumerate()).map(|(i, _)| i);
    assert_eq!(named(&[]), None);
    assert_eq!(named(&[1.0]), Some(0));
    // a small number counts as its reciprocal, and signs do not count
    assert_eq!(named(&[1e3, 1e-4, 1.0]), Some(1));
    assert_eq!(named(&[1e-3, 1e4]), Some(1));
    assert_eq!(named(&[1e3, -1e4]), Some(1));
    // of equally extreme ones the first
    assert_eq!(named(&[2.0, 8.0, 0.125, 8.0]), Some(1));
    for most in [1e300, 1e-300, f64::from_bits(1), 0.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, -f64::NAN] {
        assert_eq!(named(&[2e11, most, 1e-60]), Some(1), "{most}");
        assert_eq!(named(&[most, 2e11]), Some(0), "{most}");
    }
    assert_eq!(named(&[f64::INFINITY, f64::NAN]), Some(1));
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Way {
    Up,
    Down,
}

invalid_input::names!(Way, "way", { Up: "up", Down: "down" });

#[test]
fn names_are_written_and_read() {
    for way in [Way::Up, Way::Down] {
        assert_eq!(way.to_string().parse(), Ok(way));
        assert_eq!(way.to_string(), way.as_str());
    }
    assert_eq!(format!("{:>6}", Way::Up), "    up");
    let fault = "sideways\u{1b}".parse::<Way>().unwrap_err().within("walk");
    assert_eq!(fault.field, "walk.way");
    assert_eq!(fault.to_string(), "walk.way = sideways\\u{1b} is not allowed; it must be one of up, down");
}
