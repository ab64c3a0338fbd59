//! Locations on chapter 3's beam and balls for which the restitution can be predicted.

use super::{APART, kaneko};
use crate::chapters::beam::Beam;
use crate::chapters::chapter3::Case;
use crate::chapters::impact::{Ball, Row, Setup};
use crate::chapters::study::Study;
use serde::Serialize;
use tasks::Failure;
use vibroimpact::plot::{Axis, Figure, HeatMap, Panel};
use vibroimpact::report::significant;

/// Modes, with remainder modes for all others.
const MODES: usize = 160;
/// Locations, equally spaced, on half of the beam, which is symmetric.
const PLACES: u32 = 40;
/// Diameters of the balls, mm.
const DIAMETERS_MM: std::ops::RangeInclusive<u32> = 6..=60;
const EVERY_MM: usize = 3;
/// A restitution that changes by less than this counts as predictable.
const PREDICTED: f64 = 0.02;

/// One location and ball.
#[derive(Serialize)]
struct Cell {
    location_m: f64,
    diameter_m: f64,
    sub_impacts: usize,
    restitution_euler_bernoulli: f64,
    restitution_timoshenko: f64,
    difference_of_theories: f64,
    change_with_coefficient: f64,
}

impl Cell {
    fn new([slender, thick, soft, stiff]: [&Row; 4]) -> Cell {
        let from_thick = |row: &Row| (row.e() - thick.e()).abs();
        Cell {
            location_m: thick.location_m,
            diameter_m: thick.diameter_m,
            sub_impacts: thick.sub_impacts,
            restitution_euler_bernoulli: slender.e(),
            restitution_timoshenko: thick.e(),
            difference_of_theories: from_thick(slender),
            change_with_coefficient: from_thick(soft).max(from_thick(stiff)),
        }
    }
}

pub(super) fn run(study: &mut Study, case: &Case) -> Result<(), Failure> {
    study.section("Where a restitution can be predicted (chapter 3)");
    let material = &case.parameters.material;
    let diameters: Vec<u32> = study.thin(&DIAMETERS_MM.step_by(EVERY_MM).collect::<Vec<_>>(), 4);
    let balls = diameters
        .iter()
        .map(|mm| Ball::new(material, 1e-3 * f64::from(*mm)))
        .collect::<Result<Vec<Ball>, Failure>>()?;
    let step_m = 0.5 * case.parameters.beam.length_m / f64::from(PLACES);
    let places: Vec<f64> = study.thin(&(1..=PLACES).map(|i| f64::from(i) * step_m).collect::<Vec<_>>(), 5);
    let thick = |share: f64| case.beam.timoshenko(material, share * kaneko(material));
    let [thick, soft, stiff] = [thick(1.0)?, thick(1.0 - APART)?, thick(1.0 + APART)?];

    let cells = study.sweep(&places, 4 * balls.len(), |&location_m| {
        let of = |beam| one_beam(case, beam, location_m, &balls);
        let rows = [of(&case.beam)?, of(&thick)?, of(&soft)?, of(&stiff)?];
        Ok((0..balls.len()).map(|j| Cell::new([0, 1, 2, 3].map(|model: usize| &rows[model][j]))).collect::<Vec<Cell>>())
    })?;
    picture(study, &places, &diameters, &cells)?;
    let all: Vec<&Cell> = cells.iter().flatten().collect();
    by_contacts(study, &all)?;
    study.csv("predictable.csv", &all)
}

fn one_beam(case: &Case, beam: &Beam, location_m: f64, balls: &[Ball]) -> Result<Vec<Row>, Failure> {
    let at = |ball: &Ball| Setup {
        beam,
        ball: *ball,
        law: ball.hertz(),
        damping_ratio: case.parameters.damping_ratio,
        residual: true,
        ..case.setup(location_m, MODES)
    };
    let Some(first) = balls.first() else { return Ok(Vec::new()) };
    let solver = at(first).solver()?;
    balls.iter().map(|ball| at(ball).solve_once_with(&solver)).collect()
}

fn picture(study: &mut Study, places: &[f64], diameters: &[u32], cells: &[Vec<Cell>]) -> Result<(), Failure> {
    let y: Vec<f64> = diameters.iter().map(|mm| f64::from(*mm)).collect();
    let map = |title: &str, value: Axis, of: fn(&Cell) -> f64| {
        let rows = (0..y.len()).map(|j| cells.iter().map(|place| of(&place[j])).collect()).collect();
        let panel = Panel::new(Axis::new("location b").unit("m"), Axis::new("ball").unit("mm"));
        panel.title(title).height(210.0).map(HeatMap::new(places, &y, rows, value))
    };
    let change = || Axis::new("change of e").log().limits(1e-4, 1.0);
    let e = Axis::new("restitution e").limits(0.0, 1.0);
    let contacts = Axis::new("contacts").log();
    let figure = Figure::new("Where the restitution on the beam of chapter 3 can be predicted")
        .row([
            map("(a) restitution, Timoshenko", e, |c| c.restitution_timoshenko),
            map("(b) number of contacts", contacts, |c| c.sub_impacts as f64),
        ])
        .row([
            map("(c) ± 2 % of the shear coefficient", change(), |c| c.change_with_coefficient.max(1e-4)),
            map("(d) Euler-Bernoulli against Timoshenko", change(), |c| c.difference_of_theories.max(1e-4)),
        ])
        .width(960.0);
    study.main_figure(
        "predictable",
        &figure,
        "The figure shows half of the beam, at a damping ratio of 0.02 and 1 m/s. Changes below 10⁻⁴ are shown as \
         10⁻⁴.",
    )
}

/// Share of predictable restitutions by number of contacts.
fn by_contacts(study: &mut Study, all: &[&Cell]) -> Result<(), Failure> {
    let median = |of: fn(&Cell) -> f64, chosen: &[&&Cell]| {
        let mut values: Vec<f64> = chosen.iter().map(|cell| of(cell)).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).map_or_else(|| "-".to_owned(), |value| significant(*value, 2))
    };
    let mut lines = Vec::new();
    for (name, from, below) in
        [("1", 1, 2), ("2 or 3", 2, 4), ("4 to 9", 4, 10), ("10 and more", 10, usize::MAX), ("any", 1, usize::MAX)]
    {
        let chosen: Vec<&&Cell> = all.iter().filter(|c| (from..below).contains(&c.sub_impacts)).collect();
        let share = |of: fn(&Cell) -> f64| {
            let good = chosen.iter().filter(|cell| of(cell) < PREDICTED).count();
            format!("{:.0} %", 100.0 * good as f64 / chosen.len().max(1) as f64)
        };
        lines.push(vec![
            name.to_owned(),
            chosen.len().to_string(),
            median(|c| c.change_with_coefficient, &chosen),
            share(|c| c.change_with_coefficient),
            median(|c| c.difference_of_theories, &chosen),
            share(|c| c.difference_of_theories),
        ]);
    }
    study.tabled(
        "predictable-by-contacts",
        &[
            "contacts",
            "locations and balls",
            "coefficient, median",
            "coefficient, below 0.02",
            "theory, median",
            "theory, below 0.02",
        ],
        &lines,
    )
}
