//! The reason why a computation stopped, as a word in results.

use serde::{Serialize, Serializer};
use vibroimpact_sim::StopReason;

/// A reason as its word, or null.
#[allow(clippy::trivially_copy_pass_by_ref, clippy::ref_option)] // the signature that serde requires
pub(crate) fn word<S: Serializer>(reason: &Option<StopReason>, serializer: S) -> Result<S::Ok, S::Error> {
    reason.map(StopReason::as_str).serialize(serializer)
}
