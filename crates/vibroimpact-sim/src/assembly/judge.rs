//! Checks a solved panel: does an event function of one of its contacts fall to zero, and is the panel short enough for this
//! decision?

use super::collocate::Collocated;
use super::enclosure::{Pull, of_panel};
use super::event::{Beginning, EventFunction, Verdict};
use super::motion::{MAGNIFIED, March, Target};
use super::state::Touch;
use crate::panel::dyadic::level_within;
use crate::panel::legendre::{Legendre, Nodal, Q, TAYLOR};

/// Bound on the sum of all coefficients of `t^(3/2)` beyond the polynomial, relative to the estimate of the next two.
const TAIL: f64 = 10.0;

/// Result of testing the event functions of a panel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Judgement {
    Clear,
    Doubtful,
    Meets(Target, f64),
}

impl<'a> March<'a> {
    /// Tests all event functions of the contacts on a panel of `h` and finds the first that falls to zero.
    pub(super) fn judge(
        &mut self,
        h: f64,
        contacts: &[usize],
        closed: usize,
        solved: &[Collocated],
        overlap: &[Nodal],
        enclosed: bool,
    ) -> Judgement {
        let (mut first, mut doubtful): (Option<(Target, f64)>, bool) = (None, false);
        let mut pulls = std::mem::take(&mut self.pulls);
        pulls.clear();
        if enclosed {
            pulls.extend(self.pulls_of(&contacts[..closed]));
        }
        for (i, &c) in contacts.iter().enumerate() {
            let state = &self.states[c];
            let mut rho = [0.0; 3];
            if enclosed {
                let missed = self.tables.missed(self.system, level_within(h));
                rho = of_panel(
                    self.system,
                    missed,
                    &self.loads,
                    c,
                    h,
                    (&self.amplitude, &self.rate),
                    (&pulls, &mut self.held),
                );
            }
            let noise = self.panel_noise(c, h);
            let mut acceleration = None;
            let (residue, rate_residue) = state.touch().map_or((0.0, 0.0), |touch| (touch.residue, touch.rate_residue));
            let mut ask = |boundary: usize, start: f64, nodal: Nodal, per: (f64, f64)| {
                let (per_overlap, per_rate) = (per.0.abs(), per.1.abs() / h);
                let noise = noise * (per_overlap + MAGNIFIED * per_rate);
                let function = EventFunction {
                    start,
                    nodal,
                    rho: [0, 1, 2].map(|r| per_overlap * rho[r] + per_rate * rho.get(r + 1).copied().unwrap_or(0.0)),
                    noise,
                    residue: 2.0 * residue,
                    slope_residue: 2.0 * per_overlap * rate_residue * h,
                };
                let beginning = || {
                    let acceleration = *acceleration.get_or_insert_with(|| self.acceleration(c, &contacts[..closed]));
                    Beginning {
                        slope: (per.0 * state.rate + per.1 * acceleration) * h,
                        bend: (per.1 == 0.0).then_some(per.0 * acceleration * h * h),
                        unresolved: (per_overlap + per_rate) * h * h * self.unresolved(c, &contacts[..closed], solved),
                    }
                };
                match function.verdict(beginning) {
                    Verdict::Clear => {}
                    Verdict::Doubtful => doubtful = true,
                    Verdict::Meets(place) => {
                        if first.is_none_or(|(_, earlier)| place < earlier) {
                            first = Some((Target { contact: c, boundary }, place));
                        }
                    }
                }
            };
            match state.touch() {
                Some(touch) => {
                    let rates = if touch.ends_by_rate { solved[i].rate } else { [0.0; Q] };
                    for (which, boundary) in state.ends.iter().enumerate() {
                        let nodal = std::array::from_fn(|n| boundary.margin(overlap[i][n], rates[n]));
                        let start = boundary.margin(state.overlap, state.rate);
                        ask(which, start, nodal, (boundary.per_compression, boundary.per_rate));
                    }
                }
                None => {
                    let touch_m = state.touch_m();
                    ask(0, touch_m - state.overlap, overlap[i].map(|overlap| touch_m - overlap), (-1.0, 0.0));
                }
            }
        }
        self.pulls = pulls;
        match first {
            Some((target, place)) => Judgement::Meets(target, place),
            None if doubtful => Judgement::Doubtful,
            None => Judgement::Clear,
        }
    }

    /// Value of an event function at the end of a terminal panel, and its rate.
    pub(super) fn margin(&self, target: Target, [overlap, rate, acceleration]: [f64; 3]) -> (f64, f64) {
        let state = &self.states[target.contact];
        match state.ends.get(target.boundary).filter(|_| state.is_closed()) {
            Some(boundary) => {
                let slope = boundary.per_compression * rate + boundary.per_rate * acceleration;
                (boundary.margin(overlap, rate), slope)
            }
            None => (state.touch_m() - overlap, -rate),
        }
    }

    /// Acceleration of the overlap of a contact now (m/s^2), while these are closed.
    pub(super) fn acceleration(&self, c: usize, closed: &[usize]) -> f64 {
        let (system, link) = (self.system, &self.system.links[c]);
        let mut series = [0.0; TAYLOR];
        self.loads.add_series(c, self.time_s, &mut series);
        let of =
            |(k, psi): &(usize, f64)| psi * (system.drag[*k] * self.rate[*k] + system.square[*k] * self.amplitude[*k]);
        let free = 2.0 * series[2] - link.elastic.iter().map(of).sum::<f64>();
        let pull = |&other: &usize| {
            let (state, links) = (&self.states[other], &self.system.links);
            let weight: f64 = links[c].shared(&links[other]).map(|(_, weight)| weight).sum();
            let force = |touch: &Touch| self.law(other).force(&touch.branch, state.overlap, state.rate).force_n;
            weight * state.touch().map_or(0.0, force)
        };
        free - closed.iter().map(pull).sum::<f64>()
    }

    /// Uncertainty of the acceleration of the overlap of a contact by the truncation of the closed contacts' forces (m/s^2).
    fn unresolved(&self, c: usize, closed: &[usize], solved: &[Collocated]) -> f64 {
        let links = &self.system.links;
        let of = |(other, solved): (&usize, &Collocated)| {
            // no product of weights is larger
            let weight = (links[c].mobility * links[*other].mobility).sqrt();
            weight * TAIL * Legendre::through(&solved.acting).truncation()
        };
        let shares = |(other, _): &(&usize, &Collocated)| self.system.neighbours[c].contains(other);
        closed.iter().zip(solved).filter(shares).map(of).sum()
    }

    /// The forces of closed contacts at the start of a panel.
    fn pulls_of<'s>(&'s self, closed: &'s [usize]) -> impl Iterator<Item = Pull<'a>> + 's {
        let pull = |c: &usize| {
            let (force, h) = self.states[*c].touch()?.previous?;
            // P_n' is n (n+1) at the end of [0, 1]
            let slope: f64 = force.0.iter().enumerate().map(|(n, f)| (n * (n + 1)) as f64 * f).sum();
            Some(Pull { link: &self.system.links[*c], force_n: force.at(1.0), rate_n_s: slope / h })
        };
        closed.iter().filter_map(pull)
    }
}
