//! Pictures of a sweep: lines over one quantity, maps over two, points over what was drawn at random.

use std::ops::RangeInclusive;

use serde_json::Value;

use super::definition::Sweep;
use super::path::FieldPath;
use super::row::{Row, cell};
use super::values::{Axis as Varied, AxisValues, Scale};
use crate::plot::{Axis, Figure, HeatMap, Marker, Panel, Series};

/// Larger sweeps have no pictures: a person looks at a part of them.
const MOST_POINTS: u64 = 1_000_000;
/// Lines or maps in one picture.
const MOST_CURVES: u64 = 6;
/// Values along a line, and along either side of a map; of more, as many are picked evenly.
const ALONG_LINE: u64 = 2000;
const ALONG_MAP: u64 = 150;
/// Points that are drawn for themselves.
const MOST_DOTS: u64 = 4000;
/// The share of the draws within a band is that between these quantiles.
const BAND: RangeInclusive<f64> = 0.05..=0.95;

/// Under curves that are not drawn as lines.
const UNRESOLVED: &str = " Points that jump to and fro are not joined: finer steps would show what lies between them.";
/// A curve that turns round at more than this share of its points is not resolved by them.
const TURNING: f64 = 0.25;
/// Fewer points say nothing about that.
const FEWEST: usize = 8;
/// Smaller steps to and fro are no jumps; as a share of the range of all points.
const JUMP: f64 = 0.02;

/// One for each curve, so that points in one place are told apart.
const MARKERS: [Marker; MOST_CURVES as usize] =
    [Marker::Dot, Marker::Circle, Marker::Cross, Marker::Square, Marker::Triangle, Marker::Plus];

/// A longer description does not fit over a picture.
const LONGEST_TITLE: usize = 90;

/// What is drawn of one point; not a number where there is none.
#[derive(Debug, Clone, Copy)]
struct Drawn {
    restitution: f64,
    uncertainty: f64,
    sub_impacts: f64,
}

/// A quantity of a map, and the axis of its colours.
type Quantity = (fn(&Drawn) -> f64, Axis);

/// The results that pictures need.
pub(super) struct Pictures<'a> {
    sweep: &'a Sweep,
    /// `None` if the sweep is too large.
    points: Option<Vec<Drawn>>,
}

/// A value along an axis, and where it stands there.
struct Place {
    number: u64,
    at: f64,
}

impl<'a> Pictures<'a> {
    pub(super) fn new(sweep: &'a Sweep) -> Pictures<'a> {
        Pictures { sweep, points: (sweep.points() <= MOST_POINTS).then(Vec::new) }
    }

    pub(super) fn add(&mut self, _point: u64, row: &Row) {
        if let Some(points) = &mut self.points {
            let number = |name: &str| row.number(name).unwrap_or(f64::NAN);
            points.push(Drawn {
                restitution: number("restitution"),
                uncertainty: number("restitution_uncertainty"),
                sub_impacts: number("sub_impact_count"),
            });
        }
    }

    /// The pictures, each with a name and a caption.
    pub(super) fn figures(self) -> Vec<(&'static str, Figure, String)> {
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

    fn lines(&self, points: &[Drawn], along: usize) -> (&'static str, Figure, String) {
        let places = self.along(along, ALONG_LINE);
        let x: Vec<f64> = places.iter().map(|place| place.at).collect();
        let mut restitution = Panel::new(self.axis(along), Axis::new("restitution"));
        let mut sub_impacts = Panel::new(self.axis(along), Axis::new("sub-impacts").integers());
        let others = self.others(&[along]);
        let mut unresolved = false;
        for (number, other) in others.iter().enumerate() {
            let at = |place: &Place| self.at(points, other, &[(along, place.number)]);
            let spread: Vec<[f64; 3]> = places.iter().map(|place| self.spread(at(place))).collect();
            let column = |k: usize| spread.iter().map(|value| value[k]).collect::<Vec<f64>>();
            let counts: Vec<f64> = places.iter().map(|place| median(at(place), |drawn| drawn.sub_impacts)).collect();
            let colour = crate::plot::Colour::of_series(number);
            let marker = MARKERS[number % MARKERS.len()];
            let label = self.name(other, &[along]);
            let band = Series::band(&x, &column(0), &column(2)).colour(colour);
            let middle = column(1);
            // points that jump to and fro do not tell what lies between them
            let line = if is_resolved(&middle) {
                Series::line(&x, &middle)
            } else {
                unresolved = true;
                Series::points(&x, &middle, marker)
            };
            restitution = restitution.with(band).with(line.colour(colour).label(label.clone()));
            sub_impacts = sub_impacts.with(Series::points(&x, &counts, marker).colour(colour).label(label));
        }
        let title = self.title(&format!("Restitution against {}", label_and_unit(&self.sweep.axes[along].field).0));
        let figure = Figure::new(title).row([restitution.height(240.0)]).row([sub_impacts]);
        let shown = self.told(&[along], others.len(), x.len() as u64);
        let joined = if unresolved { UNRESOLVED } else { "" };
        ("lines", figure, format!("{}{joined} {shown}", self.told_band()))
    }

    fn maps(&self, points: &[Drawn], x: usize, y: usize) -> (&'static str, Figure, String) {
        let (columns, lines) = (self.along(x, ALONG_MAP), self.along(y, ALONG_MAP));
        let centres = |places: &[Place]| places.iter().map(|place| place.at).collect::<Vec<f64>>();
        let (xs, ys) = (centres(&columns), centres(&lines));
        let [across, up] = [x, y].map(|axis| label_and_unit(&self.sweep.axes[axis].field).0);
        let mut figure = Figure::new(self.title(&format!("Restitution and sub-impacts over {across} and {up}")));
        let others = self.others(&[x, y]);
        let quantities: [Quantity; 2] = [
            (|drawn| drawn.restitution, Axis::new("restitution")),
            (|drawn| drawn.sub_impacts, Axis::new("sub-impacts").integers()),
        ];
        for other in &others {
            let name = self.name(other, &[x, y]);
            figure = figure.row(quantities.clone().map(|(of, value)| {
                let cell = |line: &Place, column: &Place| {
                    median(self.at(points, other, &[(x, column.number), (y, line.number)]), of)
                };
                let rows = lines.iter().map(|line| columns.iter().map(|column| cell(line, column)).collect()).collect();
                let map = HeatMap::new(&xs, &ys, rows, value);
                Panel::new(self.axis(x), self.axis(y)).title(name.clone()).height(300.0).map(map)
            }));
        }
        let shown = self.told(&[x, y], others.len(), xs.len().max(ys.len()) as u64);
        let draws = if self.sweep.draws() > 1 { " Medians over the draws." } else { "" };
        ("maps", figure.width(1080.0), format!("Grey: no restitution.{draws} {shown}"))
    }

    fn dots(&self, points: &[Drawn]) -> (&'static str, Figure, String) {
        let picked = evenly(self.sweep.points(), MOST_DOTS);
        let values: Vec<Vec<Value>> = picked.iter().map(|&point| self.sweep.values(point)).collect();
        let y: Vec<f64> = picked.iter().map(|&point| points[point as usize].restitution).collect();
        let mut figure = Figure::new(self.title("Restitution of random draws"));
        let fields = self.sweep.random.iter().flat_map(|random| &random.fields);
        let panels: Vec<Panel> = fields
            .enumerate()
            .map(|(i, (field, interval))| {
                let x: Vec<f64> = values.iter().map(|values| values[i].as_f64().unwrap_or(f64::NAN)).collect();
                let axis = axis(field, interval.scale == Scale::Log, interval.whole_numbers);
                Panel::new(axis, Axis::new("restitution")).with(Series::points(&x, &y, Marker::Dot))
            })
            .collect();
        for pair in panels.chunks(2) {
            figure = figure.row(pair.to_vec());
        }
        let shown = if (picked.len() as u64) < self.sweep.points() { "picked evenly" } else { "all of them" };
        ("draws", figure, format!("{} draws, {shown}.", picked.len()))
    }

    /// The values along an axis, rising.
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

    /// The values of the other axes for which a curve or a map of its own is drawn: for each axis the number of the
    /// value, of which those of `taken` mean nothing.
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
    fn spread(&self, draws: &[Drawn]) -> [f64; 3] {
        match draws {
            [one] => {
                let error = if one.uncertainty.is_finite() { one.uncertainty } else { 0.0 };
                [one.restitution - error, one.restitution, one.restitution + error]
            }
            many => [*BAND.start(), 0.5, *BAND.end()].map(|share| quantile(many, share, |drawn| drawn.restitution)),
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
            let value = value.as_f64().map_or_else(|| short(&value), |number| crate::report::significant(number, 4));
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
        } else {
            "Bands are the stated uncertainty of the restitution, mostly too narrow to be seen."
        }
    }

    /// What of the sweep is not in the picture.
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

/// Numbers below `count`, all of them or as many as asked for, evenly spread, the first and the last among them.
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

fn median(draws: &[Drawn], of: fn(&Drawn) -> f64) -> f64 {
    quantile(draws, 0.5, of)
}

/// The value below which a share of those draws lie that have one.
fn quantile(draws: &[Drawn], share: f64, of: fn(&Drawn) -> f64) -> f64 {
    let mut values: Vec<f64> = draws.iter().map(of).filter(|value| !value.is_nan()).collect();
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1);
    values.get((share * last as f64).round() as usize).copied().unwrap_or(f64::NAN)
}

fn axis(field: &FieldPath, log: bool, integers: bool) -> Axis {
    let (label, unit) = label_and_unit(field);
    Axis { logarithmic: log, integers, ..Axis::new(label).unit(unit) }
}

/// A value as a short text.
fn short(value: &Value) -> String {
    let name = ["law", "kind", "description"].iter().find_map(|key| value.get(key)?.as_str());
    name.map_or_else(|| cell(value), str::to_owned).chars().take(24).collect()
}

/// Units by the end of a field's name, longer ends first.
const UNITS: [(&str, &str); 14] = [
    ("_n_m1_5", "N/m^1.5"),
    ("_kg_m3", "kg/m³"),
    ("_n_m2", "N m²"),
    ("_n_s_m", "N s/m"),
    ("_kg_m", "kg/m"),
    ("_rad_s", "rad/s"),
    ("_n_m", "N/m"),
    ("_m_s", "m/s"),
    ("_m_n", "m/N"),
    ("_s_m", "s/m"),
    ("_pa", "Pa"),
    ("_kg", "kg"),
    ("_m", "m"),
    ("_s", "s"),
];

/// What an axis is called: `striker.mass_kg` is `striker mass` in `kg`.
fn label_and_unit(field: &FieldPath) -> (String, &'static str) {
    let path = field.to_string();
    let path = path.strip_prefix("structure.").unwrap_or(&path);
    // theta_m of the hysteretic law is a mean, not a length
    let unit = UNITS.iter().find(|(end, _)| path.ends_with(end) && !path.ends_with("theta_m"));
    let (name, unit) = unit.map_or((path, ""), |(end, unit)| (&path[..path.len() - end.len()], *unit));
    (name.replace(['.', '_'], " "), unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_become_labels_with_units() {
        let of = |text: &str| label_and_unit(&FieldPath::parse(text).unwrap());
        assert_eq!(of("striker.mass_kg"), ("striker mass".into(), "kg"));
        assert_eq!(of("location_m"), ("location".into(), "m"));
        assert_eq!(of("structure.segments[0].density_kg_m3"), ("segments[0] density".into(), "kg/m³"));
        assert_eq!(of("contact.stiffness_n_m1_5"), ("contact stiffness".into(), "N/m^1.5"));
        assert_eq!(of("contact.theta_m"), ("contact theta m".into(), ""));
        assert_eq!(of("modes"), ("modes".into(), ""));
    }

    #[test]
    fn a_curve_that_jumps_to_and_fro_is_not_joined() {
        let curve = |of: fn(f64) -> f64| (0..40).map(|i| of(f64::from(i))).collect::<Vec<f64>>();
        assert!(is_resolved(&curve(|x| (0.3 * x).sin())));
        assert!(!is_resolved(&curve(|x| (2.5 * x).sin())));
        // noise of rounding on a smooth curve is no jump
        assert!(is_resolved(&curve(|x| x + 1e-9 * (2.5 * x).sin())));
        assert!(is_resolved(&[0.0, 1.0, 0.0, 1.0]));
    }

    #[test]
    fn picked_numbers_hold_the_ends() {
        assert_eq!(evenly(5, 10), [0, 1, 2, 3, 4]);
        assert_eq!(evenly(101, 3), [0, 50, 100]);
        assert_eq!(evenly(1, 3), [0]);
    }

    #[test]
    fn quantiles_leave_out_what_is_not_there() {
        let draws =
            [3.0, f64::NAN, 1.0, 2.0].map(|restitution| Drawn { restitution, uncertainty: 0.0, sub_impacts: 1.0 });
        assert_eq!(median(&draws, |drawn| drawn.restitution), 2.0);
        assert!(median(&[], |drawn| drawn.restitution).is_nan());
    }
}
