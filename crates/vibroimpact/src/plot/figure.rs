//! A picture and its panels.

use super::axis::Axis;
use super::heat::HeatMap;
use super::series::Series;

/// A picture: rows of panels under one title.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Text above the panels; may be empty.
    pub title: String,
    /// Panels from top to bottom, each row from left to right.
    pub rows: Vec<Vec<Panel>>,
    /// Width of the whole picture (px). The height follows from the panels.
    pub width_px: f64,
}

impl Figure {
    /// An empty figure of 760 px width.
    pub fn new(title: impl Into<String>) -> Figure {
        Figure { title: title.into(), rows: Vec::new(), width_px: 760.0 }
    }

    /// Adds a row of panels at the bottom.
    #[must_use]
    pub fn row(mut self, panels: impl IntoIterator<Item = Panel>) -> Figure {
        self.rows.push(panels.into_iter().collect());
        self
    }

    /// Sets the width of the picture (px), held between 200 and 4000.
    #[must_use]
    pub fn width(mut self, width_px: f64) -> Figure {
        self.width_px = width_px;
        self
    }
}

/// One pair of axes with its data.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Text above the axes; may be empty.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// Height of the rectangle between the axes (px).
    pub height_px: f64,
    /// The series, the first at the bottom.
    pub series: Vec<Series>,
    /// A map under the series.
    pub heat: Option<HeatMap>,
}

impl Panel {
    /// An empty panel, 190 px high.
    pub fn new(x: Axis, y: Axis) -> Panel {
        Panel { title: String::new(), x, y, height_px: 190.0, series: Vec::new(), heat: None }
    }

    /// Sets the text above the axes.
    #[must_use]
    pub fn title(mut self, title: impl Into<String>) -> Panel {
        self.title = title.into();
        self
    }

    /// Sets the height of the rectangle between the axes (px), held between 20 and 2000.
    #[must_use]
    pub fn height(mut self, height_px: f64) -> Panel {
        self.height_px = height_px;
        self
    }

    /// Adds a series on top of the others.
    #[must_use]
    pub fn with(mut self, series: Series) -> Panel {
        self.series.push(series);
        self
    }

    /// Lays a map under the series.
    #[must_use]
    pub fn map(mut self, heat: HeatMap) -> Panel {
        self.heat = Some(heat);
        self
    }

    /// The map whose scale of colours is drawn beside the panel.
    pub(super) fn scale(&self) -> Option<&HeatMap> {
        self.heat.as_ref().filter(|heat| heat.value.labelled)
    }
}
