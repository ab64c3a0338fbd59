//! Work of contacts by modes that turn fast on a panel.
//!
//! The balance integrates the work `int F xi' dt` of a contact by parts and by Gauss quadrature of its overlap
//! ([`work_of_unit_forces`]), which is exact for polynomials of degree 9. The motion of a mode that turns by more than [`FAST`] on
//! the panel is no such polynomial. This file adds the difference between its exact work and the quadrature.
//!
//! # Exact work
//! Let `A_n` and `B_n` be the amplitude and the rate of a mode at the end under the force `P_n`, `S` its impulse response, and
//! `a` and `b` its amplitude and rate at the start. Its free rate is `b S' - omega^2 a S`, and reflection of the panel gives
//! `int P_n S dt = (-1)^n A_n` and `int P_n S' dt = (-1)^n B_n`. Forces that act on the mode from rest perform the work
//! `((sum g_n B_n)^2 + omega^2 (sum g_n A_n)^2)/2` and that which damping dissipates (`damping.rs`).

use super::system::{Link, System};
use crate::panel::legendre::{Legendre, Matrix, Nodal, Q, add_motion, apply, dot, work_of_unit_forces};
use crate::panel::vector::vectorized;
use std::ops::Range;
use std::sync::OnceLock;

/// The work of a mode that turns by at most this much on a panel (rad) is integrated to rounding.
const FAST: f64 = 1.0;

/// The difference of all fast modes for one panel length.
pub(crate) struct Excess {
    h: f64,
    /// Work of a mode by `a P_n` and `b P_n`, exact less quadrature; zero for slow modes.
    by_motion: Vec<(Nodal, Nodal)>,
    /// `[c][c']`, where requested and `c' <= c`: work of `F_n` and `F'_m`, exact less quadrature, both orders together.
    pairs: Vec<OnceLock<Box<Matrix>>>,
}

/// A mode on a panel.
pub(crate) struct OnPanel {
    /// Increase of its amplitude by free motion up to the nodes and the end, from amplitude and from rate.
    pub at_nodes: (Nodal, Nodal),
    pub at_end: (f64, f64),
    pub pushed: Pushed,
}

/// Amplitude and rate of a mode at the end of a panel, under unit Legendre forces.
pub(crate) struct Pushed {
    pub amplitude: Nodal,
    pub rate: Nodal,
}

impl Excess {
    /// The difference for a panel of `h`, on which the modes have these motions.
    pub fn new(system: &System, h: f64, modes: impl Iterator<Item = OnPanel>) -> Excess {
        let mut by_motion = Vec::with_capacity(system.modes.len());
        vectorized(
            #[inline(always)]
            || {
                for (k, mode) in modes.enumerate() {
                    if !is_fast(system, h, k) {
                        by_motion.push(([0.0; Q], [0.0; Q]));
                        continue;
                    }
                    let OnPanel { at_nodes, at_end, pushed } = mode;
                    let mut by_amplitude = work_of_unit_forces(&at_nodes.0, at_end.0);
                    let mut by_rate = work_of_unit_forces(&at_nodes.1, at_end.1);
                    for n in 0..Q {
                        let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
                        by_amplitude[n] = -sign * system.square[k] * pushed.amplitude[n] - by_amplitude[n];
                        by_rate[n] = sign * pushed.rate[n] - by_rate[n];
                    }
                    by_motion.push((by_amplitude, by_rate));
                }
            },
        );
        let pairs = std::iter::repeat_with(OnceLock::new).take(system.links.len().pow(2)).collect();
        Excess { h, by_motion, pairs }
    }

    /// Whether the work of two contacts, the second not after the first, has been computed.
    pub fn knows(&self, system: &System, (c, other): (usize, usize)) -> bool {
        self.pairs[c * system.links.len() + other].get().is_some()
    }

    /// Computes the work of two contacts, the second not after the first, unless it is known: from the responses of all elastic
    /// modes, the loss by damping, and the quadrature of both orders, by columns.
    pub fn prepare(
        &self,
        system: &System,
        (c, other): (usize, usize),
        pushed: impl Fn(usize) -> Pushed,
        lost: Option<&Matrix>,
        by_quadrature: [&Matrix; 2],
    ) {
        self.pairs[c * system.links.len() + other].get_or_init(|| {
            let mut work = Box::new([[0.0; Q]; Q]);
            let shared = system.links[c].shared(&system.links[other]);
            vectorized(
                #[inline(always)]
                || {
                    for (k, weight) in shared.filter(|(k, weight)| *weight != 0.0 && !system.modes[*k].is_rigid()) {
                        let Pushed { amplitude, rate } = pushed(k);
                        let (by_amplitude, by_rate) = (0.5 * weight * system.square[k], 0.5 * weight);
                        for m in 0..Q {
                            let (by_amplitude, by_rate) = (by_amplitude * amplitude[m], by_rate * rate[m]);
                            for n in 0..Q {
                                work[m][n] -= by_amplitude * amplitude[n] + by_rate * rate[n];
                            }
                        }
                    }
                },
            );
            for m in 0..Q {
                for n in 0..Q {
                    work[m][n] -= lost.map_or(0.0, |lost| lost[m][n]);
                    work[m][n] -= 0.5 * (by_quadrature[0][m][n] + by_quadrature[1][n][m]);
                    work[m][n] *= if c == other { 1.0 } else { 2.0 };
                }
            }
            work
        });
    }

    /// Work of the contacts that the quadrature misses (J). Needs [`Excess::prepare`].
    pub fn work_j(
        &self,
        system: &System,
        (amplitude, rate): (&[f64], &[f64]),
        contacts: &[usize],
        force: &[Legendre],
    ) -> f64 {
        let mut work = 0.0;
        for (i, &c) in contacts.iter().enumerate() {
            work += dot(&self.of_motion(system, &system.links[c], amplitude, rate), &force[i].0);
            for (j, &other) in contacts[..=i].iter().enumerate() {
                if let Some(pair) = self.pairs[c * system.links.len() + other].get() {
                    work += dot(&force[i].0, &apply(pair, &force[j].0));
                }
            }
        }
        work
    }

    /// Work of unit Legendre forces of a contact over the free motion.
    fn of_motion(&self, system: &System, link: &Link, amplitude: &[f64], rate: &[f64]) -> Nodal {
        vectorized(
            #[inline(always)]
            || {
                let mut work = [0.0; Q];
                for span in &link.spans {
                    let fast = fast(system, self.h, &span.modes);
                    let psi = &span.psi[fast.start - span.modes.start..];
                    let motion = (&amplitude[fast.clone()], &rate[fast.clone()]);
                    add_motion(&mut work, &self.by_motion[fast], psi, motion);
                }
                work
            },
        )
    }
}

fn is_fast(system: &System, h: f64, k: usize) -> bool {
    system.turning[k] * h > FAST
}

/// The modes of a body that are fast on a panel of `h`.
fn fast(system: &System, h: f64, body: &Range<usize>) -> Range<usize> {
    let slow = system.turning[body.clone()].partition_point(|turning| turning * h <= FAST);
    body.start + slow..body.end
}

/// Whether a mode that moves one of these contacts is fast on a panel of `h`.
pub(crate) fn has_fast_modes(system: &System, h: f64, contacts: &[usize]) -> bool {
    let mut bodies = contacts.iter().flat_map(|&c| &system.links[c].spans);
    bodies.any(|span| !fast(system, h, &span.modes).is_empty())
}
