//! beam-modes
mod beam;
mod compliance;
mod error;
mod flexure;
mod modes;
mod piece;
mod plane;
mod roots;
mod shapes;
mod span;
mod uniform;

pub use beam::{Beam, End, Segment};
pub use error::InvalidInput;
pub use modes::Modes;
