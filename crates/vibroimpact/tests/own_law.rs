//! The record of an impact with a user-defined law is exported and drawn like any other.

#[path = "../../vibroimpact-sim/examples/own_law/hardening.rs"]
mod hardening;

use hardening::Hardening;
use vibroimpact::export;
use vibroimpact::vibroimpact_sim::modal::{Mode, Settings, Solver, Striker, Structure};

#[test]
fn histories_of_a_user_defined_law_are_exported() {
    let law = Hardening { stiffness_n_m: 2e7, yield_force_n: 100.0, kinematic_n_m: 8e6, isotropic_n_m: 1e6 };
    let law = law.validated().unwrap();
    let modes = [(160.0, 1.4), (660.0, -0.8)];
    let mode = |(omega_rad_s, shape)| Mode { omega_rad_s, damping_ratio: 0.02, shape };
    let solver = Solver::new(&Structure { modes: modes.map(mode).to_vec() }).unwrap();
    let striker = Striker { mass_kg: 0.11, speed_m_s: 1.0 };
    let (solution, history) = solver.record(&striker, &law, None, &Settings::default()).unwrap();

    let table = export::history(&history, solution.end_s);
    let column = |name: &str| &table.columns.iter().find(|(column, _)| column == name).unwrap().1;
    let (force, compression) = (column("force_n"), column("compression_m"));
    assert!(force.iter().all(|force| *force >= 0.0) && force.iter().any(|force| *force > law.yield_force_n));
    // Within one contact the same compression has two forces, because the law dissipates.
    let deepest = compression.iter().copied().fold(0.0, f64::max);
    assert!(force.iter().zip(compression).any(|(force, xi)| *force == 0.0 && *xi > 0.1 * deepest));
    let text = String::from_utf8(table.csv().unwrap()).unwrap();
    assert_eq!(text.lines().count(), force.len() + 1);

    let energies = export::modal_energies(&history, solution.end_s);
    assert_eq!(energies.columns.len(), 1 + modes.len());
}
