//! Tail probabilities and quantiles for tests of a misfit.

/// Probability that a chi-square variable with `freedom` degrees of freedom exceeds `value`, to about 1e-11; 1 if `freedom` is
/// 0.
///
/// ```
/// // two degrees of freedom: exp(-x/2)
/// assert!((fitting::chi_square_tail(3.0, 2) - (-1.5f64).exp()).abs() < 1e-10);
/// ```
pub fn chi_square_tail(value: f64, freedom: usize) -> f64 {
    match (freedom, value) {
        (0, _) => 1.0,
        (_, value) if value.is_nan() => f64::NAN,
        (_, value) if value <= 0.0 => 1.0,
        (_, value) if value.is_infinite() => 0.0,
        _ => puruspe::gammq(0.5 * freedom as f64, 0.5 * value),
    }
}

/// Probability that Fisher's variable with these degrees of freedom exceeds `value`; 1 if one of them is 0.
///
/// ```
/// // one and many degrees: the square of a normal variable
/// assert!((fitting::fisher_tail(3.841, 1, 1_000_000) - 0.05).abs() < 1e-4);
/// ```
pub fn fisher_tail(value: f64, above: usize, below: usize) -> f64 {
    if above == 0 || below == 0 || value <= 0.0 {
        return 1.0;
    }
    let (a, b) = (above as f64, below as f64);
    if value.is_infinite() { 0.0 } else { puruspe::betai(0.5 * b, 0.5 * a, b / (b + a * value)) }
}

/// `t` such that Student's variable with `freedom` degrees of freedom is within `-t..t` with probability `level` (0 to 1):
/// `I_x(f/2, 1/2) = 1 - level` at `x = f/(f + t^2)`. The degrees of freedom are at least 1 and need not be an integer. `None`
/// stands for a known standard deviation, that is the normal variable.
///
/// ```
/// assert!((fitting::two_sided_quantile(0.95, None) - 1.959964).abs() < 1e-6);
/// assert!((fitting::two_sided_quantile(0.95, Some(10.0)) - 2.228139).abs() < 1e-6);
/// ```
pub fn two_sided_quantile(level: f64, freedom: Option<f64>) -> f64 {
    let Some(freedom) = freedom else { return std::f64::consts::SQRT_2 * puruspe::inverf(level) };
    let f = freedom.max(1.0);
    let x = puruspe::invbetai(1.0 - level, 0.5 * f, 0.5);
    (f * (1.0 - x) / x).sqrt()
}

#[cfg(test)]
mod tests {
    use super::two_sided_quantile;

    #[test]
    fn student_quantiles_are_those_of_the_tables() {
        // Exact: tan(pi level / 2) for one degree; level sqrt(2/(1 - level^2)) for two; the rest from tables.
        let level: f64 = 0.95;
        let exact =
            [(1, (0.5 * std::f64::consts::PI * level).tan()), (2, level * (2.0 / (1.0 - level * level)).sqrt())];
        for (freedom, t) in exact {
            assert!((two_sided_quantile(level, Some(f64::from(freedom))) / t - 1.0).abs() < 1e-8, "{freedom}");
        }
        for (freedom, t) in [(10, 2.228138852), (30, 2.042272456), (100, 1.983971519)] {
            assert!((two_sided_quantile(level, Some(f64::from(freedom))) - t).abs() < 1e-7, "{freedom}");
        }
    }
}
