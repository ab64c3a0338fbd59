//! Figures of a sweep: lines over one quantity, maps over two, points over random draws.

use std::ops::RangeInclusive;

use serde_json::Value;

use super::definition::Sweep;
use super::labels::{axis, label_and_unit, short};
use super::quantities::{Drawn, MOTION, QUANTITIES, Quantity, median, motion_number, of_results, quantile, ranked};
use super::row::Row;
use super::values::{Axis as Varied, AxisValues, Scale};
use crate::plot::{Axis, Figure, HeatMap, Marker, Panel, Series};

/// Largest number of points of a sweep with figures.
const MOST_POINTS: u64 = 1_000_000;
/// Largest number of lines or maps in one figure.
const MOST_CURVES: u64 = 6;
/// Largest number of values along a line, and along either side of a map; from more values this number is selected evenly.
const ALONG_LINE: u64 = 2000;
const ALONG_MAP: u64 = 150;
/// Largest number of points that are drawn individually.
const MOST_DOTS: u64 = 4000;
/// Quantiles at the limits of a band.
const BAND: RangeInclusive<f64> = 0.05..=0.95;

/// Caption for curves that are not drawn as lines.
const UNRESOLVED: &str = " Points that alternate irregularly are not joined, and have bars for bands: finer \
                          steps would show what lies between them.";
/// A curve that changes its direction at more than this share of its points is not resolved.
const TURNING: f64 = 0.25;
/// Smallest number of points for this decision.
const FEWEST: usize = 8;
/// Smaller alternating steps do not count, as a share of the range of all points.
const JUMP: f64 = 0.02;

/// One marker for each curve, so that overlapping points can be distinguished.
const MARKERS: [Marker; MOST_CURVES as usize] =
    [Marker::Dot, Marker::Circle, Marker::Cross, Marker::Square, Marker::Triangle, Marker::Plus];

/// Longest description above a figure.
const LONGEST_TITLE: usize = 90;

/// The results for the figures.
pub(super) struct Pictures<'a> {
    sweep: &'a Sweep,
    quantities: Vec<Quantity>,
    /// Name of the drawn results, at the start of a title.
    name: &'static str,
    /// `None` if the sweep is too large.
    points: Option<Vec<Drawn>>,
    /// The motions to which runs have converged, numbered in the order in which they occur, and their counts.
    motions: Vec<(String, u64)>,
}

/// A value along an axis, and its position.
struct Place {
    number: u64,
    at: f64,
}

impl<'a> Pictures<'a> {
    pub(super) fn new(sweep: &'a Sweep) -> Pictures<'a> {
        let (name, quantities) = of_results(sweep.results());
        let points = (sweep.points() <= MOST_POINTS).then(Vec::new);
        Pictures { sweep, quantities, name, points, motions: Vec::new() }
    }

    pub(super) fn add(&mut self, _point: u64, row: &Row) {
        let Some(points) = &mut self.points else { return };
        let mut drawn = Drawn { values: [f64::NAN; QUANTITIES], uncertainty: f64::NAN };
        for (value, quantity) in drawn.values.iter_mut().zip(&self.quantities) {
            *value = match quantity.column {
                MOTION => motion_number(&mut self.motions, row.motion()),
                column => row.number(column).unwrap_or(f64::NAN),
            };
        }
        let uncertainty = self.quantities.first().and_then(|first| first.uncertainty);
        drawn.uncertainty = uncertainty.and_then(|column| row.number(column)).unwrap_or(f64::NAN);
        points.push(drawn);
    }

    /// The figures, each with a name and a caption.
    pub(super) fn figures(mut self) -> Vec<(&'static str, Figure, String)> {
        self.sort_motions();
        let Some(points) = &self.points else { return Vec::new() };
        let axes = &self.sweep.axes;
        let mut numeric = (0..axes.len()).filter(|&i| axes[i].is_numeric());
        match (numeric.next(), numeric.next()) {
            (Some(x), Some(y)) => vec![self.maps(points, x, y)],
            (Some(x), None) => vec![self.lines(points, x)],
            _ if !axes.is_empty() => vec![self.lines(points, 0)],
            _ => vec![self.dots(points)],
        }
    }

    /// Numbers motions in the order of their periods and intervals, and gives the axis their names. They are not drawn if there are
    /// none, or if there are several draws, for which motions have no median.
    fn sort_motions(&mut self) {
        if self.motions.is_empty() || self.sweep.draws() > 1 {
            self.quantities.retain(|quantity| quantity.column != MOTION);
            return;
        }
        let (numbers, names) = ranked(&self.motions);
        let place = self.quantities.iter().position(|quantity| quantity.column == MOTION);
        let (Some(place), Some(points)) = (place, &mut self.points) else { return };
        for drawn in points {
            let value = &mut drawn.values[place];
            // NaN means that there is no number
            *value = numbers.get(*value as usize).filter(|_| !value.is_nan()).map_or(f64::NAN, |number| *number as f64);
        }
        let last = names.len() as f64;
        let ticks = names.into_iter().enumerate().map(|(number, name)| (number as f64, name));
        let axis = Axis::new("motion, intervals/periods").ticks_at(ticks).limits(-0.5, last - 0.5);
        self.quantities[place].axis = axis;
    }

    fn lines(&self, points: &[Drawn], along: usize) -> (&'static str, Figure, String) {
        let places = self.along(along, ALONG_LINE);
        let x: Vec<f64> = places.iter().map(|place| place.at).collect();
        let others = self.others(&[along]);
        let mut unresolved = false;
        let title = format!("{} against {}", self.name, label_and_unit(&self.sweep.axes[along].field).0);
        let mut figure = Figure::new(self.title(&title));
        for (quantity, Quantity { column, axis, .. }) in self.quantities.iter().enumerate() {
            let counted = axis.integers || *column == MOTION;
            let mut panel = Panel::new(self.axis(along), axis.clone());
            for (number, other) in others.iter().enumerate() {
                let at = |place: &Place| self.at(points, other, &[(along, place.number)]);
                let spread: Vec<[f64; 3]> = places.iter().map(|place| self.spread(at(place), quantity)).collect();
                let of = |k: usize| spread.iter().map(|value| value[k]).collect::<Vec<f64>>();
                let colour = crate::plot::Colour::of_series(number);
                let marker = MARKERS[number % MARKERS.len()];
                let middle = of(1);
                // points that alternate irregularly are not joined, since the curve between them is unknown
                let jumps = !counted && !is_resolved(&middle);
                unresolved |= jumps;
                let series = match counted || jumps {
                    true => Series::points(&x, &middle, marker),
                    false => Series::line(&x, &middle),
                };
                if jumps {
                    // points that are not joined have bars
                    let across: Vec<f64> = x.iter().flat_map(|&x| [x, x, f64::NAN]).collect();
                    let up: Vec<f64> = spread.iter().flat_map(|[low, _, high]| [*low, *high, f64::NAN]).collect();
                    panel = panel.with(Series::line(&across, &up).colour(colour));
                } else if !counted {
                    panel = panel.with(Series::band(&x, &of(0), &of(2)).colour(colour));
                }
                panel = panel.with(series.colour(colour).label(self.name(other, &[along])));
            }
            figure = figure.row([if quantity == 0 { panel.height(240.0) } else { panel }]);
        }
        let shown = self.told(&[along], others.len(), x.len() as u64);
        let joined = if unresolved { UNRESOLVED } else { "" };
        ("lines", figure, format!("{}{joined} {shown}", self.told_band()).trim().to_owned())
    }

    fn maps(&self, points: &[Drawn], x: usize, y: usize) -> (&'static str, Figure, String) {
        let (columns, lines) = (self.along(x, ALONG_MAP), self.along(y, ALONG_MAP));
        let centres = |places: &[Place]| places.iter().map(|place| place.at).collect::<Vec<f64>>();
        let (xs, ys) = (centres(&columns), centres(&lines));
        let [across, up] = [x, y].map(|axis| label_and_unit(&self.sweep.axes[axis].field).0);
        let mut figure = Figure::new(self.title(&format!("{} over {across} and {up}", self.name)));
        let others = self.others(&[x, y]);
        for other in &others {
            let name = self.name(other, &[x, y]);
            figure = figure.row(self.quantities.iter().enumerate().map(|(quantity, Quantity { axis, .. })| {
                let cell = |line: &Place, column: &Place| {
                    median(self.at(points, other, &[(x, column.number), (y, line.number)]), quantity)
                };
                let rows = lines.iter().map(|line| columns.iter().map(|column| cell(line, column)).collect()).collect();
                let map = HeatMap::new(&xs, &ys, rows, axis.clone());
                Panel::new(self.axis(x), self.axis(y)).title(name.clone()).height(300.0).map(map)
            }));
        }
        let shown = self.told(&[x, y], others.len(), xs.len().max(ys.len()) as u64);
        let draws = if self.sweep.draws() > 1 { " Medians over the draws." } else { "" };
        let grey = self.quantities.first().map_or("", |first| first.axis.label.as_str());
        let width = 540.0 * self.quantities.len() as f64;
        ("maps", figure.width(width), format!("Grey: no {grey}.{draws} {shown}").trim().to_owned())
    }

    fn dots(&self, points: &[Drawn]) -> (&'static str, Figure, String) {
        let picked = evenly(self.sweep.points(), MOST_DOTS);
        let values: Vec<Vec<Value>> = picked.iter().map(|&point| self.sweep.values(point)).collect();
        let y: Vec<f64> = picked.iter().map(|&point| points[point as usize].values[0]).collect();
        let value = self.quantities.first().map_or_else(|| Axis::new(""), |first| first.axis.clone());
        let mut figure = Figure::new(self.title(&format!("{} of random draws", self.name)));
        let fields = self.sweep.random.iter().flat_map(|random| &random.fields);
        let panels: Vec<Panel> = fields
            .enumerate()
            .map(|(i, (field, interval))| {
                let x: Vec<f64> = values.iter().map(|values| values[i].as_f64().unwrap_or(f64::NAN)).collect();
                let axis = axis(field, interval.scale == Scale::Log, interval.whole_numbers);
                Panel::new(axis, value.clone()).with(Series::points(&x, &y, Marker::Dot))
            })
            .collect();
        for pair in panels.chunks(2) {
            figure = figure.row(pair.to_vec());
        }
        let shown = if (picked.len() as u64) < self.sweep.points() { "picked evenly" } else { "all of them" };
        ("draws", figure, format!("{} draws, {shown}.", picked.len()))
    }

    /// The values along an axis, ascending.
    fn along(&self, axis: usize, most: u64) -> Vec<Place> {
        let varied = &self.sweep.axes[axis];
        let place = |number: u64| {
            let value = if varied.is_numeric() { varied.value(number).as_f64() } else { Some(number as f64) };
            Place { number, at: value.unwrap_or(f64::NAN) }
        };
        let mut places: Vec<Place> = evenly(varied.count(), most).into_iter().map(place).collect();
        places.sort_by(|a, b| a.at.total_cmp(&b.at));
        places.dedup_by(|a, b| a.at == b.at);
        places
    }

    /// The values of the other axes for each separate curve or map: for each axis the number of the value; those of the axes
    /// `taken` are not used.
    fn others(&self, taken: &[usize]) -> Vec<Vec<u64>> {
        let axes = &self.sweep.axes;
        let free = (0..axes.len()).filter(|axis| !taken.contains(axis));
        let combinations: u64 = free.clone().map(|axis| axes[axis].count()).product();
        let combination = |number: u64| {
            let mut rest = number;
            let mut places = vec![0; axes.len()];
            for axis in free.clone().rev() {
                places[axis] = rest % axes[axis].count();
                rest /= axes[axis].count();
            }
            places
        };
        evenly(combinations, MOST_CURVES).into_iter().map(combination).collect()
    }

    /// All draws at a point of the grid.
    fn at<'p>(&self, points: &'p [Drawn], other: &[u64], taken: &[(usize, u64)]) -> &'p [Drawn] {
        let grid = self.sweep.axes.iter().enumerate().fold(0, |grid, (i, axis)| {
            let place = taken.iter().find(|(taken, _)| *taken == i).map_or(other[i], |(_, place)| *place);
            grid * axis.count() + place
        });
        let first = (grid * self.sweep.draws()) as usize;
        points.get(first..first + self.sweep.draws() as usize).unwrap_or_default()
    }

    /// Lower edge of the band, line, upper edge.
    fn spread(&self, draws: &[Drawn], quantity: usize) -> [f64; 3] {
        match draws {
            [one] => {
                let known = quantity == 0 && one.uncertainty.is_finite();
                let (value, error) = (one.values[quantity], if known { one.uncertainty } else { 0.0 });
                [value - error, value, value + error]
            }
            many => [*BAND.start(), 0.5, *BAND.end()].map(|share| quantile(many, share, quantity)),
        }
    }

    fn axis(&self, number: usize) -> Axis {
        let Varied { field, values } = &self.sweep.axes[number];
        match values {
            AxisValues::Range(interval, _) => axis(field, interval.scale == Scale::Log, interval.whole_numbers),
            AxisValues::List(values) if self.sweep.axes[number].is_numeric() => {
                axis(field, false, values.iter().all(|value| value.is_u64() || value.is_i64()))
            }
            AxisValues::List(values) => {
                let ticks = values.iter().enumerate().map(|(i, value)| (i as f64, short(value)));
                axis(field, false, false).ticks_at(ticks).limits(-0.5, values.len() as f64 - 0.5)
            }
        }
    }

    /// The values of the axes that are not taken, as text.
    fn name(&self, other: &[u64], taken: &[usize]) -> String {
        let axes = self.sweep.axes.iter().enumerate().filter(|(i, _)| !taken.contains(i));
        let names = axes.map(|(i, axis)| {
            let (label, unit) = label_and_unit(&axis.field);
            let value = axis.value(other[i]);
            let value = value.as_f64().map_or_else(|| short(&value), |number| crate::text::significant(number, 4));
            format!("{label} {value} {unit}").trim_end().to_owned()
        });
        names.collect::<Vec<_>>().join(", ")
    }

    fn title(&self, otherwise: &str) -> String {
        let title = self.sweep.description.as_ref().filter(|text| text.chars().count() <= LONGEST_TITLE);
        title.map_or(otherwise, String::as_str).to_owned()
    }

    fn told_band(&self) -> &'static str {
        if self.sweep.draws() > 1 {
            "Medians over the draws; bands hold nine tenths of them."
        } else if self.quantities.iter().all(|quantity| quantity.uncertainty.is_none()) {
            ""
        } else {
            "Bands are the stated uncertainty of the restitution, mostly too narrow to be seen."
        }
    }

    /// Description of the parts of the sweep that are not in the figure.
    fn told(&self, taken: &[usize], curves: usize, along: u64) -> String {
        let axes = &self.sweep.axes;
        let combinations: u64 =
            (0..axes.len()).filter(|axis| !taken.contains(axis)).map(|axis| axes[axis].count()).product();
        let mut told = Vec::new();
        if combinations > curves as u64 {
            told.push(format!("{curves} of {combinations} combinations of the other fields."));
        }
        if taken.iter().any(|&axis| axes[axis].count() > along) {
            told.push("Not every value along the axes is drawn.".to_owned());
        }
        told.join(" ")
    }
}

/// Numbers below `count`: all of them, or a selection that is evenly spread and includes the first and the last.
fn evenly(count: u64, most: u64) -> Vec<u64> {
    let picked = count.min(most);
    // both at most MOST_POINTS
    (0..picked).map(|i| i * (count - 1) / (picked - 1).max(1)).collect()
}

/// Whether points that follow each other may be joined by lines.
fn is_resolved(values: &[f64]) -> bool {
    let known: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    if known.len() < FEWEST {
        return true;
    }
    let (low, high) = known.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    let jump = JUMP * (high - low);
    let turns = known.windows(3).filter(|w| {
        let (before, after) = (w[1] - w[0], w[2] - w[1]);
        before * after < 0.0 && before.abs() > jump && after.abs() > jump
    });
    turns.count() as f64 <= TURNING * known.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_that_jumps_to_and_fro_is_not_joined() {
        let curve = |of: fn(f64) -> f64| (0..40).map(|i| of(f64::from(i))).collect::<Vec<f64>>();
        assert!(is_resolved(&curve(|x| (0.3 * x).sin())));
        assert!(!is_resolved(&curve(|x| (2.5 * x).sin())));
        // rounding on a smooth curve does not count
        assert!(is_resolved(&curve(|x| x + 1e-9 * (2.5 * x).sin())));
        assert!(is_resolved(&[0.0, 1.0, 0.0, 1.0]));
    }

    #[test]
    fn picked_numbers_hold_the_ends() {
        assert_eq!(evenly(5, 10), [0, 1, 2, 3, 4]);
        assert_eq!(evenly(101, 3), [0, 50, 100]);
        assert_eq!(evenly(1, 3), [0]);
    }
}
