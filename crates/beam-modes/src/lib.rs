//! Exact natural modes of stepped beams in bending, by Euler-Bernoulli's or Timoshenko's theory, with attachments, supports,
//! axial force and foundation ([`BeamSystem`]), and of stepped rods in axial vibration; modes of strings ([`TautString`]) and
//! of rectangular plates ([`Plate`]); their static compliance; remainder modes for the truncated modes of a model; and a
//! Hermite finite-element model.
//!
//! # The mathematics
//! A beam of uniform segments satisfies `EI w'''' = m omega^2 w` on each segment (thesis Eq. 4.1 without force), with `w`,
//! `w'`, `EI w''` and `EI w'''` continuous at the steps and two conditions at either end. Its modes `phi_k` are orthonormal in
//! mass, `int m phi_i phi_j dx = delta_ij` (Eq. 4.4).
//!
//! In Timoshenko's theory the rotation `theta` of a section differs from the slope (S. P. Timoshenko, Phil. Mag. 41:744, 1921):
//!
//! ```text
//! (kappa G A (w' - theta))' + m omega^2 w = 0,
//! (EI theta')' + kappa G A (w' - theta) + rho I omega^2 theta = 0,      int m w_i w_j + rho I theta_i theta_j dx = delta_ij.
//! ```
//!
//! Below `omega_c = sqrt(kappa G A / rho I)` one pair of waves propagates and one decays, above it both propagate (the second
//! spectrum). With axial force `T` (tension positive) and foundation `k_f`, Euler-Bernoulli's equation is
//! `EI w'''' - T w'' + k_f w = m omega^2 w`.
//!
//! | symbol | meaning | unit | equation |
//! |---|---|---|---|
//! | `EI` | flexural rigidity of a segment | N m^2 | 4.1 |
//! | `EA` | axial rigidity of a segment | N | |
//! | `m` | mass per length, the thesis's `rho A` | kg/m | 4.1 |
//! | `omega_k` | natural frequency | rad/s | 4.5 |
//! | `phi_k` | mass-normalised mode shape | kg^(-1/2) | 4.4 |
//! | `k` | wave number of a segment, `(m omega^2 / EI)^(1/4)`; axial, `omega sqrt(m/EA)` | 1/m | |
//! | `kappa G A`, `rho I` | shear rigidity, rotary inertia per length | N, kg m | |
//! | `G(x,y)` | static Green's function, `sum phi_k(x) phi_k(y) / omega_k^2` over elastic modes | m/N | |
//!
//! # The method
//! 1. The conditions of each end define a plane of states (displacement, slope, moment, shear). The plane is propagated along
//!    the beam as an orthonormal basis, rotated at every span so that the growing exponential is in one column and is
//!    normalised at the far end. Nothing overflows and nothing cancels for any number of waves in a segment; on a segment
//!    shorter than a wave the power series of Krylov's functions replace sines and exponentials.
//! 2. The count of W. H. Wittrick and F. W. Williams (Q. J. Mech. Appl. Math. 24:263, 1971) is the number of natural
//!    frequencies below a trial value. Intervals are divided until each contains one; the root of the characteristic function,
//!    which is computed separately from the count and checked against its parity, is then the frequency. No frequency is
//!    missed.
//! 3. The planes from the left and from the right are compared at every span. The mode is started where they agree best, that
//!    is, where the mode is large, and computed from there to both sides. Shapes of nearly equal frequencies are orthogonalised
//!    with closed-form integrals, which also give the norm.
//! 4. A uniform beam with pinned or guided ends needs no search by either theory, since its modes are sines and cosines
//!    (`standing.rs`), nor does one by Euler-Bernoulli's with any ends: one formula covers the other seven pairs (`uniform.rs`).
//! 5. All this applies to every span whose four first-order equations have constant coefficients. Shear, rotary inertia, axial
//!    force and foundation change only the two exponents of a span and the ratios of moment to displacement of its waves
//!    (`waves.rs`); masses and springs shear the plane at their location, and a support replaces one of its columns (`node.rs`,
//!    `plane.rs`).
//! 6. A foundation in proportion to the mass raises the squares of all frequencies alike and changes no shape. This part of a
//!    foundation is taken away before the search and added to its result, so that frequencies on a stiff foundation can be told
//!    apart. Where the mass per length is smaller than elsewhere, a part remains; if it is so stiff that no wave propagates in
//!    a span, the span is divided into pieces for power series.
//!
//! Shapes stay orthonormal to 1e-11 for ratios of neighbouring rigidities of 1e12 or of lengths of 1e3; see `tests/stepped.rs`.
//! Larger contrasts than 1e12 are rejected.
//!
//! # Limits
//! Euler-Bernoulli's theory ([`Beam`]) neglects shear and rotary inertia, which matter if a half wave is shorter than about ten
//! thicknesses; Timoshenko's theory is accurate down to half waves of about one thickness. The beam is straight and bends in
//! one plane.
//!
//! # Example
//! ```
//! use beam_modes::{Beam, End, RectangularSegment};
//! let thick = RectangularSegment {
//!     length_m: 0.5,
//!     youngs_modulus_pa: 2e11,
//!     density_kg_m3: 7800.0,
//!     width_m: 0.0113,
//!     thickness_m: 0.0113,
//! };
//! let slim = RectangularSegment { thickness_m: 0.0060, ..thick };
//! let beam = Beam { segments: vec![thick.into(), slim.into()], ends: [End::Clamped, End::Free] };
//! let modes = beam.modes(40)?;
//! let (omega, phi) = (modes.omega_rad_s(), modes.shapes_at(0.75)?);
//! // the static compliance of all modes beyond the first forty
//! let sum: f64 = omega.iter().zip(&phi).map(|(omega, phi)| (phi / omega).powi(2)).sum();
//! let residual = beam.static_compliance(0.75)? - sum;
//! assert!(residual > 0.0 && residual < 1e-4 * sum);
//! # Ok::<(), beam_modes::InvalidInput>(())
//! ```

mod axial;
mod beam;
mod buckling;
mod chain;
mod compliance;
mod definition;
mod dense;
mod elastic;
pub mod fem;
mod flexure;
mod krylov;
mod location;
mod modes;
mod node;
mod piece;
mod plane;
mod plate;
mod point_mode;
mod quadrature;
mod remainder;
mod rigid;
mod rod;
mod roots;
mod shapes;
mod span;
mod standing;
mod statics;
mod string;
mod superposition;
mod system;
mod uniform;
mod waves;

pub use axial::RodEnd;
pub use definition::{Attachment, Beam, BeamSystem, End, RectangularSegment, Segment, ShearSection, Support};
pub use invalid_input::InvalidInput;
pub use modes::Modes;
pub use plate::{Edge, Plate, PlateModes, PlateTheory};
pub use point_mode::PointMode;
pub use remainder::{
    MOST_REMAINDER_MODES, PointsMode, enough_for_remainder, remainder_at_points, remainder_from_trend, remainder_modes,
};
pub use rod::{Rod, RodSegment};
pub use string::{TautString, TautStringModes};

/// Runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
