//! Distributes chunks to workers in any order, and sorts their rows.

use std::collections::BTreeMap;
use std::ops::Range;

/// Largest number of open chunks per worker: enough that one slow chunk does not stop the others, few enough that waiting rows fit
/// in memory.
const AHEAD: u64 = 64;

/// Instruction for a worker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Order {
    /// Compute this chunk.
    Chunk(u64),
    /// Ask again when a chunk has been completed.
    Wait,
    /// All chunks have begun.
    Done,
}

/// The state of a running computation.
#[derive(Debug)]
pub(super) struct Assembly {
    /// Chunks not yet handed out.
    left: Range<u64>,
    /// First chunk whose rows are neither in `ready` nor written.
    missing: u64,
    /// Rows of chunks that were finished early.
    early: BTreeMap<u64, Vec<u8>>,
    /// Rows that can be written, and the number of their chunks.
    ready: (u64, Vec<u8>),
    window: u64,
}

impl Assembly {
    pub(super) fn new(chunks: Range<u64>, workers: usize) -> Assembly {
        let missing = chunks.start;
        Assembly {
            left: chunks,
            missing,
            early: BTreeMap::new(),
            ready: (0, Vec::new()),
            window: AHEAD * workers as u64,
        }
    }

    /// Instruction for the next free worker.
    pub(super) fn hand_out(&mut self) -> Order {
        if self.left.is_empty() {
            Order::Done
        } else if self.left.start >= self.missing + self.window {
            Order::Wait
        } else {
            self.left.start += 1;
            Order::Chunk(self.left.start - 1)
        }
    }

    /// Receives the rows of a chunk.
    pub(super) fn take_in(&mut self, chunk: u64, rows: Vec<u8>) {
        self.early.insert(chunk, rows);
        while let Some(rows) = self.early.remove(&self.missing) {
            self.missing += 1;
            self.ready.0 += 1;
            self.ready.1.extend(rows);
        }
    }

    /// The rows that can be written, and the number of their chunks.
    pub(super) fn take_ready(&mut self) -> (u64, Vec<u8>) {
        std::mem::take(&mut self.ready)
    }

    /// Whether every chunk is finished.
    pub(super) fn is_complete(&self) -> bool {
        self.left.is_empty() && self.missing == self.left.end
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_out_in_order_whatever_the_order_they_came_in() {
        let mut assembly = Assembly::new(3..7, 1);
        for chunk in 3..7 {
            assert_eq!(assembly.hand_out(), Order::Chunk(chunk));
        }
        assert_eq!(assembly.hand_out(), Order::Done);
        assembly.take_in(4, vec![4]);
        assembly.take_in(6, vec![6]);
        assert_eq!(assembly.take_ready(), (0, vec![]));
        assembly.take_in(3, vec![3]);
        assert_eq!(assembly.take_ready(), (2, vec![3, 4]));
        assert!(!assembly.is_complete());
        assembly.take_in(5, vec![5]);
        assert!(assembly.is_complete());
        assert_eq!(assembly.take_ready(), (2, vec![5, 6]));
    }

    #[test]
    fn a_slow_chunk_holds_the_others_back_at_last() {
        let mut assembly = Assembly::new(0..1000, 1);
        for chunk in 0..AHEAD {
            assert_eq!(assembly.hand_out(), Order::Chunk(chunk));
        }
        for chunk in 1..AHEAD {
            assembly.take_in(chunk, vec![0]);
        }
        assert_eq!(assembly.hand_out(), Order::Wait);
        assembly.take_in(0, vec![0]);
        assert_eq!(assembly.hand_out(), Order::Chunk(AHEAD));
    }
}
