//! The files of a run: intervals, which are written as they are found, histories, sections, figures, report, and result as JSON.

use std::fmt;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use vibroimpact_sim::assembly::Interval;

use super::report;
use super::summary::Summary;
use super::watch::Row;
use super::{AssemblyScene, Course, Simulation, pictures};
use crate::export::aside::Aside;
use crate::export::{Failure, Table};
use crate::sweep::table::{Kind, Table as Parquet};

/// Intervals of contact as a table, row by row.
const INTERVALS: [(&str, Kind); 9] = [
    ("contact", Kind::Text),
    ("number", Kind::Whole),
    ("start_s", Kind::Number),
    ("end_s", Kind::Number),
    ("impulse_n_s", Kind::Number),
    ("peak_force_n", Kind::Number),
    ("peak_compression_m", Kind::Number),
    ("approach_speed_m_s", Kind::Number),
    ("separation_speed_m_s", Kind::Number),
];

/// The files with all intervals during a run. They appear under their names when the run has ended.
pub struct IntervalFiles {
    folder: PathBuf,
    aside: Aside,
    names: Vec<String>,
    counts: Vec<u64>,
    csv: csv::Writer<BufWriter<File>>,
    parquet: Parquet,
}

const CSV: &str = "intervals.csv";
const PARQUET: &str = "intervals.parquet";

fn blame(folder: &Path) -> impl Fn(std::io::Error) -> Failure + '_ {
    move |error| format!("cannot write to {}: {error}", folder.display()).into()
}

impl fmt::Debug for IntervalFiles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("IntervalFiles")
            .field("folder", &self.folder)
            .field("names", &self.names)
            .field("counts", &self.counts)
            .finish_non_exhaustive()
    }
}

impl IntervalFiles {
    /// The names of the files.
    pub const NAMES: [&str; 2] = [CSV, PARQUET];

    /// Begins the files in a folder, which is made if it is missing; `names` are those of the contacts.
    ///
    /// # Errors
    /// A folder or file that cannot be written.
    pub fn create(folder: &Path, names: &[String]) -> Result<IntervalFiles, Failure> {
        fs::create_dir_all(folder).map_err(blame(folder))?;
        let aside = Aside::new_in(folder).map_err(blame(folder))?;
        let file = File::create(aside.path().join(CSV)).map_err(blame(folder))?;
        let mut csv = csv::Writer::from_writer(BufWriter::new(file));
        csv.write_record(INTERVALS.map(|(name, _)| name))?;
        let columns = INTERVALS.map(|(name, kind)| (name.to_owned(), kind)).to_vec();
        let parquet = Parquet::create(&aside.path().join(PARQUET), "intervals", columns)?;
        let counts = vec![0; names.len()];
        Ok(IntervalFiles { folder: folder.to_owned(), aside, names: names.to_vec(), counts, csv, parquet })
    }

    /// Adds an interval of a contact.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn add(&mut self, contact: usize, interval: &Interval) -> Result<(), Failure> {
        self.counts[contact] += 1;
        let number = |value: f64| crate::scene::json::number(value);
        let known = |value: Option<f64>| value.map_or_else(String::new, number);
        let cells = [
            self.names[contact].clone(),
            self.counts[contact].to_string(),
            number(interval.start_s),
            known(interval.end_s),
            number(interval.impulse_n_s),
            number(interval.peak_force_n),
            number(interval.peak_compression_m),
            number(interval.approach_speed_m_s),
            known(interval.separation_speed_m_s),
        ];
        self.csv.write_record(&cells)?;
        let path = self.aside.path().join(PARQUET);
        Ok(self.parquet.add(cells.iter().map(String::as_str), &path)?)
    }

    /// Completes the files and moves them to their names.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn close(mut self) -> Result<(), Failure> {
        self.csv.flush().map_err(blame(&self.folder))?;
        self.parquet.close(&self.aside.path().join(PARQUET))?;
        for name in IntervalFiles::NAMES {
            fs::rename(self.aside.path().join(name), self.folder.join(name)).map_err(blame(&self.folder))?;
        }
        Ok(())
    }
}

/// Motion and force of every contact over time: what `history.csv` holds, and `section.csv` once in each period.
pub fn history(names: &[String], rows: &[Row]) -> Table {
    let mut columns = vec![("time_s".to_owned(), rows.iter().map(|row| row.time_s).collect::<Vec<f64>>())];
    for (c, name) in names.iter().enumerate() {
        let mut column = |quantity: &str, of: fn(&vibroimpact_sim::assembly::ContactSample) -> f64| {
            columns.push((format!("{name}_{quantity}"), rows.iter().map(|row| of(&row.contacts[c])).collect()));
        };
        column("gap_m", |sample| 0.0 - sample.overlap_m);
        column("gap_rate_m_s", |sample| 0.0 - sample.rate_m_s);
        column("force_n", |sample| sample.force_n);
        column("displacement_0_m", |sample| sample.displacement_m[0]);
        column("displacement_1_m", |sample| sample.displacement_m[1]);
        column("velocity_0_m_s", |sample| sample.velocity_m_s[0]);
        column("velocity_1_m_s", |sample| sample.velocity_m_s[1]);
    }
    Table { columns }
}

/// The rest of a run's files, in memory: `result.json`, `history.csv`, `section.csv` where a load is harmonic, `run.svg`,
/// `report.html`.
///
/// # Errors
/// Errors of the writers, which a run cannot cause.
pub fn files(
    title: &str,
    scene: &AssemblyScene,
    found: &Simulation,
    summary: &Summary,
) -> Result<Vec<(&'static str, Vec<u8>)>, Failure> {
    let none = Course::default();
    let course = found.course.as_ref().unwrap_or(&none);
    let figure = pictures::picture(title, found);
    let mut files = vec![
        ("result.json", summary.json(scene)?.into_bytes()),
        ("history.csv", history(&found.posed.contacts, &course.rows).csv()?),
        ("run.svg", figure.svg()?.into_bytes()),
        ("report.html", report::report(title, scene, summary, &figure)?.html().into_bytes()),
    ];
    if course.period_s.is_some() {
        files.push(("section.csv", history(&found.posed.contacts, &course.section).csv()?));
    }
    Ok(files)
}

/// The names of all files that a run may write.
pub const NAMES: [&str; 7] = [CSV, PARQUET, "result.json", "history.csv", "run.svg", "report.html", "section.csv"];
