//! The result of an identification as text.

use std::fmt::Write;

use super::summary::{Identification, Identified};
use crate::text::significant;
use crate::text::{filled, quantity};

/// Lines are at most this long.
const WIDTH: usize = 100;
/// Largest number of candidates and lines that are listed; the others are counted.
const LISTED: usize = 10;
/// Residuals beyond this many standard deviations are listed.
const FAR: f64 = 3.0;

/// Parameters with their intervals, combinations that the data do not determine, the tests of the model, and the most informative
/// experiments.
pub fn text(found: &Identification) -> String {
    let mut text = String::new();
    let level = significant(100.0 * found.level, 3);
    let _ = writeln!(text, "  {:<36}{:<16}{level} % interval", "field", "value");
    for parameter in &found.parameters {
        let _ =
            writeln!(text, "  {:<36}{:<16}{}", parameter.field, significant(parameter.value, 5), interval(parameter));
    }
    text.push('\n');
    let mut say = |name: &str, told: &str| {
        let lines = filled(told, |line| line.chars().count() + 24 <= WIDTH);
        let _ = writeln!(text, "  {name:<22}{}", lines.join(&format!("\n{}", " ".repeat(24))));
    };
    for open in &found.undetermined {
        say("not determined", &open.text);
    }
    for noise in &found.noise {
        let stated = if noise.stated { "stated" } else { "estimated from the misfit" };
        let told = format!(
            "{} values, standard deviation {} ({stated}), misfit {} rms",
            noise.count,
            significant(noise.standard_deviation, 3),
            significant(noise.rms, 3)
        );
        say(&noise.quantity, &told);
    }
    fits(found, &mut say);
    for record in &found.records {
        say(&record.file, &format!("first touch at {} by its clock", quantity(record.offset_s, "s")));
    }
    let modes =
        found.modes.map_or("all modes listed".to_owned(), |modes| format!("{modes} modes, the same for every row"));
    say("model", &modes);
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
        (None, None) => "not determined by these data".to_owned(),
    };
    match (parameter.bent, parameter.covariance_interval) {
        (true, Some([low, high])) => format!("{told} (profile; covariance {} to {})", number(low), number(high)),
        _ => told,
    }
}

fn fits(found: &Identification, say: &mut impl FnMut(&str, &str)) {
    if found.lack_of_fit.is_empty() {
        say("fit", "cannot be judged: the table states no standard deviations, and repeats no row");
    }
    for test in &found.lack_of_fit {
        let judged = if test.noticed {
            "THE MODEL DOES NOT FIT: do not trust the values and intervals above"
        } else {
            "the misfit is one of noise"
        };
        let probability =
            if test.probability < 1e-4 { "below 0.0001".to_owned() } else { significant(test.probability, 2) };
        let of = if test.test == "chi-square" {
            format!(" with {} degrees of freedom", found.degrees_of_freedom)
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
    let best = found.starts.iter().filter_map(|start| start.robust_sum).fold(f64::INFINITY, f64::min);
    let near = |sum: Option<f64>| sum.is_some_and(|sum| sum <= 1.01 * best + 1e-9);
    let same = found.starts.iter().filter(|start| near(start.robust_sum)).count();
    if found.starts.len() > 1 {
        say("search", &format!("{same} of {} starting points lead to the least robust sum", found.starts.len()));
    }
    if !found.converged {
        say("search", "NOT CONVERGED: these are the best values that were met");
    }
    if !found.grazing_lines.is_empty() {
        let lines: Vec<String> = found.grazing_lines.iter().take(LISTED).map(u64::to_string).collect();
        let told = format!(
            "the impact of line {} grazes: its number of contacts changes nearby, and the sum of squares has a kink",
            lines.join(", ")
        );
        say("rough", &told);
    }
}

fn candidates(found: &Identification, text: &mut String) {
    let _ = writeln!(text, "  next experiment: volume of the confidence region with it, over that without");
    for candidate in found.candidates.iter().take(LISTED) {
        let fields: Vec<String> = candidate.fields.iter().map(|(field, value)| format!("{field} = {value}")).collect();
        let _ = writeln!(
            text,
            "  {:<22}{}",
            format!("line {}", candidate.line),
            format_args!("{:<12}{}", significant(candidate.volume_ratio, 3), fields.join(", "))
        );
    }
    if found.candidates.len() > LISTED {
        let _ = writeln!(text, "  and {} that are less informative", found.candidates.len() - LISTED);
    }
}
