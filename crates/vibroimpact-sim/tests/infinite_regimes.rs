//! Regimes, turning points and limits of the impact on an infinite beam and plate.

use vibroimpact_sim::StopReason;
use vibroimpact_sim::infinite::{
    Outcome, Settings, Structure, attached, critical_s, displacement_eq_2_47, solve, turning_point, turning_points,
};

/// Thesis 2.5, list of turning points.
const THESIS: [f64; 12] = [3.528e4, 5.219e2, 74.391, 22.403, 10.185, 6.030, 4.238, 3.328, 2.808, 2.485, 2.271, 2.121];

fn once() -> Settings {
    Settings { estimate_uncertainty: false, ..Settings::default() }
}

fn separations(s: f64) -> usize {
    let solution = solve(Structure::Beam, s, &once()).unwrap();
    assert!(!matches!(solution.outcome, Outcome::Stopped(_)), "{:?}", solution.outcome);
    solution.separations()
}

/// The numbers of separations: one contact below the critical S, the thesis's examples above it, and never an increase with S.
#[test]
fn numbers_of_separations() {
    for (s, count) in [(15.0, 4), (1e3, 1), (1e5, 0), (4e5, 0), (1e8, 0), (1e10, 0), (1.6, 33)] {
        assert_eq!(separations(s), count, "S = {s}");
    }
    for k in 0..=24 {
        let s = 10f64.powf(-12.0 + 0.5 * f64::from(k));
        let solution = solve(Structure::Beam, s, &once()).unwrap();
        assert_eq!((solution.outcome, solution.separations()), (Outcome::Rebound, 1), "S = {s}");
        assert!(solution.rebound_ratio().unwrap() > 0.0);
    }
    let mut last = usize::MAX;
    for k in 0..75 {
        let s = 1.7 * 10f64.powf(0.13 * f64::from(k));
        let solution = solve(Structure::Beam, s, &once()).unwrap();
        assert_eq!(solution.outcome, Outcome::Sustained, "S = {s}");
        assert!(solution.rebound_ratio().is_none() && solution.separations() <= last);
        last = solution.separations();
    }
}

/// The critical S to 12 digits, and within 0.1 % of the thesis; one contact below it, many above.
#[test]
fn critical_value() {
    let critical = critical_s();
    assert!(critical.uncertainty < 1e-12 * critical.s);
    assert!((critical.s / 1.559 - 1.0).abs() < 1e-3);
    let below = solve(Structure::Beam, critical.s * (1.0 - 1e-9), &once()).unwrap();
    assert_eq!((below.outcome, below.separations()), (Outcome::Rebound, 1));
    let ratio = below.rebound_ratio().unwrap();
    assert!(ratio > 1e-11 && ratio < 1e-10);
    // Just above, the second contact begins at a time that grows as the inverse square of the speed.
    let above = solve(Structure::Beam, critical.s * (1.0 + 1e-9), &Settings { max_panels: 200, ..once() }).unwrap();
    let speed = -above.sub_impacts[0].striker_velocity_at_end.unwrap();
    assert!((speed / ratio - 1.0).abs() < 1e-4, "{speed} {ratio}");
    assert!((above.sub_impacts[1].start * speed * speed - 1.0).abs() < 1e-4);
    assert!(above.sub_impacts.len() > 5);
}

/// Very close to the critical S the speed of the body decreases, contact by contact, far below the rounding error of its
/// initial speed; no rebound is invented and no digit is lost.
#[test]
fn close_to_the_critical_value() {
    let s = critical_s().s * (1.0 + 1e-7);
    let run = |nodes: usize| solve(Structure::Beam, s, &Settings { nodes, max_panels: 600, ..once() }).unwrap();
    let (solution, other) = (run(20), run(24));
    assert_eq!(solution.outcome, Outcome::Stopped(StopReason::Steps));
    assert!(solution.sub_impacts.len() > 60);
    for (a, b) in solution.sub_impacts.iter().zip(&other.sub_impacts) {
        assert!((a.closing_speed / b.closing_speed - 1.0).abs() < 1e-5, "{a:?} {b:?}");
        assert!(a.striker_velocity_at_end.is_none_or(|velocity| velocity < 0.0));
    }
    for pair in solution.sub_impacts.windows(2) {
        assert!(pair[1].closing_speed < pair[0].closing_speed && pair[1].start > pair[0].start);
    }
    // A thousandth above it, all of them are found.
    let all = solve(Structure::Beam, critical_s().s * 1.001, &Settings::default()).unwrap();
    assert_eq!((all.outcome, all.separations()), (Outcome::Sustained, 120));
    assert!(all.relative_uncertainty.unwrap() < 1e-9, "{:?}", all.relative_uncertainty);
}

/// The first 12 turning points to 10 digits and more, and within 0.1 % of the thesis; just below each there is one separation
/// more than just above.
#[test]
fn turning_points_of_the_thesis() {
    let points = turning_points(12).unwrap();
    for (point, printed) in points.iter().zip(THESIS) {
        assert!((point.s / printed - 1.0).abs() < 1e-3, "{point:?} {printed}");
        assert!(point.uncertainty < 1e-10 * point.s, "{point:?}");
        assert_eq!(separations(point.s * (1.0 - 1e-9)), point.n, "{point:?}");
        assert_eq!(separations(point.s * (1.0 + 1e-9)), point.n - 1, "{point:?}");
    }
    let alone = turning_point(7).unwrap();
    assert!((alone.s - points[6].s).abs() <= alone.uncertainty + points[6].uncertainty);
}

/// Up to n = 33 and 34, which enclose S = 1.6 with its 33 separations.
#[test]
fn late_turning_points() {
    let (a, b) = (turning_point(33).unwrap(), turning_point(34).unwrap());
    assert!(a.s > 1.6 && b.s < 1.6);
    assert!(a.uncertainty < 1e-10 && b.uncertainty < 1e-10);
    assert!(critical_s().s < b.s);
}

/// S to 0: the limit is Hertz contact with a rigid support (closed form), with an error of S^(1/10).
#[test]
fn rigid_limit() {
    let distance = |s: f64| {
        let solution = solve(Structure::Beam, s, &once()).unwrap();
        let unit = s.powf(-0.2);
        let duration = solution.sub_impacts[0].duration.unwrap() / unit / 3.218_065_459_719_043;
        let largest = solution.extrema[0].compression / unit / 1.093_362_073_943_278;
        (duration - 1.0, largest - 1.0, 1.0 - solution.rebound_ratio().unwrap())
    };
    let (far, close) = (distance(1e-10), distance(1e-12));
    let expected = 10f64.powf(-0.2);
    for ratio in [close.0 / far.0, close.1 / far.1, close.2 / far.2] {
        assert!((ratio / expected - 1.0).abs() < 0.1, "{ratio} {expected}");
    }
}

/// Sustained contact ends on Eq. 2.47 for any number of separations, and the attached body is the limit of large S.
#[test]
fn large_time_asymptotics() {
    for s in [15.0, 1e3, 1e5] {
        let solution = solve(Structure::Beam, s, &Settings { horizon: 3000.0, ..once() }).unwrap();
        let error = |t: f64| (solution.at(t).unwrap().striker_displacement + displacement_eq_2_47(t)).abs();
        assert!(error(3000.0) < 2e-3, "{s}: {}", error(3000.0));
        let now = solution.at(3000.0).unwrap();
        assert!((now.force / attached(Structure::Beam, 3000.0).force - 1.0).abs() < 2e-2, "{s}: {now:?}");
    }
    let distance = |s: f64| {
        let state = solve(Structure::Beam, s, &Settings { horizon: 2.0, ..once() }).unwrap().at(2.0).unwrap();
        (state.striker_velocity + attached(Structure::Beam, 2.0).speed).abs()
    };
    assert!(distance(1e8) < 2e-3 && distance(1e8) < 0.2 * distance(1e5) && distance(1e10) < 0.4 * distance(1e8));
}

/// A plate is a dashpot: there is one contact for any S, and the motion satisfies u' = -f, x' = u - f, here integrated by the
/// classical Runge-Kutta method.
#[test]
fn plate_always_rebounds_once() {
    for k in -6..=5 {
        let s = 10f64.powi(2 * k);
        let solution = solve(Structure::Plate, s, &Settings::default()).unwrap();
        assert_eq!((solution.outcome, solution.separations()), (Outcome::Rebound, 1));
        // the harder the contact, the sooner the plate carries the body along: the ratio falls as 1/S
        assert!(s < 1e4 || (s * solution.rebound_ratio().unwrap() / 0.679293 - 1.0).abs() < 1e-3, "{s}: {solution:?}");
        if !(1e-4..=1e4).contains(&s) {
            continue;
        }
        let force = |x: f64| s.sqrt() * x.max(0.0).powf(1.5);
        let rate = |x: f64, u: f64| (u - force(x), -force(x));
        let h = solution.sub_impacts[0].duration.unwrap() / 40_000.0;
        let (mut x, mut u, mut t) = (0.0, 1.0, 0.0);
        loop {
            let (a, b) = rate(x, u);
            let (c, d) = rate(x + 0.5 * h * a, u + 0.5 * h * b);
            let (e, f) = rate(x + 0.5 * h * c, u + 0.5 * h * d);
            let (g, i) = rate(x + h * e, u + h * f);
            let next = x + h / 6.0 * (a + 2.0 * c + 2.0 * e + g);
            u += h / 6.0 * (b + 2.0 * d + 2.0 * f + i);
            if next <= 0.0 {
                t += h * x / (x - next);
                break;
            }
            (x, t) = (next, t + h);
        }
        assert!((t / solution.sub_impacts[0].duration.unwrap() - 1.0).abs() < 1e-7, "{s}");
        assert!((-u / solution.rebound_ratio().unwrap() - 1.0).abs() < 1e-6, "{s}");
    }
}

/// Contact that is declared to last does last if it is computed twenty times further, also next to turning points, where the
/// compression once nearly vanished.
#[test]
fn sustained_contact_lasts() {
    let points = turning_points(6).unwrap();
    let near = points.iter().flat_map(|point| [point.s * (1.0 - 1e-6), point.s * (1.0 + 1e-6)]);
    for s in near.chain([2.0, 15.0, 100.0, 1e3, 1e5, 1e8, 1e10]) {
        let first = solve(Structure::Beam, s, &once()).unwrap();
        let further = Settings { horizon: 20.0 * first.known_until, ..once() };
        let second = solve(Structure::Beam, s, &further).unwrap();
        assert_eq!(second.outcome, Outcome::Sustained);
        assert!(second.known_until >= further.horizon);
        assert_eq!(first.separations(), second.separations(), "S = {s}");
    }
}

/// Any valid settings give the same contacts, without panic.
#[test]
fn settings_do_not_change_the_outcome() {
    for structure in [Structure::Beam, Structure::Plate] {
        for s in [1e-12, 1.5, 2.5, 300.0, 3e4, 1e8, 1e10] {
            let default = solve(structure, s, &once()).unwrap();
            for (nodes, tolerance) in [(8, 1e-3), (8, 1e-9), (13, 1e-8), (20, 1e-14), (32, 1e-3), (32, 1e-14)] {
                let other = solve(structure, s, &Settings { nodes, tolerance, ..once() }).unwrap();
                assert_eq!(other.outcome, default.outcome, "{structure:?} {s} {nodes} {tolerance}");
                assert_eq!(other.separations(), default.separations(), "{structure:?} {s} {nodes} {tolerance}");
            }
        }
    }
}

/// A stiff contact with a plate leaves the body a speed that falls as `1/S`: it keeps its digits, at every tolerance and number of
/// nodes, without panels that resolve rounding (28 nodes at 1e-14 took 200,000).
#[test]
fn a_stiff_contact_with_a_plate_keeps_its_digits() {
    for nodes in [8, 16, 20, 24, 28, 32] {
        for tolerance in [1e-10, 1e-14] {
            let solution =
                solve(Structure::Plate, 1e10, &Settings { nodes, tolerance, ..Settings::default() }).unwrap();
            let ratio = 1e10 * solution.rebound_ratio().unwrap();
            let allowed = if tolerance < 1e-12 { 1e-12 } else { 2e-9 };
            assert!((ratio / 0.679_293_063_936_485 - 1.0).abs() < allowed, "{nodes} {tolerance:e}: {ratio}");
            assert!((solution.sub_impacts[0].duration.unwrap() / 22.667_876_556_314_86 - 1.0).abs() < allowed);
            assert!(solution.panels_tried < 2_000, "{nodes} {tolerance:e}: {}", solution.panels_tried);
        }
    }
}

/// Input out of range is reported, not computed.
#[test]
fn bad_input_is_refused() {
    for s in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-13, 1e11] {
        assert_eq!(solve(Structure::Beam, s, &once()).unwrap_err().field, "s");
    }
    for (settings, field) in [
        (Settings { nodes: 7, ..once() }, "nodes"),
        (Settings { tolerance: f64::NAN, ..once() }, "tolerance"),
        (Settings { horizon: f64::INFINITY, ..once() }, "horizon"),
        (Settings { max_panels: 0, ..once() }, "max_panels"),
    ] {
        assert_eq!(solve(Structure::Beam, 1.0, &settings).unwrap_err().field, field);
    }
    assert_eq!(turning_point(0).unwrap_err().field, "n");
    assert_eq!(turning_points(61).unwrap_err().field, "count");
    let cut = solve(Structure::Beam, 15.0, &Settings { max_panels: 12, ..once() }).unwrap();
    assert_eq!(cut.outcome, Outcome::Stopped(StopReason::Steps));
    assert!(cut.at(-1.0).is_none() && cut.at(f64::NAN).is_none() && cut.at(1e9).is_none());
}
