//! The number of trustworthy digits that a solution states must cover its true error.

use crate::common;

use crate::common::random::{
    EdgeImpact, cases, decades, edge_impact, ordinary_damping, ordinary_impact, ordinary_striker,
};
use crate::common::{hertz, pinned, pinned_with_remainder, runge_kutta, seen_from, settings};
use beam_modes::{Beam, End, Segment};
use contact_models::{Law, LinearSpring, Viscous};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
use std::f64::consts::FRAC_PI_2;
use std::f64::consts::PI;
use vibroimpact_sim::dropped_rod::DroppedRod;
use vibroimpact_sim::infinite;
use vibroimpact_sim::modal::{Outcome, Settings, Solver, Striker, SubImpact};

/// The same row of random values on every machine; `VIBROIMPACT_SEED` (0 to 255) draws another one.
fn draw<T>(strategy: impl Strategy<Value = T>, count: u32) -> Vec<T> {
    let seed = std::env::var("VIBROIMPACT_SEED").ok().and_then(|text| text.parse().ok()).unwrap_or(19);
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[seed; 32]);
    let mut runner = TestRunner::new_with_rng(ProptestConfig::default(), rng);
    (0..cases(count)).map(|_| strategy.new_tree(&mut runner).unwrap().current()).collect()
}

/// How well stated uncertainties cover errors.
#[derive(Default, Debug)]
struct Coverage {
    /// Error over stated uncertainty, of each case.
    ratios: Vec<f64>,
    /// Stated uncertainty over error, where an error below a thousandth of the tolerance counts as so much.
    widths: Vec<f64>,
    /// What the largest belongs to.
    worst: (f64, String),
    /// Steps of all solutions, with those of their uncertainties.
    steps: u64,
}

impl Coverage {
    fn note(&mut self, error: f64, stated: f64, what: impl FnOnce() -> String) {
        self.ratios.push(error / stated);
        if error / stated > self.worst.0 {
            self.worst = (error / stated, format!("error {error:e}, stated {stated:e}: {}", what()));
        }
    }

    /// Prints the figures (`--nocapture` shows them).
    fn print(&mut self, name: &str) {
        self.ratios.sort_by(f64::total_cmp);
        let count = self.ratios.len();
        let (outside, median) = (self.outside(), self.ratios[count / 2].recip());
        let (steps, worst) = (self.steps as f64 / count as f64, &self.worst);
        println!(
            "{name}: {count} cases, {outside} not covered, stated over true {median:.0} in the median, {steps:.1} steps, worst {worst:?}"
        );
    }

    fn outside(&self) -> usize {
        self.ratios.iter().filter(|ratio| **ratio > 1.0).count()
    }

    /// As many cases as `at_least`, of which 99.9 % (all but one, where they are fewer than 2,000) are covered, and none is
    /// more than three times as far off as stated.
    fn assert(&self, name: &str, at_least: usize) {
        let (count, outside, worst) = (self.ratios.len(), self.outside(), &self.worst);
        assert!(count >= at_least, "{name}: {count}");
        assert!(outside <= (count / 1_000).max(1), "{name}: {outside} of {count}, worst {worst:?}");
        assert!(worst.0 <= 3.0, "{name}: {worst:?}");
    }

    /// Half of the stated uncertainties are less than so many times the error.
    fn assert_not_wider(&mut self, name: &str, times: f64) {
        self.widths.sort_by(f64::total_cmp);
        let median = self.widths[self.widths.len() / 2];
        assert!(median < times, "{name}: {median}");
    }
}

/// True errors of the restitution and of the largest forces from a solution at 1e-13, whose own uncertainty is taken off. Where rounding does not let the steps
/// become that exact, it ends with its limit, and one at 1e-12 or 1e-11 takes its place.
fn modal_restitution(name: &str, impacts: &[EdgeImpact], median: f64) {
    let tolerances = [1e-9, 1e-7, 1e-5, 1e-3];
    let mut coverages = tolerances.map(|_| Coverage::default());
    let mut forces = tolerances.map(|_| Coverage::default());
    let (mut known, mut contacts, mut unknown_forces) = (0, 0, 0);
    for impact in impacts {
        let solver = Solver::new(&impact.structure).unwrap();
        let solve = |tolerance: f64| {
            let settings = Settings { max_steps: 40_000, ..settings(tolerance) };
            solver.solve(&impact.striker, &impact.law, impact.start.as_ref(), &settings).unwrap()
        };
        let tight = |tolerance: f64| {
            let solution = solve(tolerance);
            let known = solution.restitution.zip(solution.restitution_uncertainty).filter(|(_, rest)| *rest < 1e-3);
            known.map(|known| (known, solution.sub_impacts))
        };
        // some are so chaotic that no double-precision solution is known to 1e-3
        let Some(((reference, rest), exact)) = [1e-13, 1e-12, 1e-11].into_iter().find_map(tight) else { continue };
        known += 1;
        for ((tolerance, coverage), forces) in tolerances.into_iter().zip(&mut coverages).zip(&mut forces) {
            let solution = solve(tolerance);
            // at loose tolerances an impact that amplifies errors, or a coarser solution of it, may be given up
            let Some((restitution, stated)) = solution.restitution.zip(solution.restitution_uncertainty) else {
                assert!(tolerance > 1e-6, "{name}: {:?} {impact:?}", solution.outcome);
                continue;
            };
            let beyond = ((restitution - reference).abs() - rest).max(0.0);
            coverage.note(beyond, stated, || format!("{tolerance:e} {impact:?}"));
            coverage.widths.push(stated / beyond.max(1e-3 * tolerance));
            coverage.steps += solution.counts.steps();
            let found = &solution.sub_impacts;
            contacts += found.len();
            for (i, contact) in found.iter().enumerate() {
                let Some(stated) = contact.peak_force_uncertainty_n else {
                    unknown_forces += 1;
                    continue;
                };
                let exact = SubImpact::counterpart(i, found, &exact);
                let exact = exact.and_then(|exact| Some((exact.peak_force_n, exact.peak_force_uncertainty_n?)));
                if let Some((exact, rest)) = exact {
                    let beyond = ((contact.peak_force_n - exact).abs() - rest).max(0.0);
                    forces.note(beyond, stated, || format!("contact {i} at {tolerance:e} {impact:?}"));
                }
            }
        }
    }
    assert!(100 * known >= 95 * impacts.len(), "{name}: {known} of {}", impacts.len());
    println!("{name}: the largest force is not known for {unknown_forces} of {contacts} contacts");
    assert!(5 * unknown_forces < contacts, "{name}: {unknown_forces} of {contacts}");
    for (tolerance, coverage) in tolerances.into_iter().zip(&mut forces) {
        let name = format!("largest forces, {name} at {tolerance:e}");
        coverage.print(&name);
    }
    for (tolerance, coverage) in tolerances.into_iter().zip(&forces) {
        coverage.assert(&format!("largest forces, {name} at {tolerance:e}"), known);
    }
    let names = tolerances.map(|tolerance| format!("{name} at {tolerance:e}"));
    names.iter().zip(&mut coverages).for_each(|(name, coverage)| coverage.print(name));
    for (name, coverage) in names.iter().zip(&mut coverages) {
        coverage.assert(name, 95 * known / 100);
        coverage.assert_not_wider(name, median);
    }
}

#[test]
fn ordinary_impacts() {
    let as_edge = |impact: common::random::Impact| {
        let common::random::Impact { structure, striker, law } = impact;
        EdgeImpact { structure, striker, law, start: None }
    };
    let impacts: Vec<EdgeImpact> = draw(ordinary_impact(), 150).into_iter().map(as_edge).collect();
    modal_restitution("ordinary", &impacts, 40.0);
}

#[test]
fn impacts_from_the_edges() {
    modal_restitution("edges", &draw(edge_impact(), 100), 40.0);
}

/// A ball on a beam whose coarser solutions differ from it by 14 % of its error at most, by accident.
#[test]
fn solutions_that_agree_do_not_make_an_answer_certain() {
    let structure = pinned_with_remainder(4, 0.0018795497934074362, 0.150195659069041);
    let striker = Striker { mass_kg: 0.23157432202639694, speed_m_s: 0.12129654511513636 };
    let solver = Solver::new(&structure).unwrap();
    let [truth, found] =
        [1e-13, 1e-9].map(|tolerance| solver.solve(&striker, &hertz(), None, &settings(tolerance)).unwrap());
    let error = (found.restitution.unwrap() - truth.restitution.unwrap()).abs();
    let stated = found.restitution_uncertainty.unwrap();
    assert!(error > 1e-12 && truth.restitution_uncertainty.unwrap() < 0.1 * error, "{error:e} {truth:?}");
    assert!(error <= stated && stated < 100.0 * error, "{error:e}, stated {stated:e}");
}

/// Two impacts that amplify errors, by the double-double Taylor series of their equations.
#[test]
fn impacts_known_to_more_digits() {
    let rod = |length_m: f64, youngs_pa: f64, density: f64, diameter: f64| Segment {
        length_m,
        flexural_rigidity_n_m2: youngs_pa * PI * diameter.powi(4) / 64.0,
        mass_per_length_kg_m: density * PI * diameter * diameter / 4.0,
    };
    let bar = |length_m: f64, width_m: f64, thickness_m: f64| Segment {
        length_m,
        flexural_rigidity_n_m2: 23959912665.092495 * width_m * thickness_m.powi(3) / 12.0,
        mass_per_length_kg_m: 7248.269666050314 * width_m * thickness_m,
    };
    let slender = Segment {
        length_m: 0.615512734587341,
        flexural_rigidity_n_m2: 9.639547845394423,
        mass_per_length_kg_m: 0.5649960047061051,
    };
    let first = rod(1.615266677775907, 21098263812.64986, 2466.335715254258, 0.008966475144786988);
    let beam = Beam { segments: vec![first, slender], ends: [End::Guided, End::Free] };
    let structure = seen_from(&beam, 0.25580000008103826, 9, 0.002169422726249561);
    let striker = Striker { mass_kg: 1.7654680053554914, speed_m_s: 0.03552190450390591 };
    let law = Law::from(Viscous::new(74097728.79988147, 11.439798636375956).unwrap());
    let viscous = EdgeImpact { structure, striker, law, start: None };
    let bars = vec![
        bar(0.0457049863631492, 0.0027715213558317867, 0.0012347549129352487),
        bar(0.07046769870001454, 0.0023835893178334733, 0.0023086463456862467),
        bar(0.2398378233870333, 0.0033135814128138325, 0.0021573661618968947),
    ];
    let beam = Beam { segments: bars, ends: [End::Guided, End::Guided] };
    let structure = seen_from(&beam, 0.0457049863631492, 82, 0.0);
    let striker = Striker { mass_kg: 0.013485596220419543, speed_m_s: 0.05739689771346372 };
    let law = Law::from(LinearSpring::new(971539.819720483).unwrap());
    let linear = EdgeImpact { structure, striker, law, start: None };
    // inputs off by 1e-15 move the first by 2.3e-7, the second by 2.8e-9
    for (impact, truth, moved) in [(viscous, 0.687107055, 2.3e-7), (linear, 0.63202333145, 2.8e-9)] {
        for tolerance in [1e-9, 1e-8, 1e-7, 1e-6, 1e-5] {
            let solution = impact.solve(&settings(tolerance));
            let stated = solution.restitution_uncertainty.unwrap() + 10.0 * moved;
            let error = (solution.restitution.unwrap() - truth).abs();
            assert!(error <= stated, "{tolerance:e}: {error:e}, stated {stated:e}");
        }
    }
}

/// True errors from another method: the whole system by Dormand and Prince's pair.
#[test]
fn the_modal_restitution_against_runge_kutta() {
    let mut coverage = Coverage::default();
    for (n, damping, b, striker) in draw((1usize..9, ordinary_damping(), 0.05..0.95f64, ordinary_striker()), 24) {
        let structure = pinned(n, damping, b);
        let solution = Solver::new(&structure).unwrap().solve(&striker, &hertz(), None, &settings(1e-7)).unwrap();
        let end = solution.end_s * 1.001;
        let [fine, coarse] =
            [1e-11, 1e-10].map(|tolerance| runge_kutta(&structure, &striker, &hertz(), end, tolerance));
        let error = (solution.striker_velocity_m_s - fine).abs() / striker.speed_m_s;
        let beyond = (error - 3.0 * (fine - coarse).abs() / striker.speed_m_s).max(0.0);
        let what = || format!("{n} {damping} {b} {striker:?}");
        coverage.note(beyond, solution.restitution_uncertainty.unwrap(), what);
    }
    coverage.print("Runge-Kutta");
    coverage.assert("Runge-Kutta", 24);
}

/// Impacts that begin in motion: tilted rods dropped on a surface that does not move.
#[test]
fn the_dropped_rod() {
    let angle = prop_oneof![1 => Just(0.0), 1 => Just(FRAC_PI_2), 4 => 0.0..FRAC_PI_2];
    let strategy = (
        decades(-1.0, 0.0),
        decades(-2.0, -1.0),
        angle,
        0usize..30,
        0usize..30,
        ordinary_damping(),
        decades(-2.0, 1.0),
    );
    let mut coverage = Coverage::default();
    for (length_m, slenderness, inclination_rad, bending_modes, axial_modes, damping_ratio, speed_m_s) in
        draw(strategy, 80)
    {
        let rod = DroppedRod {
            length_m,
            diameter_m: length_m * slenderness,
            youngs_modulus_pa: 2.1e11,
            density_kg_m3: 7876.74,
            poissons_ratio: 0.3,
            inclination_rad,
            bending_modes,
            axial_modes,
            damping_ratio,
        };
        let drop = rod.drop(speed_m_s).unwrap();
        let (law, solver) = (Law::from(drop.law), Solver::new(&drop.structure).unwrap());
        let mut at = |tolerance: f64| {
            let settings = Settings { max_steps: 20_000, ..settings(tolerance) };
            solver.solve(&drop.surface, &law, Some(&drop.start), &settings).unwrap()
        };
        let reference = [1e-13, 1e-12, 1e-11].into_iter().map(&mut at).find(|found| found.outcome == Outcome::Rebound);
        let reference = reference.unwrap();
        let rest = reference.restitution_uncertainty.unwrap();
        for tolerance in [1e-8, 1e-6] {
            let solution = at(tolerance);
            assert_eq!(solution.outcome, Outcome::Rebound, "{rod:?}");
            let error = (solution.restitution.unwrap() - reference.restitution.unwrap()).abs();
            let stated = solution.restitution_uncertainty.unwrap();
            coverage.note((error - rest).max(0.0), stated, || format!("{tolerance:e} {speed_m_s} m/s {rod:?}"));
        }
    }
    coverage.print("dropped rod");
    coverage.assert("dropped rod", 160);
}

/// On the infinite beam and plate: true errors of contact times, durations and speeds from the tightest settings.
#[test]
fn the_infinite_structures() {
    let settings = |nodes, tolerance| infinite::Settings { nodes, tolerance, ..infinite::Settings::default() };
    let mut coverage = Coverage::default();
    let cases = draw((any::<bool>(), -9.0..7.0f64, 8usize..24, -11.0..-4.0f64), 80);
    for (plate, power, nodes, tolerance) in cases {
        let structure = if plate { infinite::Structure::Plate } else { infinite::Structure::Beam };
        let s = 10f64.powf(power);
        let reference = infinite::solve(structure, s, &settings(32, 1e-14)).unwrap();
        let solution = infinite::solve(structure, s, &settings(nodes, 10f64.powf(tolerance))).unwrap();
        assert_eq!(solution.separations(), reference.separations(), "S = {s}");
        let relative = |a: f64, b: f64| if a == b { 0.0 } else { (a / b - 1.0).abs() };
        let error = solution.sub_impacts.iter().zip(&reference.sub_impacts).fold(0.0_f64, |error, (a, b)| {
            let duration = a.duration.zip(b.duration).map_or(0.0, |(a, b)| relative(a, b));
            let speed = a.striker_velocity_at_end.zip(b.striker_velocity_at_end);
            let speed = speed.map_or(0.0, |(x, y)| (x - y).abs() / y.abs().max(2.0 * a.closing_speed));
            error.max(relative(a.start, b.start)).max(duration).max(speed)
        });
        // rounding: no more digits are stated than 15, and the reference has no more than about 13
        let stated = solution.relative_uncertainty.unwrap().max(1e-15);
        let beyond = (error - reference.relative_uncertainty.unwrap().max(1e-13)).max(0.0);
        coverage.note(beyond, stated, || format!("{structure:?} S = {s}, {nodes} nodes, 10^{tolerance}"));
    }
    coverage.print("infinite");
    coverage.assert("infinite", 80);
}
