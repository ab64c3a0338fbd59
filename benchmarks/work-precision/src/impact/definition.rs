//! An impact, and the result of a solver.

use contact_models::Law;
use vibroimpact_sim::modal::{Striker, Structure};

/// One impact of the library.
#[derive(Debug, Clone)]
pub struct Impact {
    /// Short name.
    pub name: &'static str,
    /// A description.
    pub about: &'static str,
    /// The beam in its modes.
    pub structure: Structure,
    /// The ball.
    pub striker: Striker,
    /// The law of contact.
    pub law: Law,
}

/// The result of a solver, in terms of the norms.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Speed of the rebound divided by that of the impact.
    pub restitution: f64,
    /// Starts and ends of all contacts, in order (s).
    pub contact_times_s: Vec<f64>,
    /// Impulse of every contact (N s).
    pub impulses_n_s: Vec<f64>,
}

impl Outcome {
    /// The norms in which an outcome is compared with the reference, the chief one first.
    pub fn errors(&self, reference: &Outcome) -> Vec<(&'static str, f64)> {
        let end = reference.contact_times_s.last().copied().unwrap_or(1.0);
        // If the number of contacts differs, so does the contact history, and no time is right.
        let worst = |found: &[f64], wanted: &[f64], unit: f64| {
            if found.len() == wanted.len() {
                found.iter().zip(wanted).map(|(a, b)| (a - b).abs() / unit).fold(0.0, f64::max)
            } else {
                1.0
            }
        };
        let total = |outcome: &Outcome| outcome.impulses_n_s.iter().sum::<f64>();
        let contacts = |outcome: &Outcome| outcome.contact_times_s.len().div_ceil(2) as f64;
        vec![
            ("restitution", (self.restitution - reference.restitution).abs()),
            ("total impulse", (total(self) / total(reference) - 1.0).abs()),
            ("contact times", worst(&self.contact_times_s, &reference.contact_times_s, end)),
            ("number of sub-impacts", (contacts(self) - contacts(reference)).abs()),
        ]
    }
}
