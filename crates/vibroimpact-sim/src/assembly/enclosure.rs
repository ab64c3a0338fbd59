//! How far the overlap of a contact can be from what is known of it.
//!
//! - On a panel: by how much the polynomial through the start and the nodes may miss the overlap. With a force that is a
//!   polynomial, a mode moves along a polynomial, about `-psi F/omega^2` for a fast one, and vibrates freely about that
//!   with an amplitude that follows from its state. Interpolation at `n` points misses a vibration `A e^{i theta s}` and
//!   its derivatives by at most `A theta^n |P^(r)|/n!`, `P` the product of `s` less the points (A. Shadrin, 1995), and,
//!   however fast it is, by `A (theta^r + Lambda_r)` with the Lebesgue constants `Lambda_r` of the derivatives.
//! - In free flight: a time before which no contact can come. The modes above any `K` move the overlap by at most
//!   `H = sum |psi_k| A_k`, `A_k^2 = a_k^2 + (b_k/omega_k)^2`, and of the rest `|g''| <= B = sum (1 + 2 zeta_k) omega_k^2
//!   |psi_k| A_k`. So the separation is at least `u_K - H + u_K' t - B t^2/2`, and the best of these parabolas over `K`
//!   holds.

use super::load::Loads;
use super::system::{Link, System};
use crate::modal::flight::first_root_of_parabola;
use crate::modal::legendre::{BASIS, Q};
use std::sync::LazyLock;

/// Derivatives of the interpolation error that are bounded.
const ORDERS: usize = 3;
/// A mode that turns by less than this in a panel (rad) is interpolated to rounding.
const FOLLOWED: f64 = 0.2;

struct Bounds {
    /// `max |P^(r)|/n!` and `Lambda_r`.
    resolved: [f64; ORDERS],
    lebesgue: [f64; ORDERS],
}

static BOUNDS: LazyLock<Bounds> = LazyLock::new(|| {
    let mut points = vec![0.0];
    points.extend_from_slice(&BASIS.nodes);
    let n = points.len();
    // derivatives of a product of linear factors at a place, by the product rule
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
    for i in 0..=400 {
        let place = f64::from(i) / 400.0;
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

/// By how much interpolation on a panel misses a unit vibration that turns by `theta`, and its first two derivatives.
fn interpolation(theta: f64) -> [f64; ORDERS] {
    let bounds = &*BOUNDS;
    let power = theta.powi(Q as i32 + 1);
    let fast = [1.0, theta, theta * theta];
    std::array::from_fn(|r| (power * bounds.resolved[r]).min(fast[r] + bounds.lebesgue[r]))
}

/// By how much the overlap of a contact and its first two derivatives along a panel of `h` may differ from the polynomial
/// through start and nodes. `steady` is where the contact forces hold each mode, and its rate.
pub(super) fn of_panel(
    system: &System,
    loads: &Loads,
    contact: usize,
    h: f64,
    (amplitude, rate): (&[f64], &[f64]),
    steady: impl Fn(usize) -> (f64, f64),
) -> [f64; ORDERS] {
    let mut rho = [0.0; ORDERS];
    let mut add = |amplitude: f64, theta: f64| {
        let missed = interpolation(theta);
        for r in 0..ORDERS {
            rho[r] += amplitude * missed[r];
        }
    };
    for &(k, psi) in system.links[contact].elastic.iter().rev() {
        let omega = system.modes[k].omega_rad_s;
        let turning = omega * h * (1.0 + system.modes[k].damping_ratio);
        if omega * h < FOLLOWED && turning < FOLLOWED {
            break;
        }
        let (held, held_rate) = steady(k);
        let size = (amplitude[k] - held).abs() + (rate[k] - held_rate).abs() / omega;
        add(psi.abs() * size, turning);
    }
    for harmonic in &loads.harmonics {
        add(harmonic.contacts[contact].norm(), harmonic.omega_rad_s * h);
    }
    rho
}

/// What is certain of a flight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flight {
    /// A time (s) before which the contact cannot close, infinite if it never can.
    pub safe_s: f64,
    /// The overlap's second derivative is never larger (m/s^2).
    pub curvature: f64,
}

/// A time from `time_s` on before which an open contact cannot close in free motion, infinite if it never can. `separation`
/// is the distance of the surfaces, `rate` that of their approach; straight-line loads last for `lasting_s`.
pub(super) fn safe_time(
    system: &System,
    loads: &Loads,
    contact: usize,
    (time_s, lasting_s): (f64, f64),
    (separation, rate): (f64, f64),
    (amplitude, mode_rate): (&[f64], &[f64]),
) -> Flight {
    let link: &Link = &system.links[contact];
    let size = |k: usize| amplitude[k].hypot(mode_rate[k] / system.modes[k].omega_rad_s);
    let acceleration = |after: f64| loads.acceleration(contact, time_s + after);
    let mut curvature =
        acceleration(0.0).max(acceleration(if lasting_s.is_finite() { lasting_s } else { 0.0 })).max(0.0);
    curvature += loads.harmonics.iter().map(|h| h.omega_rad_s.powi(2) * h.contacts[contact].norm()).sum::<f64>();
    // from all modes down: what is left out of the parabola is bounded by its amplitude
    let mut cuts = Vec::with_capacity(link.elastic.len() + 1);
    let (mut u, mut closing, mut above) = (separation, rate, 0.0);
    cuts.push((u, closing, 0.0));
    for &(k, psi) in link.elastic.iter().rev() {
        let bound = psi.abs() * size(k);
        above += bound;
        u += psi * amplitude[k];
        closing -= psi * mode_rate[k];
        cuts.push((u - above * (1.0 + 1e-12), closing, bound));
    }
    let mut best = 0.0f64;
    for i in (0..cuts.len()).rev() {
        let (u, closing, _) = cuts[i];
        // a parabola that is still above zero at the best time yet has its root beyond it
        let at_best = u - best * (closing + 0.5 * curvature * best);
        if best < f64::INFINITY && at_best > 0.0 && u >= 0.0 || (u == 0.0 && closing < 0.0 && best == 0.0) {
            best = first_root_of_parabola(u, -closing, curvature);
        }
        // the next parabola follows one mode more
        if i > 0 {
            let (k, _) = link.elastic[link.elastic.len() - i];
            let mode = &system.modes[k];
            curvature += (1.0 + 2.0 * mode.damping_ratio) * mode.omega_rad_s.powi(2) * cuts[i].2;
        }
    }
    Flight { safe_s: best, curvature }
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
