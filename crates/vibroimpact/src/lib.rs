//! From a scene file to the rebound: a compact body strikes a slender vibrating one.
//!
//! A [`Scene`] describes an impact: a beam of segments (or a structure given by its modes), a striker, a law of contact,
//! a location. [`Scene::impact`] converts it into the input of the solver, and [`Impact::solve`] resolves
//! every contact until it is certain that the bodies never meet again.
//!
//! ```
//! use vibroimpact::Scene;
//! use vibroimpact::vibroimpact_sim::modal::Outcome;
//!
//! let scene = Scene::from_json(r#"{
//!     "structure": { "kind": "beam", "ends": ["clamped", "free"], "damping_ratio": 0.02,
//!                    "segments": [{ "length_m": 1, "flexural_rigidity_n_m2": 274, "mass_per_length_kg_m": 1 }] },
//!     "striker": { "mass_kg": 0.1, "speed_m_s": 1 },
//!     "contact": { "law": "hertz", "stiffness_n_m1_5": 1.8e10 },
//!     "location_m": 0.9, "modes": 100, "residual_compliance": true
//! }"#)?;
//! let solution = scene.impact()?.solve()?;
//! assert_eq!(solution.outcome, Outcome::Rebound);
//! for contact in &solution.sub_impacts {
//!     println!("{} s to {} s: {} N s", contact.start_s, contact.end_s, contact.impulse_n_s);
//! }
//! # Ok::<(), vibroimpact::SceneError>(())
//! ```
//!
//! | module | content |
//! |---|---|
//! | [`scene`] | the scene file, JSON or TOML, field by field, and its errors |
//! | [`scene::schema`] | its JSON Schema |
//! | [`draft`] | a scene file whose fields can still be changed |
//! | [`deflection`] | how a beam or a string deflects along its length during an impact |
//! | [`summary`], [`text`] | a result as JSON for programs, and as text |
//! | [`simulate`] | the impact of a scene of any kind, its result and its tables |
//! | [`model`] | the choice of the model: rigid, infinite beam, modes, or a net law |
//! | [`trust`] | how far the theories behind a result can be trusted |
//! | [`net`] | the net restitution without integration in time, and the parameters of that law from data |
//! | [`identify`] | fields of a scene from measurements, by resolved impacts |
//! | [`export`] | histories as CSV, pictures, the result as JSON |
//! | [`pictures`] | an impact, modes, and results of several models as figures |
//! | [`infinite`] | the same for impacts on infinite beams and plates |
//! | [`assembly`] | scenes of many bodies, contacts and loads over long times |
//! | [`orbit`] | periodic motions of such scenes and their branches |
//! | [`law`] | parameters of contact laws for a given restitution |
//! | [`sensitivity`] | derivatives of an impact with respect to the numbers of its scene |
//! | [`sweep`] | many scenes that differ in some fields: grids, lists, ranges, random draws |
//! | [`plot`], [`report`] | charts, and reports that compare published numbers with ours |
//!
//! The underlying crates are re-exported: [`beam_modes`], [`contact_models`], [`vibroimpact_sim`], [`emoc`],
//! [`fitting`], [`fracdiff`], [`invalid_input`].
//!
//! Without default features the crate reads scenes and solves them, without the program (feature `program`) and without files:
//! tables, figures, reports, sweeps (feature `files`). It then also runs on `wasm32-unknown-unknown`.
//!
//! # Limits
//!
//! For a single impact structures are linear, the contact is one point, and the striker moves along one line without
//! rotation. Gravity and friction are neglected during the impact. The mathematics, with its symbols, is in the documentation of
//! the solvers' crates.

// without files some helpers of sweeps and figures are not used
#![cfg_attr(not(feature = "files"), allow(dead_code, unused_imports))]

mod impact;
mod in_scene;
mod input;
mod result_file;
mod same_modes;

pub mod assembly;
pub mod deflection;
pub mod draft;
pub mod export;
pub mod identify;
pub mod infinite;
pub mod law;
pub mod model;
pub mod net;
pub mod orbit;
#[cfg(feature = "files")]
pub mod pictures;
#[cfg(feature = "files")]
pub mod plot;
#[cfg(feature = "files")]
pub mod report;
pub mod scene;
pub mod sensitivity;
pub mod simulate;
mod stop_word;
pub mod summary;
#[cfg(feature = "files")]
pub mod sweep;
pub mod text;
pub mod trust;

pub use beam_modes;
pub use contact_models;
pub use emoc;
pub use fitting;
pub use fracdiff;
pub use impact::Impact;
pub use invalid_input;
pub use result_file::{ResultFile, SubImpact};
pub use scene::{InvalidInput, Scene, SceneError};
pub use vibroimpact_sim;

/// Runs the example of the readme.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
