//! The result of an identification as text.

use std::fmt::Write;

use serde_json::Value;

use super::forward::SHARE_OF_NOISE;
use super::summary::{Identification, Identified};
use crate::text::{counted, filled, printable, quantity, significant};

/// Lines are at most this long.
const WIDTH: usize = 100;
/// Widths of the columns of labels, fields and values; a longer entry is followed by two spaces.
const LABELS: usize = 22;
const FIELDS: usize = 34;
const VALUES: usize = 14;
/// Largest number of candidates and lines that are listed; the others are counted.
const LISTED: usize = 10;
/// Residuals beyond this many standard deviations are listed.
const FAR: f64 = 3.0;
/// A misfit at least this improbably small shows that the stated standard deviations are too large.
const TOO_SMALL: f64 = 0.999;

/// Parameters with their intervals, combinations that the data do not determine, the tests of the model, and the most informative
/// experiments.
pub fn text(found: &Identification) -> String {
    let mut text = String::new();
    let level = significant(100.0 * found.level, 3);
    let fields = found.parameters.iter().map(|parameter| parameter.field.chars().count()).fold(FIELDS, usize::max);
    let mut line = |field: &str, value: &str, interval: &str| {
        let _ = writeln!(text, "  {field:<fields$}  {value:<VALUES$}  {interval}");
    };
    line("field", "value", &format!("{level} % interval"));
    for parameter in &found.parameters {
        let value = match parameter.determined {
            true => significant(parameter.value, 5),
            false => "not determined".to_owned(),
        };
        line(&parameter.field, &value, &interval(parameter));
    }
    text.push('\n');
    let mut say = |name: &str, told: &str| {
        let lines = filled(told, |line| line.chars().count() + LABELS + 2 <= WIDTH);
        let gap = if name.chars().count() < LABELS { "" } else { "  " };
        let _ = writeln!(text, "  {name:<LABELS$}{gap}{}", lines.join(&format!("\n{}", " ".repeat(LABELS + 2))));
    };
    for open in &found.undetermined {
        say("not determined", &open.text);
    }
    for known in &found.combinations {
        let [value, low, high] = [known.value, known.interval[0], known.interval[1]].map(|one| significant(one, 5));
        say("determined", &format!("{} = {value}, {level} % interval {low} to {high}", known.product));
    }
    for noise in &found.noise {
        let stated = if noise.stated { "stated" } else { "estimated from the misfit" };
        let told = format!(
            "{}, standard deviation {} ({stated}), misfit {} rms",
            counted(noise.count as u64, "value", "values"),
            significant(noise.standard_deviation, 3),
            significant(noise.rms, 3)
        );
        say(&noise.quantity, &told);
    }
    fits(found, &mut say);
    for record in &found.records {
        say(&record.file, &format!("first touch at {} by its clock", quantity(record.offset_s, "s")));
    }
    let modes = |count| counted(count as u64, "mode", "modes");
    say("model", &(found.modes.map_or("all modes listed".to_owned(), modes) + ", the same for every row"));
    if let Some(sd) = found.left_out_modes_sd.filter(|sd| *sd > SHARE_OF_NOISE) {
        let sd = significant(sd, 2);
        say("further modes", &format!("may change a measured quantity by {sd} standard deviations of its noise"));
    }
    search(found, &mut say);
    if !found.candidates.is_empty() {
        text.push('\n');
        candidates(found, &mut text);
    }
    text
}

fn interval(parameter: &Identified) -> String {
    let number = |value: f64| significant(value, 5);
    let [low, high] = parameter.profile_interval;
    let told = match (low, high) {
        (Some(low), Some(high)) => format!("{} to {}", number(low), number(high)),
        (Some(low), None) => format!("above {}", number(low)),
        (None, Some(high)) => format!("below {}", number(high)),
        (None, None) => "open".to_owned(),
    };
    if !parameter.determined {
        return format!("{told}; the search stopped at {}", significant(parameter.value, 2));
    }
    match (parameter.bent, parameter.covariance_interval) {
        (true, Some([low, high])) => format!("{told} (profile; covariance {} to {})", number(low), number(high)),
        _ => told,
    }
}

/// How many of the starting points lead to the least robust sum.
fn agreeing(found: &Identification) -> usize {
    let best = found.starts.iter().filter_map(|start| start.robust_sum).fold(f64::INFINITY, f64::min);
    let near = |sum: Option<f64>| sum.is_some_and(|sum| sum <= 1.01 * best + 1e-9);
    found.starts.iter().filter(|start| near(start.robust_sum)).count()
}

/// Whether a starting point leads elsewhere: the sum then has several minima, and the least may be missed. (Most starting points
/// are near the best ones, so that many of them may agree.)
fn is_rough(found: &Identification) -> bool {
    agreeing(found) < found.starts.len()
}

fn fits(found: &Identification, say: &mut impl FnMut(&str, &str)) {
    if found.lack_of_fit.is_empty() {
        let reason = if found.degrees_of_freedom == 0 {
            "there are as many parameters as measured values"
        } else {
            "the table states no standard deviations, and no repeated rows tell the noise from the rest of the misfit"
        };
        say("fit", &format!("cannot be judged: {reason}"));
    }
    for test in &found.lack_of_fit {
        let judged = if test.noticed && (is_rough(found) || found.starts.len() < 2) {
            "THE MODEL DOES NOT FIT, or the search has missed the least sum: do not trust the values and intervals above"
        } else if test.noticed {
            "THE MODEL DOES NOT FIT: do not trust the values and intervals above"
        } else if test.test == "chi-square" && test.probability > TOO_SMALL {
            "the misfit is smaller than the stated noise: the standard deviations are probably too large"
        } else {
            "the misfit is one of noise"
        };
        let probability =
            if test.probability < 1e-4 { "below 0.0001".to_owned() } else { significant(test.probability, 2) };
        let of = if test.test == "chi-square" {
            format!(" with {}", counted(found.degrees_of_freedom as u64, "degree of freedom", "degrees of freedom"))
        } else {
            String::new()
        };
        say(
            "fit",
            &format!("{} {}{of}, probability {probability}: {judged}", test.test, significant(test.statistic, 4)),
        );
    }
    let far = found.predictions.iter().map(|p| (p, (p.measured - p.predicted) / p.measured_sd));
    let mut far: Vec<_> = far.filter(|(_, r)| r.abs() > FAR).collect();
    far.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    for (one, r) in far.iter().take(LISTED) {
        say("far off", &format!("line {}, {}: {:+.1} standard deviations", one.line, one.quantity, r));
    }
}

fn search(found: &Identification, say: &mut impl FnMut(&str, &str)) {
    if found.starts.len() > 1 {
        let same = agreeing(found);
        let lead = if same == 1 { "leads" } else { "lead" };
        let rough = match is_rough(found) {
            true => {
                ": there are other minima, and the intervals are too narrow if one is as low; try more starting \
                 points, or leave out rows with many contacts"
            }
            false => "",
        };
        let count = found.starts.len();
        say("search", &format!("{same} of {count} starting points {lead} to the least robust sum{rough}"));
    } else {
        say("search", "from one starting point: the sum may have lower minima elsewhere");
    }
    if !found.converged {
        say("search", "NOT CONVERGED: these are the best values that were met");
    }
    if let [first, others @ ..] = &found.grazing_lines[..] {
        let lines: Vec<String> = found.grazing_lines.iter().take(LISTED).map(u64::to_string).collect();
        let more = found.grazing_lines.len().saturating_sub(LISTED);
        let told = match (others, more) {
            ([], _) => format!("the impact of line {first} grazes"),
            (_, 0) => format!("the impacts of lines {} graze", lines.join(", ")),
            _ => format!("the impacts of lines {} and of {more} others graze", lines.join(", ")),
        };
        say("rough", &(told + ": the number of contacts changes nearby, and the sum of squares has a kink"));
    }
}

fn candidates(found: &Identification, text: &mut String) {
    let _ = writeln!(text, "  next experiment: volume of the confidence region with it, over that without");
    let resolved: Vec<_> =
        found.candidates.iter().filter_map(|one| one.volume_ratio.map(|ratio| (one, ratio))).collect();
    for (candidate, ratio) in resolved.iter().take(LISTED) {
        let told = |(field, value): (&String, &Value)| match value {
            Value::String(name) => format!("{field} = {}", printable(name)),
            other => format!("{field} = {}", other.as_f64().map_or(other.to_string(), |value| significant(value, 6))),
        };
        let fields: Vec<String> = candidate.fields.iter().map(told).collect();
        let line = format!("line {}", candidate.line);
        let _ = writeln!(text, "  {line:<LABELS$}{:<12}{}", significant(*ratio, 3), fields.join(", "));
    }
    if resolved.len() > LISTED {
        let _ = writeln!(
            text,
            "  and {} less informative",
            counted((resolved.len() - LISTED) as u64, "that is", "that are")
        );
    }
    let lost: Vec<String> =
        found.candidates.iter().filter(|one| one.volume_ratio.is_none()).map(|one| one.line.to_string()).collect();
    if !lost.is_empty() {
        let lines = if lost.len() == 1 { "line" } else { "lines" };
        let _ = writeln!(
            text,
            "  not rated: {lines} {}, whose impact lacks a measured quantity or cannot be resolved",
            lost.join(", ")
        );
    }
}
