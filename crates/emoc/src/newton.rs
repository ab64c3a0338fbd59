//! Newton's restitution at the contact points, with the modes excited by a single impulse.

use crate::Real;
use crate::require::{require_fraction, require_non_negative};
use invalid_input::InvalidInput;

/// Net restitution if the striker and a structure at rest exchange one impulse after which the contact points separate at
/// `restitution` times the speed of approach: `(restitution - Z) / (1 + Z)`.
///
/// This is the meaning of a constant coefficient for a structure with modes (generalised momentum balance, thesis 5.1). For `Z
/// > restitution` the striker continues towards the structure, so that further sub-impacts must follow, which this rule does
/// not describe. For a rigid structure (`Z = 0`) it is the constant itself.
///
/// ```
/// assert_eq!(emoc::newton_restitution(0.8, 0.0)?, 0.8);
/// assert_eq!(emoc::newton_restitution(1.0, 3.0)?, -0.5);
/// # Ok::<(), emoc::InvalidInput>(())
/// ```
///
/// # Errors
/// [`InvalidInput`] for a restitution outside 0 to 1, or a `z` that is negative or not finite.
pub fn newton_restitution<T: Real>(restitution: T, z: T) -> Result<T, InvalidInput> {
    require_fraction("restitution", restitution)?;
    require_non_negative("z", z)?;
    Ok((restitution - z) / (T::ONE + z))
}
