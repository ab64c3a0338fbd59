//! Test of the derivatives of random impacts: how many agree with differences in 32 digits, and how many lie within their stated
//! uncertainty. The impacts and the solution in 32 digits are those of the tests of `vibroimpact-sim`.

#[path = "../../../../crates/vibroimpact-sim/tests/differentiate/double.rs"]
mod double;
#[path = "../../../../crates/vibroimpact-sim/tests/differentiate/posed.rs"]
mod posed;
mod row;
#[path = "../../../../crates/vibroimpact-sim/tests/differentiate/taylor.rs"]
mod taylor;

use std::fs;
use std::path::PathBuf;

use posed::{Posed, random_impacts};
use row::{FEW, OUTPUTS, Row, Tally, row};
use tasks::{Failure, Journal, Progress};

/// Impacts compared side by side before their rows are written.
const BATCH: usize = 8;

/// Options of the study of derivatives.
#[derive(clap::Args)]
pub struct Wanted {
    /// Number of random impacts
    #[arg(long, value_name = "COUNT", default_value_t = 1000)]
    impacts: u32,
    /// Resume from the results of an earlier run
    #[arg(long)]
    resume: bool,
    /// The folder to write to
    #[arg(long, value_name = "DIR", default_value = "out/study-derivatives")]
    out: PathBuf,
}

/// Runs the study, or the part that is missing, and summarises it.
///
/// # Errors
/// If a file cannot be read or written.
pub fn run(wanted: &Wanted) -> Result<String, Failure> {
    let mut journal = Journal::open(&wanted.out.join("rows.jsonl"), wanted.resume)?;
    let is_missing = |(number, _): &(u32, Posed)| journal.rows().iter().all(|row: &Row| row.number != *number);
    let missing: Vec<(u32, Posed)> = (0..wanted.impacts).zip(random_impacts()).filter(is_missing).collect();
    let mut progress = Progress::of("impacts");
    progress.begin("", u64::from(wanted.impacts), u64::from(wanted.impacts) - missing.len() as u64);
    journal.compute(&missing, BATCH, &progress, |(number, posed)| Ok(row(*number, posed)))?;
    progress.finish();
    let mut rows = journal.into_rows();
    rows.retain(|row| row.number < wanted.impacts);
    let told = told(&rows);
    fs::write(wanted.out.join("summary.txt"), &told)?;
    Ok(told)
}

fn told(rows: &[Row]) -> String {
    let rebounds: Vec<&Row> = rows.iter().filter(|row| row.rebounds).collect();
    let most = rebounds.iter().map(|row| row.contacts).max().unwrap_or(0);
    let sum = |of: fn(&Row) -> usize| rebounds.iter().map(|row| of(row)).sum::<usize>();
    let (lost, unknown) = (sum(|row| row.lost), sum(|row| row.unknown));
    let mut told = format!(
        "{} impacts, of which {} end with a rebound, with at most {most} contacts; by {lost} parameters they have another number \
         of contacts in 32 digits, and by {unknown} parameters the derivatives in 32 digits are not exact to a millionth\n",
        rows.len(),
        rebounds.len(),
    );
    for (i, name) in OUTPUTS.iter().enumerate() {
        let of =
            |rows: &mut dyn Iterator<Item = &&Row>| rows.fold(Tally::default(), |sum, row| sum.with(&row.outputs[i]));
        let (all, few) = (of(&mut rebounds.iter()), of(&mut rebounds.iter().filter(|row| row.contacts <= FEW)));
        let share = |part: usize, of: usize| 100.0 * part as f64 / of.max(1) as f64;
        told += &format!(
            "{name}: {} compared; {:.2} % correct to a millionth, {:.2} % of {} with at most {FEW} contacts; {:.2} % within the \
             stated uncertainty; {} wrong by more than a millionth and the stated uncertainty, {} without one; worst {:.1e} of \
             the derivative, with at most {FEW} contacts {:.1e}\n",
            all.compared,
            share(all.near, all.compared),
            share(few.near, few.compared),
            few.compared,
            share(all.covered, all.compared),
            all.silent,
            all.uncertain,
            all.worst,
            few.worst,
        );
    }
    told
}
