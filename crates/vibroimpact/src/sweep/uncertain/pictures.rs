//! Figures of distributions: histogram, cumulative share and indices of one, median and width of those of a grid.

use super::collect::Distributions;
use super::design::Output;
use super::estimate::{Histogram, OutputDistribution};
use crate::plot::{Axis, Colour, Figure, HeatMap, Marker, Panel, Series};
use crate::sweep::definition::Sweep;
use crate::sweep::labels::{axis, axis_of_result, label_and_unit};
use crate::sweep::values::{Axis as Varied, AxisValues, Scale};

/// Largest grid with figures.
const MOST_POINTS: usize = 40_000;

/// The figures of every output, each with a name and a caption.
pub(in crate::sweep) fn figures(sweep: &Sweep, found: &[Distributions]) -> Vec<(String, Figure, String)> {
    let outputs = sweep.uncertain.as_ref().map_or(&[][..], |uncertain| &uncertain.outputs);
    let of_output = |(number, output): (usize, &Output)| {
        let found: Vec<&Option<OutputDistribution>> = found.iter().filter_map(|found| found.get(number)).collect();
        let (name, figure, caption) = of_output(&sweep.axes, &output.name, &found)?;
        let name = if outputs.len() == 1 { name.to_owned() } else { format!("{name}-{}", number + 1) };
        Some((name, figure, caption))
    };
    outputs.iter().enumerate().filter_map(of_output).collect()
}

fn of_output(
    axes: &[Varied],
    output: &str,
    found: &[&Option<OutputDistribution>],
) -> Option<(&'static str, Figure, String)> {
    match (axes, found) {
        ([], [Some(found)]) => Some(of_one(output, found)),
        ([along], _) if along.is_numeric() && found.len() <= MOST_POINTS => Some(over_one(along, output, found)),
        ([y, x], _) if x.is_numeric() && y.is_numeric() && found.len() <= MOST_POINTS => {
            Some(over_two(x, y, output, found))
        }
        _ => None,
    }
}

fn of_one(output: &str, found: &OutputDistribution) -> (&'static str, Figure, String) {
    let Histogram { from, to, counts } = &found.histogram;
    let width = (to - from) / counts.len() as f64;
    let whole = found.histogram.is_of_whole_numbers();
    let all = found.with_value as f64;
    // a step keeps its value up to the next edge
    let edges: Vec<f64> = (0..=counts.len()).map(|i| from + width * i as f64).collect();
    let shares: Vec<f64> = counts.iter().chain(counts.last()).map(|count| *count as f64 / all).collect();
    let below = std::iter::once(0.0).chain(counts.iter().scan(0.0, |sum, count| {
        *sum += *count as f64 / all;
        Some(*sum)
    }));
    let below: Vec<f64> = below.collect();
    let below = if whole {
        // the share rises at the last whole number of an interval
        let numbers: Vec<f64> = std::iter::once(*from).chain(edges[1..].iter().map(|edge| edge - 0.5)).collect();
        Series::step(&numbers, &below)
    } else {
        Series::line(&edges, &below)
    };
    let quantiles = |of: fn(&super::Quantile) -> f64| found.quantiles.iter().map(of).collect::<Vec<_>>();
    let (value, share) = (quantiles(|quantile| quantile.value), quantiles(|quantile| quantile.share));
    // NaN draws no bar
    let error = quantiles(|quantile| 2.0 * quantile.standard_error.unwrap_or(f64::NAN));
    let of_output = || Axis { integers: whole, ..axis_of_result(output) };
    let histogram = Panel::new(of_output(), Axis::new("share of the draws")).with(Series::step(&edges, &shares));
    let cumulative = Panel::new(of_output(), Axis::new("share below").limits(0.0, 1.0))
        .with(below)
        .with(Series::level_error_bars(&value, &share, &error, Marker::Dot).label("quantiles"));
    let title = format!("Distribution of {}", label(output));
    let figure = Figure::new(title).row([histogram, cumulative]).width(860.0);
    let caption = "Left: shares of the draws. Right: the share below a value, and quantiles with two standard errors \
                   either way, where these are known.";
    match &found.indices {
        None => ("distribution", figure, caption.to_owned()),
        Some(indices) => {
            let rows: Vec<f64> = (0..indices.len()).map(|row| -(row as f64)).collect();
            let last = indices.len() as f64;
            let names = indices.keys().zip(&rows).map(|(name, row)| (*row, name.clone()));
            let y = Axis::new("").ticks_at(names).limits(0.5 - last, 0.5);
            let panel = Panel::new(Axis::new("share of the variance"), y).height(60.0 + 30.0 * last);
            let of = |shift: f64, which: fn(&super::SobolIndices) -> super::Estimate, marker| {
                let y: Vec<f64> = rows.iter().map(|row| row + shift).collect();
                let values: Vec<f64> = indices.values().map(|found| which(found).value).collect();
                let errors: Vec<f64> =
                    indices.values().map(|found| 2.0 * which(found).standard_error.unwrap_or(f64::NAN)).collect();
                Series::level_error_bars(&values, &y, &errors, marker)
            };
            let panel = panel
                .with(of(0.12, |found| found.first, Marker::Dot).label("first index"))
                .with(of(-0.12, |found| found.total, Marker::Circle).label("total index"));
            let caption = format!("{caption} Below: indices of Sobol' with two standard errors either way.");
            ("distribution", figure.row([panel]), caption)
        }
    }
}

/// Values along an axis.
fn along(axis: &Varied) -> Vec<f64> {
    (0..axis.count()).map(|number| axis.value(number).as_f64().unwrap_or(f64::NAN)).collect()
}

fn labelled(varied: &Varied) -> Axis {
    let log = matches!(&varied.values, AxisValues::Range(range, _) if range.scale == Scale::Log);
    axis(&varied.field, log, false)
}

fn label(output: &str) -> String {
    axis_of_result(output).label
}

fn at(found: &Option<OutputDistribution>, share: f64) -> f64 {
    found.as_ref().and_then(|found| found.quantile(share)).map_or(f64::NAN, |quantile| quantile.value)
}

fn over_one(varied: &Varied, output: &str, found: &[&Option<OutputDistribution>]) -> (&'static str, Figure, String) {
    let x = along(varied);
    let of = |share: f64| found.iter().map(|found| at(found, share)).collect::<Vec<_>>();
    let panel = Panel::new(labelled(varied), axis_of_result(output))
        .with(Series::band(&x, &of(0.05), &of(0.95)).colour(Colour::Blue).label("9 draws of 10"))
        .with(Series::line(&x, &of(0.5)).colour(Colour::Blue).label("median"));
    let (name, _) = label_and_unit(&varied.field);
    let figure = Figure::new(format!("Predictability of {} over {name}", label(output))).row([panel]).width(720.0);
    ("predictability", figure, "Median of the draws, and the interval that holds nine of ten.".to_owned())
}

fn over_two(
    x: &Varied,
    y: &Varied,
    output: &str,
    found: &[&Option<OutputDistribution>],
) -> (&'static str, Figure, String) {
    let (columns, lines) = (along(x), along(y));
    let map = |title: &str, value: Axis, of: &dyn Fn(&Option<OutputDistribution>) -> f64| {
        let rows = found.chunks(columns.len()).map(|row| row.iter().map(|found| of(found)).collect()).collect();
        let panel = Panel::new(labelled(x), labelled(y)).title(title).height(300.0);
        panel.map(HeatMap::new(&columns, &lines, rows, value))
    };
    let width = |found: &Option<OutputDistribution>| found.as_ref().map_or(f64::NAN, |it| it.width_90.value);
    let panels = [
        map("(a) median", axis_of_result(output), &|found| at(found, 0.5)),
        map("(b) width of the interval of 9 draws of 10", axis_of_result(output), &width),
    ];
    let (name, _) = label_and_unit(&x.field);
    let (other, _) = label_and_unit(&y.field);
    let figure =
        Figure::new(format!("Predictability of {} over {name} and {other}", label(output))).row(panels).width(1000.0);
    let caption =
        "Median of the draws at each point, and the width of the interval from their 5 % to their 95 % quantile.";
    ("predictability", figure, caption.to_owned())
}
