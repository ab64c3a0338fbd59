//! Summary of a set of residuals.

/// Size of residuals.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Residuals {
    /// Number of residuals.
    pub count: usize,
    /// Mean, with sign: the bias.
    pub mean: f64,
    /// Root of the mean square.
    pub rms: f64,
    /// Largest magnitude.
    pub max_abs: f64,
    /// Magnitude that half of them do not exceed.
    pub median_abs: f64,
    /// Magnitude that 90 % of them do not exceed.
    pub p90_abs: f64,
    /// Magnitude that 95 % of them do not exceed.
    pub p95_abs: f64,
}

impl Residuals {
    /// Summary of `residuals`; all zero for none.
    pub fn of(residuals: &[f64]) -> Residuals {
        let count = residuals.len();
        let n = count.max(1) as f64;
        let mut sizes: Vec<f64> = residuals.iter().map(|r| r.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        // The smallest magnitude that at least this share of them do not exceed.
        let quantile = |share: f64| match count {
            0 => 0.0,
            _ => sizes[((share * n).ceil() as usize).clamp(1, count) - 1],
        };
        Residuals {
            count,
            mean: residuals.iter().sum::<f64>() / n,
            rms: (residuals.iter().map(|r| r * r).sum::<f64>() / n).sqrt(),
            max_abs: quantile(1.0),
            median_abs: quantile(0.5),
            p90_abs: quantile(0.9),
            p95_abs: quantile(0.95),
        }
    }
}
