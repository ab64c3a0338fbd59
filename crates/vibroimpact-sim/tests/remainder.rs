//! What remainder modes bring: the restitution of the thesis's beam with few modes against the converged one.

mod common;
use beam_modes::{PointMode, remainder_modes};
use common::{GOLDEN, pinned, pinned_with_residual, solve};
use vibroimpact_sim::modal::{Mode, Structure};

const DAMPING: f64 = 0.02;

fn restitution(structure: &Structure) -> f64 {
    solve(structure, 1e-10).restitution.unwrap()
}

/// `n` modes of the beam and `count` remainder modes of 3,000 more, damped as the last that is kept.
fn with_remainder(n: usize, count: usize) -> Structure {
    let all = pinned(n + 3000, DAMPING, GOLDEN);
    let tail: Vec<PointMode> =
        all.modes[n..].iter().map(|m| PointMode { omega_rad_s: m.omega_rad_s, shape: m.shape }).collect();
    let rest = pinned_with_residual(n + 3000, DAMPING, GOLDEN).residual_compliance_m_n;
    let mut structure = pinned(n, DAMPING, GOLDEN);
    let damped = |m: PointMode| Mode { omega_rad_s: m.omega_rad_s, damping_ratio: DAMPING, shape: m.shape };
    structure.modes.extend(remainder_modes(&tail, rest.max(0.0), count).unwrap().into_iter().map(damped));
    structure
}

/// Golden section, 3 cm ball: a spring for the rest of 64 modes is off by 4e-4, two remainder modes by 1e-5.
#[test]
fn two_remainder_modes_are_worth_forty_springs() {
    let converged = restitution(&with_remainder(256, 3));
    let error = |structure: &Structure| (restitution(structure) - converged).abs();
    let spring = error(&pinned_with_residual(64, DAMPING, GOLDEN));
    let [one, two, three] = [1, 2, 3].map(|count| error(&with_remainder(64, count)));
    println!("{converged}: {spring:e} {one:e} {two:e} {three:e}");
    assert!((2e-4..1e-3).contains(&spring), "{spring:e}");
    assert!((3e-5..2e-4).contains(&one), "{one:e}");
    assert!(two < 3e-5 && three < 5e-5, "{two:e} {three:e}");

    let [one, two, three] = [1, 2, 3].map(|count| error(&with_remainder(128, count)));
    let spring = error(&pinned_with_residual(128, DAMPING, GOLDEN));
    println!("{spring:e} {one:e} {two:e} {three:e}");
    assert!((5e-6..5e-5).contains(&spring) && one < 1e-5 && two < 2e-6 && three < 1e-6);
}
