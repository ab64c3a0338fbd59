//! The rebound of a striker that falls on the structure.
//!
//! An impact leaves gravity out, which is right for every impact that is short, and for one along the ground. Where a striker falls and
//! is struck again and again, its weight changes the flights between the contacts, and thus the rebound. The impact is then solved
//! once more with the weight `m g` on the striker, up to the first flight whose highest point lies above the level of the first touch
//! by more than a hundredth of the height of its fall, `v^2/2g`. From the height `h` above that level follows what a drop test measures,
//!
//! ```text
//! e = sqrt(2 g h)/v.
//! ```
//!
//! This number comes from the modes of the answer at a loose tolerance, and is not accompanied by an uncertainty.
//!
//! Before the impact the structure is at rest under its own weight. Its motion relative to that is what it is without gravity. A structure
//! that is free to move as a rigid body would fall as well, and is not considered.

use serde::Serialize;
use vibroimpact_sim::assembly::{
    self, Assembly, Body, BodyMode, Contact, ContactSample, Force, Interval, Load, Motion, Observer, Point,
};
use vibroimpact_sim::modal::{Mode, Outcome, Solution};

use crate::impact::Impact;

/// Acceleration of gravity (m/s^2).
pub(crate) const GRAVITY_M_S2: f64 = 9.80665;
/// Gravity matters if it adds more than this share of the speed of impact during the interaction.
pub(crate) const MATTERS: f64 = 0.01;
/// If it adds more than this many times that speed, the striker lies on the structure rather than strikes it.
const MOST: f64 = 10.0;
/// Least height of a rebound, as a share of that of the fall.
const LEAST_RISE: f64 = 0.01;
/// Modes that turn by more than this (rad) in the shortest contact are left out, remainder modes excepted: they hardly vibrate.
const FASTEST: f64 = 300.0;
/// Tolerance of the solution, whose result is stated to two decimals.
const TOLERANCE: f64 = 1e-4;
/// The search ends after this many times the duration of the fall, or of the impact without gravity if that is longer.
const DURATIONS: f64 = 4.0;
/// It also ends after this many times the steps of the impact without gravity, and this many steps of one mode.
const STEPS: u64 = 2;
const MODE_STEPS: u64 = 20_000;

/// The rebound if the striker falls vertically on the structure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Falling {
    /// Restitution of a drop test: the speed that belongs to the height of the rebound, over the speed of impact.
    pub restitution: f64,
    /// Height to which the striker rises above the level at which it touched first (m); 0 without a rebound.
    pub rise_m: f64,
    /// Number of contacts before it; without a rebound, of those that were found.
    pub sub_impact_count: usize,
}

/// The speed that gravity adds during an interaction, over the speed of impact.
pub(crate) fn gain(interaction_s: f64, speed_m_s: f64) -> f64 {
    GRAVITY_M_S2 * interaction_s / speed_m_s
}

/// Whether the rebound depends on gravity, if the striker falls.
pub(crate) fn matters(impact: &Impact, solution: &Solution) -> bool {
    let (Outcome::Rebound, [first, ..]) = (solution.outcome, &*solution.sub_impacts) else { return false };
    let held = impact.structure.modes.iter().all(|mode| mode.omega_rad_s > 0.0);
    let gained = gain(solution.end_s - first.start_s, impact.striker.speed_m_s);
    held && impact.start.is_none() && impact.striker.mass_kg.is_finite() && (MATTERS..MOST).contains(&gained)
}

/// Looks for the rebound under gravity, of an impact that was solved without; `None` if the computation stopped before.
pub(crate) fn falling(impact: &Impact, solution: &Solution) -> Option<Falling> {
    let Impact { structure, striker, law, .. } = impact;
    let root = striker.mass_kg.sqrt();
    let durations_s = solution.sub_impacts.iter().map(|contact| contact.end_s - contact.start_s);
    let shortest_s = durations_s.fold(f64::INFINITY, f64::min);
    let (retained, remainder) = structure.modes.split_at(impact.kept_modes());
    let slow = retained.iter().filter(|mode| mode.omega_rad_s * shortest_s <= FASTEST);
    let (modes, shape) = slow
        .chain(remainder)
        .map(|&Mode { omega_rad_s, damping_ratio, shape }| (BodyMode { omega_rad_s, damping_ratio }, shape))
        .unzip();
    let sides = [Point::OfBody { body: 0, shape: vec![root.recip()] }, Point::OfBody { body: 1, shape }];
    let weight = Force::Constant { force_n: -GRAVITY_M_S2 };
    let assembly = Assembly {
        bodies: vec![Body::mass(striker.mass_kg, 0.0, -striker.speed_m_s), Body::at_rest(modes)],
        contacts: vec![Contact { sides, gap_m: 0.0, law: *law }],
        loads: vec![Load { body: 0, shape: vec![root], force: weight }],
    };
    let settings = assembly::Settings {
        tolerance: TOLERANCE,
        max_steps: STEPS * solution.counts.steps() + MODE_STEPS / structure.modes.len().max(1) as u64,
        ..assembly::Settings::until(DURATIONS * solution.end_s.max(striker.speed_m_s / GRAVITY_M_S2))
    };
    let height_m = striker.speed_m_s.powi(2) / (2.0 * GRAVITY_M_S2);
    let mut flights =
        Flights { least_rise_m: LEAST_RISE * height_m, contacts: 0, separated: false, highest: None, found: None };
    let run = assembly::run(&assembly, &settings, &mut flights).ok()?;
    let rebound = |(rise_m, sub_impact_count): (f64, usize)| Falling {
        restitution: (rise_m / height_m).sqrt(),
        rise_m,
        sub_impact_count,
    };
    match (flights.found, run.outcome) {
        (Some(found), _) => Some(rebound(found)),
        (None, assembly::Outcome::Stopped(_)) => None,
        // it stays on the structure
        (None, _) => Some(rebound((0.0, flights.contacts))),
    }
}

/// Looks for the first flight that is a rebound. The motion is evaluated as seldom as possible, because that takes as long as a step.
struct Flights {
    least_rise_m: f64,
    contacts: usize,
    /// Whether the bodies have just separated.
    separated: bool,
    /// When the striker will be highest in the present flight (s), and how high (m).
    highest: Option<[f64; 2]>,
    /// Height of the rebound (m), and number of contacts before.
    found: Option<(f64, usize)>,
}

impl Observer for Flights {
    fn interval(&mut self, _: usize, _: &Interval) {
        self.contacts += 1;
        self.separated = true;
    }

    fn panel(&mut self, panel: &dyn Motion) {
        if std::mem::take(&mut self.separated) {
            let start_s = panel.start_s();
            let ContactSample { displacement_m: [height_m, _], velocity_m_s: [rate_m_s, _], .. } =
                panel.contact(0, start_s);
            let rise_m = height_m + rate_m_s * rate_m_s / (2.0 * GRAVITY_M_S2);
            let rises = rate_m_s > 0.0 && rise_m > self.least_rise_m;
            self.highest = rises.then_some([start_s + rate_m_s / GRAVITY_M_S2, rise_m]);
        }
        if let Some([at_s, rise_m]) = self.highest.take_if(|[at_s, _]| *at_s <= panel.end_s()) {
            // it may have been struck again before
            let flies = !panel.contact(0, at_s).closed;
            self.found = self.found.or(flies.then_some((rise_m, self.contacts)));
        }
    }

    fn wants_panels(&self) -> bool {
        true
    }

    fn interrupts(&mut self) -> bool {
        self.found.is_some()
    }
}
