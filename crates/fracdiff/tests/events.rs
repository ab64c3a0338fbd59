//! Events: located on the solution, with direction, terminal or not.

use fracdiff::test_problems::{self, LINEAR_BEAM_ZERO, RIGID_CONTACT_END};
use fracdiff::{Collocation, Convolution, Direction, Event, Method, Stop, SumOfExponentials, Volterra};

fn collocation() -> Method {
    Method::Collocation(Collocation::default())
}

fn linear_beam<'a>() -> Volterra<'a> {
    test_problems::linear_beam().volterra
}

#[test]
fn first_zero_of_the_linear_beam_to_thirteen_digits() {
    let problem = linear_beam().with_event(Event::new(|_, y| y[0]).terminal());
    let solution = problem.solve(&collocation(), 10.0).unwrap();
    assert_eq!(solution.stop, Stop::Event { index: 0 });
    let hit = &solution.events[0];
    println!("{:e}", hit.t - LINEAR_BEAM_ZERO.0);
    assert!((hit.t - LINEAR_BEAM_ZERO.0).abs() < 1e-13, "{}", hit.t);
    assert!(!hit.rising && hit.y[0].abs() < 1e-14);
    // The solution ends there, and its slope is the known one.
    assert_eq!(solution.end_time(), hit.t);
    assert!(solution.at(hit.t + 1e-9).is_err());
    let h = 1e-3;
    let at = |t: f64| solution.at(t).unwrap()[0];
    let slope = (3.0 * at(hit.t) - 4.0 * at(hit.t - h) + at(hit.t - 2.0 * h)) / (2.0 * h);
    assert!((slope - LINEAR_BEAM_ZERO.1).abs() < 1e-5, "{slope}");
}

#[test]
fn other_methods_find_it_to_their_order() {
    let zero = |method: Method| {
        let problem = linear_beam().with_event(Event::new(|_, y| y[0]).terminal());
        let solution = problem.solve(&method, 10.0).unwrap();
        assert_eq!(solution.stop, Stop::Event { index: 0 });
        (solution.events[0].t - LINEAR_BEAM_ZERO.0).abs()
    };
    let order = |method: fn(usize) -> Method| 0.5 * (zero(method(1000)) / zero(method(4000))).log2();
    let trapezoidal = order(|steps| Method::Trapezoidal(Convolution { steps }));
    assert!((trapezoidal - 2.0).abs() < 0.1, "{trapezoidal}");
    let grunwald = order(|steps| Method::GrunwaldLetnikov(Convolution { steps }));
    assert!((grunwald - 1.0).abs() < 0.1, "{grunwald}");
    let exponentials = order(|steps| Method::SumOfExponentials(SumOfExponentials { steps, ..Default::default() }));
    assert!((exponentials - 2.0).abs() < 0.2, "{exponentials}");
}

#[test]
fn every_zero_of_a_cosine_and_their_directions() {
    // y'' = -y, y(0) = 1: y = 1 - int (t-s) y ds
    let cosine = || Volterra::scalar(|_| 1.0, |_, y| y, &[(2.0, -1.0)]);
    let zeros = |direction| {
        let problem = cosine().with_event(Event::new(|_, y| y[0]).direction(direction));
        problem.solve(&collocation(), 40.0).unwrap().events
    };
    let all = zeros(Direction::Any);
    assert_eq!(all.len(), 13);
    for (i, hit) in all.iter().enumerate() {
        let exact = std::f64::consts::PI * (i as f64 + 0.5);
        assert!((hit.t - exact).abs() < 1e-11, "{i}: {:e}", hit.t - exact);
        assert_eq!(hit.rising, i % 2 == 1);
    }
    assert_eq!(zeros(Direction::Rising).len(), 6);
    assert_eq!(zeros(Direction::Falling).len(), 7);
}

#[test]
fn separation_of_a_rigid_contact() {
    let problem = test_problems::rigid_contact().volterra.with_event(Event::new(|_, y| y[0]));
    let solution = problem.solve(&collocation(), 5.0).unwrap();
    // x(0) = 0 is a start, not an event.
    assert_eq!(solution.events.len(), 1);
    let hit = &solution.events[0];
    assert!((hit.t - RIGID_CONTACT_END).abs() < 1e-11, "{:e}", hit.t - RIGID_CONTACT_END);
    let speed = solution.at(5.0).unwrap()[0] - solution.at(4.0).unwrap()[0];
    assert!((speed + 1.0).abs() < 1e-11, "{speed}");
}

#[test]
fn a_jump_over_zero_is_found_at_its_break() {
    // y = g jumps from 1 to -1 at t = 0.3
    let problem = Volterra::scalar(|t| if t < 0.3 { 1.0 } else { -1.0 }, |_, _| 0.0, &[(0.5, 1.0)])
        .with_breaks(&[0.3])
        .with_event(Event::new(|_, y| y[0]));
    for method in [collocation(), Method::Trapezoidal(Convolution { steps: 50 })] {
        let solution = problem.solve(&method, 1.0).unwrap();
        assert_eq!(solution.events.len(), 1, "{}", method.name());
        assert!((solution.events[0].t - 0.3).abs() < 1e-12);
        assert!((solution.at(0.3).unwrap()[0] - 1.0).abs() < 1e-15);
        assert!((solution.at(0.3000001).unwrap()[0] + 1.0).abs() < 1e-12);
    }
}

#[test]
fn four_separations_of_a_ball_on_an_infinite_beam() {
    let events = |tolerance: f64| {
        let problem = test_problems::ball_on_beam(15.0).with_event(Event::new(|_, y| y[0]));
        let method = Method::Collocation(Collocation { tolerance, ..Default::default() });
        let solution = problem.solve(&method, 200.0).unwrap();
        assert_eq!(solution.stop, Stop::EndReached);
        solution.events
    };
    // Separation and contact alternate, with sustained contact after the fourth (thesis Fig. 2.3).
    let (fine, coarse) = (events(1e-12), events(1e-9));
    assert_eq!((fine.len(), coarse.len()), (8, 8));
    assert!(fine.iter().enumerate().all(|(i, hit)| hit.rising == (i % 2 == 1)));
    for (a, b) in fine.iter().zip(&coarse) {
        assert!((a.t / b.t - 1.0).abs() < 1e-6, "{} {}", a.t, b.t);
    }
    // The first separation by an independent method, extrapolated from second order.
    let first = |steps| {
        let problem = test_problems::ball_on_beam(15.0).with_event(Event::new(|_, y| y[0]).terminal());
        problem.solve(&Method::Trapezoidal(Convolution { steps }), 2.0).unwrap().events[0].t
    };
    let extrapolated = (4.0 * first(4000) - first(2000)) / 3.0;
    assert!((extrapolated - fine[0].t).abs() < 1e-8, "{extrapolated} {}", fine[0].t);
}
