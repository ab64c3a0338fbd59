//! The data series of a panel.

use super::colour::Colour;

/// The marker at a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marker {
    /// Open circle.
    Circle,
    /// Diagonal cross.
    Cross,
    /// Upright cross.
    Plus,
    /// Open square.
    Square,
    /// Open triangle.
    Triangle,
    /// Small filled circle.
    Dot,
}

/// How the points of a series are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mark {
    Line,
    Points(Marker),
    LinePoints(Marker),
    Step,
    Stem(Marker),
    Band,
    ErrorBars(Marker),
    LevelErrorBars(Marker),
    Spans,
    Labels,
    VerticalRule,
    HorizontalRule,
}

/// Data drawn in one style.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
    /// Upper edge of a band; half length of an error bar; right end of a span.
    pub(super) spread: Vec<f64>,
    /// Texts of labels.
    pub(super) texts: Vec<String>,
    pub(super) mark: Mark,
    pub(super) label: String,
    pub(super) colour: Option<Colour>,
    pub(super) dashed: bool,
    pub(super) width_px: f64,
    /// Of areas.
    pub(super) opacity: f64,
}

impl Series {
    fn new(x: &[f64], y: &[f64], mark: Mark) -> Series {
        let n = x.len().min(y.len());
        Series {
            x: x[..n].to_vec(),
            y: y[..n].to_vec(),
            spread: Vec::new(),
            texts: Vec::new(),
            mark,
            label: String::new(),
            colour: None,
            dashed: false,
            width_px: 1.4,
            opacity: 0.22,
        }
    }

    /// A line through the points, interrupted where a value is not finite. If the slices differ
    /// in length, the longer one is cut; the same holds for all series.
    pub fn line(x: &[f64], y: &[f64]) -> Series {
        Series::new(x, y, Mark::Line)
    }

    /// A marker at each point.
    pub fn points(x: &[f64], y: &[f64], marker: Marker) -> Series {
        Series::new(x, y, Mark::Points(marker))
    }

    /// A thin line through the points and a marker at each.
    pub fn line_points(x: &[f64], y: &[f64], marker: Marker) -> Series {
        Series { width_px: 0.8, ..Series::new(x, y, Mark::LinePoints(marker)) }
    }

    /// A value that holds from its abscissa to the next.
    pub fn step(x: &[f64], y: &[f64]) -> Series {
        Series::new(x, y, Mark::Step)
    }

    /// An upright line from zero to each point.
    pub fn stem(x: &[f64], y: &[f64], marker: Marker) -> Series {
        Series::new(x, y, Mark::Stem(marker))
    }

    /// The area between two curves.
    pub fn band(x: &[f64], low: &[f64], high: &[f64]) -> Series {
        let n = x.len().min(low.len()).min(high.len());
        Series { spread: high[..n].to_vec(), ..Series::new(&x[..n], low, Mark::Band) }
    }

    /// A marker at each point with a bar from `y - half` to `y + half`.
    pub fn error_bars(x: &[f64], y: &[f64], half: &[f64], marker: Marker) -> Series {
        let n = x.len().min(y.len()).min(half.len());
        Series { spread: half[..n].to_vec(), ..Series::new(&x[..n], y, Mark::ErrorBars(marker)) }
    }

    /// A marker at each point with a bar from `x - half` to `x + half`.
    pub fn level_error_bars(x: &[f64], y: &[f64], half: &[f64], marker: Marker) -> Series {
        let n = x.len().min(y.len()).min(half.len());
        Series { spread: half[..n].to_vec(), ..Series::new(&x[..n], y, Mark::LevelErrorBars(marker)) }
    }

    /// Grey stripes across the panel from each `from` to its `to`, at least as wide as a thin line.
    pub fn spans(from: &[f64], to: &[f64]) -> Series {
        let n = from.len().min(to.len());
        Series {
            spread: to[..n].to_vec(),
            colour: Some(Colour::Grey),
            ..Series::new(&from[..n], &vec![0.0; n], Mark::Spans)
        }
    }

    /// A text above each point; one that would run into an earlier one is left out.
    pub fn labels(x: &[f64], y: &[f64], texts: impl IntoIterator<Item = String>) -> Series {
        let texts: Vec<String> = texts.into_iter().take(x.len().min(y.len())).collect();
        let n = texts.len();
        Series { texts, colour: Some(Colour::Black), ..Series::new(&x[..n], &y[..n], Mark::Labels) }
    }

    /// A thin grey upright line across the panel.
    pub fn vertical_rule(x: f64) -> Series {
        Series { colour: Some(Colour::Grey), width_px: 0.8, ..Series::new(&[x], &[0.0], Mark::VerticalRule) }
    }

    /// A thin grey level line across the panel.
    pub fn horizontal_rule(y: f64) -> Series {
        Series { colour: Some(Colour::Grey), width_px: 0.8, ..Series::new(&[0.0], &[y], Mark::HorizontalRule) }
    }

    /// Name in the legend; a series without one is not listed.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Series {
        self.label = label.into();
        self
    }

    /// Sets the colour; otherwise the series takes the next of the palette.
    #[must_use]
    pub fn colour(mut self, colour: Colour) -> Series {
        self.colour = Some(colour);
        self
    }

    /// Draws the line dashed.
    #[must_use]
    pub fn dashed(mut self) -> Series {
        self.dashed = true;
        self
    }

    /// Sets the width of the line (px).
    #[must_use]
    pub fn line_width(mut self, width_px: f64) -> Series {
        self.width_px = width_px;
        self
    }

    /// Sets the opacity of areas, from 0 to 1.
    #[must_use]
    pub fn opacity(mut self, opacity: f64) -> Series {
        self.opacity = if opacity.is_finite() { opacity.clamp(0.0, 1.0) } else { 1.0 };
        self
    }

    pub(super) fn has_markers(&self) -> bool {
        use Mark::{ErrorBars, LevelErrorBars, LinePoints, Points, Stem};
        matches!(self.mark, Points(_) | LinePoints(_) | Stem(_) | ErrorBars(_) | LevelErrorBars(_))
    }

    /// Values that have to lie within the horizontal limits.
    pub(super) fn abscissas(&self) -> impl Iterator<Item = f64> + '_ {
        let counted = self.mark != Mark::HorizontalRule;
        let values = self.x.iter().enumerate().flat_map(|(i, &x)| match self.mark {
            Mark::Spans => [x, self.spread[i]],
            Mark::LevelErrorBars(_) => [x - self.spread[i], x + self.spread[i]],
            _ => [x, x],
        });
        values.filter(move |_| counted)
    }

    /// Values that have to lie within the vertical limits.
    pub(super) fn ordinates(&self) -> impl Iterator<Item = f64> + '_ {
        let counted = !matches!(self.mark, Mark::VerticalRule | Mark::Spans);
        let values = self.y.iter().enumerate().flat_map(|(i, &y)| match self.mark {
            Mark::Band => [y, self.spread[i]],
            Mark::ErrorBars(_) => [y - self.spread[i], y + self.spread[i]],
            Mark::Stem(_) => [y, 0.0],
            _ => [y, y],
        });
        values.filter(move |_| counted)
    }
}
