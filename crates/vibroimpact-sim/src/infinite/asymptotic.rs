//! Sustained contact at large times.
//!
//! Without compression (`x = 0`, the body attached to the structure: the limit of large `S`) the
//! Volterra equation is linear, and for the beam its Laplace transform gives the speed
//!
//! ```text
//! u(t) = exp(y^2) erfc(y),     y = 2 sqrt(t / pi),
//! ```
//!
//! and from it displacement and force. Its expansion for large `t` is thesis Eq. 2.47,
//! `z = sqrt(t) - pi/4 + pi/(8 sqrt(t)) + ...` (units `v T`, downwards). Compression corrects the
//! displacement by terms of order `1/t` only and separations by higher ones, so every sustained
//! contact ends on this solution; its compression is `x = (f / sqrt(S))^(2/3)`. A body attached to
//! a plate has `u = exp(-t)`.

use super::problem::Structure;
use std::f64::consts::PI;

/// Motion of a body in sustained contact at large times, in the units of
/// [`infinite`](crate::infinite).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attached {
    /// Displacement of body and structure towards the structure (units of `v T`).
    pub displacement: f64,
    /// Speed of both (units of `v`).
    pub speed: f64,
    /// Contact force (units of `F`).
    pub force: f64,
}

/// Thesis Eq. 2.47: displacement `sqrt(t) - pi/4 + pi/(8 sqrt(t))` of a body in sustained contact
/// with a beam, in units of `v T`, positive towards the beam. In the thesis's own units (`D`, upwards)
/// multiply by `-S^(1/3)`.
///
/// ```
/// use vibroimpact_sim::infinite::{Structure, attached, displacement_eq_2_47};
/// let exact = attached(Structure::Beam, 1e4).displacement;
/// assert!((displacement_eq_2_47(1e4) - exact).abs() < 1e-4);
/// ```
pub fn displacement_eq_2_47(t: f64) -> f64 {
    t.sqrt() - PI / 4.0 + PI / (8.0 * t.sqrt())
}

/// Motion of a body that is attached to the structure from the first touch on: the limit `S` to
/// infinity at any time `t` (units of `T`), and the limit `t` to infinity of sustained contact for
/// any `S`. Times below zero count as zero.
///
/// ```
/// use vibroimpact_sim::infinite::{Structure, attached};
/// let start = attached(Structure::Beam, 0.0);
/// assert_eq!(start.speed, 1.0);
/// ```
pub fn attached(structure: Structure, t: f64) -> Attached {
    let t = t.max(0.0);
    match structure {
        Structure::Plate => Attached { displacement: -(-t).exp_m1(), speed: (-t).exp(), force: (-t).exp() },
        Structure::Beam if !(1e-6..=1e4).contains(&t) => attached_series(t),
        Structure::Beam => {
            // with c = sqrt(pi)/2: u = erfcx(sqrt(t)/c), f = -u', z = t - int int f
            let c = 0.5 * PI.sqrt();
            let speed = puruspe::erfcx(t.sqrt() / c);
            let force = (1.0 / (PI * t).sqrt() - speed / c) / c;
            // int u = c^2 (u - 1) + sqrt(t), by the transform 1 / (s + c sqrt(s) s)
            let displacement = t.sqrt() + c * c * (speed - 1.0);
            Attached { displacement, speed, force }
        }
    }
}

/// Power series near zero, asymptotic series at large times (`c^2 = pi/4`).
fn attached_series(t: f64) -> Attached {
    let c = 0.5 * PI.sqrt();
    if t < 1.0 {
        // u = sum (-y)^n / Gamma(n/2 + 1), y = sqrt(t)/c
        let y = t.sqrt() / c;
        let gamma = [1.0, c, 1.0, 1.5 * c, 2.0, 3.75 * c, 6.0];
        let terms = |shift: i32| -> f64 { (0..5).map(|n| (-y).powi(n) / gamma[(n + shift) as usize]).sum() };
        let force = if t > 0.0 { (1.0 / (PI * t).sqrt() - terms(0) / c) / c } else { f64::INFINITY };
        return Attached { displacement: t * terms(2), speed: terms(0), force };
    }
    // erfcx(y) = (1 - 1/(2y^2) + 3/(4y^4) - ...) / (sqrt(pi) y), q = 1/(2 y^2)
    let q = PI / (8.0 * t);
    let u = 0.5 / t.sqrt();
    Attached {
        displacement: t.sqrt() - PI / 4.0 + PI / 4.0 * u * (1.0 - q * (1.0 - 3.0 * q * (1.0 - 5.0 * q))),
        speed: u * (1.0 - q * (1.0 - 3.0 * q * (1.0 - 5.0 * q))),
        force: 0.5 * u / t * (1.0 - q * (3.0 - 15.0 * q * (1.0 - 7.0 * q))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The three branches join, and speed and force are derivatives of the displacement.
    #[test]
    fn branches_join_and_derivatives_agree() {
        for edge in [1e-6_f64, 1e4] {
            let (a, b) =
                (attached(Structure::Beam, edge * (1.0 - 1e-12)), attached(Structure::Beam, edge * (1.0 + 1e-12)));
            assert!((a.displacement / b.displacement - 1.0).abs() < 3e-10, "{a:?} {b:?}");
            assert!((a.speed / b.speed - 1.0).abs() < 1e-10, "{a:?} {b:?}");
            assert!((a.force / b.force - 1.0).abs() < 1e-9, "{a:?} {b:?}");
        }
        for structure in [Structure::Beam, Structure::Plate] {
            for t in [3e-5, 0.01, 0.7, 5.0, 20.0, 3e4] {
                if structure == Structure::Plate && t > 10.0 {
                    continue;
                }
                let h = 1e-3 * t;
                let at = |t| attached(structure, t);
                let speed = (at(t + h).displacement - at(t - h).displacement) / (2.0 * h);
                let force = -(at(t + h).speed - at(t - h).speed) / (2.0 * h);
                assert!((speed / at(t).speed - 1.0).abs() < 1e-5, "{structure:?} {t} {speed} {:?}", at(t));
                assert!((force / at(t).force - 1.0).abs() < 1e-4, "{t} {force}");
            }
        }
    }
}
