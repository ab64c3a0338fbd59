//! No input makes a method panic, hang or return a value that is not finite.

use fracdiff::{
    Collocation, Convolution, Equation, Event, GalerkinStates, InitialValueProblem, InvalidInput, Method, Solution,
    Stop, SumOfExponentials, Term, Volterra, test_problems,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// The library's list, with a limit on the number of panels of collocation.
fn every_method(steps: usize) -> Vec<Method> {
    let mut methods = test_problems::every_method(steps);
    for method in &mut methods {
        if let Method::Collocation(collocation) = method {
            collocation.most_panels = 100;
        }
    }
    methods
}

fn assert_finite(solution: &Solution) {
    assert!(solution.values().iter().all(|v| v.is_finite()));
    assert!(solution.times().windows(2).all(|w| w[0] <= w[1]));
    assert_eq!(solution.times().len() * solution.unknowns(), solution.values().len());
}

fn field(result: Result<Solution, InvalidInput>) -> String {
    result.unwrap_err().field.to_string()
}

#[test]
fn bad_problems_are_refused_by_every_method() {
    let good = || Volterra::scalar(|_| 1.0, |_, y| y, &[(0.5, -1.0)]);
    let with = |order: f64, coefficient: f64| Volterra::scalar(|_| 1.0, |_, y| y, &[(order, coefficient)]);
    for method in every_method(10) {
        for t_end in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(field(good().solve(&method, t_end)), "t_end");
        }
        for order in [0.0, -0.5, 0.001, 17.0, f64::NAN] {
            assert_eq!(field(with(order, 1.0).solve(&method, 1.0)), "terms[0].order");
        }
        assert_eq!(field(with(0.5, f64::INFINITY).solve(&method, 1.0)), "terms[0].coefficient");
        let stray = Term { unknown: 1, density: 0, order: 0.5, coefficient: 1.0 };
        assert_eq!(field(Volterra { terms: vec![stray], ..good() }.solve(&method, 1.0)), "terms[0].unknown");
        let stray = Term { unknown: 0, density: 9, order: 0.5, coefficient: 1.0 };
        assert_eq!(field(Volterra { terms: vec![stray], ..good() }.solve(&method, 1.0)), "terms[0].density");
        assert_eq!(field(Volterra { unknowns: 0, ..good() }.solve(&method, 1.0)), "unknowns");
        assert_eq!(field(Volterra { densities: 0, ..good() }.solve(&method, 1.0)), "densities");
        assert_eq!(field(good().with_breaks(&[0.5, f64::NAN]).solve(&method, 1.0)), "breaks[1]");
    }
}

#[test]
fn bad_settings_are_refused() {
    let solve = |method: Method| field(Volterra::scalar(|_| 1.0, |_, y| y, &[(0.5, -1.0)]).solve(&method, 1.0));
    assert_eq!(solve(Method::Trapezoidal(Convolution { steps: 0 })), "steps");
    assert_eq!(solve(Method::L1(Convolution { steps: usize::MAX })), "steps");
    let sum = SumOfExponentials::default();
    assert_eq!(solve(Method::SumOfExponentials(SumOfExponentials { grading: 0.5, ..sum.clone() })), "grading");
    assert_eq!(solve(Method::SumOfExponentials(SumOfExponentials { tolerance: 0.0, ..sum })), "tolerance");
    let galerkin = GalerkinStates::default();
    assert_eq!(solve(Method::GalerkinStates(GalerkinStates { states: 1, ..galerkin.clone() })), "states");
    assert_eq!(solve(Method::GalerkinStates(GalerkinStates { beta2: -3.0, ..galerkin })), "beta2");
    for order in [0.96, 1.99, 2.01] {
        let method = Method::GalerkinStates(GalerkinStates::default());
        let problem = Volterra::scalar(|_| 1.0, |_, y| y, &[(2.0, -1.0), (order, -1.0)]);
        assert_eq!(field(problem.solve(&method, 1.0)), "terms[1].order");
    }
    let collocation = Collocation::default();
    for (name, settings) in [
        ("tolerance", Collocation { tolerance: f64::NAN, ..collocation.clone() }),
        ("nodes", Collocation { nodes: 3, ..collocation.clone() }),
        ("mapping", Collocation { mapping: Some(0), ..collocation.clone() }),
        ("first_panel", Collocation { first_panel: Some(-1.0), ..collocation.clone() }),
        ("longest_panel", Collocation { longest_panel: Some(f64::NAN), ..collocation.clone() }),
        ("most_panels", Collocation { most_panels: 0, ..collocation }),
    ] {
        assert_eq!(solve(Method::Collocation(settings)), name);
    }
}

#[test]
fn bad_initial_value_problems_are_refused() {
    let refuse = |equation: Equation| {
        let problem = InitialValueProblem::new(vec![equation], |_, y, f| f[0] = y[0]);
        field(problem.solve(&Method::Collocation(Collocation::default()), 1.0))
    };
    assert_eq!(refuse(Equation::new(0.0, &[1.0])), "equations[0].order");
    assert_eq!(refuse(Equation::new(f64::NAN, &[1.0])), "equations[0].order");
    assert_eq!(refuse(Equation::new(1.5, &[1.0])), "equations[0].initial.len()");
    assert_eq!(refuse(Equation::new(0.5, &[f64::NAN])), "equations[0].initial[0]");
    assert_eq!(refuse(Equation::new(0.5, &[1.0]).plus(1.0, 0.5)), "equations[0].lower[0].1");
    assert_eq!(refuse(Equation::new(0.5, &[1.0]).plus(f64::NAN, 0.2)), "equations[0].lower[0].0");
}

/// `3 - 2.99` is below 0.01 by its rounding.
#[test]
fn the_highest_lower_order_that_is_allowed_is_solved() {
    for (order, lower) in [(3.0, 2.99), (16.0, 15.99), (1.0, 0.99)] {
        let equation = Equation::new(order, &[1.0; 16][..order as usize]).plus(1.0, lower);
        let problem = InitialValueProblem::new(vec![equation], |_, y, f| f[0] = -y[0]);
        let solution = problem.solve(&Method::SumOfExponentials(SumOfExponentials::default()), 1.0).unwrap();
        assert_eq!(solution.stop, Stop::EndReached, "{order} {lower}");
    }
}

#[test]
fn values_that_are_not_finite_stop_the_run_and_say_where() {
    let problem = Volterra::scalar(|_| 1.0, |t, y| if t < 0.7 { y } else { f64::NAN }, &[(0.5, -1.0)]);
    let forced = Volterra::scalar(|t| if t < 0.7 { 1.0 } else { f64::INFINITY }, |_, y| y, &[(0.5, -1.0)]);
    for problem in [problem, forced] {
        for method in every_method(100) {
            let solution = problem.solve(&method, 1.0).unwrap();
            let Stop::NonFinite { t } = solution.stop else { panic!("{}: {:?}", method.name(), solution.stop) };
            assert!((0.7..0.72).contains(&t), "{}: {t}", method.name());
            assert!(solution.end_time() > 0.6 && solution.end_time() <= 0.7, "{}", method.name());
            assert!(solution.at(solution.end_time()).is_ok());
            assert_finite(&solution);
        }
    }
    let event = Volterra::scalar(|_| 1.0, |_, y| y, &[(0.5, -1.0)]).with_event(Event::new(|_, _| f64::NAN));
    for method in every_method(20) {
        assert_eq!(event.solve(&method, 1.0).unwrap().stop, Stop::NonFinite { t: 0.0 });
    }
    let nothing = Volterra::scalar(|_| f64::NAN, |_, y| y, &[(0.5, -1.0)]);
    for method in every_method(20) {
        let solution = nothing.solve(&method, 1.0).unwrap();
        assert_eq!((solution.stop, solution.end_time()), (Stop::NonFinite { t: 0.0 }, 0.0));
        assert!(solution.at(0.0).is_err());
    }
}

#[test]
fn a_solution_that_blows_up_stops_the_run() {
    // y' = y^2, y(0) = 1: infinite at t = 1
    let problem = Volterra::scalar(|_| 1.0, |_, y| y * y, &[(1.0, 1.0)]);
    for method in every_method(500) {
        let solution = problem.solve(&method, 2.0).unwrap();
        assert!(solution.stop != Stop::EndReached, "{}", method.name());
        assert!((solution.end_time() - 1.0).abs() < 0.1, "{} {}", method.name(), solution.end_time());
        assert_finite(&solution);
    }
}

#[test]
fn extreme_scales_of_time_and_value() {
    for scale in [1e-150, 1e-20, 1.0, 1e20, 1e150] {
        let problem = Volterra::scalar(|_| scale, |_, y| y, &[(1.0, -1.0)]);
        for method in every_method(50) {
            let solution = problem.solve(&method, 1.0).unwrap();
            assert_eq!(solution.stop, Stop::EndReached, "{} {scale}", method.name());
            let error = (solution.at(1.0).unwrap()[0] / scale - (-1.0f64).exp()).abs();
            assert!(error < 1e-2, "{} {scale}: {error}", method.name());
        }
    }
    for t_end in [1e-100_f64, 1e100] {
        let problem = Volterra::scalar(|_| 1.0, |_, y| y, &[(0.5, -t_end.powf(-0.5))]);
        for method in every_method(50) {
            match problem.solve(&method, t_end) {
                Ok(solution) => assert_finite(&solution),
                Err(refused) => panic!("{}: {refused}", method.name()),
            }
        }
    }
}

#[test]
fn values_between_the_finest_steps_are_finite() {
    // The mesh is graded so strongly after a late break that the first steps are below the rounding of t.
    let problem = Volterra::scalar(|_| 1.0, |_, y| y, &[(0.5, -1.0)]).with_breaks(&[1e3]);
    for method in [
        Method::SumOfExponentials(SumOfExponentials { steps: 4000, grading: 8.0, tolerance: 1e-6 }),
        Method::Collocation(Collocation { first_panel: Some(1e-18), ..Default::default() }),
    ] {
        let solution = problem.solve(&method, 2e3).unwrap();
        assert_eq!(solution.stop, Stop::EndReached, "{}", method.name());
        assert_finite(&solution);
        let mut t = 1e3_f64;
        for _ in 0..2000 {
            assert!(solution.at(t).unwrap()[0].is_finite(), "{} {t}", method.name());
            t = t.next_up().next_up();
        }
    }
}

#[test]
fn times_outside_are_refused() {
    let problem = Volterra::scalar(|_| 1.0, |_, y| y, &[(0.5, -1.0)]);
    for method in every_method(10) {
        let solution = problem.solve(&method, 1.0).unwrap();
        for t in [-1e-9, 1.0 + 1e-9, f64::NAN, f64::INFINITY] {
            assert_eq!(solution.at(t).unwrap_err().field, "t");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn random_problems_end_in_finite_solutions(
        order in 0.01f64..4.0,
        second in 0.01f64..4.0,
        coefficient in -20.0f64..20.0,
        power in 0.5f64..3.0,
        t_end in 1e-6f64..1e3,
        breaks in proptest::collection::vec(-1.0f64..1e3, 0..4),
        which in 0usize..6,
    ) {
        let problem = Volterra::scalar(
            |t| 1.0 + t,
            |_, y| y.abs().powf(power) * y.signum(),
            &[(order, coefficient), (second, -1.0)],
        )
        .with_breaks(&breaks)
        .with_event(Event::new(|t, y| y[0] - t));
        let solution = problem.solve(&every_method(60)[which], t_end);
        // A Galerkin order outside its range is rejected; everything else runs.
        if let Ok(solution) = solution {
            assert_finite(&solution);
            prop_assert!(solution.events.iter().all(|e| e.t.is_finite()));
        } else {
            prop_assert_eq!(which, 4);
        }
    }
}

/// The parts of such an interval underflow to 0.
#[test]
fn the_shortest_interval_ends() {
    for method in every_method(50) {
        let decay = InitialValueProblem::new(vec![Equation::new(0.5, &[1.0])], |_, y, f| f[0] = -y[0]);
        if let Ok(solution) = decay.solve(&method, 5e-324) {
            assert_finite(&solution);
        }
    }
}

/// Steps are shared by ratios of lengths, which do not overflow.
#[test]
fn the_longest_interval_ends() {
    for method in every_method(20) {
        let problem = Volterra::scalar(|_| 1.0, |_, y| y, &[(0.5, 0.0)]);
        if let Ok(solution) = problem.solve(&method, f64::MAX) {
            assert!(solution.values().iter().all(|value| value.is_finite()), "{method}");
        }
    }
}

/// `E_0.01(-0.9 t^0.01)` falls from 0.92 at `t = 1e-100` to 0.53 at 1. No panel resolves this, although Newton's method converges
/// on each.
#[test]
fn a_start_that_no_panel_resolves_is_named() {
    let problem = InitialValueProblem::new(vec![Equation::new(0.01, &[1.0])], |_, y, f| f[0] = -0.9 * y[0]);
    let found = problem.solve_to(1e-6, 1.0).unwrap();
    assert_eq!(found.solution.stop, Stop::Unresolved { t: 0.0 });
    assert!(found.error.is_infinite());
}
