//! Fractional integrals and derivatives of functions and of samples.
//!
//! `I^a f(t) = 1/Gamma(a) int_0^t (t-s)^(a-1) f(s) ds`; the Caputo derivative of order `a`, `n-1 < a <= n`, is
//! `I^(n-a) f^(n)`, the Riemann-Liouville derivative is `(I^(n-a) f)^(n)`, and the two differ by
//! `sum over k < n of f^(k)(0) t^(k-a) / Gamma(k+1-a)`.

mod function;
mod sampled;

pub use function::{Estimate, Quadrature, caputo, integral, riemann_liouville};
pub use sampled::{caputo_sampled, grunwald_letnikov, integral_sampled, riemann_liouville_sampled};

use invalid_input::InvalidInput;
use libm::tgamma;

/// Largest order of a derivative or integral here.
const LARGEST_ORDER: f64 = 16.0;

fn require_order(order: f64) -> Result<f64, InvalidInput> {
    let ok = order > 0.0 && order <= LARGEST_ORDER;
    InvalidInput::unless(ok, "order", order, "a number greater than 0 and not greater than 16").map(|()| order)
}

/// The Riemann-Liouville derivative minus the Caputo derivative, from the derivatives at the start.
///
/// At `t = 0` a term with negative exponent is infinite unless its derivative is 0.
fn start_terms(order: f64, initial: &[f64], t: f64) -> f64 {
    let term = |(k, &value): (usize, &f64)| {
        let gamma = tgamma(k as f64 + 1.0 - order);
        // 1/Gamma vanishes at the poles, so integer orders have no such terms.
        if value == 0.0 || !gamma.is_finite() { 0.0 } else { value * t.powf(k as f64 - order) / gamma }
    };
    initial.iter().enumerate().map(term).sum()
}
