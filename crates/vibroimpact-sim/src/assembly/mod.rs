//! Many bodies, contacts and loads over long times.
//!
//! # The problem
//! All bodies together are one list of mass-normalised modes. A contact `c` joins a point A and a point B, of two bodies
//! or of a body and the ground, along one axis `x`; A lies on the side of greater `x`:
//!
//! ```text
//! a_k'' + 2 zeta_k omega_k a_k' + omega_k^2 a_k = -sum_c psi_kc F_c + f_k(t)
//! xi_c = sum_k psi_kc a_k - gap_c,      psi_kc = phi_kB - phi_kA,      F_c = law_c(xi_c, xi_c') >= 0
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `a_k`, `phi_k` | modal amplitude; mass-normalised shape at a point | m kg^1/2; kg^-1/2 |
//! | `omega_k`, `zeta_k` | undamped circular frequency (0: rigid-body mode), damping ratio | rad/s, 1 |
//! | `psi_kc` | overlap of a contact for a unit amplitude | kg^-1/2 |
//! | `xi_c`, `F_c` | overlap (compression where it is positive) and force of a contact, which pushes A along `+x` | m, N |
//! | `f_k` | modal load | N kg^-1/2 |
//!
//! One striker against one structure ([`crate::modal`]) is the case of two bodies, one contact and no load.
//!
//! # The method
//! The modes are linear and uncoupled, and are propagated exactly on panels of `2^-j` s whose tables are cached
//! (`tables.rs`). Modes are computed relative to their steady motion under the loads, so that loads cost nothing on a panel
//! (`load.rs`). The only unknowns are the forces of closed contacts: polynomials through Gauss nodes, times `t^(3/2)` where they
//! begin or end so (`panel/ends.rs`), whose values the laws determine. Newton's method finds them, with a matrix that has a block
//! for every two contacts on one body (`collocate.rs`).
//!
//! Time integration (`march.rs`) computes a panel and checks it. The panel is accepted, tried again with a shorter length, or
//! ended at an event. Three rules hold for every accepted panel:
//!
//! 1. the truncation of each force, and its defect in the law at the end of the panel, are below a quarter of the tolerance
//!    in impulse (on a terminal panel the truncation alone);
//! 2. no event function falls to zero on it. An event function is the distance to a boundary of a law's branch, or of
//!    the separation of an open contact. It is represented by a polynomial with an error bound (`enclosure.rs`), and on a
//!    panel with closed contacts only `event.rs` tests it. A panel of `2^-j` s on which it comes within the bound of zero
//!    is too long; on a terminal panel the series are exact to rounding;
//! 3. it lies in one branch of every law. An event is the end of a terminal panel (`terminal.rs`), whose length is the
//!    root of the event function; one law transition follows.
//!
//! Without closed contacts a panel is as long as the bound on the motion of the open ones allows.
//!
//! On request the energy balance is computed panel by panel (`ledger.rs`, `damping.rs`, `excess.rs`).
//!
//! # Limits
//! Bodies are linear, contacts are points that move along one axis; there is no friction. A harmonic load at the frequency
//! of an undamped mode is rejected. Errors grow along a chaotic motion: compare with a run at another tolerance to find the time
//! up to which event times agree.

mod branch;
pub(crate) mod change;
mod collocate;
mod damping;
mod damping_form;
mod damping_series;
pub(crate) mod dense;
pub(crate) mod differentiate;
mod enclosure;
mod event;
mod excess;
mod first_panel;
mod flight;
mod forced;
mod interpolation;
mod judge;
mod landing;
pub(crate) mod ledger;
pub(crate) mod load;
mod load_change;
mod march;
mod miss;
mod momentum;
mod motion;
mod no_derivative;
mod orbit;
mod orbit_settings;
mod period;
mod period_map;
pub(crate) mod problem;
mod record;
mod reliability;
pub(crate) mod responses;
mod rest;
mod rise;
mod rounding;
mod search;
mod solution;
pub(crate) mod solve;
mod state;
mod stencil;
mod survey;
pub(crate) mod system;
pub(crate) mod tables;
pub(crate) mod tangent;
mod terminal;
mod transition;
mod trial;
mod watch;
pub(crate) mod wave;

pub use branch::{Branch, BranchPoint, BranchSettings, Special, SpecialPoint, follow_beginning, follow_branch};
pub use differentiate::{ContactDerivatives, Derivative, Derivatives, Differentiated, IntervalDerivatives, Parameter};
pub use miss::NearMiss;
pub use no_derivative::NoDerivative;
pub use orbit::{Orbit, OrbitOutcome, Recurrence};
pub use orbit_settings::OrbitSettings;
pub use period::CommonPeriod;
pub use problem::{Assembly, Body, BodyMode, Contact, Force, Load, Point, Settings};
pub use search::{find_orbit, find_orbit_until};
pub use solution::{
    ContactEnd, ContactSample, Counts, Interval, Ledger, Motion, Observer, Outcome, Reason, Run, Statistics,
};
pub use solve::{Solver, run};
pub use stencil::Stencil;
pub use survey::SideMotion;
