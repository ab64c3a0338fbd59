//! Checks a solved panel: does an event function of one of its contacts fall to zero, and is the panel short enough for this
//! decision?

use super::enclosure::{ContactForce, of_panel};
use super::event::{Beginning, EventFunction, Verdict};
use super::interpolation::ORDERS;
use super::motion::{Crossing, March};
use super::rounding::MAGNIFIED;
use super::state::ClosedContact;
use crate::panel::legendre::{Legendre, Nodal, Q, TAYLOR, slopes};

/// Bound on the sum of all coefficients of `t^(3/2)` beyond the polynomial, relative to the estimate of the next two. The sum is the
/// error of a force at first touch where it begins, 5.4 times the estimate.
const TAIL: f64 = 10.0;

/// Under the last Legendre polynomial as the acceleration an overlap is of the ninth degree. The polynomial through start and nodes
/// then misses `s P_8(2s - 1)/270` (panel length 1), and its rates at the nodes the slope of this there, `s P_8'(2s - 1)/135`. These are
/// bounds on both, and on what the second does to the quotient of an event function that depends on the rate. Other quotients are of at
/// most the eighth degree.
const BEYOND: [f64; ORDERS] = [1.0 / 270.0, 72.0 / 270.0, 144.0 / 270.0];

/// Beyond this part of a terminal panel a zero of the event function that it ends at is the end itself, and another event is located on
/// the same panel.
pub(super) const NEAR_END: f64 = 0.99;

/// Result of testing the event functions of a panel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Judgement {
    Clear,
    Doubtful,
    Meets(Crossing, f64),
}

/// What is not known of an overlap on a panel, and therefore not of its event functions.
struct Uncertainty {
    h: f64,
    /// Bounds on what the polynomial misses of vibrations, and the increase of the overlap by the last coefficient of the forces.
    rho: [f64; ORDERS],
    beyond: f64,
    rounding: f64,
    increase_rounding: f64,
    residue: f64,
    rate_residue: f64,
}

impl Uncertainty {
    /// The event function with these values and these derivatives by the overlap and by its rate, on both of which it depends linearly.
    fn of(&self, start: f64, nodal: Nodal, (per_overlap, per_rate): (f64, f64)) -> EventFunction {
        let Uncertainty { h, rho, beyond, .. } = *self;
        // along the panel of length 1 the rate of the overlap is its slope over `h`
        let (by_value, by_rate, by_slope) = (per_overlap.abs(), per_rate.abs(), per_rate.abs() / h);
        EventFunction {
            start,
            nodal,
            rho: [
                by_value * (rho[0] + BEYOND[0] * beyond) + by_slope * (rho[1] + BEYOND[1] * beyond),
                by_value * rho[1] + by_slope * (rho[2] + BEYOND[2] * beyond),
                by_value * rho[2],
            ],
            rounding: self.rounding * by_value + MAGNIFIED * self.increase_rounding * by_slope,
            residue: 2.0 * (by_value * self.residue + by_rate * self.rate_residue),
            slope_residue: 2.0 * by_value * self.rate_residue * h,
        }
    }
}

impl<'a> March<'a> {
    /// Tests all event functions of the contacts on a panel of `h` and finds the first that falls to zero. The series of a terminal panel
    /// need no enclosure; the function that is zero at its end by construction is tested up to [`NEAR_END`].
    pub(super) fn judge(
        &mut self,
        h: f64,
        (contacts, closed): (&[usize], usize),
        force: &[Legendre],
        moved: &[Nodal],
        enclosed: bool,
        ends_at: Option<Crossing>,
    ) -> Judgement {
        let (mut first, mut doubtful): (Option<(Crossing, f64)>, bool) = (None, false);
        let mut forces = std::mem::take(&mut self.contact_forces);
        forces.clear();
        if enclosed {
            forces.extend(self.forces_of(&contacts[..closed]));
        }
        for (i, &c) in contacts.iter().enumerate() {
            let rho = if enclosed { self.enclosure(c, h, &forces) } else { [0.0; ORDERS] };
            let beyond = h * h * self.moved_by(c, &contacts[..closed], |i| force[i].0[Q - 1].abs());
            let uncertainty = self.uncertainty(c, h, rho, beyond);
            let state = &self.states[c];
            let mut acceleration = None;
            let mut test = |boundary: usize, start: f64, nodal: Nodal, per: (f64, f64)| {
                let beginning = || {
                    let acceleration = *acceleration.get_or_insert_with(|| self.acceleration(c, &contacts[..closed]));
                    Beginning {
                        slope: (per.0 * state.rate + per.1 * acceleration) * h,
                        bend: (per.1 == 0.0).then_some(per.0 * acceleration * h * h),
                        unresolved: (per.0.abs() + per.1.abs() / h)
                            * h
                            * h
                            * self.unresolved(c, &contacts[..closed], force),
                    }
                };
                match uncertainty.of(start, nodal, per).verdict(beginning) {
                    Verdict::Clear => {}
                    Verdict::Doubtful => doubtful = true,
                    Verdict::Meets(place) => {
                        let crossing = Crossing { contact: c, boundary };
                        if ends_at == Some(crossing) && place >= NEAR_END {
                            return;
                        }
                        if first.is_none_or(|(_, earlier)| place < earlier) {
                            first = Some((crossing, place));
                        }
                    }
                }
            };
            match state.closed_contact() {
                Some(contact) => {
                    let rates = if contact.ends_by_rate { slopes(0.0, &moved[i], h) } else { [0.0; Q] };
                    for (which, boundary) in state.boundaries.iter().enumerate() {
                        let nodal = std::array::from_fn(|n| boundary.margin(state.overlap + moved[i][n], rates[n]));
                        let start = boundary.margin(state.overlap, state.rate);
                        test(which, start, nodal, (boundary.per_compression, boundary.per_rate));
                    }
                }
                None => {
                    let touch_m = state.touch_m();
                    let nodal = moved[i].map(|moved| touch_m - (state.overlap + moved));
                    test(0, touch_m - state.overlap, nodal, (-1.0, 0.0));
                }
            }
        }
        self.contact_forces = forces;
        match first {
            Some((crossing, place)) => Judgement::Meets(crossing, place),
            None if doubtful => Judgement::Doubtful,
            None => Judgement::Clear,
        }
    }

    /// Bounds on what the polynomial of an overlap on a panel of `2^-j` s misses of the vibrations of the modes.
    fn enclosure(&mut self, c: usize, h: f64, forces: &[ContactForce]) -> [f64; ORDERS] {
        let missed = self.tables.missed(self.system, self.tables.steps.level_within(h));
        let motion = (self.amplitude.as_slice(), self.rate.as_slice());
        of_panel(self.system, missed, &self.loads, c, h, motion, (forces, &mut self.quasi_static))
    }

    fn uncertainty(&self, c: usize, h: f64, rho: [f64; ORDERS], beyond: f64) -> Uncertainty {
        let (rounding, increase_rounding) = self.rounding_on_panel(c, h);
        let (residue, rate_residue) =
            self.states[c].closed_contact().map_or((0.0, 0.0), |contact| (contact.residue, contact.rate_residue));
        Uncertainty { h, rho, beyond, rounding, increase_rounding, residue, rate_residue }
    }

    /// Value of an event function at the end of a terminal panel, and its rate.
    pub(super) fn margin(&self, crossing: Crossing, [overlap, rate, acceleration]: [f64; 3]) -> (f64, f64) {
        let state = &self.states[crossing.contact];
        match state.boundaries.get(crossing.boundary).filter(|_| state.is_closed()) {
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
        let by = |&other: &usize| {
            let (state, links) = (&self.states[other], &self.system.links);
            let weight: f64 = links[c].shared(&links[other]).map(|(_, weight)| weight).sum();
            let force =
                |contact: &ClosedContact| self.law(other).force(&contact.branch, state.overlap, state.rate).force_n;
            weight * state.closed_contact().map_or(0.0, force)
        };
        free - closed.iter().map(by).sum::<f64>()
    }

    /// Uncertainty of the acceleration of the overlap of a contact by the truncation of the closed contacts' forces (m/s^2).
    fn unresolved(&self, c: usize, closed: &[usize], force: &[Legendre]) -> f64 {
        self.moved_by(c, closed, |i| TAIL * force[i].truncation())
    }

    /// Bound on the acceleration of the overlap of a contact (m/s^2) by forces of this size in the closed contacts.
    fn moved_by(&self, c: usize, closed: &[usize], force_n: impl Fn(usize) -> f64) -> f64 {
        let links = &self.system.links;
        // no product of weights is larger
        let weight = |other: usize| (links[c].mobility * links[other].mobility).sqrt();
        let shares = |(_, other): &(usize, &usize)| self.system.neighbours[c].contains(other);
        closed.iter().enumerate().filter(shares).map(|(i, &other)| weight(other) * force_n(i)).sum()
    }

    /// The forces of closed contacts at the start of a panel.
    fn forces_of<'s>(&'s self, closed: &'s [usize]) -> impl Iterator<Item = ContactForce<'a>> + 's {
        let of = |c: &usize| {
            let (force, h) = self.states[*c].closed_contact()?.previous?;
            let ([_, force_n], [_, slope]) = (force.at_ends(), force.slopes_at_ends());
            Some(ContactForce { link: &self.system.links[*c], force_n, rate_n_s: slope / h })
        };
        closed.iter().filter_map(of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::legendre::{BASIS, coefficients};

    /// The overlap under the last Legendre polynomial as the acceleration, integrated twice by the differential equation of these
    /// polynomials, is `s^2 (1 - s)^2` times the slope of the slope of `P_7`, over `7 8 (7 8 - 2)`.
    #[test]
    fn what_the_polynomial_of_the_overlap_misses_is_bounded() {
        let last = Legendre(std::array::from_fn(|n| f64::from(u8::from(n == Q - 1))));
        let bends = last.derivative().derivative();
        let moved = |s: f64| (s * (1.0 - s)).powi(2) * bends.at(s) / (56.0 * 54.0);
        let rate = |s: f64| (moved(s + 1e-6) - moved(s - 1e-6)) / 2e-6;
        let nodal = BASIS.nodes.map(moved);
        let found = slopes(0.0, &nodal, 1.0);
        for (s, found) in BASIS.nodes.iter().zip(found) {
            assert!((found - rate(*s)).abs() <= BEYOND[1] && (found - rate(*s)).abs() > 1e-3 * BEYOND[1], "{s}");
        }
        // the missed part is largest at the end, where the overlap itself is zero
        let at_end: f64 = BASIS.nodes.iter().zip(nodal).map(|(s, value)| value * lagrange(*s, 1.0)).sum();
        assert!((at_end.abs() - BEYOND[0]).abs() < 1e-12, "{at_end}");
    }

    #[test]
    fn the_error_of_a_force_where_it_begins_is_bounded() {
        // at the start all polynomials beyond the second contribute with one sign
        let all: Vec<f64> = coefficients(1.5).take(100_000).collect();
        let estimate = Legendre(std::array::from_fn(|n| all[n])).truncation();
        let tail: f64 = all[Q..].iter().map(|coefficient| coefficient.abs()).sum();
        assert!((1.0..2.0).contains(&(TAIL * estimate / tail)), "{estimate} {tail}");
    }

    /// Of the polynomial through zero and the nodes, the part that belongs to this node.
    fn lagrange(node: f64, at: f64) -> f64 {
        let others = BASIS.nodes.iter().filter(|other| **other != node);
        others.fold(at / node, |product, other| product * (at - other) / (node - other))
    }
}
