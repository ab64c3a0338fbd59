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
//!   parts, as in [`crate::panel::forcing`]), so each product has a closed integral;
//! - a faster one that vibrates little or not at all: quadrature on panels that grow away from the start.

use crate::panel::forcing::rate;
use crate::panel::lanes::{ComplexLanes, Lanes};
use crate::panel::legendre::{BASIS, Legendre, Nodal, Q, SERIES, SLOW, dot, legendre, rule};
use crate::panel::oscillator::BodyMode;
use crate::panel::oscillator::{NEARLY_CRITICAL, propagate, response};
use crate::panel::vector::{LANES, sum_over};
use num_complex::Complex64;
use std::array;
use std::num::NonZeroUsize;
use std::sync::LazyLock;

/// For a mode that turns by at most this much (rad) the coarser rule is sufficient.
const GENTLE: f64 = 1.0;
static COARSE: LazyLock<Series<12>> = LazyLock::new(Series::new);
static FINE: LazyLock<Series<20>> = LazyLock::new(Series::new);

/// Loss of one mode within a panel: `bb b^2 + 2 b sum_n bq_n q_n + sum_nm qq_nm q_n q_m` (J). The matrix is symmetric, and its
/// upper half is left at zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Form<T = f64> {
    pub bb: T,
    pub bq: [T; Q],
    pub qq: [[T; Q]; Q],
}

impl Form {
    const NONE: Form = Form { bb: 0.0, bq: [0.0; Q], qq: [[0.0; Q]; Q] };

    /// Inlined, to be compiled for the vector units of the machine.
    #[inline(always)]
    pub fn of(mode: &BodyMode, h: f64) -> Form {
        let turned = rate(mode) * h;
        if mode.damping_ratio * mode.omega_rad_s == 0.0 {
            Form::NONE
        } else if turned <= GENTLE {
            COARSE.form(mode, h)
        } else if turned <= SLOW {
            FINE.form(mode, h)
        } else if mode.damping_ratio < NEARLY_CRITICAL {
            by_parts(&[*mode; LANES], h).of_lane(0)
        } else {
            by_quadrature(mode, h)
        }
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

/// The rates of a mode: to a unit rate, and to unit Legendre forces.
const RATES: usize = 1 + Q;

/// Power series of the rates at the `M` nodes of a Gauss rule on (0, 1).
struct Series<const M: usize> {
    weights: [f64; M],
    /// `[i][p]`: `x^p/p!`, then `int_0^x (x-s)^p/p! P_n(2s-1) ds`.
    powers: [Vec<[f64; M]>; RATES],
}

impl<const M: usize> Series<M> {
    fn new() -> Series<M> {
        let rule = rule(const { NonZeroUsize::new(M).unwrap() });
        let mut powers: [_; RATES] = array::from_fn(|_| vec![[0.0; M]; SERIES]);
        for (q, &(x, _)) in rule.iter().enumerate() {
            let [by_rate, by_force @ ..] = &mut powers;
            let mut power = 1.0;
            for (p, at) in by_rate.iter_mut().enumerate() {
                at[q] = power;
                power *= x / (p + 1) as f64;
            }
            for &(y, w) in &BASIS.fine {
                let mut kernel = w * x;
                for p in 0..SERIES {
                    for (row, value) in by_force.iter_mut().zip(legendre(x * y)) {
                        row[p][q] += kernel * value;
                    }
                    kernel *= x * (1.0 - y) / (p + 1) as f64;
                }
            }
        }
        Series { weights: array::from_fn(|q| rule[q].1), powers }
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

        let mut rates = [[0.0; M]; RATES];
        for (values, powers) in rates.iter_mut().zip(&self.powers) {
            for (derivative, power) in derivatives[..terms].iter().zip(powers) {
                for q in 0..M {
                    values[q] += derivative * power[q];
                }
            }
        }
        let mut means = [[0.0; RATES]; RATES];
        for n in 0..RATES {
            let weighted: [f64; M] = array::from_fn(|q| self.weights[q] * rates[n][q]);
            for m in 0..=n {
                [means[n][m]] = sum_over(
                    [&weighted, &rates[m]],
                    #[inline(always)]
                    |[one, other]| [one * other],
                );
            }
        }
        let mut form = Form { bb: means[0][0], ..Form::NONE };
        for n in 0..Q {
            form.bq[n] = means[n + 1][0];
            form.qq[n].copy_from_slice(&means[n + 1][1..]);
        }
        form.scaled(mode, h)
    }
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

impl Form<Lanes> {
    #[inline(always)]
    pub fn of_lane(&self, l: usize) -> Form {
        Form {
            bb: self.bb.0[l],
            bq: self.bq.map(|value| value.0[l]),
            qq: self.qq.map(|row| row.map(|value| value.0[l])),
        }
    }
}

/// Modes for which [`all_by_parts`] holds.
#[inline(always)]
pub(crate) fn by_parts(modes: &[BodyMode; LANES], h: f64) -> Form<Lanes> {
    let sigma = Lanes::of(|l| modes[l].damping_ratio * modes[l].omega_rad_s);
    let omega_d =
        Lanes::of(|l| modes[l].omega_rad_s * ((1.0 - modes[l].damping_ratio) * (1.0 + modes[l].damping_ratio)).sqrt());
    let z = |l: usize| Complex64::new(-sigma.0[l], omega_d.0[l]) * h;
    let inverse = ComplexLanes::of(|l| z(l).inv());
    // the rate is Re(c e^{z x}) with this c
    let scale = ComplexLanes { re: Lanes([1.0; LANES]), im: Lanes::of(|l| sigma.0[l] / omega_d.0[l]) };

    // Q_n = sum_k P_n^(k)/z^(k+1) by Legendre coefficients: v_n/h = Re(scale (e^{z x} Q_n(0) - Q_n(x)))
    let mut sums = [[ComplexLanes::ZERO; Q]; Q];
    sums[0][0] = inverse;
    (sums[1][0], sums[1][1]) = (inverse * 2.0 * inverse, inverse);
    for n in 1..Q - 1 {
        let factor = inverse * (4 * n + 2) as f64;
        for d in 0..=n {
            sums[n + 1][d] = sums[n - 1][d] + factor * sums[n][d];
        }
        sums[n + 1][n + 1] = inverse;
        sums[n + 1][n - 1] = sums[n + 1][n - 1] - inverse;
    }

    // means of P_d e^{z x}, of e^{2 z x} and of |e^{z x}|^2
    let whole = ComplexLanes::of(|l| z(l).exp());
    let (mut at_start, mut moments) = ([ComplexLanes::ZERO; Q], [ComplexLanes::ZERO; Q]);
    for n in 0..Q {
        let mut at_end = ComplexLanes::ZERO;
        for (d, value) in sums[n].iter().enumerate().take(n + 1) {
            at_end = at_end + *value;
            at_start[n] = if d % 2 == 0 { at_start[n] + *value } else { at_start[n] - *value };
        }
        let moment = whole * at_start[n] - at_end;
        moments[n] = if n % 2 == 0 { moment } else { ComplexLanes::ZERO - moment };
    }
    let one = ComplexLanes { re: Lanes([1.0; LANES]), im: Lanes::ZERO };
    let turned = (whole * whole - one) * 0.5 * inverse;
    let decayed = Lanes::of(|l| {
        let decay = 2.0 * sigma.0[l] * h;
        if decay < 1e-17 { 1.0 } else { -(-decay).exp_m1() / decay }
    });

    // each rate is a polynomial, by Legendre coefficients, and Re(c e^{z x}): the mean of a product is bilinear in the
    // coefficients, c, and the mean m of the polynomial times e^{z x}
    let left = |c: ComplexLanes, m: ComplexLanes| [m.re, m.im, c.re, c.im];
    let right = |c: ComplexLanes, m: ComplexLanes| {
        let turned = m + c * 0.5 * turned;
        let half = decayed * 0.5;
        [c.re, -c.im, turned.re + half * c.re, half * c.im - turned.im]
    };
    let product = |one: &[Lanes; 4], other: &[Lanes; 4]| {
        (one[0] * other[0] + one[1] * other[1]) + (one[2] * other[2] + one[3] * other[3])
    };
    let by_rate = left(scale, ComplexLanes::ZERO);
    let mut polynomials = [[Lanes::ZERO; Q]; Q];
    let mut others = [[Lanes::ZERO; 4]; Q];
    let mut form = Form { bb: Lanes::ZERO, bq: [Lanes::ZERO; Q], qq: [[Lanes::ZERO; Q]; Q] };
    // from a mean over the panel of products of rates, those to forces divided by h, to the loss
    let loss = sigma * (2.0 * h);
    for n in 0..Q {
        let c = scale * at_start[n];
        let mut m = ComplexLanes::ZERO;
        for d in 0..=n {
            polynomials[n][d] = scale.im * sums[n][d].im - scale.re * sums[n][d].re;
            m = m + moments[d] * polynomials[n][d];
        }
        others[n] = right(c, m);
        let row = left(c, m);
        let mut weighted = [Lanes::ZERO; Q];
        for d in 0..=n {
            weighted[d] = polynomials[n][d] * (1.0 / (2 * d + 1) as f64);
        }
        for k in 0..=n {
            let mut sum = product(&row, &others[k]);
            for d in 0..=k {
                sum = sum + weighted[d] * polynomials[k][d];
            }
            form.qq[n][k] = sum * loss * (h * h);
        }
        form.bq[n] = product(&by_rate, &others[n]) * loss * h;
    }
    form.bb = product(&by_rate, &right(scale, ComplexLanes::ZERO)) * loss;
    form
}

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
