//! The quadratic programs of a contact problem, in units in which all numbers are of order one.

use crate::engine::{Engine, Failure};
use crate::program::Program;
use crate::{Coefficients, Contact, Friction, Mode, Outcome, Problem, Solution};
use alloc::vec;
use alloc::vec::Vec;
use core::f64::consts::PI;
use invalid_input::InvalidInput;

/// Share of the energy exchanged, or of that available if it is less, by which the energy may grow numerically.
const ENERGY_ROUNDING: f64 = 1e-10;
/// Speed, relative to the fastest one, at which a contact may close numerically.
const CLOSING_ROUNDING: f64 = 1e-9;
/// Speed, relative to the fastest one, by which a demand may be missed numerically.
const DEMAND_ROUNDING: f64 = 1e-8;
/// Impulse, relative to the one that stops the striker of its contact by itself, above which bodies count as wedged.
const WEDGED: f64 = 1e6;
/// A striker of which the impulse that stops it by itself is this many times the one that stops the contact with the greatest mobility. The
/// least energy then depends on differences of energies that are too far apart for an iteration without proof.
const HEAVY: f64 = 3e5;
/// Share of the impulses between wedged bodies, which cancel, that may be missing at a contact.
const WEDGED_ROUNDING: f64 = 1e-11;

/// Impulses and changes of the modal speeds.
pub(crate) struct Point {
    impulse: Vec<f64>,
    rate_changes: Vec<f64>,
}

/// What the two rows of a contact, Eqs. 6.9 and 6.10, demand, or their left-hand sides at some point.
#[derive(Clone, Copy)]
pub(crate) struct Demand {
    opening: f64,
    outward: f64,
}

/// The problem with velocities relative to the fastest one and inverse inertias relative to the largest one. Modes that no
/// contact excites are omitted: they do not change their speed, and with them the feasible set would have no interior.
pub(crate) struct Scaled<'a> {
    stated: &'a Problem,
    problem: Problem,
    /// Indices of the modes that are not omitted.
    kept: Vec<usize>,
    normals: Vec<usize>,
    /// Unit of the impulse in each contact coordinate: 1, or if a striker is [`HEAVY`], the one that by itself gives the striker of the
    /// contact the unit of velocity, or the structure if the striker is immovable. A striker that is far heavier than the structure takes
    /// many times the impulse that stops both together.
    impulses: Vec<f64>,
    heavy: bool,
    /// Speed at which each contact closes before the impact, 0 if it opens.
    closing: Vec<f64>,
    /// Unit of velocity (m/s).
    speed: f64,
    /// Square root of the unit of inverse inertia (kg^-1/2).
    root: f64,
}

impl<'a> Scaled<'a> {
    /// `None` if no contact is closing.
    pub(crate) fn new(stated: &'a Problem) -> Result<Option<Scaled<'a>>, InvalidInput> {
        let d = stated.coordinates();
        let combined = stated.combined_inverse_inertia();
        let root = (0..d).fold(0.0_f64, |m, i| m.max(combined[i * d + i])).sqrt();
        let opening = stated.opening(&stated.velocity_m_s, stated.modes.iter().map(|mode| mode.rate));
        let mut speed = stated.velocity_m_s.iter().chain(&opening).fold(0.0_f64, |m, v| m.max(v.abs()));
        for mode in &stated.modes {
            speed = mode.shape.iter().fold(speed, |m, shape| m.max((shape * mode.rate).abs()));
        }
        let normals = stated.normals();
        if root == 0.0 || !normals.iter().any(|&i| opening[i] < -1e-14 * speed) {
            return Ok(None);
        }
        let mut kept = Vec::new();
        let mut modes = Vec::new();
        for (place, mode) in stated.modes.iter().enumerate() {
            if mode.shape.iter().any(|shape| shape.abs() / root > 0.0) {
                kept.push(place);
                let shape = mode.shape.iter().map(|shape| shape / root).collect();
                modes.push(Mode { rate: mode.rate / speed * root, shape });
            }
        }
        let problem = Problem {
            contacts: stated.contacts.clone(),
            inverse_inertia_per_kg: stated.inverse_inertia_per_kg.iter().map(|w| w / root / root).collect(),
            velocity_m_s: stated.velocity_m_s.iter().map(|v| v / speed).collect(),
            modes,
        };
        let closing = normals.iter().map(|&i| (-opening[i] / speed).max(0.0)).collect();
        let mut impulses = units_of_impulse(&problem, |i| {
            let own = problem.inverse_inertia_per_kg[i * d + i];
            if own > 0.0 { own } else { combined[i * d + i] / root / root }
        });
        let heavy = impulses.iter().any(|unit| *unit > HEAVY);
        if !heavy {
            impulses.fill(1.0);
        }
        Ok(Some(Scaled { stated, problem, kept, normals, impulses, heavy, closing, speed, root }))
    }

    /// Least energy over the impulses within the friction cones, with `a_k' = a_k'(0) - shape_k . P`:
    /// `min P.G P/2 + g.P`, whose optimality conditions keep every contact from closing.
    pub(crate) fn least_energy(&self, engine: &mut Engine) -> Result<Point, Failure> {
        let d = self.problem.coordinates();
        let mut program = Program::new(d);
        let combined = self.problem.combined_inverse_inertia();
        let rates = self.problem.modes.iter().map(|mode| mode.rate);
        let opening = self.problem.opening(&self.problem.velocity_m_s, rates);
        let units = units_of_impulse(&self.problem, |i| combined[i * d + i]);
        for i in 0..d {
            program.linear(i, opening[i] * units[i]);
            for j in i..d {
                program.quadratic(i, j, combined[i * d + j] * units[i] * units[j]);
            }
        }
        self.friction_rows(&mut program);
        let found = engine.minimise(&program)?.x;
        let pressing = found.iter().fold(0.0_f64, |m, p| m.max(p.abs()));
        let impulse: Vec<f64> = found.iter().zip(&units).map(|(p, unit)| p * unit).collect();
        let rate_changes = self.problem.struck_changes(&impulse);
        // Between wedged bodies the least energy may need an infinite impulse.
        let point = Point { impulse, rate_changes };
        let solution = self.state(&point);
        let closes = |&i: &usize| solution.opening_m_s[i] < -10.0 * CLOSING_ROUNDING - WEDGED_ROUNDING * pressing;
        if self.normals.iter().any(closes) {
            return Err(Failure::Stopped("the bodies are wedged: no impulse of reasonable size separates them"));
        }
        Ok(point)
    }

    /// P_1 for many contacts: least energy under the outward constraints, whose demands are lowered to `share`
    /// of the way from `attained` to those stated; `None` unless the numerical solution is admissible and meets them.
    ///
    /// Variables: impulses `P` in their units, and in units of the largest shape of each mode, which is what an impulse of 1 changes, the
    /// change `x_k` of its speed and the change `c_k` of its magnitude `|a_k'|`. All of them are then of order one, also if the structure
    /// is heavy and its modal speeds exceed their changes by many orders of magnitude, or if a striker is heavy.
    pub(crate) fn attempt(&self, engine: &mut Engine, attained: &[Demand], share: f64) -> Option<Point> {
        let Problem { contacts, inverse_inertia_per_kg: w, velocity_m_s: v, modes } = &self.problem;
        let (d, n) = (v.len(), modes.len());
        let (x, c) = (d, d + n);
        let reach = |mode: &Mode| mode.shape.iter().fold(0.0_f64, |m, shape| m.max(shape.abs()));
        let units: Vec<f64> = modes.iter().map(reach).collect();
        let mut p1 = Program::new(d + 2 * n);
        // Change of energy: P.W P/2 + v.P + sum (a + x)^2/2, half of the sum in c as in Eq. 6.8.
        let impulses = &self.impulses;
        for i in 0..d {
            p1.linear(i, v[i] * impulses[i]);
            for j in i..d {
                p1.quadratic(i, j, w[i * d + j] * impulses[i] * impulses[j]);
            }
        }
        for (k, mode) in modes.iter().enumerate() {
            let unit = units[k];
            p1.linear(x + k, 0.5 * mode.rate * unit);
            p1.linear(c + k, 0.5 * mode.rate.abs() * unit);
            p1.quadratic(x + k, x + k, 0.5 * unit * unit);
            p1.quadratic(c + k, c + k, 0.5 * unit * unit);
        }
        self.friction_rows(&mut p1);
        let demands = self.demands(attained, share);
        let before = self.problem.opening(v, modes.iter().map(|mode| mode.rate));
        for (place, (&i, contact)) in self.normals.iter().zip(contacts).enumerate() {
            let Demand { opening, outward } = demands[place];
            let after = (0..d).map(|j| (j, w[i * d + j] * impulses[j]));
            // Eq. 6.9: g_i + (W P)_i - sum shape x >= ebar u; without approach it prevents interpenetration.
            let modal = modes.iter().enumerate().map(|(k, mode)| (x + k, -mode.shape[i] * units[k]));
            p1.at_least(after.clone().chain(modal), opening - before[i]);
            // Eq. 6.10, for closing contacts only; a row of zeros keeps the pattern the same for the others.
            let acts = if self.closing[place] > 0.0 { 1.0 } else { 0.0 };
            let beta0 = contact.coefficients.beta0;
            let modal = modes.iter().enumerate();
            let modal = modal.map(|(k, mode)| (c + k, -acts * beta0 * mode.shape[i].abs() * units[k]));
            let buzz: f64 = modes.iter().map(|mode| (mode.shape[i] * mode.rate).abs()).sum();
            let bound = if acts > 0.0 { outward - v[i] + beta0 * buzz } else { -1.0 };
            p1.at_least(after.map(|(j, w)| (j, acts * w)).chain(modal), bound);
        }
        for (k, mode) in modes.iter().enumerate() {
            // Beyond what admissible impulses can change a bound has no effect, but would spoil the numbers.
            let reach: Vec<(usize, f64)> = self.reach(mode, units[k]).collect();
            let furthest = -2.0 * WEDGED * reach.iter().map(|(_, reach)| reach).sum::<f64>();
            let bound = |rate: f64| ((mode.rate.abs() - rate) / units[k]).min(furthest);
            p1.at_most([(x + k, 1.0), (c + k, -1.0)], bound(mode.rate)); // 6.11
            p1.at_most([(x + k, -1.0), (c + k, -1.0)], bound(-mode.rate)); // 6.12
            // 6.13: no mode changes by more than the impulses can cause.
            let largest = reach.iter().fold(1.0_f64, |m, (_, reach)| m.max(-reach));
            let row = || reach.iter().map(|&(i, reach)| (i, reach / largest));
            p1.at_most(row().chain([(x + k, 1.0 / largest)]), 0.0);
            p1.at_most(row().chain([(x + k, -1.0 / largest)]), 0.0);
        }
        let minimum = engine.minimise(&p1).ok()?;
        if self.heavy && contacts.len() > 1 && !minimum.proven {
            return None;
        }
        let mut found = minimum.x;
        found.truncate(d + n);
        let rate_changes = found.split_off(d).iter().zip(&units).map(|(change, unit)| change * unit).collect();
        let impulse = found.iter().zip(impulses).map(|(impulse, unit)| impulse * unit).collect();
        let point = Point { impulse, rate_changes };
        (self.admissible(&point) && self.meets(&point, &demands)).then_some(point)
    }

    /// `-(|shape_normal| + mu |shape_tangent|)` for the normal impulse of each contact, in its unit and this unit of shapes.
    fn reach<'b>(&'b self, mode: &'b Mode, unit: f64) -> impl Iterator<Item = (usize, f64)> + 'b {
        self.normals.iter().zip(&self.problem.contacts).map(move |(&i, contact)| {
            let tangents = &mode.shape[i + 1..i + contact.friction.coordinates()];
            let tangent = tangents.iter().map(|shape| shape * shape).sum::<f64>().sqrt();
            (i, -(mode.shape[i].abs() + contact.friction.coefficient() * tangent) / unit * self.impulses[i])
        })
    }

    /// `p >= 0`, and the friction cone or the pyramid inscribed in it.
    fn friction_rows(&self, program: &mut Program) {
        for (&i, contact) in self.normals.iter().zip(&self.problem.contacts) {
            program.at_least([(i, 1.0)], 0.0);
            match contact.friction {
                Friction::None => {}
                Friction::Planar { coefficient } => {
                    program.at_most([(i, -coefficient), (i + 1, 1.0)], 0.0);
                    program.at_most([(i, -coefficient), (i + 1, -1.0)], 0.0);
                }
                Friction::Spatial { coefficient, facets } => {
                    let inner = coefficient * (PI / facets as f64).cos();
                    for facet in 0..facets {
                        let (sin, cos) = (2.0 * PI * facet as f64 / facets as f64).sin_cos();
                        program.at_most([(i, -inner), (i + 1, cos), (i + 2, sin)], 0.0);
                    }
                }
            }
        }
    }

    /// Left-hand sides of Eqs. 6.9 and 6.10 at a point, for each contact.
    pub(crate) fn attained(&self, point: &Point) -> Vec<Demand> {
        let solution = self.state(point);
        let attained = |(&i, contact): (&usize, &Contact)| {
            let terms = self.problem.modes.iter().zip(&solution.modal_rate);
            let buzz: f64 = terms.map(|(mode, rate)| (mode.shape[i] * rate).abs()).sum();
            let outward = solution.velocity_m_s[i] - contact.coefficients.beta0 * buzz;
            Demand { opening: solution.opening_m_s[i], outward }
        };
        self.normals.iter().zip(&self.problem.contacts).map(attained).collect()
    }

    /// The demands of each contact, lowered to `share` of the way from `attained` to those stated.
    fn demands(&self, attained: &[Demand], share: f64) -> Vec<Demand> {
        let lowered = |demand: f64, had: f64| if demand > had { had + share * (demand - had) } else { demand };
        let demands = |((closing, contact), had): ((&f64, &Contact), &Demand)| {
            let Coefficients { ebar, beta1, .. } = contact.coefficients;
            let (opening, outward) = (ebar * closing, beta1 * ebar * closing);
            Demand { opening: lowered(opening, had.opening), outward: lowered(outward, had.outward) }
        };
        self.closing.iter().zip(&self.problem.contacts).zip(attained).map(demands).collect()
    }

    /// Whether a numerical solution meets the demands of the contacts that close.
    fn meets(&self, point: &Point, demands: &[Demand]) -> bool {
        let attained = self.attained(point);
        let met = |((closing, had), demand): ((&f64, &Demand), &Demand)| {
            let missed = (demand.opening - had.opening).max(demand.outward - had.outward);
            *closing == 0.0 || missed <= DEMAND_ROUNDING
        };
        self.closing.iter().zip(&attained).zip(demands).all(met)
    }

    /// Whether a numerical solution is valid: energy does not grow and no contact closes beyond rounding, and there are no
    /// impulses that only cancel each other up to rounding, as between wedged bodies.
    fn admissible(&self, point: &Point) -> bool {
        let solution = self.state(point);
        let (problem, p) = (&self.problem, &point.impulse);
        let before_and_after = problem.velocity_m_s.iter().zip(&solution.velocity_m_s);
        let strikers: f64 =
            p.iter().zip(before_and_after).map(|(p, (v, after))| p.abs() * (v.abs() + after.abs())).sum();
        let rates_and_changes = problem.modes.iter().map(|mode| mode.rate).zip(&point.rate_changes);
        let modes: f64 = rates_and_changes.map(|(rate, change)| change.abs() * (rate.abs() + change.abs())).sum();
        // a striker has at least the energy of its motion in one coordinate alone
        let inverse = |i: usize| problem.inverse_inertia_per_kg[i * p.len() + i];
        let alone = |(i, v): (usize, &f64)| if inverse(i) > 0.0 { v * v / inverse(i) } else { 0.0 };
        let moving = problem.velocity_m_s.iter().enumerate().map(alone).fold(1.0, f64::max);
        let available = moving + problem.modes.iter().map(|mode| mode.rate * mode.rate).sum::<f64>();
        solution.energy_change_j <= ENERGY_ROUNDING * (strikers + modes).min(available)
            && self.normals.iter().all(|&i| solution.opening_m_s[i] >= -CLOSING_ROUNDING)
            && point.impulse.iter().zip(&self.impulses).all(|(p, unit)| p.abs() <= WEDGED * unit)
    }

    /// The state at a point, in the units of the program.
    fn state(&self, point: &Point) -> Solution {
        self.problem.solution(Outcome::Solved, point.impulse.clone(), &point.rate_changes)
    }

    /// The point as a solution of the problem as stated.
    pub(crate) fn solution(&self, outcome: Outcome, point: &Point) -> Solution {
        let mut rate_changes = vec![0.0; self.stated.modes.len()];
        for (&place, change) in self.kept.iter().zip(&point.rate_changes) {
            rate_changes[place] = change * self.speed / self.root;
        }
        let impulse = point.impulse.iter().map(|p| p * self.speed / self.root / self.root).collect();
        self.stated.solution(outcome, impulse, &rate_changes)
    }
}

/// A unit of the impulse in each contact coordinate: the one that changes the velocity by 1 if the normal of the contact has this inverse
/// inertia.
fn units_of_impulse(problem: &Problem, inverse_inertia: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut units = Vec::with_capacity(problem.coordinates());
    for (&i, contact) in problem.normals().iter().zip(&problem.contacts) {
        let inverse = inverse_inertia(i);
        let unit = if inverse > 0.0 { 1.0 / inverse } else { 1.0 };
        units.extend(vec![unit; contact.friction.coordinates()]);
    }
    units
}
