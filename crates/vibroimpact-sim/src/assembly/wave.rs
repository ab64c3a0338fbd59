//! Integrals with `e^{i Omega t}`.

use crate::panel::lanes::{ComplexLanes, Lanes};
use crate::panel::legendre::{Legendre, Nodal, Q};
use crate::panel::vector::LANES;
use num_complex::Complex64;
use std::array;
use std::ops::{Add, Mul};

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
    let [re, im] = centred_mean(&spherical_bessel(0.5 * angle), force);
    Complex64::cis(0.5 * angle) * Complex64::new(re, im)
}

/// Real and imaginary part of the same, of `e^{i angle (x - 1/2)}`, from the spherical Bessel functions of half the angle, or of
/// half of some angles: `int_0^1 e^{i angle (x - 1/2)} P_n(2x-1) dx = i^n j_n(angle/2)`.
#[inline(always)]
pub(crate) fn centred_mean<T>(bessel: &[T; Q], force: &Legendre) -> [T; 2]
where
    T: Copy + Add<Output = T> + Mul<f64, Output = T>,
{
    let mut parts = [bessel[0] * force.0[0], bessel[1] * force.0[1]];
    for n in 2..Q {
        let sign = if n % 4 < 2 { 1.0 } else { -1.0 };
        parts[n % 2] = parts[n % 2] + bessel[n] * (sign * force.0[n]);
    }
    parts
}

/// Below the first of these numbers the Bessel functions are computed from power series, and beyond the second one upwards.
const DOWNWARDS: [f64; 2] = [1e-2, Q as f64];
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

/// The spherical Bessel functions `j_n(y)`: by the recurrence `j_{n-1} + j_{n+1} = (2n+1)/y j_n`, upwards where that is stable
/// and otherwise downwards, or from a power series.
fn spherical_bessel(y: f64) -> Nodal {
    let mut bessel = [0.0; Q];
    if y.abs() < DOWNWARDS[0] {
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
    let wave = Complex64::cis(y);
    if y.abs() <= DOWNWARDS[1] {
        return downwards(Lanes([y; LANES]), ComplexLanes::of(|_| wave)).map(|lanes| lanes.0[0]);
    }
    let inverse = y.recip();
    bessel[0] = wave.im * inverse;
    bessel[1] = (bessel[0] - wave.re) * inverse;
    for n in 1..Q - 1 {
        bessel[n + 1] = FACTORS[n] * inverse * bessel[n] - bessel[n - 1];
    }
    bessel
}

/// The spherical Bessel functions of some numbers, from these numbers and their `e^{iy}`.
#[inline(always)]
pub(crate) fn spherical_bessels(y: Lanes, wave: ComplexLanes) -> [Lanes; Q] {
    let [least, most] = DOWNWARDS;
    if y.0.iter().all(|y| (least..=most).contains(&y.abs())) {
        return downwards(y, wave);
    }
    let each = y.0.map(spherical_bessel);
    array::from_fn(|n| Lanes::of(|l| each[l][n]))
}

/// By the recurrence downwards, from an order so high that its value does not matter (Miller's algorithm).
#[inline(always)]
fn downwards(y: Lanes, wave: ComplexLanes) -> [Lanes; Q] {
    let inverse = Lanes::of(|l| y.0[l].recip());
    let mut bessel = [Lanes::ZERO; Q];
    let (mut above, mut here) = (Lanes::ZERO, Lanes::ONE);
    for n in (1..HIGH).rev() {
        let below = inverse * FACTORS[n] * here - above;
        (above, here) = (here, below);
        if n <= Q {
            bessel[n - 1] = below;
        }
    }
    let zeroth = wave.im * inverse;
    let first = (zeroth - wave.re) * inverse;
    let scale = Lanes::of(|l| {
        // the larger of the first two has more digits
        let larger = if zeroth.0[l].abs() > first.0[l].abs() { (zeroth, bessel[0]) } else { (first, bessel[1]) };
        larger.0.0[l] / larger.1.0[l]
    });
    for value in &mut bessel {
        *value = *value * scale;
    }
    bessel
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
