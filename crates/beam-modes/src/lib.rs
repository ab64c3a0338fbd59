//! Exact natural modes of stepped Euler-Bernoulli beams in bending and of stepped rods in axial vibration, their static
//! compliance, and a Hermite finite-element model of the same beams.
//!
//! # The mathematics
//! A beam of uniform segments obeys `EI w'''' = m omega^2 w` on each segment (thesis Eq. 4.1 without force), with `w`,
//! `w'`, `EI w''` and `EI w'''` continuous at the steps and two conditions at either end. Its modes `phi_k` are
//! orthonormal in mass, `int m phi_i phi_j dx = delta_ij` (Eq. 4.4).
//!
//! | symbol | meaning | unit | equation |
//! |---|---|---|---|
//! | `EI` | flexural rigidity of a segment | N m^2 | 4.1 |
//! | `EA` | axial rigidity of a segment | N | |
//! | `m` | mass per length, the thesis's `rho A` | kg/m | 4.1 |
//! | `omega_k` | natural frequency | rad/s | 4.5 |
//! | `phi_k` | mass-normalised mode shape | kg^(-1/2) | 4.4 |
//! | `k` | wave number of a segment, `(m omega^2 / EI)^(1/4)`; axial, `omega sqrt(m/EA)` | 1/m | |
//! | `G(x,y)` | static Green's function, `sum phi_k(x) phi_k(y) / omega_k^2` over elastic modes | m/N | |
//!
//! # The method
//! 1. Each end allows a plane of states (displacement, slope, moment, shear). The plane is carried along the beam as
//!    an orthonormal basis, turned at every span so that the growing exponential stands in one column and is measured
//!    at the far end. Nothing overflows and nothing cancels, however many waves a segment holds; on a segment shorter
//!    than a wave the power series of Krylov's functions take the place of sines and exponentials.
//! 2. The count of W. H. Wittrick and F. W. Williams (Q. J. Mech. Appl. Math. 24:263, 1971) tells how many natural
//!    frequencies lie below a trial one. Intervals are split until each holds one; the characteristic function,
//!    computed apart from the count and checked against its parity, then leads to the root. No frequency is missed.
//! 3. The planes from the left and from the right are compared at every span, and the mode is started where they agree
//!    best, that is, where the mode is large, and unrolled from there to both sides. Shapes of nearly equal frequencies
//!    are orthogonalised with closed-form integrals, which also give the norm.
//! 4. A uniform beam needs no search: one formula covers the ten pairs of ends.
//!
//! Neighbours whose rigidities are in the ratio 1e12, or lengths in the ratio 1e3, keep shapes orthonormal to 1e-11;
//! see `tests/stepped.rs`. Contrasts are refused beyond 1e12.
//!
//! # Limits
//! Euler-Bernoulli: no shear and no rotary inertia, which tell once a half wave is shorter than some ten thicknesses.
//! The beam is straight, without axial load, and bends in one plane; supports are at its ends.
//!
//! # Example
//! ```
//! use beam_modes::{Beam, End, Segment};
//! let thick = Segment::rectangular(0.5, 2e11, 7800.0, 0.0113, 0.0113);
//! let slim = Segment::rectangular(0.5, 2e11, 7800.0, 0.0113, 0.0060);
//! let beam = Beam { segments: vec![thick, slim], ends: [End::Clamped, End::Free] };
//! let modes = beam.modes(40)?;
//! let (omega, phi) = (modes.omega_rad_s(), modes.shapes_at(0.75)?);
//! // what forty modes leave out of the static compliance
//! let sum: f64 = omega.iter().zip(&phi).map(|(omega, phi)| (phi / omega).powi(2)).sum();
//! let residual = beam.static_compliance(0.75)? - sum;
//! assert!(residual > 0.0 && residual < 1e-4 * sum);
//! # Ok::<(), beam_modes::InvalidInput>(())
//! ```

mod axial;
mod beam;
mod compliance;
mod error;
pub mod fem;
mod flexure;
mod modes;
mod piece;
mod plane;
mod remainder;
mod rod;
mod roots;
mod shapes;
mod span;
mod uniform;

pub use beam::{Beam, End, Segment};
pub use error::InvalidInput;
pub use modes::Modes;
pub use remainder::{
    MOST_REMAINDER_MODES, PointMode, PointsMode, remainder_at_points, remainder_from_trend, remainder_modes,
};
pub use rod::{Rod, RodEnd, RodSegment};

/// Runs the example of the readme.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
