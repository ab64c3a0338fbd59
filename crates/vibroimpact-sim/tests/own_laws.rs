//! Laws of one's own: those that keep their contract are laws like any other, and one that breaks it ends with that reason.

mod common;

use common::{ball, pinned, settings};
use contact_models::{After, Boundary, Branch, ContactLaw, Force, Internal, Memory, Stage, check_contract};
use vibroimpact_sim::StopReason;
use vibroimpact_sim::modal::{Outcome, Solver};

/// A linear spring that changes between two branches for ever, or gives no number beyond some compression.
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
