//! Stated errors must cover the true ones, in random problems with known solutions. The seed is fixed.

use fracdiff::{Equation, InitialValueProblem, Volterra, operators, test_problems};
use libm::tgamma;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};

/// The same sequence of random values on every machine.
fn draw<T>(strategy: impl Strategy<Value = T>, count: usize) -> Vec<T> {
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[19; 32]);
    let mut runner = TestRunner::new_with_rng(ProptestConfig::default(), rng);
    (0..count).map(|_| strategy.new_tree(&mut runner).unwrap().current()).collect()
}

/// Counts how well stated errors cover true ones.
#[derive(Default, Debug)]
struct Coverage {
    cases: usize,
    covered: usize,
    /// Largest ratio of true to stated error, and the problem in which it occurs.
    worst: (f64, String),
}

impl Coverage {
    fn note(&mut self, error: f64, stated: f64, what: impl FnOnce() -> String) {
        self.cases += 1;
        self.covered += usize::from(error <= stated);
        if error / stated > self.worst.0 || error.is_nan() {
            self.worst = (error / stated, format!("error {error:e}, stated {stated:e}: {}", what()));
        }
    }

    fn assert(&self, at_least: usize) {
        println!("{} of {}, {:?}", self.covered, self.cases, self.worst);
        assert!(self.cases >= at_least, "{self:?}");
        assert!(100 * self.covered >= 99 * self.cases, "{self:?}");
        assert!(self.worst.0 <= 10.0, "{self:?}");
    }
}

const TOLERANCES: [f64; 5] = [1e-1, 1e-2, 1e-4, 1e-7, 1e-10];

/// In every test problem, at every tolerance, the stated error covers the true one and is within the tolerance.
#[test]
fn the_test_problems() {
    for problem in test_problems::all() {
        let end = problem.end_before(100.0);
        for tolerance in TOLERANCES {
            let found = problem.volterra.solve_to(tolerance, end).unwrap();
            let values = found.solution.values();
            let size = values.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
            let errors = problem.reference.iter().filter(|point| point.0 <= end);
            let error = errors.fold(0.0_f64, |a, &(t, y)| a.max((found.solution.at(t).unwrap()[0] - y).abs())) / size;
            assert!(error <= found.error, "{} {tolerance:e}: {error:e}, stated {:e}", problem.name, found.error);
            assert!(found.error <= tolerance, "{} {tolerance:e}: stated {:e}", problem.name, found.error);
        }
    }
}

/// `D^a y + c D^b y = g(t) - k (y^3 - Y^3)` with `g` such that `Y = sum of w_i t^p_i`, errors over the whole interval.
#[test]
fn manufactured_initial_value_problems() {
    let mut coverage = Coverage::default();
    let powers = proptest::collection::vec((-1.0..1.0f64, 0.0..4.0f64), 1..4);
    let cases = draw((0.2..1.0f64, 0.1..0.9f64, -1.0..1.0f64, 0.0..2.0f64, powers, 0..5usize, 0.3..3.0f64), 120);
    for case in cases {
        let (order, share, lower, cubic, powers, which, end) = case.clone();
        // Exponents are not below the order, as in the solutions of such equations.
        let powers: Vec<(f64, f64)> = powers.into_iter().map(|(w, p)| (w, order + p)).collect();
        let sum = |t: f64, a: f64| -> f64 {
            powers.iter().map(|(w, p)| w * tgamma(p + 1.0) / tgamma(p + 1.0 - a) * t.powf(p - a)).sum()
        };
        let exact = |t: f64| 1.0 + sum(t, 0.0);
        let problem = InitialValueProblem::new(
            vec![Equation::new(order, &[1.0]).plus(lower, share * (order - 0.01))],
            |t, y, f| {
                let given = sum(t, order) + lower * sum(t, share * (order - 0.01));
                f[0] = given - cubic * (y[0].powi(3) - exact(t).powi(3));
            },
        );
        let found = problem.solve_to(TOLERANCES[which], end).unwrap();
        let places = (0..=400).map(|i| end * (f64::from(i) / 400.0).powi(3));
        let (mut error, mut size) = (0.0_f64, 0.0_f64);
        for t in places {
            error = error.max((found.solution.at(t).unwrap()[0] - exact(t)).abs());
            size = size.max(exact(t).abs());
        }
        coverage.note(error / size, found.error, || format!("{case:?}"));
    }
    coverage.assert(120);
}

/// `y = g - k int (t-s)^(a-1) [load + y^2 - Y^2] ds` with the solution `Y = 1 + sin(w t)` and a load that jumps.
#[test]
fn manufactured_volterra_equations() {
    let mut coverage = Coverage::default();
    for case in draw((0.3..2.5f64, 0.1..2.0f64, 0.5..20.0f64, 0..5usize, 0.2..0.8f64), 80) {
        let (order, k, omega, which, jump) = case;
        let exact = |t: f64| 1.0 + (omega * t).sin();
        let problem = Volterra::scalar(
            |t| exact(t) + k / order * (2.0 * t.powf(order) - 5.0 * (t - jump).max(0.0).powf(order)),
            |t, y| if t < jump { 2.0 } else { -3.0 } + y * y - exact(t).powi(2),
            &[(order, -k)],
        )
        .with_breaks(&[jump]);
        let found = problem.solve_to(TOLERANCES[which], 1.0).unwrap();
        if found.error == f64::INFINITY {
            println!("undecided: {case:?} {:?}", found.solution.stop);
            continue;
        }
        let times = (0..=200).map(|i| f64::from(i) / 200.0);
        let error = times.fold(0.0_f64, |a, t| a.max((found.solution.at(t).unwrap()[0] - exact(t)).abs()));
        coverage.note(error, found.error, || format!("{case:?}"));
    }
    // A few runs end undecided, and report it.
    coverage.assert(76);
}

/// `I^(1/2) exp(c s) = exp(c t) erf(sqrt(c t)) / sqrt(c)`, at any tolerance.
#[test]
fn operators_of_functions() {
    let mut coverage = Coverage::default();
    for case in draw((0.1..8.0f64, 0.1..5.0f64, -13.0..-1.0f64), 200) {
        let (c, t, power) = case;
        let settings = operators::Quadrature { tolerance: 10f64.powf(power), mapping: 1 };
        let found = operators::integral(0.5, |s| (c * s).exp(), t, &settings).unwrap();
        let exact = (c * t).exp() * puruspe::erf((c * t).sqrt()) / c.sqrt();
        let beyond = ((found.value - exact).abs() - 1e-14 * exact).max(0.0);
        coverage.note(beyond, found.error, || format!("{case:?}"));
    }
    coverage.assert(200);
}
