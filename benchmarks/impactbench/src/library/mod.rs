//! The definitions of the problems, with their references.
//!
//! A reference is exact if there is a closed form. Otherwise two methods that share no code must agree. If every law is a power
//! of the compression, one of them is the program `reference/quad.c` in quadruple precision, which takes the numbers of the
//! file as exact and whose results are in `reference/quad.csv`. The other is this workspace's assembly, which propagates modes
//! exactly and collocates forces. For other laws it is compared with DOP853.

mod gallery;
mod pieces;

use crate::codes::{dop853, own_assembly};
use crate::problem::{Body, Contact, Family, LawOfContact, Problem, Quantity, What};
use contact_models::Law;
use pieces::{BALL_KG, at_ground, needs, on_structure, quantity};
use serde::Deserialize;
use std::time::{Duration, Instant};
use work_precision::{impact, infinite};

/// Hertz's stiffness of the ball on steel.
const K_H: f64 = 1.7945e10;
const HERTZ: LawOfContact = LawOfContact::Hertz { stiffness_n_m1_5: K_H };
/// Longest run of a method that computes references.
const PATIENCE: Duration = Duration::from_secs(120);
/// Largest allowed difference between the two methods.
const AGREED: f64 = 1e-8;
/// Smallest uncertainty of a reference, relative to its scale: rounding in double precision.
const ROUNDING: f64 = 4e-16;

/// Every problem.
///
/// # Errors
/// A problem whose reference cannot be computed.
pub fn problems() -> Result<Vec<Problem>, String> {
    let quad = quad()?;
    let mut problems = restitutions();
    problems.extend(infinite_beams()?);
    for problem in [laws(), structures()?, several(), stops(), gallery::problems()?].concat() {
        problems.push(if problem.reference.is_empty() { referenced(problem, &quad)? } else { problem });
    }
    Ok(problems)
}

/// Computes the reference by two methods.
fn referenced(mut problem: Problem, quad: &[Quad]) -> Result<Problem, String> {
    let named = |error: String| format!("{}: {error}", problem.name);
    let laws: Option<Vec<Law>> = problem.contacts.iter().map(|contact| contact.law.law().ok().flatten()).collect();
    let laws = laws.ok_or_else(|| named("no laws".into()))?;
    let values = own_assembly(&problem, &laws, 1e-12).map_err(named)?;
    let precise: Vec<&Quad> = quad.iter().filter(|row| row.problem == problem.name).collect();
    if precise.len() == problem.quantities.len() {
        for (quantity, row) in problem.quantities.iter_mut().zip(precise) {
            quantity.value = row.value;
            quantity.uncertainty = row.uncertainty.max(ROUNDING * quantity.scale);
        }
        let apart = problem.error(&values);
        if apart > AGREED {
            return Err(named(format!("two methods differ by {apart:.0e}")));
        }
        problem.reference = format!(
            "extrapolation in quadruple precision; the assembly at a tolerance of 1e-12, which shares no code with it, differs \
             by {apart:.0e}"
        );
        return Ok(problem);
    }
    let others = dop853(&problem, &laws, 1e-14, Instant::now() + PATIENCE).map_err(named)?;
    for ((quantity, value), other) in problem.quantities.iter_mut().zip(values).zip(others) {
        quantity.value = value;
        quantity.uncertainty = (value - other).abs().max(ROUNDING * quantity.scale);
    }
    problem.reference =
        "the assembly at a tolerance of 1e-12 and DOP853 at 1e-14, which share no code; the uncertainty is their \
                         difference"
            .into();
    Ok(problem)
}

/// A line of `reference/quad.csv`.
#[derive(Deserialize)]
struct Quad {
    problem: String,
    value: f64,
    uncertainty: f64,
}

/// The results in quadruple precision, in the order of problems and quantities.
fn quad() -> Result<Vec<Quad>, String> {
    let mut reader = csv::Reader::from_reader(include_str!("../../reference/quad.csv").as_bytes());
    reader.deserialize().collect::<Result<_, _>>().map_err(|error| format!("reference/quad.csv: {error}"))
}

/// Laws at the ground.
fn laws() -> Vec<Problem> {
    use LawOfContact as Of;
    let omega = (1e8 / BALL_KG).sqrt();
    let laws = [
        ("law-hertz", HERTZ),
        ("law-linear", Of::LinearSpring { stiffness_n_m: 1e8 }),
        ("law-viscous", Of::Viscous { stiffness_n_m1_5: K_H, damping_s_m: 0.08 }),
        ("law-viscous-strong", Of::Viscous { stiffness_n_m1_5: K_H, damping_s_m: 3.0 }),
        (
            "law-hysteretic",
            Of::Hysteretic { stiffness_n_m1_5: K_H / 4.0, theta_m: 1.6, beta: 1.4, k_bar: 0.4, epsilon_m: 5e-8 },
        ),
        ("law-kelvin-voigt", Of::KelvinVoigt { stiffness_n_m: 1e8, damping_n_s_m: 0.3 * BALL_KG * omega }),
        ("law-kelvin-voigt-strong", Of::KelvinVoigt { stiffness_n_m: 1e8, damping_n_s_m: 1.6 * BALL_KG * omega }),
        ("law-hunt-crossley", Of::HuntCrossley { stiffness_n_m_n: 1e12, exponent: 2.2, damping_s_m: 0.3 }),
        ("law-lankarani-nikravesh", Of::LankaraniNikravesh { stiffness_n_m1_5: K_H, restitution: 0.8 }),
        ("law-flores", Of::Flores { stiffness_n_m1_5: K_H, restitution: 0.3 }),
        ("law-felt", Of::Felt { stiffness_n_m_n: 1e12, exponent: 2.5, retardation_time_s: 1e-5 }),
        (
            "law-thornton",
            Of::Thornton { effective_modulus_pa: 1.1e11, effective_radius_m: 0.015, yield_pressure_pa: 1.2e9 },
        ),
    ];
    let statement = "A ball of 110.27 g meets an immovable ground at 1 m/s, without gravity, with a given law. How fast \
                     does it leave?";
    let problem = |(name, law)| {
        let mut problem = at_ground(name, Family::Law, statement.into(), law, 1.0, 1e-3);
        problem.needs.push("the law of the contact".into());
        problem
    };
    laws.map(problem).into()
}

/// Requested restitutions.
fn restitutions() -> Vec<Problem> {
    let at_one = [0.0, 0.25, 0.5, 0.75, 0.95, 1.0].map(|restitution| (restitution, 1.0));
    let cases = at_one.into_iter().chain([1e-3, 0.1, 10.0].map(|speed| (0.5, speed)));
    let problem = |(restitution, speed_m_s): (f64, f64)| {
        let statement = format!(
            "A ball of 110.27 g and 15 mm radius meets an immovable ground at {speed_m_s} m/s, without gravity. It \
             should leave with {restitution} of its speed; each code chooses how. How fast does it leave?"
        );
        let name = format!("restitution-{restitution}-at-{speed_m_s}");
        let law = LawOfContact::Restitution { restitution };
        let mut problem = at_ground(&name, Family::Restitution, statement, law, speed_m_s, 1.0);
        problem.quantities[0].value = restitution * speed_m_s;
        problem.quantities[0].uncertainty = ROUNDING * speed_m_s;
        problem.reference = "by definition".into();
        problem
    };
    cases.map(problem).collect()
}

/// Hertz contact with infinite beams.
fn infinite_beams() -> Result<Vec<Problem>, String> {
    let problem = |s: f64| {
        let (_, ratio) = infinite::first_contact(s)?;
        Ok(Problem {
            name: format!("infinite-beam-{s}"),
            family: Family::InfiniteBeam,
            statement: format!(
                "A ball strikes an infinite beam, S = {s}. What is its velocity away from the beam \
                 after the first contact, divided by the speed of impact?"
            ),
            needs: needs(&["an infinite beam"]),
            bodies: vec![],
            contacts: vec![],
            gravity_m_s2: 0.0,
            loads: vec![],
            infinite_beam_s: Some(s),
            end_s: 1e3,
            quantities: vec![Quantity {
                body: String::new(),
                shape: None,
                what: What::FirstReboundRatio,
                value: ratio,
                uncertainty: ROUNDING,
                scale: 1.0,
            }],
            reference: "collocation on a single panel with 25 digits".into(),
        })
    };
    [1e-3, 1.0, 1.5, 15.0, 1e3].into_iter().map(problem).collect()
}

/// Balls on beams and plates.
fn structures() -> Result<Vec<Problem>, String> {
    let mut problems = Vec::new();
    // Remainder modes represent modes that other codes would have: these problems are only in work-precision.
    let of_all_codes = |of: &impact::Impact| !of.name.starts_with("remainder-");
    for of in impact::library()?.into_iter().filter(of_all_codes) {
        let reference = impact::reference(of.name)?;
        let body = Body::at_rest("structure", &of.structure.modes);
        let statement = format!("{}. How fast does the ball leave after the last contact?", of.about);
        let ball = (of.striker.mass_kg, of.striker.speed_m_s);
        let mut problem = on_structure(of.name, statement, body, ball, gallery::by_name(&of.law)?, reference.end_s());
        // The hysteretic law is not a power of the compression; a program of its own computes its reference in quadruple
        // precision.
        if matches!(of.law, Law::Hysteretic(_)) {
            problem.quantities[0].value = reference.outcome.restitution * of.striker.speed_m_s;
            problem.quantities[0].uncertainty = reference.restitution_error.max(ROUNDING);
            problem.reference = "quadruple precision; the uncertainty is the difference from a coarser run".into();
        }
        problems.push(problem);
    }
    Ok(problems)
}

/// Rows of balls, and bodies that fall.
fn several() -> Vec<Problem> {
    let row = |name: &str, masses_kg: &[f64], law: LawOfContact, about: &str| {
        let names: Vec<String> = (1..=masses_kg.len()).map(|i| format!("ball-{i}")).collect();
        let ball = |(i, mass_kg): (usize, &f64)| Body::mass(&names[i], *mass_kg, 0.0, if i == 0 { -1.0 } else { 0.0 });
        let pair = |pair: &[String]| Contact::new(&pair[0], Some(&pair[1]), 0.0, law);
        Problem {
            name: name.into(),
            family: Family::Several,
            statement: format!(
                "{about} touch at the start, and the first moves towards the rest at 1 m/s. How fast does each move in the \
                 end?"
            ),
            needs: needs(&["several free masses", "the law of the contact"]),
            bodies: masses_kg.iter().enumerate().map(ball).collect(),
            contacts: names.windows(2).map(pair).collect(),
            gravity_m_s2: 0.0,
            loads: vec![],
            infinite_beam_s: None,
            end_s: 1e-3,
            quantities: names.iter().map(|name| quantity(name, What::VelocityMS, 1.0)).collect(),
            reference: String::new(),
        }
    };
    let viscous = LawOfContact::Viscous { stiffness_n_m1_5: 1e10, damping_s_m: 0.5 };
    let hertz = LawOfContact::Hertz { stiffness_n_m1_5: 1e10 };
    let mut fall = at_ground(
        "bounces",
        Family::Several,
        "A ball of 110.27 g falls from 50 mm onto an immovable ground with Hertz's contact. How high is it after 1 s, and how \
         fast does it move?"
            .into(),
        HERTZ,
        0.0,
        1.0,
    );
    fall.bodies = vec![Body::mass("ball", BALL_KG, 0.05, 0.0)];
    fall.gravity_m_s2 = 9.81;
    fall.needs = needs(&["one free mass", "immovable ground", "gravity", "the law of the contact"]);
    fall.quantities = vec![quantity("ball", What::DisplacementM, 0.05), quantity("ball", What::VelocityMS, 1.0)];
    let mut damped = fall.clone();
    damped.name = "bounces-damped".into();
    damped.statement = damped.statement.replace("Hertz's contact", "Hertz's contact and viscous losses of 0.5 s/m");
    damped.contacts[0].law = LawOfContact::Viscous { stiffness_n_m1_5: K_H, damping_s_m: 0.5 };
    vec![
        row("cradle-2", &[0.1, 0.1], hertz, "Two balls of 100 g with Hertz's contact"),
        row("cradle-3", &[0.1; 3], hertz, "Three balls of 100 g with Hertz's contacts"),
        row("cradle-5", &[0.1; 5], hertz, "Newton's cradle: five balls of 100 g with Hertz's contacts"),
        row("cradle-5-damped", &[0.1; 5], viscous, "Five balls of 100 g with Hertz's contacts and viscous losses"),
        row("row-unequal", &[0.3, 0.05, 0.1, 0.02], hertz, "Balls of 300, 50, 100 and 20 g with Hertz's contacts"),
        fall,
        damped,
    ]
}

/// Masses on springs that meet elastic stops: piecewise linear problems, each with a closed form.
fn stops() -> Vec<Problem> {
    let oscillator = |name: &str, mass_kg: f64, omega: f64, speed_m_s: f64| Body {
        name: name.into(),
        omega_rad_s: vec![omega],
        damping_ratio: vec![0.0],
        shape: vec![mass_kg.sqrt().recip()],
        amplitude: vec![0.0],
        rate: vec![-speed_m_s * mass_kg.sqrt()],
    };
    let problem = |name: &str, statement: &str, body: Body, gap_m: f64, stiffness_n_m: f64, end_s: f64, scale: f64| {
        let law = LawOfContact::LinearSpring { stiffness_n_m };
        let contacts = vec![Contact::new("mass", None, gap_m, law)];
        Problem {
            name: name.into(),
            family: Family::Stop,
            statement: statement.into(),
            needs: needs(&["an oscillator", "an elastic stop"]),
            bodies: vec![body],
            contacts,
            gravity_m_s2: 0.0,
            loads: vec![],
            infinite_beam_s: None,
            end_s,
            quantities: vec![quantity("mass", What::VelocityMS, scale)],
            reference: String::new(),
        }
    };
    // Code_Aster's SDND122 at three quarters of its tenth period, whose exact frequency is 0.64663104064 Hz.
    let energy_j: f64 = 0.00650108331626;
    let speed = (2.0 * energy_j).sqrt();
    let sdnd101 = problem(
        "sdnd101",
        "Code_Aster's SDND101: a mass of 100 kg on a spring of 1e4 N/m moves at 1 m/s against a stop of 1e6 N/m that it \
         touches. How fast does it move after 1 s and three contacts?",
        oscillator("mass", 100.0, 10.0, 1.0),
        0.0,
        1e6,
        1.0,
        1.0,
    );
    let sdnd122 = problem(
        "sdnd122",
        "Code_Aster's SDND122: a mass of 1 kg on a spring of 10 N/m with an energy of 0.00650108331626 J meets a stop of \
         50 N/m at 10 mm. How fast does it move after 15 s? (The \"analytic\" frequency of the source is off by 6.4e-4.)",
        oscillator("mass", 1.0, 10f64.sqrt(), speed),
        0.01,
        50.0,
        15.0,
        speed,
    );
    let hard = problem(
        "hard-stop",
        "A mass of 1 kg on a spring of 1000 N/m meets a stop of 1e8 N/m at 1 mm again and again. How fast does it move after \
         2 s?",
        oscillator("mass", 1.0, 1000f64.sqrt(), 0.1),
        1e-3,
        1e8,
        2.0,
        0.1,
    );
    vec![sdnd101, sdnd122, hard]
}
