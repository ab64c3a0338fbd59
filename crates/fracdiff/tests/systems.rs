//! Systems, several terms and mixed orders; discontinuous forcing; agreement of the methods.

use fracdiff::test_problems::{self, every_method};
use fracdiff::{
    Collocation, Convolution, Equation, InitialValueProblem, Method, Solution, Stop, SumOfExponentials, Term, Volterra,
};
use libm::tgamma;

fn collocation() -> Method {
    Method::Collocation(Collocation::default())
}

#[test]
fn bagley_torvik_as_an_initial_value_problem() {
    let problem = InitialValueProblem::new(vec![Equation::new(2.0, &[0.0, 0.0]).plus(1.0, 1.5)], |t, y, f| {
        f[0] = if t <= 1.0 { 8.0 - y[0] } else { -y[0] }
    })
    .with_breaks(&[1.0]);
    let solution = problem.solve(&collocation(), 20.0).unwrap();
    for (t, y) in test_problems::bagley_torvik().reference {
        assert!((solution.at(t).unwrap()[0] - y).abs() < 2e-12, "{t}");
    }
}

/// `y = t^2 + t^(3/2) + 1`, `z = t + 2`: orders 3/2 with a lower term 1/2, and 1/2, nonlinearly coupled.
fn mixed_orders() -> InitialValueProblem<'static> {
    let y = |t: f64| t * t + t.powf(1.5) + 1.0;
    let z = |t: f64| t + 2.0;
    let derivative = |a: f64, p: f64, t: f64| tgamma(p + 1.0) / tgamma(p + 1.0 - a) * t.powf(p - a);
    let left =
        move |t: f64| derivative(1.5, 2.0, t) + tgamma(2.5) + 0.5 * (derivative(0.5, 2.0, t) + derivative(0.5, 1.5, t));
    let equations = vec![Equation::new(1.5, &[1.0, 0.0]).plus(0.5, 0.5), Equation::new(0.5, &[2.0])];
    InitialValueProblem::new(equations, move |t, v, f| {
        f[0] = left(t) + v[0] * v[1] - y(t) * z(t);
        f[1] = derivative(0.5, 1.0, t) + (v[0] - y(t)).sin() - (v[1].powi(2) - z(t).powi(2));
    })
}

#[test]
fn a_nonlinear_system_of_mixed_orders() {
    let problem = mixed_orders();
    let errors = |solution: &Solution| {
        let end = solution.at(1.0).unwrap();
        (end[0] - 3.0).abs().max((end[1] - 3.0).abs())
    };
    let found = errors(&problem.solve(&collocation(), 1.0).unwrap());
    assert!(found < 1e-12, "{found:e}");
    for method in every_method(2000) {
        let solution = problem.solve(&method, 1.0).unwrap();
        assert_eq!((solution.stop, solution.unknowns()), (Stop::EndReached, 2));
        let found = errors(&solution);
        println!("{} {found:e}", method.name());
        assert!(found < if method == every_method(2000)[0] { 5e-3 } else { 1e-4 }, "{}: {found:e}", method.name());
    }
}

#[test]
fn orders_above_two() {
    // D^(5/2) y = t^(1/2) Gamma(4)/Gamma(3/2) has the solution t^3 with zero initial values, and t^3 + 1 + t + t^2/2 with ones.
    let problem = InitialValueProblem::new(vec![Equation::new(2.5, &[1.0, 1.0, 1.0])], |t, _, f| {
        f[0] = tgamma(4.0) / tgamma(1.5) * t.sqrt()
    });
    for method in every_method(2000) {
        let end = problem.solve(&method, 2.0).unwrap().at(2.0).unwrap()[0];
        let allowed = match method {
            Method::GrunwaldLetnikov(_) => 3e-2,
            Method::Collocation(_) => 1e-11,
            _ => 1e-4,
        };
        assert!((end - 13.0).abs() < allowed, "{}: {end}", method.name());
    }
}

#[test]
fn a_discontinuous_load_keeps_the_order_of_every_method() {
    // D^(1/2) y = -y + [t > 0.37]: the break is not a natural grid point.
    let problem = InitialValueProblem::new(vec![Equation::new(0.5, &[1.0])], |t, y, f| {
        f[0] = -y[0] + if t > 0.37 { 1.0 } else { 0.0 }
    })
    .with_breaks(&[0.37]);
    let exact = problem.solve(&collocation(), 1.0).unwrap().at(1.0).unwrap()[0];
    // The equation is linear: the solution is the relaxation and its step response, by the Mittag-Leffler function erfcx(sqrt
    // t).
    let known = puruspe::erfcx(1.0) + 1.0 - puruspe::erfcx(0.63f64.sqrt());
    assert!((exact - known).abs() < 1e-13, "{exact} {known}");
    let order = |method: fn(usize) -> Method| {
        let error = |steps| (problem.solve(&method(steps), 1.0).unwrap().at(1.0).unwrap()[0] - known).abs();
        0.5 * (error(500) / error(2000)).log2()
    };
    let measured = order(|steps| Method::Trapezoidal(Convolution { steps }));
    assert!((measured - 2.0).abs() < 0.2, "{measured}");
    let measured = order(|steps| Method::SumOfExponentials(SumOfExponentials { steps, ..Default::default() }));
    assert!((measured - 2.0).abs() < 0.2, "{measured}");
    let measured = order(|steps| Method::GrunwaldLetnikov(Convolution { steps }));
    assert!((measured - 1.0).abs() < 0.1, "{measured}");
    let measured = order(|steps| Method::L1(Convolution { steps }));
    assert!((measured - 1.0).abs() < 0.1, "{measured}");
}

#[test]
fn fast_history_equals_direct_sums() {
    // 63 steps are summed directly, 64 and more by transforms. A comparison of both on the same grid, with a break in the
    // middle, would not find common errors; the reference is therefore the recursion written out.
    let (steps, order) = (777usize, 0.5);
    let solution = test_problems::abel().volterra.solve(&Method::GrunwaldLetnikov(Convolution { steps }), 2.0).unwrap();
    let h: f64 = 2.0 / steps as f64;
    let mut weight = vec![tgamma(order) * h.powf(order)];
    let mut y = vec![1.0];
    for n in 1..=steps {
        weight.push(weight[n - 1] * (n as f64 - 1.0 + order) / n as f64);
        let past: f64 = (1..n).map(|j| weight[n - j] * y[j]).sum();
        y.push((1.0 - past) / (1.0 + weight[0]));
    }
    let worst = y.iter().zip(solution.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-13, "{worst:e}");
}

#[test]
fn memory_of_the_exponentials_grows_with_the_logarithm() {
    let held = |steps: usize| {
        let method = Method::SumOfExponentials(SumOfExponentials { steps, ..Default::default() });
        test_problems::relaxation().volterra.solve(&method, 10.0).unwrap().counts.history_values
    };
    let growth = held(4000) - held(400);
    assert!(held(4000) < 400 && growth <= held(40_000) - held(4000) + 22 && growth < 120, "{growth}");
}

#[test]
fn rerun_is_identical_to_the_last_bit() {
    for method in every_method(300) {
        let run = || mixed_orders().solve(&method, 1.0).unwrap().values().to_vec();
        assert_eq!(run(), run());
    }
}

#[test]
fn terms_of_one_pair_add_up() {
    // One term of weight 1 against two of weight 1/2.
    let term = |coefficient| Term { unknown: 0, density: 0, order: 0.5, coefficient };
    let solve = |terms: Vec<Term>| {
        let problem = Volterra { terms, ..Volterra::scalar(|_| 1.0, |_, y| y * y, &[]) };
        problem.solve(&collocation(), 0.1).unwrap().at(0.1).unwrap()[0]
    };
    assert!((solve(vec![term(-1.0)]) - solve(vec![term(-0.5), term(-0.5)])).abs() < 1e-15);
    assert!((solve(vec![]) - 1.0).abs() < 1e-15);
}

/// Each unknown is computed to its own size, whatever the size of the others: their units may differ.
#[test]
fn a_small_unknown_is_as_accurate_as_a_large_one() {
    let alone = test_problems::rigid_contact().volterra;
    let own = |of: usize| Term { unknown: of, density: of, order: 2.0, coefficient: -1.0 };
    for (large, small) in [(1.0, 1e-6), (1e6, 1.0), (1e6, 1e-6)] {
        let both = Volterra {
            unknowns: 2,
            densities: 2,
            terms: vec![own(0), own(1)],
            forcing: Box::new(move |t, g| g.copy_from_slice(&[large, small * t])),
            density: Box::new(move |_, y, f| f.copy_from_slice(&[y[0], small * (y[1] / small).max(0.0).powf(1.5)])),
            breaks: Vec::new(),
            events: Vec::new(),
        };
        for method in every_method(200) {
            let [one, two] = [&alone, &both].map(|problem| problem.solve(&method, 3.0).unwrap());
            for i in 1..=30 {
                let t = 0.1 * f64::from(i);
                let difference = one.at(t).unwrap()[0] - two.at(t).unwrap()[1] / small;
                assert!(difference.abs() < 1e-12, "{method} {large} {small} {t}: {difference:e}");
            }
        }
    }
}

/// The integrals are continuous, also where a kernel of low order is all but infinite.
#[test]
fn a_break_without_a_jump_leaves_no_jump() {
    for order in [0.1, 0.5] {
        let problem = Volterra::scalar(|_| 1.0, |_, y| y, &[(order, -1.0 / tgamma(order))]).with_breaks(&[1.0]);
        for method in every_method(400) {
            let solution = problem.solve(&method, 2.0).unwrap();
            let [before, after] = [1.0, 1.0 + 1e-12].map(|t| solution.at(t).unwrap()[0]);
            assert!((after - before).abs() < 1e-8, "{method} {order}: {before} {after}");
        }
    }
}
