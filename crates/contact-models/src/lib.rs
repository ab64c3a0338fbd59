//! Force-compression laws of contact for impact problems.
//!
//! A contact law turns the local compression `xi` (m, positive when the bodies press on each
//! other) and its rate (m/s) into the normal force `F` (N). Laws with memory (hysteresis,
//! plasticity, damping that depends on the speed of approach) are made of smooth *branches*:
//! within a [`Branch`] the force is a smooth function of `(xi, xi_dot)`, and the branch is valid
//! inside an intersection of half planes ([`Boundary`]). An integrator follows one branch until
//! a boundary is met, lands on it, and asks the law what comes [`next`](ContactLaw::cross): another
//! branch, or the release of the contact. No law has a kink inside a branch, so a high-order
//! integrator keeps its order.
//!
//! | symbol | meaning | unit | thesis |
//! |---|---|---|---|
//! | `xi` | compression, structure minus striker displacement | m | Eq. 3.11 |
//! | `F` | contact force, never negative | N | Eqs. 3.12, 3.15, 3.16 |
//! | `k_H` | Hertz stiffness | N/m^1.5 | Eq. 3.14 |

mod damped;
mod error;
mod hertz;
mod hysteretic;
mod law;
mod laws;
mod pair;
mod quadrature;
mod viscous;

pub use error::InvalidInput;
pub use hertz::Hertz;
pub use hysteretic::Hysteretic;
pub use law::{After, Boundary, Branch, ContactLaw, Force, Memory, Stage};
pub use laws::Law;
pub use pair::{Body, effective_modulus_pa, effective_radius_m};
pub use viscous::Viscous;
