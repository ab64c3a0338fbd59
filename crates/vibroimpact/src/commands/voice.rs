//! The amount of output in addition to the result: progress and notes on the standard error, names of written files.

use std::fmt::Display;
use std::io::{Write, stderr};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use vibroimpact::text::quantity;

/// The amount of output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Voice {
    /// Only results and errors.
    Quiet,
    /// Progress of long work, and files that were written.
    Normal,
    /// Also each step and its time.
    Verbose,
}

/// The amount of output of this run of the program, and its start.
static VOICE: OnceLock<(Voice, Instant)> = OnceLock::new();

/// Sets, once and before anything else, how much is printed.
pub fn set(voice: Voice) {
    VOICE.get_or_init(|| (voice, Instant::now()));
}

fn get() -> (Voice, Instant) {
    *VOICE.get_or_init(|| (Voice::Normal, Instant::now()))
}

/// Whether only the result is printed.
pub fn is_quiet() -> bool {
    get().0 == Voice::Quiet
}

/// Prints a note if `--verbose` was given.
pub fn note(text: impl FnOnce() -> String) {
    if get().0 == Voice::Verbose {
        tell(text());
    }
}

/// Prints a line on the standard error. That it cannot be written is no reason to fail.
pub fn tell(line: impl Display) {
    let _ = writeln!(stderr(), "{line}");
}

/// The scene of this run of the program, for the end of a printed result.
static SCENE: OnceLock<String> = OnceLock::new();

/// Sets the name of the scene, with the fields that the command line changes.
pub fn name_scene(name: String) {
    SCENE.get_or_init(|| name);
}

/// The scene, the program and its time so far, for the end of a printed result.
pub fn signature() -> String {
    let scene = SCENE.get().map_or_else(String::new, |name| format!("{name}, by "));
    format!("\n  {scene}vibroimpact {} in {}\n", env!("CARGO_PKG_VERSION"), seconds(get().1.elapsed()))
}

/// A time to read.
pub fn seconds(time: Duration) -> String {
    quantity(time.as_secs_f64(), "s")
}
