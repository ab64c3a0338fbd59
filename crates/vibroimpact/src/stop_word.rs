//! Why a computation stopped, as results say it.

use serde::{Serialize, Serializer};
use vibroimpact_sim::StopReason;

/// A reason as its word, or null.
#[allow(clippy::trivially_copy_pass_by_ref, clippy::ref_option)] // the signature that serde asks for
pub(crate) fn word<S: Serializer>(reason: &Option<StopReason>, serializer: S) -> Result<S::Ok, S::Error> {
    reason.map(StopReason::as_str).serialize(serializer)
}
