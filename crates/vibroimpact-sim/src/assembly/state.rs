//! The state of the contacts during time integration.

use super::collocate::Collocated;
use super::enclosure::FlightBounds;
use super::solution::{Interval, Statistics};
use crate::panel::ends::Ends;
use crate::panel::interpolant::Interpolant;
use crate::panel::legendre::{BASIS, Legendre, Nodal, dot, work_of_unit_forces};
use crate::panel::peak::{Peak, turning_point};
use crate::panel::root::{EXACTLY, root};
use contact_models::{Boundary, Branch, ContactLaw, Memory};

/// A contact at a moment.
#[derive(Debug, Clone)]
pub(crate) struct State {
    pub phase: Phase,
    /// Boundaries of the branch of a closed contact, which do not change along it.
    pub boundaries: Vec<Boundary>,
    /// Whether the force falls to zero at each of these as `t^(3/2)`.
    pub vanishes: Vec<bool>,
    /// Overlap of the surfaces (m) and its rate (m/s). In a closed contact it is the sum of its increments: a difference of
    /// positions would contain their rounding, which a stiff contact would turn into force.
    pub overlap: f64,
    pub rate: f64,
    /// The part of the overlap that does not come from modes and loads (m): minus the gap, and the rounding so far.
    pub reference: f64,
    /// Largest momentum exchanged so far, or expected from the loads (N s).
    pub momentum: f64,
    /// Inverse effective mass of the bodies at the contact (1/kg).
    pub inverse_mass: f64,
    pub statistics: Statistics,
}

/// Whether a contact is closed.
#[derive(Debug, Clone)]
pub(crate) enum Phase {
    Open {
        memory: Memory,
        /// Time up to which the contact certainly stays open (s), if no force acts on its bodies.
        clear_until: f64,
        /// The bounds behind this time, as long as no force acts on its bodies.
        bounds: Option<Box<FlightBounds>>,
    },
    Closed(Box<ClosedContact>),
}

/// A contact that is closed.
#[derive(Debug, Clone)]
pub(crate) struct ClosedContact {
    pub branch: Branch,
    /// Whether a boundary of the branch depends on the rate.
    pub ends_by_rate: bool,
    /// Whether the force may depend on the rate on this branch.
    pub force_by_rate: bool,
    /// Distance of the overlap (m) and of its rate (m/s), at the transition that led to the branch, from where the event function is
    /// zero; ideally zero.
    pub residue: f64,
    pub rate_residue: f64,
    /// Whether the force begins here and now as `t^(3/2)`.
    pub begins: bool,
    /// The last panel's force, and its length.
    pub previous: Option<(Legendre, f64)>,
    /// The present interval, with the largest force until statistics began.
    pub interval: Interval,
    /// Largest force and compression since then.
    pub peak_force: Peak<Course>,
    pub peak_compression: Peak<Interpolant>,
}

/// How a contact moves on a panel: its branch, its overlap (m) and its rate (m/s; zero unless the force may depend on it).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Course {
    branch: Branch,
    overlap: Interpolant,
    rate: Interpolant,
}

impl Course {
    /// The force by the law near a place. On a panel the overlap is known more accurately than the polynomial of the force, which
    /// satisfies the law at the nodes alone.
    fn largest_force(&self, law: &dyn ContactLaw, place: f64) -> f64 {
        let (overlap, rate) = (self.overlap.evaluable(), self.rate.evaluable());
        let force = |s: f64| law.force(&self.branch, overlap.at(s)[0], rate.at(s)[0]);
        let slope = |s: f64| {
            let force = force(s);
            force.per_compression_n_m * overlap.at(s)[1] + force.per_rate_n_s_m * rate.at(s)[1]
        };
        force(turning_point(place, slope)).force_n
    }
}

/// The largest overlap near a place on a panel.
fn largest_overlap(overlap: &Interpolant, place: f64) -> f64 {
    let overlap = overlap.evaluable();
    overlap.at(turning_point(place, |s| overlap.at(s)[1]))[0]
}

impl ClosedContact {
    /// The largest force since statistics began (N).
    fn peak_force_n(&self, law: &dyn ContactLaw) -> f64 {
        self.peak_force.value(|course, place| course.largest_force(law, place))
    }
}

impl State {
    /// The speed that corresponds to the momentum (m/s).
    pub fn speed_m_s(&self) -> f64 {
        self.momentum * self.inverse_mass
    }

    /// Scales of compression and speed of the contact: the largest so far, within the range of the laws.
    pub fn scales(&self) -> Option<(f64, f64)> {
        let contact = self.closed_contact()?;
        let compression = contact.peak_compression.at_nodes().max(self.overlap);
        let speed = contact.interval.approach_speed_m_s.max(self.rate.abs());
        let within = |value: f64| (1e-30..=1e10).contains(&value);
        // for a contact that has just begun, the distance covered at its speed in a microsecond
        let compression = if within(compression) { compression } else { 1e-6 * speed };
        (within(compression) && within(speed)).then_some((compression, speed))
    }

    /// The shortest way, measured in these scales, from the present overlap and rate to a boundary: its components.
    pub fn beside(&self, boundary: &Boundary) -> (f64, f64) {
        let (compression, speed) = self.scales().unwrap_or((1.0, 1.0));
        let (by_overlap, by_rate) = (boundary.per_compression.abs() * compression, boundary.per_rate.abs() * speed);
        let way = boundary.margin(self.overlap, self.rate).abs() / by_overlap.hypot(by_rate).powi(2);
        (way * by_overlap * compression, way * by_rate * speed)
    }

    pub fn is_closed(&self) -> bool {
        matches!(self.phase, Phase::Closed(_))
    }

    /// Whether the contact is closed, and its force may depend on the rate.
    pub fn force_by_rate(&self) -> bool {
        self.closed_contact().is_some_and(|contact| contact.force_by_rate)
    }

    pub fn closed_contact(&self) -> Option<&ClosedContact> {
        match &self.phase {
            Phase::Closed(contact) => Some(contact),
            Phase::Open { .. } => None,
        }
    }

    pub fn closed_contact_mut(&mut self) -> Option<&mut ClosedContact> {
        match &mut self.phase {
            Phase::Closed(contact) => Some(contact),
            Phase::Open { .. } => None,
        }
    }

    /// Overlap at which an open contact touches (m).
    pub fn touch_m(&self) -> f64 {
        match &self.phase {
            Phase::Open { memory, .. } => memory.touch_m,
            Phase::Closed(_) => f64::NAN,
        }
    }

    /// Adds an accepted panel of `h` of a closed contact to its statistics: its force at the nodes and as a polynomial, its
    /// compression and rate at the nodes and at the end.
    pub fn accept(
        &mut self,
        law: &dyn ContactLaw,
        h: f64,
        solved: &Collocated,
        force: Legendre,
        rate: &Nodal,
        (end, end_rate): (f64, f64),
    ) {
        let Collocated { force: nodal, ends, compression, rate: exact_rate, .. } = solved;
        let work_j = self.work_j(&force, compression, end);
        let ends_of_rate = [self.rate, end_rate];
        let overlap = Interpolant::new(compression, [self.overlap, end]);
        let Phase::Closed(contact) = &mut self.phase else { return };
        contact.begins = false;
        contact.previous = Some((force, h));
        contact.interval.impulse_n_s += h * force.mean();
        let rate_if_needed = if contact.force_by_rate { ends_of_rate } else { [0.0; 2] };
        let course = Course { branch: contact.branch, overlap, rate: Interpolant::new(exact_rate, rate_if_needed) };
        contact.peak_force.note(nodal, *ends, course, |course, place| course.largest_force(law, place));
        contact.peak_compression.note(compression, Ends::SMOOTH, overlap, largest_overlap);
        let statistics = &mut self.statistics;
        statistics.contact_time_s += h;
        statistics.impulse_n_s += h * force.mean();
        statistics.squared_force_n2_s += h * dot(&BASIS.weights, &std::array::from_fn(|i| nodal[i] * nodal[i]));
        statistics.compression_work_j += compression_work(work_j, h, solved, &force, rate, ends_of_rate);
        statistics.work_j += work_j;
    }

    /// Work on the contact on a panel by quadrature (J), with its overlap at the nodes and at the end.
    pub fn work_j(&self, force: &Legendre, overlap: &Nodal, end: f64) -> f64 {
        let moved = overlap.map(|at| at - self.overlap);
        dot(&force.0, &work_of_unit_forces(&moved, end - self.overlap))
    }

    /// Begins the statistics anew, with the rest of an interval of contact.
    pub fn begin_statistics(&mut self, law: &dyn ContactLaw) {
        self.statistics = Statistics::default();
        if let Some(contact) = self.closed_contact_mut() {
            contact.interval.peak_force_n = contact.peak_force_n(law).max(contact.interval.peak_force_n);
            contact.peak_force = Peak::NONE;
        }
    }

    /// The interval that ends now.
    pub fn finish(&mut self, law: &dyn ContactLaw, released: Option<(f64, f64)>) -> Option<Interval> {
        let Phase::Closed(contact) = &mut self.phase else { return None };
        let peak_force_n = contact.peak_force_n(law);
        contact.interval.peak_force_n = peak_force_n.max(contact.interval.peak_force_n);
        contact.interval.peak_compression_m = contact.peak_compression.value(largest_overlap);
        if let Some((time_s, rate)) = released {
            contact.interval.end_s = Some(time_s);
            contact.interval.separation_speed_m_s = Some(-rate);
        }
        self.statistics.intervals += 1;
        self.statistics.largest_force_n = self.statistics.largest_force_n.max(peak_force_n);
        Some(contact.interval)
    }
}

/// Work of compression on a panel of `h` (J): that on the contact over the parts on which the rate is positive.
fn compression_work(work_j: f64, h: f64, solved: &Collocated, force: &Legendre, rate: &Nodal, ends: [f64; 2]) -> f64 {
    let everywhere = |holds: fn(f64) -> bool| rate.iter().chain(&ends).all(|rate| holds(*rate));
    if everywhere(|rate| rate >= 0.0) {
        return work_j;
    }
    if everywhere(|rate| rate <= 0.0) {
        return 0.0;
    }
    let (rates, quotient) = (Legendre::through(rate), solved.quotient(force));
    let ends = rates.at_ends();
    let between = |from: f64, to: f64| h * solved.ends.integral(&quotient, |place| rates.at(place), from, to);
    let places = BASIS.nodes.iter().zip(rate).map(|(place, rate)| (*place, *rate)).chain([(1.0, ends[1])]);
    let (mut work, mut from, mut before) = (0.0, 0.0, (0.0, ends[0]));
    for next in places {
        if (before.1 > 0.0) != (next.1 > 0.0) {
            let turns = root(before.0, next.0, EXACTLY, |place| rates.at(place)).clamp(before.0, next.0);
            if before.1 > 0.0 {
                work += between(from, turns);
            }
            from = turns;
        }
        before = next;
    }
    if before.1 > 0.0 { work + between(from, 1.0) } else { work }
}
