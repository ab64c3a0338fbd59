//! Progress of a long task on the standard error: a bar on a terminal, otherwise a line from time to time.

use std::io::{IsTerminal, stderr};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// Time before the first line if there is no terminal.
const FIRST_LINE: Duration = Duration::from_secs(5);
/// Time between two lines.
const BETWEEN_LINES: Duration = Duration::from_secs(15);

/// Progress of a task with consecutive parts. The total of a part is known when it begins, and does not change.
#[derive(Debug)]
pub struct Progress {
    /// What is counted.
    unit: &'static str,
    part: String,
    done: AtomicU64,
    total: u64,
    begun: Instant,
    next_line: Mutex<Instant>,
    /// The bar, which exists only on a terminal.
    bar: Option<ProgressBar>,
}

impl Progress {
    /// Progress of a task that counts `unit`.
    pub fn of(unit: &'static str) -> Progress {
        let now = Instant::now();
        let bar = stderr().is_terminal().then(|| {
            let look =
                format!("{{elapsed_precise}} {{msg}} {{wide_bar}} {{human_pos}} of {{human_len}} {unit}, {{eta}} left");
            let style = ProgressStyle::with_template(&look).unwrap_or_else(|_| ProgressStyle::default_bar());
            ProgressBar::new(0).with_style(style)
        });
        let next_line = Mutex::new(now + FIRST_LINE);
        Progress { unit, part: String::new(), done: AtomicU64::new(0), total: 0, begun: now, next_line, bar }
    }

    /// Begins a part with this total, some of which may already be done.
    pub fn begin(&mut self, part: impl Into<String>, total: u64, done: u64) {
        (self.part, self.total, self.done) = (part.into(), total, AtomicU64::new(done));
        if let Some(bar) = &self.bar {
            bar.set_message(self.part.clone());
            bar.set_length(total);
            bar.set_position(done);
            bar.reset_eta();
        }
    }

    /// Reports that this many more are done.
    pub fn add(&self, count: u64) {
        let done = self.done.fetch_add(count, Ordering::Relaxed) + count;
        match &self.bar {
            Some(bar) => bar.inc(count),
            // not needed if another thread is writing the line
            None => {
                if let Ok(mut next) = self.next_line.try_lock()
                    && Instant::now() >= *next
                {
                    *next = Instant::now() + BETWEEN_LINES;
                    eprintln!("{}", self.line(done));
                }
            }
        }
    }

    /// How many are done, and the total.
    #[cfg(test)]
    pub(crate) fn counted(&self) -> (u64, u64) {
        (self.done.load(Ordering::Relaxed), self.total)
    }

    fn line(&self, done: u64) -> String {
        let colon = if self.part.is_empty() { "" } else { ": " };
        let elapsed_s = self.begun.elapsed().as_secs();
        // a part such as a fit counts nothing
        let count = if self.total > 0 { format!("{done} of {} {}, ", self.total, self.unit) } else { String::new() };
        format!("{}{colon}{count}{elapsed_s} s so far", self.part)
    }

    /// Removes the bar.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_counts_to_its_total() {
        let mut progress = Progress::of("impacts");
        progress.begin("Figure 3.5", 40, 0);
        for _ in 0..40 {
            progress.add(1);
        }
        assert_eq!(progress.line(40), "Figure 3.5: 40 of 40 impacts, 0 s so far");
        assert_eq!(progress.done.load(Ordering::Relaxed), progress.total);
        progress.begin("Fits", 0, 0);
        assert_eq!(progress.line(0), "Fits: 0 s so far");
        // the work of an earlier run counts
        progress.begin("", 100, 60);
        progress.add(5);
        assert_eq!(progress.line(progress.done.load(Ordering::Relaxed)), "65 of 100 impacts, 0 s so far");
    }
}
