//! Measurements against the model, and the likelihood profiles.

use fitting::two_sided_quantile;

use super::data::Data;
use super::summary::{Identification, Predicted, ProfileCurve, RecordFit};
use crate::plot::{Axis, Colour, Figure, Marker, Panel, Series};

/// Largest number of force histories that are drawn.
const MOST_RECORDS: usize = 4;
/// Panels of profiles in a row.
const IN_A_ROW: usize = 3;

/// A panel for each measured quantity, with a band for the model's uncertainty; for each force history; and for each profile.
pub fn picture(title: &str, data: &Data, found: &Identification) -> Figure {
    let mut figure = Figure::new(title);
    let across = Across::of(data);
    for noise in &found.noise {
        let of = |p: &&Predicted| p.quantity == noise.quantity;
        let values: Vec<&Predicted> = found.predictions.iter().filter(of).collect();
        if !values.is_empty() {
            figure = figure.row([measured(&noise.quantity, &across, &values, found)]);
        }
    }
    for record in found.records.iter().take(MOST_RECORDS) {
        figure = figure.row([history(record)]);
    }
    for row in found.profiles.chunks(IN_A_ROW) {
        figure = figure.row(row.iter().map(profile));
    }
    figure
}

/// The quantity of the horizontal axis: the only field that varies, or the line of the table.
struct Across {
    name: String,
    /// The place of each line along the axis.
    places: Vec<(u64, f64)>,
}

impl Across {
    fn of(data: &Data) -> Across {
        let varies = |k: &usize| data.rows.iter().any(|row| row.values[*k] != data.rows[0].values[*k]);
        let varied: Vec<usize> = (0..data.fields.len()).filter(varies).collect();
        if let [one] = varied[..]
            && let Some(places) =
                data.rows.iter().map(|row| Some((row.line, row.values[one].as_f64()?))).collect::<Option<Vec<_>>>()
        {
            return Across { name: data.fields[one].to_string(), places };
        }
        let places = data.rows.iter().map(|row| (row.line, row.line as f64)).collect();
        Across { name: "line of the table".to_owned(), places }
    }

    fn place(&self, line: u64) -> f64 {
        self.places.iter().find(|(known, _)| *known == line).map_or(f64::NAN, |(_, place)| *place)
    }
}

fn measured(quantity: &str, across: &Across, values: &[&Predicted], found: &Identification) -> Panel {
    let z = two_sided_quantile(found.level, None);
    let mut values: Vec<(f64, &Predicted)> = values.iter().map(|value| (across.place(value.line), *value)).collect();
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let column = |of: &dyn Fn(&Predicted) -> f64| -> Vec<f64> { values.iter().map(|(_, value)| of(value)).collect() };
    let x: Vec<f64> = values.iter().map(|(x, _)| *x).collect();
    let model = column(&|p| p.predicted);
    let spread = |p: &Predicted| z * p.predicted_sd.unwrap_or(0.0);
    let (low, high) = (column(&|p| p.predicted - spread(p)), column(&|p| p.predicted + spread(p)));
    Panel::new(Axis::new(across.name.as_str()), Axis::new(quantity))
        .with(Series::band(&x, &low, &high).colour(Colour::Blue))
        .with(Series::line_points(&x, &model, Marker::Dot).colour(Colour::Blue).label("model"))
        .with(
            Series::error_bars(&x, &column(&|p| p.measured), &column(&|p| p.measured_sd), Marker::Circle)
                .colour(Colour::Vermilion)
                .label("measured, 1 standard deviation"),
        )
}

fn history(record: &RecordFit) -> Panel {
    let [time, measured, model] = &record.samples;
    Panel::new(Axis::new("time").unit("s"), Axis::new("force").unit("N"))
        .title(record.file.as_str())
        .with(Series::points(time, measured, Marker::Dot).colour(Colour::Vermilion).label("measured"))
        .with(Series::line(time, model).colour(Colour::Blue).label("model"))
}

/// The square root of the rise, which is linear in the coordinate for a linear model, so that a few points show it.
fn profile(curve: &ProfileCurve) -> Panel {
    let root: Vec<f64> = curve.rise.iter().map(|rise| rise.max(0.0).sqrt()).collect();
    Panel::new(Axis::new(curve.field.as_str()), Axis::new("√ rise of S"))
        .height(130.0)
        .with(Series::line_points(&curve.values, &root, Marker::Dot).colour(Colour::Blue))
        .with(Series::horizontal_rule(curve.limit.sqrt()))
}
