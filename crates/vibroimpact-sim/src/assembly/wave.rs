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
/// and otherwise downwards, from an order so high that its value does not matter (Miller's algorithm), or from a power series.
pub(crate) fn spherical_bessel(y: f64) -> Nodal {
    /// Order at which the recurrence downwards begins: `(j_24(y)/j_7(y))^2 < 1e-18` up to `y = Q`.
    const HIGH: usize = 24;
    const FACTORS: [f64; HIGH] = {
        let (mut factors, mut n) = ([0.0; HIGH], 0);
        while n < HIGH {
            factors[n] = (2 * n + 1) as f64;
            n += 1;
        }
        factors
    };
    let mut bessel = [0.0; Q];
    if y.abs() < 1e-2 {
        // j_n(y) = y^n/(2n+1)!! (1 - y^2/2/(2n+3) + (y^2/2)^2/2/(2n+3)/(2n+5) - ..), four terms of which matter
        let (half_square, mut power) = (0.5 * y * y, 1.0);
        for (n, value) in bessel.iter_mut().enumerate() {
            let [a, b, c] = [3, 5, 7].map(|more| (2 * n + more) as f64);
            *value =
                power * (1.0 - half_square / a * (1.0 - half_square / (2.0 * b) * (1.0 - half_square / (3.0 * c))));
            power *= y / a;
        }
        return bessel;
    }
    let (inverse, (sin, cos)) = (y.recip(), y.sin_cos());
    let first = [sin * inverse, (sin * inverse - cos) * inverse];
    if y.abs() > Q as f64 {
        bessel[..2].copy_from_slice(&first);
        for n in 1..Q - 1 {
            bessel[n + 1] = FACTORS[n] * inverse * bessel[n] - bessel[n - 1];
        }
        return bessel;
    }
    let (mut above, mut here) = (0.0, 1.0);
    for n in (1..HIGH).rev() {
        let below = FACTORS[n] * inverse * here - above;
        (above, here) = (here, below);
        if n <= Q {
            bessel[n - 1] = below;
        }
    }
    // the larger of the first two has more digits
    let scale = if first[0].abs() > first[1].abs() { first[0] / bessel[0] } else { first[1] / bessel[1] };
    bessel.map(|value| scale * value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::legendre::{BASIS, legendre};

    #[test]
    fn the_mean_of_a_turned_polynomial_is_its_integral() {
        for angle in [0.0, 1e-6, 0.0199, 0.0201, 0.7, -3.0, 6.2, 9.0, 15.9, 16.1, 40.0] {
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
