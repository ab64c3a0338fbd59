//! User-defined laws: those that keep their contract work like any other, and one that breaks it ends the run with that reason.

use crate::common::{Bounded, ball, pinned, second_method, settings};
use contact_models::{
    After, Boundary, Branch, ContactLaw, Force, Hertz, HuntCrossley, Internal, Memory, Stage, boundaries,
    check_contract,
};
use vibroimpact_sim::StopReason;
use vibroimpact_sim::modal::{Outcome, Solver};

/// A linear spring that changes between two branches forever, or gives NaN beyond some compression.
struct Endless {
    limit_m: f64,
}

impl ContactLaw for Endless {
    fn touch(&self, _: &Memory, _: f64) -> Branch {
        Branch { stage: Stage::Loading, anchor_m: 0.0, internal: Internal::NONE }
    }

    fn force(&self, _: &Branch, xi: f64, _: f64) -> Force {
        let force_n = if xi < self.limit_m { 1e7 * xi.max(0.0) } else { f64::NAN };
        Force { force_n, per_compression_n_m: if xi > 0.0 { 1e7 } else { 0.0 }, per_rate_n_s_m: 0.0 }
    }

    fn stored_energy_j(&self, _: &Branch, xi: f64) -> f64 {
        5e6 * xi.clamp(0.0, 1.0).powi(2)
    }

    fn boundary(&self, _: &Branch, which: usize) -> Option<Boundary> {
        [Boundary::compression_falls_to(0.0), Boundary::rate_falls_to(0.0)].get(which).copied()
    }

    fn cross(&self, branch: &Branch, which: usize, _: f64, _: f64) -> After {
        if which == 0 { After::Release(Memory::default()) } else { After::Continue(*branch) }
    }
}

#[test]
fn a_law_that_breaks_its_contract_ends_with_that_reason() {
    for law in [Endless { limit_m: f64::INFINITY }, Endless { limit_m: 1e-5 }] {
        assert!(check_contract(&law, 1e-4, 1.0).is_err());
        let solver = Solver::new(&pinned(10, 0.02, 0.3)).unwrap();
        let solution = solver.solve(&ball(), &law, None, &settings(1e-9)).unwrap();
        assert_eq!(solution.outcome, Outcome::Stopped(StopReason::Law));
        assert!(solution.counts.contact_steps <= 50_000, "{:?}", solution.counts);
    }
}

#[test]
fn a_law_has_any_number_of_boundaries() {
    let hertz = Hertz::new(1.7945e10).unwrap();
    let solver = Solver::new(&pinned(10, 0.02, 0.3)).unwrap();
    let falls = (1..5).map(|level| Boundary::compression_falls_to(-f64::from(level)));
    let further = [Boundary::compression_rises_to(1.0)].into_iter().chain(falls).collect();
    let law = Bounded { hertz, further };
    assert_eq!(boundaries(&law, &law.touch(&Memory::default(), 1.0)).count(), 6);
    let crowded = solver.solve(&ball(), &law, None, &settings(1e-9)).unwrap();
    let plain = solver.solve(&ball(), &hertz, None, &settings(1e-9)).unwrap();
    assert_eq!(crowded.restitution, plain.restitution);
    assert_eq!(crowded.sub_impacts, plain.sub_impacts);
}

/// A spring whose damping grows with the square of the rate, so that its derivative vanishes with the rate.
struct Squared;

impl ContactLaw for Squared {
    fn touch(&self, _: &Memory, _: f64) -> Branch {
        Branch { stage: Stage::Own(7), anchor_m: 0.0, internal: Internal::NONE }
    }

    fn force(&self, _: &Branch, xi: f64, rate: f64) -> Force {
        let (xi, rate) = (xi.clamp(0.0, 1.0), rate.clamp(-1e3, 1e3));
        let (stiffness, factor) = (1e7, 1.0 + 0.1 * rate * rate * rate);
        let per_rate_n_s_m = stiffness * xi * 0.3 * rate * rate;
        Force { force_n: stiffness * xi * factor, per_compression_n_m: stiffness * factor, per_rate_n_s_m }
    }

    fn stored_energy_j(&self, _: &Branch, xi: f64) -> f64 {
        5e6 * xi.clamp(0.0, 1.0).powi(2)
    }

    fn boundary(&self, _: &Branch, which: usize) -> Option<Boundary> {
        (which == 0).then_some(Boundary::compression_falls_to(0.0))
    }

    fn cross(&self, _: &Branch, _: usize, _: f64, _: f64) -> After {
        After::Release(Memory::default())
    }
}

/// No declaration states that the force depends on the rate, and the solver computes the rate all the same.
#[test]
fn dependence_on_the_rate_is_detected() {
    assert!(check_contract(&Squared, 1e-4, 1.0).is_ok());
    let structure = pinned(4, 0.02, 0.3);
    let solver = Solver::new(&structure).unwrap();
    let solution = solver.solve(&ball(), &Squared, None, &settings(1e-11)).unwrap();
    let second = second_method(&structure, &ball(), &Squared, solution.end_s + 1e-6, 1e-13);
    let error = (solution.restitution.unwrap() - second.velocity_m_s).abs();
    assert!(error < 1e-9, "{error:e}");
    assert_eq!(solution.sub_impacts.len(), second.touches_s.len());
}

/// The law of Hunt and Crossley with a branch for loading and one for unloading, each of which continues its force at a rate of zero
/// without dependence on the rate.
struct Sided;

impl Sided {
    const STIFFNESS_N_M: f64 = 1e7;
    const DAMPING_S_M: f64 = 0.5;
}

impl ContactLaw for Sided {
    fn touch(&self, _: &Memory, _: f64) -> Branch {
        Branch { stage: Stage::Loading, anchor_m: 0.0, internal: Internal::NONE }
    }

    fn force(&self, branch: &Branch, xi: f64, rate: f64) -> Force {
        let (low, high) = if branch.stage == Stage::Loading { (0.0, 1e3) } else { (-1e3, 0.0) };
        let (pushes, moves) = (xi > 0.0, low < rate && rate < high);
        let factor = 1.0 + Sided::DAMPING_S_M * rate.clamp(low, high);
        let spring = Sided::STIFFNESS_N_M * xi.clamp(0.0, 1.0);
        Force {
            force_n: spring * factor,
            per_compression_n_m: if pushes { Sided::STIFFNESS_N_M * factor } else { 0.0 },
            per_rate_n_s_m: if moves { spring * Sided::DAMPING_S_M } else { 0.0 },
        }
    }

    fn stored_energy_j(&self, _: &Branch, xi: f64) -> f64 {
        0.5 * Sided::STIFFNESS_N_M * xi.clamp(0.0, 1.0).powi(2)
    }

    fn boundary(&self, branch: &Branch, which: usize) -> Option<Boundary> {
        match (branch.stage, which) {
            (_, 0) => Some(Boundary::compression_falls_to(0.0)),
            (Stage::Loading, 1) => Some(Boundary::rate_falls_to(0.0)),
            (_, 1) => Some(Boundary::rate_rises_to(0.0)),
            _ => None,
        }
    }

    fn cross(&self, branch: &Branch, which: usize, _: f64, _: f64) -> After {
        let turned = if branch.stage == Stage::Loading { Stage::Unloading } else { Stage::Loading };
        match which {
            0 => After::Release(Memory::default()),
            _ => After::Continue(Branch { stage: turned, ..*branch }),
        }
    }
}

/// Beyond its boundaries a branch is only continued, and tells nothing about the rate.
#[test]
fn dependence_on_the_rate_is_asked_within_the_branch() {
    assert!(check_contract(&Sided, 1e-4, 1.0).is_ok());
    let solver = Solver::new(&pinned(4, 0.02, 0.3)).unwrap();
    let restitution = |law: &dyn ContactLaw| {
        let solution = solver.solve(&ball(), law, None, &settings(1e-11)).unwrap();
        solution.restitution.unwrap()
    };
    let whole = HuntCrossley::new(Sided::STIFFNESS_N_M, 1.0, Sided::DAMPING_S_M).unwrap();
    let error = (restitution(&Sided) - restitution(&whole)).abs();
    assert!(error < 1e-9, "{error:e}");
}
