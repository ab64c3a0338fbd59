//! Pictures in pixels, drawn from the SVG with a built-in font, so that text is the same on every machine.

use std::io;
use std::sync::{Arc, LazyLock};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb::Database};

use super::Figure;

/// DejaVu Sans with all its characters, so that names in many scripts can be drawn.
const FONT: &[u8] = include_bytes!("../../fonts/DejaVuSans.ttf");
const FAMILY: &str = "DejaVu Sans";
/// Largest number of pixels of one picture, which limits its memory.
const MOST_PIXELS: f64 = 2e8;

static FONTS: LazyLock<Arc<Database>> = LazyLock::new(|| {
    let mut fonts = Database::new();
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family(FAMILY);
    Arc::new(fonts)
});

impl Figure {
    /// The picture as a PNG file, with `scale` pixels for one of the figure; text is set in DejaVu Sans, which the
    /// program contains. The same figure always gives the same bytes.
    ///
    /// # Errors
    /// A scale that is not a finite number above 0, or that makes more than 2e8 pixels or none.
    ///
    /// ```
    /// # use vibroimpact::plot::{Axis, Figure, Panel, Series};
    /// let panel = Panel::new(Axis::new("x"), Axis::new("y")).with(Series::line(&[0.0, 1.0], &[0.0, 1.0]));
    /// let png = Figure::new("A line").row([panel]).png(2.0)?;
    /// assert!(png.starts_with(b"\x89PNG"));
    /// # Ok::<(), std::io::Error>(())
    /// ```
    pub fn png(&self, scale: f64) -> io::Result<Vec<u8>> {
        let refused =
            |why: &str| io::Error::new(io::ErrorKind::InvalidInput, format!("scale = {scale} is not allowed; {why}"));
        if !(scale > 0.0 && scale.is_finite()) {
            return Err(refused("it must be a finite number greater than 0"));
        }
        let options = Options { fontdb: FONTS.clone(), font_family: FAMILY.to_owned(), ..Options::default() };
        let tree = Tree::from_str(&self.svg()?, &options).map_err(io::Error::other)?;
        let size = tree.size();
        let [width, height] = [size.width(), size.height()].map(|side| (f64::from(side) * scale).round());
        if !(width >= 1.0 && height >= 1.0 && width * height <= MOST_PIXELS) {
            return Err(refused(&format!(
                "it must give 1 to {MOST_PIXELS:e} pixels, and this picture would have {width} by {height}"
            )));
        }
        let mut pixels = Pixmap::new(width as u32, height as u32)
            .ok_or_else(|| refused("a picture of this size is not possible"))?;
        let scale = Transform::from_scale(width as f32 / size.width(), height as f32 / size.height());
        resvg::render(&tree, scale, &mut pixels.as_mut());
        pixels.encode_png().map_err(io::Error::other)
    }
}
