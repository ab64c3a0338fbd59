//! Derivatives of a single impact.

use serde::Serialize;
use serde_json::Value;

use super::table::{Miss, OfField, Table};

/// An impact, with the derivatives of its outputs with respect to fields of its scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Sensitivity {
    /// Net restitution of the impact that was differentiated.
    pub restitution: f64,
    /// Its estimated error, for the modes retained.
    pub restitution_uncertainty: Option<f64>,
    /// Number of separate contacts.
    pub sub_impact_count: usize,
    /// Number of retained modes.
    pub modes: usize,
    /// Number of remainder modes, which represent all others.
    pub remainder_modes: usize,
    /// Speed of the slowest touch, or of the nearest miss, divided by that of the fastest touch. If it is nearly zero, a contact
    /// is near grazing, and the derivatives hold only for small changes.
    pub nearest_graze: f64,
    /// The nearest graze, if it is a miss.
    pub nearest_miss: Option<Miss>,
    /// The fields and the derivatives: outputs are `restitution`, `end_s`, `striker_velocity_m_s`,
    /// `sub_impacts[0].impulse_n_s` and the like, `omega_rad_s[0]`, `shape[0]` and so on for the lowest modes, and
    /// `emoc_restitution`, by the three-parameter law, where that holds.
    #[serde(flatten)]
    pub table: Table,
    /// The scene with the model and the modes that were used.
    pub scene: Value,
    /// Version of the program.
    pub version: &'static str,
}

impl Sensitivity {
    /// The derivative of an output with respect to a field, if it exists.
    pub fn of(&self, output: &str, field: &str) -> Option<OfField> {
        self.table.of(output, field)
    }
}
