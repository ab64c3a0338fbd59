//! A ball on an infinite beam: the solver made for it, the general Volterra methods, and the semi-analytical solution.
//!
//! First contacts are compared with 25-digit solutions by one global panel (`crates/vibroimpact-sim/tests/data`). The whole
//! contact history at `S = 15`, four separations and then sustained contact, has no such reference: the two spectral methods
//! share no code, and each is the reference of the other.

use crate::measure::{Effort, Found, Origin, Row, Solver, sweep};
use fracdiff::{Collocation, Convolution, Direction, Event, GalerkinStates, Method, SumOfExponentials, Term, Volterra};
use std::sync::OnceLock;
use vibroimpact_sim::infinite::{FirstContact, Settings, Solution, Structure, solve};

const FIRST_CONTACTS: &str = include_str!("../../../crates/vibroimpact-sim/tests/data/infinite_first_contact.csv");

/// Final time of the whole contact history at `S = 15`, for methods that need one.
const STORY_END: f64 = 200.0;

/// Duration and rebound ratio of the first contact, from the finer of the table's two resolutions.
///
/// # Errors
/// An `s` that the table does not contain.
pub fn first_contact(s: f64) -> Result<(f64, f64), String> {
    let rows = FIRST_CONTACTS.lines().skip(1).filter_map(|line| {
        let cells: Vec<f64> = line.split(',').filter_map(|cell| cell.parse().ok()).collect();
        <[f64; 4]>::try_from(cells).ok()
    });
    let finest = rows.filter(|row| row[0] == s).max_by(|a, b| a[1].total_cmp(&b[1]));
    finest.map(|row| (row[2], row[3])).ok_or_else(|| format!("no reference for S = {s}"))
}

/// Compression and speed of the ball, `x = t - int [(t-s) + sqrt(t-s)] f ds`, `u = 1 - int f ds`, with the changes of contact
/// as events.
fn volterra<'a>(s: f64, terminal: bool) -> Volterra<'a> {
    let term = |unknown, order| Term { unknown, density: 0, order, coefficient: -1.0 };
    let event = Event::new(|_, y: &[f64]| y[0]).direction(if terminal { Direction::Falling } else { Direction::Any });
    Volterra {
        unknowns: 2,
        densities: 1,
        terms: vec![term(0, 2.0), term(0, 1.5), term(1, 1.0)],
        forcing: Box::new(|t, g| {
            if let [x, u] = g {
                (*x, *u) = (t, 1.0);
            }
        }),
        density: Box::new(move |_, y, f| {
            if let (Some(x), [f]) = (y.first(), f) {
                *f = s.sqrt() * x.max(0.0).powf(1.5);
            }
        }),
        breaks: Vec::new(),
        events: vec![if terminal { event.terminal() } else { event }],
    }
}

fn own_settings(tolerance: f64) -> Settings {
    // The tolerance applies to a panel's last coefficients; the remaining error is far below the resolution of this many nodes.
    let nodes = match tolerance {
        5e-4.. => 8,
        1e-7.. => 12,
        _ => 20,
    };
    Settings { nodes, tolerance, estimate_uncertainty: false, ..Settings::default() }
}

/// Every change of contact: separation, touch, separation, and so on.
fn changes(solution: &Solution) -> Vec<f64> {
    let ends = solution.sub_impacts.iter().flat_map(|contact| [Some(contact.start), contact.end]);
    ends.flatten().skip(1).collect()
}

fn whole_story(found: &[f64], wanted: &[f64]) -> Vec<(&'static str, f64)> {
    let worst = if found.len() == wanted.len() {
        found.iter().zip(wanted).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max)
    } else {
        1.0
    };
    let separations = |times: &[f64]| times.len().div_ceil(2) as f64;
    vec![
        ("times of touch and separation", worst),
        ("number of separations", (separations(found) - separations(wanted)).abs()),
    ]
}

/// Name of a method, its settings, and the method for a setting.
type General = (&'static str, Vec<f64>, fn(f64) -> Method);

/// The methods of `fracdiff` with their sweeps.
fn general_methods(effort: &Effort) -> Vec<General> {
    let steps: Vec<f64> =
        [16.0, 32.0, 125.0, 500.0, 2000.0, 8000.0].into_iter().take(if effort.quick { 3 } else { 6 }).collect();
    vec![
        ("fracdiff collocation", effort.tolerances(3, 13), |tolerance| {
            Method::Collocation(Collocation { tolerance, ..Collocation::default() })
        }),
        ("fracdiff trapezoidal", steps.clone(), |n| Method::Trapezoidal(Convolution { steps: n as usize })),
        ("fracdiff sum of exponentials", steps.clone(), |n| {
            Method::SumOfExponentials(SumOfExponentials { steps: n as usize, ..SumOfExponentials::default() })
        }),
        ("fracdiff Galerkin states", steps.clone(), |n| {
            Method::GalerkinStates(GalerkinStates { steps: n as usize, ..GalerkinStates::default() })
        }),
        ("fracdiff Gruenwald-Letnikov", steps.clone(), |n| Method::GrunwaldLetnikov(Convolution { steps: n as usize })),
        ("fracdiff L1", steps, |n| Method::L1(Convolution { steps: n as usize })),
    ]
}

/// Difference between the two spectral methods over the whole contact history at `S = 15`: the floor of its errors.
///
/// # Errors
/// If either cannot solve it.
pub fn story_floor() -> Result<f64, String> {
    let (own, general) = story_references().as_ref().map_err(String::clone)?;
    whole_story(own, general).first().map(|norm| norm.1).ok_or_else(|| "no norm".into())
}

type Story = (Vec<f64>, Vec<f64>);

/// The contact history by both methods at their finest settings, computed once.
fn story_references() -> &'static Result<Story, String> {
    static STORY: OnceLock<Result<Story, String>> = OnceLock::new();
    STORY.get_or_init(|| story_by_both(1e-12))
}

fn story_by_both(tolerance: f64) -> Result<Story, String> {
    let own = solve(Structure::Beam, 15.0, &Settings { nodes: 28, ..own_settings(1e-14) });
    let own = changes(&own.map_err(|error| error.to_string())?);
    let method = Method::Collocation(Collocation { tolerance, ..Collocation::default() });
    let general = volterra(15.0, false).solve(&method, STORY_END).map_err(|error| error.to_string())?;
    Ok((own, general.events.iter().map(|hit| hit.t).collect()))
}

/// First contacts at `S = 1, 15, 1000` and the whole contact history at `S = 15`.
///
/// # Errors
/// If a reference is missing.
pub fn rows(effort: &Effort) -> Result<Vec<Row>, String> {
    let mut rows = Vec::new();
    for (name, s) in [("beam-S1", 1.0), ("beam-S15", 15.0), ("beam-S1000", 1000.0)] {
        let (duration, ratio) = first_contact(s)?;
        let errors = |found_duration: f64, found_ratio: f64| {
            vec![
                ("rebound ratio", (found_ratio - ratio).abs()),
                ("time of separation", (found_duration / duration - 1.0).abs()),
            ]
        };
        let own = Solver { name: "vibroimpact infinite", origin: Origin::Own, cost_unit: "panels" };
        rows.extend(sweep(name, own, &effort.tolerances(3, 14), effort, |tolerance| {
            // No further than the others, which stop at the first separation.
            let settings = Settings { max_sub_impacts: 1, ..own_settings(tolerance) };
            let solution = solve(Structure::Beam, s, &settings).map_err(|error| error.to_string())?;
            let first = solution.sub_impacts.first().and_then(|contact| contact.duration).ok_or("no separation")?;
            let ratio = solution.first_rebound_ratio().ok_or("no separation")?;
            Ok(Found { cost: solution.panels_tried as u64, errors: errors(first, ratio) })
        }));
        let semi = Solver { name: "semi-analytical", origin: Origin::Own, cost_unit: "functions" };
        let functions: Vec<f64> = (2..=16).step_by(if effort.quick { 4 } else { 2 }).map(f64::from).collect();
        rows.extend(sweep(name, semi, &functions, effort, |n| {
            let contact = FirstContact::at_s(s, n as usize).map_err(|error| error.to_string())?;
            Ok(Found { cost: n as u64, errors: errors(contact.duration(), contact.rebound_ratio()) })
        }));
        for (method, settings, make) in general_methods(effort) {
            let solver = Solver { name: method, origin: Origin::Peer, cost_unit: "evaluations of the law" };
            rows.extend(sweep(name, solver, &settings, effort, |setting| {
                let solution = volterra(s, true).solve(&make(setting), 1.1 * duration).map_err(|e| e.to_string())?;
                let hit = solution.events.first().ok_or("no separation up to the end")?;
                let speed = hit.y.get(1).ok_or("no speed")?;
                Ok(Found { cost: solution.counts.evaluations, errors: errors(hit.t, -speed) })
            }));
        }
    }
    // Its reference alone takes seconds.
    if !effort.quick {
        rows.extend(story(effort)?);
    }
    Ok(rows)
}

fn story(effort: &Effort) -> Result<Vec<Row>, String> {
    let name = "beam-S15-story";
    let (by_own, by_general) = story_references().as_ref().map_err(String::clone)?;
    let own = Solver { name: "vibroimpact infinite", origin: Origin::Own, cost_unit: "panels" };
    let mut rows = sweep(name, own, &effort.tolerances(3, 14), effort, |tolerance| {
        let solution = solve(Structure::Beam, 15.0, &own_settings(tolerance)).map_err(|error| error.to_string())?;
        Ok(Found { cost: solution.panels_tried as u64, errors: whole_story(&changes(&solution), by_general) })
    });
    for (method, settings, make) in general_methods(effort).into_iter().take(3) {
        let solver = Solver { name: method, origin: Origin::Peer, cost_unit: "evaluations of the law" };
        rows.extend(sweep(name, solver, &settings, effort, |setting| {
            let solution = volterra(15.0, false).solve(&make(setting), STORY_END).map_err(|e| e.to_string())?;
            let found: Vec<f64> = solution.events.iter().map(|hit| hit.t).collect();
            Ok(Found { cost: solution.counts.evaluations, errors: whole_story(&found, by_own) })
        }));
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_spectral_methods_agree() {
        let (own, general) = story_by_both(1e-8).unwrap();
        let difference = whole_story(&own, &general);
        assert!(difference[0].1 < 1e-6 && difference[1].1 == 0.0, "{difference:?}");
    }
}
