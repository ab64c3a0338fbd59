//! beam-modes
mod axial;
mod beam;
mod compliance;
mod error;
pub mod fem;
mod flexure;
mod modes;
mod piece;
mod plane;
mod rod;
mod roots;
mod shapes;
mod span;
mod uniform;

pub use beam::{Beam, End, Segment};
pub use error::InvalidInput;
pub use modes::Modes;
pub use rod::{Rod, RodEnd, RodSegment};
