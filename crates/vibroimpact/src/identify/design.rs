//! Ranking of further experiments by their information.

use fitting::{Information, Parameter};

use super::data::Data;
use super::derivative::derivatives;
use super::forward::Model;
use super::quantity::Quantity;
use super::summary::Candidate;

/// Sorts candidates by the information that they add, the most informative first. `noise` contains the quantities that each would
/// measure, with their standard deviations. The interval of the search represents the prior knowledge of a parameter. A
/// candidate that cannot be resolved comes last, with a ratio of 1.
pub(super) fn design(
    model: &Model,
    candidates: &Data,
    coordinates: &[Parameter],
    parameters: &[f64],
    information: &Information,
    noise: &[(Quantity, f64)],
) -> Vec<Candidate> {
    let mut table = candidates.clone();
    for row in &mut table.rows {
        row.measured = noise.iter().map(|(quantity, sd)| (*quantity, 0.0, Some(*sd))).collect();
    }
    let width = |p: &Parameter| (p.inward(p.search.1) - p.inward(p.search.0)).abs();
    let prior: Vec<f64> = coordinates.iter().map(width).collect();
    let known = information.clone().with_prior(&prior);
    let before = known.standard_deviations();
    let model = model.for_table(&table);
    let n = coordinates.len();
    let mut found = model.for_rows(|_, row, kept| {
        let weighted = derivatives(&model, row, coordinates, parameters, kept).map(|found| {
            let sds = noise.iter().flat_map(|(_, sd)| std::iter::repeat_n(*sd, n));
            found.rows.iter().zip(sds).map(|(entry, sd)| entry / sd).collect::<Vec<f64>>()
        });
        let with = weighted.and_then(|rows| known.with_rows(&rows).ok());
        let after = with.as_ref().map_or_else(|| before.clone(), Information::standard_deviations);
        let gained = with.map_or(0.0, |with| with.log_precision() - known.log_precision());
        let fields = table.fields.iter().map(ToString::to_string).zip(row.values.iter().cloned()).collect();
        Candidate {
            line: row.line,
            fields,
            volume_ratio: (-gained).exp(),
            sd_ratios: after.iter().zip(&before).map(|(after, before)| after / before).collect(),
        }
    });
    found.sort_by(|a, b| a.volume_ratio.total_cmp(&b.volume_ratio));
    found
}
