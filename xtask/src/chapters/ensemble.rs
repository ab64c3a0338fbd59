//! What is our choice, varied: steps, slim parts, ball lists and places, and in how many of the choices a trend of the
//! thesis holds.

use super::Failure;
use super::beam::{Beam, segment};
use super::chapter4::trends::{self, Trend};
use super::chapter4::{Case, EnsembleChoice, tables::Table};
use super::impact::{Ball, Row, Setup};
use super::statement::{Statement, limits};
use super::study::Study;
use serde::Serialize;
use vibroimpact::plot::{Axis, Figure, HeatMap, Panel};
use vibroimpact::report::significant;

const INTRODUCTION: &str = "The thesis does not print where its stepped beams have their step, how thin the slim part \
is, or the list of its twelve balls. What it says of them is therefore tried with all choices that are plausible: a \
grid of steps and slim parts, and every list of twelve balls in equal steps of whole millimetres that contains the three \
masses which chapter 4 names. Everything else is as in chapter 4: 40 modes, 2 % damping, 1 m/s, 25 places. A trend that \
holds in nine of ten choices counts as borne out, one that fails in nine of ten as refuted; between, the text does not \
let anyone decide.";

/// How a trend of one beam fares over the choices.
#[derive(Serialize)]
struct TrendRow {
    beam: String,
    step_m: Option<f64>,
    slim_thickness_fraction: Option<f64>,
    smallest_ball_m: f64,
    quantity: &'static str,
    value: f64,
    holds: bool,
}

/// A stepped beam, or a uniform one.
struct Variant {
    beam: Beam,
    /// Where the step is (m), and the slim part's share of the thickness.
    step: Option<(f64, f64)>,
}

/// Runs the ensembles and returns the text that introduces their report.
pub(super) fn run(study: &mut Study) -> Result<&'static str, Failure> {
    let case = Case::load()?;
    let choice = &case.parameters.our_choice.ensemble;
    let variants = variants(study, &case, choice)?;
    let lists = choice.ball_lists();
    let balls = balls(study, &case, &lists)?;
    study.section("Trends over steps, slim parts and ball lists");
    let tables = tables(study, &case, &variants, &balls)?;
    let judged = judge(&variants, &tables, &lists);
    study.csv("trends.csv", &judged.iter().flat_map(Judged::rows).collect::<Vec<TrendRow>>())?;
    for (beam, figure) in case.beams.iter().zip(6..) {
        let of: Vec<&Judged> = judged.iter().filter(|one| one.variant.beam.name == beam.name).collect();
        claim(study, &of, &beam.name, figure);
        map(study, choice, &of, beam)?;
    }
    fitting_choices(study, &judged);
    free_end(study, &judged);
    speeds(study, &case, &variants)?;
    Ok(INTRODUCTION)
}

/// Every beam of the chapter, the stepped ones in all their forms.
fn variants(study: &Study, case: &Case, choice: &EnsembleChoice) -> Result<Vec<Variant>, Failure> {
    let steps = study.thin(&choice.steps_m, 2);
    let slim = study.thin(&choice.slim_thickness_fractions, 2);
    let mut variants = Vec::new();
    for beam in &case.parameters.our_choice.beams {
        let build = |segments| Beam::new(&beam.name, &beam.title, beam.ends, segments, case.parameters.modes);
        let part = |length_m, fraction| segment(&case.parameters.material, length_m, case.parameters.side_m, fraction);
        if beam.segments.len() == 1 {
            variants.push(Variant { beam: build(vec![part(1.0, 1.0)])?, step: None });
            continue;
        }
        for &step_m in &steps {
            for &fraction in &slim {
                let segments = vec![part(step_m, 1.0), part(1.0 - step_m, fraction)];
                variants.push(Variant { beam: build(segments)?, step: Some((step_m, fraction)) });
            }
        }
    }
    Ok(variants)
}

/// Every ball of any list, once, from the smallest on.
fn balls(study: &Study, case: &Case, lists: &[Vec<u32>]) -> Result<Vec<Ball>, Failure> {
    let mut diameters_mm: Vec<u32> = lists.iter().flatten().copied().collect();
    diameters_mm.sort_unstable();
    diameters_mm.dedup();
    let kept = study.thin(&diameters_mm, 8);
    kept.iter().map(|&mm| Ball::new(&case.parameters.material, 1e-3 * f64::from(mm))).collect()
}

fn tables<'a>(
    study: &mut Study,
    case: &'a Case,
    variants: &'a [Variant],
    balls: &[Ball],
) -> Result<Vec<Table<'a>>, Failure> {
    let lists: Vec<Vec<f64>> = variants.iter().map(|variant| study.thin(&case.places(&variant.beam), 9)).collect();
    let places: Vec<(&Beam, f64)> =
        variants.iter().zip(&lists).flat_map(|(variant, list)| list.iter().map(move |&b| (&variant.beam, b))).collect();
    let results = study.sweep(&places, balls.len(), |&(beam, location_m)| {
        let mut solver = case.setup(beam, balls[0], location_m).solver()?;
        balls
            .iter()
            .map(|ball| case.setup(beam, *ball, location_m).solve_with(&mut solver))
            .collect::<Result<Vec<Row>, Failure>>()
    })?;
    let mut results = results.into_iter();
    let table = |(variant, places_m): (&'a Variant, Vec<f64>)| {
        let rows = results.by_ref().take(places_m.len()).collect();
        Table { beam: &variant.beam, places_m, balls: balls.to_vec(), rows }
    };
    Ok(variants.iter().zip(lists).map(table).collect())
}

/// The trends of one choice.
struct Judged<'a> {
    variant: &'a Variant,
    smallest_ball_mm: u32,
    trends: Vec<Trend>,
}

impl Judged<'_> {
    fn rows(&self) -> Vec<TrendRow> {
        let row = |trend: &Trend| TrendRow {
            beam: self.variant.beam.name.clone(),
            step_m: self.variant.step.map(|step| step.0),
            slim_thickness_fraction: self.variant.step.map(|step| step.1),
            smallest_ball_m: 1e-3 * f64::from(self.smallest_ball_mm),
            quantity: trend.quantity,
            value: trend.ours,
            holds: trend.holds(),
        };
        self.trends.iter().map(row).collect()
    }
}

/// Every trend of every variant with every list of balls.
fn judge<'a>(variants: &'a [Variant], tables: &[Table], lists: &[Vec<u32>]) -> Vec<Judged<'a>> {
    let mut judged = Vec::new();
    for (variant, table) in variants.iter().zip(tables) {
        for list in lists {
            let chosen = table.with_balls(|ball| list.contains(&((1e3 * ball.diameter_m).round() as u32)));
            let smallest_ball_mm = list.first().copied().unwrap_or(0);
            judged.push(Judged { variant, smallest_ball_mm, trends: trends::of(&chosen) });
        }
    }
    judged
}

/// One statement for every trend of a beam.
fn claim(study: &mut Study, judged: &[&Judged], beam: &str, figure: u32) {
    let count = judged.first().map_or(0, |first| first.trends.len());
    for k in 0..count {
        let of: Vec<&Trend> = judged.iter().filter_map(|one| one.trends.get(k)).collect();
        let holds = of.iter().filter(|trend| trend.holds()).count();
        let mut values: Vec<f64> = of.iter().map(|trend| trend.ours).collect();
        values.sort_by(f64::total_cmp);
        let [low, middle, high] = [0, values.len() / 2, values.len() - 1].map(|k| significant(values[k], 2));
        let trend = of[0];
        let limits = limits(trend.limits.0, trend.limits.1);
        let statement = Statement::choices(
            format!("share of choices in which this is {limits}: {}, {beam}", trend.quantity),
            &format!("{}, Fig. 4.{figure}", trend.source),
            trend.words,
            (holds, of.len()),
        );
        study.claim(
            statement.note(format!("From {low} over {middle} (median) to {high}; the limit is {}.", trend.reason)),
        );
    }
}

/// How many of the trends hold, over steps and slim parts.
fn map(study: &mut Study, choice: &EnsembleChoice, judged: &[&Judged], beam: &Beam) -> Result<(), Failure> {
    if judged.iter().any(|one| one.variant.step.is_none()) {
        return Ok(());
    }
    let steps = study.thin(&choice.steps_m, 2);
    let slim = study.thin(&choice.slim_thickness_fractions, 2);
    let share = |step_m: f64, fraction: f64| {
        let at = judged.iter().filter(|one| one.variant.step == Some((step_m, fraction)));
        let all: Vec<bool> = at.flat_map(|one| one.trends.iter().map(Trend::holds)).collect();
        all.iter().filter(|holds| **holds).count() as f64 / all.len() as f64
    };
    let values: Vec<Vec<f64>> =
        slim.iter().map(|&fraction| steps.iter().map(|&step| share(step, fraction)).collect()).collect();
    let [columns, lines] = [steps.len(), slim.len()].map(|count| (0..count).map(|k| k as f64).collect::<Vec<f64>>());
    let x =
        Axis::new("step").unit("m").ticks_at(steps.iter().zip(&columns).map(|(step, k)| (*k, significant(*step, 3))));
    let y = Axis::new("thickness of the slim part / side")
        .ticks_at(slim.iter().zip(&lines).map(|(fraction, k)| (*k, significant(*fraction, 2))));
    let value = Axis::new("share of trends that hold").limits(0.5, 1.0);
    let panel = Panel::new(x, y).height(220.0).map(HeatMap::new(&columns, &lines, values, value));
    let title = format!("{}: share of the trends of 4.2 and 7.2 that hold", beam.title);
    study.figure(
        &format!("choices-{}", beam.name),
        &Figure::new(title).row([panel]).width(620.0),
        "Over step and slim part, all ball lists together. The choice of `datasets/chapter4.json` is 0.5 and 0.5.",
    )
}

/// Share of the trends that hold, by list of balls, and the pairs of step and slim part that fit best.
fn fitting_choices(study: &mut Study, judged: &[Judged]) {
    let share = |chosen: &dyn Fn(&Judged) -> bool| {
        let all = judged.iter().filter(|one| chosen(one)).flat_map(|one| one.trends.iter().map(Trend::holds));
        let (holds, count) = all.fold((0usize, 0usize), |(holds, count), held| (holds + usize::from(held), count + 1));
        holds as f64 / count as f64
    };
    let mut lists: Vec<u32> = judged.iter().map(|one| one.smallest_ball_mm).collect();
    lists.sort_unstable();
    lists.dedup();
    let line = |smallest: &u32| {
        let share = share(&|one| one.smallest_ball_mm == *smallest);
        vec![format!("{smallest} mm"), format!("{} %", significant(100.0 * share, 3))]
    };
    study
        .text("Share of the trends that hold, over all beams, steps and slim parts, by the smallest ball of the list:");
    study.table(&["smallest ball", "trends that hold"], &lists.iter().map(line).collect::<Vec<_>>());

    let mut pairs: Vec<(f64, f64)> = Vec::new();
    for step in judged.iter().filter_map(|one| one.variant.step) {
        if !pairs.contains(&step) {
            pairs.push(step);
        }
    }
    let mut ranked: Vec<((f64, f64), f64)> =
        pairs.into_iter().map(|pair| (pair, share(&|one| one.variant.step == Some(pair)))).collect();
    ranked.sort_by(|a, b| b.1.total_cmp(&a.1));
    let line = |(rank, ((step, slim), share)): (usize, &((f64, f64), f64))| {
        let share = format!("{} %", significant(100.0 * share, 3));
        vec![(rank + 1).to_string(), significant(*step, 3), significant(*slim, 2), share]
    };
    let all: Vec<Vec<String>> = ranked.iter().enumerate().map(line).collect();
    study.text("The same over both stepped beams and all lists, by step and slim part; the first five, and ours:");
    let ours = |row: &&Vec<String>| row[1] == "0.5" && row[2] == "0.5";
    let shown: Vec<Vec<String>> = all.iter().take(5).chain(all.iter().skip(5).filter(ours)).cloned().collect();
    study.table(&["rank", "step (m)", "thickness of the slim part / side", "trends that hold"], &shown);
}

/// The row of chapter 4 that turns with the list of balls.
fn free_end(study: &mut Study, judged: &[Judged]) {
    let rise =
        |one: &Judged| one.trends.iter().find(|trend| trend.quantity == trends::FREE_END).map(|trend| trend.ours);
    let rows: Vec<Vec<String>> = judged
        .iter()
        .filter(|one| one.variant.step.is_none())
        .filter_map(|one| Some((one, rise(one)?)))
        .map(|(one, rise)| {
            vec![one.variant.beam.title.clone(), format!("{} mm", one.smallest_ball_mm), significant(rise, 3)]
        })
        .collect();
    study.text(
        "The rise towards the free end depends on the list of balls: the lightest lose at the very tip, where a beam is \
         far more mobile, and a list without them shows the rise that the thesis speaks of. Mean over all balls:",
    );
    study.table(&["beam", "smallest ball", "e at the free end less two places before"], &rows);
}

/// Fig. 4.3 for all stepped cantilevers and places.
fn speeds(study: &mut Study, case: &Case, variants: &[Variant]) -> Result<(), Failure> {
    study.section("The speed, over steps, slim parts and places (Fig. 4.3)");
    let p = &case.parameters.our_choice.speed_study;
    let ball = Ball::new(&case.parameters.material, p.diameter_m)?;
    let beams: Vec<&Variant> = variants.iter().filter(|variant| variant.beam.name == p.beam).collect();
    let places: Vec<(&Variant, f64)> =
        beams.iter().flat_map(|variant| p.locations_m.iter().map(move |&b| (*variant, b))).collect();
    let exponents = [0.0, -1.0, -0.5, 0.5, 1.0];
    let found = study.sweep(&places, exponents.len(), |&(variant, location_m)| {
        let setup = case.setup(&variant.beam, ball, location_m);
        let mut solver = setup.solver()?;
        let speeds = exponents.map(|x| case.parameters.speed_m_s * p.factor.powf(x));
        speeds
            .iter()
            .map(|&speed_m_s| Setup { speed_m_s, ..setup }.solve_with(&mut solver))
            .collect::<Result<Vec<Row>, Failure>>()
    })?;
    let rows: Vec<SpeedRow> = places
        .iter()
        .zip(&found)
        .map(|(&(variant, location_m), rows)| {
            let (step_m, slim_thickness_fraction) = variant.step.unwrap_or((f64::NAN, 1.0));
            let largest_change = rows.iter().map(|row| (row.e() - rows[0].e()).abs()).fold(0.0, f64::max);
            SpeedRow { step_m, slim_thickness_fraction, location_m, largest_change }
        })
        .collect();
    study.csv("speeds.csv", &rows)?;
    let holds = rows.iter().filter(|row| row.largest_change <= SMALL).count();
    let statement = Statement::choices(
        "share of choices in which this is ≤ 0.1: largest change of e from that at 1 m/s, speeds from 1/15 to 15 m/s, \
         stepped-cantilever",
        "footnote, 4.1; Fig. 4.3",
        "changing the velocity up or down by a factor of 15 has only a small effect",
        (holds, rows.len()),
    );
    let worst = rows.iter().map(|row| row.largest_change).fold(0.0, f64::max);
    study
        .claim(statement.note(format!("Over steps, slim parts and places; the largest is {}.", significant(worst, 2))));
    Ok(())
}

/// "Only a small effect": a tenth of the range from 0 to 1.
const SMALL: f64 = 0.1;

/// The effect of the speed for one beam and place.
#[derive(Serialize)]
struct SpeedRow {
    step_m: f64,
    slim_thickness_fraction: f64,
    location_m: f64,
    largest_change: f64,
}
