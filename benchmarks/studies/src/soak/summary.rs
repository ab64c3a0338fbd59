//! The result of a soak: counts, extremes and failures.

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};
use std::path::Path;
use std::time::{Duration, Instant};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::cases::case;
use super::checks::{Verdict, judge};
use tasks::{BadInput, Failure, Progress};
use vibroimpact::report::write_whole;

/// Number of impacts that are solved in parallel before they are counted. They are counted in order, for any number of threads.
const BATCH: u64 = 4096;
/// Number of failures that are listed in full; further failures are only counted.
const LISTED: usize = 100;

/// The result of a soak.
#[derive(Debug, Serialize, Deserialize)]
pub struct Summary {
    /// The seed of the sequence of cases.
    pub seed: u64,
    /// Impacts solved.
    pub impacts: u64,
    /// Number of cases of each kind with each outcome; incomplete cases are counted by reason.
    pub outcomes: BTreeMap<String, u64>,
    /// Number of contacts of all impacts, and the largest number in one impact.
    pub contacts: u64,
    pub most_contacts: Extreme,
    /// Histogram of the number of steps, and the largest number.
    pub steps: BTreeMap<u64, u64>,
    pub most_steps: Extreme,
    /// Largest gain of energy relative to the gain that the tolerance allows (1 is the limit).
    pub largest_gain_over_allowed: Extreme,
    /// The same for the change of energy of impacts without dissipation, and the number of these impacts.
    pub largest_residual_over_allowed: Extreme,
    pub conservative: u64,
    /// Number of impacts that were solved again at a thousandth of the tolerance, number of those within the stated uncertainty,
    /// and the largest ratio of difference and stated uncertainty.
    pub repeated: u64,
    pub covered: u64,
    pub largest_error_over_stated: Extreme,
    /// Slowest impact (s).
    pub slowest_s: Extreme,
    pub elapsed_s: f64,
    pub threads: usize,
    /// Number of impacts that violate a condition.
    pub failed: u64,
    /// The first of these impacts, by index.
    pub failures: Vec<Fault>,
}

/// A maximum and the impact at which it occurs.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Extreme {
    pub value: f64,
    pub index: u64,
}

impl Extreme {
    const NONE: Extreme = Extreme { value: f64::MIN, index: 0 }; // finite: JSON has no infinity

    fn note(&mut self, value: f64, index: u64) {
        if value > self.value {
            *self = Extreme { value, index };
        }
    }
}

/// An impact that violates a condition.
#[derive(Debug, Serialize, Deserialize)]
pub struct Fault {
    pub index: u64,
    pub kind: String,
    pub fault: String,
}

impl Summary {
    /// A summary without impacts.
    pub fn new(seed: u64) -> Summary {
        Summary {
            seed,
            impacts: 0,
            outcomes: BTreeMap::new(),
            contacts: 0,
            most_contacts: Extreme::NONE,
            steps: BTreeMap::new(),
            most_steps: Extreme::NONE,
            largest_gain_over_allowed: Extreme::NONE,
            largest_residual_over_allowed: Extreme::NONE,
            conservative: 0,
            repeated: 0,
            covered: 0,
            largest_error_over_stated: Extreme::NONE,
            slowest_s: Extreme::NONE,
            elapsed_s: 0.0,
            threads: rayon::current_num_threads(),
            failed: 0,
            failures: Vec::new(),
        }
    }

    /// Reads the summary of an earlier run with the same seed, in order to resume it. Without such a file the summary is new.
    ///
    /// # Errors
    /// If the file is not a summary, or has another seed.
    pub fn resume(path: &Path, seed: u64) -> Result<Summary, Failure> {
        if !path.exists() {
            return Ok(Summary::new(seed));
        }
        let told = |fault| BadInput(format!("{}: {fault}", path.display()));
        let summary: Summary = serde_json::from_str(&std::fs::read_to_string(path)?).map_err(told)?;
        if summary.seed != seed {
            let fault =
                format!("--seed {seed} is not allowed; it must be {}, the seed of {}", summary.seed, path.display());
            return Err(BadInput(fault).into());
        }
        Ok(summary)
    }

    /// Solves impacts until there are `impacts` of them or the time is over. `save` is called after every batch.
    ///
    /// # Errors
    /// Errors of `save`.
    pub fn run(
        mut self,
        impacts: u64,
        limit: Option<Duration>,
        mut save: impl FnMut(&Summary) -> Result<(), Failure>,
    ) -> Result<Summary, Failure> {
        let (start, before_s) = (Instant::now(), self.elapsed_s);
        let mut progress = Progress::of("impacts");
        while self.impacts < impacts && limit.is_none_or(|limit| start.elapsed() < limit) {
            let (from, seed) = (self.impacts, self.seed);
            let to = impacts.min(from + BATCH);
            progress.begin(format!("{} failed", self.failed), impacts, from);
            let indices: Vec<u64> = (from..to).collect();
            let verdicts: Vec<Verdict> = indices
                .into_par_iter()
                .with_max_len(16)
                .map(|index| {
                    let verdict = judge(&case(seed, index));
                    progress.add(1);
                    verdict
                })
                .collect();
            for (index, verdict) in (from..to).zip(verdicts) {
                self.note(index, verdict);
            }
            self.elapsed_s = before_s + start.elapsed().as_secs_f64();
            save(&self)?;
        }
        progress.finish();
        Ok(self)
    }

    /// The number of steps that this share of the impacts does not exceed.
    fn steps_quantile(&self, share: f64) -> u64 {
        let wanted = (share * self.impacts as f64) as u64;
        let mut counted = 0;
        let reached = self.steps.iter().find(|(_, count)| {
            counted += **count;
            counted > wanted
        });
        reached.map_or(0, |(steps, _)| *steps)
    }

    fn note(&mut self, index: u64, verdict: Verdict) {
        self.impacts += 1;
        self.contacts += verdict.contacts as u64;
        *self.outcomes.entry(format!("{}: {}", verdict.kind, verdict.outcome)).or_default() += 1;
        self.most_contacts.note(verdict.contacts as f64, index);
        *self.steps.entry(verdict.steps).or_default() += 1;
        if verdict.residual_over_allowed >= 0.0 {
            self.conservative += 1;
        }
        self.largest_residual_over_allowed.note(verdict.residual_over_allowed, index);
        if verdict.error_over_stated >= 0.0 {
            self.repeated += 1;
            self.covered += u64::from(verdict.error_over_stated <= 1.0);
        }
        self.largest_error_over_stated.note(verdict.error_over_stated, index);
        self.most_steps.note(verdict.steps as f64, index);
        self.largest_gain_over_allowed.note(verdict.gain_over_allowed, index);
        self.slowest_s.note(verdict.seconds, index);
        if let Some(fault) = verdict.fault {
            self.failed += 1;
            if self.failures.len() < LISTED {
                self.failures.push(Fault { index, kind: verdict.kind.to_owned(), fault });
            }
        }
    }

    /// Writes the summary as JSON.
    pub fn write(&self, path: &Path) -> Result<(), Failure> {
        Ok(write_whole(path, (serde_json::to_string_pretty(self)? + "\n").as_bytes())?)
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
        let (median, high) = (self.steps_quantile(0.5), self.steps_quantile(0.999));
        writeln!(
            out,
            "steps tried                  median {median}, 99.9 % {high}, most {}",
            most(&self.most_steps, 0)
        )?;
        writeln!(out, "largest energy gain          {} of what is allowed", most(&self.largest_gain_over_allowed, 3))?;
        let residual = most(&self.largest_residual_over_allowed, 3);
        writeln!(out, "largest energy residual      {residual} of it, over {} without losses", self.conservative)?;
        let Summary { repeated, covered, .. } = self;
        let error = most(&self.largest_error_over_stated, 2);
        writeln!(
            out,
            "error of the restitution     within what is stated {covered} times of {repeated}, at most {error} of it"
        )?;
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
    use super::Summary;

    fn run(impacts: u64, seed: u64) -> Summary {
        Summary::new(seed).run(impacts, None, |_| Ok(())).unwrap()
    }

    #[test]
    fn two_thousand_random_impacts_hold_what_every_impact_must() {
        let summary = run(2_000, 2019);
        assert_eq!((summary.impacts, summary.failed), (2_000, 0), "{summary}");
        for kind in ["infinite: ", "modal: ", "net: ", "rod: ", "scene: "] {
            let ends = summary.outcomes.keys().filter(|outcome| outcome.starts_with(kind)).count();
            assert!(ends >= 2, "{kind}{summary}");
        }
    }

    #[test]
    fn the_same_seed_gives_the_same_run_on_any_number_of_threads() {
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(|| run(100, 7));
        let together = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap().install(|| run(100, 7));
        assert_eq!(alone.outcomes, together.outcomes);
        assert_eq!((alone.contacts, &alone.steps), (together.contacts, &together.steps));
    }

    #[test]
    fn a_run_that_goes_on_ends_as_one_in_one_piece() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("soak.json");
        Summary::resume(&path, 7).unwrap().run(60, None, |summary| summary.write(&path)).unwrap();
        let pieces = Summary::resume(&path, 7).unwrap().run(100, None, |_| Ok(())).unwrap();
        let whole = run(100, 7);
        assert_eq!((pieces.impacts, &pieces.outcomes, &pieces.steps), (whole.impacts, &whole.outcomes, &whole.steps));
        let extremes = |summary: &Summary| [summary.largest_gain_over_allowed, summary.most_steps].map(|at| at.index);
        assert_eq!(extremes(&pieces), extremes(&whole));
        assert!(Summary::resume(&path, 8).is_err());
    }
}
