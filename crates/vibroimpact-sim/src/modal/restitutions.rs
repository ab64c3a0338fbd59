//! How much solutions of the same impact at other tolerances differ, and the uncertainty that follows.

use super::solution::SubImpact;

/// Factor from the largest difference to the uncertainty.
const WIDENED: f64 = 3.0;
/// Share of the largest force of an impact above which differences of forces say nothing of their errors.
const ACCIDENTS: f64 = 0.05;
/// Share of the tolerance that each contact adds, as its error may vanish in all differences by accident.
const LEAST: f64 = 2.5e-3;

/// The restitution of an impact, and those that it would have if it ended after each of its contacts.
pub(crate) struct Restitutions {
    flights: Vec<Flight>,
    last: f64,
    /// For a striker that falls and stays: that of its highest flight.
    would_be: Option<f64>,
}

/// The motion after a contact.
struct Flight {
    /// When the contact began and ended (s).
    contact_s: [f64; 2],
    restitution: f64,
}

impl Restitutions {
    /// From the contacts of a run and the restitution by their impulse (N s).
    pub fn new(contacts: &[SubImpact], by: impl Fn(f64) -> f64, last: f64, would_be: Option<f64>) -> Restitutions {
        let mut impulse_n_s = 0.0;
        let after = |contact: &SubImpact| {
            impulse_n_s += contact.impulse_n_s;
            Flight { contact_s: [contact.start_s, contact.end_s], restitution: by(impulse_n_s) }
        };
        Restitutions { flights: contacts.iter().map(after).collect(), last, would_be }
    }

    /// Number of contacts.
    pub fn contacts(&self) -> usize {
        self.flights.len()
    }

    /// The largest difference from another solution of the same impact, of the last restitutions and of those in the middle of
    /// each flight. The times are compared and not the numbers of the contacts, since a graze may be missing from one of them.
    pub fn difference(&self, other: &Restitutions) -> f64 {
        if let (Some(one), Some(other)) = (self.would_be, other.would_be) {
            // no flight counts, and how high they are tells how far they are from it
            return (one - other).abs();
        }
        let of = |pair: &[Flight]| {
            let [from_s, to_s] = [pair[0].contact_s[1], pair[1].contact_s[0]];
            Some((pair[0].restitution - other.at(0.5 * (from_s + to_s))?).abs())
        };
        self.flights.windows(2).filter_map(of).fold((self.last - other.last).abs(), f64::max)
    }

    /// The restitution if the impact ended at this time; `None` during a contact.
    fn at(&self, time_s: f64) -> Option<f64> {
        let begun = self.flights.partition_point(|flight| flight.contact_s[0] < time_s);
        match begun.checked_sub(1).map(|i| &self.flights[i]) {
            Some(flight) => (flight.contact_s[1] <= time_s).then_some(flight.restitution),
            None => Some(-1.0),
        }
    }
}

/// The uncertainty after so many contacts, from the largest difference.
pub(super) fn uncertainty(spread: f64, contacts: usize, tolerance: f64) -> f64 {
    (WIDENED * spread + LEAST * contacts as f64 * tolerance).min(f64::MAX)
}

/// Estimates the errors of the largest forces from other solutions of the same impact, whose differences count by this factor. As the
/// error of a motion persists, and two motions may agree in one number by accident, a difference counts for all later contacts as well.
/// Once it is a large part of all forces, the motions have nothing but accidents in common.
pub(super) fn judge_peaks(sub_impacts: &mut [SubImpact], others: &[(&[SubImpact], f64)], tolerance: f64) {
    let largest_n = sub_impacts.iter().map(|contact| contact.peak_force_n).fold(0.0, f64::max);
    let mut spread_n = 0.0f64;
    for i in 0..sub_impacts.len() {
        let difference_n = |(other, factor): &(&[SubImpact], f64)| {
            let other = SubImpact::counterpart(i, sub_impacts, other)?;
            Some(factor * (sub_impacts[i].peak_force_n - other.peak_force_n).abs())
        };
        let differences_n: Option<Vec<f64>> = others.iter().map(difference_n).collect();
        let Some(differences_n) = differences_n else { continue };
        spread_n = differences_n.into_iter().fold(spread_n, f64::max);
        if spread_n > ACCIDENTS * largest_n {
            return;
        }
        sub_impacts[i].peak_force_uncertainty_n = Some(uncertainty(spread_n, i + 1, tolerance * largest_n));
    }
}
