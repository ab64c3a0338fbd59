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
#![doc = ""]

mod error;
mod hertz;
mod law;

pub use error::InvalidInput;
pub use hertz::Hertz;
pub use law::{After, Boundary, Branch, ContactLaw, Force, Memory, Stage};

/// Every law of the crate behind one type, for scenes that choose their law at run time.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Law {
    /// Elastic contact of curved bodies.
    Hertz(Hertz),
}

impl ContactLaw for Law {
    fn touch(&self, memory: &Memory, approach_speed_m_s: f64) -> Branch {
        match self {
            Law::Hertz(law) => law.touch(memory, approach_speed_m_s),
        }
    }

    fn force(&self, branch: &Branch, compression_m: f64, rate_m_s: f64) -> Force {
        match self {
            Law::Hertz(law) => law.force(branch, compression_m, rate_m_s),
        }
    }

    fn boundaries(&self, branch: &Branch) -> [Boundary; 2] {
        match self {
            Law::Hertz(law) => law.boundaries(branch),
        }
    }

    fn cross(&self, branch: &Branch, which: usize, compression_m: f64, rate_m_s: f64) -> After {
        match self {
            Law::Hertz(law) => law.cross(branch, which, compression_m, rate_m_s),
        }
    }

    fn depends_on_rate(&self) -> bool {
        match self {
            Law::Hertz(law) => law.depends_on_rate(),
        }
    }
}
