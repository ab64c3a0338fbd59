//! Rounding floors: overlaps and rates below them count as zero, because no shorter panel makes them more certain.
//!
//! An overlap is a sum `sum_k psi_k a_k` over the modes. The rounding of its terms is relative to each of them and not to the sum, in
//! which they nearly cancel, so its floor is `4 eps sum_k |psi_k a_k|`. A closed contact adds up the increases of its overlap, whose
//! terms are smaller: within `h` free motion takes a mode no farther than `min(omega h, 1) |a| + h |b|`. Vibrations turn
//! displacement into rate, so the terms of a rate anywhere on a panel are `omega |a| + |b|`.

use super::motion::March;
use crate::panel::legendre::Nodal;

/// Rounding of a sum relative to the sum of the sizes of its terms.
const RELATIVE: f64 = 4.0 * f64::EPSILON;

/// Interpolation of a rate from the increases of an overlap up to the nodes, as for event functions, magnifies their rounding so many
/// times.
pub(super) const MAGNIFIED: f64 = 50.0;

/// Rounding of a force that is continued from the nodes to the end of a panel, and of its last coefficients, relative to the largest of
/// its values. It was measured as 19 times the rounding of one number.
const OF_FORCE: f64 = 32.0 * f64::EPSILON;

/// An error of a force with these nodal values (N), or zero where it may be their rounding. The tolerance refers to the momentum of a
/// contact; a load that presses much longer than the contact deforms gives an impulse of which the rounding alone is larger.
pub(super) fn above_rounding(error_n: f64, force: &Nodal) -> f64 {
    let largest_n = force.iter().fold(0.0f64, |most, force| most.max(force.abs()));
    if error_n <= OF_FORCE * largest_n { 0.0 } else { error_n }
}

impl<'a> March<'a> {
    /// Of an overlap that is computed as a difference of positions (m).
    pub(super) fn overlap_rounding(&self, c: usize) -> f64 {
        RELATIVE * (self.system.links[c].size(&self.amplitude) + self.states[c].reference.abs())
    }

    /// Of its rate (m/s).
    pub(super) fn rate_rounding(&self, c: usize) -> f64 {
        RELATIVE * self.system.links[c].size(&self.rate)
    }

    /// Of an overlap as it is summed up over a panel of `h`, and of its increase alone (m).
    pub(super) fn rounding_on_panel(&self, c: usize, h: f64) -> (f64, f64) {
        let moved = self.sums(
            c,
            #[inline(always)]
            |[psi, omega, a, b]| {
                let turned = omega * h;
                [psi.abs() * ((if turned < 1.0 { turned } else { 1.0 }) * a.abs() + h * b.abs())]
            },
        );
        let moved: f64 = moved.map(|[sum]| sum).sum();
        let tracked = if self.states[c].is_closed() { 0.0 } else { self.overlap_rounding(c) };
        // the relative accuracy of the motion that corresponds to the contact's momentum is the same
        let increase = RELATIVE * moved.max(self.states[c].speed_m_s() * h);
        (tracked + increase + RELATIVE * self.states[c].overlap.abs(), increase)
    }

    /// Of the rate of an overlap anywhere on a panel (m/s).
    pub(super) fn rate_rounding_on_panel(&self, c: usize) -> f64 {
        let moving = self.sums(
            c,
            #[inline(always)]
            |[psi, omega, a, b]| [psi.abs() * (omega * a.abs() + b.abs())],
        );
        let moving: f64 = moving.map(|[sum]| sum).sum();
        RELATIVE * moving.max(self.states[c].speed_m_s())
    }
}
