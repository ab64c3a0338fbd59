//! Chapter 4
use super::Failure;
use super::study::Study;
pub(super) fn run(_study: &mut Study) -> Result<&'static str, Failure> { Ok("x") }
