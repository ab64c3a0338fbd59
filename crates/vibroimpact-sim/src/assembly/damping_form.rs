//! Energy that one mode loses to modal damping within a panel, as a quadratic form of its state and its force.
//!
//! On a panel of `h` a mode starts at `(a, b)` and is driven by `g(t) = sum g_n P_n(2 t/h - 1)`. A displacement `a` acts
//! like a force `-omega^2 a` that is constant, so with `S` the impulse response its rate is
//!
//! ```text
//! a'(t) = b S'(t) + sum_n q_n v_n(t),   q_0 = g_0 - omega^2 a,   q_n = g_n,   v_n(t) = int_0^t S'(t-s) P_n(2 s/h - 1) ds
//! ```
//!
//! and the loss `int 2 zeta omega a'^2 dt` a form in `(b, q_0 .. q_7)` ([`Form`]). Its numbers are integrals of products of
//! the nine rates themselves, by three ways:
//!
//! - a mode that turns by at most [`SLOW`] rad: Gauss quadrature, with the rates from their power series;
//! - a faster one: `S' = Re(c e^{z x})`, and `v_n` is a polynomial and a multiple of the same exponential (integration by
//!   parts, as in [`crate::panel::forcing`]), so each product has a closed integral. Only a few numbers of the polynomials depend on
//!   the mode, so that their products are summed over the modes before they are integrated;
//! - a faster one that vibrates little or not at all: quadrature on panels that grow away from the start.

use crate::panel::forcing::rate;
use crate::panel::lanes::{ComplexLanes, Lanes};
use crate::panel::legendre::{BASIS, Legendre, Matrix, Nodal, Q, RECIPROCAL, SERIES, SLOW, dot, legendre, rule};
use crate::panel::oscillator::BodyMode;
use crate::panel::oscillator::{NEARLY_CRITICAL, propagate, response};
use crate::panel::vector::{LANES, sum_over, vectorized};
use num_complex::Complex64;
use std::array;
use std::num::NonZeroUsize;
use std::sync::LazyLock;

/// Nodes that integrate the products of two rates of a mode that turns by at most [`SLOW`] rad, to rounding of each.
const NODES: usize = 16;
static SLOW_RATES: LazyLock<Series> = LazyLock::new(Series::new);

/// Loss of one mode within a panel: `bb b^2 + 2 b sum_n bq_n q_n + sum_nm qq_nm q_n q_m` (J). The matrix is symmetric, and only
/// its lower half is used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Form {
    pub bb: f64,
    pub bq: Nodal,
    pub qq: Matrix,
}

/// The part of a form that depends on the motion at the start, with the first column of `qq`.
pub(crate) struct OfState {
    pub bb: f64,
    pub bq: Nodal,
    pub q0: Nodal,
}

impl Form {
    const NONE: Form = Form { bb: 0.0, bq: [0.0; Q], qq: [[0.0; Q]; Q] };

    /// Inlined, to be compiled for the vector units of the machine.
    #[inline(always)]
    pub fn of(mode: &BodyMode, h: f64) -> Form {
        let turned = rate(mode) * h;
        if mode.damping_ratio * mode.omega_rad_s == 0.0 {
            Form::NONE
        } else if turned <= SLOW {
            SLOW_RATES.form(mode, h)
        } else if mode.damping_ratio < NEARLY_CRITICAL {
            ByParts::new(&[*mode; LANES], h).of_lane(0)
        } else {
            by_quadrature(mode, h)
        }
    }

    /// The losses that depend on the motion at the start.
    #[inline(always)]
    pub fn of_state(&self) -> OfState {
        let mut q0 = [0.0; Q];
        for n in 0..Q {
            q0[n] = self.qq[n][0];
        }
        OfState { bb: self.bb, bq: self.bq, q0 }
    }

    /// Adds the products of the rates at one place, which are those to a unit rate and to unit Legendre forces over `h`.
    #[inline(always)]
    fn add(&mut self, weight: f64, by_rate: f64, by_force: &Nodal) {
        self.bb += weight * by_rate * by_rate;
        for n in 0..Q {
            self.bq[n] += weight * by_rate * by_force[n];
            for m in 0..=n {
                self.qq[n][m] += weight * by_force[n] * by_force[m];
            }
        }
    }

    /// From a mean over the panel of products of rates, those to forces divided by `h`, to the loss.
    #[inline(always)]
    fn scaled(mut self, mode: &BodyMode, h: f64) -> Form {
        let scale = 2.0 * mode.damping_ratio * mode.omega_rad_s * h;
        self.bb *= scale;
        self.bq = self.bq.map(|value| value * scale * h);
        self.qq = self.qq.map(|row| row.map(|value| value * scale * h * h));
        self
    }
}

/// Power series of the rates of a mode, to a unit rate and to unit Legendre forces, at the nodes of a Gauss rule on (0, 1).
struct Series {
    weights: [f64; NODES],
    /// `[p][i]`: `x^p/p!` at node `i`.
    by_rate: Vec<[f64; NODES]>,
    /// `[i/2][p][i%2][n]`: `int_0^x (x-s)^p/p! P_n(2s-1) ds` at node `i`.
    by_force: [Vec<[Nodal; 2]>; NODES / 2],
}

impl Series {
    /// For modes that turn by at most [`SLOW`] rad.
    fn new() -> Series {
        let terms = BASIS.terms::<SERIES>(SLOW, 2);
        let rule = rule(const { NonZeroUsize::new(NODES).unwrap() });
        let mut powers = [1.0; NODES];
        let next = |p: usize| {
            let here = powers;
            powers.iter_mut().zip(&rule).for_each(|(power, (x, _))| *power *= x * RECIPROCAL[p + 1]);
            here
        };
        let by_rate = (0..terms).map(next).collect();
        let by_force = array::from_fn(|pair| {
            let [one, other] = [0, 1].map(|i| repeated_integrals(rule[2 * pair + i].0, terms));
            one.into_iter().zip(other).map(|(one, other)| [one, other]).collect()
        });
        Series { weights: array::from_fn(|i| rule[i].1), by_rate, by_force }
    }

    #[inline(always)]
    fn form(&self, mode: &BodyMode, h: f64) -> Form {
        // S'^(p)(0) h^p
        let angle = mode.omega_rad_s * h;
        let (square, drag) = (angle * angle, 2.0 * mode.damping_ratio * angle);
        let mut derivatives = [0.0; SERIES];
        let terms = BASIS.terms::<SERIES>(rate(mode) * h, 2);
        let (mut here, mut next) = (1.0, -drag);
        for derivative in &mut derivatives[..terms] {
            *derivative = here;
            (here, next) = (next, -drag * next - square * here);
        }

        let mut by_rate = [0.0; NODES];
        for (derivative, powers) in derivatives[..terms].iter().zip(&self.by_rate) {
            for i in 0..NODES {
                by_rate[i] += derivative * powers[i];
            }
        }
        let mut by_force = [[[0.0; Q]; 2]; NODES / 2];
        for (rates, series) in by_force.iter_mut().zip(&self.by_force) {
            for (derivative, powers) in derivatives[..terms].iter().zip(series) {
                for i in 0..2 {
                    for n in 0..Q {
                        rates[i][n] += derivative * powers[i][n];
                    }
                }
            }
        }
        let by_force = by_force.as_flattened();
        let mut form = Form::NONE;
        for (i, by_force) in by_force.iter().enumerate() {
            let weighted = self.weights[i] * by_rate[i];
            form.bb += weighted * by_rate[i];
            for n in 0..Q {
                form.bq[n] += weighted * by_force[n];
            }
        }
        for n in 0..Q {
            for (by_force, weight) in by_force.iter().zip(&self.weights) {
                let weighted = weight * by_force[n];
                for m in 0..Q {
                    form.qq[n][m] += weighted * by_force[m];
                }
            }
        }
        form.scaled(mode, h)
    }
}

/// `[p][n]`: `int_0^x (x-s)^p/p! P_n(2s-1) ds`, the integral from zero taken `p + 1` times. Of `P_0` it is a power of `x`, and of the
/// others `int_0^x P_n(2s-1) ds = (P_{n+1}(2x-1) - P_{n-1}(2x-1)) / (4n+2)`, which is itself integrated in the same way.
fn repeated_integrals(x: f64, terms: usize) -> Vec<Nodal> {
    const DIVISORS: [f64; SERIES + Q] = {
        let (mut divisors, mut n) = ([0.0; SERIES + Q], 0);
        while n < SERIES + Q {
            divisors[n] = (4 * n + 2) as f64;
            n += 1;
        }
        divisors
    };
    // each integral takes one polynomial more
    let most = terms + Q - 1;
    let mut values = [0.0; SERIES + Q];
    (values[0], values[1]) = (1.0, 2.0 * x - 1.0);
    for n in 1..most {
        values[n + 1] = (0.5 * DIVISORS[n] * (2.0 * x - 1.0) * values[n] - n as f64 * values[n - 1]) / (n + 1) as f64;
    }
    let mut power = 1.0;
    let integrals = (0..terms).map(|p| {
        let before = values;
        power *= x * RECIPROCAL[p + 1];
        values[0] = power;
        let others = values[1..most - p].iter_mut().zip(before.iter().zip(&before[2..])).zip(&DIVISORS[1..]);
        others.for_each(|((value, (below, above)), divisor)| *value = (above - below) / divisor);
        array::from_fn(|n| values[n])
    });
    integrals.collect()
}

/// Whether all these modes turn by more than a few radians and are damped below critical damping.
#[inline(always)]
pub(crate) fn all_by_parts(modes: &[BodyMode], h: f64) -> bool {
    let by_parts = |mode: &BodyMode| {
        let damped = mode.damping_ratio * mode.omega_rad_s != 0.0 && mode.damping_ratio < NEARLY_CRITICAL;
        damped && rate(mode) * h > SLOW
    };
    modes.iter().all(by_parts)
}

/// Losses of [`LANES`] modes for which [`all_by_parts`] holds. The rate under a Legendre force is the sum of a multiple of `e^{z x}` and
/// of the polynomial `sum_k gamma_k P_n^(k)`, in which only the `gamma_k` depend on the mode.
pub(crate) struct ByParts {
    /// As in [`Form`].
    bb: Lanes,
    bq: [Lanes; Q],
    /// Lower half of `qq` without the products of two polynomials.
    pub vibrating: [[Lanes; Q]; Q],
    gamma: [Lanes; Q],
    /// Loss for a unit mean, over the panel, of the product of the rates under two forces.
    loss: Lanes,
}

/// `[k][j]`: the sums over modes that multiply `int P_n^(k) P_m^(j)`.
pub(crate) type Polynomials<T> = [[T; Q]; Q];

/// Adds the integrals, multiplied by these sums, to the lower half of `qq`. Of the sums, too, only the lower half is used.
pub(crate) fn add_polynomials(qq: &mut Matrix, sums: &Polynomials<f64>) {
    let (derivatives, weights) = (&BASIS.derivatives, &BASIS.weights);
    vectorized(
        #[inline(always)]
        || {
            for m in 1..Q {
                // at the nodes
                let mut columns = [[0.0; Q]; Q];
                for k in 1..Q {
                    for j in 1..=m {
                        let sum = sums[k.max(j)][k.min(j)];
                        for i in 0..Q {
                            columns[k][i] += sum * weights[i] * derivatives[j][m][i];
                        }
                    }
                }
                for n in m..Q {
                    for k in 1..=n {
                        [qq[n][m]] = sum_over(
                            [&columns[k], &derivatives[k][n]],
                            #[inline(always)]
                            |[column, derivative]| [column * derivative],
                        )
                        .map(|product| qq[n][m] + product);
                    }
                }
            }
        },
    );
}

impl ByParts {
    #[inline(always)]
    pub fn new(modes: &[BodyMode; LANES], h: f64) -> ByParts {
        // the rate after a unit rate is Re(scale e^{z x})
        let mut scale = ComplexLanes { re: Lanes([1.0; LANES]), im: Lanes::ZERO };
        let [mut sigma, mut turn, mut decayed] = [Lanes::ZERO; 3];
        let [mut inverse, mut whole] = [ComplexLanes::ZERO; 2];
        for (l, mode) in modes.iter().enumerate() {
            let BodyMode { omega_rad_s, damping_ratio } = *mode;
            sigma.0[l] = damping_ratio * omega_rad_s;
            let omega_d = omega_rad_s * ((1.0 - damping_ratio) * (1.0 + damping_ratio)).sqrt();
            scale.im.0[l] = sigma.0[l] / omega_d;
            turn.0[l] = 1.0 / (omega_d * h);
            let decay = 2.0 * sigma.0[l] * h;
            decayed.0[l] = if decay < 1e-17 { 1.0 } else { -(-decay).exp_m1() / decay };
            let z = Complex64::new(-sigma.0[l], omega_d) * h;
            inverse.set_lane(l, z.inv());
            whole.set_lane(l, z.exp());
        }

        // the rate to P_n is Re(scale (e^{z x} Q_n(0) - Q_n(x))) h with Q_n = sum_k P_n^(k)/z^(k+1), where scale/z = -i/(omega_d h);
        // and int P_n^(k) e^{z x} = [sum_s (-1)^(s-k) P_n^(s) e^{z x}/z^(s-k+1)] from s = k on
        let (mut gamma, mut beta) = ([Lanes::ZERO; Q], [ComplexLanes::ZERO; Q]);
        let mut power = inverse;
        for k in 1..Q {
            gamma[k] = -(power.im * turn);
            beta[k] = (ComplexLanes { re: gamma[k], im: Lanes::ZERO } - beta[k - 1]) * inverse;
            power = power * inverse;
        }
        // Q_n(0) obeys the recurrence of the spherical Bessel functions
        let mut at_start = [inverse; Q];
        at_start[1] = inverse * 2.0 * inverse - inverse;
        for n in 1..Q - 1 {
            at_start[n + 1] = at_start[n - 1] + inverse * (4 * n + 2) as f64 * at_start[n];
        }

        // means of e^{2 z x}/2 and of |e^{z x}|^2/2
        let one = ComplexLanes { re: Lanes([1.0; LANES]), im: Lanes::ZERO };
        let turned = (whole * whole - one) * 0.25 * inverse;
        let half = decayed * 0.5;
        // the mean of a product of two rates is bilinear in their c and the means of their polynomials times e^{z x}
        let loss = sigma * (2.0 * h);
        let seen = |c: ComplexLanes, mean: ComplexLanes| {
            let by_c = mean + c * turned;
            [by_c.re + half * c.re, half * c.im - by_c.im]
        };
        let [by_rate_re, by_rate_im] = seen(scale, ComplexLanes::ZERO);
        let bb = (scale.re * by_rate_re + scale.im * by_rate_im) * loss;
        let mut bq = [Lanes::ZERO; Q];
        let mut vibrating = [[Lanes::ZERO; Q]; Q];
        let (mut c, mut mean, mut other) = ([ComplexLanes::ZERO; Q], [ComplexLanes::ZERO; Q], [[Lanes::ZERO; 2]; Q]);
        let loss_by_force = loss * (h * h);
        for n in 0..Q {
            // sums over odd and over even derivatives, which are those at the end: at the start every second has the other sign
            let mut sums = [ComplexLanes::ZERO; 2];
            for s in 1..=n {
                sums[s % 2] = sums[s % 2] + beta[s] * AT_END[n][s];
            }
            let [even, odd] = sums;
            let at_start_of_panel = if n % 2 == 0 { even - odd } else { odd - even };
            mean[n] = whole * (even + odd) - at_start_of_panel;
            c[n] = scale * at_start[n];
            other[n] = seen(c[n], mean[n]);
            bq[n] = (scale.re * other[n][0] + scale.im * other[n][1]) * loss * h;
            for m in 0..=n {
                let by_vibration = c[n].re * other[m][0] + c[n].im * other[m][1];
                let by_polynomial = mean[n].re * c[m].re - mean[n].im * c[m].im;
                vibrating[n][m] = (by_vibration + by_polynomial) * loss_by_force;
            }
        }
        ByParts { bb, bq, vibrating, gamma, loss: loss_by_force }
    }

    /// What these modes, with these weights, add to the sums over the modes.
    #[inline(always)]
    pub fn add_polynomials(&self, weights: Lanes, sums: &mut Polynomials<Lanes>) {
        let weights = weights * self.loss;
        for k in 1..Q {
            let weighted = weights * self.gamma[k];
            for j in 1..=k {
                sums[k][j] = sums[k][j] + weighted * self.gamma[j];
            }
        }
    }

    /// The losses of one mode that depend on its motion at the start.
    #[inline(always)]
    pub fn of_state(&self, l: usize) -> OfState {
        // the rate to a constant force contains no polynomial
        let (mut bq, mut q0) = ([0.0; Q], [0.0; Q]);
        for n in 0..Q {
            (bq[n], q0[n]) = (self.bq[n].0[l], self.vibrating[n][0].0[l]);
        }
        OfState { bb: self.bb.0[l], bq, q0 }
    }

    /// The whole form of one mode.
    fn of_lane(&self, l: usize) -> Form {
        let OfState { bb, bq, .. } = self.of_state(l);
        let mut qq = self.vibrating.map(|row| row.map(|value| value.0[l]));
        let gamma = self.gamma.map(|value| value.0[l]);
        add_polynomials(&mut qq, &gamma.map(|one| gamma.map(|other| self.loss.0[l] * one * other)));
        Form { bb, bq, qq }
    }
}

/// `[n][s]`: the derivatives of `P_n(2x-1)` at 1, `(n+s)! / (s! (n-s)!)`.
const AT_END: [[f64; Q]; Q] = {
    let mut table = [[0.0; Q]; Q];
    let mut n = 0;
    while n < Q {
        let (mut s, mut value) = (0, 1.0);
        while s <= n {
            table[n][s] = value;
            value *= ((n + s + 1) * (n - s)) as f64 / (s + 1) as f64;
            s += 1;
        }
        n += 1;
    }
    table
};

/// Any damping, on panels that grow away from the start.
fn by_quadrature(mode: &BodyMode, h: f64) -> Form {
    let mut form = Form::NONE;
    let mut from = 0.0;
    let mut to = (2.0 / (2.0 * mode.damping_ratio * mode.omega_rad_s * h)).clamp(1e-18, 1.0);
    while from < 1.0 {
        for &(y, w) in &BASIS.fine {
            let x = from + (to - from) * y;
            let (_, velocity) = response(mode, x * h);
            // P_n on [0, x] in the polynomials of that part
            let values = BASIS.nodes.map(|node| legendre(x * node));
            let by_force = array::from_fn(|n| dot(&Legendre::through(&values.map(|value| value[n])).0, &velocity) / h);
            form.add(w * (to - from), propagate(mode, x * h).p22, &by_force);
        }
        from = to;
        to = (2.0 * to).min(1.0);
    }
    form.scaled(mode, h)
}

/// By composite Gauss quadrature of the rates as [`crate::panel::oscillator`] has them.
#[cfg(test)]
pub(crate) fn reference(mode: &BodyMode, h: f64) -> Form {
    let mut form = Form::NONE;
    let panels = (0.5 * rate(mode) * h).ceil().max(2.0) as usize;
    for i in 0..panels {
        for &(y, w) in &BASIS.fine {
            let x = (i as f64 + y) / panels as f64;
            let (_, velocity) = response(mode, x * h);
            let part = |n: usize| Legendre::through(&BASIS.nodes.map(|node| legendre(x * node)[n])).0;
            let by_force = array::from_fn(|n| dot(&part(n), &velocity) / h);
            form.add(w / panels as f64, propagate(mode, x * h).p22, &by_force);
        }
    }
    form.scaled(mode, h)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_is_the_integral_of_the_squared_rate() {
        let h = 1e-3;
        for zeta in [1e-3, 0.02, 0.6, 0.98, 0.995, 1.0, 1.3, 20.0] {
            for turned in [1e-3, 0.3, 1.0, 1.1, 6.0, 6.1, 12.0, 40.0] {
                let unit = BodyMode { omega_rad_s: 1.0, damping_ratio: zeta };
                let mode = BodyMode { omega_rad_s: turned / h / rate(&unit), ..unit };
                let (found, known) = (Form::of(&mode, h), reference(&mode, h));
                // nearly equal roots cancel, and by parts so does the response to high polynomials
                let roots = if zeta < NEARLY_CRITICAL { ((1.0 - zeta) * (1.0 + zeta)).recip() } else { 1.0 };
                let grown = |n: usize| (1..=n).map(|j| (4 * j - 2) as f64 / turned.max(SLOW)).product::<f64>().max(1.0);
                let close = |found: f64, known: f64, unit: f64, floor: f64| {
                    let error = (found - known).abs() / unit;
                    let what = format!("zeta {zeta}, turned {turned}: {found:e} and {known:e}, {error:e}");
                    assert!(error < 2e-14 * (10.0 + turned) * roots * floor, "{what}");
                };
                close(found.bb, known.bb, known.bb, 1.0);
                for n in 0..Q {
                    close(found.bq[n], known.bq[n], (known.bb * known.qq[0][0]).sqrt(), grown(n));
                    for m in 0..=n {
                        close(found.qq[n][m], known.qq[n][m], known.qq[0][0], grown(n) * grown(m));
                    }
                }
            }
        }
    }

    #[test]
    fn forms_are_finite_for_any_mode_and_panel() {
        for omega_rad_s in [1e-15, 1e-3, 1e9, 1e15] {
            for damping_ratio in [1e-9, 0.5, 1.0, 1e6] {
                for h in [1e-50, 1.0, 1e30] {
                    let Form { bb, bq, qq } = Form::of(&BodyMode { omega_rad_s, damping_ratio }, h);
                    let all = bq.iter().chain(qq.iter().flatten()).chain([&bb]).all(|value| value.is_finite());
                    assert!(all, "{omega_rad_s} {damping_ratio} {h}");
                }
            }
        }
    }
}
