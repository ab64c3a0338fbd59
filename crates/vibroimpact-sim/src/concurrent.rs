//! Two computations at the same time.

use std::panic::resume_unwind;
use std::thread::{Builder, scope};

/// Does both: `beside` in a thread of its own if `concurrent` holds and a thread can be had, otherwise after `here`. The
/// results are the same either way.
///
/// ```
/// let (sum, product) = vibroimpact_sim::both(true, || (1..=4).sum::<i32>(), || (1..=4).product::<i32>());
/// assert_eq!((sum, product), (10, 24));
/// ```
pub fn both<A: Send, B>(concurrent: bool, beside: impl Fn() -> A + Sync, here: impl FnOnce() -> B) -> (A, B) {
    if !concurrent {
        let here = here();
        return (beside(), here);
    }
    scope(|scope| {
        let thread = Builder::new().spawn_scoped(scope, &beside);
        let here = here();
        match thread.map(|thread| thread.join()) {
            Ok(Ok(found)) => (found, here),
            Ok(Err(panic)) => resume_unwind(panic),
            // the system has given no thread
            Err(_) => (beside(), here),
        }
    })
}
