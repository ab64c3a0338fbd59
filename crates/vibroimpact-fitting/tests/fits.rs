//! Fits compared with certified values and closed forms, and invalid input.

use fitting::*;

const METHODS: [Method; 3] = [Method::LevenbergMarquardt, Method::Simplex, Method::Both];

/// NIST StRD "Misra1a" (lower difficulty): y = b1 (1 - exp(-b2 x)), certified to 11 digits.
const MISRA_X: [f64; 14] =
    [77.6, 114.9, 141.1, 190.8, 239.9, 289.0, 332.8, 378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0];
const MISRA_Y: [f64; 14] =
    [10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02, 44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78];

fn misra(p: &[f64], r: &mut [f64]) {
    for ((r, x), y) in r.iter_mut().zip(MISRA_X).zip(MISRA_Y) {
        *r = p[0] * (1.0 - (-p[1] * x).exp()) - y;
    }
}

fn misra_jacobian(p: &[f64], rows: &mut [f64]) {
    for (row, x) in rows.chunks_exact_mut(2).zip(MISRA_X) {
        let decay = (-p[1] * x).exp();
        row.copy_from_slice(&[1.0 - decay, p[0] * x * decay]);
    }
}

fn misra_problem<'a>(jacobian: Option<&'a ResidualsFn<'a>>) -> Problem<'a> {
    Problem {
        parameters: vec![
            Parameter::positive("b1", 500.0, (10.0, 1000.0)),
            Parameter::positive("b2", 1e-4, (1e-5, 1e-2)),
        ],
        count: 14,
        residuals: &misra,
        jacobian,
    }
}

#[test]
fn certified_parameters_and_standard_deviations_are_found() {
    for jacobian in [None, Some(&misra_jacobian as &ResidualsFn)] {
        for method in METHODS {
            let settings = Settings { method, ..Settings::default() };
            let found = fit(&misra_problem(jacobian), &settings).unwrap();
            assert_eq!(found.outcome, Outcome::Converged);
            assert!((found.parameters[0] / 2.3894212918e2 - 1.0).abs() < 1e-6, "{method:?} {:?}", found.parameters);
            assert!((found.parameters[1] / 5.5015643181e-4 - 1.0).abs() < 1e-6);
            assert!((found.sum_of_squares / 1.2455138894e-1 - 1.0).abs() < 1e-9);
            // Certified standard deviations are 2.7070075241 and 7.2668688436e-6; t = 2.178812830 at 12 degrees.
            let intervals = found.intervals(0.95).unwrap().unwrap();
            for (j, deviation) in [(0, 2.7070075241), (1, 7.2668688436e-6)] {
                let relative = deviation / found.parameters[j];
                let half = 0.5 * (intervals[j].high / intervals[j].low).ln();
                assert!((half / (2.178812830 * relative) - 1.0).abs() < 1e-4, "{method:?} {j}");
            }
        }
    }
}

#[test]
fn the_same_input_gives_the_same_bits() {
    let once = fit(&misra_problem(None), &Settings::default()).unwrap();
    let again = fit(&misra_problem(None), &Settings::default()).unwrap();
    assert_eq!(once, again);
    let interval =
        |seed| bootstrap(&misra_problem(None), &Settings::default(), &once, 50, seed, 0.9).unwrap()[0].low.to_bits();
    assert_eq!(interval(3), interval(3));
    assert_ne!(interval(3), interval(4));
}

/// (1 + |a - 0.3|)(1 + |a - b|) + 0.01 (b - 3)^2: the derivative jumps at the minimum in both directions.
#[test]
fn a_kinked_minimum_is_found_without_derivatives() {
    let problem = Problem {
        parameters: vec![Parameter::free("a", 2.0, (-5.0, 5.0)), Parameter::free("b", -1.0, (-5.0, 5.0))],
        count: 2,
        residuals: &|p, r| {
            r[0] = (1.0 + (p[0] - 0.3).abs()).sqrt() * (1.0 + (p[0] - p[1]).abs()).sqrt();
            r[1] = 0.1 * (p[1] - 3.0);
        },
        jacobian: None,
    };
    // At a = 0.3 the sum is 1 + |0.3 - b| + 0.01 (b - 3)^2, whose slope in b is 1 - 0.054 > 0 to the right of 0.3.
    let least = 1.0 + 0.01 * 2.7 * 2.7;
    for method in [Method::Simplex, Method::Both] {
        let found = fit(&problem, &Settings { method, ..Settings::default() }).unwrap();
        assert!((found.sum_of_squares - least).abs() < 1e-6, "{method:?} {found:?}");
        assert!(found.parameters.iter().all(|p| (p - 0.3).abs() < 1e-6));
    }
}

#[test]
fn several_starts_find_the_lower_of_two_minima() {
    // (p^2 - 4)^2 + (p - 1)^2 / 4: a local minimum near -2, the least near 2
    let problem = Problem {
        parameters: vec![Parameter::free("p", -3.0, (-4.0, 4.0))],
        count: 2,
        residuals: &|p, r| (r[0], r[1]) = (p[0] * p[0] - 4.0, 0.5 * (p[0] - 1.0)),
        jacobian: None,
    };
    let from_one = fit(&problem, &Settings { starts: 1, method: Method::LevenbergMarquardt, ..Settings::default() });
    assert!(from_one.unwrap().parameters[0] < 0.0);
    for method in METHODS {
        let from_many = fit(&problem, &Settings { method, ..Settings::default() }).unwrap();
        assert!((from_many.parameters[0] - 1.984).abs() < 1e-2, "{:?}", from_many.parameters);
    }
}

#[test]
fn ranges_hold_at_the_boundary() {
    // The least-squares solution is outside both ranges; the fit stays within them.
    let problem = Problem {
        parameters: vec![
            Parameter::positive("p", 1.0, (0.1, 10.0)),
            Parameter {
                name: "q".into(),
                start: 0.5,
                range: Range::Between { low: 0.0, high: 1.0 },
                search: (0.1, 0.9),
            },
        ],
        count: 3,
        residuals: &|p, r| r.copy_from_slice(&[p[0] + 1.0, p[1] - 2.0, 0.0]),
        jacobian: None,
    };
    for method in METHODS {
        let found = fit(&problem, &Settings { method, ..Settings::default() }).unwrap();
        assert!(found.parameters[0] > 0.0 && found.parameters[0] < 1e-3, "{:?}", found.parameters);
        assert!(found.parameters[1] > 0.999 && found.parameters[1] <= 1.0);
    }
}

#[test]
fn wild_closures_give_outcomes_or_errors() {
    let parameter = || vec![Parameter::positive("p", 1.0, (0.1, 10.0))];
    let wild: [&ResidualsFn; 7] = [
        &|_, r| r.fill(f64::NAN),
        &|_, r| r.fill(f64::INFINITY),
        &|_, _| (),
        &|p, r| r.fill(if p[0] > 0.5 { 1.0 } else { f64::NAN }),
        &|p, r| r.fill(1e99 * p[0]),
        &|_, r| r.fill(0.0),
        &|p, r| r.fill((1e6 * p[0]).sin()),
    ];
    for (case, residuals) in wild.into_iter().enumerate() {
        for method in METHODS {
            let settings = Settings { method, max_evaluations: 300, ..Settings::default() };
            let problem = Problem { parameters: parameter(), count: 4, residuals, jacobian: None };
            let found = fit(&problem, &settings);
            match case {
                0..=2 => assert_eq!(found, Err(FitError::NonFiniteModel { starts: 8 })),
                _ => assert!(found.is_ok_and(|found| found.parameters[0].is_finite())),
            }
            // A meaningless Jacobian must not cause a panic either.
            for jacobian in [&(|_: &[f64], j: &mut [f64]| j.fill(f64::NAN)) as &ResidualsFn, &|_, _| ()] {
                let problem = Problem { parameters: parameter(), count: 4, residuals, jacobian: Some(jacobian) };
                assert_eq!(fit(&problem, &settings).is_err(), case <= 2);
            }
        }
    }
}

#[test]
fn the_limit_of_evaluations_is_an_outcome() {
    let settings = Settings { method: Method::Simplex, starts: 1, max_evaluations: 5, ..Settings::default() };
    assert_eq!(fit(&misra_problem(None), &settings).unwrap().outcome, Outcome::LimitReached);
}

#[test]
fn undetermined_parameters_have_no_intervals() {
    let problem = Problem {
        parameters: vec![Parameter::free("a", 0.0, (-1.0, 1.0)), Parameter::free("b", 0.0, (-1.0, 1.0))],
        count: 5,
        residuals: &|p, r| (0..5).for_each(|i| r[i] = p[0] + p[1] - i as f64),
        jacobian: None,
    };
    let found = fit(&problem, &Settings::default()).unwrap();
    assert_eq!(found.intervals(0.95).unwrap(), None);
    assert_eq!(found.correlation(), None);
    assert!((found.parameters[0] + found.parameters[1] - 2.0).abs() < 1e-6);
}

/// A residual of the logarithm `x` of a combination of parameters, with many minima beside `x = 0`.
fn rugged(x: f64) -> f64 {
    100.0 * (x + 0.2 * (20.0 * x).sin())
}

fn profile_of(residuals: &ResidualsFn, count: usize, j: usize, step: f64) -> Profile {
    let parameter = |name: &str| Parameter::positive(name, 1.0, (0.1, 10.0));
    let problem = Problem { parameters: vec![parameter("a"), parameter("b")], count, residuals, jacobian: None };
    profile(&problem, &Settings::default(), &[1.0, 1.0], 0.0, j, 1.96 * 1.96, step).unwrap()
}

#[test]
fn profiles_stay_in_their_valley() {
    // Only the product is determined: neither parameter has an end, however rugged the sum of squares is beside the valley.
    let product = |p: &[f64], r: &mut [f64]| r.copy_from_slice(&[rugged((p[0] * p[1]).ln()), 0.0]);
    for step in [0.1, 1.0] {
        for j in [0, 1] {
            let found = profile_of(&product, 2, j, step);
            assert_eq!((found.low, found.high, found.better), (None, None, None), "{j}, {step}");
        }
    }
    // One of them is determined besides, with a standard deviation of 0.5 of its logarithm. The valley is curved.
    let curved = |p: &[f64], r: &mut [f64]| {
        let [a, b] = [p[0].ln(), p[1].ln()];
        r.copy_from_slice(&[rugged(b - a - 0.4 * (2.0 * a).sin()), a / 0.5]);
    };
    for step in [0.1, 1.0, 3.0] {
        let found = profile_of(&curved, 2, 0, step);
        for (end, truth) in [(found.low, -0.98), (found.high, 0.98)] {
            assert!((end.unwrap().ln() - truth).abs() < 5e-3, "{step}: {end:?}");
        }
        // Every point is one of the profile.
        for (a, sum) in found.points {
            assert!((sum - (a.ln() / 0.5).powi(2)).abs() < 1e-3, "{step}: {a}, {sum}");
        }
    }
}

#[test]
fn an_end_is_a_point_of_the_contour_or_a_jump() {
    // A jump at a = 1.1, at which the contour ends. The other parameter cannot avoid it.
    let steep = |p: &[f64], r: &mut [f64]| {
        let [a, b] = [p[0].ln(), p[1].ln()];
        r.copy_from_slice(&[(a + b) / 0.01, a, if p[0] > 1.1 { 5.0 } else { 0.0 }]);
    };
    let found = profile_of(&steep, 3, 0, 1.0);
    assert!(
        (found.high.unwrap() / 1.1 - 1.0).abs() < 0.01 && (found.low.unwrap().ln() + 1.96).abs() < 0.01,
        "{found:?}"
    );
    // A jump at a minimum that lies on its edge. The search for the other parameter does not see the edge, but it can go around.
    let edge = |p: &[f64], r: &mut [f64]| {
        let [a, b] = [p[0].ln(), p[1].ln()];
        r.copy_from_slice(&[(a - b) / 0.3, (a + b) / 0.3, if b < 0.5 * a - 1e-6 { 5.0 } else { 0.0 }]);
    };
    let found = profile_of(&edge, 3, 0, 0.4);
    // On the edge b = a/2: S = (1 + 9) a^2 / (4 * 0.09); on the other side b = 0 is the best: S = 2 a^2 / 0.09.
    let high = 1.96 / (10.0f64 / 0.36).sqrt();
    assert!((found.high.unwrap().ln() / high - 1.0).abs() < 0.1, "{} {high}", found.high.unwrap().ln());
    // No model beyond a = 2, where the sum of squares is still small.
    let ends = |p: &[f64], r: &mut [f64]| {
        r.copy_from_slice(&[(p[0] * p[1]).ln(), p[0].ln(), 0.0]);
        if p[0] > 2.0 {
            r.fill(f64::NAN)
        }
    };
    let found = profile_of(&ends, 3, 0, 1.0);
    assert!(found.high.is_none() && (found.low.unwrap().ln() + 1.96).abs() < 0.01, "{found:?}");
}

/// A factor that is best at zero, and of which the data determine the upper end alone: the search is stopped at 1e-7.
#[test]
fn a_profile_reaches_the_search_interval_from_a_value_far_outside() {
    for (range, best, truth) in
        [(Range::Positive, 1e-7, 0.0196), (Range::Between { low: 0.0, high: 1.0 }, 1e-7, 0.0196)]
    {
        let problem = Problem {
            parameters: vec![Parameter { range, ..Parameter::positive("a", 0.1, (0.01, 0.9)) }],
            count: 1,
            residuals: &|p, r| r[0] = p[0] / 0.01,
            jacobian: None,
        };
        let found = profile(&problem, &Settings::default(), &[best], 1e-10, 0, 1.96 * 1.96, 1.96).unwrap();
        assert!(found.low.is_none() && (found.high.unwrap() / truth - 1.0).abs() < 0.01, "{found:?}");
    }
    // the mirror image, of which they determine the lower end alone
    let problem = Problem {
        parameters: vec![Parameter::positive("a", 10.0, (1.0, 100.0))],
        count: 1,
        residuals: &|p, r| r[0] = 1.0 / p[0] / 0.01,
        jacobian: None,
    };
    let found = profile(&problem, &Settings::default(), &[1e7], 1e-10, 0, 1.96 * 1.96, 1.96).unwrap();
    assert!(found.high.is_none() && (found.low.unwrap() * 0.0196 - 1.0).abs() < 0.01, "{found:?}");
}

#[test]
fn a_profile_of_one_parameter_or_from_a_point_that_is_no_minimum_is_found() {
    let one = Problem {
        parameters: vec![Parameter::free("a", 0.0, (-1.0, 1.0))],
        count: 1,
        residuals: &|p, r| r[0] = p[0],
        jacobian: None,
    };
    let found = profile(&one, &Settings::default(), &[0.0], 0.0, 0, 4.0, 0.1).unwrap();
    assert!((found.low.unwrap() + 2.0).abs() < 0.01 && (found.high.unwrap() - 2.0).abs() < 0.01, "{found:?}");
    // The sum of squares is 9 at a = 0 and 0 at a = 3.
    let away = Problem { residuals: &|p, r| r[0] = p[0] - 3.0, ..one };
    let found = profile(&away, &Settings::default(), &[0.0], 9.0, 0, 4.0, 1.0).unwrap();
    assert!(found.better.unwrap()[0] > 1.0 && (found.low.unwrap() + 0.6056).abs() < 0.01);
    assert!((found.high.unwrap() - 6.6056).abs() < 0.03, "{:?}", found.high);
}

/// Eight directions, in each of which the residual vanishes at many places, but all vanish together only once. None of the
/// twelve is found if all candidates are points of the sequence.
#[test]
fn candidates_find_the_least_of_many_minima() {
    for truth in [[1.234, -2.345], [-6.1, 3.3], [0.7, 8.2], [-3.9, -7.7]] {
        for (height, per_length) in [(1.0, 20.0), (2.0, 25.0), (1.0, 40.0)] {
            let residuals = |p: &[f64], r: &mut [f64]| {
                for (k, r) in r.iter_mut().enumerate() {
                    let (sin, cos) = (0.4 * k as f64).sin_cos();
                    let along = cos * (p[0] - truth[0]) + sin * (p[1] - truth[1]);
                    *r = 10.0 * along + height * (per_length * along).sin();
                }
            };
            let problem = Problem {
                parameters: vec![Parameter::free("a", 0.0, (-10.0, 10.0)), Parameter::free("b", 0.0, (-10.0, 10.0))],
                count: 8,
                residuals: &residuals,
                jacobian: None,
            };
            let method = Method::LevenbergMarquardt;
            let found =
                fit(&problem, &Settings { method, starts: 16, candidates: 960, ..Settings::default() }).unwrap();
            assert_eq!(found.starts.len(), 16);
            assert!(found.sum_of_squares < 1e-9, "{truth:?}, {height}, {per_length}: {:?}", found.parameters);
        }
    }
}

#[test]
fn intervals_cover_as_often_as_stated() {
    // For a straight line, 20 points and uniform errors, 95 % intervals should contain the slope in about 95 of 100 cases.
    let mut random = 12345_u64;
    let mut uniform = || {
        random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (random >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let (mut jacobian, mut bootstrapped) = (0, 0);
    for case in 0..200 {
        let y: Vec<f64> = (0..20).map(|i| 1.0 + 2.0 * f64::from(i) + uniform()).collect();
        let problem = Problem {
            parameters: vec![Parameter::free("a", 0.0, (-9.0, 9.0)), Parameter::free("b", 0.0, (-9.0, 9.0))],
            count: 20,
            residuals: &|p, r| (0..20).for_each(|i| r[i] = p[0] + p[1] * i as f64 - y[i]),
            jacobian: None,
        };
        let settings = Settings { method: Method::LevenbergMarquardt, starts: 1, ..Settings::default() };
        let found = fit(&problem, &settings).unwrap();
        let holds = |interval: Interval| usize::from(interval.low <= 2.0 && 2.0 <= interval.high);
        jacobian += holds(found.intervals(0.95).unwrap().unwrap()[1]);
        if case < 60 {
            bootstrapped += holds(bootstrap(&problem, &settings, &found, 100, case, 0.95).unwrap()[1]);
        }
    }
    assert!((181..=198).contains(&jacobian), "{jacobian} of 200");
    assert!((49..=60).contains(&bootstrapped), "{bootstrapped} of 60");
}

#[test]
fn cross_validation_predicts_each_residual_once_and_without_its_group() {
    let problem = misra_problem(None);
    let labels = k_folds(14, 7, 5).unwrap();
    assert!((0..7).all(|label| labels.iter().filter(|l| **l == label).count() == 2));
    let result = cross_validate(&problem, &Settings::default(), &labels).unwrap();
    assert_eq!(result.report.count, 14);
    for fold in &result.folds {
        let mut all = vec![0.0; 14];
        misra(&fold.parameters, &mut all);
        for i in (0..14).filter(|&i| labels[i] == fold.label) {
            assert_eq!(all[i], result.residuals[i]);
        }
        // The same fit to the other twelve, made directly.
        let kept: Vec<usize> = (0..14).filter(|&i| labels[i] != fold.label).collect();
        let by_hand = Problem {
            count: 12,
            residuals: &|p, r| {
                let mut all = vec![0.0; 14];
                misra(p, &mut all);
                kept.iter().zip(r).for_each(|(&i, r)| *r = all[i]);
            },
            ..misra_problem(None)
        };
        let by_hand = fit(&by_hand, &Settings::default()).unwrap();
        assert!((by_hand.parameters[0] / fold.parameters[0] - 1.0).abs() < 1e-6);
    }
    let fitted = fit(&problem, &Settings::default()).unwrap();
    assert!(result.report.rms > fitted.report.rms);
}

#[test]
fn bad_input_names_field_value_and_what_is_allowed() {
    let good = || misra_problem(None);
    let with = |change: &dyn Fn(&mut Problem, &mut Settings)| {
        let (mut problem, mut settings) = (good(), Settings::default());
        change(&mut problem, &mut settings);
        match fit(&problem, &settings) {
            Err(FitError::Invalid(error)) => error.field,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(with(&|p, _| p.parameters[0].start = -1.0), "parameter b1 start");
    assert_eq!(with(&|p, _| p.parameters[1].search = (f64::NAN, 1.0)), "parameter b2 search.0");
    assert_eq!(with(&|p, _| p.parameters[1].search = (2.0, 1.0)), "parameter b2 search");
    assert_eq!(with(&|p, _| p.parameters[0].range = Range::Between { low: 1.0, high: 1.0 }), "parameter b1 range");
    assert_eq!(with(&|p, _| p.parameters.clear()), "parameters.len()");
    assert_eq!(with(&|p, _| p.count = 1), "count");
    assert_eq!(with(&|p, _| p.count = usize::MAX), "count");
    assert_eq!(with(&|_, s| s.tolerance = f64::NAN), "tolerance");
    assert_eq!(with(&|_, s| s.starts = 0), "starts");
    assert_eq!(with(&|_, s| s.max_evaluations = 0), "max_evaluations");
    let fitted = fit(&good(), &Settings::default()).unwrap();
    assert!(fitted.intervals(1.0).is_err() && fitted.intervals(f64::NAN).is_err());
    assert!(k_folds(3, 4, 0).is_err() && k_folds(3, 1, 0).is_err());
    let allowed = "is not allowed; it must be a number of residuals whose labels fit into the memory";
    assert_eq!(k_folds(usize::MAX, 2, 0).unwrap_err().to_string(), format!("count = {} {allowed}", usize::MAX));
    assert!(cross_validate(&good(), &Settings::default(), &[0; 14]).is_err());
    assert!(cross_validate(&good(), &Settings::default(), &[0, 1]).is_err());
    assert!(bootstrap(&good(), &Settings::default(), &fitted, 1, 0, 0.9).is_err());
}

#[test]
fn a_profile_names_the_argument_that_it_refuses() {
    let problem = misra_problem(None);
    let told = |start: [f64; 2], least, rise, step| {
        profile(&problem, &Settings::default(), &start, least, 0, rise, step).unwrap_err().to_string()
    };
    assert!(told([f64::NAN, 1.0], 1.0, 1.0, 1.0).starts_with("parameters[0] = NaN"));
    assert!(told([200.0, 1e-3], f64::INFINITY, 1.0, 1.0).starts_with("least = inf"));
    assert!(told([200.0, 1e-3], 1.0, -1.0, 1.0).starts_with("rise = -1 is not allowed; it must be a number above 0"));
    assert!(told([200.0, 1e-3], 1.0, 1.0, 1e300).starts_with("step = 1"));
}

/// Free parameters in SI units are often small.
#[test]
fn a_free_parameter_may_be_small() {
    let fitted = |scale: f64| {
        let model = |p: f64, i: usize| (p / scale * 0.1 * i as f64).exp();
        let residuals = |p: &[f64], r: &mut [f64]| {
            for (i, r) in r.iter_mut().enumerate() {
                *r = model(p[0], i) - model(3.0 * scale, i) - [1e-3, -1e-3][i % 2];
            }
        };
        let parameters = vec![Parameter::free("rate", 2.9 * scale, (2.0 * scale, 4.0 * scale))];
        let problem = Problem { parameters, count: 20, residuals: &residuals, jacobian: None };
        let found = fit(&problem, &Settings::default()).unwrap();
        let interval = found.intervals(0.95).unwrap().unwrap()[0];
        [found.parameters[0], interval.low, interval.high].map(|value| value / scale)
    };
    for scale in [1e-3, 1e-6, 1e-12] {
        for (small, one) in fitted(scale).into_iter().zip(fitted(1.0)) {
            assert!((small - one).abs() < 1e-9, "{scale}: {small} {one}");
        }
    }
}

/// Neither the units of the coordinates nor a combination that was not observed changes what is known.
#[test]
fn information_does_not_depend_on_units() {
    for unit in [1.0, 1e-9, 1e12] {
        // readings of a slope and a level at 1, 2 and 4
        let rows: Vec<f64> = [1.0, 2.0, 4.0].iter().flat_map(|x| [x * unit, 1.0]).collect();
        let line = Information::of(&rows, 2).unwrap();
        let sds = line.standard_deviations();
        assert!((sds[0] * unit - (3.0f64 / 14.0).sqrt()).abs() < 1e-12 && (sds[1] - 1.5f64.sqrt()).abs() < 1e-12);
        assert!((line.covariance().unwrap()[1] * unit + 0.5).abs() < 1e-12);
        let at_two = line.of_prediction(&[2.0 * unit, 1.0]);
        assert!((at_two * at_two - 5.0 / 14.0).abs() < 1e-12, "{at_two}");
        let apart = Information::of(&[unit, 0.0, 0.0, 1.0], 2).unwrap();
        assert_eq!(apart.standard_deviations(), [unit.recip(), 1.0]);
    }
    // of the level only the sum of two parts was read
    for k in 1..100 {
        let (a, b) = (0.1 * f64::from(k), 0.37 * f64::from(k));
        let readings = Information::of(&[1.0, a, b, 2.0, a, b, 4.0, a, b], 3).unwrap();
        let slope = readings.about(&[0]).unwrap().standard_deviations()[0];
        assert!((slope - (3.0f64 / 14.0).sqrt()).abs() < 1e-12, "{k} {slope}");
        let second = readings.of_prediction(&[2.0, a, b]);
        assert!((second * second - 5.0 / 14.0).abs() < 1e-12, "{k} {second}");
    }
    let sure = Information::of(&[1.0, 1.0], 2).unwrap().with_prior(&[1e-300, 0.0]);
    assert!((sure.standard_deviations()[1] - 1.0).abs() < 1e-12, "{sure:?}");
}

#[test]
fn the_report_of_residuals_is_right() {
    let report = Residuals::of(&[-3.0, 1.0, 2.0, 0.0]);
    assert_eq!((report.count, report.mean, report.max_abs, report.median_abs), (4, 0.0, 3.0, 1.0));
    assert!((report.rms - 3.5_f64.sqrt()).abs() < 1e-15);
    assert_eq!(Residuals::of(&[]).count, 0);
}

/// Intervals by likelihood profile contain a share next to either end of its range as often as stated, or more often.
#[test]
fn profile_intervals_hold_next_to_the_ends_of_a_range() {
    let times: Vec<f64> = (0..12).map(|i| f64::from(i) / 11.0).collect();
    let mut state = 5_u64;
    let mut uniform = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((state >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    };
    let mut normal = || (-2.0 * uniform().ln()).sqrt() * (std::f64::consts::TAU * uniform()).cos();
    for truth in [0.0, 0.02, 0.5, 0.98, 1.0] {
        let (mut held, mut lengths) = (0, 0.0);
        for _ in 0..200 {
            let data: Vec<f64> = times.iter().map(|t| truth * t + 1.0 + 0.1 * normal()).collect();
            let residuals = |p: &[f64], r: &mut [f64]| {
                r.iter_mut().zip(times.iter().zip(&data)).for_each(|(r, (t, y))| *r = p[0] * t + p[1] - y);
            };
            let range = Range::Between { low: 0.0, high: 1.0 };
            let share = Parameter { name: "share".into(), start: 0.3, range, search: (0.01, 0.99) };
            let problem = Problem {
                parameters: vec![share, Parameter::free("level", 0.5, (-3.0, 3.0))],
                count: 12,
                residuals: &residuals,
                jacobian: None,
            };
            let settings = Settings::default();
            let found = fit(&problem, &settings).unwrap();
            let interval = profile_intervals(&problem, &settings, &found, 0.9).unwrap().unwrap()[0];
            held += u32::from(interval.low <= truth && truth <= interval.high);
            lengths += interval.high - interval.low;
        }
        // three standard deviations below 90 % and above 95 %
        assert!((168..=199).contains(&held), "{truth}: {held} of 200");
        assert!(lengths / 200.0 < 0.4, "{truth}: mean length {}", lengths / 200.0);
    }
}
