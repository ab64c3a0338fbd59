//! The scenes of the gallery agree with physics, and the table of the gallery contains their results.

use crate::gallery;

use std::f64::consts::PI;
use std::fmt::Write;

use crate::gallery::{assert_checked_in, gallery, named, restitution};
use vibroimpact::beam_modes;
use vibroimpact::model::Modes;
use vibroimpact::scene::{Beam, BeamTheory, End, Segment, Structure};
use vibroimpact::vibroimpact_sim::infinite;
use vibroimpact::vibroimpact_sim::modal::Outcome;

const ABOUT: &str = "# Gallery of scenes\n\n\
    A test runs each of these scenes, and most have another test of their physics. `vibroimpact simulate NAME.json` gives\n\
    the results of this table in full (`crates/vibroimpact/tests/gallery_physics.rs` writes it, with\n\
    `VIBROIMPACT_BLESS=1`). The description says where the numbers come from.\n\n\
    | scene | structure | contact | outcome | restitution | contacts | description |\n\
    |---|---|---|---|---|---|---|\n";

#[test]
fn the_table_of_the_gallery_is_current() {
    let mut table = ABOUT.to_owned();
    for path in gallery::paths() {
        let file = path.file_name().unwrap().to_string_lossy().into_owned();
        let scene = vibroimpact::Scene::read(&path).unwrap();
        let (outcome, restitution, contacts) = if scene.is_infinite() {
            let impact = scene.infinite_impact().unwrap();
            let groups = impact.groups().unwrap();
            let solution = infinite::solve(impact.structure, groups.s, &infinite::Settings::default()).unwrap();
            let summary = vibroimpact::infinite::Summary::new(&solution, None);
            (summary.outcome, summary.rebound_ratio, summary.contacts.len())
        } else {
            let solution = scene.impact().unwrap().solve().unwrap();
            (solution.outcome.as_str(), solution.restitution, solution.sub_impacts.len())
        };
        let restitution = restitution.map_or_else(|| "none".to_owned(), |e| format!("{e:.4}"));
        writeln!(
            table,
            "| [{file}]({file}) | {} | {} | {outcome} | {restitution} | {contacts} | {} |",
            scene.structure.kind(),
            scene.contact.law_name(),
            scene.description.unwrap()
        )
        .unwrap();
    }
    assert_checked_in("scenes/README.md", &table);
}

/// With Cowper's coefficient an independent computation with 800,000 modes gives 0.25302.
#[test]
fn a_timoshenko_beam_converges_and_follows_its_shear_coefficient() {
    let mut scene = named("timoshenko-beam");
    let answer = scene.answer().unwrap();
    assert!(answer.settled && answer.theory == Some(BeamTheory::Timoshenko), "{answer:?}");
    let with = |modes: usize, scene: &vibroimpact::Scene| {
        restitution(&vibroimpact::Scene {
            modes: Modes::Count(modes),
            residual_compliance: Some(true),
            ..scene.clone()
        })
    };
    let many = with(400, &scene);
    assert!((answer.restitution.unwrap() - many).abs() < 1e-3 && (many - 0.1935).abs() < 1e-4, "{many}");
    assert!(answer.uncertainty.beam_theory.unwrap() > 0.05, "{answer:?}");
    let Structure::Beam(beam) = &mut scene.structure else { panic!() };
    beam.segments[0].shear_coefficient = Some(13.0 / 15.3);
    let cowper = with(400, &scene);
    assert!((cowper - 0.25302).abs() < 1e-4, "{cowper}");
}

#[test]
fn a_plate_by_its_geometry_converges_and_is_infinite_until_waves_return() {
    let scene = named("simply-supported-plate");
    // 500 modes in closed form and the static compliance of the rest.
    let many = vibroimpact::Scene { modes: Modes::Count(500), residual_compliance: Some(true), ..scene.clone() };
    let converged = restitution(&many);
    assert!((converged - 0.0828).abs() < 2e-4, "{converged}");
    let more = vibroimpact::Scene { modes: Modes::Count(1000), ..many };
    assert!((restitution(&more) - converged).abs() < 1e-4);
    // The program finds it for any share of the modes that are excited at the location.
    let answer = scene.answer().unwrap();
    assert!(answer.settled && (answer.restitution.unwrap() - converged).abs() < 1e-3, "{answer:?}");
    // Until waves return from its edges, the plate is Zener's infinite one.
    let mut infinite = named("infinite-plate");
    let Structure::InfinitePlate(ref mut plate) = infinite.structure else { panic!() };
    plate.thickness_m = 0.005;
    let impact = infinite.infinite_impact().unwrap();
    let solution = infinite::solve(impact.structure, impact.groups().unwrap().s, &Default::default()).unwrap();
    assert!((converged - solution.rebound_ratio().unwrap()).abs() < 0.015);
}

#[test]
fn a_plate_clamped_along_one_edge_agrees_with_its_modes() {
    let scene = named("cantilever-plate");
    let Structure::Plate(plate) = &scene.structure else { panic!() };
    let modes = plate.to_plate().unwrap().modes(100).unwrap();
    assert_eq!(modes.converged(1e-3), 100);
    let answer = scene.answer().unwrap();
    assert!(answer.settled && answer.restitution.is_some_and(|e| e > 0.0 && e < 1.0), "{answer:?}");
    // The same plate with its width and length exchanged.
    let mut turned = scene.clone();
    let Structure::Plate(ref mut other) = turned.structure else { panic!() };
    (other.length_m, other.width_m) = (other.width_m, other.length_m);
    let [left, right, low, high] = other.edges;
    other.edges = [low, high, left, right];
    turned.location_m = Some([0.16, 0.25].into());
    assert!((turned.answer().unwrap().restitution.unwrap() - answer.restitution.unwrap()).abs() < 1e-5);
}

/// Chaigne and Askenfelt's C4: the hammer stays for some milliseconds, in which waves return from the near end (after 2 x
/// 0.0744 m at 325 m/s) and press on it several times; the largest force is some 20 N.
#[test]
fn the_hammer_of_c4_is_pressed_by_the_waves_from_the_near_end() {
    let scene = named("piano-hammer");
    let impact = scene.impact().unwrap();
    let (solution, history) = impact.record().unwrap();
    let last = solution.sub_impacts.last().unwrap();
    assert!((1e-3..5e-3).contains(&last.end_s), "{solution:?}");
    let peak = solution.sub_impacts.iter().map(|contact| contact.peak_force_n).fold(0.0, f64::max);
    assert!((5.0..60.0).contains(&peak), "{peak}");
    // Before the first reflection the string is infinite: w' = F/(2 Z), and the hammer m v' = -F on the power law.
    let impedance = 2.0 * (670.0f64 * 3.93e-3 / 0.62).sqrt();
    let (mass, steps, until) = (2.97e-3, 40_000, 3e-4);
    let (mut hammer, mut string, mut speed, mut pressed) = (0.0, 0.0, 2.0, 0.0);
    let force = |gap: f64| 4.5e9 * f64::max(gap, 0.0).powf(2.5);
    for _ in 0..steps {
        let h = until / f64::from(steps);
        // The midpoint rule.
        let f = force(hammer - string);
        let (hm, sm) = (hammer + 0.5 * h * speed, string + 0.5 * h * f / impedance);
        let middle = force(hm - sm);
        let vm = speed - 0.5 * h * f / mass;
        hammer += h * vm;
        string += h * middle / impedance;
        speed -= h * middle / mass;
        pressed = middle;
    }
    let found = history.at(until).force_n;
    assert!((found / pressed - 1.0).abs() < 0.05, "{found} {pressed}");
}

#[test]
fn the_bat_is_the_beam_that_its_table_was_made_from_and_has_a_sweet_spot() {
    let pieces = [(0.2, 0.056), (0.08, 0.05), (0.08, 0.042), (0.08, 0.034), (0.3, 0.025), (0.022, 0.046)];
    let bat = Beam {
        segments: pieces.map(|(length, diameter)| Segment::circular(length, 1.29e10, 640.0, diameter)).into(),
        ..Beam::new([End::Free, End::Free])
    };
    let modes = bat.to_beam().unwrap().modes(8).unwrap();
    let mut scene = named("baseball-bat");
    for (point, x) in [("barrel_end", 0.0), ("50_mm", 0.05), ("100_mm", 0.1), ("150_mm", 0.15), ("190_mm", 0.19)] {
        scene.location = Some(point.to_owned());
        let listed = scene.structure().unwrap().modes;
        let shapes = modes.shapes_at(x).unwrap();
        for k in 2..8 {
            assert!((listed[k].omega_rad_s / modes.omega_rad_s()[k] - 1.0).abs() < 1e-6, "{k}");
            assert!((listed[k].shape.abs() - shapes[k].abs()).abs() < 1e-4, "{point}, {k}");
        }
        // Of the rigid-body motions only the sum of their squares does not depend on the choice of the pair.
        let sum = |of: [f64; 2]| of[0].powi(2) + of[1].powi(2);
        let ratio = sum([listed[0].shape, listed[1].shape]) / sum([shapes[0], shapes[1]]);
        assert!((ratio - 1.0).abs() < 1e-6, "{point}: {ratio}");
    }
    // Nodes of the first two bending modes compared with Russell's measured 165 and 114 mm.
    let node = |k: usize| {
        let at = |i: usize| modes.shapes_at(0.05 + 1e-3 * i as f64).unwrap()[k];
        (0..200).find(|&i| at(i) * at(i + 1) <= 0.0).map(|i| 50 + i).unwrap()
    };
    assert!(node(2).abs_diff(165) <= 7 && node(3).abs_diff(114) <= 7, "{} and {}", node(2), node(3));
    // If it is struck near the nodes, the bat receives the least vibration.
    let vibration = |point: &str| {
        let scene = vibroimpact::Scene { location: Some(point.to_owned()), ..scene.clone() };
        let energy = scene.impact().unwrap().record().unwrap().1.energy_ledger();
        energy.modes_j[2..].iter().sum::<f64>() / energy.initial_j
    };
    let near = vibration("150_mm");
    assert!(near < 0.1 * vibration("barrel_end") && near < vibration("50_mm"));
}

/// The bat given by its geometry, truncated to the modes of the table, has the same rebound as the table.
#[test]
fn the_bat_given_by_its_geometry_is_the_one_in_the_table() {
    let restitution = |scene: &vibroimpact::Scene| scene.impact().unwrap().solve().unwrap().restitution.unwrap();
    let geometry = named("baseball-bat-geometry");
    let modes = vibroimpact::model::Modes::Count(8);
    let cut = vibroimpact::Scene { modes, residual_compliance: Some(false), ..geometry.clone() };
    let listed = restitution(&named("baseball-bat"));
    assert!((restitution(&cut) - listed).abs() < 1e-5, "{} {listed}", restitution(&cut));
    assert!((restitution(&geometry) - listed).abs() < 0.02, "{} {listed}", restitution(&geometry));
}

#[test]
fn a_stepped_shaft_vibrates_between_its_two_thicknesses() {
    let scene = named("stepped-shaft");
    let frequency = |beam: &Beam| beam.to_beam().unwrap().modes(1).unwrap().omega_rad_s()[0] / (2.0 * PI);
    let Structure::Beam(stepped) = &scene.structure else { panic!() };
    let uniform =
        |diameter| Beam { segments: vec![Segment::circular(0.7, 2.1e11, 7850.0, diameter)], ..stepped.clone() };
    let (thin, thick) = (frequency(&uniform(0.03)), frequency(&uniform(0.04)));
    // pi/(2 L^2) sqrt(E d^2/(16 rho)) of a uniform pinned shaft.
    assert!((thin / (PI / (2.0 * 0.49) * (2.1e11f64 * 0.03 * 0.03 / (16.0 * 7850.0)).sqrt()) - 1.0).abs() < 1e-9);
    let found = frequency(stepped);
    assert!(thin < found && found < thick);
    // By transfer matrices, computed separately.
    assert!((found - 142.2618380941748).abs() < 1e-6);
    // It is struck in its plane of symmetry, where antisymmetric modes have nodes.
    let modes = scene.structure().unwrap().modes;
    assert!(modes.iter().skip(1).step_by(2).take(10).all(|mode| mode.shape.abs() < 1e-6));
}

#[test]
fn a_rod_dropped_upright_responds_along_its_length_only() {
    let mut scene = named("dropped-rod");
    let Structure::DroppedRod(tilted) = scene.structure.clone() else { panic!() };
    // Thesis Eq. 8.9: the effective mass of the rigid-body motions at the contact point is m / (1 + 3 cos^2).
    let mass = 7876.74 * PI / 4.0 * 0.0127f64.powi(2) * 0.2;
    let rigid = |scene: &vibroimpact::Scene| -> f64 {
        let modes = scene.structure().unwrap().modes;
        modes.iter().filter(|mode| mode.omega_rad_s == 0.0).map(|mode| mode.shape.powi(2)).sum()
    };
    assert!((rigid(&scene) * mass / 2.5 - 1.0).abs() < 1e-12);
    let slanted = restitution(&scene);
    scene.structure = Structure::DroppedRod(vibroimpact::scene::DroppedRod { inclination_deg: 90.0, ..tilted });
    assert!((rigid(&scene) * mass - 1.0).abs() < 1e-12);
    let upright = restitution(&scene);
    // An upright rod receives energy in its axial modes only.
    assert!(upright > 0.9 && slanted < 0.9 * upright, "{slanted} {upright}");
    // The fall alone supplies energy: m v^2 / 2.
    let ledger = scene.impact().unwrap().record().unwrap().1.energy_ledger();
    assert!((ledger.initial_j / (0.5 * mass) - 1.0).abs() < 1e-12);
}

#[test]
fn the_sdnl32_benchmark_is_reproduced_by_its_scene() {
    let scene = named("sdnl32");
    let impact = scene.impact().unwrap();
    assert!(impact.striker.mass_kg.is_infinite() && impact.kept_modes() == 10);
    let (_, history) = impact.record().unwrap();
    let table = include_str!("../../vibroimpact-sim/tests/data/sdnl32_pinned_beam_elastic_stop_k18000.csv");
    let rows =
        table.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect::<Vec<f64>>());
    // The value at 3 ms is a misprint of the reference.
    for row in rows.filter(|row| row[1] != 3.0) {
        let tip_mm = -1e3 * history.at(1e-3 * row[1]).structure_displacement_m;
        assert!((tip_mm - row[2]).abs() < 0.03, "{} ms: {tip_mm} against {}", row[1], row[2]);
    }
    // m L^3/3 (3.8/s)^2/2 of the rotation.
    let inertia = 2400.0 * 0.014 * 0.014 * 0.783f64.powi(3) / 3.0;
    assert!((history.energy_ledger().initial_j / (0.5 * inertia * 3.8 * 3.8) - 1.0).abs() < 1e-9);
}

#[test]
fn a_beam_that_moves_towards_the_ball_meets_it_sooner_and_returns_it_faster() {
    let moving = named("moving-beam");
    let mut calm = moving.clone();
    calm.start.as_mut().unwrap().moving_modes.clear();
    let solve = |scene: &vibroimpact::Scene| scene.impact().unwrap().record().unwrap();
    let ((with, history), (without, _)) = (solve(&moving), solve(&calm));
    // A ball at rest would need 0.1 mm at 1 m/s; the vibrating beam approaches at 0.5 sin(0.618 pi) m/s.
    assert!((without.sub_impacts[0].start_s - 1e-4).abs() < 1e-15);
    let closing = 1.0 + 0.5 * (0.6180339887498949 * PI).sin();
    assert!((with.sub_impacts[0].start_s * closing / 1e-4 - 1.0).abs() < 1e-3);
    assert!(with.restitution.unwrap() > without.restitution.unwrap());
    // Half of the beam's mass moves with the mid-span of a half sine: ball and beam have this energy.
    let beam_kg = 7800.0 * 0.011323f64.powi(2);
    let ball_kg = moving.striker.mass_kg().unwrap();
    let brought = 0.5 * ball_kg + 0.5 * 0.5 * beam_kg * 0.25;
    assert!((history.energy_ledger().initial_j / brought - 1.0).abs() < 1e-9);
}

#[test]
fn the_other_scenes_agree_with_theory() {
    let solution = |name: &str| named(name).impact().unwrap().solve().unwrap();
    // A structure takes energy from a ball that a wall would return with its whole speed, or with 0.8 of it.
    for (name, wall) in
        [("cantilever-tip", 1.0), ("elastoplastic", 1.0), ("rubber-ball", 0.8), ("viscous", 1.0), ("hysteretic", 1.0)]
    {
        assert_eq!(solution(name).outcome, Outcome::Rebound, "{name}");
        assert!(restitution(&named(name)) < wall, "{name}");
    }
    // A soft, light ball hardly excites the bar: two bodies of 57 g and rho A L, at the restitution of the law at a wall.
    let bar_kg = 7800.0 * PI / 4.0 * 0.0127f64.powi(2) * 0.6;
    let modes = named("rubber-ball").structure().unwrap().modes;
    let translation: f64 = modes.iter().filter(|mode| mode.omega_rad_s == 0.0).map(|mode| mode.shape.powi(2)).sum();
    assert!((translation * bar_kg - 1.0).abs() < 1e-9);
    // The listed modes of the cantilever are those of a beam with the fundamental at 58.2 rad/s.
    let listed = named("measured-modes").structure().unwrap().modes;
    for (mode, root) in listed.iter().zip([1.875104, 4.694091, 7.854757, 10.995541]) {
        assert!((mode.omega_rad_s / listed[0].omega_rad_s - (root / 1.875104f64).powi(2)).abs() < 2e-4 * root * root);
    }
    assert!(gallery().len() >= 20);
    // A beam of the crate `beam-modes` is available without a further dependency.
    let _: beam_modes::End = beam_modes::End::Free;
}
