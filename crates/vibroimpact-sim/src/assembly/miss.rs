//! Near misses: surfaces that nearly touch, or that nearly part during a contact.
//!
//! A touch and a miss are compared by a speed. Near its smallest value the gap is `g + b t^2/2`. If it were smaller by `2 g`, the
//! surfaces would touch with the speed `sqrt(2 b g)`. This speed is zero at a graze, and grows alike on both sides of it. The same
//! holds for the compression of a contact above the one at which it opens.

use super::dense::Panel;
use crate::panel::root::root;

/// Accuracy of the time of a miss, as a share of the time between approach and retreat. The distance then changes only with its
/// square.
const WITHIN: f64 = 1e-8;
/// Distance of the two rates whose difference gives the acceleration, as a share of the time between approach and retreat.
const APART: f64 = 1e-3;
/// A miss is located if its estimated speed is below that of the nearest so far times this factor.
const ESTIMATED: f64 = 2.0;
/// A distance is small if it is below this share of the largest one since the contact opened or closed.
const NEAR: f64 = 0.1;

/// A contact that nearly closed, or one that nearly opened.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearMiss {
    /// Index of the contact in the list of the assembly.
    pub contact: usize,
    /// Whether it was closed and nearly opened.
    pub was_closed: bool,
    /// When it was nearest (s).
    pub time_s: f64,
    /// The gap then, or the compression above that of separation (m).
    pub distance_m: f64,
    /// The speed at the event if the distance had been smaller by twice that amount (m/s).
    pub speed_m_s: f64,
}

/// A contact and its distance from its next touch or separation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Distance {
    pub is_closed: bool,
    pub distance_m: f64,
    /// Rate at which it decreases (m/s).
    pub approach_m_s: f64,
}

/// The same with the largest distance since the contact opened or closed (m).
#[derive(Debug, Clone, Copy)]
struct Seen {
    now: Distance,
    widest_m: f64,
}

/// The search for the nearest miss along a run.
#[derive(Debug, Default)]
pub(super) struct Misses {
    before: Vec<Option<Seen>>,
    before_s: f64,
    pub nearest: Option<NearMiss>,
}

impl Misses {
    /// Whether a contact has come nearest since the last call, from the distances now, where they are known. `panel` is the motion
    /// since then, if it is known.
    pub fn look(&mut self, time_s: f64, now: impl Iterator<Item = Option<Distance>>, panel: Option<&Panel>) {
        let passed = time_s > self.before_s;
        let before = std::mem::take(&mut self.before);
        for (contact, now) in now.enumerate() {
            let seen = before.get(contact).copied().flatten();
            let before = seen.filter(|seen| now.is_some_and(|now| now.is_closed == seen.now.is_closed));
            let widest_m = before.map_or(0.0, |before| before.widest_m);
            self.before.push(now.map(|now| Seen { now, widest_m: widest_m.max(now.distance_m) }));
            if let (Some(before), Some(now), Some(panel)) = (before, now, panel)
                && before.now.approach_m_s > 0.0
                && now.approach_m_s <= 0.0
                && passed
            {
                self.compare(contact, before, now, [self.before_s, time_s], panel);
            }
        }
        self.before_s = time_s;
    }

    fn compare(&mut self, contact: usize, before: Seen, now: Distance, between_s: [f64; 2], panel: &Panel) {
        let Seen { now: Distance { distance_m, approach_m_s, .. }, widest_m } = before;
        let bend = (approach_m_s - now.approach_m_s) / (between_s[1] - between_s[0]);
        let estimated = (2.0 * bend * distance_m - approach_m_s.powi(2)).max(0.0).sqrt();
        if self.nearest.is_some_and(|nearest| estimated > ESTIMATED * nearest.speed_m_s) {
            return;
        }
        let found = nearest(panel, contact, before.now, between_s);
        let nearer = self.nearest.is_none_or(|nearest| found.speed_m_s < nearest.speed_m_s);
        if nearer && found.distance_m < NEAR * widest_m {
            self.nearest = Some(found);
        }
    }
}

/// The nearest point between a time at which the distance is given and decreases, and one at which it grows.
fn nearest(panel: &Panel, contact: usize, before: Distance, [from, to]: [f64; 2]) -> NearMiss {
    let sign = if before.is_closed { -1.0 } else { 1.0 };
    let at = |share: f64| {
        let sample = panel.contact_after(contact, from + share * (to - from) - panel.stretch.start_s);
        [sign * sample.overlap_m, sign * sample.rate_m_s]
    };
    let turn = root(0.0, 1.0, WITHIN, |share| at(share)[1]).clamp(0.0, 1.0);
    let distance_m = (before.distance_m + at(0.0)[0] - at(turn)[0]).max(0.0);
    let bend = (at(turn - APART)[1] - at(turn + APART)[1]) / (2.0 * APART * (to - from));
    let speed_m_s = (2.0 * bend.max(0.0) * distance_m).sqrt();
    NearMiss { contact, was_closed: before.is_closed, time_s: from + turn * (to - from), distance_m, speed_m_s }
}
