//! Sweeps: many scenes that differ in some fields, computed on all cores, in parts on many machines, or over the ranks of an MPI
//! job. The bytes of the results are the same in all cases.
//!
//! A [`Sweep`] is a base scene and the fields that vary. Its points are numbered, and each is a function of its number
//! alone. [`run`] computes them into a folder; after an interruption at any moment, another run continues from there.
//! [`merge`] makes the folder of a whole sweep from those of its parts.
//!
//! | file | content |
//! |---|---|
//! | `results.csv` | one row for each point: `index`, the varied fields, the result, its cost, `error` if there is none |
//! | `results.parquet` | the same, typed and compressed |
//! | `report.html`, `report.md`, `figures/` | the varied fields, the results, pictures |
//! | `distribution.csv` | for a sweep with uncertain fields: statistics of the outputs at each grid point |
//! | `summary.json` | a [`Tally`] |
//! | `sweep.json`, `progress.json`, `lock` | the sweep, its progress, the process that works on it |
//!
//! ```
//! use std::sync::atomic::AtomicBool;
//! use vibroimpact::sweep::{Part, Sweep, run};
//!
//! let sweep = Sweep::from_value(&serde_json::json!({
//!     "scene": {
//!         "structure": { "kind": "modal", "omega_rad_s": [300, 1900], "shape_at_location": [1.1, -0.7] },
//!         "striker": { "mass_kg": 0.1, "speed_m_s": 1 },
//!         "contact": { "law": "hertz", "stiffness_n_m1_5": 1e9 }
//!     },
//!     "vary": [{ "field": "striker.mass_kg", "from": 0.01, "to": 1, "count": 5, "scale": "log" }]
//! }))?;
//! let folder = tempfile::tempdir()?;
//! let tally = run(&sweep, Part::WHOLE, folder.path(), 2, &AtomicBool::new(false), &mut |_| ())?;
//! assert_eq!((tally.points, tally.failures), (5, 0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod assembly;
mod columns;
mod definition;
mod error;
mod evaluate;
mod file;
mod finish;
mod folder;
mod labels;
mod merge;
#[cfg(feature = "mpi")]
pub mod mpi;
mod part;
mod pictures;
mod predictability;
mod quantities;
mod report;
mod results;
mod row;
mod schema;
mod status;
pub(crate) mod table;
mod tally;
mod threads;
mod uncertain;
mod values;

use std::path::Path;
use std::sync::atomic::AtomicBool;

pub use crate::scene::FieldPath;
pub use columns::{Column, MOST_IN_MEMORY, run_in_memory};
pub use definition::Sweep;
pub use error::SweepError;
pub use file::FORMAT_VERSION;
pub use merge::merge;
pub use part::Part;
pub use predictability::{Blur, BlurWidth, Over};
pub use schema::schema;
pub use status::Status;
pub use tally::{Extremes, FailedPoint, Tally};
pub use uncertain::{
    Distribution, Estimate, Histogram, Output, OutputDistribution, Quantile, Sampling, Sequence, SobolIndices,
    Uncertain,
};
pub use values::{Axis, AxisValues, Interval, Random, Scale};

use folder::Folder;
use status::Sink;

/// Computes a part of a sweep, or its missing points, into a folder, and returns a summary. With `threads` equal to 0 every core
/// of the machine has a thread. `tell` is called with the progress before anything is computed, and then several times a second.
///
/// # Errors
/// A folder that cannot be used, see [`SweepError`]; [`SweepError::Stopped`] after `stop` has become true, which loses no finished
/// row; a part of a sweep whose number of draws depends on its sampling error. Scenes that cannot be solved are rows with an
/// error.
pub fn run(
    sweep: &Sweep,
    part: Part,
    path: &Path,
    threads: usize,
    stop: &AtomicBool,
    tell: &mut dyn FnMut(Status),
) -> Result<Tally, SweepError> {
    sweep.check_part(part)?;
    let mut folder = Folder::open(path, sweep, part)?;
    tell(Status::of(sweep, part, &folder));
    if folder.progress().finished {
        return finish::summary(sweep, part, &mut folder);
    }
    for until in sweep.stages(part) {
        // a finished stage was not sufficient, or is checked again
        if folder.chunks() < until {
            threads::compute(sweep, part, until, &mut folder, threads, stop, tell)?;
        }
        if folder.chunks() == until && finish::is_enough(sweep, part, &folder)? {
            break;
        }
    }
    finish::finish(sweep, part, &mut folder)
}
