//! Energy that all modes dissipate by modal damping within a panel.
//!
//! For one mode it is a quadratic form of its state at the start and of the Legendre coefficients of its force
//! (`damping_form.rs`). A contact excites all modes of a body by the same polynomial, `g_nk = -psi_k F_n`. The part quadratic
//! in the force is therefore summed over the modes only once, and a panel takes a few operations for each mode.

use super::damping_form::{ByParts, Form, OfState, Polynomials, add_polynomials, all_by_parts};
use super::system::System;
use crate::panel::lanes::Lanes;
use crate::panel::legendre::{Legendre, Matrix, Nodal, Q, add_motion, apply, dot};
use crate::panel::vector::{LANES, sum_of_lanes, sum_over, vectorized};
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
    /// Loss by `a^2`, by `a b`, and by `b^2`.
    free: [Vec<f64>; 3],
    /// Loss by `a g_n` and `b g_n`.
    cross: Vec<(Nodal, Nodal)>,
}

impl ByMode {
    /// Adds the next mode, with the square of its frequency.
    #[inline(always)]
    fn push(&mut self, square: f64, OfState { bb, bq, q0 }: &OfState) {
        let mut from_a = [0.0; Q];
        let mut from_b = [0.0; Q];
        for n in 0..Q {
            (from_a[n], from_b[n]) = (-2.0 * square * q0[n], 2.0 * bq[n]);
        }
        self.free[0].push(square * square * q0[0]);
        self.free[1].push(-2.0 * square * bq[0]);
        self.free[2].push(*bb);
        self.cross.push((from_a, from_b));
    }
}

/// Loss by the forces of two contacts, as it is summed over the modes.
struct Sum {
    /// In the list of pairs.
    place: usize,
    /// Of each mode.
    weights: Vec<f64>,
    /// The lower half, of modes taken one by one and of those taken [`LANES`] at a time.
    alone: Matrix,
    vibrating: [[Lanes; Q]; Q],
    polynomials: Polynomials<Lanes>,
}

impl Sum {
    fn new(place: usize, weights: Vec<f64>) -> Sum {
        let [vibrating, polynomials] = [[[Lanes::ZERO; Q]; Q]; 2];
        Sum { place, weights, alone: [[0.0; Q]; Q], vibrating, polynomials }
    }

    #[inline(always)]
    fn add(&mut self, weight: f64, qq: &Matrix) {
        for n in 0..Q {
            for m in 0..=n {
                self.alone[n][m] += weight * qq[n][m];
            }
        }
    }

    #[inline(always)]
    fn add_by_parts(&mut self, weights: Lanes, modes: &ByParts) {
        for n in 0..Q {
            for m in 0..=n {
                self.vibrating[n][m] = self.vibrating[n][m] + weights * modes.vibrating[n][m];
            }
        }
        modes.add_polynomials(weights, &mut self.polynomials);
    }

    /// The whole matrix.
    fn total(&self) -> Matrix {
        let mut lower: Matrix =
            array::from_fn(|n| array::from_fn(|m| self.alone[n][m] + sum_of_lanes(self.vibrating[n][m].0)));
        if self.polynomials != [[Lanes::ZERO; Q]; Q] {
            add_polynomials(&mut lower, &self.polynomials.map(|row| row.map(|lanes| sum_of_lanes(lanes.0))));
        }
        array::from_fn(|n| array::from_fn(|m| lower[n.max(m)][n.min(m)]))
    }
}

impl Damping {
    pub fn new(system: &System) -> Damping {
        let pairs = std::iter::repeat_with(OnceLock::new).take(system.links.len().pow(2)).collect();
        Damping { by_mode: OnceLock::new(), pairs }
    }

    /// Computes everything for the step exponent `j` and these contacts that is not cached yet.
    pub fn prepare(&self, system: &System, h: f64, contacts: &[usize]) {
        let mut missing: Vec<Sum> = Vec::new();
        for (i, &c) in contacts.iter().enumerate() {
            for &other in contacts[..=i].iter().filter(|other| system.neighbours[c].contains(other)) {
                let place = c * system.links.len() + other;
                if self.pairs[place].get().is_none() {
                    let mut weights = vec![0.0; system.modes.len()];
                    system.links[c].shared(&system.links[other]).for_each(|(k, weight)| weights[k] = weight);
                    missing.push(Sum::new(place, weights));
                }
            }
        }
        if missing.is_empty() {
            return;
        }
        let count = system.modes.len();
        let mut by_mode = ByMode { free: [0; 3].map(|_| Vec::with_capacity(count)), cross: Vec::with_capacity(count) };
        vectorized(
            #[inline(always)]
            || {
                for (block, modes) in system.modes.chunks(LANES).enumerate() {
                    let first = block * LANES;
                    if all_by_parts(modes, h) {
                        // the last modes are padded by modes without weight
                        let mut padded = [modes[0]; LANES];
                        padded[..modes.len()].copy_from_slice(modes);
                        let by_parts = ByParts::new(&padded, h);
                        for (l, square) in system.square[first..][..modes.len()].iter().enumerate() {
                            by_mode.push(*square, &by_parts.of_state(l));
                        }
                        for sum in &mut missing {
                            let mut weights = Lanes::ZERO;
                            weights.0[..modes.len()].copy_from_slice(&sum.weights[first..][..modes.len()]);
                            sum.add_by_parts(weights, &by_parts);
                        }
                    } else {
                        for (l, mode) in modes.iter().enumerate() {
                            let form = Form::of(mode, h);
                            by_mode.push(system.square[first + l], &form.of_state());
                            missing.iter_mut().for_each(|sum| sum.add(sum.weights[first + l], &form.qq));
                        }
                    }
                }
            },
        );
        // another thread may have been first; its result is the same
        let _ = self.by_mode.set(by_mode);
        for sum in missing {
            let _ = self.pairs[sum.place].set(Box::new(sum.total()));
        }
    }

    /// Loss by `F_n F'_m` of two contacts, the second not after the first. Needs [`Damping::prepare`].
    pub fn of_pair(&self, system: &System, c: usize, other: usize) -> Option<&Matrix> {
        self.pairs[c * system.links.len() + other].get().map(|pair| &**pair)
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
        let Some(ByMode { free, cross }) = self.by_mode.get() else { return 0.0 };
        vectorized(
            #[inline(always)]
            || {
                let mut lost = 0.0;
                for body in damped {
                    let [aa, ab, bb] = free.each_ref().map(|row| &row[body.clone()]);
                    let [by_body] = sum_over(
                        [aa, ab, bb, &amplitude[body.clone()], &rate[body.clone()]],
                        #[inline(always)]
                        |[aa, ab, bb, a, b]| [(aa * a + ab * b) * a + bb * b * b],
                    );
                    lost += by_body;
                }
                for (i, &c) in contacts.iter().enumerate() {
                    let mut by_motion = [0.0; Q];
                    for span in system.links[c].spans.iter().filter(|span| damped.contains(&span.modes)) {
                        let motion = (&amplitude[span.modes.clone()], &rate[span.modes.clone()]);
                        add_motion(&mut by_motion, &cross[span.modes.clone()], &span.psi, motion);
                    }
                    lost -= dot(&by_motion, &force[i].0);
                    for (j, &other) in contacts[..=i].iter().enumerate() {
                        if let Some(pair) = self.of_pair(system, c, other) {
                            let twice = if j < i { 2.0 } else { 1.0 };
                            lost += twice * dot(&force[i].0, &apply(pair, &force[j].0));
                        }
                    }
                }
                lost
            },
        )
    }
}
