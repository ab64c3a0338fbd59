//! Sweeps: many scenes that differ in some fields, computed on all cores, in parts on many machines, or over the ranks
//! of an MPI job, with the same bytes as a result.
//!
//! A [`Sweep`] is a base scene and the fields that vary. Its points are numbered, and each is a function of its number
//! alone. [`run`] computes them into a folder; after an interruption at any moment, another run continues from there.
//! [`merge`] makes the folder of a whole sweep from those of its parts.
//!
//! | file | what it holds |
//! |---|---|
//! | `results.csv` | one row for each point: `index`, the varied fields, the result, its cost, `error` if there is none |
//! | `results.parquet` | the same, typed and compressed |
//! | `report.html`, `report.md`, `figures/` | the varied fields, the results, pictures |
//! | `distribution.csv` | of a sweep with uncertain fields: figures of the outputs at each grid point |
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

/// Computes a part of a sweep into a folder, or what is missing of it there, and says what came out. `threads` of 0
/// stands for as many as the machine has cores. `tell` hears how far it has come, first before anything is computed,
/// and then several times a second.
///
/// # Errors
/// A folder that cannot be used, as [`SweepError`] says; [`SweepError::Stopped`] after `stop` has become true, which
/// loses nothing that was finished; a part of a sweep that ends by itself once its sampling error is small enough. Scenes
/// that cannot be solved are rows.
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
        return finish::summary(&folder);
    }
    for until in sweep.stages(part) {
        // a stage that is over was not enough, or it is asked anew
        if folder.chunks() < until {
            threads::compute(sweep, part, until, &mut folder, threads, stop, tell)?;
        }
        if folder.chunks() == until && finish::is_enough(sweep, part, &folder)? {
            break;
        }
    }
    finish::finish(sweep, part, &mut folder)
}
