//! Methods on equal steps whose memory is a discrete convolution, summed by fast Fourier transforms.
//!
//! Each segment between breaks has its own step. Inside a segment the sums over the past are split recursively
//! (Hairer, Lubich & Schlichte 1985): when the first half of a block is known, its effect on the second half is one
//! convolution. The cost of `n` steps is `O(n log^2 n)`. Earlier segments act by direct sums.

mod fft;
mod march;
mod past;
mod scheme;
mod weights;

use crate::dense::Dense;
use crate::problem::Volterra;
use crate::recorder::Recorder;
use crate::solution::{Counts, Solution, Stop};
use crate::system::{System, require_steps};
use invalid_input::InvalidInput;
use march::March;
use past::Past;

pub(crate) use fft::product;
pub(crate) use scheme::Scheme;

/// Settings of the methods on equal steps.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Convolution {
    /// Number of steps, distributed over the segments between breaks by their length, at least 8 each if there are several; 1
    /// to 4194304, default 1000.
    pub steps: usize,
}

impl Default for Convolution {
    fn default() -> Self {
        Convolution { steps: 1000 }
    }
}

pub(crate) fn run(
    problem: &Volterra<'_>,
    scheme: Scheme,
    settings: &Convolution,
    t_end: f64,
) -> Result<Solution, InvalidInput> {
    let mut system = System::new(problem, t_end)?;
    require_steps(settings.steps, &system)?;
    let mut recorder = Recorder::new(problem, Dense::grid(system.unknowns, scheme.degree()));
    let mut past = Past::new(&system.orders, system.densities, scheme.start_corrections(&system.orders));
    let mut counts = Counts::default();
    let mut stop = Stop::EndReached;
    for segment in system.segments.clone() {
        let share = settings.steps as f64 * (segment.length() / t_end);
        let least = if system.segments.len() == 1 { 1 } else { 8 };
        let steps = (share.round() as usize).max(least);
        let march = March::new(&mut system, &mut recorder, &past, scheme, segment, steps);
        let (finished, f) = march.run();
        past.push(segment, f);
        counts.steps = recorder.dense.times().len().saturating_sub(system.segments.len()) as u64;
        if let Err(reason) = finished {
            stop = reason;
            break;
        }
    }
    counts.history_values = past.len() as u64;
    Ok(recorder.finish(stop, &system, counts))
}
