//! Drawing in pixels with fractions, on top of the SVG backend of `plotters`.

use super::series::Marker;
use super::text::printable;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::io;

/// The backend has whole numbers only: it draws at ten times the size, and the view box
/// scales the picture back.
const FINE: f64 = 10.0;

/// A rectangle (px).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rectangle {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl Rectangle {
    pub fn width(&self) -> f64 {
        self.right - self.left
    }

    pub fn height(&self) -> f64 {
        self.bottom - self.top
    }
}

/// Colour, opacity and width of a stroke.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pen {
    pub colour: RGBColor,
    pub opacity: f64,
    pub width_px: f64,
    pub dashed: bool,
}

impl Pen {
    pub fn new(colour: RGBColor, width_px: f64) -> Pen {
        Pen { colour, opacity: 1.0, width_px, dashed: false }
    }

    fn stroke(&self) -> ShapeStyle {
        let width = (self.width_px * FINE).clamp(1.0, 1e3).round() as u32;
        ShapeStyle { color: self.colour.mix(self.opacity), filled: false, stroke_width: width }
    }
}

/// Size and place of a text relative to its anchor.
#[derive(Clone, Copy)]
pub(super) struct Lettering {
    pub size_px: f64,
    pub colour: RGBColor,
    pub horizontal: HPos,
    pub vertical: VPos,
    pub upright: bool,
}

/// A drawing area.
pub(super) struct Canvas<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
}

type Point = (f64, f64);

fn fine((x, y): Point) -> (i32, i32) {
    let whole = |v: f64| (v * FINE).round().clamp(-1e6, 1e6) as i32;
    (whole(x), whole(y))
}

impl<'a> Canvas<'a> {
    fn draw<'b, E, B>(&self, element: &'b E) -> io::Result<()>
    where
        B: plotters::element::CoordMapper,
        &'b E: plotters::element::PointCollection<'b, (i32, i32), B>,
        E: plotters::element::Drawable<SVGBackend<'a>, B>,
    {
        self.area.draw(element).map_err(|e| io::Error::other(e.to_string()))
    }

    /// A line through points that are all inside the picture.
    pub fn path(&self, points: &[Point], pen: Pen) -> io::Result<()> {
        let mut places: Vec<(i32, i32)> = points.iter().map(|&p| fine(p)).collect();
        places.dedup();
        if pen.dashed {
            self.draw(&plotters::element::DashedPathElement::new(places, 50, 35, pen.stroke()))
        } else {
            self.draw(&PathElement::new(places, pen.stroke()))
        }
    }

    /// A line through points, cut off at the edges of `within`.
    pub fn clipped_path(&self, points: &[Point], within: &Rectangle, pen: Pen) -> io::Result<()> {
        let mut piece: Vec<Point> = Vec::new();
        for pair in points.windows(2) {
            let Some((a, b)) = clip(pair[0], pair[1], within) else { continue };
            if piece.last() != Some(&a) {
                self.path_of_some_length(&piece, pen)?;
                piece.clear();
                piece.push(a);
            }
            piece.push(b);
        }
        self.path_of_some_length(&piece, pen)
    }

    fn path_of_some_length(&self, piece: &[Point], pen: Pen) -> io::Result<()> {
        if piece.len() > 1 { self.path(piece, pen) } else { Ok(()) }
    }

    /// A filled rectangle.
    pub fn fill(&self, r: &Rectangle, colour: RGBColor) -> io::Result<()> {
        self.draw(&plotters::element::Rectangle::new(
            [fine((r.left, r.top)), fine((r.right, r.bottom))],
            colour.filled(),
        ))
    }

    /// A filled area.
    pub fn polygon(&self, points: &[Point], colour: RGBColor, opacity: f64) -> io::Result<()> {
        let places: Vec<(i32, i32)> = points.iter().map(|&p| fine(p)).collect();
        self.draw(&Polygon::new(places, colour.mix(opacity).filled()))
    }

    /// The outline of a rectangle.
    pub fn frame(&self, r: &Rectangle, pen: Pen) -> io::Result<()> {
        let corners = [(r.left, r.top), (r.right, r.top), (r.right, r.bottom), (r.left, r.bottom), (r.left, r.top)];
        self.path(&corners, pen)
    }

    /// A marker at a point.
    pub fn marker(&self, (x, y): Point, marker: Marker, colour: RGBColor) -> io::Result<()> {
        let pen = Pen::new(colour, 1.1);
        let arm = 2.6;
        match marker {
            Marker::Circle => self.draw(&Circle::new(fine((x, y)), (arm * FINE) as i32, pen.stroke())),
            Marker::Dot => self.draw(&Circle::new(fine((x, y)), (1.9 * FINE) as i32, colour.filled())),
            Marker::Cross => {
                self.path(&[(x - arm, y - arm), (x + arm, y + arm)], pen)?;
                self.path(&[(x - arm, y + arm), (x + arm, y - arm)], pen)
            }
            Marker::Plus => {
                self.path(&[(x - 1.3 * arm, y), (x + 1.3 * arm, y)], pen)?;
                self.path(&[(x, y - 1.3 * arm), (x, y + 1.3 * arm)], pen)
            }
            Marker::Square => {
                self.frame(&Rectangle { left: x - arm, top: y - arm, right: x + arm, bottom: y + arm }, pen)
            }
            Marker::Triangle => {
                let (top, foot) = ((x, y - 1.3 * arm), y + 0.9 * arm);
                self.path(&[top, (x + 1.2 * arm, foot), (x - 1.2 * arm, foot), top], pen)
            }
        }
    }

    /// A text; `upright` turns it to read from below.
    pub fn text(&self, text: &str, place: Point, l: Lettering) -> io::Result<()> {
        // the backend divides the size by 1.24
        let font = FontDesc::new(FontFamily::SansSerif, l.size_px * FINE * 1.24, FontStyle::Normal);
        let turn = if l.upright { FontTransform::Rotate270 } else { FontTransform::None };
        let style = TextStyle::from(font.transform(turn)).color(&l.colour).pos(Pos::new(l.horizontal, l.vertical));
        self.draw(&Text::new(printable(text), fine(place), style))
    }
}

/// Runs `paint` on a white picture and gives the SVG document.
pub(super) fn picture(
    (width_px, height_px): (f64, f64),
    title: &str,
    paint: impl FnOnce(&Canvas) -> io::Result<()>,
) -> io::Result<String> {
    let (width, height) = (width_px.round(), height_px.round());
    let mut body = String::new();
    {
        let size = ((width * FINE) as u32, (height * FINE) as u32);
        let canvas = Canvas { area: SVGBackend::with_string(&mut body, size).into_drawing_area() };
        canvas.area.fill(&WHITE).map_err(|e| io::Error::other(e.to_string()))?;
        paint(&canvas)?;
        canvas.area.present().map_err(|e| io::Error::other(e.to_string()))?;
    }
    let rest = body.split_once('>').map_or("", |(_, rest)| rest);
    let title = printable(&title.replace('\n', "; ")).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {} {}\" \
         role=\"img\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n<title>{title}</title>{rest}",
        width * FINE,
        height * FINE
    ))
}

/// The part of a segment inside a rectangle (Liang and Barsky 1984).
fn clip(a: Point, b: Point, within: &Rectangle) -> Option<(Point, Point)> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    let edges =
        [(-dx, a.0 - within.left), (dx, within.right - a.0), (-dy, a.1 - within.top), (dy, within.bottom - a.1)];
    for (slope, distance) in edges {
        match slope {
            s if s < 0.0 => enter = enter.max(distance / s),
            s if s > 0.0 => leave = leave.min(distance / s),
            _ if distance < 0.0 => return None,
            _ => {}
        }
    }
    let at = |t: f64| (a.0 + t * dx, a.1 + t * dy);
    let start = if enter == 0.0 { a } else { at(enter) };
    let end = if leave == 1.0 { b } else { at(leave) };
    (enter <= leave).then_some((start, end))
}
