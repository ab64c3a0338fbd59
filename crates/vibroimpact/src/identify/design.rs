//! Ranking of further experiments by their information.

use fitting::{Information, Parameter};

use super::data::{Data, Row};
use super::derivative::derivatives;
use super::forward::Model;
use super::gauge::ForceRecord;
use super::quantity::Quantity;
use super::summary::Candidate;
use super::work::project_out;
use crate::model::Kept;

/// What each candidate would measure.
pub(super) struct Measured {
    /// Quantities, with their standard deviations.
    pub quantities: Vec<(Quantity, f64)>,
    /// A force history: the times of its samples after the first touch (s), and the standard deviation of its noise (N).
    pub force: Option<(Vec<f64>, f64)>,
}

impl Measured {
    /// The weighted Jacobian of the measurements at a row of the candidates, with the offset of the gauge eliminated; `None` if the
    /// impact cannot be resolved.
    fn rows(
        &self,
        model: &Model,
        row: &Row,
        coordinates: &[Parameter],
        parameters: &[f64],
        kept: &mut Kept,
    ) -> Option<Vec<f64>> {
        let n = coordinates.len();
        let mut row = row.clone();
        row.measured = self.quantities.iter().map(|(quantity, sd)| (*quantity, 0.0, Some(*sd))).collect();
        let mut sds: Vec<f64> = self.quantities.iter().map(|(_, sd)| *sd).collect();
        if let Some((time_s, sd)) = &self.force {
            let record = |force_n| ForceRecord { file: String::new(), time_s: time_s.clone(), force_n };
            row.force = Some((record(vec![0.0; time_s.len()]), None));
            let signal = model.course(&row, parameters, kept)?.signal?;
            // the record is that of the model, so that its clock has no offset
            row.force = Some((record(time_s.iter().map(|t| signal.at(*t)).collect()), None));
            sds.extend(time_s.iter().map(|_| *sd));
        }
        let found = derivatives(model, &row, coordinates, parameters, kept)?;
        let weights = sds.iter().flat_map(|sd| std::iter::repeat_n(*sd, n));
        let mut rows: Vec<f64> = found.rows.iter().zip(weights).map(|(entry, sd)| entry / sd).collect();
        if let Some((_, sd)) = &self.force {
            let q: Vec<f64> = found.in_offset.iter().map(|rate| rate / sd).collect();
            project_out(&mut rows[self.quantities.len() * n..], &q, n);
        }
        rows.iter().all(|entry| entry.is_finite()).then_some(rows)
    }
}

/// Sorts candidates by the information that they add, the most informative first. The interval of the search represents the
/// prior knowledge of a parameter. A candidate that cannot be resolved comes last.
pub(super) fn design(
    model: &Model,
    candidates: &Data,
    coordinates: &[Parameter],
    parameters: &[f64],
    information: &Information,
    measured: &Measured,
) -> Vec<Candidate> {
    let width = |p: &Parameter| (p.inward(p.search.1) - p.inward(p.search.0)).abs();
    let prior: Vec<f64> = coordinates.iter().map(width).collect();
    let known = information.clone().with_prior(&prior);
    let before = known.standard_deviations();
    let model = model.for_table(candidates);
    let mut found = model.for_rows(|_, row, kept| {
        let rows = measured.rows(&model, row, coordinates, parameters, kept);
        let with = rows.and_then(|rows| known.with_rows(&rows).ok());
        let after = with.as_ref().map(Information::standard_deviations);
        let ratios = |after: Vec<f64>| after.iter().zip(&before).map(|(after, before)| after / before).collect();
        Candidate {
            line: row.line,
            fields: candidates.fields.iter().map(ToString::to_string).zip(row.values.iter().cloned()).collect(),
            volume_ratio: with.map(|with| (known.log_precision() - with.log_precision()).exp()),
            sd_ratios: after.map(ratios),
        }
    });
    let ratio = |candidate: &Candidate| candidate.volume_ratio.unwrap_or(f64::INFINITY);
    found.sort_by(|a, b| ratio(a).total_cmp(&ratio(b)));
    found
}
