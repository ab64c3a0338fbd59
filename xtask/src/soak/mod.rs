//! A long run of random impacts: no panic, no NaN, no energy gained, no hang.

mod cases;
mod checks;

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};
use std::path::Path;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;
use serde::Serialize;

use crate::chapters::Failure;
use cases::case;
use checks::{Verdict, judge};

/// Impacts that are solved side by side before anything is counted; counting is in order, whatever the threads.
const BATCH: u64 = 8192;
/// Failures listed in full; the others are counted.
const LISTED: usize = 100;

/// What a soak came to.
#[derive(Debug, Serialize)]
pub struct Summary {
    /// The seed of the row of cases.
    pub seed: u64,
    /// Impacts solved.
    pub impacts: u64,
    /// How often each kind of case ended how.
    pub outcomes: BTreeMap<String, u64>,
    /// Contacts over all impacts, and the most in one.
    pub contacts: u64,
    pub most_contacts: Extreme,
    /// Steps tried: median, 999 of 1,000, and most.
    pub steps_median: u64,
    pub steps_999_of_1000: u64,
    pub most_steps: Extreme,
    /// Largest energy gained over what the tolerance allows (1 is the limit).
    pub largest_gain_over_allowed: Extreme,
    /// Slowest impact (s).
    pub slowest_s: Extreme,
    pub elapsed_s: f64,
    pub threads: usize,
    /// Impacts for which something did not hold.
    pub failed: u64,
    /// The first of them, by index.
    pub failures: Vec<Fault>,
}

/// A largest value, and the impact that has it.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Extreme {
    pub value: f64,
    pub index: u64,
}

impl Extreme {
    const NONE: Extreme = Extreme { value: f64::NEG_INFINITY, index: 0 };

    fn note(&mut self, value: f64, index: u64) {
        if value > self.value {
            *self = Extreme { value, index };
        }
    }
}

/// An impact for which something does not hold.
#[derive(Debug, Serialize)]
pub struct Fault {
    pub index: u64,
    pub kind: &'static str,
    pub fault: String,
}

/// Solves `impacts` random cases, or as many as `limit` allows.
pub fn run(impacts: u64, seed: u64, limit: Option<Duration>) -> Summary {
    let start = Instant::now();
    let style = ProgressStyle::with_template("{bar:30} {human_pos}/{human_len} impacts, {msg}, {eta} left");
    let bar = ProgressBar::new(impacts).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar.set_message("0 failed");
    let mut summary = Summary {
        seed,
        impacts: 0,
        outcomes: BTreeMap::new(),
        contacts: 0,
        most_contacts: Extreme::NONE,
        steps_median: 0,
        steps_999_of_1000: 0,
        most_steps: Extreme::NONE,
        largest_gain_over_allowed: Extreme::NONE,
        slowest_s: Extreme::NONE,
        elapsed_s: 0.0,
        threads: rayon::current_num_threads(),
        failed: 0,
        failures: Vec::new(),
    };
    let mut steps = Vec::new();
    while summary.impacts < impacts && limit.is_none_or(|limit| start.elapsed() < limit) {
        let from = summary.impacts;
        let to = impacts.min(from + BATCH);
        let indices: Vec<u64> = (from..to).collect();
        let verdicts: Vec<Verdict> = indices
            .into_par_iter()
            .with_max_len(16)
            .map(|index| {
                let verdict = judge(&case(seed, index));
                bar.inc(1);
                verdict
            })
            .collect();
        for (index, verdict) in (from..to).zip(verdicts) {
            steps.push(verdict.steps);
            summary.note(index, verdict);
        }
        bar.set_message(format!("{} failed", summary.failed));
    }
    bar.finish_and_clear();
    steps.sort_unstable();
    let quantile = |share: f64| steps.get((share * steps.len() as f64) as usize).copied().unwrap_or(0);
    (summary.steps_median, summary.steps_999_of_1000) = (quantile(0.5), quantile(0.999));
    summary.elapsed_s = start.elapsed().as_secs_f64();
    summary
}

/// Solves one case again and tells everything about it.
pub fn one(seed: u64, index: u64) -> String {
    let case = case(seed, index);
    format!("{case:#?}\n{:#?}", judge(&case))
}

impl Summary {
    fn note(&mut self, index: u64, verdict: Verdict) {
        self.impacts += 1;
        self.contacts += verdict.contacts as u64;
        *self.outcomes.entry(format!("{}: {}", verdict.kind, verdict.outcome)).or_default() += 1;
        self.most_contacts.note(verdict.contacts as f64, index);
        self.most_steps.note(verdict.steps as f64, index);
        self.largest_gain_over_allowed.note(verdict.gain_over_allowed, index);
        self.slowest_s.note(verdict.seconds, index);
        if let Some(fault) = verdict.fault {
            self.failed += 1;
            if self.failures.len() < LISTED {
                self.failures.push(Fault { index, kind: verdict.kind, fault });
            }
        }
    }

    /// Writes the summary as JSON.
    pub fn write(&self, path: &Path) -> Result<(), Failure> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        Ok(std::fs::write(path, serde_json::to_string_pretty(self)? + "\n")?)
    }
}

impl Display for Summary {
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        let Summary { seed, impacts, contacts, elapsed_s, threads, failed, .. } = self;
        writeln!(out, "{impacts} impacts with {contacts} contacts, seed {seed}: {failed} failed")?;
        for (outcome, count) in &self.outcomes {
            writeln!(out, "  {count:>9}  {outcome}")?;
        }
        let most = |extreme: &Extreme, digits: usize| format!("{:.digits$} (--only {})", extreme.value, extreme.index);
        writeln!(out, "most contacts in one impact  {}", most(&self.most_contacts, 0))?;
        let (median, high) = (self.steps_median, self.steps_999_of_1000);
        writeln!(
            out,
            "steps tried                  median {median}, 99.9 % {high}, most {}",
            most(&self.most_steps, 0)
        )?;
        writeln!(out, "largest energy gain          {} of what is allowed", most(&self.largest_gain_over_allowed, 3))?;
        writeln!(out, "slowest impact               {} s", most(&self.slowest_s, 3))?;
        write!(out, "elapsed                      {elapsed_s:.0} s on {threads} threads")?;
        for Fault { index, kind, fault } in &self.failures {
            write!(out, "\nFAILED --only {index} ({kind}): {fault}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::run;

    #[test]
    fn two_thousand_random_impacts_hold_what_every_impact_must() {
        let summary = run(2_000, 2019, None);
        assert_eq!((summary.impacts, summary.failed), (2_000, 0), "{summary}");
        for kind in ["infinite: ", "modal: ", "net: ", "scene: "] {
            let ends = summary.outcomes.keys().filter(|outcome| outcome.starts_with(kind)).count();
            assert!(ends >= 2, "{kind}{summary}");
        }
    }

    #[test]
    fn the_same_seed_gives_the_same_run_on_any_number_of_threads() {
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(|| run(100, 7, None));
        let together = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap().install(|| run(100, 7, None));
        assert_eq!(alone.outcomes, together.outcomes);
        assert_eq!((alone.contacts, alone.steps_median), (together.contacts, together.steps_median));
    }
}
