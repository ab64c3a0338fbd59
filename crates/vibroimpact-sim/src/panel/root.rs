//! Roots of functions of one variable.

/// A distance of two places on a panel that only rounding is smaller than.
pub(crate) const EXACTLY: f64 = 1e-16;
/// Largest number of evaluations after those at both ends.
const EVALUATIONS: usize = 60;

/// Root of `f` between two places where it has different signs, by secants of which one end is held back (Illinois), until they
/// move by no more than `within`.
pub(crate) fn root(a: f64, b: f64, within: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let (mut a, mut b) = ((a, f(a)), (b, f(b)));
    for _ in 0..EVALUATIONS {
        let s = b.0 - b.1 * (b.0 - a.0) / (b.1 - a.1);
        let here = (s, f(s));
        if !s.is_finite() || (s - b.0).abs() <= within || here.1 == 0.0 {
            return if s.is_finite() { s } else { b.0 };
        }
        if (here.1 < 0.0) == (b.1 < 0.0) {
            a.1 *= 0.5;
        } else {
            a = b;
        }
        b = here;
    }
    b.0
}
