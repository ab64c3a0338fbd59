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
    /// Timoshenko's where every segment gives what it needs, and no axial force and no foundation is there; otherwise
    /// Euler-Bernoulli's.
    Auto,
}

invalid_input::names!(BeamTheory, "theory", {
    EulerBernoulli: "euler-bernoulli",
    Timoshenko: "timoshenko",
    Auto: "auto",
});
