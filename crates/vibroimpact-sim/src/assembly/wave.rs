//! Integrals with `e^{i Omega t}`.

use crate::panel::legendre::{Legendre, Nodal, Q};
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
pub(crate) fn turned_mean(angle: f64, force: &Legendre) -> Complex64 {
    Complex64::cis(0.5 * angle) * centred_mean(&spherical_bessel(0.5 * angle), force)
}

/// The same, of `e^{i angle (x - 1/2)}`, from the spherical Bessel functions of half the angle:
/// `int_0^1 e^{i angle (x - 1/2)} P_n(2x-1) dx = i^n j_n(angle/2)`.
pub(crate) fn centred_mean(bessel: &Nodal, force: &Legendre) -> Complex64 {
    let part = |first: usize| {
        let sign = |n: usize| if n % 4 < 2 { 1.0 } else { -1.0 };
        (first..Q).step_by(2).map(|n| sign(n) * force.0[n] * bessel[n]).sum::<f64>()
    };
    Complex64::new(part(0), part(1))
}

/// The spherical Bessel functions `j_n(y)`: by the recurrence `j_{n-1} + j_{n+1} = (2n+1)/y j_n`, upwards where that is stable
/// and otherwise downwards from the power series of the last two.
pub(crate) fn spherical_bessel(y: f64) -> Nodal {
    const LAST: usize = Q - 1;
    let mut bessel = [0.0; Q];
    if y.abs() > Q as f64 {
        let (sin, cos) = y.sin_cos();
        bessel[0] = sin / y;
        bessel[1] = (bessel[0] - cos) / y;
        for n in 1..LAST {
            bessel[n + 1] = (2 * n + 1) as f64 / y * bessel[n] - bessel[n - 1];
        }
        return bessel;
    }
    // j_n(y) = y^n/(2n+1)!! sum_k (-y^2/2)^k / (k! (2n+3) (2n+5) .. (2n+2k+1))
    let half_square = -0.5 * y * y;
    let series = |n: usize| {
        let (mut term, mut sum, mut k) = (1.0f64, 1.0, 1);
        while term.abs() > 1e-17 {
            term *= half_square / (k * (2 * n + 2 * k + 1)) as f64;
            sum += term;
            k += 1;
        }
        sum
    };
    if y.abs() < 1e-2 {
        // a division by y would magnify rounding
        let mut power = 1.0;
        for n in 0..Q {
            bessel[n] = power * series(n);
            power *= y / (2 * n + 3) as f64;
        }
    } else {
        let power = (0..LAST - 1).fold(1.0, |power, n| power * y / (2 * n + 3) as f64);
        bessel[LAST - 1] = power * series(LAST - 1);
        bessel[LAST] = power * y / (2 * LAST + 1) as f64 * series(LAST);
        for n in (1..LAST).rev() {
            bessel[n - 1] = (2 * n + 1) as f64 / y * bessel[n] - bessel[n + 1];
        }
    }
    bessel
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::legendre::{BASIS, legendre};

    #[test]
    fn the_mean_of_a_turned_polynomial_is_its_integral() {
        for angle in [0.0, 1e-6, 0.0199, 0.0201, 0.7, -3.0, 15.9, 16.1, 40.0] {
            for n in 0..Q {
                let mut force = [0.0; Q];
                force[n] = 1.0;
                let parts = 20;
                let known: Complex64 = (0..parts)
                    .flat_map(|i| {
                        BASIS.fine.iter().map(move |(x, w)| ((i as f64 + x) / parts as f64, w / parts as f64))
                    })
                    .map(|(x, w)| w * legendre(x)[n] * Complex64::cis(angle * x))
                    .sum();
                let error = (turned_mean(angle, &Legendre(force)) - known).norm();
                assert!(error < 1e-14, "angle {angle}, degree {n}: {error:e}");
            }
        }
    }
}
