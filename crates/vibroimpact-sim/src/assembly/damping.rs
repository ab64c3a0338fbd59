//! Energy that all modes dissipate by modal damping within a panel.
//!
//! For one mode it is a quadratic form of its state at the start and of the Legendre coefficients of its force
//! (`damping_form.rs`). A contact excites all modes of a body by the same polynomial, `g_nk = -psi_k F_n`. The part quadratic
//! in the force is therefore summed over the modes only once, and a panel takes a few operations for each mode.

use super::damping_form::{COARSE, COARSE_NODES, Form, Series, TERMS};
use super::system::{Link, System};
use crate::panel::dyadic::step_s;
use crate::panel::legendre::{Legendre, Matrix, Nodal, Q, apply, dot};
use crate::panel::vector::vectorized;
use std::array;
use std::ops::Range;
use std::sync::OnceLock;

/// The quadratic forms of all modes for one step exponent.
pub(crate) struct Damping {
    by_mode: OnceLock<ByMode>,
    /// `[c][c']`, where requested: loss by `F_n F'_m`, summed over the modes.
    pairs: Vec<OnceLock<Box<Matrix>>>,
}

/// Mode by mode.
struct ByMode {
    /// Loss by `a^2`, `a b` and `b^2`.
    free: Vec<[f64; 3]>,
    /// Loss by `a g_n` and `b g_n`.
    cross: Vec<(Nodal, Nodal)>,
}

impl Damping {
    pub fn new(system: &System) -> Damping {
        let pairs = std::iter::repeat_with(OnceLock::new).take(system.links.len().pow(2)).collect();
        Damping { by_mode: OnceLock::new(), pairs }
    }

    /// Computes everything for the step exponent `j` and these contacts that is not cached yet.
    pub fn prepare(&self, system: &System, j: i32, contacts: &[usize]) {
        let mut missing: Vec<(usize, Vec<f64>, Box<Matrix>)> = Vec::new();
        for (i, &c) in contacts.iter().enumerate() {
            for &other in contacts[..=i].iter().filter(|other| system.neighbours[c].contains(other)) {
                let place = c * system.links.len() + other;
                if self.pairs[place].get().is_none() {
                    let mut weights = vec![0.0; system.modes.len()];
                    system.links[c].shared(&system.links[other]).for_each(|(k, weight)| weights[k] = weight);
                    missing.push((place, weights, Box::new([[0.0; Q]; Q])));
                }
            }
        }
        if missing.is_empty() {
            return;
        }
        let (mut free, mut cross) = (Vec::with_capacity(system.modes.len()), Vec::with_capacity(system.modes.len()));
        vectorized(
            #[inline(always)]
            || {
                for (k, mode) in system.modes.iter().enumerate() {
                    let Form { bb, bq, qq } = Form::of(mode, step_s(j));
                    let square = system.square[k];
                    free.push([square * square * qq[0][0], -2.0 * square * bq[0], bb]);
                    cross.push((qq[0].map(|value| -2.0 * square * value), bq.map(|value| 2.0 * value)));
                    for (_, weights, sum) in missing.iter_mut().filter(|(_, weights, _)| weights[k] != 0.0) {
                        for n in 0..Q {
                            for m in 0..Q {
                                sum[n][m] += weights[k] * qq[n][m];
                            }
                        }
                    }
                }
            },
        );
        // another thread may have been first; its result is the same
        let _ = self.by_mode.set(ByMode { free, cross });
        for (place, _, sum) in missing {
            let _ = self.pairs[place].set(sum);
        }
    }

    /// Energy that these bodies lose to damping within a panel (J). Needs [`Damping::prepare`].
    pub fn lost(
        &self,
        system: &System,
        damped: &[Range<usize>],
        (amplitude, rate): (&[f64], &[f64]),
        contacts: &[usize],
        force: &[Legendre],
    ) -> f64 {
        let mut lost = 0.0;
        let Some(ByMode { free, cross }) = self.by_mode.get() else { return lost };
        for body in damped {
            let motion = amplitude[body.clone()].iter().zip(&rate[body.clone()]);
            for ([aa, ab, bb], (a, b)) in free[body.clone()].iter().zip(motion) {
                lost += (aa * a + ab * b) * a + bb * b * b;
            }
        }
        for (i, &c) in contacts.iter().enumerate() {
            let mut by_motion = [0.0; Q];
            for span in system.links[c].spans.iter().filter(|span| damped.contains(&span.modes)) {
                let motion = amplitude[span.modes.clone()].iter().zip(&rate[span.modes.clone()]);
                let table = cross[span.modes.clone()].iter();
                for (((from_a, from_b), psi), (a, b)) in table.zip(&span.psi).zip(motion) {
                    let (a, b) = (psi * a, psi * b);
                    for n in 0..Q {
                        by_motion[n] += from_a[n] * a + from_b[n] * b;
                    }
                }
            }
            lost -= dot(&by_motion, &force[i].0);
            for (j, &other) in contacts[..=i].iter().enumerate() {
                if let Some(pair) = self.pairs[c * system.links.len() + other].get() {
                    let twice = if j < i { 2.0 } else { 1.0 };
                    lost += twice * dot(&force[i].0, &apply(pair, &force[j].0));
                }
            }
        }
        lost
    }
}

/// Energy that damping takes from these bodies within a panel of any length on which no mode turns by more than a radian (J).
pub(crate) fn lost_within(
    system: &System,
    damped: &[Range<usize>],
    h: f64,
    (amplitude, rate): (&[f64], &[f64]),
    contacts: &[usize],
    force: &[Legendre],
) -> f64 {
    let rule = &*COARSE;
    // effect of a contact force on a mode of unit weight, term by term
    let push = |Legendre(force): &Legendre| -> Vec<[f64; COARSE_NODES]> {
        let term = |rows: &[[f64; COARSE_NODES]; Q]| array::from_fn(|q| (0..Q).map(|n| rows[n][q] * force[n]).sum());
        rule.forced.iter().take(TERMS).map(term).collect()
    };
    let pushes: Vec<(&Link, Vec<_>)> =
        contacts.iter().zip(force).map(|(c, force)| (&system.links[*c], push(force))).collect();
    let mut lost = 0.0;
    for body in damped {
        let on_body = |(link, push): &(&Link, Vec<_>)| {
            let span = link.spans.iter().position(|span| span.modes == *body)?;
            Some((link.spans[span].psi.clone(), push.clone()))
        };
        let here: Vec<(Vec<f64>, Vec<[f64; COARSE_NODES]>)> = pushes.iter().filter_map(on_body).collect();
        for k in body.clone() {
            let mode = &system.modes[k];
            let drag = system.drag[k];
            if drag == 0.0 {
                continue;
            }
            let (held, b) = (h * system.square[k] * amplitude[k], rate[k]);
            let mut values = [0.0; COARSE_NODES];
            for (p, derivative) in Series::<COARSE_NODES>::derivatives(mode, h).take(TERMS).enumerate() {
                // a constant force enters with the next power, a rate with this one
                let (powers, next) = (&rule.powers[p], &rule.powers[p + 1]);
                for q in 0..COARSE_NODES {
                    values[q] += derivative * (b * powers[q] - held * next[q]);
                }
                for (psi, push) in &here {
                    let scale = derivative * h * psi[k - body.start];
                    for q in 0..COARSE_NODES {
                        values[q] -= scale * push[p][q];
                    }
                }
            }
            let square: f64 = rule.weights.iter().zip(&values).map(|(w, value)| w * value * value).sum();
            lost += drag * h * square;
        }
    }
    lost
}
