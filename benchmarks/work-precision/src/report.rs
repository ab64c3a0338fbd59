//! The page: measurements, machine, references, and a comparison with the targets.

use crate::compare::{Standing, chief_norm, fastest, names, standing};
use crate::figures::{OVERVIEW, figure, overview};
use crate::measure::{Origin, Row};
use crate::{impact, infinite, notes};
use std::fmt::Write;
use vibroimpact::report::Report;

/// The targets are stated at this error of the restitution.
const ERROR: f64 = 1e-6;
/// Smallest error that is expected of a solver in double precision.
const ROUNDING: f64 = 1e-15;

/// The smallest meaningful error of a problem: that of the reference.
fn floor(problem: &str) -> f64 {
    let own = match problem {
        "beam-S15-story" => infinite::story_floor().ok(),
        _ => impact::reference(problem).ok().map(|reference| reference.restitution_error),
    };
    own.unwrap_or(0.0).max(ROUNDING)
}

/// A time in a suitable unit.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1e-6 => format!("{:.0} ns", s * 1e9),
        s if s < 1e-5 => format!("{:.2} µs", s * 1e6),
        s if s < 1e-3 => format!("{:.0} µs", s * 1e6),
        s if s < 1.0 => format!("{:.2} ms", s * 1e3),
        s => format!("{s:.2} s"),
    }
}

fn of<'a>(rows: &'a [Row], problem: &str) -> Vec<&'a Row> {
    rows.iter().filter(|row| row.problem == problem).collect()
}

/// A page and the figures that it links to.
#[derive(Debug)]
pub struct Page {
    /// The text.
    pub report: Report,
    /// Paths relative to the page, and SVG documents.
    pub figures: Vec<(String, String)>,
}

/// The page. `about` is the result of [`machine`](crate::machine::describe), `outside` the same for the solvers outside Rust.
///
/// # Errors
/// If a figure cannot be drawn.
pub fn report(rows: &[Row], about: &str, outside: Option<&str>) -> Result<Page, String> {
    let mut figures = Vec::new();
    let mut page = Report::new("Work and precision");
    page.text(notes::INTRODUCTION);
    page.text(&format!("`cargo xtask work-precision` makes this page. It was last run on:\n\n{about}"));
    if let Some(outside) = outside {
        page.text(&format!(
            "`benchmarks/peers.sh` measures the solvers outside Rust separately. It was last run on:\n\n{}",
            outside.trim()
        ));
    }
    let problems = names(rows.iter().map(|row| row.problem.as_str()));
    if problems.contains(&OVERVIEW) {
        let svg = overview(rows).svg().map_err(|error| error.to_string())?;
        figures.push(("figures/speed-and-error.svg".to_owned(), svg));
    }

    page.heading("Speed at equal error");
    page.text(notes::TARGETS);
    page.table(
        &[
            "impact",
            "ours",
            "tables kept",
            "fastest on the whole system",
            "ratio (target 50)",
            "fastest with exact flight",
            "ratio (target 5)",
        ],
        &problems.iter().filter_map(|problem| targets(rows, problem)).collect::<Vec<_>>(),
    );
    page.text(notes::EVERY_ERROR);
    let errors: Vec<f64> = (2..=10).map(|digits| 10f64.powi(-digits)).collect();
    let mut headers = vec!["problem".to_string()];
    headers.extend(errors.iter().map(|error| format!("{error:.0e}")));
    let headers: Vec<&str> = headers.iter().map(String::as_str).collect();
    let mut behind = String::new();
    let table: Vec<Vec<String>> = problems
        .iter()
        .map(|problem| {
            let rows = of(rows, problem);
            let (norm, floor) = (chief_norm(&rows), floor(problem));
            let cells = errors.iter().map(|&error| match standing(&rows, norm, floor, error) {
                Standing::Ratio(ratio, peer) => {
                    if ratio < 1.0 {
                        let _ =
                            writeln!(behind, "- {problem} at {error:.0e}: {peer} is {:.1} times faster", 1.0 / ratio);
                    }
                    if ratio < 10.0 { format!("{ratio:.1}") } else { format!("{ratio:.0}") }
                }
                Standing::Alone => "alone".into(),
                Standing::Behind(peer) => {
                    let _ = writeln!(behind, "- {problem} at {error:.0e}: only {peer} reaches it");
                    "not reached".into()
                }
                Standing::Nobody => "none".into(),
            });
            [problem.to_string()].into_iter().chain(cells).collect()
        })
        .collect();
    page.table(&headers, &table);
    page.text(if behind.is_empty() {
        "No peer is faster anywhere."
    } else {
        "Another solver is faster on these problems:"
    });
    page.text(&behind);
    page.text(notes::WHY);

    for problem in problems {
        let rows = of(rows, problem);
        page.heading(problem);
        page.text(&notes::about(problem));
        let picture = figure(problem, &rows, floor(problem));
        let units = names(rows.iter().map(|row| row.cost_unit.as_str())).join(" or ");
        let caption = format!("Error against time and against cost. The cost is the number of {units}.");
        let (name, text) = (format!("work-precision-{problem}"), |error: std::io::Error| error.to_string());
        page.figure(&name, &picture, &caption).map_err(text)?;
        figures.push((format!("figures/{name}.svg"), picture.svg().map_err(text)?));
        let failures: Vec<String> = rows
            .iter()
            .filter(|row| row.status != "ok")
            .map(|row| format!("{} at {}: {}", row.solver, setting(row.setting), row.status))
            .collect();
        if !failures.is_empty() {
            page.text(&format!("Runs without a result: {}.", failures.join("; ")));
        }
    }
    Ok(Page { report: page, figures })
}

/// A tolerance, or a number of steps, nodes or elements.
fn setting(value: f64) -> String {
    if value < 1.0 { format!("{value:.0e}") } else { value.to_string() }
}

/// The line of the table of targets, for an impact.
fn targets(rows: &[Row], problem: &str) -> Option<Vec<String>> {
    let floor = impact::reference(problem).ok()?.restitution_error.max(ROUNDING);
    let rows = of(rows, problem);
    let norm = chief_norm(&rows);
    let best = |chosen: &dyn Fn(&Row) -> bool| fastest(&rows, norm, floor, ERROR, chosen);
    let cold = best(&|row| row.solver == "vibroimpact");
    let kept = best(&|row| row.origin == Origin::Own && row.solver != "vibroimpact");
    let time = |found: Option<(&str, f64)>| found.map_or("not reached".into(), |(_, time)| duration(time));
    let against = |peer: Option<(&str, f64)>| match peer {
        Some((name, peer)) => {
            let ratio = |own: Option<(&str, f64)>| own.map_or("-".into(), |(_, own)| format!("{:.1}", peer / own));
            [format!("{name}, {}", duration(peer)), format!("{}; {} with tables kept", ratio(cold), ratio(kept))]
        }
        None => ["none reaches it".into(), "-".into()],
    };
    let whole = against(best(&|row| row.origin == Origin::Peer));
    let assisted = against(best(&|row| row.origin == Origin::Assisted));
    let cells = [problem.to_string(), time(cold), time(kept)].into_iter();
    Some(cells.chain(whole).chain(assisted).collect())
}
