//! Figures used by several sections.

use super::impact::Row;
use contact_models::Law;
use serde::Serialize;
use vibroimpact::plot::{Axis, Colour, Figure, Marker, Panel, Series};
use vibroimpact_sim::modal::{History, Sample};

/// A figure's number as part of a file name that sorts: `3.5` becomes `3-05`.
pub(super) fn slug(figure: &str) -> String {
    match figure.split_once('.') {
        Some((chapter, number)) => format!("{}-{number:0>2}", chapter.to_lowercase()),
        None => figure.to_lowercase(),
    }
}

/// Results that are drawn in the same style.
pub(super) struct Curve {
    pub label: String,
    pub marker: Marker,
    pub colour: Colour,
    pub rows: Vec<Row>,
}

impl Curve {
    pub fn new(label: impl Into<String>, marker: Marker, colour: Colour, rows: Vec<Row>) -> Curve {
        Curve { label: label.into(), marker, colour, rows }
    }

    /// The thesis's blue circles.
    pub fn reference(label: impl Into<String>, rows: Vec<Row>) -> Curve {
        Curve::new(label, Marker::Circle, Colour::Blue, rows)
    }

    /// The thesis's red crosses.
    pub fn other(label: impl Into<String>, rows: Vec<Row>) -> Curve {
        Curve::new(label, Marker::Cross, Colour::Vermilion, rows)
    }

    fn series(&self, x: fn(&Row) -> f64, y: fn(&Row) -> f64) -> Series {
        let [x, y] = [x, y].map(|value| self.rows.iter().map(value).collect::<Vec<f64>>());
        Series::points(&x, &y, self.marker).colour(self.colour).label(self.label.clone())
    }
}

/// A column of panels: its heading and its curves.
pub(super) type Column = (String, Vec<Curve>);

/// Plots restitution above and number of sub-impacts below, with the same limits in every column.
pub(super) fn restitution_and_sub_impacts(title: &str, x: &Axis, of: fn(&Row) -> f64, columns: &[Column]) -> Figure {
    let count = |row: &Row| row.sub_impacts as f64;
    let top = panels(columns, &x.clone().unlabelled(), of, &Axis::new("restitution e"), Row::e);
    let mut bottom = panels(columns, x, of, &Axis::new("sub-impacts").integers(), count);
    for panel in &mut bottom {
        panel.title.clear();
        panel.height_px = 140.0;
    }
    Figure::new(title).row(top).row(bottom)
}

/// The upper half of [`restitution_and_sub_impacts`] alone.
pub(super) fn restitution(title: &str, x: &Axis, of: fn(&Row) -> f64, columns: &[Column]) -> Figure {
    Figure::new(title).row(panels(columns, x, of, &Axis::new("restitution e"), Row::e))
}

fn panels(columns: &[Column], x: &Axis, of: fn(&Row) -> f64, y: &Axis, value: fn(&Row) -> f64) -> Vec<Panel> {
    let all = columns.iter().flat_map(|c| &c.1).flat_map(|c| &c.rows).map(value);
    let highest = all.filter(|v| v.is_finite()).fold(0.0, f64::max);
    let panel = |(title, curves): &Column| {
        let y = y.clone().limits(-0.03 * highest, 1.06 * highest);
        curves.iter().fold(Panel::new(x.clone(), y).title(title.clone()), |p, c| p.with(c.series(of, value)))
    };
    columns.iter().map(panel).collect()
}

/// The motion of one impact, sampled evenly and densely enough for a picture.
pub(super) struct Course {
    pub time_ms: Vec<f64>,
    pub structure_mm: Vec<f64>,
    pub striker_mm: Vec<f64>,
    pub structure_m_s: Vec<f64>,
    pub striker_m_s: Vec<f64>,
    pub force_n: Vec<f64>,
    pub compression_m: Vec<f64>,
}

/// One sample of a motion in SI units.
#[derive(Serialize)]
pub(super) struct CourseRow {
    time_s: f64,
    structure_displacement_m: f64,
    structure_velocity_m_s: f64,
    striker_displacement_m: f64,
    striker_velocity_m_s: f64,
    compression_m: f64,
    force_n: f64,
}

impl Course {
    /// Samples from `from_s` to `to_s`: about `count` evenly spaced, and every step in contact.
    pub fn new(history: &History<Law>, (from_s, to_s): (f64, f64), count: usize) -> Course {
        let times = history.times(to_s, count).into_iter().filter(|&t| t >= from_s);
        let samples: Vec<Sample> = times.map(|t| history.at(t)).collect();
        let column = |f: fn(&Sample) -> f64| samples.iter().map(f).collect();
        Course {
            time_ms: column(|s| 1e3 * s.time_s),
            structure_mm: column(|s| 1e3 * s.structure_displacement_m),
            striker_mm: column(|s| 1e3 * s.striker_displacement_m),
            structure_m_s: column(|s| s.structure_velocity_m_s),
            striker_m_s: column(|s| s.striker_velocity_m_s),
            force_n: column(|s| s.force_n),
            compression_m: column(|s| s.compression_m),
        }
    }

    /// The samples as rows of a table.
    pub fn rows(&self) -> Vec<CourseRow> {
        let row = |i: usize| CourseRow {
            time_s: 1e-3 * self.time_ms[i],
            structure_displacement_m: 1e-3 * self.structure_mm[i],
            structure_velocity_m_s: self.structure_m_s[i],
            striker_displacement_m: 1e-3 * self.striker_mm[i],
            striker_velocity_m_s: self.striker_m_s[i],
            compression_m: self.compression_m[i],
            force_n: self.force_n[i],
        };
        (0..self.time_ms.len()).map(row).collect()
    }

    /// Beam and ball, displacement against time.
    pub fn displacements(&self) -> Panel {
        Panel::new(time_axis(), Axis::new("displacement").unit("mm"))
            .with(
                Series::line(&self.time_ms, &self.structure_mm).colour(Colour::Vermilion).label("beam at the contact"),
            )
            .with(Series::line(&self.time_ms, &self.striker_mm).colour(Colour::Blue).label("ball"))
    }

    /// Beam and ball, velocity against time.
    pub fn velocities(&self) -> Panel {
        let beam = Series::line(&self.time_ms, &self.structure_m_s).line_width(0.6);
        Panel::new(time_axis(), Axis::new("velocity").unit("m/s"))
            .with(beam.colour(Colour::Vermilion).label("beam at the contact"))
            .with(Series::line(&self.time_ms, &self.striker_m_s).colour(Colour::Blue).label("ball"))
    }

    /// Contact force against time.
    pub fn force(&self) -> Panel {
        let line = Series::line(&self.time_ms, &self.force_n).colour(Colour::Black).line_width(1.0);
        Panel::new(time_axis(), Axis::new("force F").unit("N")).height(120.0).with(line)
    }

    /// Contact force against compression.
    pub fn loops(&self) -> Panel {
        let microns: Vec<f64> = self.compression_m.iter().map(|xi| 1e6 * xi).collect();
        let pressed: Vec<f64> = microns.iter().map(|xi| if *xi >= 0.0 { *xi } else { f64::NAN }).collect();
        let line = Series::line(&pressed, &self.force_n).colour(Colour::Black).line_width(0.9);
        Panel::new(Axis::new("compression ξ").unit("µm"), Axis::new("force F").unit("N")).with(line)
    }
}

fn time_axis() -> Axis {
    Axis::new("time").unit("ms")
}
