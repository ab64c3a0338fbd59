//! Runs all chapters and writes one report that can be checked number by number.

use super::statement::{Kind, Verdict};
use super::study::Finished;
use super::tally::{Row, Tally, csv, tell};
use super::{Part, chapter8, run};
use std::path::Path;
use std::time::Instant;
use tasks::Failure;
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use vibroimpact::report::{Report, write_whole};

const INTRODUCTION: &str = "This report compares every number and every claim of the thesis's text that can be \
computed with our result, chapter by chapter. The tolerance of a printed number is half a unit of its last digit. A \
number in words and a trend have a tolerance with its reason. There are four verdicts: our number agrees; it differs; \
it is indecisive, because the limit lies within its uncertainty or because the words can be read either way; or the \
text does not suffice to decide, because the verdict depends on information that it does not contain. Identities and \
self-checks are listed but not counted. The main figures of every chapter follow its statements; the reports of the \
chapters have all figures.";

/// Runs all chapters, each into its own folder under `out`, and writes `report.md`, `report.html` and `statements.csv`
/// beside them. Returns a summary in a few lines.
pub fn run_all(out: &Path, quick: bool, data: Option<&Path>) -> Result<String, Failure> {
    // chapter 8 is among the last, and a mistake in the user's file would show only after all the others
    data.map(chapter8::points).transpose()?;
    let started = Instant::now();
    let mut finished = Vec::new();
    for part in Part::ALL {
        let data = data.filter(|_| part == Part::Chapter(8));
        let folder = part.folder();
        let found = run(part, &out.join(&folder), quick, data)?;
        finished.push((folder, found));
    }
    report(&finished, quick)?.write(out)?;
    let rows: Vec<Row> = finished.iter().flat_map(|(_, found)| found.rows()).collect();
    write_whole(&out.join("statements.csv"), &csv(&rows)?)?;

    let mut summary = String::new();
    for (folder, found) in &finished {
        summary += &format!("{folder}: {} impacts. {}\n", found.study.impacts, Tally::of(&found.rows()).headline());
    }
    Ok(format!(
        "{summary}all: {} impacts in {:.1} s with all files. {}\nReport: {}",
        finished.iter().map(|(_, found)| found.study.impacts).sum::<usize>(),
        started.elapsed().as_secs_f64(),
        Tally::of(&rows).headline(),
        out.join("report.html").display()
    ))
}

/// Larger deviations are drawn at the edge of the figure.
const EDGE: f64 = 12.0;

/// Plots the deviation of our value from every number of the text, in units of its tolerance.
fn deviations(finished: &[(String, Finished)]) -> Figure {
    let statements = finished.iter().flat_map(|(_, found)| &found.study.stated);
    let all: Vec<(Kind, f64, Verdict)> =
        statements.filter_map(|one| Some((one.kind, one.deviation()?, one.verdict()))).collect();
    let x = Axis::new("printed number, in the order of the chapters").integers();
    let y = Axis::new("(ours − thesis) / tolerance").limits(-1.05 * EDGE, 1.05 * EDGE);
    let mut panel = Panel::new(x, y).height(240.0);
    for limit in [-1.0, 1.0] {
        panel = panel.with(Series::horizontal_rule(limit));
    }
    for (kind, verdict, marker, colour) in [
        (Kind::PrintedNumber, Verdict::Agrees, Marker::Circle, Colour::Blue),
        (Kind::PrintedNumber, Verdict::Differs, Marker::Circle, Colour::Vermilion),
        (Kind::LooseNumber, Verdict::Agrees, Marker::Cross, Colour::Blue),
        (Kind::LooseNumber, Verdict::Differs, Marker::Cross, Colour::Vermilion),
    ] {
        let of = all.iter().enumerate().filter(|(_, one)| (one.0, one.2) == (kind, verdict));
        let (x, y): (Vec<f64>, Vec<f64>) = of.map(|(i, one)| ((i + 1) as f64, one.1.clamp(-EDGE, EDGE))).unzip();
        let label = format!("{}: {}", kind.title().to_lowercase(), verdict.marked());
        panel = panel.with(Series::points(&x, &y, marker).colour(colour).label(label));
    }
    Figure::new("Our numbers minus those of the thesis, in units of the tolerance").row([panel])
}

fn report(finished: &[(String, Finished)], quick: bool) -> Result<Report, Failure> {
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
    report.figure(
        "deviations",
        &deviations(finished),
        "Between the two lines our number agrees. The tolerance of a printed number is half a unit of its last digit. \
         Differences of more than 12 tolerances are drawn at the edge.",
    )?;
    for (heading, verdict) in [
        ("Where we differ", Verdict::Differs),
        ("Statements on which our numbers are indecisive", Verdict::Indecisive),
        ("Statements that cannot be decided from the text", Verdict::Undecidable),
    ] {
        let chosen: Vec<Row> = rows.iter().filter(|row| row.verdict == verdict).cloned().collect();
        if !chosen.is_empty() {
            report.heading(heading);
            tell(&mut report, &chosen);
        }
    }
    for (_, found) in finished {
        report.heading(&found.study.title);
        tell(&mut report, &found.rows());
        report.append(found.study.shown.clone());
    }
    Ok(report)
}

#[cfg(test)]
mod tests {
    use super::super::statement::Statement;
    use super::super::study::{Study, finish};
    use super::*;

    fn found(folder: &Path, ours: f64) -> Vec<(String, Finished)> {
        let mut study = Study::new(folder, true).unwrap().part_of_a_larger_one("chapter 2");
        study.state(Statement::printed("S", "2.5", "1.56", ours));
        study.state(Statement::trend("a rise", "2.5", "it rises", (0.0, 1.0), "any amount", 0.5).missing("the scale"));
        study.state(Statement::identity("energy", ["2.1", "kept", "rounding"], (0.0, 1e-9), 0.0));
        let line = Figure::new("Main").row([Panel::new(Axis::new("x"), Axis::new("y"))]);
        study.main_figure("fig-2-08", &line, "A main figure.").unwrap();
        vec![("chapter-2".to_owned(), finish(study, 2, "Chapter 2", "").unwrap())]
    }

    #[test]
    fn one_report_has_headline_verdicts_reasons_and_main_figures() {
        let folder = tempfile::tempdir().unwrap();
        let text = report(&found(folder.path(), 1.5605), false).unwrap().markdown();
        for part in [
            "Printed numbers (1): 1 agrees. Trends (1): 1 cannot be decided from the text. Not counted",
            "| S | 2.5 | 1.56 | 1.5605 | ± 0.005 | half a unit of the last digit | ✓ agrees |",
            "figures/deviations.svg",
            "figures/chapter-2-fig-2-08.svg",
            "## Statements that cannot be decided from the text",
        ] {
            assert!(text.contains(part), "{part} is not in {text}");
        }
        assert!(!text.contains("## Where we differ"));
        // a wrong number changes its row, the sections and the headline
        let text = report(&found(folder.path(), 1.566), false).unwrap().markdown();
        assert!(text.contains("## Where we differ") && text.contains("Printed numbers (1): 1 differs."));
    }
}
