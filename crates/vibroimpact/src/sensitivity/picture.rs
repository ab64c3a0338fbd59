//! The tornado diagram of a sensitivity.

use invalid_input::InvalidInput;

use super::table::{Row, Table};
use crate::plot::{Axis, Colour, Figure, Marker, Panel, Series};

/// Largest number of fields in the diagram.
const MOST: usize = 20;

/// Changes of an output by one per cent more and less of each field, the largest on top. Where the derivatives do not hold for one
/// per cent, the changes are smaller, and the legend states them.
///
/// # Errors
/// An output that the impact does not have.
pub fn figure(found: &Table, output: &str) -> Result<Figure, InvalidInput> {
    let all = found.rows(output)?;
    let (share, percentage) = (all.share, all.percentage());
    let rows: Vec<_> = all.rows.into_iter().filter(|row| row.value != 0.0).take(MOST).collect();
    let count = rows.len();
    let line = |i: usize| (count - i) as f64;
    let ends: Vec<f64> = rows.iter().map(|row| share * row.by_whole()).collect();
    let widest = ends.iter().map(|end| end.abs()).fold(f64::MIN_POSITIVE, f64::max);
    let x = Axis::new(format!("change of {output}")).limits(-1.15 * widest, 1.15 * widest);
    let name = |row: &Row| match row.derivative.uncertainty {
        Some(_) => row.path.to_owned(),
        None => format!("{} (no certain digit)", row.path),
    };
    let y = Axis::new("").ticks_at(rows.iter().enumerate().map(|(i, row)| (line(i), name(row))));
    let mut panel = Panel::new(x, y.limits(0.4, count as f64 + 0.6)).height(40.0 + 26.0 * count as f64);
    for (sign, colour, more) in [(1.0, Colour::Blue, "more"), (-1.0, Colour::Vermilion, "less")] {
        for (i, end) in ends.iter().enumerate() {
            let level = line(i);
            let bar = Series::line(&[0.0, sign * end], &[level, level]).colour(colour).line_width(10.0);
            panel = panel.with(if i == 0 { bar.label(format!("{percentage} {more}")) } else { bar });
        }
    }
    let half: Vec<f64> =
        rows.iter().map(|row| share * row.value.abs() * row.derivative.uncertainty.unwrap_or(0.0)).collect();
    let levels: Vec<f64> = (0..count).map(line).collect();
    let panel = panel.with(Series::level_error_bars(&ends, &levels, &half, Marker::Dot).colour(Colour::Black));
    Ok(Figure::new(format!("What changes {output}")).row([panel.with(Series::vertical_rule(0.0))]))
}
