//! A law with two parameters: a single contact for light balls, and common motion with the slow modes for heavy ones.
//!
//! A light ball touches the beam once. Modes that are slow compared with the contact take up an impulse; fast modes follow it
//! quasi-statically without loss. With `tau` the duration of the contact with an immovable surface (Hertz),
//!
//! ```text
//! Z_w = m sum phi_k^2 exp(-(c omega_k tau)^2),      A = exp(-q Z_w).
//! ```
//!
//! A heavy ball touches the beam many times, until both have the same velocity. It then moves with the beam as if attached.
//! The beam with the mass attached at the contact has modes `psi_j`, and `s_j = m psi_j^2` is the share of the ball's velocity in
//! mode `j`. Half a period of that mode later this share has the opposite sign, and the ball separates. Among many shares with
//! different periods the largest is decisive:
//!
//! ```text
//! e = A + (1 - A) max_j s_j.
//! ```
//!
//! Attached modes solve `m x sum phi_k^2/(omega_k^2 - x) = 1` in `x = Omega^2`, one between each two neighbouring
//! `omega_k^2` and one below the first, with `1/s = 1 + m x^2 sum phi_k^2/(omega_k^2 - x)^2`. Sum of all `s`: Z/(1+Z).

use vibroimpact_sim::modal::Mode;

/// A mode with `m phi^2` below this value at the contact has no separate attached mode.
const NEGLIGIBLE: f64 = 1e-12;
/// Number of bisections for a root to the last bit.
const HALVINGS: usize = 60;

/// The largest share of the velocity of a mass attached to the structure that belongs to one mode.
pub fn largest_share(mass_kg: f64, modes: &[Mode]) -> f64 {
    // m phi^2 and omega^2 of the modes that move here
    let moving: Vec<[f64; 2]> = modes
        .iter()
        .map(|mode| [mass_kg * mode.shape.powi(2), mode.omega_rad_s.powi(2)])
        .filter(|[weight, _]| *weight > NEGLIGIBLE)
        .collect();
    let z: f64 = moving.iter().map(|[weight, _]| weight).sum();
    let mut rest = z / (1.0 + z);
    let (mut largest, mut below) = (0.0f64, 0.0);
    for &[_, above] in &moving {
        let share = share(&moving, root(&moving, below, above));
        largest = largest.max(share);
        rest -= share;
        if rest <= largest {
            break;
        }
        below = above;
    }
    largest
}

/// The root between two poles, where the left-hand side rises from minus to plus infinity.
fn root(moving: &[[f64; 2]], mut low: f64, mut high: f64) -> f64 {
    for _ in 0..HALVINGS {
        let x = 0.5 * (low + high);
        let sum: f64 = moving.iter().map(|[weight, pole]| weight * x / (pole - x)).sum();
        *(if sum < 1.0 { &mut low } else { &mut high }) = x;
    }
    0.5 * (low + high)
}

fn share(moving: &[[f64; 2]], x: f64) -> f64 {
    let sum: f64 = moving.iter().map(|[weight, pole]| weight * (x / (pole - x)).powi(2)).sum();
    // at a pole the mass does not move
    if sum.is_finite() { 1.0 / (1.0 + sum) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(omega_rad_s: f64, shape: f64) -> Mode {
        Mode { omega_rad_s, damping_ratio: 0.0, shape }
    }

    #[test]
    fn one_mode_holds_its_share_of_the_joint_mass() {
        // a mass m on a modal mass 1/phi^2: after the plastic impact m/(m + 1/phi^2) of the velocity remains
        let share = largest_share(0.5, &[mode(100.0, 2.0)]);
        assert!((share - 2.0 / 3.0).abs() < 1e-12, "{share}");
        assert_eq!(largest_share(0.5, &[mode(100.0, 0.0)]), 0.0);
        assert_eq!(largest_share(0.5, &[]), 0.0);
    }

    #[test]
    fn two_modes_share_as_their_eigenvectors_do() {
        // M = I + m phi phi^T, K = diag(omega^2): generalised eigenvalues of a 2 by 2 problem by hand
        let (m, p, q, a, b) = (0.7, 1.3, 0.4, 50.0f64.powi(2), 80.0f64.powi(2));
        let (m11, m12, m22) = (1.0 + m * p * p, m * p * q, 1.0 + m * q * q);
        let (det, middle) = (m11 * m22 - m12 * m12, m22 * a + m11 * b);
        let root = (middle * middle - 4.0 * det * a * b).sqrt();
        let shares = [middle - root, middle + root].map(|twice| {
            let x = twice / (2.0 * det);
            let (u, v) = (x * m12, a - x * m11); // first row of K - x M
            m * (p * u + q * v).powi(2) / (m11 * u * u + 2.0 * m12 * u * v + m22 * v * v)
        });
        let z = m * (p * p + q * q);
        assert!((shares[0] + shares[1] - z / (1.0 + z)).abs() < 1e-12);
        let found = largest_share(m, &[mode(50.0, p), mode(80.0, q)]);
        assert!((found - shares[0].max(shares[1])).abs() < 1e-10, "{found} {shares:?}");
    }
}
