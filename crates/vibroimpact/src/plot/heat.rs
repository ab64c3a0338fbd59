//! Maps: a value as colour over two quantities.

use super::axis::{Axis, Scale, full_label, named_or};
use super::canvas::{Canvas, Lettering, Pen, Rectangle};
use super::colour::{blue_red, viridis};
use super::text::width_px;
use plotters::style::RGBColor;
use plotters::style::text_anchor::{HPos, VPos};
use std::io;

/// Width of the strip right of the panel that holds the scale of colours (px).
pub(super) const STRIP_PX: f64 = 74.0;

/// A value on a grid, shown as colour with a scale beside it.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    /// Abscissas of the cells' centres, ascending.
    pub x: Vec<f64>,
    /// Ordinates of the cells' centres, ascending.
    pub y: Vec<f64>,
    /// Values, one row of cells per ordinate; missing or not finite ones stay grey.
    pub rows: Vec<Vec<f64>>,
    /// The quantity of the colour, with unit and limits; limits symmetric about zero give a diverging colour map. With an axis
    /// without labels no scale of colours is drawn.
    pub value: Axis,
}

impl HeatMap {
    /// A map of `rows[j][i]` over `x[i]` and `y[j]`, which may have any order.
    pub fn new(x: &[f64], y: &[f64], rows: Vec<Vec<f64>>, value: Axis) -> HeatMap {
        let order = |places: &[f64]| {
            let mut order: Vec<usize> = (0..places.len()).collect();
            order.sort_by(|&i, &j| places[i].total_cmp(&places[j]));
            order
        };
        let (columns, lines) = (order(x), order(y));
        let value_at = |j: usize, i: usize| rows.get(j).and_then(|row| row.get(i)).copied().unwrap_or(f64::NAN);
        let rows = lines.iter().map(|&j| columns.iter().map(|&i| value_at(j, i)).collect()).collect();
        let sorted = |places: &[f64], order: &[usize]| order.iter().map(|&k| places[k]).collect();
        HeatMap { x: sorted(x, &columns), y: sorted(y, &lines), rows, value }
    }

    fn scale(&self) -> Scale {
        let finite = self.rows.iter().flatten().copied().filter(|v| super::axis::drawable(*v, self.value.logarithmic));
        let extent = finite
            .fold(None, |e: Option<(f64, f64)>, v| Some(e.map_or((v, v), |(low, high)| (low.min(v), high.max(v)))));
        Scale::new(&self.value, extent, 0.0, true)
    }

    /// Viridis; with limits symmetric about zero, blue for negative and red for positive values.
    fn shade(&self, fraction: f64) -> RGBColor {
        match self.value.limits {
            Some((low, high)) if low == -high && !self.value.logarithmic => blue_red(fraction),
            _ => viridis(fraction),
        }
    }

    /// Draws the cells; `logarithmic` states which of the two axes are logarithmic, `place` maps a pair of values to the picture.
    pub(super) fn draw(
        &self,
        canvas: &Canvas,
        within: &Rectangle,
        logarithmic: [bool; 2],
        place: impl Fn(f64, f64) -> (f64, f64),
    ) -> io::Result<()> {
        let scale = self.scale();
        let (columns, lines) = (edges(&self.x, logarithmic[0]), edges(&self.y, logarithmic[1]));
        for (j, line) in lines.windows(2).enumerate() {
            for (i, column) in columns.windows(2).enumerate() {
                let value = self.rows.get(j).and_then(|r| r.get(i)).copied().unwrap_or(f64::NAN);
                let known = super::axis::drawable(value, self.value.logarithmic);
                let colour = if known { self.shade(scale.fraction(value)) } else { RGBColor(190, 190, 190) };
                let ((left, bottom), (right, top)) = (place(column[0], line[0]), place(column[1], line[1]));
                // half a pixel under the next cell, which is drawn later: no seams
                let cell = Rectangle {
                    left: left.max(within.left),
                    top: (top - 0.5).max(within.top),
                    right: (right + 0.5).min(within.right),
                    bottom: bottom.min(within.bottom),
                };
                if cell.left < cell.right && cell.top < cell.bottom {
                    canvas.fill(&cell, colour)?;
                }
            }
        }
        Ok(())
    }

    /// Draws the scale of colours right of the panel.
    pub(super) fn draw_scale(&self, canvas: &Canvas, panel: &Rectangle, text: Lettering) -> io::Result<()> {
        let scale = self.scale();
        let bar = Rectangle { left: panel.right + 12.0, right: panel.right + 24.0, ..*panel };
        // values with names have separate colours
        let shades = if self.value.named_ticks.is_empty() { 64 } else { self.value.named_ticks.len() };
        for k in 0..shades {
            let at = |k: usize| bar.bottom - bar.height() * k as f64 / shades as f64;
            let shade = Rectangle { top: (at(k + 1) - 0.5).max(bar.top), bottom: at(k), ..bar };
            canvas.fill(&shade, self.shade((k as f64 + 0.5) / shades as f64))?;
        }
        canvas.frame(&bar, Pen::new(text.colour, 0.7))?;
        let (ticks, exponent) = named_or(&self.value, scale.ticks_up(bar.height(), text.size_px));
        let widest = ticks.iter().map(|t| width_px(&t.1, text.size_px)).fold(0.0, f64::max);
        for (measure, label) in ticks {
            let y = bar.bottom - bar.height() * scale.fraction_of_measure(measure);
            canvas.path(&[(bar.right, y), (bar.right + 3.0, y)], Pen::new(text.colour, 0.7))?;
            let side = Lettering { horizontal: HPos::Left, vertical: VPos::Center, ..text };
            canvas.text(&label, (bar.right + 5.0, y), side)?;
        }
        let turned = Lettering { horizontal: HPos::Center, vertical: VPos::Bottom, upright: true, ..text };
        let middle = 0.5 * (bar.top + bar.bottom);
        canvas.text(&full_label(&self.value, exponent), (bar.right + widest + 9.0 + text.size_px, middle), turned)
    }
}

/// Edges of cells around centres: half way between neighbours, in the measure of the axis.
pub(super) fn edges(centres: &[f64], logarithmic: bool) -> Vec<f64> {
    if logarithmic && centres.iter().all(|&centre| super::axis::drawable(centre, true)) {
        let measures: Vec<f64> = centres.iter().map(|centre| centre.log10()).collect();
        return edges(&measures, false).into_iter().map(|edge| 10f64.powf(edge)).collect();
    }
    let inner: Vec<f64> = centres.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    let (Some(first), Some(last)) = (centres.first(), centres.last()) else { return Vec::new() };
    let half = |edge: Option<&f64>, centre: f64| edge.map_or(0.5, |e| (e - centre).abs());
    let low = first - half(inner.first(), *first);
    let high = last + half(inner.last(), *last);
    [&[low], inner.as_slice(), &[high]].concat()
}
