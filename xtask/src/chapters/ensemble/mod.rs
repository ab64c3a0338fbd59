//! Variation of the parameters that the thesis does not state: steps, thin parts, lists of balls and locations. Counts for how
//! many of the choices each trend of the thesis holds.

mod law;
mod single;
mod variant;

use super::beam::{Beam, segment};
use super::chapter4::trends::{self, Trend};
use super::chapter4::{Case, EnsembleChoice, tables::Table};
use super::impact::{Ball, Row};
use super::study::Study;
use serde::Serialize;
use tasks::Failure;
use variant::{MOST_MODES, Variant, claim};
use vibroimpact::plot::{Axis, Figure, HeatMap, Panel};
use vibroimpact::report::significant;

const INTRODUCTION: &str = "The thesis states neither the position of its steps, nor the thickness of its slim parts, \
nor the list of its twelve balls. Its statements about them are therefore tested with all plausible choices: a grid of \
steps and slim parts, and every list of twelve balls in equal steps of whole millimetres that contains the three \
masses which chapter 4 states. Everything else is as in chapter 4: 40 modes, 2 % damping, 1 m/s, 25 locations. The \
statements of section 7.2 about the law are tested on the same tables, with the law fitted to each. A trend that holds \
in nine of ten choices counts as confirmed, one that fails in nine of ten as refuted. Otherwise the text does not \
suffice to decide.";

/// Result of a trend of one beam over all choices.
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

/// Runs the ensembles and returns the text that introduces their report.
pub(super) fn run(study: &mut Study) -> Result<&'static str, Failure> {
    let case = Case::load()?;
    let choice = &case.parameters.our_choice.ensemble;
    let variants = variants(study, &case, choice)?;
    let lists = choice.ball_lists();
    let balls = balls(study, &case, &lists)?;
    study.section("Trends over steps, slim parts and ball lists");
    let places: Vec<Vec<f64>> = variants.iter().map(|variant| study.thin(&case.places(&variant.beam), 9)).collect();
    let tables = tables(study, &case, &variants, &balls, places)?;
    let closer = variants.iter().map(|variant| closer_places(&case, &variant.beam)).collect();
    let closer = self::tables(study, &case, &variants, &balls, closer)?;
    study.section("The law fitted to every choice");
    let judged = judge(study, &variants, [&tables, &closer], &lists)?;
    study.csv("trends.csv", &judged.iter().flat_map(Judged::rows).collect::<Vec<TrendRow>>())?;
    for (k, beam) in case.beams.iter().enumerate() {
        let of: Vec<&Judged> = judged.iter().filter(|one| one.variant.beam.name == beam.name).collect();
        let (tables, law): (Vec<&[Trend]>, Vec<&[Trend]>) =
            of.iter().map(|one| (one.trends.as_slice(), one.law.as_slice())).unzip();
        claim(study, &tables, &beam.name, &format!("4.{}", k + 6));
        claim(study, &law, &beam.name, &format!("7.{}", k + 3));
        map(study, choice, &of, beam)?;
    }
    fitting_choices(study, &judged);
    free_end(study, &judged);
    single::run(study, &case, &variants)?;
    Ok(INTRODUCTION)
}

/// Every beam of the chapter, the stepped ones in all their forms.
fn variants(study: &Study, case: &Case, choice: &EnsembleChoice) -> Result<Vec<Variant>, Failure> {
    let steps = study.thin(&choice.steps_m, 2);
    let slim = study.thin(&choice.slim_thickness_fractions, 2);
    let mut variants = Vec::new();
    for beam in &case.parameters.our_choice.beams {
        let build = |segments| Beam::new(&beam.name, &beam.title, beam.ends, segments, MOST_MODES);
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

/// Every ball of any list, without repetition, in increasing size.
fn balls(study: &Study, case: &Case, lists: &[Vec<u32>]) -> Result<Vec<Ball>, Failure> {
    let mut diameters_mm: Vec<u32> = lists.iter().flatten().copied().collect();
    diameters_mm.sort_unstable();
    diameters_mm.dedup();
    let kept = study.thin(&diameters_mm, 8);
    kept.iter().map(|&mm| Ball::new(&case.parameters.material, 1e-3 * f64::from(mm))).collect()
}

/// A location near each held end, at a sixteenth of the distance between two locations of the tables.
fn closer_places(case: &Case, beam: &Beam) -> Vec<f64> {
    let places = case.places(beam);
    let near = places.get(1).map_or(f64::NAN, |first| first / 16.0);
    let held = beam.model.beam.ends.map(|end| end != beam_modes::End::Free);
    [near, beam.model.beam.length_m() - near].into_iter().zip(held).filter_map(|(b, held)| held.then_some(b)).collect()
}

/// The tables of all variants at these locations.
fn tables<'a>(
    study: &mut Study,
    case: &'a Case,
    variants: &'a [Variant],
    balls: &[Ball],
    lists: Vec<Vec<f64>>,
) -> Result<Vec<Table<'a>>, Failure> {
    let places: Vec<(&Beam, f64)> =
        variants.iter().zip(&lists).flat_map(|(variant, list)| list.iter().map(move |&b| (&variant.beam, b))).collect();
    let results = study.sweep(&places, balls.len(), |&(beam, location_m)| {
        let solver = case.setup(beam, balls[0], location_m).solver()?;
        balls
            .iter()
            .map(|ball| case.setup(beam, *ball, location_m).solve_once_with(&solver))
            .collect::<Result<Vec<Row>, Failure>>()
    })?;
    let mut results = results.into_iter();
    let table = |(variant, places_m): (&'a Variant, Vec<f64>)| {
        let rows = results.by_ref().take(places_m.len()).collect();
        Table { beam: &variant.beam, places_m, balls: balls.to_vec(), rows }
    };
    Ok(variants.iter().zip(lists).map(table).collect())
}

/// Trends of one choice.
struct Judged<'a> {
    variant: &'a Variant,
    smallest_ball_mm: u32,
    /// Trends of the table.
    trends: Vec<Trend>,
    /// Trends of the law fitted to the table.
    law: Vec<Trend>,
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
        self.trends.iter().chain(&self.law).map(row).collect()
    }
}

/// Every trend of every variant with every list of balls.
fn judge<'a>(
    study: &mut Study,
    variants: &'a [Variant],
    [tables, closer]: [&[Table]; 2],
    lists: &[Vec<u32>],
) -> Result<Vec<Judged<'a>>, Failure> {
    let cases: Vec<(usize, &Vec<u32>)> =
        (0..variants.len()).flat_map(|k| lists.iter().map(move |list| (k, list))).collect();
    study.sweep(&cases, 0, |&(k, list)| {
        let of_list = |ball: &Ball| list.contains(&((1e3 * ball.diameter_m).round() as u32));
        let chosen = tables[k].with_balls(of_list);
        let mut trends = trends::of(&chosen);
        trends.extend(trends::closer_to_held_ends(&chosen, &closer[k].with_balls(of_list)));
        let smallest_ball_mm = list.first().copied().unwrap_or(0);
        Ok(Judged { variant: &variants[k], smallest_ball_mm, trends, law: law::trends(&chosen)? })
    })
}

/// Plots the share of the trends that hold against step and thickness of the thin part.
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
    study.main_figure(
        &format!("choices-{}", beam.name),
        &Figure::new(title).row([panel]).width(620.0),
        "The share is over step and slim part, for all lists of balls together. The choice of `datasets/chapter4.json` \
         is 0.5 and 0.5.",
    )
}

/// Share of the trends that hold for each list of balls, and the best pairs of step and thickness.
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
    study.text(
        "The table has the share of the trends that hold over all beams, steps and slim parts, by the smallest ball of \
         the list.",
    );
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
    study.text(
        "The next table has the same share over both stepped beams and all lists, by step and slim part, for the five \
         best choices and for ours.",
    );
    let ours = |row: &&Vec<String>| row[1] == "0.5" && row[2] == "0.5";
    let shown: Vec<Vec<String>> = all.iter().take(5).chain(all.iter().skip(5).filter(ours)).cloned().collect();
    study.table(&["rank", "step (m)", "thickness of the slim part / side", "trends that hold"], &shown);
}

/// The statement of chapter 4 whose verdict depends on the list of balls.
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
        "The rise towards the free end depends on the list of balls. The lightest balls lose speed at the very tip, \
         where a beam is far more mobile, and a list without them shows the rise that the thesis describes. The table \
         has the mean over all balls.",
    );
    study.table(&["beam", "smallest ball", "e at the free end minus that two locations before"], &rows);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chapters::study::finish;

    #[test]
    fn a_trend_is_judged_by_how_many_choices_bear_it_out() {
        let folder = tempfile::tempdir().unwrap();
        let verdicts = |holding: usize, of: usize, otherwise: &'static str| {
            let trend = |k: usize| {
                let ours = if k < holding { 0.2 } else { -0.2 };
                vec![Trend { otherwise, ..Trend::new("rise", "it rises", trends::RISES, ours) }]
            };
            let choices: Vec<Vec<Trend>> = (0..of).map(trend).collect();
            let mut study = Study::new(folder.path(), true).unwrap();
            claim(&mut study, &choices.iter().map(Vec::as_slice).collect::<Vec<_>>(), "beam", "4.6");
            let rows = finish(study, 4, "title", "").unwrap().rows();
            assert_eq!(rows.len(), 1);
            rows[0].verdict
        };
        use crate::chapters::statement::Verdict::{Agrees, Differs, Undecidable};
        assert_eq!(
            [10, 9, 8, 2, 1, 0].map(|n| verdicts(n, 10, "")),
            [Agrees, Agrees, Undecidable, Undecidable, Differs, Differs]
        );
        // a statement with another possible meaning cannot be refuted, but it can be confirmed
        assert_eq!([9, 1].map(|n| verdicts(n, 10, "what else")), [Agrees, Undecidable]);
        // without unstated parameters the number itself decides
        assert_eq!([1, 0].map(|n| verdicts(n, 1, "")), [Agrees, Differs]);
    }
}
