//! Every chapter in one run, ending in one report that can be checked number by number.

use super::{CHAPTERS, Failure, Finished, run};
use serde::Serialize;
use std::path::Path;
use std::time::Instant;
use vibroimpact::report::{Comparison, Report, Verdict, write_whole};

const INTRODUCTION: &str = "Every number and every claim of the thesis's text that can be computed, beside ours, chapter \
by chapter. A printed number is given half a unit of its last digit; a number in words, the tolerance that the words \
allow. The figures are in the chapters' own reports.";

/// One statement in `statements.csv`; numbers in the unit that the quantity names.
#[derive(Serialize)]
struct Row<'a> {
    chapter: u32,
    quantity: &'a str,
    source: &'a str,
    stated: &'a str,
    ours: f64,
    difference: f64,
    agrees: bool,
}

/// Runs all chapters, each into its own folder under `out`, and writes `report.md`, `report.html` and `statements.csv`
/// beside them. Returns a summary in a few lines.
pub fn run_all(out: &Path, quick: bool, data: Option<&Path>) -> Result<String, Failure> {
    let started = Instant::now();
    let mut finished = Vec::new();
    for chapter in CHAPTERS {
        let data = data.filter(|_| chapter == 8);
        finished.push((chapter, run(chapter, &out.join(format!("chapter-{chapter}")), quick, data)?));
    }
    report(&finished, quick).write(out)?;
    write_whole(&out.join("statements.csv"), &table(&finished)?)?;

    let count = |verdict: fn(&Finished) -> usize| finished.iter().map(|(_, chapter)| verdict(chapter)).sum::<usize>();
    let mut summary = String::new();
    for (chapter, found) in &finished {
        let (agree, all, impacts) = (agreeing(found), found.statements.len(), found.impacts);
        summary += &format!("chapter {chapter}: {agree:>3} of {all:>3} statements agree, {impacts:>6} impacts\n");
    }
    Ok(format!(
        "{summary}all:       {:>3} of {:>3} statements agree, {:>6} impacts in {:.1} s with all files\nReport: {}",
        count(agreeing),
        count(|found| found.statements.len()),
        count(|found| found.impacts),
        started.elapsed().as_secs_f64(),
        out.join("report.html").display()
    ))
}

fn agreeing(found: &Finished) -> usize {
    found.statements.iter().filter(|statement| statement.verdict() == Verdict::Agrees).count()
}

fn report(finished: &[(u32, Finished)], quick: bool) -> Report {
    let mut report = Report::new("The thesis, number by number");
    report.text(INTRODUCTION);
    if quick {
        report.text("**This is the quick form, with fewer points.**");
    }
    let rows: Vec<Vec<String>> = finished
        .iter()
        .map(|(chapter, found)| {
            let all = found.statements.len();
            vec![
                format!("[chapter {chapter}](chapter-{chapter}/report.html)"),
                all.to_string(),
                agreeing(found).to_string(),
                (all - agreeing(found)).to_string(),
            ]
        })
        .collect();
    report.table(&["chapter", "statements", "agree", "differ"], &rows);

    report.heading("Where we differ");
    let differ = |found: &Finished| -> Vec<Comparison> {
        found.statements.iter().filter(|statement| statement.verdict() == Verdict::Differs).cloned().collect()
    };
    let all: Vec<Comparison> = finished.iter().flat_map(|(_, found)| differ(found)).collect();
    report.comparisons(&all);
    for (_, found) in finished {
        report.heading(&found.title);
        report.comparisons(&found.statements);
    }
    report
}

fn table(finished: &[(u32, Finished)]) -> Result<Vec<u8>, Failure> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for (chapter, found) in finished {
        for statement in &found.statements {
            writer.serialize(Row {
                chapter: *chapter,
                quantity: &statement.quantity,
                source: &statement.source,
                stated: &statement.stated,
                ours: statement.ours,
                difference: statement.difference(),
                agrees: statement.verdict() == Verdict::Agrees,
            })?;
        }
    }
    Ok(writer.into_inner()?)
}
