//! Every chapter in one run, ending in one report that can be checked number by number.

use super::statement::{Kind, Verdict};
use super::tally::{Row, Tally, csv, tell};
use super::{Failure, Finished, Part, run};
use std::path::Path;
use std::time::Instant;
use vibroimpact::report::{Report, write_whole};

const INTRODUCTION: &str = "Every number and every claim of the thesis's text that can be computed, beside ours, chapter \
by chapter. A printed number is held to half a unit of its last digit. A number in words and a trend have a tolerance \
with its reason. A verdict is one of four: ours agrees; it differs; it is indecisive, because the limit lies within \
its own uncertainty or because the words can be read either way; or it cannot be decided from the text, because it \
depends on what the text does not print. Identities and self-checks are listed and not counted. The figures are in the \
chapters' own reports.";

/// Runs all chapters, each into its own folder under `out`, and writes `report.md`, `report.html` and `statements.csv`
/// beside them. Returns a summary in a few lines.
pub fn run_all(out: &Path, quick: bool, data: Option<&Path>) -> Result<String, Failure> {
    let started = Instant::now();
    let mut finished = Vec::new();
    for part in Part::ALL {
        let data = data.filter(|_| part == Part::Chapter(8));
        let folder = part.folder();
        let found = run(part, &out.join(&folder), quick, data)?;
        finished.push((folder, found));
    }
    report(&finished, quick).write(out)?;
    let rows: Vec<Row> = finished.iter().flat_map(|(_, found)| found.rows()).collect();
    write_whole(&out.join("statements.csv"), &csv(&rows)?)?;

    let mut summary = String::new();
    for (folder, found) in &finished {
        summary += &format!("{folder}: {} impacts. {}\n", found.impacts, Tally::of(&found.rows()).headline());
    }
    Ok(format!(
        "{summary}all: {} impacts in {:.1} s with all files. {}\nReport: {}",
        finished.iter().map(|(_, found)| found.impacts).sum::<usize>(),
        started.elapsed().as_secs_f64(),
        Tally::of(&rows).headline(),
        out.join("report.html").display()
    ))
}

fn report(finished: &[(String, Finished)], quick: bool) -> Report {
    let mut report = Report::new("The thesis, number by number");
    report.text(INTRODUCTION);
    if quick {
        report.text("**This is the quick form, with fewer points.**");
    }
    let rows: Vec<Row> = finished.iter().flat_map(|(_, found)| found.rows()).collect();
    report.text(&Tally::of(&rows).headline());
    let counted = |name: String, tally: Tally| -> Vec<String> {
        let kinds = Kind::ALL.into_iter().filter(|kind| kind.can_fail());
        let agreeing =
            kinds.clone().map(|kind| format!("{} of {}", tally.with(kind, Verdict::Agrees), tally.all(kind)));
        let others = Verdict::ALL.into_iter().skip(1);
        let others =
            others.map(|verdict| kinds.clone().map(|kind| tally.with(kind, verdict)).sum::<usize>().to_string());
        let uncounted =
            Kind::ALL.into_iter().filter(|kind| !kind.can_fail()).map(|kind| tally.all(kind)).sum::<usize>();
        [name].into_iter().chain(agreeing).chain(others).chain([uncounted.to_string()]).collect()
    };
    let mut lines: Vec<Vec<String>> = finished
        .iter()
        .map(|(folder, found)| counted(format!("[{folder}]({folder}/report.html)"), Tally::of(&found.rows())))
        .collect();
    lines.push(counted("all".to_owned(), Tally::of(&rows)));
    report.table(
        &[
            "chapter",
            "printed numbers that agree",
            "loose numbers",
            "trends",
            "differ",
            "indecisive",
            "cannot be decided",
            "identities and self-checks, not counted",
        ],
        &lines,
    );
    for (heading, verdict) in [
        ("Where we differ", Verdict::Differs),
        ("What our numbers do not decide", Verdict::Indecisive),
        ("What the text does not let anyone decide", Verdict::Undecidable),
    ] {
        let chosen: Vec<Row> = rows.iter().filter(|row| row.verdict == verdict).cloned().collect();
        if !chosen.is_empty() {
            report.heading(heading);
            tell(&mut report, &chosen);
        }
    }
    for (_, found) in finished {
        report.heading(&found.title);
        tell(&mut report, &found.rows());
    }
    report
}
