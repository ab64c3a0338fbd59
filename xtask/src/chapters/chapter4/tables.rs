//! The restitution tables: every beam, location and ball. Figs. 4.6 to 4.9.

use super::Case;
use crate::chapters::beam::Beam;
use crate::chapters::impact::{Ball, Row, Setup};
use crate::chapters::study::Study;
use tasks::Failure;
use vibroimpact::plot::{Axis, Figure, HeatMap, Marker, Panel, Series};
use vibroimpact_sim::modal::Solver;

/// The table of one beam: one row per location, with one result per ball.
pub(in crate::chapters) struct Table<'a> {
    pub beam: &'a Beam,
    pub places_m: Vec<f64>,
    pub balls: Vec<Ball>,
    pub rows: Vec<Vec<Row>>,
}

impl Table<'_> {
    /// One quantity of every result, with balls as rows and locations as columns, as it is shown in a map.
    pub fn by_ball(&self, value: impl Fn(&Row) -> f64) -> Vec<Vec<f64>> {
        (0..self.balls.len()).map(|j| self.rows.iter().map(|place| value(&place[j])).collect()).collect()
    }

    /// All results, ordered by location.
    pub fn all(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().flatten()
    }

    /// A map over locations and balls; balls are equally spaced and labelled with their mass.
    pub fn map(&self, values: Vec<Vec<f64>>, value: Axis) -> Panel {
        let numbers: Vec<f64> = (0..self.balls.len()).map(|j| j as f64).collect();
        let ticks = self.balls.iter().zip(&numbers).map(|(ball, j)| (*j, format!("{:.4}", ball.mass_kg)));
        let y = Axis::new("mass of the ball").unit("kg").ticks_at(ticks);
        let x = Axis::new("location b").unit("m").limits(0.0, self.beam.model.beam.length_m());
        Panel::new(x, y).height(200.0).map(HeatMap::new(&self.places_m, &numbers, values, value))
    }

    /// Mean of a quantity over the selected results; NaN if there are none.
    pub fn mean(&self, value: impl Fn(&Row) -> f64, chosen: impl Fn(&Row) -> bool) -> f64 {
        let chosen: Vec<f64> = self.all().filter(|r| chosen(r)).map(value).collect();
        chosen.iter().sum::<f64>() / chosen.len() as f64
    }

    /// The table restricted to some of the balls.
    pub fn with_balls(&self, chosen: impl Fn(&Ball) -> bool) -> Table<'_> {
        let kept: Vec<usize> = (0..self.balls.len()).filter(|&j| chosen(&self.balls[j])).collect();
        let of = |place: &Vec<Row>| kept.iter().map(|&j| place[j].clone()).collect();
        Table {
            beam: self.beam,
            places_m: self.places_m.clone(),
            balls: kept.iter().map(|&j| self.balls[j]).collect(),
            rows: self.rows.iter().map(of).collect(),
        }
    }
}

/// The tables of all beams for one model: a number of modes, with or without remainder modes.
pub(in crate::chapters) fn compute<'a>(
    study: &mut Study,
    case: &'a Case,
    modes: usize,
    residual: bool,
) -> Result<Vec<Table<'a>>, Failure> {
    of_beams(study, case, &case.beams, (modes, residual), |setup, solver| setup.solve_with(solver))
}

/// The same for other beams, with a given way of solving each impact. The structure at each location is built once for all balls.
pub(in crate::chapters) fn of_beams<'a, S>(
    study: &mut tasks::Study<S>,
    case: &Case,
    beams: &'a [Beam],
    (modes, residual): (usize, bool),
    solve: impl Fn(&Setup, &Solver) -> Result<Row, Failure> + Sync,
) -> Result<Vec<Table<'a>>, Failure> {
    let balls = study.thin(&case.balls, 4);
    let lists: Vec<Vec<f64>> = beams.iter().map(|beam| study.thin(&case.places(beam), 9)).collect();
    let places: Vec<(&Beam, f64)> =
        beams.iter().zip(&lists).flat_map(|(beam, list)| list.iter().map(move |&b| (beam, b))).collect();
    let results = study.sweep(&places, balls.len(), |&(beam, location_m)| {
        let at = |ball: &Ball| Setup { modes, residual, ..case.setup(beam, *ball, location_m) };
        let solver = at(&balls[0]).solver()?;
        balls.iter().map(|ball| solve(&at(ball), &solver)).collect::<Result<Vec<Row>, Failure>>()
    })?;
    let mut results = results.into_iter();
    let table = |(beam, places_m): (&'a Beam, Vec<f64>)| {
        let rows = results.by_ref().take(places_m.len()).collect();
        Table { beam, places_m, balls: balls.clone(), rows }
    };
    Ok(beams.iter().zip(lists).map(table).collect())
}

pub(super) fn run<'a>(study: &mut Study, case: &'a Case) -> Result<Vec<Table<'a>>, Failure> {
    study.section("The tables: four beams, every location and ball, N = 40, ζ = 0.02");
    let tables = compute(study, case, case.parameters.modes, false)?;
    study.section("Restitution against location and ball (Figs. 4.6 to 4.9)");
    for (table, number) in tables.iter().zip(6..) {
        let rows: Vec<Row> = table.all().cloned().collect();
        study.csv(&format!("restitution-{}.csv", table.beam.name), &rows)?;
        let caption = "Top: restitution and number of sub-impacts over location and ball. Bottom: restitution of every \
                       other ball along the beam.";
        study.main_figure(&format!("fig-4-{number:02}"), &figure(table, number), caption)?;
    }
    Ok(tables)
}

fn figure(table: &Table, number: usize) -> Figure {
    let e = table.map(table.by_ball(Row::e), Axis::new("restitution e").limits(0.0, 1.0)).title("(a) restitution");
    let contacts = table.by_ball(|r| r.sub_impacts as f64);
    let contacts = table.map(contacts, Axis::new("sub-impacts").integers()).title("(b) sub-impacts");
    let lines = Panel::new(Axis::new("location b").unit("m"), Axis::new("restitution e"))
        .height(230.0)
        .title("(c) restitution along the beam, every other ball");
    let by_ball = table.by_ball(Row::e);
    let markers = [Marker::Circle, Marker::Cross, Marker::Square, Marker::Triangle, Marker::Plus, Marker::Dot];
    let every_other = (0..table.balls.len()).rev().step_by(2).collect::<Vec<_>>().into_iter().rev();
    let lines = every_other.zip(markers).fold(lines, |panel, (j, marker)| {
        let label = format!("{:.4} kg", table.balls[j].mass_kg);
        panel.with(Series::line_points(&table.places_m, &by_ball[j], marker).label(label))
    });
    Figure::new(format!("Fig. 4.{number}  {}", table.beam.title)).row([e, contacts]).row([lines]).width(960.0)
}
