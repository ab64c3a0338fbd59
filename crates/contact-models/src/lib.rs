//! Force-compression laws of contact for impact problems.
//!
//! A contact law gives the normal force `F` (N) as a function of the local compression `xi` (m, positive when the bodies press
//! on each other) and its rate (m/s). Laws with memory (hysteresis, plasticity, damping that depends on the speed of approach)
//! consist of smooth *branches*: within a [`Branch`] the force is a smooth function of `(xi, xi_dot)`, and the branch is valid
//! inside an intersection of half planes ([`Boundary`]), as many as the law needs. An integrator follows one branch until it
//! reaches a boundary, locates it, and asks the law for the [next](ContactLaw::cross) branch or the release of the contact. No
//! law has a kink inside a branch, so that an integrator keeps its high order.
//!
//! The state of a law besides compression and rate consists of its *internal variables* ([`Internal`]): those that determine a
//! branch are in the [`Branch`], those that outlast a contact in the [`Memory`]. Both are small and copied, so that an
//! integrator may try a step and reject it.
//!
//! | symbol | meaning | unit | thesis |
//! |---|---|---|---|
//! | `xi` | compression, structure minus striker displacement | m | Eq. 3.11 |
//! | `<xi>` | `xi` where positive, zero elsewhere | m | Eq. 3.13 |
//! | `F` | contact force, never negative | N | Eqs. 3.12, 3.15, 3.16 |
//! | `k_H` | Hertz stiffness | N/m^1.5 | Eq. 3.14 |
//! | `c`, `D` | damping factor, of one law or set at first touch | s/m | Eq. 3.15 |
//! | `theta` | internal variable of the hysteretic law | 1 | Eq. 3.17 |
//! | `theta_m`, `beta` | centre and half width of its range | 1 | Eq. 3.17 |
//! | `K`, `eps` | rate at which it follows `xi`; regularisation at `xi = 0` | 1, m | Eq. 3.17 |
//! | `E*`, `R*` | effective modulus and radius of two bodies | Pa, m | Eq. 3.14, general |
//! | `Q0`, `p`, `alpha` | static stiffness, exponent and retardation time of felt | N/m^p, 1, s | |
//! | `p_y` | contact pressure at first yield | Pa | |
//! | `v0`, `e` | approach speed; rebound speed over it | m/s, 1 | Eq. 3.19 |
//!
//! # The laws
//!
//! | law | force | parameters | source | valid for | tension |
//! |---|---|---|---|---|---|
//! | [`Hertz`] | `k_H xi^1.5` | `k_H`, or two bodies | Hertz 1882; thesis 3.12 | small contact, elastic | none |
//! | [`Viscous`] | `k_H xi^1.5 (1 + c xi')` | `k_H`, `c` | thesis 3.15 | `c xi'` well below 1 | slack |
//! | [`Hysteretic`] | `k_H xi^1.5 (1 + theta)` | `k_H` and four more | thesis 3.16, 3.17 | damping without rate | none |
//! | [`LinearSpring`] | `k xi` | `k` | textbook | constant contact area, penalty | none |
//! | [`Power`] | `k xi^n` | `k`, `n` | textbook | any curve that a power fits, no losses | none |
//! | [`KelvinVoigt`] | `k xi + c xi'` | `k`, `c` | Schwager and Poschel 2007 | simple model, `e` without speed | slack |
//! | [`HuntCrossley`] | `k xi^n (1 + D xi')` | `k`, `n`, `D` | Hunt and Crossley 1975 | light damping | slack |
//! | [`LankaraniNikravesh`] | `k_H xi^1.5 (1 + D xi')` | `k_H`, `e` | Lankarani and Nikravesh 1990 | `e` near 1 | slack |
//! | [`Flores`] | `k_H xi^1.5 (1 + D xi')` | `k_H`, `e` | Flores et al. 2011 | any `e`, approximately | slack |
//! | [`Felt`] | `Q0 (xi^p + alpha d(xi^p)/dt)` | `Q0`, `p`, `alpha` | Stulov 2004 | piano hammers | slack |
//! | [`Thornton`] | Hertz, line after yield, Hertz back | `E*`, `R*`, `p_y` | Thornton 1997 | moderate plastic indentation | none |
//!
//! The last column states what replaces the formula where it would give tension. *Slack* means that the surfaces recover
//! without touching: the force is zero until the formula is positive again or the compression is zero. It is a branch of its
//! own ([`Stage::Slack`]), and the force is continuous at both of its ends. [`Law`] contains any of them;
//! [`Law::wall_restitution`] is the restitution of a rigid striker at a wall, for any law. The difference between the work
//! received and the [stored](ContactLaw::stored_energy_j) energy is what the contact has dissipated. [`trace`] evaluates a law
//! along a prescribed motion, and [`check_contract`] tests whether your own law has the properties on which an integrator
//! relies.
//!
//! Conversely, [`Wanted`] gives the parameters of a law for a required restitution, exactly and not by the papers'
//! approximations, and [`stepped_restitution`] the restitution of these parameters in an engine with a fixed step.
//!
//! The laws give the normal force of one contact, without friction and without adhesion (no law gives tension). Waves in the
//! bodies are part of the structure.
//!
//! Parameters are checked by each law's `new`. Fields are public; after a change, `validated` checks them again. Checked laws
//! give finite numbers for every finite compression and rate; a value beyond 1e30 (SI units) counts as 1e30.
//!
//! ```
//! use contact_models::{ContactLaw, Law, Memory, Viscous};
//!
//! let law = Law::from(Viscous::with_restitution(1.7945e10, 0.95, 1.0)?);
//! let branch = law.touch(&Memory::default(), 1.0);
//! let force = law.force(&branch, 2e-5, 0.5);
//! assert!(force.force_n > 1600.0 && force.per_compression_n_m > 0.0);
//! assert!((law.wall_restitution(0.11, 1.0)? - 0.95).abs() < 1e-14);
//! # Ok::<(), contact_models::InvalidInput>(())
//! ```

mod check;
mod conservative;
mod damped;
mod felt;
mod flores;
mod hertz;
mod hunt_crossley;
mod hysteretic;
mod internal;
mod kelvin_voigt;
mod lankarani_nikravesh;
mod law;
mod laws;
mod linear;
mod pair;
mod power;
mod quadrature;
mod range;
mod stepped;
mod thornton;
mod trace;
mod viscous;
mod wanted;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}

pub use check::{Breach, Promise, check_contract, check_contract_along};
pub use felt::Felt;
pub use flores::Flores;
pub use hertz::Hertz;
pub use hunt_crossley::HuntCrossley;
pub use hysteretic::Hysteretic;
pub use internal::Internal;
pub use invalid_input::InvalidInput;
pub use kelvin_voigt::KelvinVoigt;
pub use lankarani_nikravesh::LankaraniNikravesh;
pub use law::{After, Boundary, Branch, ContactLaw, Force, MOST_BOUNDARIES, Memory, Stage, boundaries};
pub use laws::Law;
pub use linear::LinearSpring;
pub use pair::{Body, effective_modulus_pa, effective_radius_m};
pub use power::Power;
pub use range::LARGEST;
pub use stepped::{Stepped, stepped_restitution};
pub use thornton::Thornton;
pub use trace::{TracePoint, trace};
pub use viscous::Viscous;
pub use wanted::{Solref, Wanted, damping_ratio, damping_ratio_if_it_pulled, reduced_mass_kg};
