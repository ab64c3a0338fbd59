//! The quantities of an impact whose uncertainty is estimated from other impacts, and their changes.

use vibroimpact_sim::modal::{Outcome, Solution, Striker, SubImpact};

use super::wall::Wall;
use crate::impact::Impact;

/// Weight of a change of the motion behind a quantity.
const MOTION: f64 = 0.5;
/// A touch may come before or after a falling striker turns round if the time between the two is below this share of the rise, and differs
/// between two solutions by more than the second share of itself.
const NEARLY: f64 = 0.1;
const CHANGED: f64 = 0.1;

/// A quantity of an impact.
pub(super) enum Quantity<'a> {
    /// The restitution.
    Restitution {
        /// `(1/m + sum phi^2)/v`, with the rigid-body motions `phi` of the structure and the speed of approach `v`: its change per
        /// impulse (1/(N s)).
        per_impulse: f64,
        /// The speed at the start as a share of `v`.
        from: f64,
        /// `g/v`: its change per time in a fall (1/s); otherwise 0.
        per_time: f64,
        /// The time in which the striker would cross the largest compression on an immovable surface at the speed of approach (s), about
        /// a third of the duration of that contact. A flight that is shorter counts by its share of this time.
        crossing_s: f64,
    },
    /// The largest force of number `i` of these intervals of contact (N).
    PeakForce { of: &'a [SubImpact], i: usize },
}

/// Difference between two solutions in a quantity, in its unit.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Change {
    /// Of the quantity itself. If only one solution has it, it is 1 for a restitution, and infinite for a force.
    pub itself: f64,
    /// Of the motion behind it, because two solutions may agree in one number by accident. For a restitution, of the speed of a
    /// flight between two contacts, relative to the rigid-body motion of the structure and as a share of the speed of impact: of the
    /// restitution that the impact would have if it ended there. A flight that is short compared with a contact counts less. Under a
    /// strong dashpot the surfaces part for a moment with every wave of the fast modes, which differs from one number of modes to the
    /// next; what it changes in the motion shows in the longer flights. For a force, of the impulse of the same contact, as a share of it
    /// that is taken of the force.
    pub motion: f64,
}

impl Change {
    /// As an error of the quantity.
    pub fn size(self) -> f64 {
        self.itself.max(MOTION * self.motion)
    }
}

impl Quantity<'_> {
    /// The restitution of an impact.
    pub fn restitution(impact: &Impact) -> Quantity<'static> {
        let speed = impact.approach_m_s();
        let per_impulse = impact.structure.mobility_per_kg(&impact.striker) / speed;
        let from = if impact.gravity_m_s2 > 0.0 { impact.striker.speed_m_s / speed } else { 1.0 };
        let striker = Striker { mass_kg: (per_impulse * speed).recip(), speed_m_s: speed };
        let crossing_s = Wall::new(&impact.law, &striker).compression_m / speed;
        Quantity::Restitution { per_impulse, from, per_time: impact.gravity_m_s2 / speed, crossing_s }
    }

    /// Its value in a solution.
    pub fn value(&self, solution: &Solution) -> Option<f64> {
        match self {
            Quantity::Restitution { .. } => solution.restitution,
            Quantity::PeakForce { .. } => self.contact(solution).map(|contact| contact.peak_force_n),
        }
    }

    /// What a share of the energy or of the momentum of the impact changes in it, if all of it does.
    pub fn scale(&self) -> f64 {
        match self {
            Quantity::Restitution { .. } => 1.0,
            Quantity::PeakForce { of, .. } => of.iter().map(|contact| contact.peak_force_n).fold(0.0, f64::max),
        }
    }

    /// Whether fast modes change it as much as they move, and not only by the momentum that they take up.
    pub fn is_of_an_instant(&self) -> bool {
        matches!(self, Quantity::PeakForce { .. })
    }

    /// Its change from one solution to another.
    pub fn change(&self, a: &Solution, b: &Solution) -> Change {
        let unknown = match self {
            Quantity::Restitution { .. } => 1.0,
            Quantity::PeakForce { .. } => f64::INFINITY,
        };
        let mut itself = self.value(a).zip(self.value(b)).map_or(unknown, |(a, b)| (a - b).abs());
        let both_stay = [a, b].iter().all(|solution| solution.outcome == Outcome::Sustained);
        let motion = match *self {
            // a striker that falls and stays has no flight that counts, and how high they are tells how far they are from it
            Quantity::Restitution { per_time, .. } if per_time > 0.0 && both_stay => {
                let [a, b] = [a, b].map(|solution| solution.highest_flight.max(0.0).sqrt());
                (a - b).abs()
            }
            Quantity::Restitution { per_impulse, from, per_time, crossing_s }
                if per_impulse > 0.0 && per_impulse.is_finite() =>
            {
                let of = |solution: &Solution| flights(solution, per_impulse, from, per_time);
                let (of_a, of_b) = (of(a), of(b));
                if per_time > 0.0 && turn_differs(&touches(a, &of_a, per_time), &touches(b, &of_b, per_time)) {
                    itself = unknown;
                }
                let [of_a, of_b] =
                    [(a, of_a), (b, of_b)].map(|(solution, flights)| weighted(solution, flights, crossing_s));
                distance(&of_a, &of_b)
            }
            Quantity::Restitution { .. } => 0.0,
            Quantity::PeakForce { of, i } => {
                let impulses = self.contact(a).zip(self.contact(b)).map(|(a, b)| [a.impulse_n_s, b.impulse_n_s]);
                let share = impulses.map_or(0.0, |[a, b]| (a - b).abs() / a.abs().max(b.abs()).max(f64::MIN_POSITIVE));
                share * of[i].peak_force_n
            }
        };
        Change { itself, motion }
    }

    /// The interval of contact of another solution whose force this is.
    fn contact<'s>(&self, solution: &'s Solution) -> Option<&'s SubImpact> {
        match self {
            Quantity::Restitution { .. } => None,
            Quantity::PeakForce { of, i } => SubImpact::counterpart(*i, of, &solution.sub_impacts),
        }
    }
}

/// The restitution that the impact would have if it ended with each of its separations, by the velocity alone.
fn flights(solution: &Solution, per_impulse: f64, from: f64, per_time: f64) -> Vec<f64> {
    let mut sum = 0.0;
    let separations = solution.sub_impacts.iter();
    separations
        .map(|contact| {
            sum += contact.impulse_n_s;
            sum * per_impulse - from - contact.end_s * per_time
        })
        .collect()
}

/// For each flight on which a falling striker rises, the time from its highest point to the next touch, as a share of the duration of the
/// rise. It is negative if the touch comes first.
fn touches(solution: &Solution, flights: &[f64], per_time: f64) -> Vec<f64> {
    let contacts = &solution.sub_impacts;
    let after = |(i, restitution): (usize, &f64)| {
        let rises_s = restitution / per_time;
        let until_s = match contacts.get(i + 1) {
            Some(next) => next.start_s - contacts[i].end_s - rises_s,
            None => solution.until_touch_s,
        };
        (rises_s > 0.0).then(|| until_s / rises_s)
    };
    flights.iter().enumerate().filter_map(after).collect()
}

/// Whether a touch that is close to the highest point of a flight differs so much that it may come before or after it.
fn turn_differs(a: &[f64], b: &[f64]) -> bool {
    let differs = |(a, b): (&f64, &f64)| {
        let nearest = a.abs().min(b.abs());
        nearest < NEARLY && (a - b).abs() > CHANGED * nearest
    };
    a.iter().zip(b).any(differs)
}

/// Each flight with its weight: its duration as a share of this time, at most 1. The last flight has no end.
fn weighted(solution: &Solution, flights: Vec<f64>, crossing_s: f64) -> Vec<(f64, f64)> {
    let contacts = &solution.sub_impacts;
    let weight = |i: usize| match contacts.get(i + 1) {
        Some(next) if next.start_s - contacts[i].end_s < crossing_s => (next.start_s - contacts[i].end_s) / crossing_s,
        _ => 1.0,
    };
    flights.into_iter().enumerate().map(|(i, flight)| (flight, weight(i))).collect()
}

/// Largest weighted difference between the flights of one impact and the nearest ones of another.
fn distance(a: &[(f64, f64)], b: &[(f64, f64)]) -> f64 {
    let nearest = |x: f64, of: &[(f64, f64)]| of.iter().map(|(y, _)| (x - y).abs()).fold(f64::INFINITY, f64::min);
    let directed = |of: &[(f64, f64)], to: &[(f64, f64)]| {
        of.iter().map(|(x, weight)| weight * nearest(*x, to)).fold(0.0, f64::max)
    };
    if a.is_empty() && b.is_empty() { 0.0 } else { directed(a, b).max(directed(b, a)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impacts_are_as_far_apart_as_their_flights() {
        let long = |flights: &[f64]| flights.iter().map(|flight| (*flight, 1.0)).collect::<Vec<_>>();
        assert_eq!(distance(&[], &[]), 0.0);
        assert_eq!(distance(&long(&[1.0, 1.5]), &long(&[1.0, 1.5])), 0.0);
        // a third contact that does not change the result
        assert_eq!(distance(&long(&[1.0, 1.5]), &long(&[1.0, 1.25, 1.5])), 0.25);
        assert_eq!(distance(&long(&[1.0, 1.5]), &[(1.0, 1.0), (1.25, 0.1), (1.5, 1.0)]), 0.025);
        assert_eq!(distance(&long(&[1.0]), &[]), f64::INFINITY);
    }

    #[test]
    fn a_touch_counts_where_a_change_may_move_it_across_the_highest_point() {
        assert!(!turn_differs(&[1e-3, f64::INFINITY], &[1.02e-3, f64::INFINITY]));
        assert!(turn_differs(&[0.5, 1e-3], &[0.5, 1.2e-3]));
        assert!(turn_differs(&[-1e-3], &[1e-3]));
        // far from there, it may change much
        assert!(!turn_differs(&[0.3, f64::INFINITY], &[0.8, 2.0]));
    }

    /// On a free beam that is much lighter than the striker, at rest and in motion.
    #[test]
    fn a_flight_counts_as_the_restitution_of_an_impact_that_ends_with_it() {
        let mut scene = serde_json::json!({
            "structure": { "kind": "beam", "ends": ["free", "free"], "damping_ratio": 0.02, "segments": [
                { "length_m": 0.3, "flexural_rigidity_n_m2": 20.0, "mass_per_length_kg_m": 0.2 }
            ] },
            "striker": { "mass_kg": 3.0, "speed_m_s": 0.5 },
            "contact": { "law": "linear-spring", "stiffness_n_m": 1e6 }, "location_m": 0.1, "modes": 6
        });
        for start in [
            serde_json::Value::Null,
            serde_json::json!({ "gap_m": 1e-4, "moving_modes": [
            { "mode": 1, "velocity_m_s": 0.2, "location_m": 0.1 }
        ] }),
        ] {
            if !start.is_null() {
                scene["start"] = start;
            }
            let impact = crate::Scene::from_value(&scene).unwrap().impact().unwrap();
            let solution = impact.solve().unwrap();
            let Quantity::Restitution { per_impulse, from, per_time, .. } = Quantity::restitution(&impact) else {
                unreachable!()
            };
            let last = flights(&solution, per_impulse, from, per_time).pop().unwrap();
            assert!((last - solution.restitution.unwrap()).abs() < 1e-8, "{last}, {solution:?}");
        }
    }
}
