//! Whether surfaces overlap so far that a contact law does not describe them: a law concerns local deformation, which is small
//! compared with the bodies.

use super::Simulation;
use crate::text::{quantity, small};
use crate::trust::Check;

/// Largest compression over the thickness of the thinner body: within the range of contact laws, and beyond it.
const COMPRESSION: [f64; 2] = [0.1, 0.5];

/// The check of the contact with the largest compression in thicknesses; `None` if no thickness is known, or nothing touches.
pub(super) fn compression(found: &Simulation) -> Option<Check> {
    let of_contact = |(c, thickness_m): (usize, &Option<f64>)| {
        let peaks = found.intervals.get(c)?.iter().map(|interval| interval.peak_compression_m);
        Some((c, peaks.reduce(f64::max)?, (*thickness_m)?))
    };
    let share = |&(_, most_m, thickness_m): &(usize, f64, f64)| most_m / thickness_m;
    let contacts = found.posed.thickness_m.iter().enumerate().filter_map(of_contact);
    let worst = contacts.max_by(|one, other| share(one).total_cmp(&share(other)))?;
    let (c, most_m, _) = worst;
    let says = format!(
        "the surfaces of {} overlap by up to {}, {} of the thickness of the thinner body; a contact law describes local \
         deformation, unless it stands for a spring beside the body",
        found.posed.contacts[c],
        quantity(most_m, "m"),
        small(share(&worst))
    );
    Some(Check::new("compression", share(&worst), COMPRESSION, says))
}
