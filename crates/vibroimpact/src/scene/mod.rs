//! Scenes: impacts as JSON or TOML files.
//!
//! The types mirror the file field by field; [`Scene::impact`] converts them into the input of the solver. Fields are required
//! unless a default is stated. All quantities are in SI units, and every name contains its unit. A file may state
//! `"version": 1`, the version of this format, and its schema as `"$schema"`, for editors. An object that needs numbers of a
//! material may name one of [`MATERIALS`] instead: `"material": "steel"`.
//!
//! A scene can also be built in Rust:
//!
//! ```
//! use vibroimpact::model::Modes;
//! use vibroimpact::scene::{Beam, Contact, End, HertzStiffness, RectangularSegment, Scene, Striker};
//!
//! let side_m = 0.011323;
//! let segment = RectangularSegment {
//!     length_m: 1.0,
//!     youngs_modulus_pa: 2e11,
//!     density_kg_m3: 7800.0,
//!     width_m: side_m,
//!     thickness_m: side_m,
//! };
//! let beam = Beam {
//!     segments: vec![segment.into()],
//!     damping_ratio: 0.02,
//!     ..Beam::new([End::Pinned, End::Pinned])
//! };
//! let scene = Scene {
//!     location_m: Some(0.6180339887498949.into()),
//!     modes: Modes::Count(100),
//!     residual_compliance: Some(true),
//!     ..Scene::new(beam, Striker::sphere(7800.0, 0.015, 1.0), Contact::Hertz(HertzStiffness::of_material(2e11, 0.3)))
//! };
//! let solution = scene.impact()?.solve()?;
//! assert!((solution.restitution.unwrap() - 0.142555).abs() < 2e-6);
//! # Ok::<(), vibroimpact::InvalidInput>(())
//! ```

mod beam;
mod beam_theory;
mod choice;
mod contact;
pub(crate) mod damping;
mod definition;
mod dropped_rod;
mod error;
mod extreme;
pub(crate) mod fields;
mod files;
mod fittings;
mod from_tree;
mod infinite;
pub(crate) mod json;
mod known;
mod location;
mod material;
mod materials;
mod modal;
mod modes_file;
mod motion;
mod path;
mod place;
mod plate;
pub(crate) mod ranges;
mod remainder;
pub mod schema;
mod segment;
pub(crate) mod sets;
mod start;
mod striker;
mod string;
mod structure;
mod theory;
pub(crate) mod told;
pub(crate) mod toml;
mod waves;

pub use beam::{Beam, End};
pub use beam_modes::RectangularSegment;
pub use beam_theory::BeamTheory;
pub use choice::{Model, Modes};
pub use contact::Contact;
pub use definition::Scene;
pub(crate) use definition::{chooses_modes, modal_only, read_modes_into};
pub use dropped_rod::DroppedRod;
pub use error::SceneError;
pub(crate) use error::{as_json, require_positive};
pub(crate) use extreme::{follows_from, most_extreme_in, of_computed_mode, such_that};
pub use files::FORMAT_VERSION;
pub(crate) use files::{A_SCENE, check_version, plain_tree, read_tree, utf8, versioned_tree};
pub use fittings::{Attachment, Support};
pub use infinite::{InfiniteBeam, InfinitePlate};
pub use invalid_input::InvalidInput;
pub(crate) use known::KnownModes;
pub use location::Location;
pub use material::{MATERIALS, NamedMaterial};
pub use materials::{HertzStiffness, Materials};
pub use modal::{Modal, Point};
pub use modes_file::ModesFile;
pub use path::FieldPath;
pub use place::MOST_MODES;
pub(crate) use place::{Place, require_count};
pub use plate::{CONVERGED_FREQUENCY, Edge, Plate, PlateTheory};
pub(crate) use remainder::{COMPLETE, compliance, require_elastic, rigid_mobility};
pub use segment::Segment;
pub(crate) use start::by_frequency;
pub use start::{MovingMode, Start};
pub use striker::Striker;
pub use string::TautString;
pub use structure::Structure;
pub use theory::TheoryVariant;
pub(crate) use waves::Waves;

pub(crate) use material::numbers_of_materials;
pub(crate) use modes_file::table_path;
