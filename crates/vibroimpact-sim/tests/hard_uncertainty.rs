//! The number of trustworthy digits that a solution states must cover its true error.

mod common;

use common::random::{Impact, cases, decades, ordinary_damping, ordinary_impact, ordinary_striker};
use common::{hertz, pinned, runge_kutta, settings};
use contact_models::Law;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
use std::f64::consts::FRAC_PI_2;
use vibroimpact_sim::dropped_rod::DroppedRod;
use vibroimpact_sim::infinite;
use vibroimpact_sim::modal::{Outcome, Settings, Solver};

/// The same row of random values on every machine.
fn draw<T>(strategy: impl Strategy<Value = T>, count: u32) -> Vec<T> {
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[19; 32]);
    let mut runner = TestRunner::new_with_rng(ProptestConfig::default(), rng);
    (0..cases(count)).map(|_| strategy.new_tree(&mut runner).unwrap().current()).collect()
}

/// How well stated uncertainties cover errors.
#[derive(Default, Debug)]
struct Coverage {
    cases: usize,
    covered: usize,
    /// Largest error over stated uncertainty, and what it belongs to.
    worst: (f64, String),
}

impl Coverage {
    fn note(&mut self, error: f64, stated: f64, what: impl FnOnce() -> String) {
        self.cases += 1;
        self.covered += usize::from(error <= stated);
        if error / stated > self.worst.0 {
            self.worst = (error / stated, format!("error {error:e}, stated {stated:e}: {}", what()));
        }
    }

    fn assert(&self, at_least: usize) {
        assert!(self.cases >= at_least, "{self:?}");
        assert!(100 * self.covered >= 99 * self.cases, "{self:?}");
        assert!(self.worst.0 <= 10.0, "{self:?}");
    }
}

/// True errors from a solution at 1e-13, whose own uncertainty is taken off. Where rounding does not let the steps
/// become that exact, it ends with its limit, and one at 1e-12 or 1e-11 takes its place.
#[test]
fn the_modal_restitution() {
    let impacts = draw(ordinary_impact(), 150);
    let tight = |impact: &Impact, tolerance: f64| {
        let settings = Settings { max_steps: 20_000, ..settings(tolerance) };
        let mut solver = Solver::new(&impact.structure).unwrap();
        let solution = solver.solve(&impact.striker, &impact.law, None, &settings).unwrap();
        solution.restitution.zip(solution.restitution_uncertainty)
    };
    let reference = |impact: &Impact| [1e-13, 1e-12, 1e-11].into_iter().find_map(|tolerance| tight(impact, tolerance));
    let references: Vec<(f64, f64)> = impacts.iter().filter_map(reference).collect();
    assert_eq!(references.len(), impacts.len());
    for tolerance in [1e-9, 1e-7, 1e-5] {
        let mut coverage = Coverage::default();
        for (impact, (reference, rest)) in impacts.iter().zip(&references) {
            let solution = impact.solve(tolerance);
            assert_eq!(solution.outcome, Outcome::Rebound, "{impact:?}");
            let beyond = ((solution.restitution.unwrap() - reference).abs() - rest).max(0.0);
            coverage.note(beyond, solution.restitution_uncertainty.unwrap(), || format!("{tolerance:e} {impact:?}"));
        }
        coverage.assert(impacts.len());
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
    coverage.assert(24);
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
        let (law, mut solver) = (Law::from(drop.law), Solver::new(&drop.structure).unwrap());
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
    coverage.assert(160);
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
        let error = solution.contacts.iter().zip(&reference.contacts).fold(0.0_f64, |error, (a, b)| {
            let duration = a.duration.zip(b.duration).map_or(0.0, |(a, b)| relative(a, b));
            let speed = a.body_speed_at_end.zip(b.body_speed_at_end);
            let speed = speed.map_or(0.0, |(x, y)| (x - y).abs() / y.abs().max(2.0 * a.closing_speed));
            error.max(relative(a.start, b.start)).max(duration).max(speed)
        });
        // rounding: no more digits are stated than 15, and the reference has no more than about 13
        let stated = solution.error.unwrap().max(1e-15);
        let beyond = (error - reference.error.unwrap().max(1e-13)).max(0.0);
        coverage.note(beyond, stated, || format!("{structure:?} S = {s}, {nodes} nodes, 10^{tolerance}"));
    }
    coverage.assert(80);
}
