//! Error of the polynomial through the start and the nodes of a panel for a vibration.
//!
//! The error of interpolation at `n` points for a vibration `A e^{i theta s}` and its derivatives is at most
//! `A theta^n |P^(r)|/n!`, where `P` is the product of the differences of `s` and the points (A. Shadrin, 1995). For any
//! frequency it is at most `A (theta^r + Lambda_r)` with the Lebesgue constants `Lambda_r` of the derivatives. A decay
//! `A e^{-theta s}` obeys the same bounds.

use super::system::System;
use crate::panel::legendre::{BASIS, Q};
use crate::panel::oscillator::BodyMode;
use std::sync::LazyLock;

/// Derivatives of the interpolation error that are bounded.
pub(crate) const ORDERS: usize = 3;
/// Modes damped more than this are two decays, `a' + r_2 a` with the rate `r_1` and the other way round.
pub(crate) const OVERDAMPED: f64 = 1.5;
/// A mode that turns by less than this in a panel (rad) is interpolated to rounding.
pub(crate) const FOLLOWED: f64 = 0.2;

struct Bounds {
    /// `max |P^(r)|/n!` and `Lambda_r`.
    resolved: [f64; ORDERS],
    lebesgue: [f64; ORDERS],
}

static BOUNDS: LazyLock<Bounds> = LazyLock::new(|| {
    let mut points = vec![0.0];
    points.extend_from_slice(&BASIS.nodes);
    let n = points.len();
    // derivatives of a product of linear factors at a location, by the product rule
    let product = |place: f64, without: usize| {
        let mut derivatives = [1.0, 0.0, 0.0];
        for (m, point) in points.iter().enumerate().filter(|(m, _)| *m != without) {
            let (factor, [value, slope, bend]) = (place - point, derivatives);
            let scale = if without < n { points[without] - points[m] } else { 1.0 };
            derivatives =
                [value * factor / scale, (slope * factor + value) / scale, (bend * factor + 2.0 * slope) / scale];
        }
        derivatives
    };
    let factorial: f64 = (1..=n).map(|i| i as f64).product();
    let mut bounds = Bounds { resolved: [0.0; ORDERS], lebesgue: [0.0; ORDERS] };
    // the derivatives are largest at an end of the panel; the values are smooth between the nodes
    const PLACES: u32 = 64;
    for i in 0..=PLACES {
        let place = f64::from(i) / f64::from(PLACES);
        let whole = product(place, n);
        let lagrange: Vec<_> = (0..n).map(|j| product(place, j)).collect();
        for r in 0..ORDERS {
            bounds.resolved[r] = bounds.resolved[r].max(whole[r].abs() / factorial);
            let sum = lagrange.iter().map(|derivatives| derivatives[r].abs()).sum();
            bounds.lebesgue[r] = bounds.lebesgue[r].max(sum);
        }
    }
    bounds
});

/// Interpolation errors of a unit vibration that turns by `theta` on a panel, and of its first two derivatives.
pub(crate) fn interpolation(theta: f64) -> [f64; ORDERS] {
    let bounds = &*BOUNDS;
    let power = theta.powi(Q as i32 + 1);
    let fast = [1.0, theta, theta * theta];
    std::array::from_fn(|r| (power * bounds.resolved[r]).min(fast[r] + bounds.lebesgue[r]))
}

/// Interpolation errors of unit vibrations of all modes on a panel of one length, and of their first two derivatives. They are
/// zero for overdamped modes, which are treated as two decays, and for modes that are interpolated to rounding.
pub(crate) struct Missed(pub [Vec<f64>; ORDERS]);

impl Missed {
    pub fn new(system: &System, h: f64) -> Missed {
        let of = |mode: &BodyMode| {
            let turning = mode.omega_rad_s * h * (1.0 + mode.damping_ratio);
            if turning < FOLLOWED || mode.damping_ratio > OVERDAMPED { [0.0; ORDERS] } else { interpolation(turning) }
        };
        let all: Vec<[f64; ORDERS]> = system.modes.iter().map(of).collect();
        Missed(std::array::from_fn(|r| all.iter().map(|missed| missed[r]).collect()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolation_of_a_vibration_is_bounded() {
        let mut points = vec![0.0];
        points.extend_from_slice(&BASIS.nodes);
        for theta in [0.3, 1.0, 2.0, 4.0, 7.0, 20.0] {
            let bound = interpolation(theta)[0];
            let mut worst = 0.0f64;
            for phase in [0.0, 0.4, 0.9, 1.3] {
                let f = |s: f64| (theta * s + phase).sin();
                for i in 0..=200 {
                    let place = f64::from(i) / 200.0;
                    let mut value = 0.0;
                    for (j, point) in points.iter().enumerate() {
                        let others = points.iter().enumerate().filter(|(m, _)| *m != j);
                        value +=
                            f(*point) * others.map(|(_, other)| (place - other) / (point - other)).product::<f64>();
                    }
                    worst = worst.max((value - f(place)).abs());
                }
            }
            assert!(worst <= bound + 1e-14, "{theta}: {worst:e} {bound:e}");
            assert!(bound < 1e3 * worst + 1e-12, "{theta}: {worst:e} {bound:e}");
        }
    }
}
