//! A quantity on a panel from its values at the nodes and at both ends.

use super::legendre::{Legendre, Nodal, Q};
use super::polynomial::{legendre, next_legendre};

/// The polynomial of degree `Q + 1` through the nodes and both ends: that through the nodes, and a line times `P_Q(2s-1)`, which is
/// zero at all nodes and, as `Q` is even, one at both ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Interpolant {
    nodal: Nodal,
    ends: [f64; 2],
}

/// The same in a form to be evaluated.
pub(crate) struct Evaluable {
    through: Legendre,
    slope: Legendre,
    /// What the polynomial through the nodes misses at the start, and its increase up to the end.
    missed: [f64; 2],
}

/// `d/ds P_Q(2s-1)` is `2 (2m+1) P_m` summed over `m = Q-1, Q-3, ..`.
const LAST_SLOPE: Legendre = {
    let mut slope = [0.0; Q];
    let mut m = (Q - 1) % 2;
    while m < Q {
        slope[m] = 2.0 * (2 * m + 1) as f64;
        m += 2;
    }
    Legendre(slope)
};

impl Interpolant {
    pub fn new(nodal: &Nodal, ends: [f64; 2]) -> Interpolant {
        Interpolant { nodal: *nodal, ends }
    }

    pub fn evaluable(&self) -> Evaluable {
        let through = Legendre::through(&self.nodal);
        let [start, end] = through.at_ends();
        let missed = [self.ends[0] - start, self.ends[1] - end];
        Evaluable { slope: through.derivative(), through, missed: [missed[0], missed[1] - missed[0]] }
    }
}

impl Evaluable {
    /// Its value and its slope at a place.
    pub fn at(&self, s: f64) -> [f64; 2] {
        let p = legendre(s);
        let (last, last_slope) = (next_legendre(s, &p), LAST_SLOPE.at(s));
        let line = self.missed[0] + s * self.missed[1];
        [self.through.at(s) + last * line, self.slope.at(s) + last_slope * line + last * self.missed[1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::legendre::BASIS;

    #[test]
    fn a_polynomial_of_degree_nine_is_met_everywhere_with_its_slope() {
        let of = |s: f64| 2.0 - s + 3.0 * s.powi(4) - s.powi(9);
        let slope = |s: f64| -1.0 + 12.0 * s.powi(3) - 9.0 * s.powi(8);
        let found = Interpolant::new(&BASIS.nodes.map(of), [of(0.0), of(1.0)]).evaluable();
        for s in [0.0, 0.03, 0.4, 0.77, 1.0] {
            let [value, rises] = found.at(s);
            assert!((value - of(s)).abs() < 1e-14 && (rises - slope(s)).abs() < 1e-12, "{s}: {value} {rises}");
        }
    }
}
