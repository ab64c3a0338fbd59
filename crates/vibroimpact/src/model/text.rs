//! Choice, plan and comparison as text.

use std::fmt::Write;

use super::{Answer, Comparison, Plan};
use crate::text::{counted, filled, quantity, restitution, small, stopped};

/// Largest number of characters of a line.
const WIDTH: usize = 96;

/// Breaks a sentence into lines, all but the first indented.
pub(crate) fn wrapped(text: &str, indent: usize) -> String {
    let lines = filled(text, |line| line.chars().count() + indent <= WIDTH);
    lines.join(&format!("\n{}", " ".repeat(indent)))
}

/// Comparison of the estimated error with the tolerance.
fn against_tolerance(answer: &Answer) -> String {
    let wanted = small(answer.tolerance);
    match (answer.uncertainty.of_model(), answer.settled) {
        (Some(u), true) if u <= answer.tolerance => {
            let margin = answer.tolerance / u;
            // the uncertainty of a converged answer is often the tolerance itself
            let better = if margin < 1.5 { String::new() } else { format!(" ({} times better)", small(margin)) };
            format!("requested {wanted}, known within {}{better}", small(u))
        }
        (Some(u), true) => {
            let solver = answer.uncertainty.solver.unwrap_or(u);
            format!("requested {wanted} for the modes as stated, whose motion is solved within {}", small(solver))
        }
        (Some(u), false) => {
            let spread = answer.spread.map_or(String::new(), |s| format!(", spread {}", small(s)));
            format!("requested {wanted}, known within {}; NOT CONVERGED{spread}", small(u))
        }
        (None, _) => format!("requested {wanted}; the reached accuracy is not known"),
    }
}

/// Description of each part of the uncertainty.
fn meaning(part: &str) -> &'static str {
    match part {
        "solver" => "error in solving the equations of this model",
        "modes left out" => "change by all further modes of the structure",
        _ => "change by the other theory of bending, or by 2 % of the shear coefficient",
    }
}

/// The names of the parts of the uncertainty, and their sizes and meanings, or why they are not known.
pub(crate) fn parts_in_words(answer: &Answer) -> Vec<(&'static str, String)> {
    let told = |(name, part): (&'static str, Option<f64>)| {
        let why = answer.not_known.iter().find_map(|why| why.strip_prefix(name)?.strip_prefix(": "));
        let told = match part {
            Some(part) => format!("{}: {}", small(part), meaning(name)),
            None => format!("not known: {}", why?),
        };
        Some((name, told))
    };
    answer.uncertainty.parts().into_iter().filter_map(told).collect()
}

fn parts(answer: &Answer) -> String {
    let mut text = String::new();
    for (name, told) in parts_in_words(answer) {
        let _ = writeln!(text, "    {name:<20}{}", wrapped(&told, 24));
    }
    if text.is_empty() { text } else { format!("  uncertainty\n{text}") }
}

/// Description of the computation, and comparison of the estimated error with the tolerance.
pub fn answer_text(answer: &Answer) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "  {:<22}{}", "model", wrapped(&answer.reason, 24));
    text += &parts(answer);
    let _ = writeln!(text, "  {:<22}{}", "accuracy", wrapped(&against_tolerance(answer), 24));
    let cost = &answer.cost;
    let _ =
        writeln!(text, "  {:<22}{}, {} mode-steps", "cost", counted(cost.solves, "solve", "solves"), cost.mode_steps);
    text
}

/// The result of a model that does not resolve the motion in time.
pub fn net_text(answer: &Answer) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:<22}{value}");
    };
    line("outcome", stopped(answer.stopped_by).unwrap_or_else(|| answer.outcome.to_owned()));
    if let Some(value) = answer.restitution {
        line("restitution", restitution(value, answer.restitution_uncertainty));
    }
    if let Some(count) = answer.sub_impact_count {
        line("sub-impacts", count.to_string());
    }
    text + &answer_text(answer)
}

/// A plan.
pub fn plan_text(plan: &Plan) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "  {:<22}{}", "model", plan.model.as_str());
    let _ = writeln!(text, "  {:<22}{}", "tolerance", small(plan.tolerance));
    if let Some(duration) = plan.contact_duration_s {
        let _ = writeln!(text, "  {:<22}{} on an immovable surface", "contact", quantity(duration, "s"));
    }
    let _ = writeln!(text, "\n  {:<16}{:>10}{:>24}{:>24}", "model", "error", "mode-steps", "time");
    for tier in &plan.tiers {
        let error = tier.expected_error.map_or_else(|| "-".to_owned(), small);
        let _ = writeln!(
            text,
            "  {:<16}{error:>10}{:>24}{:>24}",
            tier.model.as_str(),
            range(tier.mode_steps.map(|steps| steps.to_string())),
            range(tier.time_s.map(|time| quantity(time, "s")))
        );
        let applies = if tier.applies { "" } else { "no: " };
        let _ = writeln!(text, "      {}", wrapped(&format!("{applies}{}", tier.reason), 6));
    }
    text
}

/// The two ends of a range, or the one value.
fn range([least, most]: [String; 2]) -> String {
    if least == most { format!("~{least}") } else { format!("{least} to {most}") }
}

/// A comparison.
pub fn comparison_text(comparison: &Comparison) -> String {
    let mut text = String::new();
    let _ = writeln!(
        text,
        "  {:<16}{:>14}{:>12}{:>12}{:>10}{:>12}",
        "model", "restitution", "uncertainty", "sub-imp.", "modes", "difference"
    );
    for tier in &comparison.tiers {
        let name = tier.model.as_str();
        let Some(answer) = &tier.answer else {
            let refused = tier.refused.as_deref().unwrap_or_default();
            let _ = writeln!(text, "  {name:<16}{}", wrapped(&format!("does not apply: {refused}"), 18));
            continue;
        };
        let or_dash = |value: Option<String>| value.unwrap_or_else(|| "-".to_owned());
        let _ = writeln!(
            text,
            "  {name:<16}{:>14}{:>12}{:>12}{:>10}{:>12}{}",
            or_dash(answer.restitution.map(|e| format!("{e:.6}"))),
            or_dash(answer.restitution_uncertainty.map(small)),
            or_dash(answer.sub_impact_count.map(|count| count.to_string())),
            answer.modes,
            or_dash(tier.difference.map(|d| format!("{d:+.1e}"))),
            if answer.model == comparison.chosen.model { "   chosen" } else { "" }
        );
        let _ = writeln!(
            text,
            "      {}",
            wrapped(
                &format!(
                    "{}; {}, {} mode-steps",
                    answer.reason,
                    counted(answer.cost.solves, "solve", "solves"),
                    answer.cost.mode_steps
                ),
                6
            )
        );
    }
    let _ = writeln!(
        text,
        "\n  Differences are from {}, whose uncertainty is the smallest{}.",
        comparison.best.as_str(),
        if comparison.best_leaves_modes_out() {
            " as far as it is known; the effect of its truncated modes is not known"
        } else {
            ""
        }
    );
    let _ = writeln!(
        text,
        "  The model emoc is a net law with fixed parameters; vibroimpact emoc takes the three-parameter law of thesis\n  \
         chapter 7, which is to be fitted to the structure, and gives another number."
    );
    text
}
