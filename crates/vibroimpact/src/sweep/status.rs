//! How far a sweep has come, and where its rows go.

use super::definition::Sweep;
use super::error::SweepError;
use super::part::Part;

/// Takes rows in order.
pub(super) trait Sink {
    /// How many chunks it has, from the first of the part.
    fn chunks(&self) -> u64;
    /// Takes the rows of the next chunks.
    fn append(&mut self, chunks: u64, rows: &[u8]) -> Result<(), SweepError>;
}

/// How far a sweep, or a part of one, has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Status {
    /// Points whose rows are in the folder.
    pub done: u64,
    /// Points in all.
    pub points: u64,
}

impl Status {
    pub(super) fn of(sweep: &Sweep, part: Part, sink: &impl Sink) -> Status {
        let chunks = part.chunks(sweep.chunks());
        let all = sweep.first_of_chunk(chunks.start)..sweep.first_of_chunk(chunks.end);
        let done = sweep.first_of_chunk(chunks.start + sink.chunks());
        Status { done: done - all.start, points: all.end - all.start }
    }

    /// Whether nothing is left to compute.
    pub fn is_complete(&self) -> bool {
        self.done == self.points
    }
}
