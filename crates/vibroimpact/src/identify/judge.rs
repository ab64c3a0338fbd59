//! Tests whether the misfit can be explained by noise.

use fitting::{chi_square_tail, fisher_tail};

use super::data::Data;
use super::gauge::lag_one;
use super::summary::LackOfFit;

/// A model is rejected if its misfit is less probable than this.
pub(super) const NOTICED: f64 = 0.01;

/// Tests residuals of unit variance, in the order of the rows of the table.
///
/// With stated standard deviations the sum of squares is compared with the chi-square distribution. With estimated ones the
/// differences between repeated rows are compared with the other residuals (Fisher). For force histories the correlation of
/// neighbouring residuals is tested too.
pub(super) fn lack_of_fit(data: &Data, residuals: &[f64], freedom: usize) -> Vec<LackOfFit> {
    let mut found = Vec::new();
    let mut judge = |test: String, statistic: f64, probability: f64| {
        found.push(LackOfFit { test, statistic, probability, noticed: probability < NOTICED });
    };
    let sum: f64 = residuals.iter().map(|r| r * r).sum();
    if data.stated && freedom > 0 {
        judge("chi-square".to_owned(), sum, chi_square_tail(sum, freedom));
    }
    let scalars = scalars(data, residuals);
    if !data.stated {
        let (pure, pure_freedom) = repeated(data, &scalars);
        // without gauges, whose samples are never repeated
        let all: f64 = scalars.iter().map(|(_, _, r)| r * r).sum();
        let gauges: usize =
            data.rows.iter().filter_map(|row| row.force.as_ref()).map(|(record, _)| record.time_s.len()).sum();
        let rest = freedom.saturating_sub(gauges).saturating_sub(pure_freedom);
        if pure_freedom > 0 && rest > 0 && pure > 0.0 {
            let ratio = ((all - pure).max(0.0) / rest as f64) / (pure / pure_freedom as f64);
            judge("repeated rows".to_owned(), ratio, fisher_tail(ratio, rest, pure_freedom));
        }
    }
    let mut place = 0;
    for row in &data.rows {
        place += row.measured.len();
        if let Some((record, _)) = &row.force {
            let (correlation, probability) = lag_one(&residuals[place..place + record.time_s.len()]);
            judge(format!("neighbouring samples of {}", record.file), correlation, probability);
            place += record.time_s.len();
        }
    }
    found
}

/// Row, number of the quantity in it, and residual of everything that is not a force history.
fn scalars(data: &Data, residuals: &[f64]) -> Vec<(usize, usize, f64)> {
    let mut found = Vec::new();
    let mut place = 0;
    for (i, row) in data.rows.iter().enumerate() {
        found.extend((0..row.measured.len()).map(|k| (i, k, residuals[place + k])));
        place += row.measured.len() + row.force.as_ref().map_or(0, |(record, _)| record.time_s.len());
    }
    found
}

/// Sum of squares among repeated rows about their means, and its degrees of freedom.
fn repeated(data: &Data, scalars: &[(usize, usize, f64)]) -> (f64, usize) {
    let same = |(i, k, _): &(usize, usize, f64), (j, l, _): &(usize, usize, f64)| {
        data.rows[*i].values == data.rows[*j].values && data.rows[*i].measured[*k].0 == data.rows[*j].measured[*l].0
    };
    let mut groups: Vec<Vec<&(usize, usize, f64)>> = Vec::new();
    for scalar in scalars {
        match groups.iter_mut().find(|group| same(group[0], scalar)) {
            Some(group) => group.push(scalar),
            None => groups.push(vec![scalar]),
        }
    }
    let (mut sum, mut freedom) = (0.0, 0);
    for group in groups.iter().filter(|group| group.len() > 1) {
        let mean = group.iter().map(|(_, _, r)| r).sum::<f64>() / group.len() as f64;
        sum += group.iter().map(|(_, _, r)| (r - mean).powi(2)).sum::<f64>();
        freedom += group.len() - 1;
    }
    (sum, freedom)
}
