//! The restitution tables: every beam, place and ball. Figs. 4.6 to 4.9.

use super::Case;
use crate::chapters::Failure;
use crate::chapters::beam::Beam;
use crate::chapters::impact::{Ball, Row, Setup};
use crate::chapters::study::Study;
use vibroimpact::plot::{Axis, Figure, HeatMap, Marker, Panel, Series};
use vibroimpact::report::Comparison;

/// The table of one beam: rows of places, in each one result a ball.
pub(in crate::chapters) struct Table<'a> {
    pub beam: &'a Beam,
    pub places_m: Vec<f64>,
    pub balls: Vec<Ball>,
    pub rows: Vec<Vec<Row>>,
}

impl Table<'_> {
    /// A number of every result as rows of balls over columns of places, as a map shows it.
    pub fn by_ball(&self, value: impl Fn(&Row) -> f64) -> Vec<Vec<f64>> {
        (0..self.balls.len()).map(|j| self.rows.iter().map(|place| value(&place[j])).collect()).collect()
    }

    /// All results, place by place.
    pub fn all(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().flatten()
    }

    /// A map over places and balls; balls are equally spaced and labelled with their mass.
    pub fn map(&self, values: Vec<Vec<f64>>, value: Axis) -> Panel {
        let numbers: Vec<f64> = (0..self.balls.len()).map(|j| j as f64).collect();
        let ticks = self.balls.iter().zip(&numbers).map(|(ball, j)| (*j, format!("{:.4}", ball.mass_kg)));
        let y = Axis::new("mass of the ball").unit("kg").ticks_at(ticks);
        Panel::new(Axis::new("location b").unit("m"), y).height(200.0).map(HeatMap::new(
            &self.places_m,
            &numbers,
            values,
            value,
        ))
    }

    fn mean(&self, chosen: impl Fn(&Row) -> bool) -> f64 {
        let chosen: Vec<f64> = self.all().filter(|r| chosen(r)).map(Row::e).collect();
        chosen.iter().sum::<f64>() / chosen.len() as f64
    }
}

/// The tables of all beams for one model: so many modes, with or without the residual
/// compliance. Each place's structure is built once and serves all balls.
pub(in crate::chapters) fn compute<'a>(
    study: &mut Study,
    case: &'a Case,
    modes: usize,
    residual: bool,
) -> Result<Vec<Table<'a>>, Failure> {
    let balls = study.thin(&case.balls, 4);
    let lists: Vec<Vec<f64>> = case.beams.iter().map(|beam| study.thin(&case.places(beam), 9)).collect();
    let places: Vec<(&Beam, f64)> =
        case.beams.iter().zip(&lists).flat_map(|(beam, list)| list.iter().map(move |&b| (beam, b))).collect();
    let results = study.sweep(&places, balls.len(), |&(beam, location_m)| {
        let at = |ball: &Ball| Setup { modes, residual, ..case.setup(beam, *ball, location_m) };
        let mut solver = at(&balls[0]).solver()?;
        balls.iter().map(|ball| at(ball).solve_with(&mut solver)).collect::<Result<Vec<Row>, Failure>>()
    })?;
    let mut results = results.into_iter();
    let table = |(beam, places_m): (&'a Beam, Vec<f64>)| {
        let rows = results.by_ref().take(places_m.len()).collect();
        Table { beam, places_m, balls: balls.clone(), rows }
    };
    Ok(case.beams.iter().zip(lists).map(table).collect())
}

pub(super) fn run<'a>(study: &mut Study, case: &'a Case) -> Result<Vec<Table<'a>>, Failure> {
    study.section("The tables: four beams, every place and ball, N = 40, ζ = 0.02");
    let tables = compute(study, case, case.parameters.modes, false)?;
    study.section("Restitution against place and ball (Figs. 4.6 to 4.9)");
    for (table, number) in tables.iter().zip(6..) {
        let rows: Vec<Row> = table.all().cloned().collect();
        study.csv(&format!("restitution-{}.csv", table.beam.name), &rows)?;
        let caption = "Above: restitution and number of sub-impacts over place and ball. Below: restitution of every other \
                       ball along the beam.";
        study.figure(&format!("fig-4-{number:02}"), &figure(table, number), caption)?;
        statements(study, table, number);
    }
    Ok(tables)
}

fn figure(table: &Table, number: usize) -> Figure {
    let e = table.map(table.by_ball(Row::e), Axis::new("restitution e").limits(0.0, 1.0)).title("(a) restitution");
    let contacts = table.by_ball(|r| r.sub_impacts as f64);
    let contacts = table.map(contacts, Axis::new("sub-impacts").integers()).title("(b) sub-impacts");
    let lines = Panel::new(Axis::new("location b").unit("m"), Axis::new("restitution e")).height(230.0).title("(c)");
    let by_ball = table.by_ball(Row::e);
    let markers = [Marker::Circle, Marker::Cross, Marker::Square, Marker::Triangle, Marker::Plus, Marker::Dot];
    let every_other = (0..table.balls.len()).rev().step_by(2).collect::<Vec<_>>().into_iter().rev();
    let lines = every_other.zip(markers).fold(lines, |panel, (j, marker)| {
        let label = format!("{:.4} kg", table.balls[j].mass_kg);
        panel.with(Series::line_points(&table.places_m, &by_ball[j], marker).label(label))
    });
    Figure::new(format!("Fig. 4.{number}  {}", table.beam.title)).row([e, contacts]).row([lines]).width(960.0)
}

/// The trends that section 4.2 observes, beam by beam.
fn statements(study: &mut Study, table: &Table, number: usize) {
    let (source, name) = (format!("4.2, Fig. 4.{number}"), &table.beam.name);
    let length = table.beam.model.length_m();
    let inner = |r: &Row| r.location_m > 0.1 * length && r.location_m < 0.9 * length;
    let (Some(lightest), Some(heaviest)) = (table.balls.first(), table.balls.last()) else { return };
    let light = |r: &Row| inner(r) && r.mass_kg == lightest.mass_kg;
    let most = table.all().filter(|r| light(r)).map(|r| r.sub_impacts).max().unwrap_or(0);
    study.state(Comparison::range(
        format!("most contacts of the lightest ball away from the ends, {name}"),
        &source,
        "a single contact event",
        (1.0, 1.0),
        most as f64,
    ));

    let means: Vec<f64> = table.balls.iter().map(|b| table.mean(|r| inner(r) && r.mass_kg == b.mass_kg)).collect();
    let least = means.iter().copied().fold(f64::INFINITY, f64::min);
    let fall = means.first().map_or(f64::NAN, |first| first - least);
    let rise = means.last().map_or(f64::NAN, |last| last - least);
    study.state(Comparison::range(
        format!("mean e away from the ends: lightest ball less the least of all balls, {name}"),
        &source,
        "high for very small m, then low",
        (0.1, 1.0),
        fall,
    ));
    study.state(Comparison::range(
        format!("mean e away from the ends: heaviest ball less the least of all balls, {name}"),
        &source,
        "increases again",
        (0.05, 1.0),
        rise,
    ));

    if let ([.., before, _, _], beam_modes::End::Free) = (table.places_m.as_slice(), table.beam.model.ends[1]) {
        let rise = |least_kg: f64| {
            let at = |place_m: f64| table.mean(|r| r.location_m == place_m && r.mass_kg > least_kg);
            at(length) - at(*before)
        };
        let row = |balls: &str, rise: f64| {
            let quantity = format!("mean e at the free end less mean e two places before, {balls}, {name}");
            Comparison::range(quantity, &source, "a general rising trend", (0.0, 1.0), rise)
        };
        let note = "Light balls lose more at the free end itself, where a beam is far more mobile than inside; that can \
                    outweigh the rise of the others in the mean over all balls.";
        study.state(row("all balls", rise(0.0)).note(note));
        study.state(row("balls above 0.06 kg", rise(0.06)));
    }
    if let [_, near, further, ..] = table.places_m.as_slice() {
        let rise = table.mean(|r| r.location_m == *near) - table.mean(|r| r.location_m == *further);
        study.state(Comparison::range(
            format!("mean e one place from the held end less two places from it, {name}"),
            &source,
            "a sudden rise very close to fixed or pinned ends",
            (0.0, 1.0),
            rise,
        ));
    }
    if let [thick, _, ..] = table.beam.model.segments.as_slice() {
        let heavy = |r: &Row| inner(r) && r.mass_kg > 0.3 * heaviest.mass_kg;
        let slim = table.mean(|r| heavy(r) && r.location_m > thick.length_m)
            - table.mean(|r| heavy(r) && r.location_m < thick.length_m);
        study.state(Comparison::range(
            format!("mean e of heavy balls on the slim part less that on the thick part, {name}"),
            &source,
            "greater rebound from the thinner portion",
            (0.0, 1.0),
            slim,
        ));
    }
}
