//! The figure of a run.

use rustfft::FftPlannerScalar;
use rustfft::num_complex::Complex;

use super::{Course, Simulation};
use crate::plot::{Axis, Colour, Figure, Marker, Panel, Series};

/// Largest number of contacts that are drawn; more would overlap.
const DRAWN: usize = 6;
/// Largest number of intervals whose stripes and peaks are drawn.
const MOST_SPANS: usize = 400;
/// Largest number of points of an impact map.
const MOST_MAPPED: usize = 5000;

/// Gaps and forces over time; below, each speed of approach plotted against the one before it (the impact map), the state once in
/// each period of the load (the Poincare section), and the spectrum of the displacements.
pub fn picture(title: &str, found: &Simulation) -> Figure {
    let none = Course::default();
    let course = found.course.as_ref().unwrap_or(&none);
    let end_s = found.run.end_s;
    let time: Vec<f64> = course.rows.iter().map(|row| row.time_s).collect();
    let names = &found.posed.contacts[..found.posed.contacts.len().min(DRAWN)];
    let time_axis = || Axis::new("time").unit("s").limits(0.0, end_s);
    let column = |c: usize, of: fn(&vibroimpact_sim::assembly::ContactSample) -> f64| -> Vec<f64> {
        course.rows.iter().map(|row| of(&row.contacts[c])).collect()
    };
    let mut gaps = Panel::new(time_axis().unlabelled(), Axis::new("gap").unit("m")).height(150.0);
    let mut forces = Panel::new(time_axis(), Axis::new("contact force").unit("N")).height(130.0);
    if found.intervals.iter().map(Vec::len).sum::<usize>() <= MOST_SPANS {
        let all = || found.intervals.iter().take(DRAWN).flatten();
        let starts: Vec<f64> = all().map(|interval| interval.start_s).collect();
        let ends: Vec<f64> = all().map(|interval| interval.end_s.unwrap_or(end_s)).collect();
        gaps = gaps.with(Series::spans(&starts, &ends));
    }
    for (c, name) in names.iter().enumerate() {
        let colour = Colour::of_series(c);
        gaps = gaps.with(Series::line(&time, &column(c, |s| 0.0 - s.overlap_m)).label(name).colour(colour));
        let force = Series::line(&time, &column(c, |s| s.force_n)).colour(colour).line_width(0.8);
        forces = forces.with(force);
    }
    gaps = gaps.with(Series::horizontal_rule(0.0));
    let mut below = Vec::new();
    if found.intervals.iter().take(DRAWN).any(|intervals| intervals.len() > 1) {
        below.push(impact_map(found, names));
    }
    if course.period_s.is_some() {
        below.push(section(course, names));
    }
    let mut figure = Figure::new(title).row([gaps]).row([forces]);
    if !below.is_empty() {
        figure = figure.row(below);
    }
    figure.row([spectrum(course, names)])
}

/// Each speed of approach plotted against the one before it.
fn impact_map(found: &Simulation, names: &[String]) -> Panel {
    let axes = Panel::new(Axis::new("speed of approach").unit("m/s"), Axis::new("of the next").unit("m/s"));
    names.iter().enumerate().fold(axes.title("Impact map").height(170.0), |panel, (c, _)| {
        let speeds: Vec<f64> = found.intervals[c].iter().map(|interval| interval.approach_speed_m_s).collect();
        let from = speeds.len().saturating_sub(MOST_MAPPED);
        let speeds = &speeds[from..];
        let next = speeds.get(1..).unwrap_or_default();
        panel.with(Series::points(speeds, next, Marker::Dot).colour(Colour::of_series(c)))
    })
}

/// The state of each contact once in each period.
fn section(course: &Course, names: &[String]) -> Panel {
    let axes = Panel::new(Axis::new("gap").unit("m"), Axis::new("its rate").unit("m/s"));
    names.iter().enumerate().fold(axes.title("Once in each period of the load").height(170.0), |panel, (c, _)| {
        let gap: Vec<f64> = course.section.iter().map(|row| 0.0 - row.contacts[c].overlap_m).collect();
        let rate: Vec<f64> = course.section.iter().map(|row| 0.0 - row.contacts[c].rate_m_s).collect();
        panel.with(Series::points(&gap, &rate, Marker::Dot).colour(Colour::of_series(c)))
    })
}

/// Amplitudes of the displacement of each contact's first side (or second, if the first does not move) over frequency. The mean is
/// subtracted, and a Hann window reduces leakage.
fn spectrum(course: &Course, names: &[String]) -> Panel {
    let rows: Vec<_> = course.even_rows().collect();
    let count = rows.len();
    let duration_s = count as f64 * course.step_s;
    let panel = Panel::new(Axis::new("frequency").unit("Hz").log(), Axis::new("amplitude").unit("m").log());
    let mut panel = panel.title("Spectrum of the displacements").height(150.0);
    if count < 4 {
        return panel;
    }
    let transform = FftPlannerScalar::new().plan_fft_forward(count);
    for c in 0..names.len() {
        let moves = |side: usize| rows.iter().any(|row| row.contacts[c].displacement_m[side] != 0.0);
        let side = if moves(0) { 0 } else { 1 };
        let values: Vec<f64> = rows.iter().map(|row| row.contacts[c].displacement_m[side]).collect();
        let mean = values.iter().sum::<f64>() / count as f64;
        let hann = |i: usize| 1.0 - (std::f64::consts::TAU * i as f64 / count as f64).cos();
        let mut course: Vec<Complex<f64>> =
            values.iter().enumerate().map(|(i, value)| Complex::new((value - mean) * hann(i), 0.0)).collect();
        transform.process(&mut course);
        let frequency: Vec<f64> = (1..count / 2).map(|i| i as f64 / duration_s).collect();
        let amplitude: Vec<f64> = (1..count / 2).map(|i| 2.0 * course[i].norm() / count as f64).collect();
        panel = panel.with(Series::line(&frequency, &amplitude).colour(Colour::of_series(c)).line_width(0.8));
    }
    panel
}
