//! Problems that are scenes of the gallery in `datasets`.

use super::pieces::{needs, on_structure, quantity};
use crate::codes::own_assembly;
use crate::problem::{Body, Contact, Family, LawOfContact, Load, Problem, Quantity, What};
use contact_models::Law;
use std::f64::consts::FRAC_PI_2;
use std::path::PathBuf;
use vibroimpact::assembly::AssemblyScene;
use vibroimpact::model::Modes;
use vibroimpact::{Impact, Scene};
use vibroimpact_sim::assembly::{Force, Point};

/// All of them, without their references.
pub(super) fn problems() -> Result<Vec<Problem>, String> {
    let mut problems = Vec::new();
    for (file, name, count, end_s) in [
        ("simply-supported-plate", "plate", Some(60), 0.01),
        ("cantilever-plate", "cantilever-plate", Some(60), 0.01),
        ("measured-modes", "measured-modes", None, 0.01),
        ("linear-stop", "soft-contact", Some(20), 0.05),
        ("timoshenko-beam", "timoshenko-beam", Some(40), 0.02),
    ] {
        problems.push(ball(file, name, count, end_s)?);
    }
    problems.push(dropped_rod()?);
    problems.push(turning_beam()?);
    for (file, family, end_s) in [
        ("sdnd102", Family::Stop, 1.0),
        ("sdnd125", Family::Stop, 1.0),
        ("sdnl104", Family::Stop, 0.16),
        ("sdnl105", Family::Stop, 1.0),
        ("sdnl301", Family::Stop, 0.25),
        ("shaken-table", Family::Several, 1.0),
        ("dropped-ball", Family::Several, 0.25),
    ] {
        problems.push(bodies(file, family, end_s)?);
    }
    Ok(problems)
}

fn path(folder: &str, file: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "../../datasets", folder, &format!("{file}.json")].iter().collect()
}

/// The impact of a scene with this many modes, or with all that it lists.
fn impact(file: &str, count: Option<usize>) -> Result<Impact, String> {
    let mut scene = Scene::read(&path("scenes", file)).map_err(|error| error.to_string())?;
    if let Some(count) = count {
        scene.modes = Modes::Count(count);
        scene.residual_compliance = Some(false);
    }
    scene.impact().map_err(|error| error.to_string())
}

/// A ball on a structure at rest.
fn ball(file: &str, name: &str, count: Option<usize>, end_s: f64) -> Result<Problem, String> {
    let found = impact(file, count)?;
    let modes = &found.structure.modes;
    let body = Body::at_rest("structure", modes);
    let statement = format!(
        "The scene {file}.json of the gallery with {} modes. How fast does the ball move after {end_s} s?",
        modes.len()
    );
    let ball = (found.striker.mass_kg, found.striker.speed_m_s);
    Ok(on_structure(name, statement, body, ball, by_name(&found.law)?, end_s))
}

/// A structure that moves against an immovable stop, which it touches at the start. In a scene the stop is above, in a problem
/// below.
fn against_ground(name: &str, body: &str, found: &Impact) -> Result<Problem, String> {
    let start = found.start.as_ref().ok_or("a structure at rest meets no stop")?;
    let mut body = Body::at_rest(body, &found.structure.modes);
    body.amplitude = start.amplitude.iter().map(|amplitude| 0.0 - amplitude).collect();
    body.rate = start.rate.iter().map(|rate| 0.0 - rate).collect();
    let mut problem = on_structure(name, String::new(), body, (1.0, 1.0), by_name(&found.law)?, 0.0);
    // The ground takes the place of the ball.
    problem.bodies.remove(0);
    problem.contacts = vec![Contact::new(&problem.bodies[0].name, None, 0.0, by_name(&found.law)?)];
    problem.needs = needs(&["a moving body in its modes", "immovable ground", "the law of the contact"]);
    Ok(problem)
}

/// The rod of chapter 8 on the floor.
fn dropped_rod() -> Result<Problem, String> {
    let found = impact("dropped-rod", None)?;
    let mut problem = against_ground("dropped-rod", "rod", &found)?;
    let body = &problem.bodies[0];
    let rigid: Vec<f64> = body
        .shape
        .iter()
        .zip(&body.omega_rad_s)
        .map(|(shape, omega)| if *omega == 0.0 { *shape } else { 0.0 })
        .collect();
    problem.statement = format!(
        "A steel rod of 0.2 m falls on an immovable floor at 1 m/s, inclined by 45 degrees; {} \
         modes describe its rigid, bending and axial motion. How fast does its lower end rise after 2 ms by the rigid \
         motion alone?",
        body.shape.len()
    );
    problem.end_s = 2e-3;
    problem.quantities = vec![Quantity { shape: Some(rigid), ..quantity("rod", What::VelocityMS, 1.0) }];
    Ok(problem)
}

/// SDNL32 of the VPCS guide.
fn turning_beam() -> Result<Problem, String> {
    let mut problem = against_ground("sdnl32", "beam", &impact("sdnl32", Some(10))?)?;
    problem.family = Family::Stop;
    problem.statement = "SDNL32: a straight beam of 10 modes turns about its pinned end, and its tip meets a stop of 18 kN/m \
                         at 2.9754 m/s. Where is the tip after 12 ms, and how fast does it move? (The guide lists -0.742 mm, \
                         by Timoshenko elements. Its value at 3 ms is a misprint, -4.92 instead of -4.95 mm.)"
        .into();
    problem.end_s = 0.012;
    problem.quantities = vec![quantity("beam", What::DisplacementM, 5e-3), quantity("beam", What::VelocityMS, 2.9754)];
    Ok(problem)
}

/// The subject of a scene of several bodies, and the values of its source that are wrong.
fn statement(file: &str) -> &'static str {
    match file {
        "sdnd102" => "Code_Aster's SDND102: an oscillator on a shaken base strikes a wall.",
        "sdnd125" => {
            "Code_Aster's SDND125: three masses in a row, the outer ones on springs, the middle one driven. (The \
             source states a force of 1698.44669 N on the left at 0.68044 s; the exact one is 1698.44744 N.)"
        }
        "sdnl104" => {
            "Code_Aster's SDNL104 with 40 modes: a cantilever under a force at its tip above a stop. (The two \
             answers of the source for the tip at 0.1315 s are 7 % apart.)"
        }
        "sdnl105" => {
            "Code_Aster's SDNL105 with 5 modes for each of three tubes: the first is pushed against the second, and the \
             second against the third. (With more modes the velocities change by up to 40 %.)"
        }
        "sdnl301" => {
            "Code_Aster's SDNL301: a tube under a harmonic load has gaps on both sides at four supports. (The source states a \
             root mean square of 23.98 N at the last support, from fixed steps; without an error in time it is 24.53 N.)"
        }
        "shaken-table" => {
            "A ball bounces on a table that shakes at 20 Hz with 1.2 times the acceleration of gravity. Motion is relative to \
             the table."
        }
        _ => "A ball dropped from 5 mm bounces on a pinned beam under gravity.",
    }
}

/// A scene of several bodies; the displacement and the velocity of each at the end are requested.
fn bodies(file: &str, family: Family, end_s: f64) -> Result<Problem, String> {
    let scene = AssemblyScene::read(&path("assemblies", file)).map_err(|error| error.to_string())?;
    let posed = scene.pose().map_err(|error| error.to_string())?;
    let (assembly, names) = (posed.assembly, posed.bodies);
    let touched = |number: usize| {
        let sides = assembly.contacts.iter().flat_map(|contact| &contact.sides);
        let mut shapes = sides.filter_map(|side| match side {
            Point::OfBody { body, shape } if *body == number => Some(shape.clone()),
            _ => None,
        });
        shapes.next().ok_or_else(|| format!("{file}: {} touches nothing", names[number]))
    };
    let mut bodies = Vec::new();
    for (number, body) in assembly.bodies.iter().enumerate() {
        bodies.push(Body {
            name: names[number].clone(),
            omega_rad_s: body.modes.iter().map(|mode| mode.omega_rad_s).collect(),
            damping_ratio: body.modes.iter().map(|mode| mode.damping_ratio).collect(),
            shape: touched(number)?,
            amplitude: body.amplitude.clone(),
            rate: body.rate.clone(),
        });
    }
    let elsewhere = |body: usize, shape: &[f64]| (bodies[body].shape != shape).then(|| shape.to_vec());
    let side = |point: &Point| match point {
        Point::Ground => (None, None),
        Point::OfBody { body, shape } => (Some(names[*body].clone()), elsewhere(*body, shape)),
    };
    let mut contacts = Vec::new();
    for contact in &assembly.contacts {
        let [(upper, upper_shape), (lower, lower_shape)] = [side(&contact.sides[0]), side(&contact.sides[1])];
        let law = by_name(&contact.law)?;
        contacts.push(Contact { upper, upper_shape, lower, lower_shape, gap_m: contact.gap_m, law });
    }
    let mut loads: Vec<Load> = Vec::new();
    for load in &assembly.loads {
        let (force_n, omega_rad_s, phase_rad) = match load.force {
            Force::Constant { force_n } => (force_n, 0.0, FRAC_PI_2),
            Force::Harmonic { force_n, omega_rad_s, phase_rad } => (force_n, omega_rad_s, phase_rad),
            _ => return Err(format!("{file}: a load without a name here")),
        };
        let alike =
            |of: &&mut Load| of.body == names[load.body] && (of.omega_rad_s, of.phase_rad) == (omega_rad_s, phase_rad);
        let whole = load.shape.iter().map(|shape| shape * force_n);
        match loads.iter_mut().find(alike) {
            // Several forces of one frequency on one body are one force.
            Some(Load { shape: Some(sum), .. }) => sum.iter_mut().zip(whole).for_each(|(sum, more)| *sum += more),
            _ => loads.push(Load {
                body: names[load.body].clone(),
                shape: Some(whole.collect()),
                force_n: 1.0,
                omega_rad_s,
                phase_rad,
            }),
        }
    }
    let mut problem = Problem {
        name: file.into(),
        family,
        statement: format!("{} Where is each body after {end_s} s, and how fast does it move?", statement(file)),
        needs: needs(&["bodies in their modes", "loads", "the law of the contact"]),
        quantities: names
            .iter()
            .flat_map(|name| [What::DisplacementM, What::VelocityMS].map(|what| quantity(name, what, 1.0)))
            .collect(),
        bodies,
        contacts,
        gravity_m_s2: 0.0,
        loads,
        infinite_beam_s: None,
        end_s,
        reference: String::new(),
    };
    scale(&mut problem)?;
    Ok(problem)
}

/// Scales errors by the largest displacement and velocity at any of 32 instants of the motion.
fn scale(problem: &mut Problem) -> Result<(), String> {
    let laws: Result<Vec<Option<Law>>, _> = problem.contacts.iter().map(|contact| contact.law.law()).collect();
    let laws: Vec<Law> = laws.map_err(|error| error.to_string())?.into_iter().flatten().collect();
    let mut largest = [0.0; 2];
    let at = |what: What| usize::from(what == What::VelocityMS);
    for moment in 1..=32 {
        let until = Problem { end_s: problem.end_s * f64::from(moment) / 32.0, ..problem.clone() };
        for (value, quantity) in own_assembly(&until, &laws, 1e-6)?.iter().zip(&problem.quantities) {
            largest[at(quantity.what)] = f64::max(largest[at(quantity.what)], value.abs());
        }
    }
    for quantity in &mut problem.quantities {
        // Two digits suffice for a scale.
        quantity.scale = format!("{:.1e}", largest[at(quantity.what)]).parse().map_err(|_| "a scale is a number")?;
    }
    Ok(())
}

/// The law as a file states it.
pub(super) fn by_name(law: &Law) -> Result<LawOfContact, String> {
    Ok(match *law {
        Law::Hertz(law) => LawOfContact::Hertz { stiffness_n_m1_5: law.stiffness_n_m1_5 },
        Law::LinearSpring(law) => LawOfContact::LinearSpring { stiffness_n_m: law.stiffness_n_m },
        Law::KelvinVoigt(law) => {
            LawOfContact::KelvinVoigt { stiffness_n_m: law.stiffness_n_m, damping_n_s_m: law.damping_n_s_m }
        }
        Law::HuntCrossley(law) => LawOfContact::HuntCrossley {
            stiffness_n_m_n: law.stiffness_n_m_n,
            exponent: law.exponent,
            damping_s_m: law.damping_s_m,
        },
        Law::Viscous(law) => {
            LawOfContact::Viscous { stiffness_n_m1_5: law.stiffness_n_m1_5, damping_s_m: law.damping_s_m }
        }
        Law::Hysteretic(law) => LawOfContact::Hysteretic {
            stiffness_n_m1_5: law.stiffness_n_m1_5,
            theta_m: law.theta_m,
            beta: law.beta,
            k_bar: law.k_bar,
            epsilon_m: law.epsilon_m,
        },
        _ => return Err(format!("a law without a name here: {}", law.name())),
    })
}
