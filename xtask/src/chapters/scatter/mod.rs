//! Scatter of the law: the distribution of the restitutions of chapter 4's tables about the law, its prediction for a beam that
//! was left out of the fit, and a comparison with simpler and with more detailed models.

mod models;
mod scores;

use super::beam::Beam;
use super::chapter4::Case;
use super::chapter4::tables::{Table, of_beams};
use super::chapter7::laws::Datum;
use super::chapter7::{Dataset, LAW_MODES};
use super::theories::kaneko;
use models::{MODELS, Model, Predicted};
use scores::{Evidence, LEVELS};
use tasks::{Failure, Study};
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use vibroimpact::report::{Comparison, significant};

const INTRODUCTION: &str = "The law of energy minimisation under outward constraints gives one restitution for given \
mass ratios. Impacts with the same ratios scatter about it, because their sub-impacts occur in a different order. Here \
the law is fitted to the tables of chapter 4 by maximum likelihood, its scatter is fitted to each beam about the law \
that the other beams give, and each beam is predicted by the fit to the other three. All scores are those of \
predictions. Held ends, where no mode moves and the law is exact, are omitted.";

/// Modes of the converged tables, with remainder modes for all others.
const MODES: usize = 160;
/// A `Z` below this value is that of a support.
const HELD: f64 = 1e-6;

/// Runs the study and returns the text that introduces its report.
pub(super) fn run(study: &mut Study) -> Result<&'static str, Failure> {
    let case = Case::load()?;
    let material = &case.parameters.material;
    let thick = case.beams.iter().map(|beam| beam.timoshenko(material, kaneko(material)));
    let thick = thick.collect::<Result<Vec<_>, Failure>>()?;
    study.section("The tables");
    let sources: [(&str, &[Beam], (usize, bool)); 3] = [
        ("N = 40", &case.beams, (case.parameters.modes, false)),
        ("Euler-Bernoulli, converged", &case.beams, (MODES, true)),
        ("Timoshenko, converged", &thick, (MODES, true)),
    ];
    let mut tables = Vec::new();
    for (name, beams, model) in sources {
        tables.push((name, computed(study, &case, beams, model)?));
    }
    study.section("Fits and predictions");
    let mut found = Vec::new();
    for (name, tables) in &tables {
        let beams = data(tables)?;
        found.push((*name, study.sweep(&MODELS.each_ref(), 0, |model| Evidence::new(model, &beams))?));
    }
    scores(study, &found)?;
    coverage(study, &found, &tables)?;
    parameters(study, &found)?;
    let (_, models) = &found[1];
    let target = |quantity: &str, range: (f64, f64), ours: f64| {
        let stated = format!("{} to {}", range.0, range.1);
        Comparison::range(quantity, "converged tables", &stated, range, ours)
    };
    let [law, _, _, constant, ..] = models.as_slice() else { return Ok(INTRODUCTION) };
    study.state(target("share within the 95 % intervals, omitted beams", (0.92, 0.98), law.mean(|b| b.coverage[2])));
    let ratio = law.mean(|beam| beam.crps) / constant.mean(|beam| beam.crps);
    study.state(target("CRPS of the law with its scatter over that of a constant", (0.0, 0.5), ratio));
    let (_, converged) = &tables[1];
    bands(study, converged, &found[1].1[0])?;
    Ok(INTRODUCTION)
}

/// The tables of these beams with this many modes, with or without remainder modes.
fn computed<'a>(
    study: &mut Study,
    case: &Case,
    beams: &'a [Beam],
    model: (usize, bool),
) -> Result<Vec<Table<'a>>, Failure> {
    of_beams(study, case, beams, model, |setup, solver| setup.solve_once_with(solver))
}

/// The impacts of every beam.
fn data(tables: &[Table]) -> Result<Vec<Vec<Datum>>, Failure> {
    let of_beam = |table: &Table| {
        let mut data = Datum::all(&Dataset::new(table))?;
        data.retain(|datum| datum.impact.z > HELD);
        Ok(data)
    };
    tables.iter().map(of_beam).collect()
}

type Found = [(&'static str, Vec<Evidence>)];

fn scores(study: &mut Study, found: &Found) -> Result<(), Failure> {
    let mut lines = Vec::new();
    for (table, models) in found {
        for evidence in models {
            let figures = [
                evidence.mean(|beam| beam.crps),
                evidence.mean(|beam| beam.log_score),
                evidence.mean(|beam| beam.rms.powi(2)).sqrt(),
                evidence.mean(|beam| beam.coverage[2]),
                evidence.mean(|beam| beam.width),
            ];
            let [crps, log_score, rms, coverage, width] = figures;
            let cells = [
                format!("{crps:.4}"),
                format!("{log_score:.3}"),
                format!("{rms:.3}"),
                format!("{:.1} %", 100.0 * coverage),
                format!("{width:.2}"),
            ];
            let names =
                [(*table).to_owned(), evidence.model.name.to_owned(), evidence.model.parameters.len().to_string()];
            lines.push(names.into_iter().chain(cells).collect());
        }
    }
    let headers =
        ["tables", "model", "parameters", "CRPS", "log score", "rms of the median", "within 95 %", "mean width"];
    study.tabled("scores", &headers, &lines)?;
    study.text(
        "The table has means over all impacts, where each beam is predicted by the fit to the other three. Smaller \
         scores are better.",
    );
    Ok(())
}

/// For the first model, the share of the restitutions of a beam left out that lie within the intervals.
fn coverage(study: &mut Study, found: &Found, tables: &[(&str, Vec<Table>)]) -> Result<(), Failure> {
    let mut lines = Vec::new();
    for ((name, models), (_, tables)) in found.iter().zip(tables) {
        for (beam, table) in models[0].left_out.iter().zip(tables) {
            let shares = beam.coverage.iter().map(|share| format!("{:.1} %", 100.0 * share));
            let names = [(*name).to_owned(), table.beam.title.clone()];
            lines.push(names.into_iter().chain(shares).chain([format!("{:.4}", beam.crps)]).collect());
        }
    }
    let levels = LEVELS.map(|level| format!("within {} %", 100.0 * level));
    let headers: Vec<&str> =
        ["tables", "beam left out"].into_iter().chain(levels.iter().map(String::as_str)).chain(["CRPS"]).collect();
    study.tabled("coverage", &headers, &lines)?;
    study
        .text("The table is for the law with its scatter, where each beam is predicted by the fit to the other three.");
    Ok(())
}

fn parameters(study: &mut Study, found: &Found) -> Result<(), Failure> {
    let of = |(name, models): &(&str, Vec<Evidence>)| {
        let numbers = models[0].together.iter().map(|value| significant(*value, 3));
        std::iter::once((*name).to_owned()).chain(numbers).collect()
    };
    let names = MODELS[0].parameters.iter().map(|(name, _)| *name);
    let headers: Vec<&str> = std::iter::once("tables").chain(names).collect();
    study.tabled("parameters", &headers, &found.iter().map(of).collect::<Vec<Vec<String>>>())?;
    study.text(&format!(
        "The law with its scatter is fitted to all four beams at once, with {LAW_MODES} modes in the law."
    ));
    Ok(())
}

/// Plots the restitution of each beam against `Z`, with the intervals predicted from the other beams.
fn bands(study: &mut Study, tables: &[Table], evidence: &Evidence) -> Result<(), Failure> {
    let mut panels = Vec::new();
    for ((table, beam), left_out) in tables.iter().zip(data(tables)?).zip(&evidence.left_out) {
        let mut order: Vec<&Datum> = beam.iter().collect();
        order.sort_by(|a, b| a.impact.z.total_cmp(&b.impact.z));
        let z: Vec<f64> = order.iter().map(|datum| datum.impact.z).collect();
        let at = |share: f64| smoothed(evidence.model, &left_out.parameters, &order, share);
        let observed: Vec<f64> = order.iter().map(|datum| datum.observed).collect();
        let panel = Panel::new(Axis::new("Z").log(), Axis::new("restitution").limits(0.0, 1.0))
            .title(table.beam.title.clone())
            .height(210.0)
            .with(Series::band(&z, &at(0.025), &at(0.975)).colour(Colour::Blue))
            .with(Series::line(&z, &at(0.5)).colour(Colour::Blue))
            .with(Series::points(&z, &observed, Marker::Dot).colour(Colour::Vermilion));
        panels.push(panel);
    }
    let figure = Figure::new("Restitution of each beam, predicted from the other three").width(960.0);
    let figure = panels.chunks(2).fold(figure, |figure, row| figure.row(row.to_vec()));
    study.figure(
        "scatter-of-the-law",
        &figure,
        "The dots are the table (Euler-Bernoulli, converged). Line and band are the median and the 95 % interval of \
         the law with its scatter, fitted to the other three beams and averaged over the impacts with nearly the same \
         Z.",
    )
}

/// A quantile over neighbouring impacts: impacts of the same `Z` differ in `S_1`, and so do their predictions.
fn smoothed(model: &Model, parameters: &[f64], order: &[&Datum], share: f64) -> Vec<f64> {
    const EITHER_SIDE: usize = 12;
    let predicted: Vec<Predicted> = order.iter().map(|datum| model.predict(parameters, datum)).collect();
    let mean = |i: usize| {
        let near = &predicted[i.saturating_sub(EITHER_SIDE)..(i + EITHER_SIDE + 1).min(predicted.len())];
        near.iter().map(|one| one.quantile(share)).sum::<f64>() / near.len() as f64
    };
    (0..order.len()).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use emoc::ScatteredLaw;

    /// Checks the main numbers of docs/scatter-of-the-law.md and the default parameters of `emoc`.
    #[test]
    fn beams_left_out_are_predicted_as_the_page_says() {
        let folder = tempfile::tempdir().unwrap();
        let mut study = Study::new(folder.path(), false).unwrap();
        let case = Case::load().unwrap();
        let beams = data(&computed(&mut study, &case, &case.beams, (MODES, true)).unwrap()).unwrap();
        let found: Vec<Evidence> =
            study.sweep(&MODELS[..4].iter().collect::<Vec<_>>(), 0, |model| Evidence::new(model, &beams)).unwrap();
        let [law, misfit, same, constant] = found.as_slice() else { panic!() };
        let close = |found: f64, told: f64, error: f64| assert!((found - told).abs() <= error, "{found}, told {told}");
        for (evidence, crps, log_score) in
            [(law, 0.0465, -1.121), (misfit, 0.0465, -1.100), (same, 0.0460, -1.082), (constant, 0.1236, -0.223)]
        {
            close(evidence.mean(|beam| beam.crps), crps, 5e-4);
            close(evidence.mean(|beam| beam.log_score), log_score, 5e-3);
        }
        for (level, told, of_misfit) in [(0, 0.48, 0.458), (1, 0.793, 0.721), (2, 0.965, 0.956)] {
            close(law.mean(|beam| beam.coverage[level]), told, 0.01);
            close(misfit.mean(|beam| beam.coverage[level]), of_misfit, 0.01);
        }
        let ScatteredLaw { law: parameters, single, repeated, onset } = ScatteredLaw::BEAMS;
        let brought = [parameters.mu0, parameters.alpha0, parameters.alpha1, single, repeated, onset];
        for (found, brought) in law.together.iter().zip(brought) {
            close(found / brought, 1.0, 0.02);
        }
    }
}
