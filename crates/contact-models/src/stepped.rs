//! The restitution of a law in an engine with a fixed step.
//!
//! Physics engines integrate a contact by the semi-implicit Euler rule: with `xi` and `v` the compression and its rate,
//!
//! ```text
//! v <- v - h F(xi, v) / m,   xi <- xi + h v.                                      (1)
//! ```
//!
//! The contact is detected in the first step that ends with `xi > 0`, at a depth between 0 and `h v0`. This depth is a matter
//! of chance, so that one law has many restitutions for one step.

use crate::{After, ContactLaw, Law, Memory, boundaries};

use crate::range::require_positive;
use invalid_input::InvalidInput;

/// Phases of the first touch within a step, evenly spaced.
const PHASES: u32 = 64;
/// Longest contact that is computed (steps).
const MOST_STEPS: u32 = 100_000;

/// Restitutions of a law at a fixed step, over all phases of the first touch within a step.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Stepped {
    /// The smallest.
    pub lowest: f64,
    /// Their mean.
    pub mean: f64,
    /// The largest; above 1 the step adds energy.
    pub highest: f64,
    /// Steps with contact, on average.
    pub steps: f64,
}

/// Rebound speed over approach speed of a rigid striker at a wall, by the semi-implicit Euler rule (1) with a fixed step.
///
/// # Errors
/// A mass, speed or step that is not positive; a step so short that the contact has not ended after 100,000 steps.
pub fn stepped_restitution(law: &Law, mass_kg: f64, speed_m_s: f64, step_s: f64) -> Result<Stepped, InvalidInput> {
    require_positive("mass_kg", mass_kg)?;
    require_positive("speed_m_s", speed_m_s)?;
    require_positive("step_s", step_s)?;
    let mut found = Stepped { lowest: f64::INFINITY, mean: 0.0, highest: 0.0, steps: 0.0 };
    for phase in 0..PHASES {
        let depth_m = (f64::from(phase) + 0.5) / f64::from(PHASES) * speed_m_s * step_s;
        let (restitution, steps) = rebound(law, mass_kg, speed_m_s, step_s, depth_m).ok_or_else(|| {
            let allowed = format!("longer, because the contact has not ended after {MOST_STEPS} steps");
            InvalidInput::new("step_s", step_s, allowed)
        })?;
        found.lowest = found.lowest.min(restitution);
        found.highest = found.highest.max(restitution);
        found.mean += restitution / f64::from(PHASES);
        found.steps += f64::from(steps) / f64::from(PHASES);
    }
    Ok(found)
}

/// Restitution and number of steps of a contact that is detected at this depth; none if it does not end.
fn rebound(law: &Law, mass_kg: f64, speed_m_s: f64, step_s: f64, depth_m: f64) -> Option<(f64, u32)> {
    let mut branch = law.touch(&Memory::default(), speed_m_s);
    let (mut xi, mut v) = (depth_m, speed_m_s);
    for step in 0..MOST_STEPS {
        // A step may cross several branches.
        for _ in 0..4 {
            let met = boundaries(law, &branch).position(|boundary| boundary.margin(xi, v) < 0.0);
            let Some(which) = met else { break };
            match law.cross(&branch, which, xi, v) {
                After::Continue(next) => branch = next,
                After::Release(_) => return Some(((-v / speed_m_s).max(0.0), step)),
            }
        }
        v -= step_s * law.force(&branch, xi, v).force_n.max(0.0) / mass_kg;
        xi += step_s * v;
    }
    None
}
