//! Strikers that fall on a structure, and rise by what a drop test would measure.

use crate::common::random::{Impact, config, ordinary_impact};
use crate::common::{ball, hertz, pinned, second_method_under, settings};
use contact_models::{Hertz, KelvinVoigt, Law, LinearSpring};
use proptest::prelude::*;
use vibroimpact_sim::modal::{
    Derivatives, Mode, Outcome, Parameter, Posing, Settings, Solution, Solver, Start, Stencil, Striker, Structure,
};

const GRAVITY_M_S2: f64 = 9.81;
/// Half of the time over which a difference of velocities is an acceleration (s).
const MOMENT_S: f64 = 1e-7;

fn falls(structure: &Structure, striker: &Striker, law: &Law, start: Option<&Start>, tolerance: f64) -> Solution {
    let solver = Solver::new(structure).unwrap().under_gravity(GRAVITY_M_S2).unwrap();
    solver.solve(striker, law, start, &settings(tolerance)).unwrap()
}

/// A ball that lies on the beam for a while, and is thrown up in the end.
fn beam() -> (Structure, Striker, Law) {
    (pinned(20, 0.01, 0.3), Striker { mass_kg: 0.263, speed_m_s: 1.0 }, hertz())
}

#[test]
fn a_rigid_structure_without_losses_returns_the_ball_to_where_it_came_from() {
    let rigid = Structure::default();
    let found = falls(&rigid, &ball(), &hertz(), None, 1e-9);
    assert_eq!((found.outcome, found.sub_impacts.len()), (Outcome::Rebound, 1));
    assert!((found.restitution.unwrap() - 1.0).abs() < 1e-9, "{found:?}");
    // dropped from rest at 50 mm, and thrown up at first
    for speed_m_s in [0.0, -0.5] {
        let start = Start { gap_m: 0.05, ..Start::at_rest(0) };
        let striker = Striker { speed_m_s, ..ball() };
        let found = falls(&rigid, &striker, &hertz(), Some(&start), 1e-9);
        assert_eq!(found.outcome, Outcome::Rebound, "{found:?}");
        let arrives = (speed_m_s * speed_m_s + 2.0 * GRAVITY_M_S2 * 0.05).sqrt();
        assert!((found.restitution.unwrap() - 1.0).abs() < 1e-9, "{found:?}");
        let touch_s = (arrives - speed_m_s) / GRAVITY_M_S2;
        assert!((found.sub_impacts[0].start_s / touch_s - 1.0).abs() < 1e-12, "{found:?}");
        assert!((found.restitution.unwrap() - 1.0).abs() < 1e-9, "{found:?}");
    }
}

/// Times, places and speeds of all contacts by the Runge-Kutta integration of tests/common, and no flight before the last rises enough.
#[test]
fn agrees_with_a_second_method() {
    let (structure, striker, law) = beam();
    let found = falls(&structure, &striker, &law, None, 1e-11);
    assert_eq!(found.outcome, Outcome::Rebound);
    assert!(found.sub_impacts.len() > 5, "{found:?}");
    let to = |end_s: f64| second_method_under(GRAVITY_M_S2, &structure, &striker, &law, end_s, 1e-12);
    let rise = |end_s: f64| {
        let end = to(end_s);
        end.displacement_m + end.velocity_m_s.max(0.0).powi(2) / (2.0 * GRAVITY_M_S2)
    };
    // beyond the last separation, until the ball turns round
    let turns_s = found.end_s + found.striker_velocity_m_s / GRAVITY_M_S2;
    let all = to(turns_s);
    assert!(all.velocity_m_s.abs() < 1e-6, "{}", all.velocity_m_s);
    assert_eq!(all.touches_s.len(), found.sub_impacts.len());
    for (contact, touch_s) in found.sub_impacts.iter().zip(&all.touches_s) {
        assert!((contact.start_s - touch_s).abs() < 1e-8, "{contact:?} {touch_s}");
    }
    let restitution = (2.0 * GRAVITY_M_S2 * all.displacement_m).sqrt();
    let beyond = (restitution - found.restitution.unwrap()).abs();
    assert!(beyond < found.restitution_uncertainty.unwrap().max(1e-8), "{restitution} {found:?}");
    let least = 0.01 / (2.0 * GRAVITY_M_S2);
    for pair in found.sub_impacts.windows(2) {
        let turns_s = pair[0].end_s + to(pair[0].end_s).velocity_m_s / GRAVITY_M_S2;
        assert!(turns_s > pair[1].start_s || rise(pair[0].end_s) < least, "{pair:?}");
    }
}

#[test]
fn energy_is_balanced_and_the_history_ends_where_the_rebound_is_highest() {
    let (structure, striker, law) = beam();
    let start = Start { gap_m: 0.01, ..Start::at_rest(structure.modes.len()) };
    let solver = Solver::new(&structure).unwrap().under_gravity(GRAVITY_M_S2).unwrap();
    for start in [None, Some(&start)] {
        let (found, history) = solver.record(&striker, &law, start, &settings(1e-9)).unwrap();
        let ledger = history.energy_ledger();
        let gap_m = start.map_or(0.0, |start| start.gap_m);
        let initial_j = striker.mass_kg * (0.5 * striker.speed_m_s.powi(2) + GRAVITY_M_S2 * gap_m);
        assert!((ledger.initial_j / initial_j - 1.0).abs() < 1e-12);
        assert!(ledger.residual_j.abs() < 1e-9 * initial_j, "{ledger:?}");
        let restitution = (ledger.striker_j / initial_j).sqrt();
        assert!((restitution - found.restitution.unwrap()).abs() < 1e-12, "{restitution} {found:?}");
        let top = history.at(f64::INFINITY);
        assert!(top.striker_velocity_m_s.abs() < 1e-9, "{top:?}");
        assert!((top.time_s - history.known_until_s()).abs() < 1e-12);
        assert!((history.striker_energy_j(top.time_s) / ledger.striker_j - 1.0).abs() < 1e-9, "{ledger:?}");
        let rises = striker.mass_kg * GRAVITY_M_S2 * (top.striker_displacement_m + gap_m);
        assert!((rises / ledger.striker_j - 1.0).abs() < 1e-9, "{top:?} {ledger:?}");
        // in the middle of a contact the motion is that of the modes, the weight included
        let contact = found.sub_impacts[1];
        let [before, middle, after] =
            [-1.0, 0.0, 1.0].map(|side| history.at(0.5 * (contact.start_s + contact.end_s) + side * MOMENT_S));
        let accelerates = (after.striker_velocity_m_s - before.striker_velocity_m_s) / (2.0 * MOMENT_S);
        let expected = middle.force_n / striker.mass_kg - GRAVITY_M_S2;
        assert!((accelerates / expected - 1.0).abs() < 1e-2, "{accelerates} {expected}");
    }
}

#[test]
fn weak_gravity_changes_nothing() {
    let (structure, striker, law) = beam();
    let without = Solver::new(&structure).unwrap().solve(&striker, &law, None, &settings(1e-10)).unwrap();
    let solver = Solver::new(&structure).unwrap().under_gravity(1e-9).unwrap();
    let with = solver.solve(&striker, &law, None, &settings(1e-10)).unwrap();
    assert_eq!(with.sub_impacts.len(), without.sub_impacts.len());
    assert!((with.restitution.unwrap() - without.restitution.unwrap()).abs() < 1e-8, "{with:?} {without:?}");
    // and none, nothing at all
    let none = Solver::new(&structure).unwrap().under_gravity(0.0).unwrap();
    assert_eq!(none.solve(&striker, &law, None, &settings(1e-10)).unwrap(), without);
}

#[test]
fn a_striker_that_hardly_rises_stays() {
    let soft = Structure { modes: vec![Mode { omega_rad_s: 60.0, damping_ratio: 0.5, shape: 1.0 }] };
    let heavy = Striker { mass_kg: 2.0, speed_m_s: 1.0 };
    let found = falls(&soft, &heavy, &hertz(), None, 1e-9);
    assert_eq!((found.outcome, found.restitution), (Outcome::Sustained, Some(0.0)));
    assert!(found.restitution_uncertainty.unwrap() < 1e-6 && found.highest_flight < 0.01, "{found:?}");
    // in a dashpot, at once
    let damped = KelvinVoigt::new(1e5, 1e5).unwrap().into();
    let found = falls(&Structure::default(), &heavy, &damped, None, 1e-9);
    assert_eq!((found.outcome, found.restitution), (Outcome::Sustained, Some(0.0)));
}

/// A slow ball stays on a soft support for nearly a whole vibration under its weight, far longer than it flies, and loses nothing.
#[test]
fn a_rebound_from_a_soft_support_is_awaited() {
    let slow = Striker { mass_kg: 1.0, speed_m_s: 0.02 };
    // on a light plate on a spring of 400 N/m, by a hard contact, and on a soft contact with a rigid structure
    let light = Structure { modes: vec![Mode { omega_rad_s: 2e3, damping_ratio: 0.0, shape: 100.0 }] };
    let spring = LinearSpring::new(400.0).unwrap().into();
    for (structure, law) in [(&light, &hertz()), (&Structure::default(), &spring)] {
        let found = falls(structure, &slow, law, None, 1e-9);
        let interval_s = found.sub_impacts.iter().map(|contact| contact.end_s - contact.start_s).sum::<f64>();
        assert_eq!(found.outcome, Outcome::Rebound, "{found:?}");
        assert!((found.restitution.unwrap() - 1.0).abs() < 1e-3, "{found:?}");
        assert!(interval_s > 20.0 * slow.speed_m_s / GRAVITY_M_S2, "{found:?}");
    }
    // with losses it stays
    let damped = KelvinVoigt::new(400.0, 4.0).unwrap().into();
    let found = falls(&Structure::default(), &slow, &damped, None, 1e-9);
    assert_eq!((found.outcome, found.restitution), (Outcome::Sustained, Some(0.0)));
}

/// A heavy ball on a beam that is hardly damped never leaves it again, and need not come to rest for that to be known.
#[test]
fn a_ball_that_swings_on_the_beam_stays() {
    let structure = Structure { modes: vec![Mode { omega_rad_s: 570.0, damping_ratio: 0.005, shape: 1.2 }] };
    let (heavy, spring) = (Striker { mass_kg: 300.0, speed_m_s: 0.005 }, LinearSpring::new(1e6).unwrap().into());
    let found = falls(&structure, &heavy, &spring, None, 1e-9);
    assert_eq!((found.outcome, found.restitution), (Outcome::Sustained, Some(0.0)), "{found:?}");
    assert!(found.sub_impacts.len() == 1 && found.counts.contact_steps < 20_000, "{found:?}");
}

#[test]
fn a_fall_that_is_none_is_refused() {
    let (structure, striker, law) = beam();
    let refused = |structure: &Structure, striker: &Striker, gravity_m_s2: f64| {
        let solver = Solver::new(structure).unwrap().under_gravity(gravity_m_s2);
        let found = solver.and_then(|solver| solver.solve(striker, &law, None, &Settings::default()));
        let fault = found.unwrap_err();
        assert_eq!(fault.field.to_string(), "gravity_m_s2");
        fault.to_string()
    };
    for gravity_m_s2 in [-9.81, f64::NAN, f64::INFINITY, 1e31, 1e-31] {
        assert!(refused(&structure, &striker, gravity_m_s2).contains("positive"));
    }
    let stop = Striker { mass_kg: f64::INFINITY, speed_m_s: 1.0 };
    assert!(refused(&structure, &stop, 9.81).contains("stop"));
    let mut free = structure.clone();
    free.modes.push(Mode { omega_rad_s: 0.0, damping_ratio: 0.0, shape: 1.0 });
    assert!(refused(&free, &striker, 9.81).contains("not held"));
    for speed_m_s in [0.0, -0.5] {
        assert!(refused(&structure, &Striker { speed_m_s, ..striker }, 9.81).contains("touches"));
    }
}

proptest! {
    #![proptest_config(config(60))]

    /// The stated uncertainty covers the error at a loose tolerance, no energy appears, and nothing takes for ever.
    #[test]
    fn stated_uncertainties_cover_errors(impact in ordinary_impact(), speed in 0.02f64..3.0) {
        let Impact { structure, striker, law } = impact;
        let striker = Striker { speed_m_s: speed, ..striker };
        let [fine, loose] = [1e-11, 1e-6].map(|tolerance| falls(&structure, &striker, &law, None, tolerance));
        if let (Some(exact), Some(rest)) = (fine.restitution, fine.restitution_uncertainty)
            && let (Some(found), Some(stated)) = (loose.restitution, loose.restitution_uncertainty)
        {
            prop_assert!((0.0..=1.0 + 1e-6).contains(&found), "{}", found);
            prop_assert!((found - exact).abs() <= stated + rest, "{} {} {} {}", found, exact, stated, rest);
        }
        for found in [&fine, &loose] {
            prop_assert!(found.outcome.stopped_by().is_none() || found.counts.steps() > 10_000, "{:?}", found.outcome);
        }
    }
}

/// A fall at one value of each number that defines it.
struct Drop {
    structure: Structure,
    striker: Striker,
    law: Law,
    start: Start,
    gravity_m_s2: f64,
}

impl Drop {
    /// With a part of one of the numbers added to it, for a start that touches at 1 m/s or is at rest 50 mm above.
    fn new(from_rest: bool, number: usize, part: f64) -> Drop {
        let times = |which: usize| if which == number { 1.0 + part } else { 1.0 };
        let mut structure = pinned(6, 0.01 * times(4), 0.3 * times(5));
        structure.modes.iter_mut().for_each(|mode| mode.omega_rad_s *= times(3));
        let speed_m_s = if from_rest { 0.0 } else { times(1) };
        let gap_m = if from_rest { 0.05 * times(1) } else { 0.0 };
        Drop {
            striker: Striker { mass_kg: 0.263 * times(0), speed_m_s },
            law: Hertz::new(1.8e10 * times(6)).unwrap().into(),
            start: Start { gap_m, ..Start::at_rest(structure.modes.len()) },
            gravity_m_s2: GRAVITY_M_S2 * times(2),
            structure,
        }
    }

    fn solver(&self) -> Solver {
        Solver::new(&self.structure).unwrap().under_gravity(self.gravity_m_s2).unwrap()
    }

    fn posing(&self) -> Posing<'_> {
        let Drop { structure, striker, law, start, gravity_m_s2 } = self;
        Posing { structure, striker, law, start, gravity_m_s2: *gravity_m_s2 }
    }
}

#[test]
fn derivatives_agree_with_differences_of_falls() {
    const NUMBERS: usize = 7;
    let offsets = [-2e-6, -1e-6, 1e-6, 2e-6];
    for from_rest in [false, true] {
        let drop = Drop::new(from_rest, 0, 0.0);
        let near: Vec<[Drop; 4]> =
            (0..NUMBERS).map(|number| offsets.map(|part| Drop::new(from_rest, number, part))).collect();
        let mut parameters = Vec::new();
        for (number, near) in near.iter().enumerate() {
            let neighbours = near.each_ref().map(Drop::posing);
            parameters.push(Parameter { offsets, neighbours, changes_law: number == 6 });
        }
        let Drop { striker, law, start, .. } = &drop;
        let found = drop.solver().differentiate(striker, law, Some(start), &settings(1e-10), &parameters).unwrap();
        assert!(found.solution.sub_impacts.len() > 1, "{:?}", found.solution);
        for (number, (derivatives, near)) in found.derivatives.iter().zip(&near).enumerate() {
            let outputs = near.each_ref().map(|at| {
                let found = at.solver().solve(&at.striker, &at.law, Some(&at.start), &settings(1e-13)).unwrap();
                [found.restitution.unwrap(), found.end_s, found.striker_velocity_m_s]
            });
            let Derivatives { restitution, end_s, striker_velocity_m_s, .. } = derivatives.as_ref().unwrap();
            for (k, derivative) in [restitution, end_s, striker_velocity_m_s].into_iter().enumerate() {
                let slope = Stencil::new(offsets).slope(outputs.map(|output| output[k]));
                let error = (derivative.value - slope).abs();
                assert!(error < derivative.uncertainty.unwrap() + 1e-6, "{from_rest} {number} {derivative:?} {slope}");
                assert!(derivative.uncertainty.unwrap() < 1e-4, "{from_rest} {number} {derivative:?}");
            }
        }
    }
}

#[test]
fn derivatives_need_gravity_at_all_neighbours_or_at_none() {
    let drop = Drop::new(false, 0, 0.0);
    let near = [0.0, GRAVITY_M_S2, 10.0, 10.0].map(|gravity_m_s2| Posing { gravity_m_s2, ..drop.posing() });
    let parameter = Parameter { offsets: [-2.0, -1.0, 1.0, 2.0], neighbours: near, changes_law: false };
    let Drop { striker, law, start, .. } = &drop;
    let fault = drop.solver().differentiate(striker, law, Some(start), &settings(1e-9), &[parameter]).unwrap_err();
    assert_eq!(fault.field.to_string(), "parameters[0].neighbours[0].gravity_m_s2");
}
