//! A choice, and the statement about a trend over all choices.

use crate::chapters::beam::Beam;
use crate::chapters::chapter4::trends::Trend;
use crate::chapters::statement::{Statement, Verdict, limits};
use crate::chapters::study::Study;
use vibroimpact::report::significant;

/// A stepped beam, or a uniform one.
pub struct Variant {
    pub beam: Beam,
    /// Location of the step (m), and relative thickness of the thin part.
    pub step: Option<(f64, f64)>,
}

/// Modes of every beam: those of the law, and of Fig. 4.4.
pub const MOST_MODES: usize = 60;

/// One statement for every trend. Every choice has all trends. A beam with one choice has no unstated parameters.
pub fn claim(study: &mut Study, choices: &[&[Trend]], beam: &str, figure: &str) {
    for k in 0..choices.first().map_or(0, |first| first.len()) {
        let of: Vec<&Trend> = choices.iter().filter_map(|trends| trends.get(k)).collect();
        let trend = of[0];
        let source = format!("{}, Fig. {figure}", trend.source);
        if of.len() == 1 {
            let quantity = format!("{}, {beam}", trend.quantity);
            study.state(Statement::trend(quantity, &source, trend.words, trend.limits, trend.reason, trend.ours));
            continue;
        }
        let holds = of.iter().filter(|trend| trend.holds()).count();
        let mut values: Vec<f64> = of.iter().map(|trend| trend.ours).collect();
        values.sort_by(f64::total_cmp);
        let [low, middle, high] = [0, values.len() / 2, values.len() - 1].map(|k| significant(values[k], 2));
        let limits = limits(trend.limits.0, trend.limits.1);
        let quantity = format!("{}, {beam}; share of choices that give {limits}", trend.quantity);
        let statement = Statement::choices(quantity, &source, trend.words, (holds, of.len())).note(format!(
            "The values range from {low} to {high}, with the median {middle}. Reason for the limit: {}.",
            trend.reason
        ));
        let refuted = statement.verdict() == Verdict::Differs;
        study.state(if refuted { statement.missing(trend.otherwise) } else { statement });
    }
}
