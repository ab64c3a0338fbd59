//! Comparison of the resolved drops with the abstract of Stoianovici and Hurmuzlu (1996, doi:10.1115/1.2788865), which
//! describes their measurements in words. The thesis does not contain these words.

use super::Parameters;
use super::drops::{DropRow, solve};
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use tasks::Failure;
use vibroimpact::report::significant;

const SOURCE: &str = "[19], abstract";
/// A tenth of the range from 0 to 1.
const CLEAR: f64 = 0.1;

/// Difference of the largest and the smallest restitution over the inclinations.
fn range(rows: &[&DropRow]) -> f64 {
    let e = rows.iter().map(|row| row.restitution.unwrap_or(f64::NAN));
    let (low, high) = e.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), e| (low.min(e), high.max(e)));
    high - low
}

pub(super) fn run(study: &mut Study, parameters: &Parameters, drops: &[DropRow]) -> Result<(), Failure> {
    study.section("What the abstract of the experiments says");
    study.text(
        "The thesis quotes Stoianovici and Hurmuzlu (1996) only in a few words and a figure, whose points we do not \
         have. Their abstract (doi:10.1115/1.2788865) makes three statements that can be compared with resolved drops: \
         the restitution varies with the inclination, vibration and multiple impacts cause the variation, and the \
         restitution of bars that are not slender enough does not vary.",
    );
    let ranges: Vec<(f64, f64)> = parameters
        .lengths_m
        .iter()
        .map(|&length| (length, range(&drops.iter().filter(|row| row.length_m == length).collect::<Vec<_>>())))
        .collect();
    let least = ranges.iter().map(|(_, range)| *range).fold(f64::INFINITY, f64::min);
    study.state(Statement::trend(
        "least range of e over the inclinations, five rods",
        SOURCE,
        "the restitution varies unusually with the inclination",
        (CLEAR, 1.0),
        "a tenth of the range from 0 to 1",
        least,
    ));
    let several: Vec<&DropRow> = drops.iter().filter(|row| row.micro_collisions > 1).collect();
    let changed = |row: &&&DropRow| {
        row.restitution.is_some_and(|restitution| (restitution - row.restitution_of_the_first).abs() > CLEAR)
    };
    study.state(Statement::trend(
        "share of drops with several micro-collisions whose first one alone would give another e, by more than 0.1",
        SOURCE,
        "vibration and multiple impacts are the main causes of the variation",
        (0.5, 1.0),
        "more often than not",
        several.iter().filter(changed).count() as f64 / several.len() as f64,
    ));
    let stubby_m = parameters.our_choice.stubby_length_m;
    let angles: Vec<f64> =
        drops.iter().filter(|row| row.length_m == parameters.lengths_m[0]).map(|row| row.angle_deg).collect();
    let stubby = study.sweep(&angles, 1, |&angle| solve(parameters, stubby_m, angle))?;
    let stubby = range(&stubby.iter().collect::<Vec<_>>());
    let told: Vec<String> =
        ranges.iter().map(|(length, range)| format!("{:.0} mm {}", 1e3 * length, significant(*range, 2))).collect();
    study.state(
        Statement::trend(
            format!("range of e over the inclinations of a bar of {:.0} mm", 1e3 * stubby_m),
            SOURCE,
            "a slenderness factor separates the bars whose restitution does not vary",
            (0.0, CLEAR),
            "a tenth of the range from 0 to 1",
            stubby,
        )
        .note(format!(
            "Ranges of the rods: {}. Euler-Bernoulli's theory is too stiff for such a short bar.",
            told.join(", ")
        )),
    );
    Ok(())
}
