//! The evidence for the automatic choice of the model: random scenes against a far tighter reference.

mod net;
mod scenes;

use super::Failure;
use super::study::Study;
use serde::Serialize;
use std::time::Instant;
use vibroimpact::Scene;
use vibroimpact::model::{Answer, Model, Modes};
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use vibroimpact::report::{Comparison, significant};
use vibroimpact::scene::Structure;

/// Scenes, in full and in the quick form.
const SCENES: (u64, u64) = (400, 40);
/// Numbers of modes of the reference and of its check; their tolerance.
const REFERENCE: [usize; 2] = [360, 250];
const REFERENCE_TOLERANCE: f64 = 1e-10;
/// The fixed number of modes to which costs are compared, at its default settings.
const FIXED: usize = 100;
/// Runs of which the fastest counts.
const REPEATS: usize = 5;
/// Smaller errors are rounding.
const ROUNDING: f64 = 1e-11;
/// A reference counts where it is known this many times better than the tolerance.
const TIGHTER: f64 = 3.0;

const INTRODUCTION: &str = "The automatic choice of the model, put to the test on random scenes: beams with \
every pair of ends, with and without a step, strikers from a millionth to three times the mass of the beam, 0.05 to 5 \
m/s, four laws of contact, damping ratios from 0.001 to 0.1 and none, tolerances from 1e-5 to 1e-1. The reference has \
360 modes with remainder modes for all others and a tolerance of 1e-10; the same with 250 modes tells how well it \
is known itself. Where the reference is not known three times better than the tolerance, the scene is listed and not \
counted.";

/// One scene and what became of it.
#[derive(Clone, Serialize)]
struct Row {
    scene: u64,
    damping_ratio: f64,
    law: &'static str,
    tolerance: f64,
    model: &'static str,
    modes: usize,
    sub_impacts: Option<usize>,
    restitution: Option<f64>,
    uncertainty: Option<f64>,
    settled: bool,
    reference: Option<f64>,
    reference_change: Option<f64>,
    error: Option<f64>,
    solves: u64,
    mode_steps: u64,
    fixed_mode_steps: u64,
    fixed_error: Option<f64>,
}

impl Row {
    fn new(number: u64) -> Result<Row, Failure> {
        let scene = scenes::scene(number)?;
        let answer = scene.answer()?;
        let [reference, check] = REFERENCE.map(|modes| stated(&scene, modes, true, Some(REFERENCE_TOLERANCE)).answer());
        let (reference, check) = (reference?.restitution, check?.restitution);
        let fixed = stated(&scene, FIXED, false, None).answer()?;
        let from_reference = |e: Option<f64>| e.zip(reference).map(|(e, reference)| (e - reference).abs());
        Ok(Row {
            scene: number,
            damping_ratio: damping(&scene),
            law: scene.contact.law_name(),
            tolerance: answer.tolerance,
            model: answer.model.as_str(),
            modes: answer.modes,
            sub_impacts: answer.sub_impact_count,
            restitution: answer.restitution,
            uncertainty: answer.restitution_uncertainty,
            settled: answer.settled,
            reference,
            reference_change: from_reference(check),
            error: from_reference(answer.restitution),
            solves: answer.cost.solves,
            mode_steps: answer.cost.mode_steps,
            fixed_mode_steps: fixed.cost.mode_steps,
            fixed_error: from_reference(fixed.restitution),
        })
    }

    /// Whether the reference is known well enough for this tolerance.
    fn counts(&self) -> bool {
        self.reference_change.is_some_and(|change| change * TIGHTER <= self.tolerance)
    }

    fn meets(&self) -> bool {
        self.error.is_some_and(|error| error <= self.tolerance)
    }

    /// Actual error over the uncertainty reported; what the reference does not know is no error.
    fn overrun(&self) -> Option<f64> {
        let error = self.error? - self.reference_change?;
        Some(if error > ROUNDING { error / self.uncertainty? } else { 0.0 })
    }
}

fn damping(scene: &Scene) -> f64 {
    match &scene.structure {
        Structure::Beam(beam) => beam.damping_ratio,
        _ => 0.0,
    }
}

/// The scene with so many modes.
fn stated(scene: &Scene, modes: usize, residual: bool, tolerance: Option<f64>) -> Scene {
    Scene { modes: Modes::Count(modes), residual_compliance: Some(residual), tolerance, ..scene.clone() }
}

/// Time of the choice and of the fixed number of modes, each the fastest of several runs one after another.
#[derive(Serialize)]
struct Timing {
    scene: u64,
    choice_us: f64,
    fixed_us: f64,
}

fn fastest(scene: &Scene) -> Result<f64, Failure> {
    let mut best = f64::INFINITY;
    for _ in 0..REPEATS {
        let start = Instant::now();
        std::hint::black_box::<Answer>(scene.answer()?);
        best = best.min(start.elapsed().as_secs_f64() * 1e6);
    }
    Ok(best)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn geometric(values: &[f64]) -> f64 {
    mean(&values.iter().map(|v| v.ln()).collect::<Vec<f64>>()).exp()
}

pub fn run(study: &mut Study, first: u64) -> Result<&'static str, Failure> {
    study.section("Random scenes");
    let count = if study.quick { SCENES.1 } else { SCENES.0 };
    let numbers: Vec<u64> = (0..count).map(|i| first.saturating_add(i)).collect();
    let rows = study.sweep(&numbers, 1, |&number| Row::new(number))?;
    study.csv("scenes.csv", &rows)?;
    outcome(study, &rows);
    picture(study, &rows)?;
    timing(study, &rows)?;
    net::run(study)?;
    Ok(INTRODUCTION)
}

fn outcome(study: &mut Study, rows: &[Row]) {
    let counted: Vec<&Row> = rows.iter().filter(|row| row.counts()).collect();
    let damped: Vec<&Row> = counted.iter().copied().filter(|row| row.damping_ratio > 0.0).collect();
    let met = damped.iter().filter(|row| row.meets()).count();
    let share = met as f64 / damped.len() as f64;
    let claimed = counted.iter().filter(|row| row.settled);
    let kept = claimed.clone().filter(|row| row.meets()).count();
    let worst = counted.iter().filter_map(|row| row.overrun()).fold(0.0, f64::max);
    let missing = counted.iter().filter(|row| row.overrun().is_none()).count();
    let fixed = damped.iter().filter(|row| row.fixed_error.is_some_and(|error| error <= row.tolerance)).count();
    study.state(Comparison::range(
        "damped scenes within their tolerance",
        "target",
        "at least 99 %",
        (0.99, 1.0),
        share,
    ));
    study.state(Comparison::range(
        "largest actual error over reported uncertainty, all scenes",
        "target",
        "at most 10",
        (0.0, 10.0),
        worst,
    ));
    let left_out: Vec<&Row> = rows.iter().filter(|row| !row.counts()).collect();
    let admitted = left_out.iter().filter(|row| !row.settled).count();
    study.text(&format!(
        "{} scenes, of which the reference is known well enough for {}; of these {} are damped, and {met} of them are \
         within their tolerance ({} %). With {FIXED} modes and plain truncation {fixed} of them would be. {} of all \
         scenes counted are said to be within their tolerance, and {kept} are. {missing} of the scenes counted have no \
         stated uncertainty. Of the {} scenes not counted, {} are undamped, and the choice says of {admitted} that they \
         do not settle.",
        rows.len(),
        counted.len(),
        damped.len(),
        significant(100.0 * share, 4),
        claimed.count(),
        left_out.len(),
        left_out.iter().filter(|row| row.damping_ratio == 0.0).count(),
    ));
    let models = [Model::Rigid, Model::InfiniteBeam, Model::Modal, Model::Emoc];
    let lines: Vec<Vec<String>> = models
        .iter()
        .map(|model| {
            let of: Vec<&&Row> = counted.iter().filter(|row| row.model == model.as_str()).collect();
            let worst = of.iter().filter_map(|row| row.overrun()).fold(0.0, f64::max);
            let met = of.iter().filter(|row| row.meets()).count();
            vec![model.as_str().to_owned(), of.len().to_string(), met.to_string(), significant(worst, 2)]
        })
        .collect();
    study.table(&["model", "scenes", "within tolerance", "worst error over uncertainty"], &lines);
    let misses: Vec<Vec<String>> = counted
        .iter()
        .filter(|row| !row.meets())
        .map(|row| {
            let small = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |v| significant(v, 2));
            vec![
                row.scene.to_string(),
                significant(row.damping_ratio, 2),
                row.model.to_owned(),
                small(Some(row.tolerance)),
                small(row.error),
                small(row.uncertainty),
                if row.settled { "settled" } else { "not settled" }.to_owned(),
            ]
        })
        .collect();
    if !misses.is_empty() {
        study.text("Scenes beyond their tolerance:");
        study.table(&["scene", "damping ratio", "model", "tolerance", "error", "uncertainty", "said"], &misses);
    }
    costs(study, rows);
}

/// Mode-steps of the fixed number of modes over those of the choice; a choice that integrates no mode counts as one step.
fn costs(study: &mut Study, rows: &[Row]) {
    let ratios: Vec<f64> = rows.iter().map(|row| row.fixed_mode_steps as f64 / row.mode_steps.max(1) as f64).collect();
    let modal: Vec<f64> = rows.iter().zip(&ratios).filter(|(row, _)| row.mode_steps > 0).map(|(_, r)| *r).collect();
    let of = |rows: &[&Row]| {
        let sums = rows.iter().fold((0, 0), |(a, b), row| (a + row.fixed_mode_steps, b + row.mode_steps));
        significant(sums.0 as f64 / sums.1.max(1) as f64, 3)
    };
    let cheaper = modal.iter().filter(|ratio| **ratio > 1.0).count();
    study.state(Comparison::range(
        format!(
            "mode-steps of {FIXED} fixed modes over those of the choice, arithmetic mean where modes are integrated"
        ),
        "target",
        "at least 10",
        (10.0, f64::INFINITY),
        mean(&modal),
    ));
    study.text(&format!(
        "Mode-steps of {FIXED} fixed modes over those of the choice, where modes were integrated at all ({} scenes, \
         {cheaper} of them cheaper): arithmetic mean {}, geometric mean {}. Of the sums over all scenes {}, over those \
         that settle {}, over those of them for which the fixed number is enough {}.",
        modal.len(),
        significant(mean(&modal), 3),
        significant(geometric(&modal), 3),
        of(&rows.iter().collect::<Vec<&Row>>()),
        of(&rows.iter().filter(|row| row.settled).collect::<Vec<&Row>>()),
        of(&rows
            .iter()
            .filter(|row| row.settled && row.fixed_error.is_some_and(|error| error <= row.tolerance))
            .collect::<Vec<&Row>>()),
    ));
}

const MODELS: [(Model, Colour, Marker); 4] = [
    (Model::Rigid, Colour::Grey, Marker::Square),
    (Model::InfiniteBeam, Colour::Green, Marker::Triangle),
    (Model::Modal, Colour::Blue, Marker::Circle),
    (Model::Emoc, Colour::Orange, Marker::Plus),
];

fn picture(study: &mut Study, rows: &[Row]) -> Result<(), Failure> {
    let counted: Vec<&Row> = rows.iter().filter(|row| row.counts()).collect();
    // an error below the reference's own is shown as that
    let error = |row: &Row| row.error.unwrap_or(1.0).max(row.reference_change.unwrap_or(0.0)).max(1e-12);
    let panel = |x: &str, of: fn(&Row) -> f64, low: f64| {
        let panel = Panel::new(Axis::new(x).log().limits(low, 1.0), Axis::new("actual error").log().limits(1e-12, 1.0));
        let mut panel = panel.with(Series::line(&[low, 1.0], &[low, 1.0]).colour(Colour::Black));
        for (model, colour, marker) in MODELS {
            let of_model: Vec<&&Row> = counted.iter().filter(|row| row.model == model.as_str()).collect();
            if of_model.is_empty() {
                continue;
            }
            let x: Vec<f64> = of_model.iter().map(|row| of(row)).collect();
            let y: Vec<f64> = of_model.iter().map(|row| error(row)).collect();
            panel = panel.with(Series::points(&x, &y, marker).colour(colour).label(model.as_str()));
        }
        panel
    };
    let tolerance = panel("tolerance", |row| row.tolerance, 5e-6);
    let uncertainty = panel("reported uncertainty", |row| row.uncertainty.unwrap_or(1.0).max(1e-9), 1e-9);
    study.figure(
        "choosing-the-model",
        &Figure::new("The automatic choice on random scenes").row([tolerance, uncertainty]),
        "Each mark is one scene. Below the line the error is smaller than what was asked for, and than what was reported.",
    )
}

/// Times differ from run to run, so they stay out of the report.
fn timing(study: &mut Study, rows: &[Row]) -> Result<(), Failure> {
    let mut timings = Vec::new();
    for row in rows {
        let scene = scenes::scene(row.scene)?;
        let fixed_us = fastest(&stated(&scene, FIXED, false, None))?;
        timings.push(Timing { scene: row.scene, choice_us: fastest(&scene)?, fixed_us });
    }
    let ratios: Vec<f64> = timings.iter().map(|timing| timing.fixed_us / timing.choice_us).collect();
    let sum = |of: fn(&Timing) -> f64| timings.iter().map(of).sum::<f64>();
    study.remark(format!(
        "Time of {FIXED} fixed modes over time of the choice: arithmetic mean {}, geometric mean {}, of the sums {}.",
        significant(mean(&ratios), 3),
        significant(geometric(&ratios), 3),
        significant(sum(|t| t.fixed_us) / sum(|t| t.choice_us), 3)
    ));
    study.csv("timings-of-scenes.csv", &timings)
}
