//! The parts into which a sweep is divided for several machines.

use std::ops::Range;

use serde::{Deserialize, Serialize};

/// One of the parts into which a sweep is divided: neighbouring chunks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Part {
    /// Number of the part, from 1.
    pub number: u64,
    /// Number of parts.
    pub of: u64,
}

impl Part {
    /// The whole sweep.
    pub const WHOLE: Part = Part { number: 1, of: 1 };

    /// Reads `K/N`, as in `3/8`.
    pub fn parse(text: &str) -> Option<Part> {
        let (number, of) = text.split_once('/')?;
        let part = Part { number: number.parse().ok()?, of: of.parse().ok()? };
        (part.number >= 1 && part.number <= part.of && part.of <= 1_000_000).then_some(part)
    }

    /// Its share of this many chunks.
    pub(super) fn chunks(self, all: u64) -> Range<u64> {
        // at most 1e10 chunks and 1e6 parts: the products are exact
        let bound = |parts: u64| all * parts / self.of;
        bound(self.number - 1)..bound(self.number)
    }
}
