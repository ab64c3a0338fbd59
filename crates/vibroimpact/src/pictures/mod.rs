//! The figures of the commands: an impact ([`impact`], and [`crate::infinite::picture`] for infinite structures), the modes of a
//! structure ([`modes`]), its motion ([`animation`]), and a comparison of several models ([`comparison`], [`of_comparison`]).
//!
//! Axes are in SI units with prefixes, whatever the scale of the impact.

mod animation;
mod comparison;
mod impact;
mod modes;

pub use animation::animation;
pub use comparison::{comparison, of_answer, of_comparison};
pub use impact::impact;
pub use modes::modes;

use crate::plot::{Axis, Colour, Marker, Panel, Series};

/// Largest number of contacts that are numbered in a figure; more numbers would hide the curves.
const NUMBERED: usize = 20;
/// Peaks that differ by more than this ratio are drawn on a logarithmic axis.
const WIDE_PEAKS: f64 = 100.0;

/// Largest force of a contact, and when it is reached.
pub(crate) struct Peak {
    pub time: f64,
    pub force: f64,
}

/// The contact force with every contact's peak marked, and numbered if they are few. If weak contacts would not be visible beside
/// strong ones, the axis is logarithmic.
pub(crate) fn force_panel(time_axis: Axis, unit: &str, time: &[f64], force: &[f64], peaks: &[Peak]) -> Panel {
    let times: Vec<f64> = peaks.iter().map(|peak| peak.time).collect();
    let forces: Vec<f64> = peaks.iter().map(|peak| peak.force).collect();
    let positive = || forces.iter().copied().filter(|force| *force > 0.0);
    let (low, high) = (positive().fold(f64::INFINITY, f64::min), positive().fold(0.0, f64::max));
    let axis = Axis::new("contact force").unit(unit);
    // room for the numbers above the peaks
    let axis = match (low < high / WIDE_PEAKS, high > 0.0) {
        (true, _) => axis.log().limits(0.1 * low, high * (high / low).powf(0.15)),
        (false, true) => axis.limits(0.0, 1.2 * high),
        (false, false) => axis,
    };
    // a force of zero has no logarithm, so the line leaves the figure at its lower edge
    let lowest = if axis.logarithmic { 1e-3 * low } else { f64::NEG_INFINITY };
    let force: Vec<f64> = force.iter().map(|force| force.max(lowest)).collect();
    let few = peaks.len() <= NUMBERED;
    let panel = Panel::new(time_axis, axis)
        .height(140.0)
        .with(Series::line(time, &force).colour(Colour::Black).line_width(if few { 1.0 } else { 0.5 }))
        .with(Series::points(&times, &forces, Marker::Dot).colour(Colour::Vermilion));
    if few { panel.with(Series::labels(&times, &forces, (1..=peaks.len()).map(|n| n.to_string()))) } else { panel }
}
