//! Energy that modes lose to modal damping within a short panel of any length, by the power series of their motion.
//!
//! On a panel of `h`, with `x = t/h` and the force `g = sum g_p x^p` on a mode, its displacement `sum A_p x^p` and its rate
//! `sum B_p x^p` follow from those at the start:
//!
//! ```text
//! (p+1) A_{p+1} = h B_p,   (p+1) B_{p+1} = h (g_p - 2 zeta omega B_p - omega^2 A_p)
//! ```
//!
//! The loss `2 zeta omega h int B^2 dx` is found by Gauss quadrature. No mode of a short panel turns by more
//! than [`REACH`](super::terminal::REACH) rad.

use super::system::System;
use crate::panel::forcing::rate;
use crate::panel::lanes::Lanes;
use crate::panel::legendre::{BASIS, Legendre, Nodal, Q, RECIPROCAL, SERIES, rule};
use crate::panel::vector::{LANES, sum_of_lanes, vectorized};
use std::array;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::LazyLock;

const NODES: usize = 13;
/// Largest number of terms: those of free motion, after those of the force.
const TERMS: usize = SERIES;

static GAUSS: LazyLock<[(f64, f64); NODES]> = LazyLock::new(|| {
    let rule = rule(const { NonZeroUsize::new(NODES).unwrap() });
    array::from_fn(|i| rule[i])
});

/// `[n][p]`: coefficients of the powers of `x` in `P_n(2x-1)`, `(-1)^(n+p) (n+p)! / ((n-p)! p!^2)`.
const POWERS: [[f64; Q]; Q] = {
    let mut table = [[0.0; Q]; Q];
    let mut n = 0;
    while n < Q {
        let mut value = if n % 2 == 0 { 1.0 } else { -1.0 };
        let mut p = 0;
        while p <= n {
            table[n][p] = value;
            value *= -((n + p + 1) as f64 * (n - p) as f64) / ((p + 1) * (p + 1)) as f64;
            p += 1;
        }
        n += 1;
    }
    table
};

/// Energy that these bodies lose to damping within a short panel of `h` (J).
pub(crate) fn lost_within(
    system: &System,
    damped: &[Range<usize>],
    h: f64,
    (amplitude, rates): (&[f64], &[f64]),
    contacts: &[usize],
    force: &[Legendre],
) -> f64 {
    let powers = |Legendre(force): &Legendre| -> Nodal {
        array::from_fn(|p| force.iter().zip(&POWERS).map(|(force, row)| force * row[p]).sum())
    };
    let forces: Vec<Nodal> = force.iter().map(powers).collect();
    let mut lost = 0.0;
    for body in damped {
        let on_body = |(c, force): (&usize, &Nodal)| Some((system.links[*c].span(body)?.psi.as_slice(), *force));
        let pushes: Vec<(&[f64], Nodal)> = contacts.iter().zip(&forces).filter_map(on_body).collect();
        vectorized(
            #[inline(always)]
            || {
                for first in body.clone().step_by(LANES) {
                    let mut turned = 0.0f64;
                    let mut here = Motion::NONE;
                    for (l, k) in (first..body.end).take(LANES).enumerate() {
                        turned = turned.max(rate(&system.modes[k]) * h);
                        here.square.0[l] = system.square[k] * h;
                        here.drag.0[l] = system.drag[k] * h;
                        (here.amplitude.0[l], here.rate.0[l]) = (amplitude[k], rates[k]);
                        for (psi, force) in &pushes {
                            for p in 0..Q {
                                here.force[p].0[l] -= h * psi[k - body.start] * force[p];
                            }
                        }
                    }
                    let terms = (BASIS.terms::<SERIES>(turned, 2) + Q).min(TERMS);
                    let series = here.rates(h, terms);
                    let series = &series[..terms];
                    lost += sum_of_lanes((here.drag * mean_square(series)).0);
                }
            },
        );
    }
    lost
}

/// Some modes at the start of a panel of `h`.
struct Motion {
    /// `omega^2 h` and `2 zeta omega h`.
    square: Lanes,
    drag: Lanes,
    amplitude: Lanes,
    rate: Lanes,
    /// `h g_p`.
    force: [Lanes; Q],
}

impl Motion {
    const NONE: Motion = Motion {
        square: Lanes::ZERO,
        drag: Lanes::ZERO,
        amplitude: Lanes::ZERO,
        rate: Lanes::ZERO,
        force: [Lanes::ZERO; Q],
    };

    /// The first terms of the power series of the rates.
    #[inline(always)]
    fn rates(&self, h: f64, terms: usize) -> [Lanes; TERMS] {
        let mut series = [Lanes::ZERO; TERMS];
        let (mut a, mut b) = (self.amplitude, self.rate);
        for p in 0..terms {
            series[p] = b;
            let pull = self.drag * b + self.square * a;
            let push = if p < Q { self.force[p] - pull } else { -pull };
            (a, b) = (b * (h * RECIPROCAL[p + 1]), push * RECIPROCAL[p + 1]);
        }
        series
    }
}

/// Mean over the panel of the square of a power series, mode by mode.
#[inline(always)]
fn mean_square(series: &[Lanes]) -> Lanes {
    let mut mean = Lanes::ZERO;
    for &(x, weight) in &*GAUSS {
        let mut value = Lanes::ZERO;
        for term in series.iter().rev() {
            value = value * x + *term;
        }
        mean = mean + value * value * weight;
    }
    mean
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::damping_form::{Form, reference};
    use crate::assembly::terminal::REACH;
    use crate::assembly::{Assembly, Body, BodyMode, Contact, Point};

    const WEIGHT: f64 = 0.7;

    /// A body of one mode with a contact.
    fn system(mode: BodyMode) -> System {
        let body = Body { modes: vec![mode], amplitude: vec![0.0], rate: vec![0.0] };
        let side = Point::OfBody { body: 0, shape: vec![-WEIGHT] };
        let contacts = vec![Contact { sides: [side, Point::Ground], gap_m: 0.0, law: () }];
        System::new(&Assembly { bodies: vec![body], contacts, loads: Vec::new() }.with_laws(Vec::new()))
    }

    /// The same loss by the quadratic form.
    fn by_form(Form { bb, bq, qq }: &Form, square: f64, [a, b]: [f64; 2], force: &Nodal) -> f64 {
        let mut q = force.map(|force| -WEIGHT * force);
        q[0] -= square * a;
        let products = |n: usize| (0..Q).map(|m| qq[n.max(m)][n.min(m)] * q[n] * q[m]).sum::<f64>();
        bb * b * b + (0..Q).map(|n| 2.0 * b * bq[n] * q[n] + products(n)).sum::<f64>()
    }

    #[test]
    fn modes_lose_the_integral_of_their_squared_rate() {
        let h = 1e-3;
        for zeta in [1e-3, 0.02, 0.6, 0.98, 0.995, 1.0, 1.3, 20.0] {
            for turned in [1e-3, 0.3, REACH] {
                let unit = BodyMode { omega_rad_s: 1.0, damping_ratio: zeta };
                let mode = BodyMode { omega_rad_s: turned / h / rate(&unit), ..unit };
                let (system, form) = (system(mode), reference(&mode, h));
                let close = |motion: [f64; 2], force: Nodal| {
                    let (amplitude, rate) = ([motion[0]], [motion[1]]);
                    let force_of = [Legendre(force)];
                    let found = lost_within(&system, &system.bodies, h, (&amplitude, &rate), &[0], &force_of);
                    let known = by_form(&form, system.square[0], motion, &force);
                    let unit = by_form(&form, system.square[0], [0.0, 0.0], &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
                    let error = (found - known).abs() / known.abs().max(unit);
                    // the powers of a polynomial of high degree cancel
                    assert!(error < 1e-12, "zeta {zeta}, turned {turned}, {motion:?}, {force:?}: {found:e}, {known:e}");
                };
                close([1.0 / system.square[0], 0.0], [0.0; Q]);
                close([0.0, h], [0.0; Q]);
                for n in 0..Q {
                    close([0.0, 0.0], array::from_fn(|i| if i == n { 1.0 } else { 0.0 }));
                }
                close([-0.3 / system.square[0], 0.5 * h], array::from_fn(|n| 0.7 - 0.2 * n as f64));
            }
        }
    }
}
