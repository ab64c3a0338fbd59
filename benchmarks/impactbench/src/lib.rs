//! A benchmark of impact for any code.
//!
//! `cargo xtask impactbench` runs this package; `docs/impactbench.md` shows the results and how to add a code.
//!
//! A problem is a file in `problems`: bodies by their modes, contacts between them, and the requested quantities with their
//! references. All bodies together satisfy
//!
//! ```text
//! a_k'' + 2 zeta_k omega_k a_k' + omega_k^2 a_k = sum phi_k F                                             (1)
//! ```
//!
//! over the forces of contacts, loads and gravity, with mass-normalised modes: a free mass has one, of frequency 0 and
//! shape `m^(-1/2)`. A contact pushes its upper body up and its lower one, if it is not the ground, down, with the force of
//! its law at the compression
//!
//! ```text
//! xi = sum phi_k a_k (lower) - sum phi_k a_k (upper) - gap.                                              (2)
//! ```
//!
//! | module | content |
//! |---|---|
//! | [`problem`] | the file of a problem |
//! | [`library`] | the definitions of the problems, with their references |
//! | [`system`] | a problem as a system of ordinary differential equations, and as an assembly of this workspace |
//! | [`codes`] | the codes in Rust, each with its settings |
//! | [`outcome`] | the result of a code: a line of a table of results |
//! | [`judge`] | errors, kinds of failure, numbers of problems solved |
//! | [`report`] | the page and its figures |

pub mod codes;
pub mod judge;
pub mod library;
pub mod outcome;
pub mod problem;
pub mod report;
pub mod system;
