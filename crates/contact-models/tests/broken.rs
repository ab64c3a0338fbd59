//! Laws that each break their contract in one way, and the error that reports it.

use contact_models::{
    After, Boundary, Branch, ContactLaw, Force, Internal, LinearSpring, Memory, Promise, Stage, check_contract,
};

/// A linear spring with one fault.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Broken {
    Nothing,
    Pulls,
    Jumps,
    HidesItsRate,
    DampedOnlyDeep,
    Endless,
    MakesEnergy,
    NeverSettles,
    BeginsBeyond,
    NotANumber,
}

const STIFFNESS: f64 = 1e6;

fn branch(stage: Stage) -> Branch {
    Branch { stage, anchor_m: 0.0, internal: Internal::NONE }
}

impl ContactLaw for Broken {
    fn touch(&self, _: &Memory, _: f64) -> Branch {
        branch(Stage::Loading)
    }

    fn force(&self, branch: &Branch, compression_m: f64, rate_m_s: f64) -> Force {
        let xi = compression_m.clamp(0.0, 1.0);
        let stiffness = if (0.0..1.0).contains(&compression_m) { STIFFNESS } else { 0.0 };
        let spring = Force { force_n: STIFFNESS * xi, per_compression_n_m: stiffness, per_rate_n_s_m: 0.0 };
        let unloads = branch.stage == Stage::Unloading;
        let times = |factor: f64| Force {
            force_n: factor * spring.force_n,
            per_compression_n_m: factor * stiffness,
            per_rate_n_s_m: 0.0,
        };
        match self {
            Broken::Pulls if unloads => times(-1.0),
            Broken::Jumps if unloads => times(0.5),
            Broken::HidesItsRate => times(1.0 + 1e-3 * rate_m_s.clamp(-1.0, 1.0)),
            Broken::DampedOnlyDeep if xi > 3e-6 => {
                let (deep, damping) = (xi - 3e-6, 1e-3 * STIFFNESS);
                let per_compression_n_m = stiffness + 2.0 * damping * deep * rate_m_s.clamp(-1.0, 1.0);
                let per_rate_n_s_m = damping * deep * deep;
                let force_n = spring.force_n + per_rate_n_s_m * rate_m_s.clamp(-1.0, 1.0);
                Force { force_n, per_compression_n_m, per_rate_n_s_m }
            }
            // The force is larger on unloading, and the branch is kept.
            Broken::MakesEnergy if unloads => {
                let [deepest] = branch.internal.into();
                let root = (xi * deepest).sqrt();
                Force {
                    force_n: STIFFNESS * root,
                    per_compression_n_m: 0.5 * STIFFNESS * root / xi.max(1e-300),
                    ..spring
                }
            }
            Broken::NotANumber if xi > 3e-6 => times(f64::NAN),
            _ => spring,
        }
    }

    fn stored_energy_j(&self, _: &Branch, compression_m: f64) -> f64 {
        0.5 * STIFFNESS * compression_m.clamp(0.0, 1.0).powi(2)
    }

    fn boundary(&self, branch: &Branch, which: usize) -> Option<Boundary> {
        match (branch.stage, which) {
            (Stage::Loading, 0) => Some(Boundary::rate_falls_to(0.0)),
            (Stage::Slack, 0) => Some(Boundary { level: 1.0, ..Boundary::NEVER }),
            (Stage::Unloading, 0) => Some(Boundary::compression_falls_to(0.0)),
            (Stage::Unloading, 1) if *self != Broken::MakesEnergy => Some(Boundary::rate_rises_to(0.0)),
            _ if *self == Broken::Endless => Some(Boundary::NEVER),
            _ => None,
        }
    }

    fn cross(&self, before: &Branch, which: usize, compression_m: f64, _: f64) -> After {
        match (self, before.stage, which) {
            (_, Stage::Unloading, 0) => After::Release(Memory::default()),
            (Broken::NeverSettles, Stage::Unloading | Stage::Loading, _) => After::Continue(*before),
            (Broken::BeginsBeyond, ..) => After::Continue(branch(Stage::Slack)),
            (_, Stage::Loading, _) => {
                After::Continue(Branch { internal: [compression_m].into(), ..branch(Stage::Unloading) })
            }
            _ => After::Continue(branch(Stage::Loading)),
        }
    }
}

#[test]
fn each_error_is_named() {
    let told = |law: Broken| check_contract(&law, 1e-5, 1.0).map_err(|breach| breach.promise);
    assert_eq!(told(Broken::Nothing), Ok(()));
    assert!(matches!(told(Broken::Pulls), Err(Promise::Continuous { .. })));
    assert!(matches!(told(Broken::Jumps), Err(Promise::Continuous { .. })));
    assert_eq!(told(Broken::HidesItsRate), Err(Promise::Rate));
    assert_eq!(told(Broken::DampedOnlyDeep), Err(Promise::Rate));
    assert_eq!(told(Broken::Endless), Err(Promise::Boundaries));
    assert!(matches!(told(Broken::MakesEnergy), Err(Promise::Energy { made_j }) if made_j > 0.0));
    assert_eq!(told(Broken::NeverSettles), Err(Promise::Settles));
    assert_eq!(told(Broken::BeginsBeyond), Err(Promise::Begins));
    assert_eq!(told(Broken::NotANumber), Err(Promise::Finite));
    let message = check_contract(&Broken::HidesItsRate, 1e-5, 1.0).unwrap_err().to_string();
    assert!(message.contains("depends on the rate") && message.contains("Loading"), "{message}");
}

/// The test ends for any sizes: a spring has the required properties on all of them.
#[test]
fn any_size_is_answered() {
    let spring = LinearSpring::new(STIFFNESS).unwrap();
    for size in [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e-300, 1e300] {
        assert_eq!(check_contract(&spring, size, 1.0), Ok(()), "{size}");
        assert_eq!(check_contract(&spring, 1e-5, size), Ok(()), "{size}");
    }
}
