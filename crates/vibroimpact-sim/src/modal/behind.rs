//! Behind a residual compliance: what the gap between the bodies makes of the contact itself.
//!
//! The gap is the compression and what the compliance yields, `g = xi + c F(xi, xi')`. Where the compliance is soft
//! against the contact nearly all of the gap is `c F`, and a small error of the force, as a polynomial makes it beyond its
//! nodes, is a large one of the compression: at the end of a step the law itself is solved. Where the force depends on
//! the rate, the contact lags behind the gap by `c F_rate / (1 + c F_xi)`, in steps shorter than which the compression is
//! a state of its own, carried on by the polynomial through its nodes.

use super::landing::end_slope;
use super::legendre::{BASIS, Nodal, evaluate};
use super::step::Collocated;
use contact_models::{Boundary, Branch, ContactLaw};

/// Newton's method on a convex function: a third of the way at least in each iteration.
const ITERATIONS_MAX: usize = 60;

/// A branch of a law behind a compliance.
pub(crate) struct Behind<'a, L> {
    pub law: &'a L,
    pub branch: &'a Branch,
    /// The residual compliance `c` (m/N).
    pub compliance: f64,
}

impl<L: ContactLaw> Behind<'_, L> {
    /// Compression and its rate at the end of a step of `h`, of which the gap and its rate there are known.
    pub fn end_of_step(
        &self,
        (gap, gap_rate): (f64, f64),
        start_compression: f64,
        step: &Collocated,
        force: &Nodal,
        h: f64,
    ) -> (f64, f64) {
        if self.compliance == 0.0 {
            return (gap, gap_rate);
        }
        let estimate = gap - self.compliance * evaluate(force, 1.0);
        if self.law.depends_on_rate() {
            let rate = end_slope(start_compression, &step.compression, h);
            if self.lags(estimate, rate, h) {
                return (end_value(start_compression, &step.compression), rate);
            }
            return (self.compression(gap, estimate, rate), rate);
        }
        let compression = self.compression(gap, estimate, 0.0);
        let stiffness = self.law.force(self.branch, compression, 0.0).per_compression_n_m;
        (compression, gap_rate / (1.0 + self.compliance * stiffness))
    }

    /// Whether the contact lags behind the gap so far that an error of the compression at the start of a step of `h`, which
    /// is one of the rate at its end, would make a larger one of the compression that the law gives with that rate.
    pub fn lags(&self, compression: f64, rate: f64, h: f64) -> bool {
        let force = self.law.force(self.branch, compression, rate);
        let lag = self.compliance * force.per_rate_n_s_m / (1.0 + self.compliance * force.per_compression_n_m);
        lag * BASIS.end_slope_from_start.abs() > h
    }

    /// The compression at which `xi + c F(xi, xi') = g`, near an estimate.
    pub fn compression(&self, gap: f64, estimate: f64, rate: f64) -> f64 {
        let mut compression = estimate;
        for _ in 0..ITERATIONS_MAX {
            let force = self.law.force(self.branch, compression, rate);
            let excess = compression + self.compliance * force.force_n - gap;
            let next = compression - excess / (1.0 + self.compliance * force.per_compression_n_m);
            if !next.is_finite() || (next - compression).abs() <= 1e-15 * next.abs() {
                break;
            }
            compression = next;
        }
        compression
    }

    /// Distance to a boundary of the branch, positive inside, and how fast it changes, which behind a compliance is not
    /// known (0) at the boundaries of a rate; `gap` is the gap with its first two derivatives. A boundary in the compression alone is one in the gap, where the law does not depend on the
    /// rate, and the gap is smooth where the compression is not: `g^(2/3)` at a separation.
    pub fn margin(&self, boundary: &Boundary, gap: [f64; 3], (compression, rate): (f64, f64)) -> (f64, f64) {
        if self.compliance == 0.0 {
            let slope = boundary.per_compression * gap[1] + boundary.per_rate * gap[2];
            return (boundary.margin(compression, rate), slope);
        }
        if boundary.per_rate != 0.0 {
            return (boundary.margin(compression, rate), 0.0);
        }
        if self.law.depends_on_rate() {
            return (boundary.margin(compression, rate), boundary.per_compression * rate);
        }
        let met = boundary.level / boundary.per_compression;
        let yielded = self.compliance * self.law.force(self.branch, met, 0.0).force_n;
        (boundary.margin(gap[0] - yielded, 0.0), boundary.per_compression * gap[1])
    }
}

/// Value at the end of a step of the polynomial with these values at its start and at the nodes. To the polynomial through
/// the nodes alone it adds a multiple of the Legendre polynomial that vanishes there, and is 1 at both ends.
fn end_value(start: f64, nodal: &Nodal) -> f64 {
    let coefficients = BASIS.coefficients(nodal);
    start + (evaluate(&coefficients, 1.0) - evaluate(&coefficients, 0.0))
}
