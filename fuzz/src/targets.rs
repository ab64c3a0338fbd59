//! The functions that the fuzzer calls. `cargo test` applies the same functions to every file of the corpus, without a fuzzer
//! (`crates/vibroimpact/tests/fuzz_corpus.rs`).

use arbitrary::{Arbitrary, Result, Unstructured};
use vibroimpact::contact_models::{
    Flores, Hertz, HuntCrossley, Hysteretic, KelvinVoigt, LankaraniNikravesh, Law, LinearSpring, Thornton, Viscous,
};
use vibroimpact::sweep::Sweep;
use vibroimpact::vibroimpact_sim::infinite;
use vibroimpact::vibroimpact_sim::modal::{Mode, Settings, Solution, Solver, Start, Striker, Structure};
use vibroimpact::{Scene, net};

/// A scene file, JSON or TOML: it is read, written and read again, converted, and solved within limits.
pub fn scene(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(scene) = Scene::from_json(text).or_else(|_| Scene::from_toml(text)) else { return };
    let again = Scene::from_json(&scene.to_json());
    assert!(again.is_ok_and(|again| again == scene), "a scene is not read as it was written");
    if let Ok(toml) = scene.to_toml() {
        let again = Scene::from_toml(&toml);
        assert!(again.is_ok_and(|again| again == scene), "a scene is not read as it was written in TOML");
    }
    if let Ok(impact) = scene.infinite_impact() {
        infinite_structure(&impact);
        return;
    }
    // Thousands of modes are valid, but too expensive for a fuzzer.
    if scene.modes.count().is_some_and(|modes| modes > 50) {
        return;
    }
    let Ok(impact) = scene.impact() else { return };
    let settings = Settings { max_steps: 500, max_sub_impacts: 50, ..impact.settings };
    let solved =
        Solver::new(&impact.structure).and_then(|solver| solver.solve(&impact.striker, &impact.law, None, &settings));
    if let Ok(solution) = solved {
        sound(&solution);
    }
}

/// An impact on an infinite beam or plate: contacts are in order, and the speed of the body never increases.
fn infinite_structure(impact: &infinite::Impact) {
    let settings = infinite::Settings { max_panels: 200, ..infinite::Settings::default() };
    let Ok(groups) = impact.groups() else { return };
    let Ok(solution) = infinite::solve(impact.structure, groups.s, &settings) else { return };
    let (mut now, mut speed) = (0.0, 1.0);
    for contact in &solution.sub_impacts {
        assert!(contact.start >= now && contact.closing_speed > 0.0, "{contact:?} after {now}");
        let slower = contact.striker_velocity_at_end.map_or(speed, |velocity| -velocity);
        assert!(slower <= speed && slower >= -1.0, "{contact:?} at {speed}");
        (now, speed) = (contact.end.unwrap_or(now), slower);
    }
    assert!(solution.rebound_ratio().is_none_or(|e| (0.0..=1.0).contains(&e)), "S = {}", groups.s);
}

/// A sweep file, JSON or TOML, with its scene in it: it is read, and scenes of its points are converted.
pub fn sweep(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(sweep) = Sweep::from_json(text).or_else(|_| Sweep::from_toml(text)) else { return };
    let last = sweep.points() - 1;
    for point in [0, last / 3, last] {
        let values = sweep.values(point);
        assert_eq!(values.len(), sweep.fields().count());
        assert_eq!(values, sweep.values(point), "a point is not a function of its number");
        // Values that are not a scene are a row with its error.
        let _ = sweep.scene(point);
    }
}

/// A table of measured restitutions.
pub fn data_table(bytes: &[u8]) {
    if let Ok(table) = net::parse(bytes) {
        for datum in table {
            let values = [datum.mass_kg, datum.location_m, datum.restitution];
            assert!(datum.line > 1 && values.iter().all(|value| value.is_finite()), "{datum:?}");
        }
    }
}

/// An impact of a few modes and arbitrary numbers, solved within limits.
pub fn impact(bytes: &[u8]) {
    let mut unstructured = Unstructured::new(bytes);
    if let Ok((structure, striker, law, start, settings)) = posed(&mut unstructured) {
        let solved = Solver::new(&structure).and_then(|solver| solver.solve(&striker, &law, start.as_ref(), &settings));
        if let Ok(solution) = solved {
            sound(&solution);
        }
    }
}

type Posed = (Structure, Striker, Law, Option<Start>, Settings);

fn posed(from: &mut Unstructured) -> Result<Posed> {
    let count = from.int_in_range(0..=6)?;
    let mut modes = Vec::with_capacity(count);
    for _ in 0..count {
        modes.push(Mode { omega_rad_s: number(from)?, damping_ratio: number(from)?, shape: number(from)? });
    }
    let structure = Structure { modes };
    let striker = Striker { mass_kg: number(from)?, speed_m_s: number(from)? };
    let law = law(from)?;
    let start = if bool::arbitrary(from)? {
        let amplitude = (0..count).map(|_| number(from)).collect::<Result<_>>()?;
        let rate = (0..count).map(|_| number(from)).collect::<Result<_>>()?;
        Some(Start { amplitude, rate, gap_m: number(from)? })
    } else {
        None
    };
    let tolerance = 10f64.powi(-from.int_in_range(1..=13)?);
    Ok((
        structure,
        striker,
        law,
        start,
        Settings { tolerance, max_steps: 500, max_sub_impacts: 50, ..Settings::default() },
    ))
}

/// Mostly a number of moderate size, with few digits; sometimes arbitrary bits.
fn number(from: &mut Unstructured) -> Result<f64> {
    Ok(match from.int_in_range(0..=9u8)? {
        0 => f64::arbitrary(from)?,
        1 => 0.0,
        _ => f64::from(u8::arbitrary(from)?) / 16.0 * 10f64.powi(from.int_in_range(-12..=12)?),
    })
}

fn law(from: &mut Unstructured) -> Result<Law> {
    let k = number(from)?;
    let law = match from.int_in_range(0..=8u8)? {
        0 => Hertz::new(k).map(Law::from),
        1 => Viscous::new(k, number(from)?).map(Law::from),
        2 => Hysteretic {
            stiffness_n_m1_5: k,
            theta_m: number(from)?,
            beta: number(from)?,
            k_bar: number(from)?,
            epsilon_m: number(from)?,
        }
        .validated()
        .map(Law::from),
        3 => LinearSpring::new(k).map(Law::from),
        4 => KelvinVoigt::new(k, number(from)?).map(Law::from),
        5 => HuntCrossley::new(k, number(from)?, number(from)?).map(Law::from),
        6 => LankaraniNikravesh::new(k, number(from)?).map(Law::from),
        7 => Flores::new(k, number(from)?).map(Law::from),
        _ => Thornton::new(k, number(from)?, number(from)?).map(Law::from),
    };
    law.map_err(|_| arbitrary::Error::IncorrectFormat)
}

fn sound(solution: &Solution) {
    let state = solution.amplitude.iter().chain(&solution.rate).chain([&solution.striker_velocity_m_s]);
    assert!(state.into_iter().all(|value| value.is_finite()), "{solution:?}");
    assert!(solution.restitution.is_none_or(f64::is_finite), "{solution:?}");
    let mut now = 0.0;
    for contact in &solution.sub_impacts {
        assert!(contact.start_s >= now && contact.end_s >= contact.start_s, "{solution:?}");
        assert!(contact.impulse_n_s.is_finite() && contact.peak_force_n.is_finite(), "{solution:?}");
        now = contact.end_s;
    }
}
