//! Plates that are pinned along all edges, in closed form.
//!
//! `w = sin(m pi x/a) sin(n pi y/b)`, with `k^2 = (m pi/a)^2 + (n pi/b)^2`. Kirchhoff: `omega = k^2 sqrt(D/(rho h))`. Mindlin
//! (*J. Appl. Mech.* 18 (1951) 31), with rotations `psi` of amplitude `k W kappa G h/(D k^2 + kappa G h - rho h^3 omega^2/12)`
//! and two frequencies for each pair `m, n`:
//!
//! ```text
//! (kappa G h k^2 - rho h omega^2)(D k^2 + kappa G h - rho h^3 omega^2/12) = (kappa G h k)^2.
//! ```
//!
//! Thickness-shear modes in which `w` is zero everywhere are omitted.

use super::definition::{Plate, PlateTheory};
use super::modes::{Kind, PlateModes, Sine};
use std::f64::consts::PI;

/// The first `count` modes.
pub(super) fn modes(plate: &Plate, count: usize) -> PlateModes {
    // All pairs below a wave number that includes enough of them: the quarter of the ellipse minus its edges.
    let (a, b) = (plate.length_m, plate.width_m);
    let mut limit = (4.0 * PI * count as f64 / (a * b)).sqrt() + 2.0 * PI * (a + b) / (a * b);
    let mut sines = below(plate, limit);
    while sines.len() < count {
        limit *= 1.2;
        sines = below(plate, limit);
    }
    sines.sort_by(|p, q| p.omega_rad_s.total_cmp(&q.omega_rad_s).then((p.m, p.n).cmp(&(q.m, q.n))));
    sines.truncate(count);
    let omega_rad_s = sines.iter().map(|sine| sine.omega_rad_s).collect();
    PlateModes { plate: *plate, rigid: 0, change: vec![0.0; count], omega_rad_s, kind: Kind::Sines(sines) }
}

/// All modes of wave numbers up to `limit`. None that is slower than the fastest of them can be missing: frequencies of either
/// branch increase with the wave number, and Mindlin's second branch is truncated where the first is.
fn below(plate: &Plate, limit: f64) -> Vec<Sine> {
    let (kx, ky) = (PI / plate.length_m, PI / plate.width_m);
    let mut sines = Vec::new();
    let mut m = 1;
    while kx * m as f64 <= limit {
        let rest = (limit * limit - (kx * m as f64).powi(2)).sqrt();
        for n in 1..=(rest / ky) as usize {
            let k = (kx * m as f64).hypot(ky * n as f64);
            branches(plate, k, |omega_rad_s, size| sines.push(Sine { m, n, omega_rad_s, size }));
        }
        m += 1;
    }
    if let PlateTheory::Mindlin { .. } = plate.theory {
        let mut highest = 0.0;
        branches(plate, limit, |omega, _| highest = if highest == 0.0 { omega } else { f64::min(highest, omega) });
        sines.retain(|sine| sine.omega_rad_s <= highest);
    }
    sines
}

/// Frequencies and mass-normalised amplitudes of the modes of one wave number, the slow one first.
fn branches(plate: &Plate, k: f64, mut found: impl FnMut(f64, f64)) {
    let (d, mass) = (plate.flexural_rigidity_n_m(), plate.mass_per_area_kg_m2());
    let thin = 2.0 / plate.mass_kg().sqrt();
    let PlateTheory::Mindlin { shear_coefficient } = plate.theory else {
        return found(k * k * (d / mass).sqrt(), thin);
    };
    let h = plate.thickness_m;
    let shear = shear_coefficient * plate.youngs_modulus_pa / (2.0 * (1.0 + plate.poissons_ratio)) * h;
    let rotary = mass * h * h / 12.0;
    // rho h rho I w^4 - (rho h (D k^2 + S) + rho I S k^2) w^2 + S D k^4 = 0, the small root without cancellation.
    let half = 0.5 * (mass * (d * k * k + shear) + rotary * shear * k * k);
    let (square, last) = (mass * rotary, shear * d * k.powi(4));
    let large = (half + (half * half - square * last).max(0.0).sqrt()) / square;
    for omega_squared in [last / square / large, large] {
        // Of the two expressions for the rotation, the one whose denominator is not a small difference.
        let bending = d * k * k + shear - rotary * omega_squared;
        let rotation = if omega_squared < shear / rotary {
            shear * k / bending
        } else {
            (shear * k * k - mass * omega_squared) / (shear * k)
        };
        found(omega_squared.sqrt(), thin / (1.0 + rotary / mass * rotation * rotation).sqrt());
    }
}

/// Static compliance at a location, given in shares of length and width.
///
/// For each wave in one direction the plate is a beam in the other on `(d^2/ds^2 - k^2)^2`, solved in closed form; the rest is
/// a single series, `1/k^3` for waves short against the distance to the edges, whose sum is known.
pub(super) fn static_compliance(plate: &Plate, x: f64, y: f64) -> f64 {
    let (a, b, d) = (plate.length_m, plate.width_m, plate.flexural_rigidity_n_m());
    if [x, y].iter().any(|share| *share <= 0.0 || *share >= 1.0) {
        return 0.0;
    }
    // Waves along the direction across which the location is further from the edges.
    let depth = |share: f64, length: f64| share.min(1.0 - share) * length;
    let (along, across, x, y) = if depth(y, b) / a >= depth(x, a) / b { (a, b, x, y) } else { (b, a, y, x) };
    let mut sum = 0.0;
    for m in 1..=100_000 {
        let k = PI * f64::from(m) / along;
        let (p, q) = (k * across * y, k * across * (1.0 - y));
        let inverse = 1.0 / (1.0 / p.tanh() + 1.0 / q.tanh());
        let beam = 0.5 * (coth_less(p) + coth_less(q)) * inverse * inverse - 0.25;
        let sine = (PI * f64::from(m) * x).sin();
        sum += sine * sine * beam / f64::from(m).powi(3);
        if p.min(q) > 20.0 {
            break;
        }
    }
    // The rest of every term, sin^2(m pi x)/(4 m^3), in closed form.
    let rest = 0.25 * sines_over_cubes(x);
    2.0 * along * along / (PI.powi(3) * d) * (sum + rest)
}

/// `coth r - r/sinh^2 r`.
fn coth_less(r: f64) -> f64 {
    if r < 0.05 {
        // 2r/3 - 4r^3/45 + 4r^5/315
        return r * (2.0 / 3.0 - r * r * (4.0 / 45.0 - r * r * 4.0 / 315.0));
    }
    // In decaying exponentials: (1 - e^2 - 4 r e)/(1 - e)^2 with e = exp(-2r).
    let e = (-2.0 * r).exp();
    (-(-4.0 * r).exp_m1() - 4.0 * r * e) / ((-2.0 * r).exp_m1()).powi(2)
}

/// `zeta(3)`.
const ZETA_3: f64 = 1.202_056_903_159_594_3;

/// `sum sin^2(m pi x)/m^3` for `0 < x < 1`.
pub(super) fn sines_over_cubes(x: f64) -> f64 {
    0.5 * (ZETA_3 - cosines_over_cubes(2.0 * PI * x.min(1.0 - x)))
}

/// `sum cos(m phi)/m^3` for `0 < phi <= pi`, by its expansion about zero.
fn cosines_over_cubes(phi: f64) -> f64 {
    let zeta = |s: i32| (1..=40).rev().map(|n| f64::from(n).powi(-s)).sum::<f64>();
    let ratio = (phi / (2.0 * PI)).powi(2);
    let mut sum = ZETA_3 + phi * phi * (0.5 * phi.ln() - 0.75);
    let mut power = 1.0;
    for k in 1..=30 {
        power *= ratio;
        let n = f64::from(2 * k);
        // The series of the zeta function converge slowly at 2 and 4.
        let zeta = match k {
            1 => PI * PI / 6.0,
            2 => PI.powi(4) / 90.0,
            3 => PI.powi(6) / 945.0,
            _ => zeta(2 * k),
        };
        sum -= 2.0 * zeta * power * phi * phi / (n * (n + 1.0) * (n + 2.0));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_of_cosines() {
        // sum (-1)^m/m^3 = -3 zeta(3)/4, and by summation.
        assert!((cosines_over_cubes(PI) + 0.75 * ZETA_3).abs() < 1e-14);
        for phi in [1e-3, 0.3, 2.0] {
            let direct: f64 = (1..200_000).rev().map(|m| (f64::from(m) * phi).cos() / f64::from(m).powi(3)).sum();
            assert!((cosines_over_cubes(phi) - direct).abs() < 1e-11, "{phi}");
        }
    }

    #[test]
    fn the_kernel_across_is_smooth_where_its_formula_changes() {
        assert!((coth_less(0.05 - 1e-12) - coth_less(0.05 + 1e-12)).abs() < 2e-12);
        assert!((coth_less(1.0) - (1.0 / 1f64.tanh() - 1.0 / 1f64.sinh().powi(2))).abs() < 1e-15);
    }
}
