//! Half-widths of the intervals in standard deviations, Eq. (3).

use fitting::two_sided_quantile;

use super::work::Work;
use crate::scene::InvalidInput;

/// The quantile `z` of each parameter for intervals of this level.
pub(super) fn quantiles(work: &Work, level: f64) -> Result<Vec<f64>, InvalidInput> {
    let n = work.coordinates.len();
    if work.model.data.stated {
        return Ok(vec![two_sided_quantile(level, None); n]);
    }
    let (rows, information) = work.information()?;
    let Some(covariance) = information.covariance() else {
        return Ok(vec![two_sided_quantile(level, Some(work.freedom as f64)); n]);
    };
    let freedom = work.freedom_of_groups();
    let of_parameter = |of_parameter: &[f64]| {
        let mut parts = vec![0.0; freedom.len()];
        for (row, (_, group)) in rows.chunks_exact(n).zip(&work.measured) {
            let part: f64 = row.iter().zip(of_parameter).map(|(a, c)| a * c).sum();
            parts[*group] += part * part;
        }
        let variance: f64 = parts.iter().sum();
        let spread: f64 = parts.iter().zip(&freedom).map(|(part, freedom)| part * part / freedom).sum();
        two_sided_quantile(level, Some(variance * variance / spread))
    };
    Ok(covariance.chunks_exact(n).map(of_parameter).collect())
}
