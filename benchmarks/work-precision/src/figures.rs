//! Error against time and against deterministic cost.

use crate::compare::{chief_norm, names};
use crate::measure::{Origin, Row};
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};

const COLOURS: [Colour; 6] =
    [Colour::Vermilion, Colour::Green, Colour::Orange, Colour::Purple, Colour::Sky, Colour::Grey];
const MARKERS: [Marker; 5] = [Marker::Circle, Marker::Square, Marker::Triangle, Marker::Plus, Marker::Cross];

/// One problem in its chief norm. Solvers of the workspace are blue and thick; a solver with exact flight has the colour and
/// the marker of the same solver without it, and a dashed line.
pub fn figure(problem: &str, rows: &[&Row], floor: f64) -> Figure {
    let norm = chief_norm(rows);
    let rows: Vec<&Row> = rows.iter().copied().filter(|row| row.norm == norm).collect();
    let error = || Axis::new(format!("error: {norm}")).log();
    let mut time = Panel::new(Axis::new("time").unit("s").log(), error()).height(300.0);
    let mut cost = Panel::new(Axis::new("deterministic cost").log(), error()).height(300.0);
    let solvers = names(rows.iter().map(|row| row.solver.as_str()));
    let peers = names(rows.iter().filter(|row| row.origin != Origin::Own).map(|row| base(&row.solver)));
    let mut own_before = 0;
    for solver in solvers {
        let points: Vec<&Row> = rows.iter().copied().filter(|row| row.solver == solver).collect();
        let Some(origin) = points.first().map(|row| row.origin) else { continue };
        let place = peers.iter().position(|peer| *peer == base(solver)).unwrap_or(0);
        let (colour, marker, width) = match origin {
            Origin::Own => {
                own_before += 1;
                ([Colour::Blue, Colour::Black][(own_before - 1) % 2], Marker::Dot, 2.4)
            }
            _ => (COLOURS[place % COLOURS.len()], MARKERS[(place / COLOURS.len() + place) % MARKERS.len()], 1.0),
        };
        let errors: Vec<f64> = points.iter().map(|row| row.error.map_or(f64::NAN, |e| e.max(floor))).collect();
        let times: Vec<f64> = points.iter().map(|row| row.time_s.unwrap_or(f64::NAN)).collect();
        let costs: Vec<f64> = points.iter().map(|row| row.cost.map_or(f64::NAN, |cost| cost as f64)).collect();
        let series = |x: &[f64]| {
            let series = Series::line_points(x, &errors, marker).label(solver).colour(colour).line_width(width);
            if origin == Origin::Assisted { series.dashed() } else { series }
        };
        time = time.with(series(&times));
        cost = cost.with(series(&costs));
    }
    Figure::new(problem).row([time, cost]).width(980.0)
}

/// The impact of the overview.
pub const OVERVIEW: &str = "pinned-hertz";

/// Solvers of the overview: their names in the table and in the figure.
const SHOWN: [(&str, &str); 8] = [
    ("vibroimpact", "vibroimpact"),
    ("vibroimpact, tables kept", "vibroimpact, further impacts on the same beam"),
    ("DOP853 + exact flight", "DOP853 with the flight of vibroimpact between contacts"),
    ("DOP853", "DOP853"),
    ("scipy LSODA", "LSODA (scipy)"),
    ("diffsol BDF", "BDF (diffsol)"),
    ("CVODE BDF", "BDF (CVODE)"),
    ("scipy Radau", "Radau (scipy)"),
];

/// Error against time of some solvers on one impact, for the README.
pub fn overview(rows: &[Row]) -> Figure {
    let rows: Vec<&Row> = rows.iter().filter(|row| row.problem == OVERVIEW).collect();
    let norm = chief_norm(&rows);
    let axes =
        Panel::new(Axis::new("time of one impact").unit("s").log(), Axis::new(format!("error of the {norm}")).log());
    let panel = SHOWN.iter().enumerate().fold(axes.height(300.0), |panel, (i, (solver, label))| {
        let points = rows.iter().filter(|row| row.solver == *solver && row.norm == norm);
        let (times, errors): (Vec<f64>, Vec<f64>) = points.filter_map(|row| row.time_s.zip(row.error)).unzip();
        let (colour, marker, width) = match i {
            0 | 1 => ([Colour::Blue, Colour::Black][i], Marker::Dot, 2.4),
            _ => (COLOURS[i - 2], MARKERS[(i - 2) % MARKERS.len()], 1.0),
        };
        panel.with(Series::line_points(&times, &errors, marker).label(*label).colour(colour).line_width(width))
    });
    Figure::new("A steel ball on a pinned steel beam of 40 modes, Hertz's law, 8 contacts").row([panel]).width(800.0)
}

/// The name without the form in which the solver is used.
fn base(solver: &str) -> &str {
    solver.split(" + ").next().unwrap_or(solver)
}
