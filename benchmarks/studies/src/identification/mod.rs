//! Test of `identify` with random tables of synthetic measurements: how often its intervals contain the true parameters, how
//! often a wrong model is noticed, and how many starting points are needed for impacts with many contacts.

mod row;

use std::fs;
use std::path::PathBuf;

use row::{FREE, Kind, Row, STARTS, row};
use tasks::{Failure, Journal, Progress};

/// Tables fitted side by side before their rows are written.
const BATCH: usize = 32;

/// Options of the study of identification.
#[derive(clap::Args)]
pub struct Wanted {
    /// Number of tables of each kind
    #[arg(long, value_name = "COUNT", default_value_t = 2000)]
    tables: u64,
    /// Number of tables of impacts with many contacts
    #[arg(long, value_name = "COUNT", default_value_t = 40)]
    rough: u64,
    /// Resume from the results of an earlier run
    #[arg(long)]
    resume: bool,
    /// The folder to write to
    #[arg(long, value_name = "DIR", default_value = "out/study-identify")]
    out: PathBuf,
}

/// Runs the study, or the part that is missing, and summarises it.
///
/// # Errors
/// If a table cannot be fitted, or a file cannot be read or written.
pub fn run(wanted: &Wanted) -> Result<String, Failure> {
    let count = |kind: Kind| if kind.is_rough() { wanted.rough } else { wanted.tables };
    let all: Vec<(Kind, u64)> = Kind::ALL.iter().flat_map(|&kind| (0..count(kind)).map(move |n| (kind, n))).collect();
    let mut journal = Journal::open(&wanted.out.join("rows.jsonl"), wanted.resume)?;
    let is_missing = |(kind, number): &(Kind, u64)| {
        journal.rows().iter().all(|row: &Row| (row.kind, row.number) != (*kind, *number))
    };
    let missing: Vec<(Kind, u64)> = all.iter().copied().filter(is_missing).collect();
    let mut progress = Progress::of("tables");
    progress.begin("", all.len() as u64, (all.len() - missing.len()) as u64);
    journal.compute(&missing, BATCH, &progress, |&(kind, number)| {
        row(kind, number).map_err(|fault| format!("{kind:?} {number}: {fault}").into())
    })?;
    progress.finish();
    let mut rows = journal.into_rows();
    rows.retain(|row| all.contains(&(row.kind, row.number)));
    let told = Kind::ALL.iter().map(|&kind| told(kind, &rows)).collect::<String>();
    fs::write(wanted.out.join("summary.txt"), &told)?;
    Ok(told)
}

/// The share of the rows of a kind for which a condition holds, and its standard error (%).
fn told(kind: Kind, rows: &[Row]) -> String {
    let rows: Vec<&Row> = rows.iter().filter(|row| row.kind == kind).collect();
    let share = |held: usize, of: usize| {
        let p = held as f64 / of.max(1) as f64;
        format!("{:.2} +- {:.2} %", 100.0 * p, 100.0 * (p * (1.0 - p) / of.max(1) as f64).sqrt())
    };
    let parameters = FREE.len() * rows.len();
    let sum = |of: fn(&Row) -> usize| rows.iter().map(|row| of(row)).sum::<usize>();
    let noticed = share(sum(|row| usize::from(row.noticed)), rows.len());
    match kind {
        Kind::Stated | Kind::Estimated => format!(
            "{kind:?}: {} tables; intervals hold by covariance {}, by profile {}; noticed {noticed}\n",
            rows.len(),
            share(sum(|row| row.by_covariance), parameters),
            share(sum(|row| row.by_profile), parameters),
        ),
        Kind::WrongLaw | Kind::WrongDamping => format!("{kind:?}: {} tables; noticed {noticed}\n", rows.len()),
        Kind::Rough | Kind::RoughPeak | Kind::Smooth | Kind::Chaotic => {
            let of = |all: fn(&Row) -> &[bool], k: usize| {
                share(rows.iter().filter(|row| all(row).get(k) == Some(&true)).count(), rows.len())
            };
            let each = |(k, starts)| {
                let (fits, near) = (of(|row| &row.fits, k), of(|row| &row.near, k));
                format!("from {starts} starts {fits} fit as well as the truth and {near} are near it, ")
            };
            let each: String = STARTS.iter().enumerate().map(each).collect();
            let held = share(sum(|row| row.by_profile), parameters);
            format!("{kind:?}: {} tables; {each}intervals from the most starts hold by profile {held}\n", rows.len())
        }
    }
}
