//! The fits of section 7.2, and the error against the number of modes (Fig. 7.7).

use super::{Dataset, LAW_MODES};
use crate::chapters::statement::Statement;
use crate::chapters::study::Study;
use emoc::{Impact, Site};
use fitting::Fit;
use serde::Serialize;
use std::time::Instant;
use tasks::Failure;
use vibroimpact::net::{self, Observations};
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use vibroimpact::report::significant;

/// The fit of one beam with its data.
pub(in crate::chapters) struct BeamFit {
    pub observations: Observations,
    pub fit: Fit,
}

impl BeamFit {
    pub fn new(data: &Dataset, modes: usize) -> Result<BeamFit, Failure> {
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

/// Fits the law to both tables of every beam. Returns the fits to the tables with 40 modes, which took `resolved_s` to compute.
pub(super) fn run(
    study: &mut Study,
    truncated: &[Dataset],
    settled: &[Dataset],
    resolved_s: f64,
) -> Result<Vec<BeamFit>, Failure> {
    study.section("Three parameters per beam (section 7.2)");
    let (mut rows, mut cells, mut fits) = (Vec::new(), Vec::new(), Vec::new());
    let start = Instant::now();
    for (tables, name) in [(truncated, "N = 40"), (settled, "converged")] {
        for data in tables {
            let found = BeamFit::new(data, LAW_MODES)?;
            let row = FitRow::new(data, name, LAW_MODES, &found.fit);
            cells.push(row.cells(&data.beam.title, &with_intervals(&found.fit)?));
            rows.push(row);
            fits.push(found);
        }
    }
    let seconds = start.elapsed().as_secs_f64();
    quicker(study, &rows, seconds, resolved_s / truncated.iter().map(|data| data.rows.len()).sum::<usize>() as f64);
    let seconds = seconds / fits.len() as f64;
    study.remark(format!(
        "A fit of the law to the table of a beam takes {:.0} ms with all its {} searches. In the thesis a fit took \
         about ten minutes, and a resolved table ten hours.",
        1e3 * seconds,
        rows[0].starts
    ));
    study.table(
        &["beam", "table", "μ₀", "α₀", "α₁", "rms", "largest", "starts at the minimum", "rms of the worst start"],
        &cells,
    );
    study.text(
        "The table has the parameters with 95 % intervals, and the root-mean-square and the largest difference of law \
         and table. The intervals assume independent errors and are too narrow here. The sum of squares has several \
         minima, and only some starting points lead to the least one. A single search, as the thesis describes it, can \
         end at the error in the last column.",
    );
    study.csv("fits.csv", &rows)?;
    fits.truncate(truncated.len());
    let a_start = rows.iter().take(truncated.len()).map(|row| row.evaluations as f64 / row.starts as f64);
    study.state(
        Statement::loose(
            "evaluations of the sum of squares per search, mean over the beams",
            "7.2",
            "100 to 200 function evaluations",
            (150.0, 50.0),
            "as stated",
            a_start.sum::<f64>() / truncated.len() as f64,
        )
        .missing(
            "which search of fminunc was used, and whether with differences for derivatives; ours is another method",
        ),
    );
    for (data, found) in truncated.iter().zip(&fits) {
        held_ends(study, data, found);
    }
    against_z(study, truncated, &fits)?;
    Ok(fits)
}

/// Chapter 1: how much faster the law is than resolving an impact in time, which takes `resolved_s`. Measured times differ
/// from run to run, so that at most three orders of magnitude are counted.
fn quicker(study: &mut Study, rows: &[FitRow], fits_s: f64, resolved_s: f64) {
    const COUNTED: f64 = 3.0;
    let evaluated: usize = rows.iter().map(|row| row.evaluations * row.count).sum();
    let powers = (resolved_s / (fits_s / evaluated as f64)).log10().floor();
    study.state(Statement::trend(
        "orders of magnitude by which the law is faster than resolving an impact in time, counted up to 3",
        "1, 7.2",
        "algebraic, comparatively much quicker: ten minutes for a fit, ten hours for a table",
        (1.0, f64::INFINITY),
        "ten times",
        powers.min(COUNTED),
    ));
}

/// Section 7.1: restitution against Z, and the function that approximates it.
fn against_z(study: &mut Study, data: &[Dataset], fits: &[BeamFit]) -> Result<(), Failure> {
    const PARTS: usize = 10;
    let mut pairs: Vec<(f64, f64)> = data
        .iter()
        .zip(fits)
        .flat_map(|(data, found)| found.observations.impacts.iter().zip(&data.rows).map(|(i, row)| (i.z, row.e())))
        .collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mean = |k: usize| {
        let part = &pairs[k * pairs.len() / PARTS..(k + 1) * pairs.len() / PARTS];
        part.iter().map(|(_, e)| e).sum::<f64>() / part.len() as f64
    };
    let means: Vec<f64> = (0..PARTS).map(mean).collect();
    let least = means.iter().copied().fold(f64::INFINITY, f64::min);
    let told = means.iter().map(|mean| significant(*mean, 2)).collect::<Vec<_>>().join(", ");
    for (quantity, words, end) in [
        (
            "smallest tenth of Z",
            "for small Z, v_f is relatively high (closer to unity); for intermediate Z, low",
            means[0],
        ),
        ("largest tenth of Z", "for large Z, v_f is high again", means[PARTS - 1]),
    ] {
        let quantity = format!("mean e over the {quantity} minus the least of all tenths, four beams");
        let reason = "a tenth of the range from 0 to 1";
        let statement = Statement::trend(quantity, "7.1, item 4", words, (0.1, 1.0), reason, end - least);
        study.state(statement.open((0.0, 1.0)).note(format!("Means by tenths of Z: {told}.")));
    }
    let guessed = net::law(&[1.0; 3]);
    let site = Site::new(&[1.0])?;
    let (mut value, mut place) = (f64::INFINITY, 0.0);
    for k in 0..=4000 {
        let z = 10f64.powf(-4.0 + f64::from(k) / 500.0);
        let ebar = guessed.coefficients(&Impact::new(z, &site)?)?.ebar;
        if ebar < value {
            (value, place) = (ebar, z);
        }
    }
    for (quantity, words, limits, ours) in [
        ("minimum of ē over e", "a minimum of 2/3", (2.0 / 3.0 - 1e-9, 2.0 / 3.0 + 1e-9), value),
        ("μ₀ Z at the minimum of ē over e", "at Z = 1/μ₀", (0.995, 1.005), place),
    ] {
        study.state(Statement::identity(
            quantity,
            ["7.1, Eq. 7.4", words, "a grid of 500 points a decade"],
            limits,
            ours,
        ));
    }
    Ok(())
}

/// Section 7.2: perfect rebound at held ends.
fn held_ends(study: &mut Study, data: &Dataset, found: &BeamFit) {
    let name = &data.beam.name;
    let length = data.beam.model.beam.length_m();
    let [held_left, held_right] = data.beam.model.beam.ends.map(|end| end != beam_modes::End::Free);
    let at_held = |place: f64| (held_left && place == 0.0) || (held_right && place == length);
    let predicted = data.rows.iter().zip(&found.fit.residuals).map(|(row, residual)| (row, residual + row.e()));
    let least = predicted.filter(|(row, _)| at_held(row.location_m)).map(|(_, e)| e);
    study.state(Statement::identity(
        format!("least e of the law at the held ends, {name}"),
        ["7.2", "at fixed or pinned ends, rebound is perfect, and captured", "rounding; no mode moves there"],
        (0.999_999, 1.0),
        least.fold(1.0, f64::min),
    ));
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
        let range = |least: usize| {
            let chosen = fits.iter().filter(|row| row.modes >= least).map(|row| row.rms);
            let (low, high) = chosen.fold((f64::INFINITY, 0.0f64), |(l, h), rms| (l.min(rms), h.max(rms)));
            (high - low, high)
        };
        let ((late, _), (whole, highest)) = (range(40), range(1));
        study.state(
            Statement::trend(
                format!("range of the rms error from N = 40 on over its range from N = 1 on, {}", data.beam.name),
                "Fig. 7.7",
                "the difference beyond N = 40 is small",
                (0.0, 0.1),
                "a tenth of the figure's height",
                late / whole,
            )
            .note(format!(
                "From {} down to {}; beyond N = 40, up to N = 100, it varies by {}.",
                significant(highest, 2),
                significant(highest - whole, 2),
                significant(late, 3)
            )),
        );
        rows.extend(fits);
    }
    panel = panel.with(
        Series::vertical_rule(LAW_MODES as f64)
            .colour(Colour::Grey)
            .label(format!("N = {LAW_MODES}, as in the thesis")),
    );
    study.main_figure(
        "fig-7-07",
        &Figure::new("Fig. 7.7  Error of the fit against the number of modes").row([panel]).width(760.0),
        "The tables have N = 40. The vertical line marks N = 50, which is used everywhere else.",
    )?;
    study.csv("fig-7-07.csv", &rows)
}
