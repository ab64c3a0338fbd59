//! The Galerkin recipe of Das and Chatterjee (2013): internal states for a fractional derivative (thesis A.1).
//!
//! `D^a x = 1/(Gamma(1-a) Gamma(1+a)) int_0^inf u(xi, t) dxi`, where `du/dt + xi^(1/a) u = dx/dt` for every `xi > 0`,
//! since the integral of `exp(-xi^(1/a) t)` over `xi` is `Gamma(1+a)/t^a`. A Galerkin projection of `u` on hat
//! functions in `eta = r/(1+r)`, `r = xi^(1/a)`, with breakpoints at `xi = 10^beta1 ... 10^beta2`, equally spaced in
//! `log xi`, gives the matrices of Eq. A.1.

use super::sum::ExponentialSum;
use crate::quadrature::Rule;
use invalid_input::InvalidInput;
use libm::tgamma;
use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};

/// Orders for which the recipe is computed.
pub(super) const ALPHA: std::ops::RangeInclusive<f64> = 0.05..=0.95;

/// The matrices of `A da/dt + B a = c d^n x/dt^n`, `D^alpha x = c^T a` (thesis Eq. A.1), `n - 1 < alpha < n`.
///
/// ```
/// use fracdiff::DasChatterjee;
/// let recipe = DasChatterjee::new(0.5, 50, -2.4, 1.2)?;
/// assert_eq!(recipe.c.len(), 50);
/// assert_eq!(recipe.a.len(), 50 * 50);
/// # Ok::<(), fracdiff::InvalidInput>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct DasChatterjee {
    /// `N x N`, symmetric and positive definite, row-major.
    pub a: Vec<f64>,
    /// `N x N`, symmetric and positive definite, row-major.
    pub b: Vec<f64>,
    /// `N` values.
    pub c: Vec<f64>,
}

impl DasChatterjee {
    /// Matrices for the order `alpha` between 0 and 1 (the fractional part of a higher order), `states` internal
    /// states and breakpoints from `xi = 10^beta1` to `10^beta2`, that is decay rates `xi^(1/alpha)`.
    ///
    /// # Errors
    ///
    /// [`InvalidInput`] unless `0.05 <= alpha <= 0.95`, `3 <= states <= 500`, `-12 <= beta1 < beta2 <= 12`.
    pub fn new(alpha: f64, states: usize, beta1: f64, beta2: f64) -> Result<DasChatterjee, InvalidInput> {
        InvalidInput::unless(ALPHA.contains(&alpha), "alpha", alpha, "a number from 0.05 to 0.95")?;
        InvalidInput::unless((3..=500).contains(&states), "states", states, "a number from 3 to 500")?;
        InvalidInput::unless((-12.0..=12.0).contains(&beta1), "beta1", beta1, "a number from -12 to 12")?;
        let beta2_ok = beta2 > beta1 && beta2 <= 12.0;
        InvalidInput::unless(beta2_ok, "beta2", beta2, "a number greater than beta1 and not greater than 12")?;
        Ok(Assembly::new(alpha, states).assemble(beta1, beta2))
    }

    /// The kernel `t^(-alpha)/Gamma(1-alpha)` that the matrices approximate, `c^T exp(-A^-1 B t) A^-1 c`, diagonalised. `None`
    /// if rounding has made `A` indefinite.
    pub fn kernel(&self) -> Option<ExponentialSum> {
        let n = self.c.len();
        let factor = Cholesky::new(DMatrix::from_row_slice(n, n, &self.a))?.unpack();
        let half = factor.solve_lower_triangular(&DMatrix::from_row_slice(n, n, &self.b))?;
        let whole = factor.solve_lower_triangular(&half.transpose())?;
        let symmetric = 0.5 * (&whole + whole.transpose());
        let c = factor.solve_lower_triangular(&DVector::from_column_slice(&self.c))?;
        let eigen = SymmetricEigen::try_new(symmetric, f64::EPSILON, 0)?;
        let projected = eigen.eigenvectors.transpose() * c;
        Some(ExponentialSum {
            // Rounding is relative to the largest rate; a slow state must not grow.
            rates: eigen.eigenvalues.iter().map(|r| r.max(0.0)).collect(),
            weights: projected.iter().map(|p| p * p).collect(),
        })
    }
}

/// Integration element by element; hat functions are linear in `eta`, and the measure is `dxi = alpha r^(alpha-1) dr`.
struct Assembly {
    alpha: f64,
    states: usize,
    a: Vec<f64>,
    b: Vec<f64>,
    c: Vec<f64>,
}

impl Assembly {
    fn new(alpha: f64, states: usize) -> Assembly {
        let (a, b) = (vec![0.0; states * states], vec![0.0; states * states]);
        Assembly { alpha, states, a, b, c: vec![0.0; states] }
    }

    /// Adds one quadrature point with the rate `r`, the measure `dxi`, and the two hat functions `(index, value)` that are
    /// nonzero there.
    fn add(&mut self, r: f64, dxi: f64, hats: [(usize, f64); 2]) {
        for (i, p) in hats {
            self.c[i] += dxi * p;
            for (j, q) in hats {
                self.a[i * self.states + j] += dxi * p * q;
                self.b[i * self.states + j] += dxi * p * q * r;
            }
        }
    }

    fn assemble(mut self, beta1: f64, beta2: f64) -> DasChatterjee {
        let (alpha, last) = (self.alpha, self.states - 1);
        let log_rate = |i: usize| {
            let log_xi = beta1 + (beta2 - beta1) * i as f64 / last as f64;
            log_xi * std::f64::consts::LN_10 / alpha
        };
        // First element, eta from 0 to eta_1: the first hat is 1. With r = xi^(1/alpha) and the substitution r = r_1 u, the
        // integrands are smooth apart from the weight u^(alpha-1).
        let r1 = log_rate(0).exp();
        let rule = Rule::jacobi(8, alpha);
        for (&u, &w) in rule.nodes.iter().zip(&rule.weights) {
            self.add(r1 * u, w * r1.powf(alpha), [(0, 1.0), (0, 0.0)]);
        }
        // Inner elements, in log r.
        let rule = Rule::legendre(24);
        for i in 0..last {
            let (low, high) = (log_rate(i), log_rate(i + 1));
            for (&u, &w) in rule.nodes.iter().zip(&rule.weights) {
                let log_r = low + (high - low) * u;
                let r = log_r.exp();
                let rise = eta_difference(low, log_r) / eta_difference(low, high);
                let dxi = alpha * r.powf(alpha) * (high - low) * w;
                self.add(r, dxi, [(i, 1.0 - rise), (i + 1, rise)]);
            }
        }
        // Last element: the last hat falls linearly to 0 at eta = 1, so it is (1 + r_N)/(1 + r). In v = r_N/r the
        // measure is alpha r_N^alpha v^(-alpha-1) dv; the factor 1/(1+r) ~ v leaves the weight v^(-alpha).
        let rn = log_rate(last).exp();
        let rule = Rule::jacobi(24, 1.0 - alpha);
        for (&v, &w) in rule.nodes.iter().zip(&rule.weights) {
            let r = rn / v;
            let hat = (1.0 + rn) / (1.0 + r);
            self.add(r, alpha / (1.0 - alpha) * rn.powf(alpha) * w / v, [(last, hat), (last, 0.0)]);
        }
        // D^alpha x has the factor 1/(Gamma(1-alpha) Gamma(1+alpha)), shared by the two c.
        let share = 1.0 / (tgamma(1.0 - alpha) * tgamma(1.0 + alpha)).sqrt();
        self.c.iter_mut().for_each(|c| *c *= share);
        DasChatterjee { a: self.a, b: self.b, c: self.c }
    }
}

/// `eta(s) - eta(p)` for logarithms of rates, `eta = r/(1+r)`.
fn eta_difference(p: f64, s: f64) -> f64 {
    // r_s/(1+r_s) - r_p/(1+r_p) = (r_s - r_p)/((1+r_s)(1+r_p)), the numerator by expm1
    p.exp() * (s - p).exp_m1() / ((1.0 + s.exp()) * (1.0 + p.exp()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernel_of_the_thesis_settings_is_a_power_in_its_band() {
        let sum = DasChatterjee::new(0.5, 50, -2.4, 1.2).unwrap().kernel().unwrap();
        let mut worst: f64 = 0.0;
        for i in 0..=60 {
            let t = 10f64.powf(-1.5 + 0.075 * f64::from(i));
            let exact = 1.0 / (tgamma(0.5) * t.sqrt());
            worst = worst.max((sum.evaluate(t) / exact - 1.0).abs());
        }
        println!("worst {worst}");
        assert!(worst < 1e-3);
    }

    #[test]
    fn more_states_and_a_wider_band_do_better() {
        let error = |states: usize, beta: f64| {
            let sum = DasChatterjee::new(0.5, states, -beta, beta).unwrap().kernel().unwrap();
            (0..=30)
                .map(|i| 10f64.powf(-1.5 + 0.1 * f64::from(i)))
                .map(|t| (sum.evaluate(t) * tgamma(0.5) * t.sqrt() - 1.0).abs())
                .fold(0.0, f64::max)
        };
        let errors = [error(12, 1.5), error(24, 2.0), error(48, 2.5), error(96, 3.0)];
        println!("{errors:?}");
        assert!(errors.windows(2).all(|e| e[1] < 0.5 * e[0]), "{errors:?}");
    }

    #[test]
    fn bad_input_is_refused() {
        assert!(DasChatterjee::new(1.0, 50, -2.0, 2.0).is_err());
        assert!(DasChatterjee::new(0.5, 2, -2.0, 2.0).is_err());
        assert!(DasChatterjee::new(0.5, 50, 2.0, -2.0).is_err());
        assert!(DasChatterjee::new(0.5, 50, f64::NAN, 2.0).is_err());
    }
}
