//! One impact of a compact body on a vibrating structure, fully resolved.
//!
//! | module | structure | method | thesis |
//! |---|---|---|---|
//! | [`modal`] | any that is described by its modes, at rest or moving | treated as the smallest assembly | chapters 3, 4 |
//! | [`infinite`] | infinite: the impulse response is a sum of powers of time | one scalar Volterra equation | chapter 2 |
//! | [`assembly`] | many bodies, contacts and loads, over long times | modes exact, the forces by collocation | not in the thesis |
//! | [`dropped_rod`] | a tilted rod that falls on an immovable surface, treated as a modal impact | as `modal` | chapter 8 |
//!
//! The documentation of each module begins with its mathematics and a table of symbols. Throughout, `z` is the displacement of the
//! striker and `w` that of the structure at the contact (m), `xi` the compression (m), `F` the contact force (N), `m`
//! the striker's mass (kg), and the restitution the relative speed of separation over that of approach, both of
//! rigid-body motions.
//!
//! # Limits
//!
//! Structures are linear, and the contact is one point. The striker moves along one line and does not rotate. Gravity
//! and friction are neglected during the impact. Sustained contact on an infinite structure is detected for Hertz contact only;
//! with other laws a run stops if the contact lasts. An impact on many undamped modes amplifies every error; the stated
//! uncertainty shows by how much.

pub mod assembly;
mod concurrent;
pub mod dropped_rod;
pub mod infinite;
pub mod modal;
mod outcome;
mod panel;
mod stop;

pub use concurrent::both;
pub use invalid_input::InvalidInput;
pub use stop::StopReason;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
