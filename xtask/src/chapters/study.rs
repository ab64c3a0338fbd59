//! Tools of all chapters: output folder, progress, parallel sweeps and one writer of files.

use super::figures::Course;
use super::statement::Statement;
use super::tally::{Row, Tally, tell};
use crate::failure::Failure;
use crate::progress::Progress;
use rayon::prelude::*;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Instant;
use vibroimpact::plot::Figure;
use vibroimpact::report::{Comparison, Report, write_whole};

/// The list of files, written last.
const MANIFEST: &str = "manifest.json";

/// A chapter that is being computed.
pub(super) struct Study {
    out: PathBuf,
    /// Whether to take fewer points.
    pub quick: bool,
    chapter: u32,
    body: Report,
    /// The figures that also appear in the report of all chapters.
    shown: Report,
    statements: Vec<Statement>,
    /// Targets of a study that is not part of the thesis, with their heading.
    targets: Option<(&'static str, Vec<Comparison>)>,
    files: Vec<String>,
    timings: Vec<Timing>,
    remarks: Vec<String>,
    started: Instant,
    progress: Progress,
}

/// Results of a finished chapter, for the summary.
#[derive(Debug)]
pub struct Finished {
    /// Title of its report.
    pub title: String,
    chapter: u32,
    /// The thesis's statements beside our numbers.
    pub statements: Vec<Statement>,
    /// The figures for the report of all chapters.
    pub shown: Report,
    /// Number of impacts solved.
    pub impacts: usize,
    /// Impacts, time, agreement and the path of the report, in a few lines.
    pub summary: String,
}

impl Finished {
    /// The statements as rows of `statements.csv`.
    pub fn rows(&self) -> Vec<Row> {
        rows(self.chapter, &self.statements)
    }
}

fn rows(chapter: u32, statements: &[Statement]) -> Vec<Row> {
    statements.iter().map(|statement| Row::new(chapter, statement)).collect()
}

/// Cost of one section.
#[derive(Serialize)]
struct Timing {
    section: String,
    impacts: usize,
    seconds: f64,
}

/// Contents of a finished folder.
#[derive(Serialize)]
struct Manifest<'a> {
    title: &'a str,
    version: &'static str,
    quick: bool,
    files: &'a [String],
}

impl Study {
    /// Begins the study of a chapter's statements, which will write into `out`. The manifest of an earlier run is removed, so that
    /// a folder with a manifest is always complete.
    pub fn new(chapter: u32, out: &Path, quick: bool) -> Result<Study, Failure> {
        match std::fs::remove_file(out.join(MANIFEST)) {
            Err(failure) if failure.kind() != std::io::ErrorKind::NotFound => return Err(failure.into()),
            _ => {}
        }
        Ok(Study {
            out: out.into(),
            quick,
            chapter,
            body: Report::new(""),
            shown: Report::new(""),
            statements: Vec::new(),
            targets: None,
            files: Vec::new(),
            timings: Vec::new(),
            remarks: Vec::new(),
            started: Instant::now(),
            progress: Progress::of("impacts"),
        })
    }

    /// Sets the heading of a list of our own targets, which replaces the statements of the thesis.
    pub fn claims(&mut self, heading: &'static str) {
        self.targets = Some((heading, Vec::new()));
    }

    /// Begins a section of the report.
    pub fn section(&mut self, title: &str) {
        self.body.heading(title);
        self.timings.push(Timing { section: title.into(), impacts: 0, seconds: self.started.elapsed().as_secs_f64() });
    }

    /// Does `job` for each case on all cores; results come in the order of the cases, whatever
    /// the number of threads. `impacts` is what one case counts for in the progress.
    pub fn sweep<C: Sync, R: Send>(
        &mut self,
        cases: &[C],
        impacts: usize,
        job: impl Fn(&C) -> Result<R, Failure> + Sync,
    ) -> Result<Vec<R>, Failure> {
        let count = cases.len() * impacts;
        let chapter = if self.chapter > 0 { format!("chapter {}, ", self.chapter) } else { String::new() };
        let section = self.timings.last().map_or("", |timing| &timing.section);
        self.progress.begin(format!("{chapter}{section}"), count as u64, 0);
        if let Some(timing) = self.timings.last_mut() {
            timing.impacts += count;
        }
        let each = |case| {
            let result = job(case);
            self.progress.add(impacts as u64);
            result
        };
        cases.par_iter().map(each).collect()
    }

    /// All points of a list, or in a quick run the first, the last and a few in between.
    pub fn thin<T: Clone>(&self, all: &[T], quick_count: usize) -> Vec<T> {
        if !self.quick || all.len() <= quick_count {
            return all.to_vec();
        }
        let last = quick_count.saturating_sub(1).max(1);
        (0..quick_count).map(|i| all[i * (all.len() - 1) / last].clone()).collect()
    }

    /// Writes a table; the columns are the fields of the rows.
    pub fn csv<R: Serialize>(&mut self, name: &str, rows: &[R]) -> Result<(), Failure> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        for row in rows {
            writer.serialize(row)?;
        }
        let bytes = writer.into_inner()?;
        self.file(name, &bytes)
    }

    /// Adds a figure with its caption.
    pub fn figure(&mut self, name: &str, figure: &Figure, caption: &str) -> Result<(), Failure> {
        Ok(self.body.figure(name, figure, caption)?)
    }

    /// Adds a figure that also appears in the report of all chapters.
    pub fn main_figure(&mut self, name: &str, figure: &Figure, caption: &str) -> Result<(), Failure> {
        self.shown.figure(&format!("chapter-{}-{name}", self.chapter), figure, caption)?;
        self.figure(name, figure, caption)
    }

    /// Adds a paragraph of Markdown.
    pub fn text(&mut self, markdown: &str) {
        self.body.text(markdown);
    }

    /// Adds a table to the report.
    pub fn table(&mut self, headers: &[&str], rows: &[Vec<String>]) {
        self.body.table(headers, rows);
    }

    /// Adds a table to the report and also writes the formatted table as a file, for pages of the book.
    pub fn tabled(&mut self, name: &str, headers: &[&str], rows: &[Vec<String>]) -> Result<(), Failure> {
        self.table(headers, rows);
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(headers)?;
        for row in rows {
            writer.write_record(row)?;
        }
        let bytes = writer.into_inner()?;
        self.file(&format!("{name}.csv"), &bytes)
    }

    /// Adds a statement of the thesis to the list at the start of the report.
    pub fn claim(&mut self, statement: Statement) {
        self.statements.push(statement);
    }

    /// Adds a target of our own to the list at the start of the report.
    pub fn state(&mut self, target: Comparison) {
        self.targets.get_or_insert(("Targets", Vec::new())).1.push(target);
    }

    /// Writes the motion of an impact.
    pub fn course(&mut self, name: &str, course: &Course) -> Result<(), Failure> {
        self.csv(name, &course.rows())
    }

    /// Writes a figure outside the report, because it differs from run to run.
    pub fn aside(&mut self, name: &str, figure: &Figure) -> Result<(), Failure> {
        self.file(name, figure.svg()?.as_bytes())
    }

    /// Adds a line to the final summary, for values that differ from run to run.
    pub fn remark(&mut self, line: String) {
        self.remarks.push(line);
    }

    fn file(&mut self, name: &str, bytes: &[u8]) -> Result<(), Failure> {
        write_whole(&self.out.join(name), bytes)?;
        self.files.push(name.into());
        Ok(())
    }

    /// Writes report, timings and manifest, and sums up. The manifest comes last: a folder with
    /// one is complete.
    pub fn finish(mut self, title: &str, introduction: &str) -> Result<Finished, Failure> {
        let total = self.started.elapsed().as_secs_f64();
        let ends: Vec<f64> = self.timings.iter().skip(1).map(|t| t.seconds).chain([total]).collect();
        for (timing, end) in self.timings.iter_mut().zip(ends) {
            timing.seconds = end - timing.seconds;
        }
        let timings = std::mem::take(&mut self.timings);
        let impacts: usize = timings.iter().map(|t| t.impacts).sum();

        let mut report = Report::new(title);
        report.text(introduction);
        if self.quick {
            report.text("**This is the quick form, with fewer points.**");
        }
        let rows = rows(self.chapter, &self.statements);
        let counted = match &self.targets {
            Some((heading, targets)) => {
                report.heading(heading);
                report.comparisons(targets);
                String::new()
            }
            None => {
                report.heading("What the thesis states, beside ours");
                tell(&mut report, &rows);
                format!("{}\n", Tally::of(&rows).headline())
            }
        };
        report.append(self.body.clone());
        for path in report.write(&self.out)? {
            let name = path.strip_prefix(&self.out).unwrap_or(&path);
            self.files.push(name.to_string_lossy().replace('\\', "/"));
        }
        let files = self.files.clone();
        let manifest = Manifest { title, version: env!("CARGO_PKG_VERSION"), quick: self.quick, files: &files };
        self.csv("timings.csv", &timings)?;
        self.file(MANIFEST, serde_json::to_string_pretty(&manifest)?.as_bytes())?;
        self.progress.finish();

        let summary = format!(
            "{title}: {impacts} impacts in {:.2} s, {:.2} s with all files.\n{}{counted}Report: {}",
            total,
            self.started.elapsed().as_secs_f64(),
            self.remarks.iter().map(|line| format!("{line}\n")).collect::<String>(),
            self.out.join("report.html").display()
        );
        let (chapter, statements, shown) = (self.chapter, self.statements, self.shown);
        Ok(Finished { title: title.to_owned(), chapter, statements, shown, impacts, summary })
    }
}

/// A figure's number as part of a file name that sorts: `3.5` becomes `3-05`.
pub(super) fn slug(figure: &str) -> String {
    match figure.split_once('.') {
        Some((chapter, number)) => format!("{}-{number:0>2}", chapter.to_lowercase()),
        None => figure.to_lowercase(),
    }
}
