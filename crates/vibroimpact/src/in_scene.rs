//! Errors of the solver with the field names of scenes.

use invalid_input::{InvalidInput, Step, Value};

/// The solver's error with the field names of scenes.
pub(crate) fn in_scene(fault: InvalidInput) -> InvalidInput {
    match fault.field.steps() {
        // the modes of a scene have been checked where they were computed or read
        [Step::Field(list), Step::Index(_), ..] if list == "modes" => fault.within("structure"),
        // a striker of infinite mass is a stop
        [Step::Field(name)] if name == "mass_kg" && fault.value == Some(Value::Number(f64::INFINITY)) => {
            let allowed = "left out, with a mass in its place, because no mode of the structure moves at the contact";
            InvalidInput::new(["striker", "immovable"], "true", allowed)
        }
        [Step::Field(name)] if ["mass_kg", "speed_m_s"].contains(&name.as_str()) => fault.within("striker"),
        // an amplitude or rate out of range may come from any of the ways in which a scene states the start
        [Step::Field(name), ..] if ["gap_m", "amplitude", "rate"].contains(&name.as_str()) => fault.within("start"),
        _ => fault,
    }
}
