//! Tail probabilities and quantiles for tests of a misfit.

use crate::incomplete::{lower_beta, upper_gamma};

/// Degrees of freedom from which on an expansion about the normal distribution is exact to rounding.
const MANY: f64 = 1e4;

/// Logarithms between which Student's quantiles lie.
const LOGARITHMS: (f64, f64) = (-340.0, 60.0);

/// Probability that a chi-square variable with `freedom` degrees of freedom exceeds `value`, to about 1e-9; 1 if `freedom` is 0.
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
        _ => upper_gamma(0.5 * freedom as f64, 0.5 * value),
    }
}

/// Probability that Fisher's variable with these degrees of freedom exceeds `value`; 1 if one of them is 0.
///
/// ```
/// // one and many degrees: the square of a normal variable
/// assert!((fitting::fisher_tail(3.841, 1, 1_000_000) - 0.05).abs() < 1e-4);
/// ```
pub fn fisher_tail(value: f64, above: usize, below: usize) -> f64 {
    let (a, b) = (above as f64, below as f64);
    match value {
        _ if above == 0 || below == 0 || value <= 0.0 => 1.0,
        _ if value.is_nan() => f64::NAN,
        _ if value.is_infinite() => 0.0,
        _ => {
            let ratio = value * (a / b);
            lower_beta(0.5 * b, 0.5 * a, 1.0 / (1.0 + ratio), 1.0 / (1.0 + 1.0 / ratio))
        }
    }
}

/// `t` such that Student's variable with `freedom` degrees of freedom is within `-t..t` with probability `level` (0 to 1, otherwise
/// NaN): `I_x(f/2, 1/2) = 1 - level` at `x = f/(f + t^2)`, and for many degrees of freedom an expansion about the normal variable.
/// The degrees of freedom are at least 1 and need not be an integer. `None` stands for a known standard deviation, that is the
/// normal variable.
///
/// ```
/// assert!((fitting::two_sided_quantile(0.95, None) - 1.959964).abs() < 1e-6);
/// assert!((fitting::two_sided_quantile(0.95, Some(10.0)) - 2.228139).abs() < 1e-6);
/// ```
pub fn two_sided_quantile(level: f64, freedom: Option<f64>) -> f64 {
    match level {
        1.0 => return f64::INFINITY,
        0.0..1.0 => {}
        _ => return f64::NAN,
    }
    let z = std::f64::consts::SQRT_2 * puruspe::inverf(level);
    let Some(freedom) = freedom else { return z };
    let f = freedom.max(1.0);
    if f >= MANY {
        // Abramowitz and Stegun 26.7.5
        let w = z * z;
        let orders =
            [(w + 1.0) / 4.0, ((5.0 * w + 16.0) * w + 3.0) / 96.0, (((3.0 * w + 19.0) * w + 17.0) * w - 15.0) / 384.0];
        return z * orders.iter().rev().fold(1.0, |sum, order| (sum - 1.0 + order) / f + 1.0);
    }
    // Of the two probabilities the smaller one is compared, which keeps its digits.
    let too_small = |t: f64| {
        let (ratio, inverse) = (t * (t / f), f / t / t);
        let (outside, inside) = (1.0 / (1.0 + ratio), 1.0 / (1.0 + inverse));
        if level < 0.5 {
            lower_beta(0.5, 0.5 * f, inside, outside) < level
        } else {
            lower_beta(0.5 * f, 0.5, outside, inside) > 1.0 - level
        }
    };
    let (mut low, mut high) = LOGARITHMS;
    while high - low > 1e-13 {
        let middle = 0.5 * (low + high);
        *(if too_small(middle.exp()) { &mut low } else { &mut high }) = middle;
    }
    (0.5 * (low + high)).exp()
}

#[cfg(test)]
mod tests {
    use super::{chi_square_tail, fisher_tail, two_sided_quantile};

    #[test]
    fn a_quantile_of_no_probability_is_no_number() {
        for freedom in [None, Some(10.0)] {
            for level in [-1.0, 1.5, f64::INFINITY, f64::NAN] {
                assert!(two_sided_quantile(level, freedom).is_nan(), "{level} {freedom:?}");
            }
            assert_eq!(two_sided_quantile(1.0, freedom), f64::INFINITY);
            assert!(two_sided_quantile(0.0, freedom).abs() < 1e-12);
        }
    }

    /// Force histories have thousands of values.
    #[test]
    fn tails_of_many_degrees_of_freedom_are_those_of_the_tables() {
        let chi_square = [
            (2.706, 1, 0.099_971_378_125_259),
            (150.0, 200, 0.996_647_558_501_813),
            (199.0, 200, 0.506_673_339_680_035),
            (1212.0, 1228, 0.622_023_375_791_767),
            (1351.0, 1229, 0.008_263_044_585_848),
            (100_500.0, 100_000, 0.131_854_811_603_383),
            (95_000.0, 100_000, 1.0),
            (1e300, 100_000, 0.0),
            (1e7, 10_000_000, 0.499_940_529_196_062),
            (10_002_236.0, 10_000_000, 0.308_503_527_390_500),
            (99_985_857.0, 100_000_000, 0.841_359_537_221_296),
            (100_100_000.0, 100_000_000, 7.816_251e-13),
            (1e10, 10_000_000_000, 0.499_998_119_368_055),
        ];
        for (value, freedom, known) in chi_square {
            let found = chi_square_tail(value, freedom);
            assert!((found - known).abs() < 1e-9, "{value} {freedom}: {found} {known}");
        }
        let fisher = [
            (3.0, 4, 20, 0.043_200_998_334_214),
            (1.02, 8000, 9000, 0.180_925_399_348_137),
            (0.98, 8000, 9000, 0.823_566_003_030_755),
            (1.05, 7000, 7000, 0.020_632_128_337_233),
            (1e-3, 1, 1_000_000, 0.974_772_885_680_942),
            (1e-12, 1, 20_000, 0.999_999_202_125_413),
            (1e-14, 1, 3, 0.999_999_926_489_481),
        ];
        for (value, above, below, known) in fisher {
            let found = fisher_tail(value, above, below);
            assert!((found - known).abs() < 1e-8, "{value} {above} {below}: {found} {known}");
        }
        assert!(chi_square_tail(f64::NAN, 300).is_nan() && fisher_tail(f64::NAN, 3, 5).is_nan());
    }

    /// Degrees of freedom, and by how much the quantile of 95 % exceeds the normal one, by 40 digits.
    const QUANTILES: [(f64, f64); 4] = [
        (1e4, 2.372_553_505_720_22e-4),
        (3e4, 7.907_884_388_085_49e-5),
        (1e6, 2.372_274_052_799_73e-6),
        (1e9, 2.372_271_233_121_06e-9),
    ];

    #[test]
    fn student_quantiles_are_those_of_the_tables() {
        // Exact: tan(pi level / 2) for one degree; level sqrt(2/(1 - level^2)) for two; the rest from tables.
        let level: f64 = 0.95;
        let exact =
            [(1, (0.5 * std::f64::consts::PI * level).tan()), (2, level * (2.0 / (1.0 - level * level)).sqrt())];
        for (freedom, t) in exact {
            assert!((two_sided_quantile(level, Some(f64::from(freedom))) / t - 1.0).abs() < 1e-8, "{freedom}");
        }
        let by_40_digits = [
            (0.01, 10.0, 0.012_850_279_188_571_4),
            (0.01, 9999.0, 0.012_533_782_929_290_4),
            (1e-6, 3.0, 1.360_349_523_176_22e-6),
            (0.2, 9999.0, 0.253_353_844_119_836),
            (0.9999, 1.5, 384.572_402_521_582),
        ];
        for (level, freedom, t) in by_40_digits {
            let found = two_sided_quantile(level, Some(freedom));
            assert!((found / t - 1.0).abs() < 1e-11, "{level} {freedom}: {found} {t}");
        }
        let normal = two_sided_quantile(level, None);
        assert_eq!(two_sided_quantile(level, Some(f64::INFINITY)), normal);
        for (freedom, more) in QUANTILES {
            let found = two_sided_quantile(level, Some(freedom)) - normal;
            assert!((found - more).abs() < 1e-14, "{freedom}: {found} {more}");
        }
        for (freedom, t) in [(10, 2.228138852), (30, 2.042272456), (100, 1.983971519)] {
            assert!((two_sided_quantile(level, Some(f64::from(freedom))) - t).abs() < 1e-7, "{freedom}");
        }
    }
}
