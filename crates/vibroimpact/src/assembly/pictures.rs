//! The figure of a run.

use rustfft::algorithm::Radix4;
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftDirection};

use super::{Course, Simulation};
use crate::plot::{Axis, Colour, Figure, Marker, Panel, Series};

/// Largest number of contacts in a panel, one for each colour.
const IN_PANEL: usize = 6;
/// Largest number of contacts in the figure; more would make it too long.
const DRAWN: usize = 24;
/// Largest number of stripes.
const MOST_SPANS: usize = 400;
/// Largest number of points of an impact map.
const MOST_MAPPED: usize = 5000;
/// Least number of samples of a spectrum.
const FEWEST_SAMPLES: usize = 4;

/// Gaps and forces over time; below, each speed of approach plotted against the one before it (the impact map), the state once in
/// each period of the loads (the Poincare section), and the spectrum of the displacements. Many contacts are drawn in groups, and
/// of more than 24 those with the largest root mean square of the force.
pub fn picture(title: &str, found: &Simulation) -> Figure {
    let none = Course::default();
    let course = found.course.as_ref().unwrap_or(&none);
    let contacts = found.posed.contacts.len();
    let mut drawn: Vec<usize> = (0..contacts).collect();
    let mut title = title.to_owned();
    if contacts > DRAWN {
        let squared_force = |c: &usize| found.run.contacts[*c].statistics.squared_force_n2_s;
        drawn.sort_by(|one, other| squared_force(other).total_cmp(&squared_force(one)));
        drawn.truncate(DRAWN);
        drawn.sort_unstable();
        title += &format!("\nthe {DRAWN} of {contacts} contacts with the largest RMS force");
    }
    let groups = drawn.len().div_ceil(IN_PANEL).max(1);
    let figure = Figure::new(title);
    if drawn.is_empty() {
        return group(figure, found, course, &[]);
    }
    drawn.chunks(drawn.len().div_ceil(groups)).fold(figure, |figure, contacts| group(figure, found, course, contacts))
}

/// The panels of some contacts.
fn group(figure: Figure, found: &Simulation, course: &Course, contacts: &[usize]) -> Figure {
    let end_s = found.run.end_s;
    let time: Vec<f64> = course.rows.iter().map(|row| row.time_s).collect();
    let time_axis = || Axis::new("time").unit("s").limits(0.0, end_s);
    let column = |c: usize, of: fn(&vibroimpact_sim::assembly::ContactSample) -> f64| -> Vec<f64> {
        course.rows.iter().map(|row| of(&row.contacts[c])).collect()
    };
    let mut gaps = Panel::new(time_axis().unlabelled(), Axis::new("gap").unit("m")).height(150.0);
    let mut forces = Panel::new(time_axis(), Axis::new("contact force").unit("N")).height(130.0);
    let closed = closed(found, contacts);
    if closed.len() <= MOST_SPANS {
        let (starts, ends): (Vec<f64>, Vec<f64>) = closed.into_iter().unzip();
        gaps = gaps.with(Series::spans(&starts, &ends));
    }
    for (number, &c) in contacts.iter().enumerate() {
        let colour = Colour::of_series(number);
        let gap = Series::line(&time, &column(c, |s| 0.0 - s.overlap_m));
        gaps = gaps.with(gap.label(&found.posed.contacts[c]).colour(colour));
        let force = Series::line(&time, &column(c, |s| s.force_n)).colour(colour).line_width(0.8);
        forces = forces.with(force);
    }
    gaps = gaps.with(Series::horizontal_rule(0.0));
    let mut below = Vec::new();
    if contacts.iter().any(|&c| found.intervals[c].len() > 1) {
        below.push(impact_map(found, contacts));
    }
    if course.period_s.is_some() {
        below.push(section(course, contacts));
    }
    let figure = figure.row([gaps]).row([forces]);
    let figure = if below.is_empty() { figure } else { figure.row(below) };
    figure.row([spectrum(found, course, contacts)])
}

/// The times during which any of some contacts is closed, in order.
fn closed(found: &Simulation, contacts: &[usize]) -> Vec<(f64, f64)> {
    let of = |&c: &usize| found.intervals[c].iter().map(|one| (one.start_s, one.end_s.unwrap_or(found.run.end_s)));
    let mut all: Vec<(f64, f64)> = contacts.iter().flat_map(of).collect();
    all.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut times: Vec<(f64, f64)> = Vec::new();
    for (start, end) in all {
        match times.last_mut() {
            Some(last) if start <= last.1 => last.1 = last.1.max(end),
            _ => times.push((start, end)),
        }
    }
    times
}

/// Each speed of approach plotted against the one before it.
fn impact_map(found: &Simulation, contacts: &[usize]) -> Panel {
    let axes = Panel::new(Axis::new("speed of approach").unit("m/s"), Axis::new("next speed of approach").unit("m/s"));
    contacts.iter().enumerate().fold(axes.title("Impact map").height(170.0), |panel, (number, &c)| {
        let speeds: Vec<f64> = found.intervals[c].iter().map(|interval| interval.approach_speed_m_s).collect();
        let from = speeds.len().saturating_sub(MOST_MAPPED);
        let speeds = &speeds[from..];
        let next = speeds.get(1..).unwrap_or_default();
        panel.with(Series::points(speeds, next, Marker::Dot).colour(Colour::of_series(number)))
    })
}

/// The state of each contact once in each period.
fn section(course: &Course, contacts: &[usize]) -> Panel {
    let axes = Panel::new(Axis::new("gap").unit("m"), Axis::new("rate of the gap").unit("m/s"));
    let axes = axes.title("Once in each period of the load").height(170.0);
    contacts.iter().enumerate().fold(axes, |panel, (number, &c)| {
        let gap: Vec<f64> = course.section.iter().map(|row| 0.0 - row.contacts[c].overlap_m).collect();
        let rate: Vec<f64> = course.section.iter().map(|row| 0.0 - row.contacts[c].rate_m_s).collect();
        panel.with(Series::points(&gap, &rate, Marker::Dot).colour(Colour::of_series(number)))
    })
}

/// Amplitudes of the displacement of each contact's first side (or second, if the first does not move) over frequency. The mean is
/// subtracted, and a Hann window reduces leakage. The title says what is missing because it is too fast for the samples.
fn spectrum(found: &Simulation, course: &Course, contacts: &[usize]) -> Panel {
    let samples = &course.spectrum;
    let highest = crate::text::quantity(samples.highest_hz(), "Hz");
    let mut title = "Spectrum of the displacements".to_owned();
    if samples.fast_modes > 0 {
        let modes = crate::text::counted(samples.fast_modes as u64, "mode", "modes");
        title += &format!(" without {modes} above {highest}");
    }
    let most = contacts.iter().map(|&c| found.intervals[c].len() as u64 + found.left_out[c]).max().unwrap_or(0);
    if most as f64 > found.run.end_s * samples.highest_hz() {
        title += "; contacts follow each other faster than its samples";
    }
    let panel = Panel::new(Axis::new("frequency").unit("Hz").log(), Axis::new("amplitude").unit("m").log());
    contacts.iter().enumerate().fold(panel.title(title).height(150.0), |panel, (number, &c)| {
        let values = samples.of_contact(c);
        let count = values.len();
        if count < FEWEST_SAMPLES {
            return panel;
        }
        let mean = values.iter().sum::<f64>() / count as f64;
        let hann = |i: usize| 1.0 - (std::f64::consts::TAU * i as f64 / count as f64).cos();
        let mut turned: Vec<Complex<f64>> =
            values.iter().enumerate().map(|(i, value)| Complex::new((value - mean) * hann(i), 0.0)).collect();
        // zeros beyond the samples interpolate their spectrum
        let padded = count.next_power_of_two();
        turned.resize(padded, Complex::default());
        Radix4::new(padded, FftDirection::Forward).process(&mut turned);
        let duration_s = padded as f64 * samples.step_s;
        let of = |i: usize| (i as f64 / duration_s, 2.0 * turned[i].norm() / count as f64);
        let (frequency, amplitude): (Vec<f64>, Vec<f64>) = (1..padded / 2).map(of).unzip();
        panel.with(Series::line(&frequency, &amplitude).colour(Colour::of_series(number)).line_width(0.8))
    })
}
