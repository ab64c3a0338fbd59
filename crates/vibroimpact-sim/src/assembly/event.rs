//! Event location: where on a panel with closed contacts an event function first falls to zero. No other file decides this; in
//! flight `enclosure.rs` finds the first closing.
//!
//! An event function `m` is positive inside a branch. It is the distance to a boundary of the law, or between two separated
//! surfaces. On a panel it is represented by the polynomial through the start and the nodes, with an error of at most `rho`
//! ([`super::enclosure`]) and rounding. In Bernstein's form a polynomial lies within the range of its coefficients. This proves
//! that a panel has no event, or subdivision leads to the first zero: to a part of the panel where the coefficients decrease.
//! There the polynomial decreases too and has exactly one zero.
//!
//! A branch may begin on its boundary, where `m(0) = 0` to rounding. The polynomial `(m(s) - m(0))/s` is then tested in place of
//! `m`; its value at `s = 0` is the slope of `m`, known from the rate of the overlap and its acceleration. If the slope is zero
//! too, as for a branch that begins at a turning point, `(m(s) - m(0) - s m'(0))/s^2` is tested. If the tested function is
//! negative before it was ever positive, the branch ends where it begins. A function that begins above rounding, but within the
//! residue of the transition before, is first tested itself: it may fall without becoming zero.
//!
//! A start without slope depends on the sign of a small number. Whether surfaces that touch without speed and without force
//! separate or press each other follows from the forces of other contacts. These forces are polynomials with a truncation error
//! `e`, which leaves the second derivative of the overlap uncertain by `sum_c' W_cc' e_c'`, where `W` is the inverse mass of an
//! impulse of `c'` at the contact. A shorter panel does not help, because the relative truncation error of a force that begins like
//! a power of time is the same on every panel. This uncertainty is treated like rounding: an event function within it counts as
//! zero. The force that the contact may have meanwhile is smaller than these errors by the square of the panel times the frequency
//! of the contact.

use crate::panel::legendre::{BASIS, Nodal, Q};
use std::sync::LazyLock;

/// Points of a panel: its start and the nodes.
const POINTS: usize = Q + 1;

/// An event function on a panel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EventFunction {
    /// Its value at the start of the panel.
    pub start: f64,
    pub nodal: Nodal,
    /// Bounds on the error of the polynomial, of its slope along the panel (panel length 1), and of its second derivative.
    pub rho: [f64; 3],
    /// Rounding of its values.
    pub rounding: f64,
    /// Bounds on the deviation of value and slope from zero at the beginning of the branch.
    pub residue: f64,
    pub slope_residue: f64,
}

/// Result of testing an event function on a panel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Verdict {
    /// The function stays positive.
    Clear,
    /// The panel is too long for a decision.
    Doubtful,
    /// The function falls to zero at this part of the panel.
    Meets(f64),
}

/// An event function at the start of a panel (panel length 1).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Beginning {
    pub slope: f64,
    /// The slope of that, where it is known.
    pub bend: Option<f64>,
    /// Bound on its second derivative by the truncation of the forces.
    pub unresolved: f64,
}

impl EventFunction {
    /// `beginning` is evaluated only if the function begins at zero.
    pub fn verdict(&self, beginning: impl FnOnce() -> Beginning) -> Verdict {
        // the polynomial passes through the start, where the only error is rounding
        let known = self.rounding + self.residue;
        if self.start < -known {
            return Verdict::Meets(0.0);
        }
        if self.start > self.rounding {
            let verdict = Tested::new(&with(self.start, &self.nodal), self.rho[0], self.rounding, false).verdict();
            // a function that does not begin at zero need not end where it begins, though it may be small and fall
            let apart = verdict == Verdict::Clear || matches!(verdict, Verdict::Meets(place) if place > FINEST);
            if self.start > known || apart {
                return verdict;
            }
        }
        self.quotient(beginning).verdict()
    }

    /// Of a function that begins at zero, the quotient that has to stay positive.
    fn quotient(&self, beginning: impl FnOnce() -> Beginning) -> Tested {
        let [_, rho_slope, rho_bend] = self.rho;
        // rounding of a value is one of the slope from the start, largest at the first node
        let slopes: Nodal = std::array::from_fn(|i| (self.nodal[i] - self.start) / BASIS.nodes[i]);
        let rounding = 2.0 * self.rounding / BASIS.nodes[0] + self.slope_residue;
        let Beginning { slope, bend, unresolved } = beginning();
        let begins_level = slope.abs() <= self.rounding + self.slope_residue;
        match bend {
            // the slope at the start is better known than those that are quotients
            Some(bend) if begins_level => {
                let bends = std::array::from_fn(|i| (slopes[i] - slope) / BASIS.nodes[i]);
                let rounding = rounding / BASIS.nodes[0] + unresolved;
                Tested::new(&with(0.5 * bend, &bends), 0.5 * rho_bend, rounding, true)
            }
            None if begins_level => Tested::new(&with(slope, &slopes), rho_slope, rounding + unresolved, true),
            // a shorter panel resolves a slope that is not zero
            _ => Tested::new(&with(slope, &slopes), rho_slope + unresolved, rounding, true),
        }
    }
}

/// The values at all points of a panel.
fn with(start: f64, nodal: &Nodal) -> [f64; POINTS] {
    let mut values = [start; POINTS];
    values[1..].copy_from_slice(nodal);
    values
}

/// A polynomial that is tested for being positive.
struct Tested {
    bernstein: [f64; POINTS],
    /// Its error bound, and the part of the bound that a shorter panel would not reduce.
    slack: f64,
    rounding: f64,
    /// Treats the whole error bound as rounding.
    certain: bool,
    /// Whether the event function begins at zero; its value at the start is then known to rounding.
    from_zero: bool,
}

impl Tested {
    fn new(values: &[f64; POINTS], rho: f64, rounding: f64, from_zero: bool) -> Tested {
        let mut bernstein = [0.0; POINTS];
        for (column, value) in TO_BERNSTEIN.iter().zip(values) {
            for i in 0..POINTS {
                bernstein[i] += column[i] * value;
            }
        }
        Tested { bernstein, slack: rho + rounding, rounding, certain: rho <= rounding, from_zero }
    }

    fn verdict(&self) -> Verdict {
        let [first, .., last] = self.bernstein;
        if first > self.slack && last > self.slack && self.first_at_or_below(self.slack).is_none() {
            return Verdict::Clear;
        }
        if self.from_zero && first < -self.rounding {
            return Verdict::Meets(0.0);
        }
        match self.first_at_or_below(if self.certain { -self.slack } else { 0.0 }) {
            Some(place) if self.from_zero && !self.rises_before(place) => match self.certain {
                true => Verdict::Meets(0.0),
                false => Verdict::Doubtful,
            },
            Some(place) => Verdict::Meets(place),
            None if self.certain => Verdict::Clear,
            None => Verdict::Doubtful,
        }
    }

    /// Whether it exceeds the error bound before this place.
    fn rises_before(&self, place: f64) -> bool {
        let above = first_at_or_below(&self.bernstein.map(|b| -b), -self.slack, 0.0, 1.0);
        above.is_some_and(|above| above < place)
    }

    /// The first place at which it is at most `level`, to [`FINEST`].
    fn first_at_or_below(&self, level: f64) -> Option<f64> {
        first_at_or_below(&self.bernstein, level, 0.0, 1.0)
    }
}

/// Parts of a panel are halved down to this length.
const FINEST: f64 = 1.0 / 65536.0;

/// The first place at which the polynomial with these Bernstein coefficients on `[from, from + length]` is at most `level`.
fn first_at_or_below(b: &[f64; POINTS], level: f64, from: f64, length: f64) -> Option<f64> {
    if b.iter().all(|b| *b > level) {
        return None;
    }
    if b[0] <= level {
        return Some(from);
    }
    let half = 0.5 * length;
    if length <= FINEST {
        return Some(from + half);
    }
    if b.windows(2).all(|pair| pair[0] > pair[1]) && b[Q] < level {
        return Some((from + length * falls_to(b, level)).min(from + length - 0.5 * FINEST));
    }
    let (mut left, mut right) = ([0.0; POINTS], *b);
    for i in 0..POINTS {
        left[i] = right[0];
        for k in 0..POINTS - 1 - i {
            right[k] = 0.5 * (right[k] + right[k + 1]);
        }
    }
    first_at_or_below(&left, level, from, half).or_else(|| first_at_or_below(&right, level, from + half, half))
}

/// The place on (0, 1) where the polynomial with these decreasing Bernstein coefficients equals `level`, which lies between its
/// end values. The polynomial decreases throughout, so Newton's method within a bracket finds the result of subdivision.
fn falls_to(b: &[f64; POINTS], level: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    let mut place = (b[0] - level) / (b[0] - b[Q]);
    for _ in 0..60 {
        let value = bernstein(b, &BINOMIALS, place) - level;
        *(if value > 0.0 { &mut low } else { &mut high }) = place;
        let falls: Nodal = std::array::from_fn(|i| b[i + 1] - b[i]);
        let newton = place - value / (Q as f64 * bernstein(&falls, &BINOMIALS_BELOW, place));
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - place).abs() < NEAR {
            return next;
        }
        place = next;
    }
    place
}

/// Newton's steps below this change no part of a panel of length [`FINEST`].
const NEAR: f64 = 1e-9;

/// Coefficients of `(s + t)^Q` and of one power less.
const BINOMIALS: [f64; POINTS] = binomials();
const BINOMIALS_BELOW: Nodal = binomials();

const fn binomials<const N: usize>() -> [f64; N] {
    let mut row = [1.0; N];
    let mut i = 1;
    while i < N {
        row[i] = row[i - 1] * (N - i) as f64 / i as f64;
        i += 1;
    }
    row
}

/// The polynomial with these Bernstein coefficients at `t`.
fn bernstein<const N: usize>(b: &[f64; N], binomials: &[f64; N], t: f64) -> f64 {
    let rest = 1.0 - t;
    let (mut power, mut sum) = (1.0, 0.0);
    for i in 0..N {
        sum = sum * rest + binomials[i] * power * b[i];
        power *= t;
    }
    sum
}

/// Matrix from values at the start and the nodes to Bernstein coefficients, by columns: `[j][i]` is the effect of value `j` on
/// coefficient `i`.
static TO_BERNSTEIN: LazyLock<[[f64; POINTS]; POINTS]> = LazyLock::new(|| conversion(&with(0.0, &BASIS.nodes)));

/// Through these points: the Lagrange polynomials in Bernstein's form, each a product of linear factors, which are
/// multiplied in that form.
fn conversion(points: &[f64; POINTS]) -> [[f64; POINTS]; POINTS] {
    std::array::from_fn(|j| {
        let mut product = vec![1.0];
        for m in (0..POINTS).filter(|&m| m != j) {
            let scale = 1.0 / (points[j] - points[m]);
            // the factor (s - points[m]) scale, at either end
            let (low, high) = (-points[m] * scale, (1.0 - points[m]) * scale);
            let n = product.len();
            product = (0..=n)
                .map(|i| {
                    let share = i as f64 / n as f64;
                    let from_low = if i < n { (1.0 - share) * low * product[i] } else { 0.0 };
                    let from_high = if i > 0 { share * high * product[i - 1] } else { 0.0 };
                    from_low + from_high
                })
                .collect();
        }
        std::array::from_fn(|i| product[i])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn function(f: impl Fn(f64) -> f64, rho: f64) -> EventFunction {
        EventFunction {
            start: f(0.0),
            nodal: BASIS.nodes.map(f),
            rho: [rho; 3],
            rounding: 1e-14,
            residue: 0.0,
            slope_residue: 0.0,
        }
    }

    fn verdict(f: impl Fn(f64) -> f64, rho: f64) -> Verdict {
        let slope = (f(1e-6) - f(-1e-6)) / 2e-6;
        function(f, rho).verdict(|| Beginning { slope, bend: None, unresolved: 0.0 })
    }

    #[test]
    fn zeros_are_found_first_and_dips_are_seen() {
        let meets = |found, at: f64| match found {
            Verdict::Meets(place) => assert!((place - at).abs() < 1e-5, "{place} {at}"),
            other => panic!("{other:?}"),
        };
        meets(verdict(|s| (0.3 - s) * (0.7 - s) * (2.0 - s), 0.0), 0.3);
        meets(verdict(|s| 0.999 - s, 0.0), 0.999);
        // a minimum below zero between two nodes, and a minimum that only touches zero
        for lowest in [0.05, 0.3, 0.5, 0.71, 0.97] {
            let dip = |depth: f64| move |s: f64| (s - lowest).powi(2) * (1.0 + s) - depth;
            let (mut above, mut below) = (0.0, lowest);
            for _ in 0..60 {
                let middle = 0.5 * (above + below);
                *(if dip(1e-6)(middle) > 0.0 { &mut above } else { &mut below }) = middle;
            }
            meets(verdict(dip(1e-6), 0.0), above);
            assert_eq!(verdict(dip(-1e-6), 0.0), Verdict::Clear);
            assert_eq!(verdict(dip(-1e-6), 1e-5), Verdict::Doubtful);
        }
        assert_eq!(verdict(|s| 1.0 + s, 1e-3), Verdict::Clear);
    }

    /// For a decreasing polynomial the result equals that of subdivision.
    #[test]
    fn a_falling_function_is_met_where_halving_meets_it() {
        for i in 1..200 {
            let zero = f64::from(i) / 200.0;
            for bend in [0.0, 0.3, -0.3] {
                let f = |s: f64| (zero - s) * (1.0 + bend * s) * (2.0 - s);
                let halved = ((zero / FINEST).floor() + 0.5) * FINEST;
                match verdict(f, 0.0) {
                    // a zero on the edge of a part may fall to either side of it
                    Verdict::Meets(place) => assert!((place - halved).abs() <= FINEST, "{place} {halved}"),
                    other => panic!("{other:?}"),
                }
            }
        }
    }

    #[test]
    fn a_branch_may_begin_on_its_boundary() {
        assert_eq!(verdict(|s| s + s * s, 0.0), Verdict::Clear);
        assert_eq!(verdict(|s| s, 2.0), Verdict::Doubtful);
        match verdict(|s| s * (0.4 - s), 0.0) {
            Verdict::Meets(place) => assert!((place - 0.4).abs() < 1e-5),
            other => panic!("{other:?}"),
        }
        assert_eq!(verdict(|s| -s, 0.0), Verdict::Meets(0.0));
        // a branch that is short, but does not end where it begins
        match verdict(|s| s * (1e-7 - s), 0.0) {
            Verdict::Meets(place) => assert!(place > 0.0 && place < 1e-4, "{place}"),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_branch_may_begin_at_a_turning_point() {
        let turning = |bend: f64| {
            let beginning = Beginning { slope: 0.0, bend: Some(2.0 * bend), unresolved: 0.0 };
            function(|s| bend * s * s * (1.0 + s), 1e-3).verdict(|| beginning)
        };
        assert_eq!(turning(1.0), Verdict::Clear);
        assert_eq!(turning(-1.0), Verdict::Meets(0.0));
    }

    /// Surfaces at rest against each other, which the force `t^(3/2)` of another contact begins to press or to separate. The
    /// polynomial of that force starts with the wrong sign.
    #[test]
    fn a_branch_may_begin_from_nothing() {
        let begins = |sign: f64, wrong: f64, unresolved: f64, rho: f64| {
            let moved = |s: f64| sign * (s.powf(3.5) - wrong * s * s * (1.0 - 20.0 * s));
            let beginning = Beginning { slope: 0.0, bend: Some(0.0), unresolved };
            EventFunction { rounding: 1e-18, ..function(moved, rho) }.verdict(|| beginning)
        };
        assert_eq!(begins(1.0, 1e-4, 1e-3, 0.0), Verdict::Clear);
        assert_eq!(begins(-1.0, 1e-4, 1e-3, 0.0), Verdict::Meets(0.0));
        // with vibrations that the panel does not resolve neither can be decided
        assert_eq!(begins(1.0, 1e-4, 1e-3, 1e-2), Verdict::Doubtful);
        assert_eq!(begins(-1.0, 1e-4, 1e-3, 1e-2), Verdict::Doubtful);
    }
}
