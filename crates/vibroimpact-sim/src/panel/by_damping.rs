//! Derivatives of a mode on a step with respect to its damping ratio, in closed form, also near critical damping.
//!
//! With `sigma = zeta omega`, `D = omega^2 (zeta^2 - 1)` and `S = sinh(sqrt(D) t)/sqrt(D)`, `C = dS/dt`, which are entire
//! functions of `D`, the displacement after a unit velocity is `K = e^{-sigma t} S`. By `d sigma/d zeta = omega`,
//! `dD/d zeta = 2 omega sigma` and `dC/dD = t S/2`
//!
//! ```text
//! dK/d zeta  = -omega t K + 2 omega sigma W,      W = e^{-sigma t} dS/dD,                                 (1)
//! dK'/d zeta = -omega (t K' + K) + omega sigma (t K - 2 sigma W),
//!
//! dS/dD = (t C - S)/(2 D) = t^3 sum_(k >= 1) k (D t^2)^(k-1)/(2k + 1)!                                    (2)
//! ```
//!
//! and the rest of the free motion follows from `p12 = K`, `p22 = K'`, `p11 = p22 + 2 sigma p12`, `p21 = -omega^2 p12`.
//! Responses to forces are integrals of these.

use super::forcing::{Compliance, Order};
use super::legendre::{BASIS, Matrix, Nodal};
use super::oscillator::{BodyMode, propagate, response_of};

/// Terms of the series (2) for `|D t^2| <= 1`.
const TERMS: usize = 10;

/// Derivatives with respect to the damping ratio of a mode of unit weight.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ByDamping {
    /// Free motion over the step: amplitude and rate at the end, each from amplitude and from rate at the start.
    pub free: [[f64; 2]; 2],
    /// Free motion at the nodes, from amplitude and from rate, and its rate.
    pub at_nodes: (Nodal, Nodal),
    pub rates: (Nodal, Nodal),
    /// Amplitude and rate at the end under unit Legendre forces.
    pub end: (Nodal, Nodal),
    /// Response at the nodes to nodal forces, and its rate.
    pub compliance: Matrix,
    pub compliance_rates: Matrix,
}

impl ByDamping {
    /// The derivatives for a step of `h` without forces.
    pub fn of_free_motion(mode: &BodyMode, h: f64) -> ByDamping {
        ByDamping { free: free(mode, h), ..ByDamping::default() }
    }

    /// The derivatives for a step of `h`.
    pub fn new(mode: &BodyMode, h: f64) -> ByDamping {
        let response = |t: f64| {
            response_of(mode, t, |t| {
                let [[_, moved], [_, speed]] = free(mode, t);
                (moved, speed)
            })
        };
        let [mut compliance, mut rates] = [Order::Displacement, Order::Velocity].map(Compliance::new);
        compliance.add_response(1.0, h, |t| response(t).0);
        rates.add_response(1.0, h, |t| response(t).1);
        let at_nodes = BASIS.nodes.map(|c| free(mode, c * h));
        let [by_amplitude, by_rate] = [0, 1].map(|from| at_nodes.map(|motion| motion[0][from]));
        let [rate_by_amplitude, rate_by_rate] = [0, 1].map(|from| at_nodes.map(|motion| motion[1][from]));
        ByDamping {
            free: free(mode, h),
            at_nodes: (by_amplitude, by_rate),
            rates: (rate_by_amplitude, rate_by_rate),
            end: response(h),
            compliance: compliance.at_nodes(h),
            compliance_rates: rates.at_nodes(h),
        }
    }
}

/// Derivatives of `p11`, `p12` and `p21`, `p22`, Eq. (1).
fn free(mode: &BodyMode, t: f64) -> [[f64; 2]; 2] {
    let (omega, zeta) = (mode.omega_rad_s, mode.damping_ratio);
    let (sigma, square) = (zeta * omega, omega * omega * (zeta - 1.0) * (zeta + 1.0));
    let kernel = propagate(mode, t);
    let (moved, speed) = (kernel.p12, kernel.p22);
    let parted = square * t * t;
    let by_square = if parted.abs() <= 1.0 {
        (-sigma * t).exp() * t.powi(3) * series(parted)
    } else {
        (t * (speed + sigma * moved) - moved) / (2.0 * square)
    };
    let p12 = omega * (2.0 * sigma * by_square - t * moved);
    let p22 = omega * (sigma * (t * moved - 2.0 * sigma * by_square) - t * speed - moved);
    [[p22 + 2.0 * (omega * moved + sigma * p12), p12], [-omega * omega * p12, p22]]
}

/// `sum_(k >= 1) k x^(k-1)/(2k + 1)!`.
fn series(x: f64) -> f64 {
    let (mut sum, mut term) = (0.0, 1.0 / 6.0);
    for k in 1..=TERMS {
        sum += k as f64 * term;
        term *= x / ((2 * k + 2) * (2 * k + 3)) as f64;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::forcing::{Part, Way, along};

    fn mode(damping_ratio: f64) -> BodyMode {
        BodyMode { omega_rad_s: 1.0, damping_ratio }
    }

    /// All values at one damping ratio, by the methods of time integration.
    fn all(mode: &BodyMode, h: f64) -> Vec<f64> {
        let whole = propagate(mode, h);
        let of = |order| along((Way::of(mode, h), order), mode, h, &mut 2);
        let ((Part { at_nodes, end }, compliance), (_, rates)) = (of(Order::Displacement), of(Order::Velocity));
        let free = [whole.p11_less_1, whole.p12, whole.p21, whole.p22];
        let rows = [free.to_vec(), at_nodes.0.to_vec(), at_nodes.1.to_vec(), end.0.to_vec(), end.1.to_vec()];
        [rows.concat(), compliance.at_nodes(h).concat(), rates.at_nodes(h).concat()].concat()
    }

    #[test]
    fn derivatives_meet_differences_of_the_march_on_both_sides_of_the_double_root() {
        for zeta in [0.7, 0.95, 1.0 - 1e-9, 1.0, 1.0 + 1e-6, 1.04, 1.3] {
            for h in [1e-3, 0.1, 1.0, 2.9, 7.0, 40.0] {
                let ByDamping { free, at_nodes, end, compliance, compliance_rates, .. } =
                    ByDamping::new(&mode(zeta), h);
                let rows = [at_nodes.0, at_nodes.1, end.0, end.1];
                let own = [free.concat(), rows.concat(), compliance.concat(), compliance_rates.concat()].concat();
                let [fine, coarse] = [5e-3, 1e-2].map(|step| {
                    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|place| all(&mode(zeta + place * step), h));
                    let slope = |i: usize| (8.0 * (c[i] - b[i]) - (d[i] - a[i])) / (12.0 * step);
                    (0..own.len()).map(slope).collect::<Vec<f64>>()
                });
                for (i, own) in own.iter().enumerate() {
                    // extrapolated, of sixth order; its rounding error is that of fourteen digits divided by the step
                    let reference = fine[i] + (fine[i] - coarse[i]) / 15.0;
                    assert!((own - reference).abs() <= 1e-10 * h.min(1.0), "{zeta} {h} {i}: {own} {reference}");
                }
            }
        }
    }

    /// At the double root `K = t e^{-omega t}` changes by `omega t^2 e^{-omega t} (omega t/3 - 1)`: not at all at `omega t = 3`.
    #[test]
    fn critical_damping_has_its_closed_form() {
        for omega in [0.3, 20.0] {
            for turned in [1e-6, 0.4, 3.0, 9.0, 300.0] {
                let t: f64 = turned / omega;
                let found = free(&BodyMode { omega_rad_s: omega, damping_ratio: 1.0 }, t);
                let size = t * turned * (-turned).exp();
                assert!((found[0][1] - size * (turned / 3.0 - 1.0)).abs() <= 1e-14 * size * (1.0 + turned));
                let by_time = turned * (-turned).exp() * (2.0 * turned - 2.0 - turned * turned / 3.0);
                assert!((found[1][1] - by_time).abs() <= 1e-14 * turned * (-turned).exp() * (1.0 + turned).powi(2));
            }
        }
    }
}
