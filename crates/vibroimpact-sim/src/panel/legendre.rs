//! The step's polynomial basis: Legendre polynomials on [0, 1] and their Gauss nodes.

#[cfg(test)]
pub(crate) use super::polynomial::coefficients;
pub(crate) use super::polynomial::{Legendre, Nodal, Q, dot, legendre};
use super::vector::vectorized;
use gauss_quad::legendre::GaussLegendre;
use std::num::NonZeroUsize;
use std::sync::LazyLock;

/// Powers of time in a Taylor series over a terminal step.
pub(crate) const TAYLOR: usize = 24;
/// Powers of time in a Taylor series over a dyadic step, and about its middle: enough for [`SLOW`] rad.
pub(crate) const SERIES: usize = 42;
pub(crate) const HALF_SERIES: usize = 30;
/// A mode that turns by at most this much (rad) in a step is expanded in power series.
pub(crate) const SLOW: f64 = 6.0;
/// Nodes of the finer rule for integrals that `Q` nodes do not integrate exactly.
const FINE: usize = 20;

/// A matrix that acts on nodal values, stored by columns: `matrix[j][i]` is the effect of value `j` on value `i`.
pub(crate) type Matrix = [[f64; Q]; Q];

/// Constant matrices of the basis, computed once.
pub(crate) struct Basis {
    /// Gauss nodes on (0, 1).
    pub nodes: Nodal,
    /// Nodal values to Legendre coefficients, by columns, and the weights of the nodes, which are its first row.
    pub to_coefficients: Matrix,
    pub weights: Nodal,
    /// `restricted[i][n][m]`: `P_n` on [0, 1], seen on [0, c_i], in Legendre polynomials of that part.
    pub restricted: [Matrix; Q],
    /// `power[p][j][i]`: integral over [0, c_i] of `(c_i - s)^p / p!` times the nodal polynomial `j`.
    pub power: Vec<Matrix>,
    /// `power_end[p][j]`: the same over [0, 1].
    pub power_end: Vec<Nodal>,
    /// `about_middle[p]`: first `(c - 1/2)^p` for the nodes `c` of the second half, then its integral up to there, then
    /// the integrals over [0, 1] of `P_n(2s-1) (1/2 - s)^p` for the `n` of the parity of `p` (the others vanish).
    pub about_middle: Vec<[[f64; Q / 2]; 3]>,
    /// `within[t]`: a motion that turns by at most so much (rad) needs `t` terms of its power series.
    within: [f64; SERIES],
    /// `derivatives[k][n][i]`: `d^k/ds^k P_n(2s-1)` at node `i`.
    pub derivatives: [Matrix; Q],
    /// Nodal values to the integrals `-int P_n'(2s-1) xi ds`, by columns.
    pub work_from_nodes: Matrix,
    /// Derivative at the nodes of the polynomial through the start (first) and the nodes (rest, by columns).
    pub slope_from_start: Nodal,
    pub slope_from_nodes: Matrix,
    /// The finer rule on (0, 1): node and weight.
    pub fine: Vec<(f64, f64)>,
}

/// The basis, built at first use.
pub(crate) static BASIS: LazyLock<Basis> = LazyLock::new(Basis::new);

/// `1/n`.
pub(crate) const RECIPROCAL: [f64; SERIES + 2] = {
    let mut table = [f64::INFINITY; SERIES + 2];
    let mut n = 1;
    while n < SERIES + 2 {
        table[n] = 1.0 / n as f64;
        n += 1;
    }
    table
};

/// Leaves out powers of time whose coefficients are beyond the range of numbers. Vibrations so fast are expanded over so short a time
/// that these powers do not matter.
pub(crate) fn leave_out_infinite(series: &mut [f64; TAYLOR]) {
    for value in series.iter_mut().filter(|value| !value.is_finite()) {
        *value = 0.0;
    }
}

/// Adds a multiple of a short vector.
pub(crate) fn add(to: &mut Nodal, factor: f64, from: &Nodal) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to += factor * from);
}

/// Adds to `sum` the values that some modes contribute by free motion: `psi (from_a a + from_b b)` of each, with its pair of vectors
/// in the table.
#[inline(always)]
pub(crate) fn add_motion(sum: &mut Nodal, table: &[(Nodal, Nodal)], psi: &[f64], (amplitude, rate): (&[f64], &[f64])) {
    for (((from_a, from_b), psi), (a, b)) in table.iter().zip(psi).zip(amplitude.iter().zip(rate)) {
        let (a, b) = (psi * a, psi * b);
        for n in 0..Q {
            sum[n] += from_a[n] * a + from_b[n] * b;
        }
    }
}

/// A matrix, kept by columns, times a vector.
#[inline(always)]
pub(crate) fn apply(matrix: &Matrix, vector: &Nodal) -> Nodal {
    let mut product = [0.0; Q];
    for j in 0..Q {
        for i in 0..Q {
            product[i] += matrix[j][i] * vector[j];
        }
    }
    product
}

/// Rates at the nodes of a polynomial on a step of `h`, by its values at the start and at the nodes.
#[inline(always)]
pub(crate) fn slopes(start: f64, nodal: &Nodal, h: f64) -> Nodal {
    let basis = &*BASIS;
    let from_nodes = apply(&basis.slope_from_nodes, nodal);
    std::array::from_fn(|i| (basis.slope_from_start[i] * start + from_nodes[i]) / h)
}

/// Work of unit Legendre forces over a motion on a panel, from its increase up to the nodes and up to the end: `int P_n d xi`, by
/// parts and by quadrature, which is exact for a motion of degree 9.
#[inline(always)]
pub(crate) fn work_of_unit_forces(moved: &Nodal, moved_at_end: f64) -> Nodal {
    let mut work = apply(&BASIS.work_from_nodes, moved);
    work.iter_mut().for_each(|work| *work += moved_at_end);
    work
}

impl Legendre {
    /// The polynomial with these values at the nodes.
    pub fn through(nodal: &Nodal) -> Legendre {
        let to_coefficients = &BASIS.to_coefficients;
        Legendre(vectorized(
            #[inline(always)]
            || apply(to_coefficients, nodal),
        ))
    }

    /// Its values at the nodes.
    pub fn nodal(&self) -> Nodal {
        BASIS.nodes.map(|s| self.at(s))
    }

    /// The same polynomial on [0, `part`], where that is scaled to [0, 1].
    pub fn restricted(&self, part: f64) -> Legendre {
        Legendre::through(&BASIS.nodes.map(|s| self.at(s * part)))
    }
}

/// A Gauss-Legendre rule on (0, 1).
pub(crate) fn rule(n: NonZeroUsize) -> Vec<(f64, f64)> {
    let mut rule: Vec<(f64, f64)> = GaussLegendre::new(n).iter().map(|(x, w)| (0.5 * (1.0 + x), 0.5 * w)).collect();
    rule.sort_by(|a, b| a.0.total_cmp(&b.0));
    rule
}

impl Basis {
    fn new() -> Basis {
        let gauss = rule(const { NonZeroUsize::new(Q).unwrap() });
        let fine = rule(const { NonZeroUsize::new(FINE).unwrap() });
        let mut nodes = [0.0; Q];
        let mut to_coefficients = [[0.0; Q]; Q];
        for (j, &(x, w)) in gauss.iter().enumerate() {
            nodes[j] = x;
            for (n, value) in legendre(x).into_iter().enumerate() {
                to_coefficients[j][n] = (2 * n + 1) as f64 * w * value;
            }
        }

        let mut restricted = [[[0.0; Q]; Q]; Q];
        for i in 0..Q {
            for &(x, w) in &gauss {
                let (part, whole) = (legendre(x), legendre(nodes[i] * x));
                for n in 0..Q {
                    for m in 0..Q {
                        restricted[i][n][m] += (2 * m + 1) as f64 * w * part[m] * whole[n];
                    }
                }
            }
        }

        // nodal polynomial j at s is sum_n to_coefficients[j][n] P_n(s)
        let nodal = |s: f64| {
            let p = legendre(s);
            let mut values = [0.0; Q];
            for j in 0..Q {
                for n in 0..Q {
                    values[j] += to_coefficients[j][n] * p[n];
                }
            }
            values
        };
        let moments = |end: f64| {
            let mut table = vec![[0.0; Q]; SERIES];
            for &(x, w) in &fine {
                let values = nodal(end * x);
                let mut kernel = w * end;
                for (p, row) in table.iter_mut().enumerate() {
                    if p > 0 {
                        kernel *= end * (1.0 - x) / p as f64;
                    }
                    for j in 0..Q {
                        row[j] += kernel * values[j];
                    }
                }
            }
            table
        };
        let mut power = vec![[[0.0; Q]; Q]; SERIES];
        for i in 0..Q {
            for (p, row) in moments(nodes[i]).into_iter().enumerate() {
                for j in 0..Q {
                    power[p][j][i] = row[j];
                }
            }
        }
        let mut power_end = moments(1.0);
        power_end.truncate(TAYLOR);

        let about: Vec<_> = fine.iter().map(|&(x, w)| (0.5 - x, w, legendre(x))).collect();
        let mut about_middle = vec![[[0.0; Q / 2]; 3]; HALF_SERIES];
        for (p, [powers, from_middle, integrals]) in about_middle.iter_mut().enumerate() {
            for m in 0..Q / 2 {
                powers[m] = (nodes[Q / 2 + m] - 0.5).powi(p as i32);
                from_middle[m] = powers[m] * (nodes[Q / 2 + m] - 0.5) / (p + 1) as f64;
                integrals[m] = about.iter().map(|(x, w, values)| w * x.powi(p as i32) * values[2 * m + p % 2]).sum();
            }
        }
        // the response to a unit velocity goes as angle^(p-1) / p!
        let mut within = [0.0; SERIES];
        let mut factorial = 1.0;
        for t in 2..SERIES {
            factorial *= t as f64;
            within[t] = (1e-17 * factorial).powf(1.0 / (t - 1) as f64);
        }
        let mut derivatives = [[[0.0; Q]; Q]; Q];
        for n in 0..Q {
            let mut polynomial = Legendre([0.0; Q]);
            polynomial.0[n] = 1.0;
            for k in 0..Q {
                for i in 0..Q {
                    derivatives[k][n][i] = polynomial.at(nodes[i]);
                }
                polynomial = polynomial.derivative();
            }
        }

        let mut work_from_nodes = [[0.0; Q]; Q];
        for i in 0..Q {
            for n in 0..Q {
                work_from_nodes[i][n] = -gauss[i].1 * derivatives[1][n][i];
            }
        }

        let slopes = |at: f64| derivative_weights(&nodes, at);
        let mut slope_from_start = [0.0; Q];
        let mut slope_from_nodes = [[0.0; Q]; Q];
        for i in 0..Q {
            let from_nodes;
            (slope_from_start[i], from_nodes) = slopes(nodes[i]);
            for j in 0..Q {
                slope_from_nodes[j][i] = from_nodes[j];
            }
        }
        Basis {
            nodes,
            weights: std::array::from_fn(|j| to_coefficients[j][0]),
            to_coefficients,
            restricted,
            power,
            power_end,
            about_middle,
            within,
            derivatives,
            work_from_nodes,
            slope_from_start,
            slope_from_nodes,
            fine,
        }
    }

    /// How many terms of its power series, of `MOST`, a motion that turns by `angle` (rad) needs to be exact to
    /// rounding. `known` is a number that is not enough or just enough, as it is for a slower motion.
    pub fn terms<const MOST: usize>(&self, angle: f64, known: usize) -> usize {
        let mut terms = known;
        while terms < MOST.min(SERIES) && self.within[terms] < angle {
            terms += 1;
        }
        terms
    }
}

/// Weights of the derivative at `at` of the polynomial through 0 and the nodes.
fn derivative_weights(nodes: &Nodal, at: f64) -> (f64, Nodal) {
    let mut points = vec![0.0];
    points.extend_from_slice(nodes);
    let weight = |j: usize| {
        // derivative of the Lagrange polynomial j: sum over the factor that is differentiated
        let mut sum = 0.0;
        for m in (0..points.len()).filter(|&m| m != j) {
            let mut product = 1.0 / (points[j] - points[m]);
            for l in (0..points.len()).filter(|&l| l != j && l != m) {
                product *= (at - points[l]) / (points[j] - points[l]);
            }
            sum += product;
        }
        sum
    };
    let mut weights = [0.0; Q];
    for (i, w) in weights.iter_mut().enumerate() {
        *w = weight(i + 1);
    }
    (weight(0), weights)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_constant_matrices_are_exact_on_polynomials() {
        let basis = &*BASIS;
        // f(s) = s^3: slopes differentiate it, powers integrate it
        let cube: Nodal = basis.nodes.map(|c| c.powi(3));
        for i in 0..Q {
            let slope = apply(&basis.slope_from_nodes, &cube)[i];
            assert!((slope - 3.0 * basis.nodes[i].powi(2)).abs() < 1e-11);
            // int_0^c (c-s)^2/2 s^3 ds = c^6/120
            let integral = apply(&basis.power[2], &cube)[i];
            assert!((integral - basis.nodes[i].powi(6) / 120.0).abs() < 1e-15);
            // P_3 on [0, c_i] in polynomials of the part
            let (at, mut sum) = (0.3, 0.0);
            for (m, p) in legendre(at).into_iter().enumerate() {
                sum += basis.restricted[i][3][m] * p;
            }
            assert!((sum - legendre(at * basis.nodes[i])[3]).abs() < 1e-13);
        }
    }

    /// `s^3`.
    fn cube() -> Legendre {
        Legendre::through(&BASIS.nodes.map(|s| s.powi(3)))
    }

    #[test]
    fn values_derivatives_and_parts_are_those_of_the_polynomial() {
        let places = BASIS.nodes.map(|s| 1.2 * s);
        for (s, beyond) in places.into_iter().zip(cube().at_each(&places)) {
            assert!((beyond - cube().at(s)).abs() < 1e-14);
        }
        for s in [0.0, 0.2, 0.37, 0.9, 1.0] {
            assert!((cube().at(s) - s.powi(3)).abs() < 1e-14);
            assert!((cube().derivative().at(s) - 3.0 * s * s).abs() < 1e-12);
            assert!((cube().restricted(0.3).at(s) - (0.3 * s).powi(3)).abs() < 1e-14);
        }
        assert!((cube().mean() - 0.25).abs() < 1e-15);
        assert!(cube().nodal().iter().zip(BASIS.nodes).all(|(value, s)| (value - s.powi(3)).abs() < 1e-14));
    }

    #[test]
    fn the_maximum_is_found_inside_and_at_either_end() {
        let (place, value) = Legendre::through(&BASIS.nodes.map(|s| s * (1.4 - s))).maximum();
        assert!((place - 0.7).abs() < 1e-12 && (value - 0.49).abs() < 1e-15);
        assert_eq!(cube().maximum().0, 1.0);
        assert_eq!(Legendre::through(&BASIS.nodes.map(|s| -s)).maximum().0, 0.0);
        assert_eq!(Legendre([0.0; Q]).maximum(), (0.0, 0.0));
    }
}
