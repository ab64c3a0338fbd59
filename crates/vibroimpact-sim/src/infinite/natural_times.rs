//! How long a contact lasts by its law.

use super::kernel::Kernel;
use super::law::{Margin, Scaled};
use contact_models::Branch;

/// Part of the natural time within which the end of the first branch sets the length of panels.
const SOON: f64 = 1e-9;

/// Times that characterise a contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct NaturalTimes {
    /// In which the law without its damping, pressed at the closing speed, would take half of that speed from the striker.
    pub contact: f64,
    /// The same with its damping, except for what a plate gives way at once; or the time in which the branch would end, if
    /// that is so soon that no panel of these lengths could find it.
    pub onset: f64,
    /// In which its damping relaxes.
    pub relaxation: f64,
}

impl NaturalTimes {
    pub fn new(kernel: &Kernel, law: &Scaled<'_>, branch: &Branch, level: f64, closing: f64) -> NaturalTimes {
        let force = |h: f64, rate: f64| law.force(branch, level + closing * h, rate);
        // the part of half the speed that the law takes in a time
        let by_spring = |h: f64| force(h, 0.0).force * (h + kernel.value(h)) / (0.5 * closing);
        let by_both = |h: f64| {
            let (damped, instant) = (force(h, closing), kernel.instant());
            let damper = (damped.force - force(h, 0.0).force) / (1.0 + instant * damped.damping);
            by_spring(h) + damper * (h + kernel.value(h) - instant) / (0.5 * closing)
        };
        let contact = first_one(2.0_f64.powi(100), by_spring);
        // in which this compression would reach a boundary of the branch
        let end = |margin: Margin| {
            let (before, fall) = (margin.at(level, 0.0), -margin.per_compression * closing);
            let is_met = fall > 0.0 && margin.per_rate == 0.0 && before > 4e-15 * margin.size(level, 0.0);
            if is_met && before / fall < SOON * contact { before / fall } else { contact }
        };
        let end = law.margins(branch).into_iter().map(end).fold(contact, f64::min);
        let there = force(contact, closing);
        let relaxation = there.damping / there.stiffness;
        NaturalTimes {
            contact,
            onset: first_one(contact, by_both).min(end),
            relaxation: if relaxation.is_finite() { relaxation.abs() } else { 0.0 },
        }
    }

    /// Whether the force or a boundary of a branch depends on the rate. On a branch the force does so wherever it is not zero or
    /// nowhere (see [`ContactLaw::force`](contact_models::ContactLaw::force)): it is asked at a compression and a way from it.
    pub fn follows_rate(&self, law: &Scaled<'_>, branch: &Branch, x: f64, closing: f64) -> bool {
        let way = closing * self.contact;
        let damped = [x - way, x, x + way].iter().any(|&x| law.force(branch, x, closing).damping != 0.0);
        damped || law.margins(branch).iter().any(|margin| margin.per_rate != 0.0)
    }
}

/// The time, up to the latest, at which a growing function reaches 1; between halvings of the latest, as a power.
fn first_one(latest: f64, taken: impl Fn(f64) -> f64) -> f64 {
    let mut h = latest;
    while h > 2.0_f64.powi(-250) && taken(h) > 1.0 {
        h *= 0.5;
    }
    let (below, above) = (taken(h).ln(), taken(2.0 * h).ln());
    let part = -below / (above - below);
    if (0.0..1.0).contains(&part) { h * part.exp2() } else { h }
}
