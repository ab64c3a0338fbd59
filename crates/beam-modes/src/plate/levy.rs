//! Static deflection of plates that are pinned along two opposite edges, by Levy's single series.
//!
//! With sines `sin(k x)`, `k = m pi/a`, along the pinned direction, the deflection across under a unit load at `(x, y)`
//! satisfies `(d^2/dt^2 - 1)^2 W = delta` in `t = k y`. It is `(1 + u) e^(-u)/4` at the distance `u` from the load plus two
//! terms that decay from either edge, `e^(-t)` and `t e^(-t)`, which satisfy the conditions there (S. P. Timoshenko and S.
//! Woinowsky-Krieger, *Theory of Plates and Shells*, 1959, chapter 6). At the load itself
//!
//! ```text
//! D G = sum_m sin^2(k x) (1 + what the edges add)/(2 a k^3).                                                      (1)
//! ```

use super::definition::Edge;
use super::navier::sines_over_cubes;
use crate::statics::solve;
use std::f64::consts::PI;

/// Largest number of terms; beyond them the contribution of the edges is taken as constant.
const TERMS: i32 = 100_000;
/// A term that has decayed over this distance is zero to rounding.
const FAR: f64 = 40.0;

/// The two linear forms in `W`, `W'`, `W''`, `W'''`, with derivatives inwards, that are zero at an edge.
fn conditions(edge: Edge, nu: f64) -> [[f64; 4]; 2] {
    match edge {
        Edge::Clamped => [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]],
        Edge::Pinned => [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]],
        Edge::Free => [[-nu, 0.0, 1.0, 0.0], [0.0, nu - 2.0, 0.0, 1.0]],
    }
}

/// The terms that decay from an edge, at this edge, and those of the other edge, at the distance `s`.
fn own() -> [[f64; 4]; 2] {
    [[1.0, -1.0, 1.0, -1.0], [0.0, 1.0, -2.0, 3.0]]
}

fn other(s: f64) -> [[f64; 4]; 2] {
    [[1.0, 1.0, 1.0, 1.0], [s, s - 1.0, s - 2.0, s - 3.0]].map(|values| values.map(|value| value * (-s).exp()))
}

/// The term of the load, times 4, on an edge at the distance `u`.
fn load(u: f64) -> [f64; 4] {
    [1.0 + u, u, u - 1.0, u - 2.0].map(|value| value * (-u).exp())
}

/// `D G` of Eq. (1), in m^2: sines along a side `a`, `edges` at `y = 0` and `y = b`.
pub(super) fn deflection([a, b]: [f64; 2], edges: [Edge; 2], nu: f64, [x, y]: [f64; 2]) -> f64 {
    let forms = edges.map(|edge| conditions(edge, nu));
    let dot = |form: &[f64; 4], values: &[f64; 4]| form.iter().zip(values).map(|(f, v)| f * v).sum::<f64>();
    if x <= 0.0 || x >= a {
        return 0.0;
    }
    let (mut sum, mut added, mut taken) = (0.0, 0.0, 0.0);
    for m in 1..=TERMS {
        let k = PI * f64::from(m) / a;
        let distances = [k * y, k * (b - y)];
        let far = other(k * b);
        let row = |edge: usize, form: usize| {
            let form = &forms[edge][form];
            let (near, far) = (own().map(|values| dot(form, &values)), far.map(|values| dot(form, &values)));
            let [low, high] = if edge == 0 { [near, far] } else { [far, near] };
            ([low[0], low[1], high[0], high[1]], -dot(form, &load(distances[edge])))
        };
        let rows = [row(0, 0), row(0, 1), row(1, 0), row(1, 1)];
        let terms = solve(rows.map(|(left, _)| left), rows.map(|(_, right)| right), 4);
        let decayed =
            |edge: usize| (terms[2 * edge] + terms[2 * edge + 1] * distances[edge]) * (-distances[edge]).exp();
        added = decayed(0) + decayed(1);
        let sine = (k * x).sin().powi(2) / f64::from(m).powi(3);
        sum += sine * (1.0 + added);
        taken += sine;
        if distances.iter().all(|distance| *distance == 0.0 || *distance > FAR) {
            break;
        }
    }
    let rest = sines_over_cubes(x / a) - taken;
    (sum + rest * (1.0 + added)) * a * a / (2.0 * PI.powi(3))
}

#[cfg(test)]
mod tests {
    use super::super::{Plate, PlateTheory, navier};
    use super::*;

    #[test]
    fn a_plate_pinned_all_round_is_navier_s() {
        let plate = Plate {
            length_m: 1.0,
            width_m: 0.7,
            thickness_m: 0.01,
            youngs_modulus_pa: 2e11,
            poissons_ratio: 0.3,
            density_kg_m3: 7800.0,
            edges: [Edge::Pinned; 4],
            theory: PlateTheory::Kirchhoff,
        };
        for [x, y] in [[0.5, 0.35], [0.3, 0.1], [0.9, 0.69], [0.5, 0.699]] {
            let levy = deflection([1.0, 0.7], [Edge::Pinned; 2], 0.3, [x, y]) / plate.flexural_rigidity_n_m();
            let navier = navier::static_compliance(&plate, x, y / 0.7);
            assert!((levy / navier - 1.0).abs() < 1e-9, "{x} {y}: {levy:e} {navier:e}");
        }
    }

    /// The deflection of a strip far from the constraints of its long edges is that of an infinite one; it is smaller with
    /// clamped edges than with pinned ones, and larger with free ones.
    #[test]
    fn edges_order_the_deflection() {
        let [clamped, pinned, free] = [Edge::Clamped, Edge::Pinned, Edge::Free]
            .map(|edge| [0.3, 6.0].map(|b| deflection([1.0, b], [edge; 2], 0.3, [0.4, 0.5 * b])));
        assert!(clamped[0] < pinned[0] && pinned[0] < free[0]);
        assert!((clamped[1] / pinned[1] - 1.0).abs() < 1e-5 && (free[1] / pinned[1] - 1.0).abs() < 1e-5);
    }
}
