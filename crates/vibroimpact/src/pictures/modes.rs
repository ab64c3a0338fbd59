//! The modes of a structure.

use std::f64::consts::TAU;

use crate::plot::{Axis, Colour, Figure, HeatMap, Marker, Panel, Series};
use crate::scene::{Beam, InvalidInput, Location, Plate, Scene, Structure, TautString};
use crate::text::quantity;

/// Modes whose shape along a beam or string is drawn.
const DRAWN: usize = 30;
/// Points along it, in addition to the location of impact.
const POINTS: usize = 400;
/// Height of many shapes (px).
const TALLEST_PX: f64 = 760.0;
/// Largest displacement of a shape, where neighbours are 1 apart.
const AMPLITUDE: f64 = 0.42;
/// Modes whose shape over a plate is drawn, and number of maps in a row.
const DRAWN_OVER_A_PLATE: usize = 12;
const BESIDE: usize = 3;
/// Cells along the longer side of a plate.
const CELLS: f64 = 48.0;
/// Width of a map of a plate (px), as the figure leaves it, and the heights it may have.
const MAP_PX: f64 = 205.0;
const HEIGHTS_PX: [f64; 2] = [40.0, 400.0];

/// The shapes of the first thirty of `count` modes along a beam or string, or of the first twelve over a plate, each scaled to
/// its largest displacement, with the location of impact; below, the mass-normalised shape at that location of all `count` modes
/// against frequency. For a structure that is given by its modes only the latter is known.
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
/// assert!(svg.contains("location along the beam (m)"));
/// # Ok::<(), vibroimpact::SceneError>(())
/// ```
pub fn modes(scene: &Scene, count: usize) -> Result<Figure, InvalidInput> {
    let modes = scene.mode_shapes(count)?;
    let frequency: Vec<f64> = modes.iter().map(|mode| mode.omega_rad_s / TAU).collect();
    let shape: Vec<f64> = modes.iter().map(|mode| mode.shape).collect();
    let at_place = Panel::new(Axis::new("frequency").unit("Hz"), Axis::new("shape there").unit("1/√kg"))
        .title("Mass-normalised shape at the location of impact")
        .height(130.0)
        .with(Series::horizontal_rule(0.0))
        .with(Series::stem(&frequency, &shape, Marker::Dot).colour(Colour::Vermilion).line_width(0.8));
    let figure = Figure::new(match modes.len() {
        1 => "The first mode".to_owned(),
        n => format!("The first {n} modes"),
    });
    let drawn = |most: usize| frequency.get(..count.min(most)).unwrap_or(&frequency);
    Ok(match (&scene.structure, scene.location_m) {
        (Structure::Beam(beam), Some(Location::Along(location_m))) => figure
            .row([along(&Line::of_beam(beam, location_m, drawn(DRAWN).len())?, drawn(DRAWN), count)])
            .row([at_place]),
        (Structure::TautString(string), Some(Location::Along(location_m))) => figure
            .row([along(&Line::of_string(string, location_m, drawn(DRAWN).len())?, drawn(DRAWN), count)])
            .row([at_place]),
        (Structure::Plate(plate), Some(Location::On(location_m))) => {
            let drawn = drawn(DRAWN_OVER_A_PLATE);
            let maps = over(plate, location_m, drawn)?;
            let title = match drawn.len() {
                n if n < count => format!("{}, {n} of them drawn; the circle is the location of impact", figure.title),
                _ => format!("{}; the circle is the location of impact", figure.title),
            };
            let figure = Figure { title, ..figure };
            maps.chunks(BESIDE).fold(figure, |figure, row| figure.row(row.to_vec())).row([at_place])
        }
        _ => figure.row([at_place]),
    })
}

/// Shapes along a beam or string.
struct Line {
    /// Its name.
    name: &'static str,
    length_m: f64,
    location_m: f64,
    places_m: Vec<f64>,
    /// For each location, the shapes of all modes.
    shapes: Vec<Vec<f64>>,
    /// Locations of changes of the section.
    joints_m: Vec<f64>,
    /// Locations of attachments and supports.
    fitted_m: Vec<f64>,
}

impl Line {
    fn of_beam(beam: &Beam, location_m: f64, count: usize) -> Result<Line, InvalidInput> {
        let body = beam.to_system().map_err(|fault| fault.within("structure"))?;
        let modes = body.modes(count).map_err(in_scene)?;
        let places_m = places(modes.length_m(), location_m);
        let ends = beam.segments.iter().scan(0.0, |end_m, segment| {
            *end_m += segment.length_m;
            Some(*end_m)
        });
        let attached = beam.attachments.iter().map(|attachment| attachment.location_m);
        Ok(Line {
            name: "beam",
            length_m: modes.length_m(),
            location_m,
            shapes: places_m.iter().map(|&x| modes.shapes_at(x).map_err(in_scene)).collect::<Result<_, _>>()?,
            places_m,
            joints_m: ends.take(beam.segments.len().saturating_sub(1)).collect(),
            fitted_m: attached.chain(beam.supports.iter().map(|support| support.location_m)).collect(),
        })
    }

    fn of_string(string: &TautString, location_m: f64, count: usize) -> Result<Line, InvalidInput> {
        let modes = string.to_taut_string().modes(count).map_err(in_scene)?;
        let places_m = places(string.length_m, location_m);
        Ok(Line {
            name: "string",
            length_m: string.length_m,
            location_m,
            shapes: places_m.iter().map(|&x| modes.shapes_at(x).map_err(in_scene)).collect::<Result<_, _>>()?,
            places_m,
            joints_m: Vec::new(),
            fitted_m: Vec::new(),
        })
    }
}

fn in_scene(fault: InvalidInput) -> InvalidInput {
    fault.within("structure")
}

/// Locations at which shapes are drawn, including that of the impact.
fn places(length_m: f64, location_m: f64) -> Vec<f64> {
    let even = (0..=POINTS).map(|i| length_m * i as f64 / POINTS as f64);
    let mut places: Vec<f64> = even.chain([location_m]).collect();
    places.sort_by(f64::total_cmp);
    places
}

/// Shapes above each other, the first at the bottom; `count` modes were requested.
fn along(line: &Line, frequency_hz: &[f64], count: usize) -> Panel {
    let Line { name, places_m, shapes, location_m, .. } = line;
    let heights = |k: usize| -> Vec<f64> {
        let largest = shapes.iter().map(|at| at[k].abs()).fold(f64::MIN_POSITIVE, f64::max);
        shapes.iter().map(|at| (k + 1) as f64 + AMPLITUDE * at[k] / largest).collect()
    };
    let names = frequency_hz.iter().enumerate().map(|(k, &f)| ((k + 1) as f64, named(k + 1, f)));
    let y = Axis::new("").ticks_at(names).limits(0.4, frequency_hz.len() as f64 + 0.6);
    let title = match frequency_hz.len() {
        drawn if drawn < count => {
            format!("Shapes of the first {drawn} along the {name}; the rule is the location of impact")
        }
        _ => format!("Shapes along the {name}; the rule is the location of impact"),
    };
    let mut panel = Panel::new(Axis::new(format!("location along the {name}")).unit("m").limits(0.0, line.length_m), y)
        .title(title)
        .height((38.0 * frequency_hz.len() as f64).min(TALLEST_PX) + 20.0);
    for joint_m in &line.joints_m {
        panel = panel.with(Series::vertical_rule(*joint_m).dashed());
    }
    for fitted_m in &line.fitted_m {
        panel = panel.with(Series::vertical_rule(*fitted_m));
    }
    panel = panel.with(Series::vertical_rule(*location_m).colour(Colour::Vermilion));
    let here = places_m.iter().position(|x| x == location_m);
    for k in 0..frequency_hz.len() {
        let drawn = heights(k);
        panel = panel.with(Series::line(places_m, &drawn).colour(Colour::Blue));
        if let Some(height) = here.and_then(|here| drawn.get(here)) {
            panel = panel.with(Series::points(&[*location_m], &[*height], Marker::Dot).colour(Colour::Vermilion));
        }
    }
    panel
}

/// A map of each shape over a plate, in its proportions if they fit.
fn over(plate: &Plate, [x_m, y_m]: [f64; 2], frequency_hz: &[f64]) -> Result<Vec<Panel>, InvalidInput> {
    let body = plate.to_plate().map_err(|fault| fault.within("structure"))?;
    let modes = body.modes(frequency_hz.len()).map_err(in_scene)?;
    let sides = [plate.length_m, plate.width_m];
    let longer = sides[0].max(sides[1]);
    let centres = |side: f64| -> Vec<f64> {
        let cells = (CELLS * side / longer).ceil().max(4.0);
        (0..cells as usize).map(|i| side * (i as f64 + 0.5) / cells).collect()
    };
    let (along, across) = (centres(sides[0]), centres(sides[1]));
    let row = |&y: &f64| along.iter().map(|&x| modes.shapes_at(x, y).map_err(in_scene)).collect();
    let shapes = across.iter().map(row).collect::<Result<Vec<Vec<Vec<f64>>>, _>>()?;
    let panel = |(k, &frequency): (usize, &f64)| {
        let largest = shapes.iter().flatten().map(|at| at[k].abs()).fold(f64::MIN_POSITIVE, f64::max);
        let cells = shapes.iter().map(|row| row.iter().map(|at| at[k] / largest).collect()).collect();
        let first_of_row = k % BESIDE == 0;
        let last_of_column = k + BESIDE >= frequency_hz.len();
        let (x, y) = (Axis::new("x").unit("m"), Axis::new("y").unit("m"));
        let x = if last_of_column { x } else { x.unlabelled() };
        let y = if first_of_row { y } else { y.unlabelled() };
        Panel::new(x.limits(0.0, sides[0]), y.limits(0.0, sides[1]))
            .title(named(k + 1, frequency))
            .height((MAP_PX * sides[1] / sides[0]).clamp(HEIGHTS_PX[0], HEIGHTS_PX[1]))
            .map(HeatMap::new(&along, &across, cells, Axis::new("").limits(-1.0, 1.0).unlabelled()))
            .with(Series::points(&[x_m], &[y_m], Marker::Circle).colour(Colour::Black))
    };
    Ok(frequency_hz.iter().enumerate().map(panel).collect())
}

fn named(number: usize, frequency_hz: f64) -> String {
    if frequency_hz == 0.0 { format!("{number}: rigid") } else { format!("{number}: {}", quantity(frequency_hz, "Hz")) }
}
