//! Predictions of the impact of a row, and their derivatives in the free fields.

use fitting::Parameter;

use super::data::Row;
use super::forward::{Course, Model};
use crate::model::Kept;

/// Step of the differences in the transformed coordinate. With impacts resolved to 1e-10 and differences of the fourth order,
/// rounding leaves about 1e-6 of the derivative, and truncation less.
const STEP: f64 = 1e-4;

/// What a row predicts.
pub(super) struct Prediction {
    /// The measured quantities in their order, then the samples of the gauge at the offset.
    pub values: Vec<f64>,
    /// Offset of the clock of the gauge (s), if there is one.
    pub offset_s: Option<f64>,
    /// How many contacts the impact has.
    pub sub_impacts: usize,
}

/// The predictions of a row; its gauge is taken at `offset_s`, or where it fits best.
pub(super) fn predict(
    model: &Model,
    row: &Row,
    parameters: &[f64],
    offset_s: Option<f64>,
    kept: &mut Kept,
) -> Option<Prediction> {
    let course = model.course(row, parameters, kept)?;
    Some(seen(row, &course, offset_s))
}

fn seen(row: &Row, course: &Course, offset_s: Option<f64>) -> Prediction {
    let mut values: Vec<f64> = row.measured.iter().map(|(quantity, ..)| quantity.of(&course.solution)).collect();
    let gauge = row.force.as_ref().zip(course.signal.as_ref());
    let offset_s = gauge.map(|((record, _), signal)| offset_s.unwrap_or_else(|| record.offset_s(signal)));
    if let Some((((record, _), signal), offset_s)) = gauge.zip(offset_s) {
        values.extend(record.time_s.iter().map(|t| signal.at(t - offset_s)));
    }
    Prediction { values, offset_s, sub_impacts: course.solution.sub_impacts.len() }
}

/// Derivatives of the predictions of a row.
pub(super) struct Derivatives {
    /// In the coordinates of the parameters, of prediction `i` in coordinate `j` at `i * n + j`.
    pub rows: Vec<f64>,
    /// In the offset of the gauge's clock, of each of its samples (N/s); empty without a gauge.
    pub in_offset: Vec<f64>,
    /// Whether the number of contacts changes within the steps: the impact grazes there, and a derivative need not exist.
    pub grazes: bool,
}

/// Derivatives of the predictions of a row in the transformed coordinates: central differences of the fourth order. `None` where an
/// impact of them cannot be resolved.
pub(super) fn derivatives(
    model: &Model,
    row: &Row,
    coordinates: &[Parameter],
    parameters: &[f64],
    kept: &mut Kept,
) -> Option<Derivatives> {
    let n = coordinates.len();
    let course = model.course(row, parameters, kept)?;
    let here = seen(row, &course, None);
    let mut found = Derivatives { rows: vec![0.0; here.values.len() * n], in_offset: Vec::new(), grazes: false };
    if let Some((((record, _), signal), offset_s)) = row.force.as_ref().zip(course.signal.as_ref()).zip(here.offset_s) {
        found.in_offset = record.time_s.iter().map(|t| -signal.rate_at(t - offset_s)).collect();
    }
    for (j, coordinate) in coordinates.iter().enumerate() {
        let u = coordinate.inward(parameters[j]);
        for (steps, weight) in [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)] {
            let mut shifted = parameters.to_vec();
            shifted[j] = coordinate.outward(u + steps * STEP);
            let there = predict(model, row, &shifted, here.offset_s, kept)?;
            found.grazes |= there.sub_impacts != here.sub_impacts;
            for (entry, value) in found.rows.iter_mut().skip(j).step_by(n).zip(&there.values) {
                *entry += weight * value / (12.0 * STEP);
            }
        }
    }
    Some(found)
}
