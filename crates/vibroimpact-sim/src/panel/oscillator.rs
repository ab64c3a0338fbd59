//! One mode on its own: exact free motion and exact response to a polynomial force, at any step.

use super::legendre::{BASIS, Nodal, Q, legendre};
use num_complex::Complex64;

/// One mode of a body. Shapes belong to points, see [`Point`](crate::assembly::Point).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyMode {
    /// Undamped circular frequency `omega_k` (rad/s); 0 for a rigid-body mode.
    pub omega_rad_s: f64,
    /// Damping ratio `zeta_k`; the modal equation contains `2 zeta_k omega_k`. A rigid-body mode has none.
    pub damping_ratio: f64,
}

impl BodyMode {
    /// Whether the mode is a rigid-body motion.
    pub(crate) fn is_rigid(&self) -> bool {
        self.omega_rad_s == 0.0
    }
}

/// Free motion over a time: `(a, a')` at the end are `p11 a + p12 a'` and `p21 a + p22 a'`. The difference `p11 - 1` is stored,
/// which is small over a short time: a body in contact moves little, whatever its displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Propagator {
    pub p11_less_1: f64,
    pub p12: f64,
    pub p21: f64,
    pub p22: f64,
}

/// From this damping ratio up to [`ROOTS_APART`] the two roots are nearly equal: the response is integrated by quadrature.
pub(crate) const NEARLY_CRITICAL: f64 = 0.99;

/// From this damping ratio on the slower root is less than half of the faster one, so that the difference of two exponential
/// moments is known to rounding.
const ROOTS_APART: f64 = 1.1;

/// A kernel that has decayed by the exponential of this number has no part in an integral, also if it has a factor `t^3`.
const DECAYED: f64 = 60.0;

/// Exact free motion of `a'' + 2 zeta omega a' + omega^2 a = 0` over `t` (s).
pub(crate) fn propagate(mode: &BodyMode, t: f64) -> Propagator {
    let (omega, zeta) = (mode.omega_rad_s, mode.damping_ratio);
    let sigma = zeta * omega;
    // `cosine` and `sine / omega_d`, both times exp(-sigma t), and the first of them less 1
    let (cosine, sine, less_1) = if zeta < 1.0 {
        let omega_d = omega * ((1.0 - zeta) * (1.0 + zeta)).sqrt();
        let (decay, decayed) = exp_and_less_1(-sigma * t);
        let (s, c) = (omega_d * t).sin_cos();
        let turned = if c > 0.0 { -s * s / (1.0 + c) } else { c - 1.0 };
        (decay * c, decay * if omega_d * t < 1e-8 { t } else { s / omega_d }, decayed * c + turned)
    } else {
        let (slow, split) = (slow_decay(mode), half_distance(mode));
        let (decay, decayed) = exp_and_less_1(-slow * t);
        let parted = (-2.0 * split * t).exp_m1();
        let sine = if split * t < 1e-17 { t } else { -parted / (2.0 * split) };
        (decay * (1.0 + 0.5 * parted), decay * sine, decayed + 0.5 * decay * parted)
    };
    Propagator { p11_less_1: less_1 + sigma * sine, p12: sine, p21: -omega * omega * sine, p22: cosine - sigma * sine }
}

/// Half the distance of the two roots of a mode that does not oscillate (1/s).
fn half_distance(mode: &BodyMode) -> f64 {
    mode.omega_rad_s * ((mode.damping_ratio - 1.0) * (mode.damping_ratio + 1.0)).max(0.0).sqrt()
}

/// The rate (1/s) at which free motion decays in the end.
fn slow_decay(mode: &BodyMode) -> f64 {
    let (omega, sigma) = (mode.omega_rad_s, mode.damping_ratio * mode.omega_rad_s);
    if mode.damping_ratio < 1.0 || omega == 0.0 { sigma } else { omega * omega / (sigma + half_distance(mode)) }
}

impl Propagator {
    /// Displacement and velocity at the end, from those at the start.
    pub fn apply(&self, a: f64, b: f64) -> (f64, f64) {
        (a + (self.p11_less_1 * a + self.p12 * b), self.p21 * a + self.p22 * b)
    }
}

/// `e^x` and `e^x - 1`, for `x <= 0`.
fn exp_and_less_1(x: f64) -> (f64, f64) {
    if x < -0.5 {
        let all = x.exp();
        (all, all - 1.0)
    } else {
        let less = x.exp_m1();
        (1.0 + less, less)
    }
}

/// Response of a mode starting at rest to unit Legendre forces on a step of length `h`:
/// displacement and velocity at its end, one of each a polynomial.
pub(crate) fn response(mode: &BodyMode, h: f64) -> (Nodal, Nodal) {
    if mode.damping_ratio >= NEARLY_CRITICAL {
        let apart = mode.damping_ratio >= ROOTS_APART && first_part(mode, h) < 1.0;
        return if apart { response_of_two_decays(mode, h) } else { response_by_quadrature(mode, h) };
    }
    let sigma = mode.damping_ratio * mode.omega_rad_s;
    let omega_d = mode.omega_rad_s * ((1.0 - mode.damping_ratio) * (1.0 + mode.damping_ratio)).sqrt();
    let lambda = Complex64::new(-sigma, omega_d);
    let moments = exponential_moments(lambda * h);
    (moments.map(|e| h * e.im / omega_d), moments.map(|e| h * (lambda * e).im / omega_d))
}

/// As [`response`], for a mode that consists of two decays with different rates, `(e^{-slow t} - e^{-fast t})/(fast - slow)`. The
/// faster one has to decay within the step: before it does, the two cancel.
fn response_of_two_decays(mode: &BodyMode, h: f64) -> (Nodal, Nodal) {
    let (slow, apart) = (slow_decay(mode), 2.0 * half_distance(mode));
    let fast = slow + apart;
    let [slowly, fastly] = [slow, fast].map(|rate| exponential_moments(Complex64::from(-rate * h)).map(|e| e.re));
    let scale = h / apart;
    let displacement = std::array::from_fn(|n| scale * (slowly[n] - fastly[n]));
    (displacement, std::array::from_fn(|n| scale * (fast * fastly[n] - slow * slowly[n])))
}

/// The part of a step on which the faster decay of an overdamped mode is smooth.
fn first_part(mode: &BodyMode, h: f64) -> f64 {
    (2.0 / (mode.omega_rad_s * 2.0 * mode.damping_ratio * h)).min(1.0)
}

/// As [`response`], for any damping.
fn response_by_quadrature(mode: &BodyMode, h: f64) -> (Nodal, Nodal) {
    response_of(mode, h, |t| {
        let kernel = propagate(mode, t);
        (kernel.p12, kernel.p22)
    })
}

/// As [`response`], for any kernel of displacement and velocity that changes with the time as this mode does, on panels that
/// grow away from the end of the step until the kernel has decayed.
pub(crate) fn response_of(mode: &BodyMode, h: f64, kernel: impl Fn(f64) -> (f64, f64)) -> (Nodal, Nodal) {
    let (mut displacement, mut velocity) = ([0.0; Q], [0.0; Q]);
    let decay = slow_decay(mode) * h;
    let mut from = 0.0;
    let mut to = first_part(mode, h);
    while from < 1.0 && decay * from < DECAYED {
        for &(x, w) in &BASIS.fine {
            let u = from + (to - from) * x;
            let (moved, speed) = kernel(u * h);
            let weight = w * (to - from) * h;
            for (n, p) in legendre(1.0 - u).into_iter().enumerate() {
                displacement[n] += weight * moved * p;
                velocity[n] += weight * speed * p;
            }
        }
        from = to;
        to = (2.0 * to).min(1.0);
    }
    (displacement, velocity)
}

/// `int_0^1 P_n(2s-1) e^{z(1-s)} ds` for `n < Q`: `(-1)^n e^w i_n(w)` with `w = z/2` and `i_n` the modified
/// spherical Bessel function. The recurrence `i_{n-1} = i_{n+1} + (2n+1)/w i_n` is run downwards from the power series
/// of the last two up to `|w| = Q`, and upwards beyond, where that is stable. Needs `Re z <= 0`.
pub(crate) fn exponential_moments(z: Complex64) -> [Complex64; Q] {
    let w = 0.5 * z;
    let size = w.norm();
    let mut moments = [Complex64::ZERO; Q];
    if size > Q as f64 {
        let end = z.exp();
        let inverse = w.inv();
        moments[0] = 0.5 * (end - 1.0) * inverse;
        moments[1] = (0.5 * (end + 1.0) - moments[0]) * inverse;
        for n in 1..Q - 1 {
            moments[n + 1] = moments[n - 1] - (2 * n + 1) as f64 * inverse * moments[n];
        }
    } else {
        // i_n(w) = w^n/(2n+1)!! sum_k (w^2/2)^k / (k! (2n+3) (2n+5) .. (2n+2k+1))
        let half_square = 0.5 * w * w;
        let series = |n: usize| {
            let (mut term, mut sum) = (Complex64::ONE, Complex64::ONE);
            let mut k = 1;
            while term.norm_sqr() > 1e-34 && k < 60 {
                term *= half_square / (k * (2 * n + 2 * k + 1)) as f64;
                sum += term;
                k += 1;
            }
            sum
        };
        let scale = w.exp();
        if size < 1e-2 {
            // a division by w would magnify rounding
            let mut power = scale;
            for n in 0..Q {
                moments[n] = power * series(n);
                power *= w / (2 * n + 3) as f64;
            }
        } else {
            const LAST: usize = Q - 1;
            let mut power = scale;
            for n in 0..LAST - 1 {
                power *= w / (2 * n + 3) as f64;
            }
            moments[LAST - 1] = power * series(LAST - 1);
            moments[LAST] = power * w / (2 * LAST + 1) as f64 * series(LAST);
            let inverse = w.inv();
            for n in (1..LAST).rev() {
                moments[n - 1] = moments[n + 1] + (2 * n + 1) as f64 * inverse * moments[n];
            }
        }
    }
    for n in (1..Q).step_by(2) {
        moments[n] = -moments[n];
    }
    moments
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(omega_rad_s: f64, damping_ratio: f64) -> BodyMode {
        BodyMode { omega_rad_s, damping_ratio }
    }

    /// Fixed fine composite Gauss quadrature of the defining integral.
    fn reference(mode: &BodyMode, h: f64) -> (Nodal, Nodal) {
        let (mut a, mut v) = ([0.0; Q], [0.0; Q]);
        let panels = 400;
        for i in 0..panels {
            for &(x, w) in &BASIS.fine {
                let s = (i as f64 + x) / panels as f64;
                let kernel = propagate(mode, (1.0 - s) * h);
                for (n, p) in legendre(s).into_iter().enumerate() {
                    a[n] += w * h / panels as f64 * kernel.p12 * p;
                    v[n] += w * h / panels as f64 * kernel.p22 * p;
                }
            }
        }
        (a, v)
    }

    #[test]
    fn responses_equal_their_integrals_for_all_frequencies_and_dampings() {
        for omega in [1e-3, 0.3, 1.3, 1.5, 2.9, 6.2, 12.0, 13.9, 14.1, 40.0, 300.0] {
            for zeta in [0.0, 0.02, 0.5, 0.98, 0.995, 1.0, 1.3, 20.0] {
                let (mode, h) = (mode(omega, zeta), 1.0);
                let ((a, v), (ra, rv)) = (response(&mode, h), reference(&mode, h));
                for n in 0..Q {
                    let floor = 1e-14 / omega.max(1.0);
                    assert!(
                        (a[n] - ra[n]).abs() < 2e-13 * ra[n].abs() + floor,
                        "{omega} {zeta} {n}: {} {}",
                        a[n],
                        ra[n]
                    );
                    assert!(
                        (v[n] - rv[n]).abs() < 2e-13 * rv[n].abs() + 1e-13,
                        "{omega} {zeta} {n}: {} {}",
                        v[n],
                        rv[n]
                    );
                }
            }
        }
    }

    /// The quadrature resolves both decays, however far they are apart. Its kernel of the velocity is known to the rounding of one,
    /// which adds up for as long as the slower decay lasts.
    #[test]
    fn two_decays_meet_the_quadrature() {
        for zeta in [ROOTS_APART, 1.3, 5.0, 1e3, 1e6] {
            for turned in [2.1, 5.0, 16.1, 40.0, 1e3, 1e6, 1e12] {
                let mode = mode(0.5 * turned / zeta, zeta);
                let (own, other) = (response_of_two_decays(&mode, 1.0), response_by_quadrature(&mode, 1.0));
                // the largest velocity after a unit of the force
                let largest = 1.0 / turned;
                let kernel = f64::EPSILON * slow_decay(&mode).recip().min(1.0);
                for n in 0..Q {
                    let differences = [own.0[n] - other.0[n], own.1[n] - other.1[n]].map(f64::abs);
                    assert!(differences[0] < 1e-14 * largest, "{zeta} {turned} {n}: {differences:?}");
                    assert!(differences[1] < 1e-14 * largest + kernel, "{zeta} {turned} {n}: {differences:?}");
                }
                // the velocity after a constant force is the displacement after a unit velocity
                assert!((own.1[0] - propagate(&mode, 1.0).p12).abs() < 1e-14 * largest, "{zeta} {turned}");
            }
        }
    }

    /// A high mode of a beam with Rayleigh damping on a long panel. A quadrature of the whole panel would take 30 parts.
    #[test]
    fn a_quadrature_ends_where_the_kernel_has_decayed() {
        for zeta in [NEARLY_CRITICAL, 1.0, ROOTS_APART] {
            let (mode, calls) = (mode(1e9, zeta), std::cell::Cell::new(0));
            let (displacement, _) = response_of(&mode, 1.0, |t| {
                calls.set(calls.get() + 1);
                let kernel = propagate(&mode, t);
                (kernel.p12, kernel.p22)
            });
            assert!(calls.get() <= 8 * BASIS.fine.len(), "{zeta}: {} calls", calls.get());
            // the static displacement under a constant force
            assert!((displacement[0] * 1e18 - 1.0).abs() < 1e-13, "{zeta}: {:e}", displacement[0]);
        }
    }

    #[test]
    fn a_body_that_has_hardly_moved_is_known_to_have_moved_so_much() {
        // -(omega t)^2/2 (1 - 2 zeta omega t/3 + (4 zeta^2 - 1) (omega t)^2/12 ..)
        for zeta in [0.0f64, 0.02, 0.999, 1.0, 1.001, 7.0] {
            for t in [1e-3, 1e-6, 1e-9f64] {
                let series = 1.0 - 2.0 * zeta * t / 3.0 + (4.0 * zeta * zeta - 1.0) * t * t / 12.0;
                let moved = propagate(&mode(1.0, zeta), t).p11_less_1;
                // the effect of damping cancels to first order, and leaves its rounding
                let floor = 4.0 * f64::EPSILON * (t * t + zeta * t) + 1e2 * (1.0 + zeta).powi(3) * t.powi(5);
                assert!((moved + 0.5 * t * t * series).abs() < floor, "{zeta} {t}: {moved:e}");
            }
        }
    }

    #[test]
    fn free_motion_composes_and_solves_the_equation() {
        for zeta in [0.0, 0.02, 0.999, 1.0, 1.001, 7.0] {
            let mode = mode(3.0, zeta);
            let (whole, half) = (propagate(&mode, 0.8), propagate(&mode, 0.4));
            for start in [(1.0, 0.0), (0.0, 1.0)] {
                let middle = half.apply(start.0, start.1);
                let (once, twice) = (whole.apply(start.0, start.1), half.apply(middle.0, middle.1));
                assert!((once.0 - twice.0).abs() < 1e-14 && (once.1 - twice.1).abs() < 1e-13, "{zeta}");
            }
            let d = 1e-4;
            let (before, after) = (propagate(&mode, 0.4 - d), propagate(&mode, 0.4 + d));
            assert!(((after.p11_less_1 - before.p11_less_1) / (2.0 * d) - half.p21).abs() < 1e-6);
        }
    }
}
