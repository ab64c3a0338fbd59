//! The modes of a structure.

use std::f64::consts::TAU;

use crate::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use crate::scene::{Beam, InvalidInput, Location, Scene, Structure};
use crate::text::quantity;

/// Modes whose shape along the beam is drawn.
const DRAWN: usize = 30;
/// Points along a beam, beside the place of impact.
const POINTS: usize = 400;
/// Height of many shapes (px).
const TALLEST_PX: f64 = 760.0;
/// Largest displacement of a shape, where neighbours are 1 apart.
const AMPLITUDE: f64 = 0.42;

/// The shapes of the first thirty of `count` modes along a beam, each scaled to its largest displacement, with the place
/// of impact; below, the mass-normalised shape at that place of all `count` modes against frequency. Of a structure
/// that is given by its modes only the latter is known.
///
/// # Errors
/// As [`Scene::mode_shapes`].
///
/// ```
/// let scene = vibroimpact::Scene::from_json(r#"{
///     "structure": { "kind": "beam", "ends": ["pinned", "pinned"],
///                    "segments": [{ "length_m": 1, "flexural_rigidity_n_m2": 274, "mass_per_length_kg_m": 1 }] },
///     "striker": { "mass_kg": 0.1, "speed_m_s": 1 },
///     "contact": { "law": "hertz", "stiffness_n_m1_5": 1.8e10 }, "location_m": 0.4, "modes": 100
/// }"#)?;
/// let svg = vibroimpact::pictures::modes(&scene, 6)?.svg().expect("a picture");
/// assert!(svg.contains("place along the beam (m)"));
/// # Ok::<(), vibroimpact::SceneError>(())
/// ```
pub fn modes(scene: &Scene, count: usize) -> Result<Figure, InvalidInput> {
    let modes = scene.mode_shapes(count)?;
    let frequency: Vec<f64> = modes.iter().map(|mode| mode.omega_rad_s / TAU).collect();
    let shape: Vec<f64> = modes.iter().map(|mode| mode.shape).collect();
    let at_place = Panel::new(Axis::new("frequency").unit("Hz"), Axis::new("shape there").unit("1/√kg"))
        .title("Mass-normalised shape at the place of impact")
        .height(130.0)
        .with(Series::horizontal_rule(0.0))
        .with(Series::stem(&frequency, &shape, Marker::Dot).colour(Colour::Vermilion).line_width(0.8));
    let figure = Figure::new(match modes.len() {
        1 => "The first mode".to_owned(),
        n => format!("The first {n} modes"),
    });
    Ok(match (&scene.structure, scene.location_m) {
        (Structure::Beam(beam), Some(Location::Along(location_m))) => {
            let drawn = frequency.get(..count.min(DRAWN)).unwrap_or(&frequency);
            figure.row([along(beam, location_m, drawn, count)?]).row([at_place])
        }
        _ => figure.row([at_place]),
    })
}

/// Shapes above each other, the first at the bottom; `count` modes were asked for.
fn along(beam: &Beam, location_m: f64, frequency_hz: &[f64], count: usize) -> Result<Panel, InvalidInput> {
    let in_scene = |fault: beam_modes::InvalidInput| InvalidInput::from(fault).within("structure");
    let body = beam.to_system().map_err(|fault| fault.within("structure"))?;
    let modes = body.modes(frequency_hz.len()).map_err(in_scene)?;
    let length_m = modes.length_m();
    let mut places: Vec<f64> = (0..=POINTS).map(|i| length_m * i as f64 / POINTS as f64).collect();
    places.push(location_m);
    places.sort_by(f64::total_cmp);
    // per place, the shapes of all modes
    let shapes: Vec<Vec<f64>> =
        places.iter().map(|&x| modes.shapes_at(x).map_err(in_scene)).collect::<Result<_, _>>()?;

    let heights = |k: usize| -> Vec<f64> {
        let largest = shapes.iter().map(|at| at[k].abs()).fold(f64::MIN_POSITIVE, f64::max);
        shapes.iter().map(|at| (k + 1) as f64 + AMPLITUDE * at[k] / largest).collect()
    };
    let names = frequency_hz.iter().enumerate().map(|(k, &f)| ((k + 1) as f64, name(k + 1, f)));
    let y = Axis::new("").ticks_at(names).limits(0.4, frequency_hz.len() as f64 + 0.6);
    let title = match frequency_hz.len() {
        drawn if drawn < count => {
            format!("Shapes of the first {drawn} along the beam; the rule is the place of impact")
        }
        _ => "Shapes along the beam; the rule is the place of impact".to_owned(),
    };
    let mut panel = Panel::new(Axis::new("place along the beam").unit("m").limits(0.0, length_m), y)
        .title(title)
        .height((38.0 * frequency_hz.len() as f64).min(TALLEST_PX) + 20.0);
    let mut joint_m = 0.0;
    for segment in beam.segments.iter().rev().skip(1).rev() {
        joint_m += segment.length_m;
        panel = panel.with(Series::vertical_rule(joint_m).dashed());
    }
    for fitted_m in beam.attachments.iter().map(|a| a.location_m).chain(beam.supports.iter().map(|s| s.location_m)) {
        panel = panel.with(Series::vertical_rule(fitted_m));
    }
    panel = panel.with(Series::vertical_rule(location_m).colour(Colour::Vermilion));
    let here = places.iter().position(|&x| x == location_m);
    for k in 0..frequency_hz.len() {
        let line = heights(k);
        panel = panel.with(Series::line(&places, &line).colour(Colour::Blue));
        if let Some(height) = here.and_then(|here| line.get(here)) {
            panel = panel.with(Series::points(&[location_m], &[*height], Marker::Dot).colour(Colour::Vermilion));
        }
    }
    Ok(panel)
}

fn name(number: usize, frequency_hz: f64) -> String {
    if frequency_hz == 0.0 { format!("{number}: rigid") } else { format!("{number}: {}", quantity(frequency_hz, "Hz")) }
}
