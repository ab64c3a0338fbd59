//! The report on a run.

use std::io;

use super::AssemblyScene;
use super::summary::Summary;
use super::text::{
    CONTACT, INTERVAL, contact_rows, energy_rows, first_intervals, interval_cells, outcome, reliability,
};
use crate::plot::Figure;
use crate::report::{Report, literal, trusted};
use crate::text::quantity;

/// Intervals that are listed.
const LISTED: usize = 100;

/// The report on a scene of bodies: result, picture, contacts, energy, the scene.
///
/// # Errors
/// Those of the figure.
pub fn report(headline: &str, scene: &AssemblyScene, summary: &Summary, figure: &Figure) -> io::Result<Report> {
    let mut report = Report::new(headline);
    if let Some(description) = &scene.description {
        report.text(&literal(description));
    }
    let mut rows = vec![vec!["outcome".to_owned(), outcome(summary)]];
    if let Some(reliable) = reliability(summary) {
        rows.push(vec!["touches and releases are certain until".to_owned(), reliable]);
    }
    if summary.statistics_from_s > 0.0 {
        rows.push(vec!["statistics from".to_owned(), quantity(summary.statistics_from_s, "s")]);
    }
    report.table(&["result", ""], &rows);
    report.figure("run", figure, "Gaps and forces over time (grey: in contact), with their statistics.")?;
    report.heading("Contacts");
    report.table(&CONTACT, &contact_rows(summary));
    report.heading("Energy");
    report.table(&["where", "energy"], &energy_rows(summary).into_iter().map(Vec::from).collect::<Vec<_>>());
    report.heading("Intervals of contact");
    let listed = first_intervals(summary, LISTED);
    let rows: Vec<Vec<String>> = listed.iter().map(|(name, interval)| interval_cells(name, interval).into()).collect();
    report.table(&INTERVAL, &rows);
    let all = summary.interval_count();
    if all > rows.len() as u64 {
        report.text(&format!("... and {} more.", all - rows.len() as u64));
    }
    trusted(&mut report, &summary.trust);
    report.heading("The scene");
    report.code(&scene.to_json());
    report.heading("How to repeat this");
    report
        .text(&format!("With vibroimpact {}, save the scene above as `scene.json` and run", env!("CARGO_PKG_VERSION")));
    report.code("vibroimpact simulate scene.json");
    Ok(report)
}
