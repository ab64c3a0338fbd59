//! Chapter 6: the forms of the law agree, its solution is unique, its energy never grows.

use super::Failure;
use super::study::Study;

const INTRODUCTION: &str = "";

/// Runs the chapter and returns the text that introduces its report.
pub(super) fn run(_study: &mut Study) -> Result<&'static str, Failure> {
    Ok(INTRODUCTION)
}
