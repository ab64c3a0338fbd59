//! Cases that are difficult for codes of impacts on infinite beams and plates, each with its expected result.

use crate::common::random::{config, decades};
use proptest::prelude::*;
use vibroimpact_sim::StopReason;
use vibroimpact_sim::infinite::{
    Impact, Material, Outcome, S_RANGE, Settings, Solution, Structure, critical_s, solve, turning_points,
};

fn run(s: f64) -> Solution {
    solve(Structure::Beam, s, &Settings::default()).unwrap()
}

/// `S` within 1e-9 and 1e-12 of the critical value and of each turning point, on both sides: the outcome, and the number of
/// separations (`None`: more than double precision can count).
#[test]
fn on_both_sides_of_every_critical_value() {
    let critical = critical_s();
    let mut table = vec![
        ("below critical", critical.s * (1.0 - 1e-9), Outcome::Rebound, Some(1)),
        ("closer below critical", critical.s * (1.0 - 1e-11), Outcome::Rebound, Some(1)),
        ("above critical", critical.s * (1.0 + 1e-9), Outcome::Stopped(StopReason::DigitsExhausted), None),
        ("closer above critical", critical.s * (1.0 + 1e-11), Outcome::Stopped(StopReason::DigitsExhausted), None),
        ("least S", *S_RANGE.start(), Outcome::Rebound, Some(1)),
        ("largest S", *S_RANGE.end(), Outcome::Sustained, Some(0)),
    ];
    for point in turning_points(8).unwrap() {
        for aside in [1e-6, 1e-9] {
            assert!(point.uncertainty < 0.1 * aside * point.s, "{point:?}");
            table.push(("below a turning point", point.s * (1.0 - aside), Outcome::Sustained, Some(point.n)));
            table.push(("above a turning point", point.s * (1.0 + aside), Outcome::Sustained, Some(point.n - 1)));
        }
    }
    for (name, s, outcome, separations) in table {
        let solution = run(s);
        assert_eq!(solution.outcome, outcome, "{name}: S = {s}");
        if let Some(count) = separations {
            assert_eq!(solution.separations(), count, "{name}: S = {s}");
            // The number of contacts is certain, and so are their times; digits are lost only where one grazes.
            assert!(
                solution.relative_uncertainty.unwrap() < 1e-3,
                "{name}: S = {s}: {:?}",
                solution.relative_uncertainty
            );
        } else {
            // Certainty ends where times leave the range of numbers, or the body's speed has no digits left.
            let certain = solution.certain_separations.unwrap();
            assert!(certain > 50, "{name}: S = {s}: {certain} of {}", solution.separations());
            assert_eq!(solution.rebound_ratio(), None, "{name}");
        }
        assert!(
            solution.sub_impacts.windows(2).all(|pair| pair[0].end.is_some_and(|end| end < pair[1].start)),
            "{name}"
        );
    }
}

/// Just below a turning point the n-th flight is short and shallow; just above it the compression has an equally small minimum
/// in its place. Both approach zero with the distance.
#[test]
fn grazing_contacts_on_both_sides() {
    for point in turning_points(6).unwrap() {
        let mut last = f64::INFINITY;
        for aside in [1e-4, 1e-6, 1e-8] {
            let (below, above) = (run(point.s * (1.0 - aside)), run(point.s * (1.0 + aside)));
            let parted = below.sub_impacts[point.n - 1].end.unwrap();
            let flight = below.sub_impacts[point.n].start - parted;
            assert!(flight > 0.0 && flight < last, "n = {}: {flight:e}", point.n);
            // A gap that opens as the square of time has a depth proportional to the distance from the turning point, and a
            // duration proportional to its square root: three depths decrease by a hundred each, the durations by ten.
            if last.is_finite() {
                assert!((last / flight / 10.0 - 1.0).abs() < 0.1, "n = {}: {last:e} to {flight:e}", point.n);
            }
            last = flight;
            let minima = above.extrema.iter().filter(|extremum| extremum.minimum && extremum.contact == point.n - 1);
            let least = minima.map(|extremum| extremum.compression).fold(f64::INFINITY, f64::min);
            let largest = above.extrema.iter().filter(|extremum| extremum.contact == point.n - 1);
            let largest = largest.map(|extremum| extremum.compression).fold(0.0, f64::max);
            assert!(least > 0.0 && least < 10.0 * aside * largest, "n = {}: {least:e} of {largest:e}", point.n);
        }
    }
}

/// So close above the critical value that the outcome is beyond double precision: the separations that are certain are counted,
/// and no rebound is invented.
#[test]
fn what_is_certain_just_above_the_critical_value() {
    // The number of separations that a run found before, with its "rebound".
    for (s, found) in [(1.5605177558734, 326), (1.5605177648, 985)] {
        let solution = run(s);
        assert_eq!(solution.outcome, Outcome::Stopped(StopReason::DigitsExhausted), "S = {s}");
        assert_eq!(solution.rebound_ratio(), None);
        let certain = solution.certain_separations.unwrap();
        assert!((50..=found).contains(&certain) && certain <= solution.separations(), "S = {s}: {certain}");
        // Each of them at its time: other numbers of nodes find them too.
        let other =
            solve(Structure::Beam, s, &Settings { nodes: 26, tolerance: 1e-12, ..Settings::default() }).unwrap();
        for (a, b) in solution.sub_impacts.iter().zip(&other.sub_impacts).take(certain) {
            assert!((a.start - b.start).abs() <= 0.5 * b.start, "S = {s}: {} {}", a.start, b.start);
        }
    }
    // The nearest numbers on either side: whether the body returns at all is not known.
    let critical = critical_s().s;
    for ulps in -3i64..=3 {
        let solution = run(f64::from_bits((critical.to_bits() as i64 + ulps) as u64));
        assert!(solution.outcome != Outcome::Sustained && solution.certain_separations >= Some(1), "{ulps}");
        assert!(solution.rebound_ratio().is_none_or(|ratio| ratio < 1e-13 && solution.separations() == 1), "{ulps}");
    }
}

proptest! {
    #![proptest_config(config(60))]

    /// Any `S`: contacts are in order, the speed of the body never increases, and the rebound is no faster than the approach.
    #[test]
    fn any_s(power in -12.0..8.0f64, plate in any::<bool>()) {
        let structure = if plate { Structure::Plate } else { Structure::Beam };
        let s = 10f64.powf(power);
        let solution = solve(structure, s, &Settings { estimate_uncertainty: false, max_panels: 2_000, ..Settings::default() }).unwrap();
        let mut velocity = -1.0;
        for contact in &solution.sub_impacts {
            prop_assert!(contact.closing_speed > 0.0 && contact.duration.is_none_or(|duration| duration > 0.0));
            prop_assert!(contact.striker_velocity_at_start == velocity);
            velocity = contact.striker_velocity_at_end.unwrap_or(velocity);
            prop_assert!(velocity >= contact.striker_velocity_at_start && velocity <= 1.0);
        }
        if let Some(ratio) = solution.rebound_ratio() {
            prop_assert!((0.0..=1.0).contains(&ratio));
        }
        for i in 0..=50 {
            let time = solution.known_until.min(1e3) * (f64::from(i) / 50.0);
            let state = solution.at(time).unwrap();
            prop_assert!(state.force >= 0.0 && state.striker_displacement.is_finite() && state.structure_velocity.is_finite());
        }
    }

    /// Scaling: impacts in which mass, stiffness and speed change but `S` does not are one impact in other units.
    #[test]
    fn the_same_s_in_other_units(
        radius in decades(-3.0, -1.0), speed in decades(-2.0, 1.0), mass in decades(-2.0, 2.0), stiff in decades(-2.0, 2.0),
    ) {
        let one = Impact::sphere_on_beam(Material::STEEL, 0.028, 0.028, radius, speed).unwrap();
        // S = C^10 k^2 m^8 v
        let factor = stiff.powi(2) * mass.powi(8);
        let response = factor.powf(-0.1);
        let other = Impact {
            impulse_response: one.impulse_response * response,
            stiffness_n_m1_5: one.stiffness_n_m1_5 * stiff,
            mass_kg: one.mass_kg * mass,
            ..one
        };
        let (a, b) = (one.groups().unwrap(), other.groups().unwrap());
        prop_assert!((a.s / b.s - 1.0).abs() < 1e-12, "{} {}", a.s, b.s);
        prop_assert!((b.time_s / a.time_s / (response * mass).powi(2) - 1.0).abs() < 1e-12);
        if S_RANGE.contains(&a.s) && S_RANGE.contains(&b.s) {
            let settings = Settings { max_panels: 500, ..Settings::default() };
            let (a, b) = (solve(Structure::Beam, a.s, &settings).unwrap(), solve(Structure::Beam, b.s, &settings).unwrap());
            prop_assert_eq!(a.outcome, b.outcome);
            prop_assert_eq!(a.separations(), b.separations());
            if let (Some(x), Some(y)) = (a.rebound_ratio(), b.rebound_ratio()) {
                // S itself differs by rounding; the relative decrease of the restitution per decade of S is below one.
                let stated = a.relative_uncertainty.unwrap_or(1.0) + b.relative_uncertainty.unwrap_or(1.0) + 1e-12;
                prop_assert!((x - y).abs() <= 2.0 * stated, "{} {}", x, y);
            }
        }
    }
}
