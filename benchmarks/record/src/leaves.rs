//! Problems of the crates without dependencies in the workspace: modes, contact laws, net restitution, fits and fractional
//! equations. Reading a scene is measured here too.

use crate::problem::{Found, Problem};
use beam_modes::{Beam, End, Segment};
use std::f64::consts::PI;
use std::path::Path;
use tasks::Failure;
use vibroimpact::Scene;
use vibroimpact::model::Modes;
use vibroimpact_sim::modal::Settings;

fn uncounted(values: Vec<f64>) -> Found {
    Found { values, costs: Vec::new() }
}

/// Frequencies of uniform beams (closed form) and of a stepped one (multiple precision, `beam-modes/tests/data`).
pub fn modes(root: &Path) -> Result<Vec<Problem>, Failure> {
    let segment = |length_m, flexural_rigidity_n_m2, mass_per_length_kg_m| Segment {
        length_m,
        flexural_rigidity_n_m2,
        mass_per_length_kg_m,
    };
    let mut problems = Vec::new();
    for count in [40, 200] {
        let beam = Beam { segments: vec![segment(1.0, 273.0, 1.0)], ends: [End::Pinned, End::Pinned] };
        let exact = (1..=count).map(|k| (f64::from(k) * PI).powi(2) * 273f64.sqrt()).collect();
        problems.push(Problem::exact(format!("modes/uniform N={count}"), exact, move || {
            Ok(uncounted(beam.modes(count as usize)?.omega_rad_s().to_vec()))
        }));
    }
    let path = root.join("crates/beam-modes/tests/data/stepped_beam_reference.csv");
    let mut exact: Vec<f64> = Vec::new();
    for row in csv::Reader::from_path(path)?.deserialize() {
        let (case, _, omega): (String, usize, f64) = row?;
        if case == "halves" {
            exact.push(omega);
        }
    }
    for count in [40, 500] {
        let beam =
            Beam { segments: vec![segment(0.5, 1.0, 1.0), segment(0.5, 0.2, 0.5)], ends: [End::Clamped, End::Free] };
        let exact = exact.get(..count).ok_or("too few reference frequencies")?.to_vec();
        problems.push(Problem::exact(format!("modes/stepped N={count}"), exact, move || {
            Ok(uncounted(beam.modes(count)?.omega_rad_s().to_vec()))
        }));
    }
    Ok(problems)
}

/// Restitutions of a rigid ball at a wall, of laws for which they are known.
pub fn laws() -> Result<Vec<Problem>, Failure> {
    use contact_models::{HuntCrossley, Hysteretic, KelvinVoigt, Law, Viscous};
    let (k, mass_kg) = (1.7945e10, 0.11027);
    let laws: [Law; 4] = [
        Viscous::with_restitution(k, 0.95, 1.0)?.into(),
        HuntCrossley::with_restitution(k, 1.5, 0.8, 1.0)?.into(),
        KelvinVoigt::with_restitution(1e8, 0.7, mass_kg)?.into(),
        Hysteretic { stiffness_n_m1_5: k, theta_m: 1.6, beta: 1.4, k_bar: 4.0, epsilon_m: 1e-20 }.validated()?.into(),
    ];
    // the last: loading and unloading in closed form, without regularisation
    let exact = vec![0.95, 0.8, 0.7, ((1.2 / 2.5 + 2.8 / 6.5) / 1.6f64).sqrt()];
    Ok(vec![Problem::exact("laws/restitution at a wall", exact, move || {
        let restitutions: Result<Vec<f64>, _> = laws.iter().map(|law| law.wall_restitution(mass_kg, 1.0)).collect();
        Ok(uncounted(restitutions?))
    })])
}

/// The closed form of the net restitution, and the quadratic programs that it replaces.
pub fn net_restitution() -> Vec<Problem> {
    use emoc::{Coefficients, Contact, Friction, Mode, SingleImpact, Solver};
    let coefficients = Coefficients { ebar: 0.9, beta0: 0.3, beta1: 0.1 };

    // the residuals of the active conditions: x + y = ebar and, on the second branch, x - beta0 y = beta1 ebar
    let mut problems = vec![Problem::exact("emoc/closed form, 1,000 ratios", vec![0.0], move || {
        let mut worst = 0f64;
        for i in 0..1000 {
            let rebound = coefficients.rebound(1e-3 * 1.02f64.powi(i))?;
            let (x, y) = (rebound.restitution, rebound.recoil);
            worst = worst.max((x + y - 0.9).abs());
            if rebound.branch == emoc::Branch::Outward {
                worst = worst.max((x - 0.3 * y - 0.09).abs());
            }
        }
        Ok(uncounted(vec![worst]))
    })];
    for n in [5, 50] {
        let phi: Vec<f64> = (1..=n).map(|k| 1.4 * (0.4 * f64::from(k)).sin()).collect();
        let z = 0.2 * phi.iter().map(|phi| phi * phi).sum::<f64>();
        let exact = coefficients.rebound(z).map_or(f64::NAN, |rebound| rebound.restitution);
        let problem = Problem::exact(format!("emoc/program of 2N+1 unknowns, N={n}"), vec![exact], move || {
            let impact = SingleImpact { mass_kg: 0.2, phi: &phi, coefficients };
            Ok(uncounted(vec![impact.solve_full()?.restitution]))
        });
        problems.push(problem.rounding(1e-10));

        let contact = Contact { friction: Friction::Planar { coefficient: 0.3 }, coefficients };
        let mut inverse_inertia_per_kg = vec![0.0; 16];
        (0..4).for_each(|i| inverse_inertia_per_kg[5 * i] = 5.0);
        let mode = |k: f64| Mode {
            rate: 0.02 * (1.7 * k).cos(),
            shape: vec![1.4 * (0.4 * k).sin(), 0.0, 1.4 * (1.1 * k).sin(), 0.0],
        };
        let contacts = emoc::Problem {
            contacts: vec![contact; 2],
            inverse_inertia_per_kg,
            velocity_m_s: vec![-1.0, 0.4, -0.7, -0.2],
            modes: (1..=n).map(|k| mode(f64::from(k))).collect(),
        };
        let solve = move || -> Result<Vec<f64>, Failure> {
            let solution = Solver::new().solve(&contacts)?;
            Ok(solution.velocity_m_s.iter().copied().chain([solution.energy_change_j]).collect())
        };
        let again = solve.clone();
        let name = format!("emoc/two contacts with friction, N={n}");
        problems.push(Problem::against_tighter(name, solve, move || Ok(uncounted(again()?))).rounding(1e-9));
    }
    problems
}

/// An exponential with noise-free data, and the impact law with kinks: the true parameters are known.
pub fn fits() -> Vec<Problem> {
    use fitting::{Method, Parameter, Settings, fit};
    let run = |parameters: Vec<Parameter>, count: usize, residuals: &fitting::ResidualsFn, method: Method| {
        let problem = fitting::Problem { parameters, count, residuals, jacobian: None };
        let found = fit(&problem, &Settings { method, ..Settings::default() })?;
        let costs = vec![("evaluations", found.evaluations as u64), ("jacobians", found.jacobians as u64)];
        Ok::<Found, Failure>(Found { values: found.parameters, costs })
    };
    let decay = move || {
        let truth = |t: f64| 2.0 * (-0.7 * t).exp() + 0.3;
        let parameters = ["a", "k", "c"].map(|name| Parameter::positive(name, 1.0, (0.01, 10.0))).to_vec();
        let residuals = |p: &[f64], r: &mut [f64]| {
            for (i, r) in r.iter_mut().enumerate() {
                let t = 0.1 * i as f64;
                *r = p[0] * (-p[1] * t).exp() + p[2] - truth(t);
            }
        };
        run(parameters, 60, &residuals, Method::LevenbergMarquardt)
    };
    let law = move |mu0: f64, alpha0: f64, alpha1: f64, i: usize| {
        let z = 0.01 * 1.3f64.powi(i as i32);
        let law = emoc::Parameters { mu0, alpha0, alpha1, notional_restitution: 1.0 };
        let impact = emoc::Impact { mass_kg: 0.2, z, s0: z / 50.0, s1: z / 5.0 };
        law.rebound(&impact).map_or(f64::NAN, |rebound| rebound.restitution)
    };
    let kinked = move || {
        let parameters = ["mu0", "alpha0", "alpha1"].map(|name| Parameter::positive(name, 1.0, (0.01, 100.0))).to_vec();
        let residuals = |p: &[f64], r: &mut [f64]| {
            for (i, r) in r.iter_mut().enumerate() {
                *r = law(p[0], p[1], p[2], i) - law(0.7, 3.0, 0.2, i);
            }
        };
        run(parameters, 40, &residuals, Method::Both)
    };
    // the search ends when the residuals have fallen to 1e-10 of the first ones, which limits the parameters
    vec![
        Problem::exact("fitting/decay, Levenberg-Marquardt", vec![2.0, 0.7, 0.3], decay).rounding(1e-9),
        Problem::exact("fitting/impact law with kinks, both methods", vec![0.7, 3.0, 0.2], kinked).rounding(1e-6),
    ]
}

/// Every method on the linear analogue of the infinite beam, and collocation where the past is long.
pub fn fractional() -> Vec<Problem> {
    use fracdiff::{Collocation, Method, test_problems};
    let on = |test: fracdiff::test_problems::TestProblem, method: Method, end: f64| {
        let name = format!("fracdiff/{}/{}", test.name, method.name());
        let exact = test.reference.iter().filter(|(t, _)| *t == end).map(|r| r.1).collect();
        Problem::exact(name, exact, move || {
            let solution = test.volterra.solve(&method, end)?;
            let counts = solution.counts;
            let costs = vec![
                ("evaluations", counts.evaluations),
                ("newton_iterations", counts.newton_iterations),
                ("steps", counts.steps),
                ("rejected_steps", counts.rejected),
                ("history_values", counts.history_values),
            ];
            Ok(Found { values: solution.at(end)?, costs })
        })
    };
    let mut problems: Vec<Problem> = test_problems::every_method(500)
        .into_iter()
        .map(|method| on(test_problems::linear_beam(), method, 2.0))
        .collect();
    let collocation = || Method::Collocation(Collocation::default());
    problems.push(on(test_problems::relaxation(), collocation(), 100.0));
    problems.push(on(test_problems::bagley_torvik(), collocation(), 20.0));
    problems.push(on(test_problems::rigid_contact(), collocation(), 5.0));
    problems
}

/// Reads the text of a scene and computes the modes at the point of impact; and all that `simulate --json` does.
pub fn scenes(root: &Path) -> Result<Vec<Problem>, Failure> {
    let text = std::fs::read_to_string(root.join("datasets/scenes/pinned-beam-converged.json"))?;
    let (side, b): (f64, f64) = (0.011323, 0.618_033_988_749_894_9);
    let (mass, rigidity) = (7800.0 * side * side, 2e11 * side.powi(4) / 12.0);
    let q = 100.0 * PI;
    let exact = vec![100.0, q * q * (rigidity / mass).sqrt(), (2.0 / mass).sqrt() * (q * b).sin()];
    let problem = Problem::exact("scenes/read, N=100", exact, move || {
        let impact = Scene::from_json(&text)?.impact()?;
        let modes = &impact.structure.modes[..impact.kept_modes()];
        let last = modes.last().ok_or("no modes")?;
        Ok(uncounted(vec![modes.len() as f64, last.omega_rad_s, last.shape]))
    });
    let mut problems = vec![problem.rounding(1e-12)];
    let cases = [
        ("pinned-beam", None),
        ("pinned-beam-converged", None),
        ("stepped-cantilever", None),
        ("pinned-beam", Some(1000)),
    ];
    for (name, modes) in cases {
        let text = std::fs::read_to_string(root.join(format!("datasets/scenes/{name}.json")))?;
        let posed = move || -> Result<Scene, Failure> {
            let scene = Scene::from_json(&text)?;
            Ok(Scene { modes: modes.map_or(scene.modes, Modes::Count), ..scene })
        };
        let tighter = posed.clone();
        let modes = modes.map_or_else(String::new, |modes| format!(", N={modes}"));
        problems.push(Problem::against_tighter(
            format!("scenes/simulate, {name}{modes}"),
            move || {
                let scene = tighter()?;
                let tolerance = scene.tolerance.unwrap_or(Settings::default().tolerance);
                simulated(&Scene { tolerance: Some(0.01 * tolerance), ..scene })
            },
            move || simulated(&posed()?).map(uncounted),
        ));
    }
    Ok(problems)
}

/// The restitution in the printed result.
fn simulated(scene: &Scene) -> Result<Vec<f64>, Failure> {
    let printed: serde_json::Value = serde_json::from_str(&scene.simulate()?.json(scene)?)?;
    Ok(vec![printed["restitution"].as_f64().ok_or("no restitution")?])
}
