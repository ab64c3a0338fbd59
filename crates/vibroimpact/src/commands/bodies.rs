//! The command `simulate` for a scene of bodies.

use std::io::{IsTerminal, stderr};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use vibroimpact::assembly::{self, AssemblyScene, IntervalFiles, MOST_INTERVALS, Summary, Wanted};
use vibroimpact::export::{Failure, Files};
use vibroimpact::text::quantity;
use vibroimpact::vibroimpact_sim::assembly::Interval;

use super::products::{Products, with_files};
use super::sweep::stop_on_signal;
use super::voice::{is_quiet, signature, tell};

/// Solves the scene and returns the text to print; at most `intervals` intervals of contact are listed.
pub fn simulate(scene: &AssemblyScene, intervals: usize, products: &Products) -> Result<String, Failure> {
    // an error of the scene is reported before anything is written
    let posed = scene.pose()?;
    let headline = assembly::headline(scene, &posed);
    let mut files = products.out.as_deref().map(|folder| IntervalFiles::create(folder, &posed.contacts)).transpose()?;
    let mut take = |contact: usize, interval: &Interval| match &mut files {
        Some(files) => files.add(contact, interval),
        None => Ok(()),
    };
    let stop = stop_on_signal()?;
    let mut progress = Progress::new(scene.end_s);
    let wanted = Wanted {
        intervals: MOST_INTERVALS,
        reliability: true,
        course: products.want_course(),
        take: Some(&mut take),
        stop: &stop,
        tell: &mut |time_s| progress.tell(time_s),
    };
    let found = scene.simulate_with(wanted)?;
    progress.finish();
    let summary = Summary::new(&found).listing(intervals);
    let printed = match products.json {
        true => summary.json(scene)?,
        false => format!("{headline}\n\n{}{}", assembly::result(&summary), signature()),
    };
    with_files(printed, |printed| {
        files.map_or(Ok(()), IntervalFiles::close)?;
        products.write(
            printed,
            || assembly::picture(&headline, &found),
            |figure| assembly::report(&headline, scene, &summary, figure),
            || Ok(Files::of(assembly::files(&headline, scene, &found, &summary)?).beside(&IntervalFiles::NAMES)),
        )
    })
}

/// Progress on the standard error: a bar on a terminal, a line from time to time elsewhere.
struct Progress {
    end_s: f64,
    begun: Instant,
    told: Instant,
    bar: Option<ProgressBar>,
}

/// Time before the first line if there is no terminal.
const FIRST: Duration = Duration::from_secs(1);
/// Time between two lines.
const BETWEEN_LINES: Duration = Duration::from_secs(30);
/// Steps of the bar.
const STEPS: f64 = 1000.0;

impl Progress {
    fn new(end_s: f64) -> Progress {
        let now = Instant::now();
        Progress { end_s, begun: now, told: now, bar: None }
    }

    fn tell(&mut self, time_s: f64) {
        if is_quiet() || self.begun.elapsed() < FIRST {
            return;
        }
        if stderr().is_terminal() {
            let bar = self.bar.get_or_insert_with(|| {
                let bar = ProgressBar::new(STEPS as u64);
                ProgressStyle::with_template("{wide_bar} {msg}, {eta} left").map(|style| bar.set_style(style)).ok();
                bar
            });
            bar.set_position((STEPS * (time_s / self.end_s).clamp(0.0, 1.0)) as u64);
            bar.set_message(format!("{} of {}", quantity(time_s, "s"), quantity(self.end_s, "s")));
        } else if self.told.elapsed() >= BETWEEN_LINES {
            self.told = Instant::now();
            tell(format_args!("simulate: {} of {}", quantity(time_s, "s"), quantity(self.end_s, "s")));
        }
    }

    fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
