//! The theories of bending.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Theory of bending of a beam.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BeamTheory {
    /// Sections stay normal to the axis and have no rotary inertia.
    EulerBernoulli,
    /// With shear and rotary inertia.
    Timoshenko,
    /// Timoshenko's if every segment has the data for it and there is neither axial force nor foundation; otherwise
    /// Euler-Bernoulli's.
    Auto,
}

invalid_input::names!(BeamTheory, "theory", {
    EulerBernoulli: "euler-bernoulli",
    Timoshenko: "timoshenko",
    Auto: "auto",
});
