//! Data of the structure for a step in contact: its free motion at the nodes, its compliance there to nodal forces, and the
//! response of every mode at the end of the step.
//!
//! With `S(t)` the displacement of a mode `t` after a unit velocity, these follow from `S`, `S'` and
//! `int_0^c S(h (c-s)) P_n(2s-1) ds`. Their computation depends on the angle `|z|`, `z = lambda h`, by which the mode turns in
//! the step (`lambda = -zeta omega + i omega_d`):
//!
//! - up to [`SLOW`] rad by power series. About the middle of the step they need half the terms, and the even and odd terms are
//!   the same for the nodes of both halves;
//! - beyond that by parts: `int_0^c e^{z(c-s)} f(s) ds = e^{zc} sum f^(k)(0)/z^{k+1} - sum f^(k)(c)/z^{k+1}`, which
//!   ends after `Q` terms, since `f` is a polynomial. The second sum of all modes together needs only `Q` numbers; the first
//!   is a product of two short vectors for each mode;
//! - near critical damping and above it, where roots may coincide, one node after the other unless the series apply: by
//!   quadrature or, if the roots are apart, as two decays.

use super::lanes::{ComplexLanes, Lanes};
use super::legendre::{BASIS, HALF_SERIES, Matrix, Nodal, Q, RECIPROCAL, SERIES, SLOW};
use super::oscillator::{BodyMode, NEARLY_CRITICAL, Propagator, propagate, response};
use super::vector::{LANES, sum_of_lanes, vectorized};
use num_complex::Complex64;
use std::array;

/// Method of computing the response of a mode on a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Way {
    Series,
    ByParts,
    Quadrature,
}

impl Way {
    pub fn of(mode: &BodyMode, h: f64) -> Way {
        if rate(mode) * h <= SLOW {
            Way::Series
        } else if mode.damping_ratio < NEARLY_CRITICAL {
            Way::ByParts
        } else {
            Way::Quadrature
        }
    }
}

/// One slow mode on a step of `h`; `half` is its free motion over `h/2`. A mode needs no fewer `terms` of its series about the
/// middle than a slower one.
#[inline(always)]
pub(crate) fn by_series(mode: &BodyMode, h: f64, half: &Propagator, terms: &mut usize) -> Part {
    // as many even as odd ones
    *terms = BASIS.terms::<HALF_SERIES>(0.5 * rate(mode) * h, *terms).next_multiple_of(2);
    slow(mode, h, half, *terms)
}

/// `|lambda|`, of the faster root if there are two (rad/s).
pub(crate) fn rate(mode: &BodyMode) -> f64 {
    mode.omega_rad_s * if mode.damping_ratio < NEARLY_CRITICAL { 1.0 } else { 2.0 * mode.damping_ratio }
}

/// Contribution of one mode for a step exponent.
pub(crate) struct Part {
    /// Change by free motion at the nodes, from displacement and from velocity.
    pub at_nodes: (Nodal, Nodal),
    /// Displacement and velocity at the end of the step to unit Legendre forces, for unit weight.
    pub end: (Nodal, Nodal),
}

/// What of the motion under a force is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Order {
    Displacement,
    Velocity,
}

/// The compliance, or its rate, as it is gathered from the modes of a body, from the slowest to the fastest.
pub(crate) struct Compliance {
    order: Order,
    /// Slow modes: derivatives of their common impulse response at zero, times `h^p`, in [`LANES`] partial sums.
    impulse: [[f64; LANES]; SERIES],
    /// Number of terms that the modes of this body and of the bodies before need.
    terms: usize,
    most_terms: usize,
    /// Fast modes: `sum h^2 w Im(z^-(k+1)) / (omega_d h)`, what multiplies the derivatives of the force at the node; for velocities
    /// `lambda z^-(k+1)` in its place.
    by_parts: Nodal,
    /// `[n][i]`: motion at node `i` to unit Legendre force `n`, of all that is neither of these.
    legendre: Matrix,
}

impl Compliance {
    pub fn new(order: Order) -> Compliance {
        Compliance {
            order,
            impulse: [[0.0; LANES]; SERIES],
            terms: 2,
            most_terms: 0,
            by_parts: [0.0; Q],
            legendre: [[0.0; Q]; Q],
        }
    }

    /// Adds slow modes with these weights: the impulse response from the start, `S^(p)(0) h^p`, or that of `S'`.
    #[inline(always)]
    pub fn add_slow(&mut self, modes: &[BodyMode; LANES], weights: &[f64; LANES], h: f64) {
        let (mut square, mut damping, mut turned) = ([0.0; LANES], [0.0; LANES], 0.0f64);
        for l in 0..LANES {
            (square[l], damping[l]) = square_and_damping(&modes[l], h);
            turned = turned.max(rate(&modes[l]) * h);
        }
        // no fewer than slower ones
        self.terms = BASIS.terms::<SERIES>(turned, self.terms);
        self.most_terms = self.most_terms.max(self.terms);
        let (mut here, mut next) = match self.order {
            Order::Displacement => ([0.0; LANES], weights.map(|weight| h * weight)),
            Order::Velocity => (*weights, array::from_fn(|l| -damping[l] * weights[l])),
        };
        for sum in &mut self.impulse[..self.terms] {
            for l in 0..LANES {
                sum[l] += here[l];
                (here[l], next[l]) = (next[l], -damping[l] * next[l] - square[l] * here[l]);
            }
        }
    }

    /// Ends a body: the number of terms for the modes of the next body does not depend on it.
    pub fn end_body(&mut self) {
        self.terms = 2;
    }

    /// Adds modes that are integrated by parts, with these weights.
    #[inline(always)]
    pub fn add_by_parts(&mut self, modes: &ByParts, weights: &[f64; LANES]) {
        if *weights == [0.0; LANES] {
            return;
        }
        let order = self.order;
        let differentiated = |value: ComplexLanes| match order {
            Order::Displacement => value,
            Order::Velocity => modes.lambda * value,
        };
        let weights = Lanes(*weights) * modes.scale;
        let mut power = differentiated(modes.inverse);
        for value in &mut self.by_parts {
            (weights * power.im).0.iter().for_each(|part| *value += part);
            power = power * modes.inverse;
        }
        for (column, start) in self.legendre.iter_mut().zip(&modes.at_start) {
            let start = differentiated(*start) * weights;
            // a copy, to be kept in registers
            let mut sums = *column;
            for (l, (nodes_re, nodes_im)) in modes.to_nodes.iter().enumerate() {
                for i in 0..Q {
                    sums[i] -= start.re.0[l] * nodes_im[i] + start.im.0[l] * nodes_re[i];
                }
            }
            *column = sums;
        }
    }

    /// Adds any mode with this weight, by quadrature.
    pub fn add_by_quadrature(&mut self, mode: &BodyMode, weight: f64, h: f64) {
        let order = self.order;
        self.add_response(weight, h, |t| {
            let (displacement, velocity) = response(mode, t);
            if order == Order::Displacement { displacement } else { velocity }
        });
    }

    /// Adds a response to unit Legendre forces with this weight.
    pub fn add_response(&mut self, weight: f64, h: f64, moved: impl Fn(f64) -> Nodal) {
        let basis = &*BASIS;
        for i in 0..Q {
            let to_node = moved(basis.nodes[i] * h);
            for n in 0..Q {
                for m in 0..=n {
                    self.legendre[n][i] -= weight * basis.restricted[i][n][m] * to_node[m];
                }
            }
        }
    }

    /// Motion at the nodes under nodal forces.
    pub fn at_nodes(&self, h: f64) -> Matrix {
        let basis = &*BASIS;
        vectorized(
            #[inline(always)]
            || {
                let mut legendre = self.legendre;
                if self.by_parts != [0.0; Q] {
                    for (s, derivatives) in self.by_parts.iter().zip(&basis.derivatives) {
                        for n in 0..Q {
                            for i in 0..Q {
                                legendre[n][i] += s * derivatives[n][i];
                            }
                        }
                    }
                }
                let mut compliance = [[0.0; Q]; Q];
                for (lanes, power) in self.impulse[..self.most_terms].iter().zip(&basis.power) {
                    let kernel = h * sum_of_lanes(*lanes);
                    for j in 0..Q {
                        for i in 0..Q {
                            compliance[j][i] -= kernel * power[j][i];
                        }
                    }
                }
                // zero if all modes are slow
                if legendre != [[0.0; Q]; Q] {
                    for n in 0..Q {
                        for j in 0..Q {
                            for i in 0..Q {
                                compliance[j][i] += legendre[n][i] * basis.to_coefficients[j][n];
                            }
                        }
                    }
                }
                compliance
            },
        )
    }
}

/// By power series, from the free motion in the middle of the step.
#[inline(always)]
fn slow(mode: &BodyMode, h: f64, middle: &Propagator, terms: usize) -> Part {
    let (square, damping) = square_and_damping(mode, h);

    // S^(p) h^p/p! in the middle, and the same of h S'
    let mut series = [(0.0, 0.0); HALF_SERIES];
    let (mut s, mut v) = (middle.p12, middle.p22 * h);
    for (term, reciprocal) in series[..terms].iter_mut().zip(&RECIPROCAL[1..]) {
        *term = (s, v);
        (s, v) = (v * reciprocal, (-damping * v - square * s) * reciprocal);
    }
    let series = &series[..terms];
    let sums @ [even, odd] = &[weighted_sums(series, 0), weighted_sums(series, 1)];
    let square_per_second = square / h;
    // the even part is the same in both halves, the odd part changes its sign; those of the integral of `S`, which is
    // taken from the middle, are odd and even
    let at = |i: usize, of: usize| {
        if i < Q / 2 {
            even[of][Q / 2 - 1 - i] - odd[of][Q / 2 - 1 - i]
        } else {
            even[of][i - Q / 2] + odd[of][i - Q / 2]
        }
    };
    let end = |n: usize, of: usize| sums[n % 2][of][n / 2];
    Part {
        // a unit displacement moves by -omega^2 int S
        at_nodes: (
            array::from_fn(|i| middle.p11_less_1 + square_per_second * if i < Q / 2 { at(i, 1) } else { -at(i, 1) }),
            array::from_fn(|i| at(i, 0)),
        ),
        end: (array::from_fn(|n| h * end(n, 2)), array::from_fn(|n| end(n, 3))),
    }
}

/// `(omega h)^2` and `2 zeta omega h`.
fn square_and_damping(mode: &BodyMode, h: f64) -> (f64, f64) {
    let angle = mode.omega_rad_s * h;
    (angle * angle, 2.0 * mode.damping_ratio * angle)
}

/// Even or odd terms: of `S` at the nodes of the second half, of its integral from the middle to there, and of `S` and
/// `h S'` integrated with the Legendre polynomials.
#[inline(always)]
fn weighted_sums(series: &[(f64, f64)], parity: usize) -> [[f64; Q / 2]; 4] {
    let (mut s_nodes, mut to_nodes, mut s_end, mut v_end) = ([0.0; Q / 2], [0.0; Q / 2], [0.0; Q / 2], [0.0; Q / 2]);
    for (terms, weights) in series.chunks_exact(2).zip(BASIS.about_middle.chunks_exact(2)) {
        let ((s, v), [powers, from_middle, integrals]) = (terms[parity], &weights[parity]);
        for m in 0..Q / 2 {
            s_nodes[m] += s * powers[m];
            to_nodes[m] += s * from_middle[m];
            s_end[m] += s * integrals[m];
            v_end[m] += v * integrals[m];
        }
    }
    [s_nodes, to_nodes, s_end, v_end]
}

/// Modes below critical damping, integrated by parts.
pub(crate) struct ByParts {
    sigma: Lanes,
    omega_d: Lanes,
    lambda: ComplexLanes,
    /// `1/z` and `h/omega_d`.
    inverse: ComplexLanes,
    scale: Lanes,
    /// By mode.
    to_nodes: [(Nodal, Nodal); LANES],
    to_end: ComplexLanes,
    /// Sums of `P_n^(k)/z^(k+1)` at the end and at the start of the step.
    at_end: [ComplexLanes; Q],
    at_start: [ComplexLanes; Q],
}

impl ByParts {
    /// Modes on a step of `h`, with their free motion over the whole step.
    #[inline(always)]
    pub fn new(modes: &[BodyMode; LANES], over_step: &[Propagator; LANES], h: f64) -> ByParts {
        let sigma = Lanes::of(|l| modes[l].damping_ratio * modes[l].omega_rad_s);
        let omega_d = Lanes::of(|l| {
            let BodyMode { omega_rad_s, damping_ratio } = modes[l];
            omega_rad_s * ((1.0 - damping_ratio) * (1.0 + damping_ratio)).sqrt()
        });
        let lambda = ComplexLanes { re: -sigma, im: omega_d };
        let inverse = ComplexLanes::of(|l| (lambda.of_lane(l) * h).inv());
        let scale = Lanes::of(|l| h / omega_d.0[l]);
        let [p12, p22] = [Lanes::of(|l| over_step[l].p12), Lanes::of(|l| over_step[l].p22)];
        let to_end = ComplexLanes { re: p22 + sigma * p12, im: omega_d * p12 };
        let mut to_nodes = [([0.0; Q], [0.0; Q]); LANES];
        for l in 0..LANES {
            to_nodes[l] = exponentials(sigma.0[l] * h, omega_d.0[l] * h, to_end.of_lane(l));
        }
        // both obey the recurrence of the spherical Bessel functions, in the direction in which it is stable
        let (mut at_end, mut at_start) = ([inverse; Q], [inverse; Q]);
        let twice = inverse * 2.0 * inverse;
        (at_end[1], at_start[1]) = (twice + inverse, twice - inverse);
        for n in 1..Q - 1 {
            let factor = inverse * (4 * n + 2) as f64;
            at_end[n + 1] = at_end[n - 1] + factor * at_end[n];
            at_start[n + 1] = at_start[n - 1] + factor * at_start[n];
        }
        ByParts { sigma, omega_d, lambda, inverse, scale, to_nodes, to_end, at_end, at_start }
    }

    /// Change of a mode by free motion at the nodes, from displacement and from velocity.
    #[inline(always)]
    pub fn at_nodes(&self, l: usize) -> (Nodal, Nodal) {
        let (nodes_re, nodes_im) = &self.to_nodes[l];
        let (mut from_displacement, mut sine) = ([0.0; Q], [0.0; Q]);
        for i in 0..Q {
            sine[i] = nodes_im[i] / self.omega_d.0[l];
            from_displacement[i] = nodes_re[i] + self.sigma.0[l] * sine[i] - 1.0;
        }
        (from_displacement, sine)
    }

    /// Displacements and velocities at the end of the step to unit Legendre forces, for unit weight.
    #[inline(always)]
    pub fn end(&self) -> ([Lanes; Q], [Lanes; Q]) {
        let (mut displacement, mut velocity) = ([Lanes::ZERO; Q], [Lanes::ZERO; Q]);
        for n in 0..Q {
            let moment = self.to_end * self.at_start[n] - self.at_end[n];
            displacement[n] = self.scale * moment.im;
            velocity[n] = self.scale * (self.lambda * moment).im;
        }
        (displacement, velocity)
    }
}

/// `e^{(-decay + i turn) c}` at the nodes, real and imaginary parts, from that at 1. Nodes `c` and `1 - c` share theirs.
fn exponentials(decay: f64, turn: f64, whole: Complex64) -> (Nodal, Nodal) {
    let (mut re, mut im) = ([0.0; Q], [0.0; Q]);
    for i in 0..Q / 2 {
        let c = BASIS.nodes[i];
        let (sine, cosine) = (turn * c).sin_cos();
        let size = if decay == 0.0 { 1.0 } else { (-decay * c).exp() };
        (re[i], im[i]) = (size * cosine, size * sine);
        // where the size underflows, less than 1e-160 of the second half is left
        if size > 0.0 {
            let other = whole * Complex64::new(cosine, -sine);
            (re[Q - 1 - i], im[Q - 1 - i]) = (other.re / size, other.im / size);
        }
    }
    (re, im)
}

/// Any mode, one node after the other.
pub(crate) fn by_quadrature(mode: &BodyMode, h: f64) -> Part {
    let at = BASIS.nodes.map(|c| propagate(mode, c * h));
    Part { at_nodes: (at.map(|p| p.p11_less_1), at.map(|p| p.p12)), end: response(mode, h) }
}

/// Weights of the same mode in all lanes, as one of unit weight.
#[cfg(test)]
const WEIGHTS: [f64; LANES] = [0.3, 0.0, 0.5, 0.2];

/// One mode in this way.
#[cfg(test)]
pub(crate) fn along((way, order): (Way, Order), mode: &BodyMode, h: f64, terms: &mut usize) -> (Part, Compliance) {
    let mut compliance = Compliance::new(order);
    let part = match way {
        Way::Series => {
            compliance.add_slow(&[*mode; LANES], &WEIGHTS, h);
            by_series(mode, h, &propagate(mode, 0.5 * h), terms)
        }
        Way::ByParts => {
            let by_parts = ByParts::new(&[*mode; LANES], &[propagate(mode, h); LANES], h);
            compliance.add_by_parts(&by_parts, &WEIGHTS);
            let (displacement, velocity) = by_parts.end();
            let end = (displacement.map(|all| all.0[1]), velocity.map(|all| all.0[1]));
            Part { at_nodes: by_parts.at_nodes(1), end }
        }
        Way::Quadrature => {
            compliance.add_by_quadrature(mode, 1.0, h);
            by_quadrature(mode, h)
        }
    };
    (part, compliance)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(omega_rad_s: f64, damping_ratio: f64) -> BodyMode {
        BodyMode { omega_rad_s, damping_ratio }
    }

    /// `moved`: how far free motion from a unit displacement goes, and what cancels in it, in size.
    fn assert_close(
        (one, other): ((Part, Compliance), (Part, Compliance)),
        (h, order): (f64, Order),
        moved: f64,
        floor: f64,
        what: &str,
    ) {
        let close = |a: &Nodal, b: &Nodal, unit: f64, part: &str| {
            for i in 0..Q {
                let error = (a[i] - b[i]).abs() / unit;
                assert!(error < floor, "{what}, {part} {i}: {} and {}, {error:e}", a[i], b[i]);
            }
        };
        close(&one.0.at_nodes.0, &other.0.at_nodes.0, moved.min(1.0), "from displacement");
        close(&one.0.at_nodes.1, &other.0.at_nodes.1, h, "from velocity");
        close(&one.0.end.0, &other.0.end.0, h * h, "displacement");
        close(&one.0.end.1, &other.0.end.1, h, "velocity");
        let (one, other) = (one.1.at_nodes(h), other.1.at_nodes(h));
        let unit = if order == Order::Displacement { h * h } else { h };
        for i in 0..Q {
            close(&one[i], &other[i], unit, "compliance");
        }
    }

    /// By this way, and by quadrature.
    fn each_way(mode: &BodyMode, h: f64, way: Way, order: Order) -> ((Part, Compliance), (Part, Compliance)) {
        (along((way, order), mode, h, &mut 2), along((Way::Quadrature, order), mode, h, &mut 2))
    }

    #[test]
    fn the_series_of_slow_modes_meet_the_closed_forms() {
        for h in [1e-6, 1.0] {
            for zeta in [0.0, 0.02, 0.9, 0.9899, 0.995, 1.0, 1.2, 30.0] {
                for turned in [SLOW, 0.99 * SLOW, 4.0, 2.0, 0.5, 1e-2, 1e-9] {
                    let mode = mode(turned / h / rate(&mode(1.0, zeta)), zeta);
                    let angle = mode.omega_rad_s * h;
                    for order in [Order::Displacement, Order::Velocity] {
                        let both = each_way(&mode, h, Way::Series, order);
                        let what = format!("{order:?} {turned} {zeta} {h}");
                        assert_close(both, (h, order), angle * (angle + zeta), 2e-14, &what);
                    }
                }
            }
        }
    }

    #[test]
    fn integration_by_parts_meets_the_moments_one_by_one() {
        for h in [1e-6, 1.0] {
            for zeta in [0.0, 0.02, 0.5, 0.9, 0.9899] {
                for turned in [SLOW, 1.01 * SLOW, 8.0, 12.0, 20.0, 100.0, 1e3, 3e4] {
                    let mode = mode(turned / h, zeta);
                    // the angle has a rounding error, and nearly equal roots cancel
                    let floor = (3e-14 + f64::EPSILON * turned) / ((1.0 - zeta) * (1.0 + zeta)).sqrt();
                    for order in [Order::Displacement, Order::Velocity] {
                        let both = each_way(&mode, h, Way::ByParts, order);
                        assert_close(both, (h, order), 1.0, floor, &format!("{order:?} {turned} {zeta} {h}"));
                    }
                }
            }
        }
    }

    #[test]
    fn modes_of_any_speed_have_finite_tables() {
        let modes = [1e-15, 1e-3, 1e9, 1e15].into_iter().flat_map(|omega| [0.0, 0.5, 1.0, 1e6].map(|z| mode(omega, z)));
        let finite = |values: &[f64]| values.iter().all(|x| x.is_finite());
        for h in [1e-50, 1.0, 1e30] {
            let mut terms = 2;
            for mode in modes.clone() {
                for order in [Order::Displacement, Order::Velocity] {
                    let (part, compliance) = along((Way::of(&mode, h), order), &mode, h, &mut terms);
                    assert!(finite(&part.at_nodes.0) && finite(&part.at_nodes.1), "{h}");
                    assert!(finite(&part.end.0) && finite(&part.end.1), "{h}");
                    assert!(finite(compliance.at_nodes(h).as_flattened()), "{h}");
                }
            }
        }
    }
}
