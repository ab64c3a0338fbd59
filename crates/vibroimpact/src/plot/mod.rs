//! Charts in one consistent style, as SVG and PNG.
//!
//! A [`Figure`] is rows of [`Panel`]s; a panel has two [`Axis`] descriptions and either series
//! (lines, markers, steps, stems, bands, error bars) or a [`HeatMap`]. Axis limits, ticks,
//! margins and legends are computed from the data; the same figure always gives the same
//! bytes. Values that are not finite are omitted and interrupt a line. Colours are those of
//! Okabe and Ito (2008), which can be distinguished with any colour vision; maps use viridis, or
//! blue to red where their limits lie about zero.
//!
//! ```
//! use vibroimpact::plot::{Axis, Figure, Marker, Panel, Series};
//! let modes: Vec<f64> = (0..40).map(f64::from).collect();
//! let restitution: Vec<f64> = modes.iter().map(|n| 0.2 + 0.8 / (1.0 + n)).collect();
//! let svg = Figure::new("Restitution against the number of modes")
//!     .row([Panel::new(Axis::new("modes N").integers(), Axis::new("restitution e"))
//!         .with(Series::points(&modes, &restitution, Marker::Circle).label("undamped"))])
//!     .svg()?;
//! assert!(svg.starts_with("<svg"));
//! # Ok::<(), std::io::Error>(())
//! ```

mod axis;
mod canvas;
mod colour;
mod figure;
mod format;
mod heat;
mod layout;
mod panel;
#[cfg(feature = "png")]
mod png;
mod series;
mod text;

pub use axis::Axis;
pub use colour::Colour;
pub use figure::{Figure, Panel};
pub use format::Format;
pub use heat::HeatMap;
pub use series::{Marker, Series};

#[cfg(test)]
mod tests;
