//! Parts of the definitions of problems.

use crate::problem::{Body, Contact, Family, LawOfContact, Problem, Quantity, What};

/// A steel ball of 30 mm.
pub(super) const BALL_KG: f64 = 0.11027;

pub(super) fn quantity(body: &str, what: What, scale: f64) -> Quantity {
    Quantity { body: body.into(), shape: None, what, value: f64::NAN, uncertainty: 0.0, scale }
}

pub(super) fn needs(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

/// A ball at an immovable ground.
pub(super) fn at_ground(
    name: &str,
    family: Family,
    statement: String,
    law: LawOfContact,
    speed_m_s: f64,
    end_s: f64,
) -> Problem {
    Problem {
        name: name.into(),
        family,
        statement,
        needs: needs(&["one free mass", "immovable ground"]),
        bodies: vec![Body::mass("ball", BALL_KG, 0.0, -speed_m_s)],
        contacts: vec![Contact::new("ball", None, 0.0, law)],
        gravity_m_s2: 0.0,
        loads: vec![],
        infinite_beam_s: None,
        end_s,
        quantities: vec![quantity("ball", What::VelocityMS, speed_m_s)],
        reference: String::new(),
    }
}

/// A ball, by its mass and speed, that touches a structure at the start.
pub(super) fn on_structure(
    name: &str,
    statement: String,
    body: Body,
    ball: (f64, f64),
    law: LawOfContact,
    end_s: f64,
) -> Problem {
    let (mass_kg, speed_m_s) = ball;
    let mut problem = at_ground(name, Family::Structure, statement, law, speed_m_s, end_s);
    problem.needs =
        needs(&["one free mass", "a structure in its modes, or one that is equivalent", "the law of the contact"]);
    let touching = body.at_point(&body.amplitude);
    problem.bodies = vec![Body::mass("ball", mass_kg, touching, -speed_m_s), body];
    problem.contacts[0].lower = Some("structure".into());
    problem
}
