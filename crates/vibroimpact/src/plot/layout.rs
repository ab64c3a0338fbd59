//! Layout of a figure: margins, panels, legends.

use super::axis::{Axis, Scale, Tick, drawable, full_label, named_or};
use super::canvas::{Canvas, Lettering, Pen, Rectangle, picture};
use super::figure::{Figure, Panel};
use super::heat::{STRIP_PX, edges};
use super::panel::{self, Entry, SMALL, TICK_PX};
use super::series::Series;
use super::text::{width_px, wrapped};
use plotters::style::RGBColor;
use plotters::style::text_anchor::{HPos, VPos};
use std::io;

const EDGE_PX: f64 = 10.0;
const LABEL_PX: f64 = 12.0;
const LEGEND_LINE_PX: f64 = 17.0;
const TITLE_PX: f64 = 14.0;
const TITLE_LINE_PX: f64 = 18.0;

/// A panel without its position.
struct Plan<'a> {
    panel: &'a Panel,
    x: Scale,
    y: Scale,
    y_ticks: Vec<Tick>,
    y_label: String,
    height_px: f64,
    left_px: f64,
    right_px: f64,
}

impl<'a> Plan<'a> {
    fn new(panel: &'a Panel) -> Plan<'a> {
        let height_px = if panel.height_px.is_finite() { panel.height_px.clamp(20.0, 2000.0) } else { 190.0 };
        let cells =
            |centres: &dyn Fn(&super::HeatMap) -> Vec<f64>| panel.heat.as_ref().map(centres).unwrap_or_default();
        let tight = if panel.heat.is_some() { 0.0 } else { 1.0 };
        // a marker on the frame would be cut in two
        let flush = !panel.series.iter().any(Series::has_markers);
        let x_extent = extent(
            &panel.x,
            panel.series.iter().flat_map(Series::abscissas).chain(cells(&|h| edges(&h.x, panel.x.logarithmic))),
        );
        let y_extent = extent(
            &panel.y,
            panel.series.iter().flat_map(Series::ordinates).chain(cells(&|h| edges(&h.y, panel.y.logarithmic))),
        );
        let (x, y) =
            (Scale::new(&panel.x, x_extent, 0.02 * tight, flush), Scale::new(&panel.y, y_extent, 0.06 * tight, flush));
        let (y_ticks, exponent) = named_or(&panel.y, y.ticks_up(height_px, TICK_PX));
        let y_label = full_label(&panel.y, exponent);
        let widest = y_ticks.iter().map(|t| width_px(&t.1, TICK_PX)).fold(0.0, f64::max);
        let left_px = match (panel.y.labelled, y_label.is_empty()) {
            (false, _) => 8.0,
            (true, true) => widest + 10.0,
            (true, false) => widest + 14.0 + 1.4 * LABEL_PX,
        };
        let right_px = if panel.scale().is_some() { STRIP_PX } else { 14.0 };
        Plan { panel, x, y, y_ticks, y_label, height_px, left_px, right_px }
    }

    fn below_px(&self) -> f64 {
        match (self.panel.x.labelled, self.panel.x.label.is_empty() && self.panel.x.unit.is_empty()) {
            (false, _) => 6.0,
            (true, true) => 1.9 * TICK_PX,
            (true, false) => 1.9 * TICK_PX + 1.3 * LABEL_PX,
        }
    }
}

fn extent(axis: &Axis, values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let drawn = values.filter(|v| drawable(*v, axis.logarithmic));
    drawn.fold(None, |e: Option<(f64, f64)>, v| Some(e.map_or((v, v), |(low, high)| (low.min(v), high.max(v)))))
}

/// Named series of a panel with their colours.
fn entries(panel: &Panel) -> Vec<Entry<'_>> {
    panel::coloured(panel).filter(|(series, _)| !series.label.is_empty()).collect()
}

fn same(a: &[Entry], b: &[Entry]) -> bool {
    a.len() == b.len()
        && a.iter()
            .zip(b)
            .all(|((s, c), (t, d))| s.label == t.label && s.mark == t.mark && s.dashed == t.dashed && c == d)
}

/// Breaks entries into lines no wider than `width`; each with its abscissa.
fn legend_lines<'a, 'b>(entries: &'b [Entry<'a>], width: f64) -> Vec<Vec<(f64, &'b Entry<'a>)>> {
    let mut lines: Vec<Vec<(f64, &Entry)>> = Vec::new();
    let mut x = f64::INFINITY;
    for entry in entries {
        let wide = 26.0 + width_px(&entry.0.label, TICK_PX) + 16.0;
        if x + wide > width {
            lines.push(Vec::new());
            x = 0.0;
        }
        if let Some(line) = lines.last_mut() {
            line.push((x, entry));
        }
        x += wide;
    }
    lines
}

fn draw_legend(canvas: &Canvas, entries: &[Entry], (left, top): (f64, f64), width: f64) -> io::Result<()> {
    for (k, line) in legend_lines(entries, width).iter().enumerate() {
        let y = top + LEGEND_LINE_PX * (k as f64 + 0.5);
        for (x, (series, colour)) in line {
            panel::draw_key(canvas, series, *colour, (left + x, y))?;
            let beside = Lettering { horizontal: HPos::Left, vertical: VPos::Center, ..SMALL };
            canvas.text(&series.label, (left + x + 26.0, y), beside)?;
        }
    }
    Ok(())
}

/// Draws a figure.
pub(super) fn draw(figure: &Figure) -> io::Result<String> {
    let width = if figure.width_px.is_finite() { figure.width_px.clamp(200.0, 4000.0) } else { 760.0 };
    let rows: Vec<Vec<Plan>> = figure.rows.iter().map(|row| row.iter().map(Plan::new).collect()).collect();

    // one legend for all panels if each that has one has the same; beside a map, a legend stays with its panel
    let with_legend: Vec<Vec<Entry>> = figure.rows.iter().flatten().map(entries).filter(|e| !e.is_empty()).collect();
    let lone = with_legend.len() == 1 && figure.rows.iter().flatten().any(|panel| panel.heat.is_some());
    let shared = with_legend.first().filter(|first| !lone && with_legend.iter().all(|e| same(e, first)));
    let inner = width - 2.0 * EDGE_PX;
    let lines_px = |e: &[Entry], width: f64| LEGEND_LINE_PX * legend_lines(e, width).len() as f64;

    let title = wrapped(&figure.title, TITLE_PX, inner);
    let title_px = if title.is_empty() { 0.0 } else { TITLE_LINE_PX * title.len() as f64 + 6.0 };
    let mut y = EDGE_PX + title_px;
    let shared_top = y;
    if let Some(entries) = shared {
        y += lines_px(entries, inner) + 8.0;
    }
    let mut placed = Vec::new();
    for row in &rows {
        // rows with the same number of panels share their margins, so that panels are aligned
        let alike = || rows.iter().filter(|r| r.len() == row.len());
        let margin = |side: &dyn Fn(&Plan) -> f64, column: usize| alike().map(|r| side(&r[column])).fold(0.0, f64::max);
        let lefts: Vec<f64> = (0..row.len()).map(|c| margin(&|p| p.left_px, c)).collect();
        let rights: Vec<f64> = (0..row.len()).map(|c| margin(&|p| p.right_px, c)).collect();
        let used: f64 = lefts.iter().chain(&rights).sum();
        let panel_width = ((inner - used) / row.len().max(1) as f64).max(20.0);
        let own: Vec<Vec<Entry>> =
            row.iter().map(|p| if shared.is_some() { Vec::new() } else { entries(p.panel) }).collect();
        let own_px = own.iter().map(|e| lines_px(e, panel_width)).fold(0.0, f64::max);
        let head = if row.iter().any(|p| !p.panel.title.is_empty()) { 19.0 } else { 6.0 };
        let height = row.iter().map(|p| p.height_px).fold(0.0, f64::max);
        let mut x = EDGE_PX;
        for ((plan, own), (left, right)) in row.iter().zip(own).zip(lefts.iter().zip(&rights)) {
            let top = y + head + own_px;
            let within = Rectangle { left: x + left, top, right: x + left + panel_width, bottom: top + height };
            placed.push((plan, within, own, own_px));
            x += left + panel_width + right;
        }
        y += head + own_px + height + row.iter().map(Plan::below_px).fold(0.0, f64::max) + 6.0;
    }

    picture((width, y + EDGE_PX - 4.0), &figure.title, |canvas| {
        for (k, line) in title.iter().enumerate() {
            let l = Lettering { size_px: TITLE_PX, horizontal: HPos::Left, ..SMALL };
            canvas.text(line, (EDGE_PX, EDGE_PX + TITLE_LINE_PX * k as f64), l)?;
        }
        if let Some(entries) = shared {
            draw_legend(canvas, entries, (EDGE_PX, shared_top), inner)?;
        }
        for (plan, within, own, own_px) in &placed {
            draw_legend(canvas, own, (within.left, within.top - own_px - 2.0), within.width())?;
            let heading = Lettering { size_px: LABEL_PX, horizontal: HPos::Left, ..SMALL };
            canvas.text(&plan.panel.title, (within.left, within.top - own_px - 17.0), heading)?;
            draw_panel(canvas, plan, within)?;
        }
        Ok(())
    })
}

fn draw_panel(canvas: &Canvas, plan: &Plan, r: &Rectangle) -> io::Result<()> {
    let panel = plan.panel;
    let (x_ticks, exponent) = named_or(&panel.x, plan.x.ticks_along(r.width(), TICK_PX));
    let grid = Pen::new(RGBColor(228, 228, 228), 0.6);
    let axis = Pen::new(RGBColor(90, 90, 90), 0.8);
    let inside = |f: &f64| (-1e-9..=1.0 + 1e-9).contains(f);
    let x_at = |t: &Tick| Some(plan.x.fraction_of_measure(t.0)).filter(inside).map(|f| r.left + f * r.width());
    let y_at = |t: &Tick| Some(plan.y.fraction_of_measure(t.0)).filter(inside).map(|f| r.bottom - f * r.height());

    if panel.heat.is_none() {
        for x in x_ticks.iter().filter(|t| !t.1.is_empty()).filter_map(x_at) {
            canvas.path(&[(x, r.top), (x, r.bottom)], grid)?;
        }
        for y in plan.y_ticks.iter().filter(|t| !t.1.is_empty()).filter_map(y_at) {
            canvas.path(&[(r.left, y), (r.right, y)], grid)?;
        }
    }
    panel::draw(canvas, panel, &plan.x, &plan.y, r)?;
    canvas.frame(r, axis)?;
    for tick in &x_ticks {
        let Some(x) = x_at(tick) else { continue };
        canvas.path(&[(x, r.bottom), (x, r.bottom + if tick.1.is_empty() { 2.5 } else { 4.0 })], axis)?;
        if panel.x.labelled {
            canvas.text(&tick.1, (x, r.bottom + 6.0), SMALL)?;
        }
    }
    for tick in &plan.y_ticks {
        let Some(y) = y_at(tick) else { continue };
        canvas.path(&[(r.left, y), (r.left - if tick.1.is_empty() { 2.5 } else { 4.0 }, y)], axis)?;
        if panel.y.labelled {
            let l = Lettering { horizontal: HPos::Right, vertical: VPos::Center, ..SMALL };
            canvas.text(&tick.1, (r.left - 6.0, y), l)?;
        }
    }
    let l = Lettering { size_px: LABEL_PX, ..SMALL };
    if panel.x.labelled {
        let place = (0.5 * (r.left + r.right), r.bottom + 1.9 * TICK_PX);
        canvas.text(&full_label(&panel.x, exponent), place, l)?;
    }
    if panel.y.labelled {
        let widest = plan.y_ticks.iter().map(|t| width_px(&t.1, TICK_PX)).fold(0.0, f64::max);
        let place = (r.left - widest - 12.0, 0.5 * (r.top + r.bottom));
        canvas.text(&plan.y_label, place, Lettering { upright: true, vertical: VPos::Bottom, ..l })?;
    }
    match panel.scale() {
        Some(heat) => heat.draw_scale(canvas, r, SMALL),
        None => Ok(()),
    }
}

impl Figure {
    /// The picture as an SVG document.
    ///
    /// # Errors
    /// Those of the SVG backend.
    pub fn svg(&self) -> io::Result<String> {
        draw(self)
    }
}
