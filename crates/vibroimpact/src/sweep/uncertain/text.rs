//! A distribution as text.

use std::fmt::Write;

use super::estimate::OutputDistribution;
use super::figure::Estimate;
use crate::text::significant;

/// Width of the labels (characters).
const NAMES: usize = 22;

/// A statistic with its standard error, to the significant digits.
fn told(figure: Estimate) -> String {
    let Estimate { value, standard_error } = figure;
    match standard_error {
        Some(error) if error > 0.0 => {
            // two digits of the error, as many decimals of the figure
            let order = error.log10().floor();
            match (1.0 - order) as usize {
                decimals @ ..16 => format!("{value:.decimals$} ± {error:.decimals$}"),
                _ => {
                    let decimals = (value.abs().log10().floor() - order + 1.0).min(16.0) as usize;
                    format!("{value:.decimals$e} ± {error:.1e}")
                }
            }
        }
        Some(_) => significant(value, 6),
        None => format!("{}, standard error unknown", significant(value, 6)),
    }
}

/// The lines on the distribution of an output.
pub(in crate::sweep) fn text(output: &str, found: &OutputDistribution) -> String {
    let mut lines = String::new();
    // writing to a String cannot fail
    let mut line = |name: &str, text: String| {
        let gap = if name.len() < NAMES { "" } else { "  " };
        let _ = writeln!(lines, "  {name:<NAMES$}{gap}{text}");
    };
    let OutputDistribution { draws, with_value, quantiles, indices, .. } = found;
    line(output, format!("of {with_value} of {draws} draws; every figure ± its standard error"));
    if let (Some(requested), Some(false)) = (found.requested_error, found.reached) {
        let largest = match found.largest_error() {
            error if error.is_finite() => format!("the largest standard error is {}", significant(error, 2)),
            _ => "the draws are too few to know every standard error".to_owned(),
        };
        let told = format!("NOT REACHED: {largest}, and {requested} was requested; allow more draws (sampling.draws)");
        line("sampling error", told);
    }
    line("mean", told(found.mean));
    line("standard deviation", told(found.standard_deviation));
    for quantile in quantiles {
        let figure = Estimate { value: quantile.value, standard_error: quantile.standard_error };
        line(&format!("{} % below", 100.0 * quantile.share), told(figure));
    }
    for (field, indices) in indices.iter().flatten() {
        line(field, format!("first index {}, total {}", told(indices.first), told(indices.total)));
    }
    match found.index_groups {
        Some(groups @ 1..) if indices.is_none() => {
            line("indices", format!("not defined, because {output} does not vary in {groups} groups of draws"));
        }
        Some(groups) if with_value < draws => {
            line("indices", format!("of the {groups} groups of draws in which every draw has a value"));
        }
        _ => {}
    }
    lines
}
