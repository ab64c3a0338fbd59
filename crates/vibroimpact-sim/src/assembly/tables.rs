//! Tables of panels `h = 2^-j` units of time: free motion and forced response of every mode, and the response of every contact to
//! the force of another. They do not depend on the masses of rigid bodies. Each table is computed at first use and never changes,
//! so that runs and threads can share it and have the same results.

use super::damping::Damping;
use super::excess::{Excess, OnPanel, has_fast_modes};
use super::forced::{Forced, Over, Response, again};
use super::interpolation::Missed;
use super::system::{Link, Span, System};
use crate::panel::dyadic::{Levels, Rotation, Steps};
use crate::panel::forcing::{ByParts, Order};
use crate::panel::legendre::{Legendre, Matrix, Nodal, Q, TAYLOR, leave_out_infinite};
use crate::panel::vector::{sum_over, vectorized};
use std::sync::OnceLock;

/// Free motion and forced responses on panels of one step exponent, with the responses of pairs of contacts.
struct Expanded {
    forced: Forced,
    /// `[c][c']`, where requested: the response of the elastic modes, for contacts that share some, and its rate at the nodes
    /// (m/(N s)).
    elastic: Vec<OnceLock<Box<Response>>>,
    elastic_rates: Vec<OnceLock<Box<Matrix>>>,
    /// The modes that are integrated by parts, once responses with other weights are requested.
    by_parts: OnceLock<Vec<ByParts>>,
}

#[derive(Default)]
struct Level {
    rotation: OnceLock<Rotation>,
    expanded: OnceLock<Expanded>,
    damping: OnceLock<Damping>,
    excess: OnceLock<Excess>,
    missed: OnceLock<Missed>,
}

pub(crate) struct Tables {
    /// Lengths of the panels.
    pub steps: Steps,
    levels: Levels<Level>,
    /// Derivatives at zero of the elastic modes' response of contact `c` to an impulse of contact `c'`, where requested.
    kernels: Vec<OnceLock<[f64; TAYLOR]>>,
    contacts: usize,
}

impl Tables {
    pub fn new(system: &System, steps: Steps) -> Tables {
        let contacts = system.links.len();
        Tables { steps, levels: Levels::default(), kernels: unset(contacts), contacts }
    }

    /// Free motion over one panel with the step exponent `j`.
    pub fn rotation(&self, system: &System, j: i32) -> &Rotation {
        self.level(j).rotation.get_or_init(|| Rotation::new(&system.modes, self.steps.step_s(j)))
    }

    /// Interpolation errors for the step exponent `j`.
    pub fn missed(&self, system: &System, j: i32) -> &Missed {
        self.level(j).missed.get_or_init(|| Missed::new(system, self.steps.step_s(j)))
    }

    /// Dissipation by modal damping for the step exponent `j` with these closed contacts; only for the energy balance.
    pub fn damping(&self, system: &System, j: i32, contacts: &[usize]) -> &Damping {
        let damping = self.level(j).damping.get_or_init(|| Damping::new(system));
        damping.prepare(system, self.steps.step_s(j), contacts);
        damping
    }

    /// Work of these closed contacts that quadrature misses, for the step exponent `j`; only for the energy balance. `None` if it
    /// misses nothing. Needs [`Tables::prepare`].
    pub fn excess(&self, system: &System, j: i32, contacts: &[usize]) -> Option<&Excess> {
        if !has_fast_modes(system, self.steps.step_s(j), contacts) {
            return None;
        }
        let (rotation, Expanded { forced, .. }) = (self.rotation(system, j), self.expanded(j)?);
        let on_panel = |k: usize| {
            let free = rotation.of(k);
            OnPanel { at_nodes: forced.at_nodes[k], at_end: (free.p11_less_1, free.p12), pushed: forced.pushed(k) }
        };
        let excess = self
            .level(j)
            .excess
            .get_or_init(|| Excess::new(system, self.steps.step_s(j), (0..system.modes.len()).map(on_panel)));
        let damping = (system.most_damping > 0.0).then(|| self.damping(system, j, contacts));
        for (i, &c) in contacts.iter().enumerate() {
            let missing = |other: usize| system.share_elastic_modes(c, other) && !excess.knows(system, (c, other));
            for &other in contacts[..=i].iter().filter(|other| missing(**other)) {
                let lost = damping.and_then(|damping| damping.of_pair(system, c, other));
                let by_quadrature =
                    [(c, other), (other, c)].map(|(c, other)| self.elastic_response(j, c, other).works());
                excess.prepare(system, (c, other), |k| forced.pushed(k), lost, by_quadrature.each_ref());
            }
        }
        Some(excess)
    }

    /// Tables for a system with other weights of the elastic modes: everything that does not depend on them is reused.
    pub fn change_weights(&mut self) {
        for level in self.levels.iter_mut() {
            level.damping = OnceLock::new();
            level.excess = OnceLock::new();
            if let Some(expanded) = level.expanded.get_mut() {
                (expanded.elastic, expanded.elastic_rates) = (unset(self.contacts), unset(self.contacts));
            }
        }
        self.kernels = unset(self.contacts);
    }

    #[inline]
    fn level(&self, j: i32) -> &Level {
        self.levels.get_or_init(j, Level::default)
    }

    /// Computes everything for the step exponent `j` and these contacts and forces that is not cached yet.
    pub fn prepare(&self, system: &System, j: i32, contacts: &[usize], forces: &[usize]) {
        self.rotation(system, j);
        let count = self.contacts;
        let expanded = self.expanded(j);
        let pairs: Vec<(usize, usize)> = contacts
            .iter()
            .flat_map(|&c| forces.iter().map(move |&other| (c, other)))
            .filter(|(c, other)| system.share_elastic_modes(*c, *other))
            .filter(|(c, other)| expanded.as_ref().is_none_or(|level| level.elastic[c * count + other].get().is_none()))
            .collect();
        if expanded.is_some() && pairs.is_empty() {
            return;
        }
        let weights: Vec<Vec<f64>> = pairs.iter().map(|(c, other)| system.shared(*c, *other)).collect();
        let mut found = None;
        let expanded = self.level(j).expanded.get_or_init(|| {
            let half = Over { h: 0.5 * self.steps.step_s(j), known: self.level(j + 1).rotation.get() };
            let (forced, sums) = Forced::new(system, &self.over_panel(j), &half, &weights);
            found = Some(sums);
            Expanded { forced, elastic: unset(count), elastic_rates: unset(count), by_parts: OnceLock::new() }
        });
        let again = || again(system, &self.over_panel(j), (&weights, Order::Displacement), &expanded.by_parts);
        let found = found.unwrap_or_else(again);
        for (((c, other), nodes), weights) in pairs.into_iter().zip(found).zip(&weights) {
            let (end, end_rate) = expanded.forced.end(system, weights);
            // another thread may have been first; its result is the same
            let _ = expanded.elastic[c * count + other].set(Box::new(Response { nodes, end, end_rate }));
        }
    }

    /// Computes the rates at the nodes for the step exponent `j` and these pairs of contacts that are not cached yet. Needs
    /// [`Tables::prepare`].
    pub fn prepare_rates(&self, system: &System, j: i32, pairs: &[(usize, usize)]) {
        let Some(expanded) = self.expanded(j) else { return };
        let rates = |(c, other): (usize, usize)| &expanded.elastic_rates[c * self.contacts + other];
        let wanted = |pair: &(usize, usize)| system.share_elastic_modes(pair.0, pair.1) && rates(*pair).get().is_none();
        let pairs: Vec<(usize, usize)> = pairs.iter().copied().filter(wanted).collect();
        let weights: Vec<Vec<f64>> = pairs.iter().map(|(c, other)| system.shared(*c, *other)).collect();
        let found = again(system, &self.over_panel(j), (&weights, Order::Velocity), &expanded.by_parts);
        for (pair, nodes) in pairs.into_iter().zip(found) {
            let _ = rates(pair).set(Box::new(nodes));
        }
    }

    fn over_panel(&self, j: i32) -> Over<'_> {
        Over { h: self.steps.step_s(j), known: self.level(j).rotation.get() }
    }

    fn expanded(&self, j: i32) -> Option<&Expanded> {
        self.level(j).expanded.get()
    }

    /// Change of the overlap of a contact by free motion at the nodes. Needs [`Tables::prepare`].
    pub fn free_at_nodes(&self, j: i32, link: &Link, amplitude: &[f64], rate: &[f64]) -> Nodal {
        self.expanded(j).map_or([0.0; Q], |level| level.forced.free_at_nodes(&link.spans, amplitude, rate))
    }

    /// Response of contact `c` to the force of `other` by the elastic modes. Needs [`Tables::prepare`].
    pub fn elastic_response(&self, j: i32, c: usize, other: usize) -> Response {
        let found = self.expanded(j).and_then(|level| level.elastic[c * self.contacts + other].get());
        found.map_or_else(Response::default, |response| **response)
    }

    /// Rate of the overlap of contact `c` at the nodes by the elastic modes, to nodal forces of `other`. Needs
    /// [`Tables::prepare_rates`].
    pub fn elastic_rates(&self, j: i32, c: usize, other: usize) -> Matrix {
        let found = self.expanded(j).and_then(|level| level.elastic_rates[c * self.contacts + other].get());
        found.map_or([[0.0; Q]; Q], |rates| **rates)
    }

    /// [`Tables::free_at_nodes`], and the rate there. Needs [`Tables::prepare`].
    pub fn free_with_rates(
        &self,
        system: &System,
        j: i32,
        link: &Link,
        amplitude: &[f64],
        rate: &[f64],
    ) -> (Nodal, Nodal) {
        self.expanded(j)
            .map_or(([0.0; Q], [0.0; Q]), |level| level.forced.free_with_rates(system, &link.spans, amplitude, rate))
    }

    /// Change of the overlap of a contact by free motion over a panel, and its rate at the end.
    pub fn free_at_end(&self, j: i32, link: &Link, amplitude: &[f64], rate: &[f64]) -> (f64, f64) {
        let (mut moved, mut speed) = (0.0, 0.0);
        let Some(rotation) = self.level(j).rotation.get() else { return (moved, speed) };
        for Span { modes, psi } in &link.spans {
            let [less, p12, p21, p22] = rotation.of_modes(modes.clone());
            let [a, b] = [amplitude, rate].map(|row| &row[modes.clone()]);
            let rows = [psi, less, p12, p21, p22, a, b];
            let [by_span, speed_by_span] = vectorized(
                #[inline(always)]
                || {
                    sum_over(
                        rows,
                        #[inline(always)]
                        |[psi, less, p12, p21, p22, a, b]| [psi * (less * a + p12 * b), psi * (p21 * a + p22 * b)],
                    )
                },
            );
            moved += by_span;
            speed += speed_by_span;
        }
        (moved, speed)
    }

    /// Free motion of all modes over one panel.
    pub fn rotate(&self, system: &System, j: i32, amplitude: &mut [f64], rate: &mut [f64]) {
        self.rotation(system, j).apply(amplitude, rate);
    }

    /// Adds the effect of a contact force on the modes within a panel.
    pub fn push(&self, j: i32, link: &Link, force: &Legendre, amplitude: &mut [f64], rate: &mut [f64]) {
        if let Some(level) = self.expanded(j) {
            level.forced.push(&link.spans, force, amplitude, rate);
        }
    }

    /// Derivatives at zero of the response of contact `c` to an impulse of `other`.
    pub fn kernel(&self, system: &System, c: usize, other: usize) -> [f64; TAYLOR] {
        let (one, other_link) = (&system.links[c], &system.links[other]);
        let mut kernel = *self.kernels[c * self.contacts + other].get_or_init(|| {
            let mut kernel = [0.0; TAYLOR];
            for (k, weight) in one.shared(other_link).filter(|(k, _)| !system.modes[*k].is_rigid()) {
                let (mut here, mut next) = (0.0, weight);
                for value in &mut kernel {
                    *value += here;
                    (here, next) = (next, -system.drag[k] * next - system.square[k] * here);
                }
            }
            leave_out_infinite(&mut kernel);
            kernel
        });
        kernel[1] += one.shared_rigid(other_link);
        kernel
    }
}

/// An empty table for every pair of this many contacts.
fn unset<T>(contacts: usize) -> Vec<OnceLock<T>> {
    std::iter::repeat_with(OnceLock::new).take(contacts * contacts).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::{Assembly, Body, BodyMode, Contact, Point};

    /// A contact between two bodies, of these frequencies and unit shapes.
    fn between(bodies: [&[f64]; 2]) -> System {
        let body = |omegas: &[f64]| Body {
            modes: omegas.iter().map(|omega| BodyMode { omega_rad_s: *omega, damping_ratio: 0.01 }).collect(),
            amplitude: vec![0.0; omegas.len()],
            rate: vec![0.0; omegas.len()],
        };
        let side = |i: usize| Point::OfBody { body: i, shape: vec![1.0; bodies[i].len()] };
        let contacts = vec![Contact { sides: [side(0), side(1)], gap_m: 0.0, law: () }];
        let assembly = Assembly { bodies: bodies.map(body).to_vec(), contacts, loads: Vec::new() };
        System::new(&assembly.with_laws(Vec::new()))
    }

    /// The number of terms for the modes of one body does not depend on the other body.
    #[test]
    fn the_response_of_two_bodies_is_the_sum_of_theirs() {
        let nodes = |system: &System| {
            let tables = Tables::new(system, Steps::OF_SECOND);
            tables.prepare(system, 0, &[0], &[0]);
            tables.elastic_response(0, 0, 0).nodes
        };
        let (fast, slow) = ([4.0, 5.5], [1e-3, 2e-3]);
        let both = nodes(&between([&fast, &slow]));
        let (one, other) = (nodes(&between([&fast, &[]])), nodes(&between([&[], &slow])));
        for j in 0..Q {
            for i in 0..Q {
                assert!((both[j][i] - (one[j][i] + other[j][i])).abs() < 1e-15, "{j} {i}");
            }
        }
    }
}
