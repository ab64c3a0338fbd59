//! How much is said beside the result: progress and notes on the standard error, files that were written.

use std::sync::OnceLock;
use std::time::{Duration, Instant};

use vibroimpact::text::quantity;

/// How much is said.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Voice {
    /// Nothing but results and errors.
    Quiet,
    /// Progress of long work, and files that were written.
    Normal,
    /// Also what is done, and how long it takes.
    Verbose,
}

/// That of this run of the program, and when it began.
static VOICE: OnceLock<(Voice, Instant)> = OnceLock::new();

/// Says once, before anything else, how much is to be said.
pub fn set(voice: Voice) {
    VOICE.get_or_init(|| (voice, Instant::now()));
}

fn get() -> (Voice, Instant) {
    *VOICE.get_or_init(|| (Voice::Normal, Instant::now()))
}

/// Whether nothing is to be said beside the result.
pub fn is_quiet() -> bool {
    get().0 == Voice::Quiet
}

/// Says something that only a curious user wants to know.
pub fn note(text: impl FnOnce() -> String) {
    if get().0 == Voice::Verbose {
        eprintln!("{}", text());
    }
}

/// The program and its time so far, for the end of a result that people read.
pub fn signature() -> String {
    format!("\n  vibroimpact {}, {}\n", env!("CARGO_PKG_VERSION"), seconds(get().1.elapsed()))
}

/// A time to read.
pub fn seconds(time: Duration) -> String {
    quantity(time.as_secs_f64(), "s")
}
