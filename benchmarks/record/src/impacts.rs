//! Impacts on modal structures (thesis chapters 3, 4 and 8) and on infinite ones (chapter 2).

use crate::problem::{Found, Problem};
use contact_models::Law;
use std::path::Path;
use tasks::Failure;
use vibroimpact::model::Modes;
use vibroimpact::{Impact, Scene};
use vibroimpact_sim::dropped_rod::DroppedRod;
use vibroimpact_sim::infinite::{self, critical_s, turning_point};
use vibroimpact_sim::modal::{Counts, Settings, Solution, Solver, Striker};

/// Every modal problem is solved at these speeds (m/s). Its error is the largest of the five, so that a single result that is
/// accurate by chance does not hide the others.
const SPEEDS: [f64; 5] = [0.8, 0.9, 1.0, 1.1, 1.25];
/// The tolerance of the reference.
fn tighter_than(tolerance: f64) -> f64 {
    (0.1 * tolerance).min(1e-12)
}

/// The impacts at all speeds: restitutions, and the counts in all.
fn at_all_speeds(impact: &Impact, tolerance: f64) -> Result<Found, Failure> {
    let solver = Solver::new(&impact.structure)?;
    let settings = Settings { tolerance, estimate_uncertainty: false, ..impact.settings };
    let mut values = Vec::new();
    let mut total = Counts::default();
    for speed_m_s in SPEEDS {
        let striker = Striker { speed_m_s, ..impact.striker };
        let solution = solver.solve(&striker, &impact.law, None, &settings)?;
        values.push(restitution(&solution)?);
        add(&mut total, &solution.counts);
    }
    Ok(Found { values, costs: named(&total) })
}

fn restitution(solution: &Solution) -> Result<f64, Failure> {
    solution.restitution.ok_or_else(|| format!("no restitution: {}", solution.outcome.as_str()).into())
}

fn add(total: &mut Counts, counts: &Counts) {
    total.contact_steps += counts.contact_steps;
    total.rejected_steps += counts.rejected_steps;
    total.newton_iterations += counts.newton_iterations;
    total.law_evaluations += counts.law_evaluations;
    total.flight_steps += counts.flight_steps;
}

fn named(counts: &Counts) -> Vec<(&'static str, u64)> {
    vec![
        ("contact_steps", counts.contact_steps),
        ("rejected_steps", counts.rejected_steps),
        ("newton_iterations", counts.newton_iterations),
        ("law_evaluations", counts.law_evaluations),
        ("flight_steps", counts.flight_steps),
    ]
}

fn modal(name: String, impact: Impact, tolerance: f64) -> Problem {
    let tighter = impact.clone();
    Problem::against_tighter(
        format!("modal/{name}/{tolerance:e}"),
        move || Ok(at_all_speeds(&tighter, tighter_than(tolerance))?.values),
        move || at_all_speeds(&impact, tolerance),
    )
    // the effect of rounding after dozens of sub-impacts
    .rounding(1e-11)
}

/// Impacts of thesis chapters 3, 4 and 8.
pub fn on_modes(root: &Path) -> Result<Vec<Problem>, Failure> {
    let scene = |name: &str| Scene::read(&root.join(format!("datasets/scenes/{name}.json")));
    let mut problems = Vec::new();

    let mut pinned = scene("pinned-beam-converged")?;
    pinned.residual_compliance = Some(false);
    for n in [10, 40, 200] {
        pinned.modes = Modes::Count(n);
        for tolerance in [1e-6, 1e-9, 1e-12] {
            problems.push(modal(format!("pinned N={n} hertz"), pinned.impact()?, tolerance));
        }
    }
    pinned.modes = Modes::Count(40);
    let hertz = pinned.impact()?;
    for law in laws(&hertz.law)? {
        problems.push(modal(format!("pinned N=40 {}", law.name()), Impact { law, ..hertz.clone() }, 1e-9));
    }
    pinned.residual_compliance = Some(true);
    problems.push(modal("pinned N=40 hertz, remainder modes".into(), pinned.impact()?, 1e-9));

    // an undamped impact amplifies every error, including rounding
    let mut undamped = scene("pinned-beam-undamped")?;
    undamped.modes = Modes::Count(25);
    problems.push(modal("undamped N=25 hertz".into(), undamped.impact()?, 1e-9).rounding(1e-7));

    for name in ["stepped-cantilever", "cantilever-tip"] {
        let truncated =
            Scene { modes: Modes::Count(40), residual_compliance: Some(false), tolerance: None, ..scene(name)? };
        problems.push(modal(format!("{name} N=40 hertz"), truncated.impact()?, 1e-9));
    }
    problems.push(dropped_rod());
    Ok(problems)
}

/// The laws with branches, damping or memory, around the stiffness of the thesis's ball.
fn laws(hertz: &Law) -> Result<Vec<Law>, Failure> {
    use contact_models::{HuntCrossley, Hysteretic, Thornton, Viscous};
    let Law::Hertz(hertz) = hertz else { return Err("the scene's contact is not Hertzian".into()) };
    let k = hertz.stiffness_n_m1_5;
    Ok(vec![
        Viscous::with_restitution(k, 0.95, 1.0)?.into(),
        Hysteretic { stiffness_n_m1_5: k, theta_m: 1.6, beta: 1.4, k_bar: 0.4, epsilon_m: 5e-8 }.validated()?.into(),
        HuntCrossley::new(k, 1.5, 0.2)?.into(),
        Thornton::new(1.1e11, 0.015, 2e9)?.into(),
    ])
}

fn dropped_rod() -> Problem {
    let solve = |tolerance: f64| -> Result<Found, Failure> {
        let mut values = Vec::new();
        let mut total = Counts::default();
        for inclination_deg in [15.0_f64, 45.0, 75.0] {
            let rod = DroppedRod {
                length_m: 0.3,
                diameter_m: 0.0127,
                youngs_modulus_pa: 2e11,
                density_kg_m3: 7800.0,
                poissons_ratio: 0.3,
                inclination_rad: inclination_deg.to_radians(),
                bending_modes: 20,
                axial_modes: 5,
                damping_ratio: 0.005,
            };
            let drop = rod.drop(1.0)?;
            let settings = Settings { tolerance, estimate_uncertainty: false, ..Settings::default() };
            let solution =
                Solver::new(&drop.structure)?.solve(&drop.surface, &drop.law, Some(&drop.start), &settings)?;
            values.push(restitution(&solution)?);
            add(&mut total, &solution.counts);
        }
        Ok(Found { values, costs: named(&total) })
    };
    Problem::against_tighter(
        "modal/dropped rod with remainder modes, three inclinations/1e-9",
        move || Ok(solve(tighter_than(1e-9))?.values),
        move || solve(1e-9),
    )
    .rounding(1e-11)
}

/// Impacts of thesis chapter 2, and the special values of `S`.
pub fn on_infinite_structures() -> Vec<Problem> {
    use infinite::Structure::{Beam, Plate};
    let mut problems = Vec::new();
    // 1.5605 and 1.562 lie just below and just above the critical 1.56051775487; the latter gives about a hundred separations
    let cases = [(Beam, 1.0), (Beam, 1.5605), (Beam, 1.562), (Beam, 15.0), (Beam, 1000.0), (Plate, 1.0)];
    for (structure, s) in cases {
        let solve = move |settings: infinite::Settings| -> Result<Found, Failure> {
            let solution = infinite::solve(structure, s, &settings)?;
            let mut values = vec![solution.sub_impacts.len() as f64];
            for contact in &solution.sub_impacts {
                values.extend([contact.start, -contact.striker_velocity_at_start]);
                values.extend(contact.duration.into_iter().chain(contact.striker_velocity_at_end.map(|end| -end)));
            }
            let costs = vec![("panels", solution.panels as u64), ("panels_tried", solution.panels_tried as u64)];
            Ok(Found { values, costs })
        };
        let once = infinite::Settings { estimate_uncertainty: false, ..Default::default() };
        let tight = infinite::Settings { nodes: 28, tolerance: 1e-13, ..once };
        let name = match structure {
            Beam => "beam",
            Plate => "plate",
        };
        let problem = Problem::against_tighter(
            format!("infinite/{name} S={s}"),
            move || Ok(solve(tight)?.values),
            move || solve(once),
        );
        problems.push(if s < 2.0 { problem.rounding(1e-10) } else { problem.rounding(1e-12) });
    }
    // the values to which three resolutions agree within 1e-13
    problems.push(Problem::against_tighter(
        "infinite/critical S",
        || Ok(vec![critical_s().s]),
        || Ok(Found { values: vec![critical_s().s], costs: Vec::new() }),
    ));
    problems.push(Problem::against_tighter(
        "infinite/turning point 3",
        || Ok(vec![turning_point(3)?.s]),
        || Ok(Found { values: vec![turning_point(3)?.s], costs: Vec::new() }),
    ));
    problems
}
