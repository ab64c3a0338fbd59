//! The law of the example `own_law`, with two internal variables, compared with an integration of its flow rule.

#[path = "../examples/own_law/hardening.rs"]
mod hardening;

use crate::common::{Intervals, ball, dormand_prince_until, pinned, settings};
use contact_models::{TracePoint, check_contract, trace};
use hardening::Hardening;
use std::f64::consts::PI;
use vibroimpact_sim::assembly::{self, Assembly, Body, BodyMode, Contact, Outcome, Point, run};
use vibroimpact_sim::modal::{Parameter, Posing, Solver, Start, Striker};

/// Little kinematic hardening, and so much that the contact yields in unloading before it opens.
fn laws() -> [Hardening; 2] {
    let mild = Hardening { stiffness_n_m: 2e7, yield_force_n: 100.0, kinematic_n_m: 1e6, isotropic_n_m: 2e6 };
    [mild, Hardening { yield_force_n: 20.0, kinematic_n_m: 1e7, isotropic_n_m: 5e5, ..mild }]
        .map(|law| law.validated().unwrap())
}

/// A contact by the flow rule alone.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Flow {
    Open,
    Elastic,
    Yields(f64),
}

/// Modes and contacts: overlaps are `psi a - gap`, and in addition to the modes each contact has an indentation and a yield
/// force.
struct Reference {
    modes: Vec<BodyMode>,
    contacts: Vec<(Vec<f64>, f64, Hardening)>,
}

impl Reference {
    /// Overlap and rate of a contact, its indentation and its yield force.
    fn seen(&self, c: usize, y: &[f64]) -> (f64, f64, f64, f64) {
        let (psi, gap, _) = &self.contacts[c];
        let n = self.modes.len();
        let dot = |values: &[f64]| psi.iter().zip(values).map(|(psi, value)| psi * value).sum::<f64>();
        (dot(&y[..n]) - gap, dot(&y[n..2 * n]), y[2 * n + 2 * c], y[2 * n + 2 * c + 1])
    }

    /// Force, and its distances from the limits of the elastic range.
    fn force(&self, c: usize, y: &[f64]) -> (f64, f64, f64) {
        let law = &self.contacts[c].2;
        let (xi, _, p, yields) = self.seen(c, y);
        let (force, back) = (law.stiffness_n_m * (xi - p), law.kinematic_n_m * p);
        (force, back + yields - force, force - (back - yields))
    }

    fn slope(&self, flows: &[Flow], y: &[f64], dy: &mut [f64]) {
        let n = self.modes.len();
        for (k, mode) in self.modes.iter().enumerate() {
            dy[k] = y[n + k];
            dy[n + k] = -2.0 * mode.damping_ratio * mode.omega_rad_s * y[n + k] - mode.omega_rad_s.powi(2) * y[k];
        }
        for (c, flow) in flows.iter().enumerate() {
            let (psi, _, law) = &self.contacts[c];
            (dy[2 * n + 2 * c], dy[2 * n + 2 * c + 1]) = (0.0, 0.0);
            if *flow == Flow::Open {
                continue;
            }
            let force = self.force(c, y).0;
            (0..n).for_each(|k| dy[n + k] -= psi[k] * force);
            if let Flow::Yields(_) = flow {
                // The force stays at the limit of its range.
                let all = law.stiffness_n_m + law.kinematic_n_m + law.isotropic_n_m;
                let flows = law.stiffness_n_m / all * self.seen(c, y).1;
                (dy[2 * n + 2 * c], dy[2 * n + 2 * c + 1]) = (flows, law.isotropic_n_m * flows.abs());
            }
        }
    }

    /// The next state of a contact here.
    fn next(&self, c: usize, flow: Flow, y: &[f64]) -> Option<Flow> {
        let (xi, rate, p, _) = self.seen(c, y);
        let (force, above, below) = self.force(c, y);
        match flow {
            Flow::Open => (xi > p).then_some(Flow::Elastic),
            _ if force < 0.0 => Some(Flow::Open),
            Flow::Elastic if above < 0.0 && rate > 0.0 => Some(Flow::Yields(1.0)),
            Flow::Elastic if below < 0.0 && rate < 0.0 => Some(Flow::Yields(-1.0)),
            Flow::Yields(side) if side * rate < 0.0 => Some(Flow::Elastic),
            _ => None,
        }
    }

    /// The state at the end, and the numbers of closures and of yielding in loading and in unloading.
    fn run(&self, modes: &[f64], end_s: f64, tolerance: f64) -> (Vec<f64>, [usize; 3]) {
        let n = self.modes.len();
        let mut y = modes.to_vec();
        self.contacts.iter().for_each(|(_, _, law)| y.extend([0.0, law.yield_force_n]));
        let scale = |i: usize| match i {
            _ if i < n => 1e-5,
            _ if i < 2 * n => 1.0,
            _ if (i - 2 * n).is_multiple_of(2) => 1e-5,
            _ => 100.0,
        };
        let mut flows = vec![Flow::Open; self.contacts.len()];
        let (mut time_s, mut seen) = (0.0, [0; 3]);
        while time_s < end_s {
            let met = |y: &[f64]| (0..flows.len()).any(|c| self.next(c, flows[c], y).is_some());
            let slope = |_: f64, y: &[f64], dy: &mut [f64]| self.slope(&flows, y, dy);
            time_s = dormand_prince_until(slope, scale, &mut y, (time_s, end_s, 1e-8), tolerance, met);
            for c in 0..flows.len() {
                let Some(next) = self.next(c, flows[c], &y) else { continue };
                match (flows[c], next) {
                    (Flow::Open, _) => seen[0] += 1,
                    (_, Flow::Yields(side)) => seen[if side > 0.0 { 1 } else { 2 }] += 1,
                    _ => {}
                }
                flows[c] = next;
            }
        }
        (y, seen)
    }
}

/// A ball on a beam of four modes: velocity of the ball, contacts and indentation agree with the flow rule.
#[test]
fn an_impact_follows_the_flow_rule() {
    let (structure, ball) = (pinned(4, 0.02, 0.3), ball());
    let mut backwards = 0;
    for law in laws() {
        let solver = Solver::new(&structure).unwrap();
        let (solution, history) = solver.record(&ball, &law, None, &settings(1e-11)).unwrap();
        let root = ball.mass_kg.sqrt();
        let mut psi = vec![-1.0 / root];
        psi.extend(structure.modes.iter().map(|mode| mode.shape));
        let mut modes = vec![BodyMode { omega_rad_s: 0.0, damping_ratio: 0.0 }];
        modes.extend(
            structure.modes.iter().map(|m| BodyMode { omega_rad_s: m.omega_rad_s, damping_ratio: m.damping_ratio }),
        );
        let reference = Reference { modes, contacts: vec![(psi, 0.0, law)] };
        let mut start = vec![0.0; 10];
        start[5] = -root * ball.speed_m_s;
        let end_s = solution.end_s + 1e-6;
        let (y, seen) = reference.run(&start, end_s, 1e-13);
        let (rough, _) = reference.run(&start, end_s, 1e-12);
        let e = |y: &[f64]| y[5] / root / ball.speed_m_s;
        let allowed = 1e-9 + 3.0 * (e(&y) - e(&rough)).abs();
        assert!(allowed < 1e-7, "{allowed:e}");
        let found = solution.restitution.unwrap();
        assert!((found - e(&y)).abs() < allowed, "{found} {} {allowed:e} {seen:?}", e(&y));
        assert_eq!(solution.sub_impacts.len(), seen[0]);
        assert!(seen[1] > 0);
        backwards += seen[2];
        // Where the last contact opens, the compression equals the indentation.
        let left_m = history.at(solution.end_s).compression_m;
        assert!((left_m - y[10]).abs() < 1e-6 * y[10], "{left_m:e} {:e}", y[10]);
        assert!(history.times(end_s, 50).iter().all(|time| history.at(*time).force_n.is_finite()));
    }
    assert!(backwards > 0);
}

/// A ball between a beam and a stop, both of which it indents.
#[test]
fn two_contacts_follow_the_flow_rule() {
    let structure = pinned(3, 0.02, 0.4);
    let [mild, strong] = laws();
    let (root, shape) = (0.1f64.sqrt(), structure.modes.iter().map(|mode| mode.shape).collect::<Vec<f64>>());
    let modes: Vec<BodyMode> = structure
        .modes
        .iter()
        .map(|m| BodyMode { omega_rad_s: m.omega_rad_s, damping_ratio: m.damping_ratio })
        .collect();
    let of_ball = Point::OfBody { body: 0, shape: vec![1.0 / root] };
    let of_beam = Point::OfBody { body: 1, shape: shape.clone() };
    let posed: Assembly<Hardening> = Assembly {
        bodies: vec![Body::mass(0.1, 0.0, -1.0), Body::at_rest(modes.clone())],
        contacts: vec![
            Contact { sides: [of_ball.clone(), of_beam], gap_m: 0.0, law: strong },
            Contact { sides: [Point::Ground, of_ball], gap_m: 1e-4, law: mild },
        ],
        loads: vec![],
    };
    let end_s = 2e-3;
    let mut wanted = assembly::Settings::until(end_s);
    wanted.tolerance = 1e-11;
    let mut intervals = Intervals::default();
    let found = run(&posed, &wanted, &mut intervals).unwrap();
    assert_eq!(found.outcome, Outcome::End);
    assert!((0..2).all(|c| intervals.0.iter().any(|(contact, _)| *contact == c)), "{:?}", intervals.0);

    let mut all = vec![BodyMode { omega_rad_s: 0.0, damping_ratio: 0.0 }];
    all.extend(modes);
    let on_beam = std::iter::once(-1.0 / root).chain(shape).collect();
    let on_stop = vec![1.0 / root, 0.0, 0.0, 0.0];
    let reference = Reference { modes: all, contacts: vec![(on_beam, 0.0, strong), (on_stop, 1e-4, mild)] };
    let mut start = vec![0.0; 8];
    start[4] = -root;
    let (y, seen) = reference.run(&start, end_s, 1e-13);
    let (rough, _) = reference.run(&start, end_s, 1e-12);
    let rates = found.rate.concat();
    for (k, rate) in rates.into_iter().enumerate() {
        let allowed = 1e-9 + 3.0 * (y[4 + k] - rough[4 + k]).abs();
        assert!(allowed < 1e-7 && (rate - y[4 + k]).abs() < allowed, "{k} {rate} {} {allowed:e}", y[4 + k]);
    }
    assert_eq!(intervals.0.len(), seen[0]);
    assert!(seen[1] > 0 && seen[2] > 0, "{seen:?}");
}

/// The law has the properties that a solver requires, and its motions reach all three kinds of branches.
#[test]
fn the_law_keeps_its_contract() {
    for law in laws() {
        for (compression_m, speed_m_s) in [(1e-6, 0.1), (2e-5, 1.0), (1e-3, 10.0)] {
            let kept = check_contract(&law, compression_m, speed_m_s);
            assert!(kept.is_ok(), "{law:?} {compression_m} {}", kept.unwrap_err());
        }
    }
    // If it is pressed twice to the same depth, the law with strong hardening yields in unloading at the end of each press, and
    // in loading again.
    let times: Vec<f64> = (0..=400).map(|i| f64::from(i) / 100.0).collect();
    let press = |t: f64| (5e-5 * (PI * t).sin(), 5e-5 * PI * (PI * t).cos());
    let path = trace(&laws()[1], &times, press).unwrap();
    let lost = |time: f64| path.iter().find(|point: &&TracePoint| point.time_s == time).unwrap().work_j;
    assert!(lost(1.5) > 0.0 && lost(3.5) > lost(1.5) + 0.01 * lost(1.5));
}

/// Derivatives include the indentation and the yield force from contact to contact.
#[test]
fn derivatives_follow_the_internal_variables() {
    let offsets = [-2e-4, -1e-4, 1e-4, 2e-4];
    let structure = pinned(4, 0.02, 0.3);
    let start = Start::at_rest(4);
    for law in laws() {
        let strikers = offsets.map(|by| Striker { speed_m_s: 1.0 + by, ..ball() });
        let softer = offsets.map(|by| Hardening { isotropic_n_m: law.isotropic_n_m * (1.0 + by), ..law });
        let sooner = offsets.map(|by| Hardening { yield_force_n: law.yield_force_n * (1.0 + by), ..law });
        let of = |striker, law| Posing { structure: &structure, striker, law, start: &start, gravity_m_s2: 0.0 };
        let at = [ball(); 4];
        let parameters = [
            Parameter { offsets, neighbours: strikers.each_ref().map(|striker| of(striker, &law)), changes_law: false },
            Parameter { offsets, neighbours: std::array::from_fn(|i| of(&at[i], &softer[i])), changes_law: true },
            Parameter { offsets, neighbours: std::array::from_fn(|i| of(&at[i], &sooner[i])), changes_law: true },
        ];
        let solver = Solver::new(&structure).unwrap();
        let found = solver.differentiate(&ball(), &law, None, &settings(1e-11), &parameters).unwrap();
        let derivatives: Vec<_> = found.derivatives.into_iter().collect::<Result<_, _>>().unwrap();
        let restitution = |striker: &Striker, law: &Hardening| {
            solver.solve(striker, law, None, &settings(1e-12)).unwrap().restitution.unwrap()
        };
        let differences = [
            strikers.each_ref().map(|striker| restitution(striker, &law)),
            softer.each_ref().map(|law| restitution(&ball(), law)),
            sooner.each_ref().map(|law| restitution(&ball(), law)),
        ];
        for (derivative, [a, b, c, d]) in derivatives.iter().zip(differences) {
            let slope = (a - 8.0 * b + 8.0 * c - d) / (12.0 * 1e-4);
            let error = (derivative.restitution.value - slope).abs();
            assert!(error < 1e-6 * (1.0 + slope.abs()), "{:?} {slope}", derivative.restitution);
        }
        assert!(derivatives.iter().all(|derivative| derivative.restitution.value != 0.0));
    }
}
