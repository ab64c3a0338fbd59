//! The kinds of file that a figure can be written to.

use std::io;
use std::path::Path;

use super::Figure;

/// Pixels of a PNG file for each pixel of the figure: sharp on paper and on dense screens.
#[cfg(feature = "png")]
const FILE_SCALE: f64 = 2.0;

/// A kind of picture file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Lines and text, at any size.
    Svg,
    /// Pixels.
    #[cfg(feature = "png")]
    Png,
}

impl Format {
    /// The endings that [`Format::of`] knows, for messages.
    pub const ENDINGS: &str = if cfg!(feature = "png") {
        "a file name that ends in .svg or .png"
    } else {
        "a file name that ends in .svg (this program was built without its feature png)"
    };

    /// The format for the ending of a file name, in capitals or not; `None` if it is not that of a picture.
    ///
    /// ```
    /// use vibroimpact::plot::Format;
    /// assert_eq!(Format::of("out/impact.SVG".as_ref()), Some(Format::Svg));
    /// assert_eq!(Format::of("impact.jpg".as_ref()), None);
    /// ```
    pub fn of(path: &Path) -> Option<Format> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "svg" => Some(Format::Svg),
            #[cfg(feature = "png")]
            "png" => Some(Format::Png),
            _ => None,
        }
    }
}

impl Figure {
    /// The content of a file in this format; a PNG has two pixels for one of the figure.
    ///
    /// # Errors
    /// A picture too large for pixels.
    pub fn bytes(&self, format: Format) -> io::Result<Vec<u8>> {
        match format {
            Format::Svg => self.svg().map(String::into_bytes),
            #[cfg(feature = "png")]
            Format::Png => self.png(FILE_SCALE),
        }
    }

    /// Writes the picture to a file, as SVG or PNG by the ending of its name. The file appears complete or not at all; missing
    /// folders are created.
    ///
    /// # Errors
    /// Another ending, or a place that cannot be written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        let format = Format::of(path).ok_or_else(|| {
            let message = format!("the file name {} is not allowed; it must be {}", path.display(), Format::ENDINGS);
            io::Error::new(io::ErrorKind::InvalidInput, message)
        })?;
        crate::report::write_whole(path, &self.bytes(format)?)
    }
}
