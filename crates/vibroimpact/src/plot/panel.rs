//! The series of one panel.

use super::axis::{Scale, drawable};
use super::canvas::{Canvas, Lettering, Pen, Rectangle};
use super::colour::Colour;
use super::figure::Panel;
use super::series::{Mark, Marker, Series};
use super::text::width_px;
use plotters::style::RGBColor;
use plotters::style::text_anchor::{HPos, VPos};
use std::io;

pub(super) const INK: RGBColor = RGBColor(40, 40, 40);
pub(super) const TICK_PX: f64 = 11.0;

/// Text style of tick labels, from which the other styles are derived.
pub(super) const SMALL: Lettering =
    Lettering { size_px: TICK_PX, colour: INK, horizontal: HPos::Center, vertical: VPos::Top, upright: false };

/// An entry of a legend: the series whose look it explains, and the series' colour.
pub(super) type Entry<'a> = (&'a Series, Colour);

/// The series with their colours: their own, or the next of the palette.
pub(super) fn coloured(panel: &Panel) -> impl Iterator<Item = Entry<'_>> {
    let mut taken = 0;
    panel.series.iter().map(move |series| {
        let colour = series.colour.unwrap_or_else(|| {
            taken += 1;
            Colour::of_series(taken - 1)
        });
        (series, colour)
    })
}

fn pen(series: &Series, colour: Colour) -> Pen {
    Pen { dashed: series.dashed, ..Pen::new(colour.rgb(), series.width_px) }
}

/// Draws map and series between the axes.
pub(super) fn draw(canvas: &Canvas, panel: &Panel, x: &Scale, y: &Scale, r: &Rectangle) -> io::Result<()> {
    let place = |u: f64, v: f64| (r.left + x.fraction(u) * r.width(), r.bottom - y.fraction(v) * r.height());
    if let Some(heat) = &panel.heat {
        heat.draw(canvas, r, [panel.x.logarithmic, panel.y.logarithmic], place)?;
    }
    // values that cannot be drawn become None and interrupt a line
    let at = |u: f64, v: f64| {
        let drawn = drawable(u, panel.x.logarithmic) && drawable(v, panel.y.logarithmic);
        drawn.then(|| place(u, v))
    };
    for (series, colour) in coloured(panel) {
        draw_series(canvas, series, colour, r, &at)?;
    }
    // rules and spans alone are no data, nor are zeros on a logarithmic axis
    let has_data = |series: &Series| {
        series.abscissas().any(|u| drawable(u, panel.x.logarithmic))
            && series.ordinates().any(|v| drawable(v, panel.y.logarithmic))
    };
    if panel.heat.is_none() && !panel.series.iter().any(has_data) {
        let middle = (0.5 * (r.left + r.right), 0.5 * (r.top + r.bottom));
        canvas.text("no data", middle, Lettering { vertical: VPos::Center, ..SMALL })?;
    }
    Ok(())
}

type Place<'a> = &'a dyn Fn(f64, f64) -> Option<(f64, f64)>;

fn draw_series(canvas: &Canvas, series: &Series, colour: Colour, r: &Rectangle, at: Place) -> io::Result<()> {
    let pen = pen(series, colour);
    let pairs = || series.x.iter().copied().zip(series.y.iter().copied());
    let points: Vec<Option<(f64, f64)>> = pairs().map(|(u, v)| at(u, v)).collect();
    let runs = |points: &[Option<(f64, f64)>]| -> io::Result<()> {
        for run in points.split(Option::is_none) {
            let run: Vec<(f64, f64)> = run.iter().copied().flatten().collect();
            canvas.clipped_path(&run, r, pen)?;
        }
        Ok(())
    };
    let markers = |marker: Marker| -> io::Result<()> {
        let inside =
            |p: &(f64, f64)| p.0 >= r.left - 0.5 && p.0 <= r.right + 0.5 && p.1 >= r.top - 0.5 && p.1 <= r.bottom + 0.5;
        points.iter().flatten().filter(|p| inside(p)).try_for_each(|&p| canvas.marker(p, marker, colour.rgb()))
    };
    match series.mark {
        Mark::Line => runs(&points),
        Mark::Points(marker) => markers(marker),
        Mark::LinePoints(marker) => {
            runs(&points)?;
            markers(marker)
        }
        Mark::Step => {
            let corners: Vec<Option<(f64, f64)>> = points
                .iter()
                .enumerate()
                .flat_map(|(i, p)| {
                    let before = if i == 0 { None } else { points[i - 1] };
                    [before.zip(*p).map(|(q, p)| (p.0, q.1)).or(*p), *p]
                })
                .collect();
            runs(&corners)
        }
        Mark::Stem(marker) => {
            for (point, (u, _)) in points.iter().zip(pairs()) {
                let foot = at(u, 0.0).map_or(r.bottom, |p| p.1);
                if let Some(p) = point {
                    canvas.clipped_path(&[(p.0, foot), *p], r, pen)?;
                }
            }
            markers(marker)
        }
        Mark::Band => {
            let clamp = |p: (f64, f64)| (p.0.clamp(r.left, r.right), p.1.clamp(r.top, r.bottom));
            let upper = series.x.iter().zip(&series.spread).map(|(&u, &v)| at(u, v));
            let both: Vec<_> = points.iter().copied().zip(upper).map(|(low, high)| low.zip(high)).collect();
            for run in both.split(Option::is_none) {
                let run: Vec<_> = run.iter().copied().flatten().collect();
                let outline: Vec<(f64, f64)> =
                    run.iter().map(|p| clamp(p.0)).chain(run.iter().rev().map(|p| clamp(p.1))).collect();
                if run.len() > 1 {
                    canvas.polygon(&outline, colour.rgb(), series.opacity)?;
                }
            }
            Ok(())
        }
        Mark::Spans => {
            for (&from, &to) in series.x.iter().zip(&series.spread) {
                // zero on a logarithmic axis lies beyond its lower end
                let begin = at(from, 1.0).or_else(|| (from <= 0.0).then_some((r.left, r.top)));
                draw_span(canvas, r, colour, begin.zip(at(to, 1.0)))?;
            }
            Ok(())
        }
        Mark::Labels => draw_labels(canvas, series, colour, r, &points),
        Mark::ErrorBars(marker) => {
            for ((u, v), half) in pairs().zip(&series.spread) {
                if let (Some(low), Some(high)) = (at(u, v - half), at(u, v + half)) {
                    canvas.clipped_path(&[low, high], r, pen)?;
                    for end in [low, high] {
                        canvas.clipped_path(&[(end.0 - 2.5, end.1), (end.0 + 2.5, end.1)], r, pen)?;
                    }
                }
            }
            markers(marker)
        }
        Mark::LevelErrorBars(marker) => {
            for ((u, v), half) in pairs().zip(&series.spread) {
                if let (Some(left), Some(right)) = (at(u - half, v), at(u + half, v)) {
                    canvas.clipped_path(&[left, right], r, pen)?;
                    for end in [left, right] {
                        canvas.clipped_path(&[(end.0, end.1 - 2.5), (end.0, end.1 + 2.5)], r, pen)?;
                    }
                }
            }
            markers(marker)
        }
        Mark::VerticalRule => match pairs().next() {
            Some((u, _)) if drawable(u, false) => {
                // any drawable ordinate can be used to find the abscissa
                let x = at(u, 1.0).map_or(f64::NAN, |p| p.0);
                if (r.left..=r.right).contains(&x) { canvas.path(&[(x, r.top), (x, r.bottom)], pen) } else { Ok(()) }
            }
            _ => Ok(()),
        },
        Mark::HorizontalRule => match pairs().next() {
            Some((_, v)) if drawable(v, false) => {
                let y = at(1.0, v).map_or(f64::NAN, |p| p.1);
                if (r.top..=r.bottom).contains(&y) { canvas.path(&[(r.left, y), (r.right, y)], pen) } else { Ok(()) }
            }
            _ => Ok(()),
        },
    }
}

/// A stripe between two abscissas, never thinner than a fine line.
fn draw_span(canvas: &Canvas, r: &Rectangle, colour: Colour, ends: Option<((f64, f64), (f64, f64))>) -> io::Result<()> {
    const THINNEST_PX: f64 = 0.8;
    let Some(((from, _), (to, _))) = ends else { return Ok(()) };
    if to < r.left || from > r.right {
        return Ok(());
    }
    let widen = (0.5 * (THINNEST_PX - (to - from))).max(0.0);
    let (left, right) = ((from - widen).clamp(r.left, r.right), (to + widen).clamp(r.left, r.right));
    let corners = [(left, r.top), (right, r.top), (right, r.bottom), (left, r.bottom)];
    canvas.polygon(&corners, colour.rgb(), 0.25)
}

/// Texts above their points. One that would cover another is raised by a line, and left out if there is no room either.
fn draw_labels(
    canvas: &Canvas,
    series: &Series,
    colour: Colour,
    r: &Rectangle,
    points: &[Option<(f64, f64)>],
) -> io::Result<()> {
    const ABOVE_PX: f64 = 5.0;
    const APART_PX: f64 = 2.0;
    let lettering = Lettering { colour: colour.rgb(), vertical: VPos::Bottom, ..SMALL };
    let mut drawn: Vec<Rectangle> = Vec::new();
    for (point, text) in points.iter().zip(&series.texts) {
        let Some((x, y)) = point.filter(|&(x, y)| (r.left..=r.right).contains(&x) && (r.top..=r.bottom).contains(&y))
        else {
            continue;
        };
        let half = 0.5 * width_px(text, lettering.size_px);
        // pushed inside where the point is near the edge
        let middle = x.min(r.right - half - APART_PX).max(r.left + half + APART_PX);
        let highest = r.top + lettering.size_px + APART_PX;
        let at = |raised: f64| {
            let bottom = (y - ABOVE_PX - raised).max(highest);
            Rectangle { left: middle - half, right: middle + half, top: bottom - lettering.size_px, bottom }
        };
        let free = |place: &Rectangle| {
            drawn.iter().all(|other| {
                place.right + APART_PX < other.left
                    || other.right + APART_PX < place.left
                    || place.bottom < other.top
                    || other.bottom < place.top
            })
        };
        if let Some(place) = [0.0, lettering.size_px + APART_PX].map(at).into_iter().find(free) {
            canvas.text(text, (middle, place.bottom), lettering)?;
            drawn.push(place);
        }
    }
    Ok(())
}

/// The sample of a series' look in a legend, 20 px wide from `(left, y)`.
pub(super) fn draw_key(canvas: &Canvas, series: &Series, colour: Colour, (left, y): (f64, f64)) -> io::Result<()> {
    let middle = (left + 10.0, y);
    let line = || canvas.path(&[(left, y), (left + 20.0, y)], pen(series, colour));
    match series.mark {
        Mark::Points(marker) => canvas.marker(middle, marker, colour.rgb()),
        Mark::LinePoints(marker) => {
            line()?;
            canvas.marker(middle, marker, colour.rgb())
        }
        Mark::Stem(marker) | Mark::ErrorBars(marker) => {
            canvas.path(&[(middle.0, y - 5.0), (middle.0, y + 5.0)], pen(series, colour))?;
            canvas.marker(middle, marker, colour.rgb())
        }
        Mark::LevelErrorBars(marker) => {
            line()?;
            canvas.marker(middle, marker, colour.rgb())
        }
        Mark::Band | Mark::Spans => {
            let area = [(left, y - 4.0), (left + 20.0, y - 4.0), (left + 20.0, y + 4.0), (left, y + 4.0)];
            canvas.polygon(&area, colour.rgb(), series.opacity)
        }
        Mark::Line | Mark::Step | Mark::VerticalRule | Mark::HorizontalRule => line(),
        Mark::Labels => Ok(()),
    }
}
