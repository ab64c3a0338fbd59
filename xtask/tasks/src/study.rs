//! A study: its output folder, progress, parallel sweeps, and one writer of files.

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

/// A study that is being computed. `S` is what it states at the start of its report.
#[derive(Debug)]
pub struct Study<S = Comparison> {
    out: PathBuf,
    /// Whether to take fewer points.
    pub quick: bool,
    /// The part that it is of a larger study.
    part: Option<String>,
    body: Report,
    /// The figures that also appear in the report of the larger study.
    shown: Report,
    stated: Vec<S>,
    files: Vec<String>,
    timings: Vec<Timing>,
    remarks: Vec<String>,
    started: Instant,
    progress: Progress,
}

/// Results of a finished study.
#[derive(Debug)]
pub struct Finished<S> {
    /// Title of its report.
    pub title: String,
    /// What it states.
    pub stated: Vec<S>,
    /// The figures for the report of the larger study.
    pub shown: Report,
    /// Number of impacts solved.
    pub impacts: usize,
    /// Impacts, time, agreement and the path of the report, in a few lines.
    pub summary: String,
}

/// Cost of one section.
#[derive(Debug, Serialize)]
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

/// Writes the targets of a study into its report. They add nothing to its summary.
pub fn targets(report: &mut Report, stated: &[Comparison]) -> String {
    report.heading("Targets, and what was found");
    report.comparisons(stated);
    String::new()
}

impl<S> Study<S> {
    /// Begins a study that will write into `out`, which is created now, since a folder that cannot be written would otherwise show only
    /// after the computation. The manifest of an earlier run is removed, so that a folder with a manifest is always complete.
    ///
    /// # Errors
    /// If the folder cannot be created, or that manifest cannot be removed.
    pub fn new(out: &Path, quick: bool) -> Result<Study<S>, Failure> {
        std::fs::create_dir_all(out).map_err(|failure| unwritten(out, &failure))?;
        let manifest = out.join(MANIFEST);
        match std::fs::remove_file(&manifest) {
            Err(failure) if failure.kind() != std::io::ErrorKind::NotFound => {
                return Err(unwritten(&manifest, &failure));
            }
            _ => {}
        }
        Ok(Study {
            out: out.into(),
            quick,
            part: None,
            body: Report::new(""),
            shown: Report::new(""),
            stated: Vec::new(),
            files: Vec::new(),
            timings: Vec::new(),
            remarks: Vec::new(),
            started: Instant::now(),
            progress: Progress::of("impacts"),
        })
    }

    /// Names the part of a larger study that this one is, such as `chapter 3`.
    pub fn part_of_a_larger_one(self, name: impl Into<String>) -> Study<S> {
        Study { part: Some(name.into()), ..self }
    }

    /// Begins a section of the report.
    pub fn section(&mut self, title: &str) {
        self.body.heading(title);
        self.timings.push(Timing { section: title.into(), impacts: 0, seconds: self.started.elapsed().as_secs_f64() });
    }

    /// Does `job` for each case on all cores; results come in the order of the cases, whatever
    /// the number of threads. `impacts` is what one case counts for in the progress.
    ///
    /// # Errors
    /// The first error of `job`.
    pub fn sweep<C: Sync, R: Send>(
        &mut self,
        cases: &[C],
        impacts: usize,
        job: impl Fn(&C) -> Result<R, Failure> + Sync,
    ) -> Result<Vec<R>, Failure> {
        let mut all = Vec::with_capacity(cases.len());
        self.sweep_in_batches(cases, (cases.len().max(1), impacts), job, |results| {
            all = results;
            Ok(())
        })?;
        Ok(all)
    }

    /// The same in batches of so many cases, each of which is saved before the next one begins.
    ///
    /// # Errors
    /// The first error of `job` or of `save`.
    pub fn sweep_in_batches<C: Sync, R: Send>(
        &mut self,
        cases: &[C],
        (batch, impacts): (usize, usize),
        job: impl Fn(&C) -> Result<R, Failure> + Sync,
        mut save: impl FnMut(Vec<R>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let count = cases.len() * impacts;
        let part = self.part.as_ref().map_or_else(String::new, |part| format!("{part}, "));
        let section = self.timings.last().map_or("", |timing| &timing.section);
        self.progress.begin(format!("{part}{section}"), count as u64, 0);
        if let Some(timing) = self.timings.last_mut() {
            timing.impacts += count;
        }
        let each = |case| {
            let result = job(case);
            self.progress.add(impacts as u64);
            result
        };
        for batch in cases.chunks(batch) {
            save(batch.par_iter().map(each).collect::<Result<Vec<R>, Failure>>()?)?;
        }
        Ok(())
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
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn csv<R: Serialize>(&mut self, name: &str, rows: &[R]) -> Result<(), Failure> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        for row in rows {
            writer.serialize(row)?;
        }
        let bytes = writer.into_inner()?;
        self.file(name, &bytes)
    }

    /// Adds a figure with its caption.
    ///
    /// # Errors
    /// If the figure cannot be drawn.
    pub fn figure(&mut self, name: &str, figure: &Figure, caption: &str) -> Result<(), Failure> {
        Ok(self.body.figure(name, figure, caption)?)
    }

    /// Adds a figure that also appears in the report of the larger study, where the name of this part precedes its own.
    ///
    /// # Errors
    /// If the figure cannot be drawn.
    pub fn main_figure(&mut self, name: &str, figure: &Figure, caption: &str) -> Result<(), Failure> {
        let part = self.part.as_ref().map_or_else(String::new, |part| part.replace(' ', "-") + "-");
        self.shown.figure(&format!("{part}{name}"), figure, caption)?;
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
    ///
    /// # Errors
    /// If the file cannot be written.
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

    /// Adds a statement or a target to the list at the start of the report.
    pub fn state(&mut self, stated: S) {
        self.stated.push(stated);
    }

    /// Writes a figure outside the report, because it differs from run to run.
    ///
    /// # Errors
    /// If the figure cannot be drawn or written.
    pub fn aside(&mut self, name: &str, figure: &Figure) -> Result<(), Failure> {
        self.file(name, figure.svg()?.as_bytes())
    }

    /// Adds a line to the final summary, for values that differ from run to run.
    pub fn remark(&mut self, line: String) {
        self.remarks.push(line);
    }

    fn file(&mut self, name: &str, bytes: &[u8]) -> Result<(), Failure> {
        let path = self.out.join(name);
        write_whole(&path, bytes).map_err(|failure| unwritten(&path, &failure))?;
        self.files.push(name.into());
        Ok(())
    }

    /// Writes report, timings and manifest, and sums up. The manifest comes last: a folder with one is complete. `tell` writes
    /// what is stated into the report, and returns lines about it for the summary.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn finish(
        mut self,
        title: &str,
        introduction: &str,
        tell: impl FnOnce(&mut Report, &[S]) -> String,
    ) -> Result<Finished<S>, Failure> {
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
        let told = tell(&mut report, &self.stated);
        report.append(self.body.clone());
        for path in report.write(&self.out).map_err(|failure| unwritten(&self.out, &failure))? {
            let name = path.strip_prefix(&self.out).unwrap_or(&path);
            self.files.push(name.to_string_lossy().replace('\\', "/"));
        }
        let files = self.files.clone();
        let manifest = Manifest { title, version: env!("CARGO_PKG_VERSION"), quick: self.quick, files: &files };
        self.csv("timings.csv", &timings)?;
        self.file(MANIFEST, serde_json::to_string_pretty(&manifest)?.as_bytes())?;
        self.progress.finish();

        let summary = format!(
            "{title}: {impacts} impacts in {:.2} s, {:.2} s with all files.\n{}{told}Report: {}",
            total,
            self.started.elapsed().as_secs_f64(),
            self.remarks.iter().map(|line| format!("{line}\n")).collect::<String>(),
            self.out.join("report.html").display()
        );
        Ok(Finished { title: title.to_owned(), stated: self.stated, shown: self.shown, impacts, summary })
    }
}

/// An error of the operating system says what is wrong, but not with which file.
fn unwritten(path: &Path, failure: &std::io::Error) -> Failure {
    format!("cannot write {}: {failure}", path.display()).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quick_study_keeps_both_ends_of_a_list() {
        let folder = tempfile::tempdir().unwrap();
        let thinned = |quick: bool, all: &[usize]| Study::<()>::new(folder.path(), quick).unwrap().thin(all, 13);
        let all: Vec<usize> = (1..=65).collect();
        let quick = thinned(true, &all);
        assert_eq!((quick.len(), quick[0], quick[12]), (13, 1, 65));
        assert!(quick.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!(thinned(false, &all), all);
        assert_eq!(thinned(true, &all[..4]), all[..4]);
    }

    #[test]
    fn batches_count_to_one_total() {
        let folder = tempfile::tempdir().unwrap();
        let mut study = Study::<()>::new(folder.path(), true).unwrap();
        let mut saved = Vec::new();
        let save = |batch: Vec<usize>| {
            saved.push(batch);
            Ok(())
        };
        study.sweep_in_batches(&[1, 2, 3, 4, 5], (2, 10), |&case| Ok(2 * case), save).unwrap();
        assert_eq!(saved, [vec![2, 4], vec![6, 8], vec![10]]);
        assert_eq!(study.progress.counted(), (50, 50));
    }
}
