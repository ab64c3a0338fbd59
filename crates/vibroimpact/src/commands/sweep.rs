//! The commands `sweep` and `merge`.

use std::io::{IsTerminal, stderr};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use clap::Args;
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use serde_json::json;
use vibroimpact::export::{self, Failure};
use vibroimpact::sweep::{self, Part, Status, Sweep, SweepError, Tally};
use vibroimpact::text::printable;

use super::voice::{is_quiet, tell};

pub const SWEEP_EXAMPLES: &str = r#"Examples:
  vibroimpact sweep sweep.json --out results/                  computes, shows the time left, resumes if interrupted
  vibroimpact sweep sweep.json --out part-3/ --shard 3/8       the third of eight parts, for a job array
  mpirun -n 64 vibroimpact sweep sweep.json --out results/ --mpi

A sweep file contains a scene (or names one) and the fields that vary:

  { "scene_file": "ball.json",
    "vary": [ { "field": "location_m", "from": 0.02, "to": 0.98, "count": 25 },
              { "field": "striker.mass_kg", "from": 0.01, "to": 1, "count": 20, "scale": "log" },
              { "field": "structure.damping_ratio", "values": [0, 0.02] } ],
    "random": { "seed": 1, "draws": 10, "fields": [ { "field": "striker.speed_m_s", "from": 0.5, "to": 2 } ] } }

In place of "random", fields may be given as distributions. The restitution is then reported as a distribution with sampling
errors; for a scene of bodies this holds for the results that "outputs" in "sampling" names:

  { "scene_file": "ball.json",
    "uncertain": { "location_m": { "normal": [0.4, 1e-3] }, "striker.speed_m_s": { "uniform": [0.9, 1.1] } },
    "sampling": { "draws": 65536, "sampling_error": 0.002, "indices": true } }

The axes of "vary" form a grid, whose last axis runs fastest; each of its points is combined with every random draw. The folder
gets results.csv, results.parquet, report.html with pictures, summary.json. The bytes are the same for any number of
threads, parts and ranks. A scene that cannot be solved is a row with its error.

Ctrl-C stops the sweep; the same command continues from there, also after a crash. A folder with another sweep, or with files
of the names above that belong to none, is rejected; other files in it are left alone.
Exit codes: 0 finished, 130 stopped, 2 for input that cannot be used (nothing is computed, or no point could be solved),
1 if reading or writing fails. With the output redirected, lines on the standard error report the progress."#;

pub const MERGE_EXAMPLES: &str = "Example:
  vibroimpact merge part-*/ --out results/

The folders must be those of all parts of one sweep, each once and finished; the message names those that are missing.
The results are the same, byte for byte, as those of an undivided sweep.";

/// Exit code of a sweep that was interrupted.
pub const STOPPED: u8 = 130;

/// Destination, computation and form of the results.
#[derive(Args)]
pub struct Run {
    /// The folder for the results; an unfinished sweep in it is resumed
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Number of threads; default: one for each core
    #[arg(long, value_name = "N", value_parser = super::whole::<u16>(1..=4096), allow_negative_numbers = true)]
    threads: Option<u16>,
    /// Print one JSON object in place of the summary
    #[arg(long)]
    json: bool,
}

/// A sweep, and the folder for its results.
#[derive(Args)]
pub struct SweepArguments {
    /// The sweep file
    sweep: PathBuf,
    #[command(flatten)]
    run: Run,
    /// Compute only the K-th of N parts
    #[arg(long, value_name = "K/N", value_parser = part, allow_hyphen_values = true)]
    shard: Option<Part>,
    /// Compute on the ranks of an MPI job, under mpirun; the first rank hands out the work
    #[arg(long, conflicts_with = "threads")]
    mpi: bool,
}

/// The parts of a sweep, and the folder for the whole.
#[derive(Args)]
pub struct MergeArguments {
    /// The folders of the parts
    #[arg(required = true, value_name = "DIR")]
    parts: Vec<PathBuf>,
    /// The folder for the joined sweep
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Print one JSON object in place of the summary
    #[arg(long)]
    json: bool,
}

fn part(text: &str) -> Result<Part, &'static str> {
    Part::parse(text).ok_or("it must be K/N with whole numbers, where K is from 1 to N, and N is at most 1000000")
}

/// Runs the command `sweep` and returns the text to print.
pub fn sweep(arguments: SweepArguments) -> Result<String, Failure> {
    let part = arguments.shard.unwrap_or(Part::WHOLE);
    if !arguments.mpi {
        return compute(&Sweep::read(&arguments.sweep)?, part, &arguments.run);
    }
    let stop = stop_on_signal()?;
    let mut progress = Progress::new(is_quiet());
    match over_ranks(&arguments, part, &stop, &mut progress)? {
        Some(tally) => told(&tally, &arguments.run, &progress),
        // another rank reports it
        None => Ok(String::new()),
    }
}

/// Computes a sweep that has been read, and returns the text to print.
pub fn compute(sweep: &Sweep, part: Part, run: &Run) -> Result<String, Failure> {
    let stop = stop_on_signal()?;
    let mut progress = Progress::new(is_quiet());
    let threads = run.threads.map_or(0, usize::from);
    let tally = sweep::run(sweep, part, &run.out, threads, &stop, &mut |status| progress.tell(status))?;
    told(&tally, run, &progress)
}

fn told(tally: &Tally, run: &Run, progress: &Progress) -> Result<String, Failure> {
    progress.finish();
    solved(tally, printed(tally, &run.out, run.json, Some(progress))?)
}

#[cfg(feature = "mpi")]
fn over_ranks(
    arguments: &SweepArguments,
    part: Part,
    stop: &AtomicBool,
    progress: &mut Progress,
) -> Result<Option<Tally>, SweepError> {
    sweep::mpi::run(|| Sweep::read(&arguments.sweep), part, &arguments.run.out, stop, &mut |status| {
        progress.tell(status)
    })
}

#[cfg(not(feature = "mpi"))]
fn over_ranks(_: &SweepArguments, _: Part, _: &AtomicBool, _: &mut Progress) -> Result<Option<Tally>, SweepError> {
    let text = "--mpi: this program was built without MPI; build it with `cargo build --release --features mpi`";
    Err(SweepError::Refused(text.to_owned()))
}

/// Runs the command `merge` and returns the text to print.
pub fn merge(arguments: MergeArguments) -> Result<String, Failure> {
    let tally = sweep::merge(&arguments.parts, &arguments.out)?;
    solved(&tally, printed(&tally, &arguments.out, arguments.json, None)?)
}

/// A sweep that ended without a single result.
#[derive(Debug, thiserror::Error)]
#[error("none of the {points} points could be solved; the first: {first}")]
pub struct NoPointSolved {
    /// Number of points.
    points: u64,
    /// The error of the first.
    first: String,
    /// The text that is printed nevertheless.
    pub printed: String,
}

/// Returns the text to print, unless every point failed.
fn solved(tally: &Tally, printed: String) -> Result<String, Failure> {
    if tally.points == 0 || tally.failures < tally.points {
        return Ok(printed);
    }
    let first = tally.first_failures.first().map_or_else(String::new, |failed| failed.error.clone());
    Err(NoPointSolved { points: tally.points, first, printed }.into())
}

/// The first signal requests an orderly end, the second ends the program at once.
pub fn stop_on_signal() -> Result<Arc<AtomicBool>, Failure> {
    let stop = Arc::new(AtomicBool::new(false));
    let asked = Arc::clone(&stop);
    ctrlc::set_handler(move || {
        if asked.swap(true, Ordering::Relaxed) {
            std::process::exit(STOPPED.into());
        }
    })?;
    Ok(stop)
}

fn printed(tally: &Tally, out: &Path, as_json: bool, progress: Option<&Progress>) -> Result<String, Failure> {
    let (computed, elapsed_s) = progress.map_or((0, 0.0), Progress::work);
    let rate = (computed > 0 && elapsed_s > 0.0).then(|| computed as f64 / elapsed_s);
    if as_json {
        let mut object = serde_json::to_value(tally)?;
        if let Some(map) = object.as_object_mut() {
            map.insert("folder".to_owned(), json!(out));
            if progress.is_some() {
                map.insert("computed_points".to_owned(), json!(computed));
                map.insert("elapsed_s".to_owned(), json!(elapsed_s));
                map.insert("impacts_per_s".to_owned(), json!(rate));
            }
        }
        return export::json(&object);
    }
    let mut text = format!("{}\n\n{}", printable(&out.display().to_string()), tally.text());
    match (progress, rate) {
        (Some(_), Some(rate)) => {
            text += &format!("  {:<22}{computed} points in {elapsed_s:.1} s, {rate:.0} a second\n", "computed now");
        }
        (Some(_), None) => text += &format!("  {:<22}nothing; all points were done\n", "computed now"),
        (None, _) => {}
    }
    Ok(text)
}

/// Progress on the standard error: a bar on a terminal, a line from time to time elsewhere.
struct Progress {
    quiet: bool,
    begun: Instant,
    /// Points at the beginning of this run, and now.
    first: Option<Status>,
    last: Option<Status>,
    bar: Option<ProgressBar>,
    next_line: Instant,
}

/// Time before the first line where there is no terminal.
const FIRST_LINE: Duration = Duration::from_secs(10);
/// Time between two lines.
const BETWEEN_LINES: Duration = Duration::from_secs(30);

impl Progress {
    fn new(quiet: bool) -> Progress {
        let now = Instant::now();
        Progress { quiet, begun: now, first: None, last: None, bar: None, next_line: now + FIRST_LINE }
    }

    fn tell(&mut self, status: Status) {
        if self.first.is_none() {
            self.first = Some(status);
            self.begun = Instant::now();
            if !self.quiet && stderr().is_terminal() && !status.is_complete() {
                let bar = ProgressBar::new(status.points).with_position(status.done).with_style(style());
                bar.reset_eta();
                self.bar = Some(bar);
            }
            if !self.quiet && status.done > 0 && !status.is_complete() {
                tell(format_args!("{} of {} points are done; continuing", status.done, status.points));
            }
        }
        self.last = Some(status);
        if let Some(bar) = &self.bar {
            bar.set_position(status.done);
        } else if !self.quiet && Instant::now() >= self.next_line {
            self.next_line = Instant::now() + BETWEEN_LINES;
            let (computed, elapsed_s) = self.work();
            let rate = computed as f64 / elapsed_s;
            let left = Duration::try_from_secs_f64((status.points - status.done) as f64 / rate);
            let left = left.map_or_else(|_| "unknown".to_owned(), |left| HumanDuration(left).to_string());
            tell(format_args!("{} of {} points, {rate:.0} a second, {left} left", status.done, status.points));
        }
    }

    fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }

    /// Points computed in this run, and the time it took.
    fn work(&self) -> (u64, f64) {
        let computed = self.first.zip(self.last).map_or(0, |(first, last)| last.done - first.done);
        (computed, self.begun.elapsed().as_secs_f64())
    }
}

fn style() -> ProgressStyle {
    let template = "{bar:30} {human_pos} of {human_len} points, {per_sec}, {eta} left";
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}
