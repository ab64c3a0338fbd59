//! The study of a chapter: what it states are the thesis's statements beside our numbers.

use super::statement::Statement;
use super::tally::{Row, Tally, tell};
use tasks::Failure;
use vibroimpact::report::Report;

/// A chapter that is being computed.
pub(super) type Study = tasks::Study<Statement>;

/// Results of a finished chapter, for the summary.
#[derive(Debug)]
pub struct Finished {
    chapter: u32,
    /// The thesis's statements beside our numbers, figures, report and summary.
    pub study: tasks::Finished<Statement>,
}

impl Finished {
    /// The statements as rows of `statements.csv`.
    pub fn rows(&self) -> Vec<Row> {
        rows(self.chapter, &self.study.stated)
    }
}

fn rows(chapter: u32, statements: &[Statement]) -> Vec<Row> {
    statements.iter().map(|statement| Row::new(chapter, statement)).collect()
}

/// Writes the files of a chapter, and sums up.
pub(super) fn finish(study: Study, chapter: u32, title: &str, introduction: &str) -> Result<Finished, Failure> {
    let counted = |report: &mut Report, statements: &[Statement]| {
        let rows = rows(chapter, statements);
        report.heading("What the thesis states, beside ours");
        tell(report, &rows);
        format!("{}\n", Tally::of(&rows).headline())
    };
    Ok(Finished { chapter, study: study.finish(title, introduction, counted)? })
}
