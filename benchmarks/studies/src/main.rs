//! Studies of the program on random input: does it hold what it states?
//!
//! | command | question | page of the book |
//! |---|---|---|
//! | `cargo xtask soak` | does any impact panic, hang, gain energy, or give no number? | `development/fuzzing-and-soak` |
//! | `cargo xtask study-auto` | do answers with the chosen model keep the requested tolerance? | `choosing-the-model` |
//! | `cargo xtask study-identify` | how often do intervals contain the true parameters? | `how-to/identify` |
//! | `cargo xtask study-derivatives` | how many derivatives agree with differences in 32 digits? | `theory/derivatives` |
//! | `cargo xtask study-control` | how many draws would a control variate save? | `development/draws-history` |
//!
//! All cases come from seeds, so that a run gives the same numbers on any number of threads; `soak`, `study-auto`,
//! `study-derivatives` and `study-identify` can be interrupted and resumed. The scatter of the law (`cargo xtask study-scatter`) is fitted to the tables
//! of the thesis, and is therefore among its chapters in `xtask`.

mod choice;
#[path = "../../../crates/vibroimpact-sim/tests/common/mod.rs"]
mod common;
mod control;
mod derivatives;
mod identification;
mod soak;

use clap::{Parser, Subcommand};
use std::process::ExitCode;
use tasks::{Failure, ended, say};

/// Studies of the program on random input.
#[derive(Parser)]
#[command(bin_name = "cargo xtask")]
struct Cli {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Solve random impacts far outside the usual range: no panic, no NaN, no energy gained, no hang
    Soak(soak::Wanted),
    /// Test the automatic choice of the model: random scenes against a far more accurate reference
    StudyAuto(choice::Wanted),
    /// Test identification: random tables of synthetic measurements with noise
    StudyIdentify(identification::Wanted),
    /// Test derivatives: random impacts against differences of an independent solution in 32 digits
    StudyDerivatives(derivatives::Wanted),
    /// Measure the gain of a control variate from derivatives over plain draws of uncertain fields
    StudyControl(control::Wanted),
}

fn main() -> ExitCode {
    ended(run(&Cli::parse().task))
}

fn run(task: &Task) -> Result<(), Failure> {
    match task {
        Task::Soak(wanted) => soak::run(wanted),
        Task::StudyAuto(wanted) => say(&choice::run(wanted)?),
        Task::StudyIdentify(wanted) => say(&identification::run(wanted)?),
        Task::StudyDerivatives(wanted) => say(&derivatives::run(wanted)?),
        Task::StudyControl(wanted) => say(&control::run(wanted)?),
    }
}
