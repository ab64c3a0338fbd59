//! The fits of section 7.2, and the error against the number of modes (Fig. 7.7).

use super::{Dataset, LAW_MODES};
use crate::chapters::Failure;
use crate::chapters::study::Study;
use fitting::Fit;
use serde::Serialize;
use vibroimpact::net::Observations;
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use vibroimpact::report::{Comparison, significant};

/// One beam's fit with the data that it was made to.
pub(super) struct BeamFit {
    pub observations: Observations,
    pub fit: Fit,
}

impl BeamFit {
    fn new(data: &Dataset, modes: usize) -> Result<BeamFit, Failure> {
        let observations = data.observations(modes)?;
        let fit = observations.fit()?;
        Ok(BeamFit { observations, fit })
    }
}

/// A fit as a row of a table.
#[derive(Serialize)]
struct FitRow {
    beam: String,
    table: &'static str,
    modes: usize,
    mu0: f64,
    alpha0: f64,
    alpha1: f64,
    rms: f64,
    max_error: f64,
    count: usize,
    starts: usize,
    starts_at_least: usize,
    rms_of_worst_start: f64,
    evaluations: usize,
}

impl FitRow {
    fn new(data: &Dataset, table: &'static str, modes: usize, fit: &Fit) -> FitRow {
        let rms = |sum: f64| (sum / fit.report.count as f64).sqrt();
        let ends: Vec<f64> =
            fit.starts.iter().map(|start| rms(start.sum_of_squares)).filter(|rms| rms.is_finite()).collect();
        FitRow {
            beam: data.beam.name.clone(),
            table,
            modes,
            mu0: fit.parameters[0],
            alpha0: fit.parameters[1],
            alpha1: fit.parameters[2],
            rms: fit.report.rms,
            max_error: fit.report.max_abs,
            count: fit.report.count,
            starts: fit.starts.len(),
            starts_at_least: ends.iter().filter(|end| **end < 1.001 * fit.report.rms).count(),
            rms_of_worst_start: ends.iter().copied().fold(0.0, f64::max),
            evaluations: fit.evaluations,
        }
    }

    fn cells(&self, title: &str, intervals: &[String; 3]) -> Vec<String> {
        let [mu0, alpha0, alpha1] = intervals.clone();
        let numbers = [self.rms, self.max_error, self.rms_of_worst_start].map(|v| significant(v, 3));
        let [rms, largest, worst] = numbers;
        let least = format!("{} of {}", self.starts_at_least, self.starts);
        vec![title.into(), self.table.into(), mu0, alpha0, alpha1, rms, largest, least, worst]
    }
}

/// The parameters with half the width of their 95 % intervals, as text.
fn with_intervals(fit: &Fit) -> Result<[String; 3], Failure> {
    let intervals = fit.intervals(0.95)?;
    Ok([0, 1, 2].map(|k| {
        let value = significant(fit.parameters[k], 3);
        match &intervals {
            Some(all) => format!("{value} ({} to {})", significant(all[k].low, 3), significant(all[k].high, 3)),
            None => value,
        }
    }))
}

/// Fits every beam to both tables; gives those to the thesis's tables.
pub(super) fn run(study: &mut Study, truncated: &[Dataset], settled: &[Dataset]) -> Result<Vec<BeamFit>, Failure> {
    study.section("Three parameters a beam (section 7.2)");
    let (mut rows, mut cells, mut fits) = (Vec::new(), Vec::new(), Vec::new());
    for (tables, name) in [(truncated, "N = 40"), (settled, "converged")] {
        for data in tables {
            let found = BeamFit::new(data, LAW_MODES)?;
            let row = FitRow::new(data, name, LAW_MODES, &found.fit);
            cells.push(row.cells(&data.beam.title, &with_intervals(&found.fit)?));
            rows.push(row);
            fits.push(found);
        }
    }
    study.table(
        &["beam", "table", "μ₀", "α₀", "α₁", "rms", "largest", "starts at the minimum", "rms of the worst start"],
        &cells,
    );
    study.text(
        "Parameters with 95 % intervals, which assume independent errors and are too narrow here; root-mean-square and \
         largest difference of law and table. The sum of squares has several minima: of the starting points only some \
         lead to the least one. A single search, as the thesis describes it, can end at the error in the last column.",
    );
    study.csv("fits.csv", &rows)?;
    fits.truncate(truncated.len());
    for (row, data) in rows.iter().zip(truncated) {
        study.state(Comparison::range(
            format!("root-mean-square error of the fit, {}", data.beam.name),
            "7.2",
            "captures reasonably well",
            (0.0, 0.1),
            row.rms,
        ));
    }
    for (data, found) in truncated.iter().zip(&fits) {
        trends(study, data, found);
    }
    Ok(fits)
}

/// What section 7.2 says that the law captures.
fn trends(study: &mut Study, data: &Dataset, found: &BeamFit) {
    let name = &data.beam.name;
    let length = data.beam.model.length_m();
    let predicted: Vec<f64> = found.fit.residuals.iter().zip(&data.rows).map(|(r, row)| r + row.e()).collect();
    let [held_left, held_right] = data.beam.model.ends.map(|end| end != beam_modes::End::Free);
    let at_held = |place: f64| (held_left && place == 0.0) || (held_right && place == length);
    let least = data.rows.iter().zip(&predicted).filter(|(row, _)| at_held(row.location_m)).map(|(_, e)| *e);
    study.state(Comparison::range(
        format!("least e of the law at the held ends, {name}"),
        "7.2",
        "rebound is perfect, and captured",
        (0.999_999, 1.0),
        least.fold(1.0, f64::min),
    ));
    let places = &data.table.places_m;
    if let (false, [.., before, _, _]) = (held_right, places.as_slice()) {
        let mean = |place: f64| {
            let chosen = data.rows.iter().zip(&predicted).filter(|(r, _)| r.location_m == place && r.mass_kg > 0.06);
            let chosen: Vec<f64> = chosen.map(|(_, e)| *e).collect();
            chosen.iter().sum::<f64>() / chosen.len() as f64
        };
        study.state(Comparison::range(
            format!("law: mean e at the free end less that two places before, balls above 0.06 kg, {name}"),
            "7.2",
            "the rising trend near the free end",
            (0.0, 1.0),
            mean(length) - mean(*before),
        ));
    }
}

/// Fig. 7.7: the error of the fit against the number of modes in the law.
pub(super) fn against_modes(study: &mut Study, data: &[Dataset]) -> Result<(), Failure> {
    study.section("Error of the fit against the number of modes in the law (Fig. 7.7)");
    let all = [1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 35, 40, 45, 50, 60, 70, 80, 90, 100];
    let counts = if study.quick { vec![1, 10, 40, 50, 100] } else { all.to_vec() };
    let mut panel = Panel::new(Axis::new("modes N in the law").integers(), Axis::new("rms error of the fit"));
    panel.height_px = 260.0;
    let markers = [Marker::Circle, Marker::Cross, Marker::Square, Marker::Triangle];
    let mut rows = Vec::new();
    for (data, marker) in data.iter().zip(markers) {
        let fits = study
            .sweep(&counts, 0, |&modes| Ok(FitRow::new(data, "N = 40", modes, &BeamFit::new(data, modes)?.fit)))?;
        let n: Vec<f64> = fits.iter().map(|row| row.modes as f64).collect();
        let rms: Vec<f64> = fits.iter().map(|row| row.rms).collect();
        panel = panel.with(Series::line_points(&n, &rms, marker).label(data.beam.title.clone()));
        let at = |modes: usize| fits.iter().find(|row| row.modes == modes).map_or(f64::NAN, |row| row.rms);
        study.state(Comparison::range(
            format!("change of the rms error from N = 40 to N = 50, {}", data.beam.name),
            "7.2",
            "results do not change much between N = 40 and 50",
            (0.0, 0.01),
            (at(50) - at(40)).abs(),
        ));
        let late = fits.iter().filter(|row| row.modes >= 40).map(|row| row.rms);
        let (low, high) = late.fold((f64::INFINITY, 0.0f64), |(l, h), rms| (l.min(rms), h.max(rms)));
        study.state(
            Comparison::range(
                format!("change of the rms error from N = 40 on, {}", data.beam.name),
                "Fig. 7.7",
                "the difference beyond N = 40 is small",
                (0.0, 0.01),
                high - low,
            )
            .note("Up to N = 100. The thesis's figure gives no scale in the text; 0.01 is our reading of small."),
        );
        rows.extend(fits);
    }
    panel = panel.with(Series::vertical_rule(LAW_MODES as f64).colour(Colour::Grey));
    study.figure(
        "fig-7-07",
        &Figure::new("Fig. 7.7  Error of the fit against the number of modes").row([panel]).width(760.0),
        "Tables with N = 40. The rule marks N = 50, used everywhere else.",
    )?;
    study.csv("fig-7-07.csv", &rows)
}
