//! The methods on equal steps, which differ in their weights.

use super::weights::{self, Weights};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scheme {
    GrunwaldLetnikov,
    L1,
    Trapezoidal,
}

impl Scheme {
    pub(super) fn weights(self, order: f64, steps: usize, exponents: &[f64]) -> Weights {
        match self {
            Scheme::GrunwaldLetnikov => weights::grunwald_letnikov(order, steps),
            Scheme::L1 => weights::l1(order, steps),
            Scheme::Trapezoidal => {
                let mut weights = weights::trapezoidal(order, steps);
                if exponents.len() > 2 {
                    weights::add_corrections(&mut weights, order, exponents);
                }
                weights
            }
        }
    }

    /// Corrections for the singular start of a past segment; methods of first order need none.
    pub(super) fn start_corrections(self, orders: &[f64]) -> Vec<f64> {
        let exponents = weights::start_exponents(orders);
        let wanted = self == Scheme::Trapezoidal && exponents.len() > 2;
        if wanted { weights::start_corrections(&exponents) } else { Vec::new() }
    }

    /// Degree of the interpolation between grid points, one more than the order requires.
    pub(super) fn degree(self) -> usize {
        if self == Scheme::Trapezoidal { 3 } else { 1 }
    }
}
