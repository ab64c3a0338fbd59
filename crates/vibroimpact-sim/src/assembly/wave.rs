//! Integrals with `e^{i Omega t}`.

use crate::panel::legendre::{Nodal, Q};
use crate::panel::oscillator::exponential_moments;
use num_complex::Complex64;

/// `e^{i Omega t}` over a stretch of time.
pub(crate) struct Wave {
    /// At its ends.
    pub ends: [Complex64; 2],
    /// `int e^{i Omega t} dt`.
    pub mean: Complex64,
    /// `int (t - start) e^{i Omega t} dt`.
    pub first: Complex64,
}

impl Wave {
    pub fn over(omega: f64, from_s: f64, to_s: f64) -> Wave {
        let ends = [from_s, to_s].map(|time| Complex64::cis(omega * time));
        let length = to_s - from_s;
        let mean = integral(omega, from_s, to_s);
        let i_omega = Complex64::new(0.0, omega);
        Wave { ends, mean, first: (length * ends[1] - mean) / i_omega }
    }
}

/// `int e^{i Omega t} dt`, for any `Omega`.
pub(crate) fn integral(omega: f64, from_s: f64, to_s: f64) -> Complex64 {
    let (half, length) = (0.5 * omega * (to_s - from_s), to_s - from_s);
    let mean = if half.abs() < 1e-9 { 1.0 } else { half.sin() / half };
    Complex64::cis(omega * 0.5 * (from_s + to_s)) * (length * mean)
}

/// `int_0^1 e^{i angle x} sum_n f_n P_n(2x-1) dx`.
pub(crate) fn turned_mean(angle: f64, force: &Nodal) -> Complex64 {
    turned(&turned_means(angle), force)
}

/// The same from the integrals of the polynomials.
pub(crate) fn turned(means: &[Complex64; Q], force: &Nodal) -> Complex64 {
    (0..Q).map(|n| force[n] * means[n]).sum()
}

/// `int_0^1 e^{i angle x} P_n(2x-1) dx`.
pub(crate) fn turned_means(angle: f64) -> [Complex64; Q] {
    // seen from the other end, where odd polynomials change their sign
    let moments = exponential_moments(Complex64::new(0.0, angle));
    std::array::from_fn(|n| if n % 2 == 0 { moments[n] } else { -moments[n] })
}
