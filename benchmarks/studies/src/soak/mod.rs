//! A long run of random impacts: no panic, no NaN, no energy gained, no hang.

mod cases;
mod checks;
mod summary;

use std::path::PathBuf;
use std::time::Duration;

use cases::case;
use checks::judge;
use summary::Summary;
use tasks::{Failure, say};

/// Options of the soak.
#[derive(clap::Args)]
pub struct Wanted {
    /// Number of impacts
    #[arg(long, default_value_t = 1_000_000)]
    impacts: u64,
    /// Seed of the cases
    #[arg(long, default_value_t = 2019)]
    seed: u64,
    /// Start no further impact after this many minutes
    #[arg(long)]
    minutes: Option<u64>,
    /// Solve only the case with this number, and print it
    #[arg(long, value_name = "INDEX")]
    only: Option<u64>,
    /// Resume where the run that wrote the summary ended
    #[arg(long)]
    resume: bool,
    /// The file for the summary, written after every 4,096 impacts
    #[arg(long, value_name = "FILE", default_value = "out/soak.json")]
    out: PathBuf,
}

/// Runs the soak, or a single case of it, and prints what was found.
///
/// # Errors
/// If an impact fails, or the summary cannot be read or written.
pub fn run(wanted: &Wanted) -> Result<(), Failure> {
    let Wanted { impacts, seed, minutes, only, resume, out } = wanted;
    if let Some(index) = only {
        let case = case(*seed, *index);
        return say(&format!("{case:#?}\n{:#?}", judge(&case)));
    }
    let limit = minutes.map(|minutes| Duration::from_secs(minutes.saturating_mul(60)));
    let begun = if *resume { Summary::resume(out, *seed)? } else { Summary::new(*seed) };
    let summary = begun.run(*impacts, limit, |summary| summary.write(out))?;
    say(&summary.to_string())?;
    if summary.failed == 0 { Ok(()) } else { Err(format!("{} impacts failed", summary.failed).into()) }
}
