//! The checks as text.

use std::fmt::Write;

use super::check::Check;
use crate::text::filled;

/// Breaks a sentence into lines of at most this many characters.
const WIDTH: usize = 96;
const INDENT: usize = 24;

/// The last part of the output of `simulate`; empty if no check applies.
pub fn trust_text(checks: &[Check]) -> String {
    let mut text = String::new();
    if checks.is_empty() {
        return text;
    }
    text += "\n  how far to trust it\n";
    for check in checks {
        let told = format!("{}: {}", check.verdict.as_str(), check.says);
        let lines = filled(&told, |line| line.chars().count() + INDENT <= WIDTH);
        let _ = writeln!(text, "    {:<20}{}", check.check.replace('_', " "), lines.join(&format!("\n{:INDENT$}", "")));
    }
    text
}
