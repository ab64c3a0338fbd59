//! The summary of a sweep.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde::{Deserialize, Serialize};

use super::row::Row;
use super::uncertain::{self, Distributions, OutputDistribution, Uncertain};
use crate::text::significant;

/// Largest number of failures that are listed.
const FAILURES_TOLD: usize = 5;

/// Counts, extremes and costs of a sweep's results.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Tally {
    /// Points.
    pub points: u64,
    /// Number of points by outcome, without those that failed.
    pub outcomes: BTreeMap<String, u64>,
    /// Points by the model that was solved.
    pub models: BTreeMap<String, u64>,
    /// Points whose restitution is not known to the requested tolerance.
    pub unsettled: u64,
    /// Points whose scene could not be solved.
    pub failures: u64,
    /// The first of them.
    pub first_failures: Vec<FailedPoint>,
    /// Least and greatest restitution; null if there is none.
    pub restitution: Option<Extremes>,
    /// Least and greatest uncertainty of the restitution; null if there is none.
    pub restitution_uncertainty: Option<Extremes>,
    /// Least and greatest number of sub-impacts; null if there is none.
    pub sub_impact_count: Option<Extremes>,
    /// Least and greatest number of intervals of contact in a run; null for single impacts.
    pub intervals: Option<Extremes>,
    /// Least and greatest of the largest forces of runs (N); null for single impacts.
    pub largest_force_n: Option<Extremes>,
    /// Least and greatest work of compression over time (W); null for single impacts.
    pub contact_work_rate_w: Option<Extremes>,
    /// Number of runs under a harmonic load by the motion to which they have converged, as `intervals/periods`, or `none`.
    pub motions: BTreeMap<String, u64>,
    /// The distribution of each output with uncertain fields, if there is no grid.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub distributions: BTreeMap<String, OutputDistribution>,
    /// For each output the least and greatest width of the interval of nine draws of ten over the points of the grid, if there is
    /// one; each index is that of the grid point.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub width_90: BTreeMap<String, Extremes>,
    /// Steps in contact, over all points.
    pub contact_steps: u64,
    /// Evaluations of the contact law, over all points.
    pub law_evaluations: u64,
    /// Steps times modes, over all points.
    pub mode_steps: u64,
}

/// A point whose scene could not be solved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FailedPoint {
    /// Its number.
    pub index: u64,
    /// The reason.
    pub error: String,
}

/// The least and the greatest of some numbers, and the points where they first occur.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Extremes {
    /// The least.
    pub least: f64,
    /// Its point.
    pub least_index: u64,
    /// The greatest.
    pub greatest: f64,
    /// Its point.
    pub greatest_index: u64,
}

impl Extremes {
    fn with(found: Option<Extremes>, value: f64, index: u64) -> Extremes {
        let Some(mut all) = found else {
            return Extremes { least: value, least_index: index, greatest: value, greatest_index: index };
        };
        if value < all.least {
            (all.least, all.least_index) = (value, index);
        }
        if value > all.greatest {
            (all.greatest, all.greatest_index) = (value, index);
        }
        all
    }
}

impl Tally {
    pub(super) fn add(&mut self, index: u64, row: &Row) {
        self.points += 1;
        let error = row.text("error");
        if error.is_empty() {
            *self.outcomes.entry(row.text("outcome").to_owned()).or_default() += 1;
            self.unsettled += u64::from(row.text("settled") == "false");
            for (counts, name) in [(&mut self.models, row.text("model")), (&mut self.motions, &row.motion())] {
                if !name.is_empty() {
                    *counts.entry(name.to_owned()).or_default() += 1;
                }
            }
        } else {
            self.failures += 1;
            if self.first_failures.len() < FAILURES_TOLD {
                self.first_failures.push(FailedPoint { index, error: error.to_owned() });
            }
        }
        for (found, name) in [
            (&mut self.restitution, "restitution"),
            (&mut self.restitution_uncertainty, "restitution_uncertainty"),
            (&mut self.sub_impact_count, "sub_impact_count"),
            (&mut self.intervals, "intervals"),
            (&mut self.largest_force_n, "largest_force_n"),
            (&mut self.contact_work_rate_w, "contact_work_rate_w"),
        ] {
            if let Some(value) = row.number(name) {
                *found = Some(Extremes::with(*found, value, index));
            }
        }
        let count = |name: &str| row.text(name).parse().unwrap_or(0u64);
        self.contact_steps = self.contact_steps.saturating_add(count("contact_steps"));
        self.law_evaluations = self.law_evaluations.saturating_add(count("law_evaluations"));
        self.mode_steps = self.mode_steps.saturating_add(count("mode_steps"));
    }

    /// Adds the distributions at the points of a grid, or those of a sweep without a grid.
    pub(super) fn add_distributions(&mut self, uncertain: &Uncertain, has_grid: bool, found: &[Distributions]) {
        for (place, found) in (0..).zip(found) {
            for (output, one) in uncertain.outputs.iter().zip(found) {
                let Some(one) = one else { continue };
                if has_grid {
                    let before = self.width_90.get(&output.name).copied();
                    let widths = Extremes::with(before, one.width_90.value, place);
                    self.width_90.insert(output.name.clone(), widths);
                } else {
                    self.distributions.insert(output.name.clone(), one.clone());
                }
            }
        }
    }

    /// The summary as text.
    pub fn text(&self) -> String {
        let counts = |counts: &BTreeMap<String, u64>| {
            counts.iter().map(|(name, count)| format!("{count} {name}")).collect::<Vec<_>>().join(", ")
        };
        let mut lines = String::new();
        let mut line = |name: &str, text: &str| {
            // writing to a String cannot fail
            let _ = writeln!(lines, "  {name:<22}{text}");
        };
        line("points", &self.points.to_string());
        line("outcomes", &counts(&self.outcomes));
        for (name, groups) in [("models", &self.models), ("intervals/periods", &self.motions)] {
            if !groups.is_empty() {
                line(name, &counts(groups));
            }
        }
        if self.unsettled > 0 {
            line("not converged", &format!("{} (column settled)", self.unsettled));
        }
        if self.failures > 0 {
            line("failed", &self.failures.to_string());
            for FailedPoint { index, error } in &self.first_failures {
                line("", &format!("point {index}: {error}"));
            }
            if self.failures > self.first_failures.len() as u64 {
                line("", "... (column error)");
            }
        }
        let range = |extremes: &Extremes, point: &str| {
            let Extremes { least, least_index, greatest, greatest_index } = extremes;
            let digits = |value: &f64| significant(*value, 4);
            format!("{} ({point} {least_index}) to {} ({point} {greatest_index})", digits(least), digits(greatest))
        };
        for (name, found) in [
            ("restitution", &self.restitution),
            ("uncertainty", &self.restitution_uncertainty),
            ("sub-impacts", &self.sub_impact_count),
            ("intervals", &self.intervals),
            ("largest force, N", &self.largest_force_n),
            ("contact work rate, W", &self.contact_work_rate_w),
        ] {
            if let Some(extremes) = found {
                line(name, &range(extremes, "point"));
            }
        }
        for (output, extremes) in &self.width_90 {
            line("width of 9 in 10", &format!("{output} {}", range(extremes, "grid point")));
        }
        let Tally { contact_steps, law_evaluations, mode_steps, .. } = self;
        line("cost", &format!("{contact_steps} steps in contact, {law_evaluations} evaluations of the law"));
        if *mode_steps > 0 {
            line("", &format!("{mode_steps} steps times modes"));
        }
        lines.extend(self.distributions.iter().map(|(output, found)| uncertain::text(output, found)));
        lines
    }
}
