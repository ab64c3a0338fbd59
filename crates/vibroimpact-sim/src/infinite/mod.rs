//! A compact body strikes an infinite beam or a thin infinite plate (thesis chapter 2).
//!
//! # Mathematics
//!
//! An impulse `P` at a point of an infinite Euler-Bernoulli beam moves that point by
//! `P C sqrt(t)` (Eq. 2.1), of a thin infinite plate by the constant `P alpha` (Zener 1941). With
//! Hertz contact, time in units of `T = C^2 m^2`, force in units of `F = v/(C^2 m)`, speed in units
//! of `v` and displacement in units of `v T`, the compression obeys one scalar Volterra equation
//! with one parameter,
//!
//! ```text
//! x(t) = t - int_0^t [ (t - s) + K(t - s) ] f(s) ds,      f = sqrt(S) max(x, 0)^(3/2),
//! K(t) = sqrt(t) for the beam, 1 for the plate.
//! ```
//!
//! | symbol | meaning | unit | source |
//! |---|---|---|---|
//! | `x` | compression, body minus structure displacement; negative: gap | `v T` | Eq. 2.5, `xi` |
//! | `f` | contact force | `F` | Eqs. 2.5, 2.10 |
//! | `t` | time since first touch | `T` | Eq. 2.9 |
//! | `S` | the single nondimensional parameter, `C^10 k_H^2 m^8 v` for the beam | 1 | Eq. 2.8 |
//! | `u` | speed of the body towards the structure | `v` | |
//!
//! Displacements in the thesis's unit `D` (Eq. 2.11) are `S^(1/3)` times those in `v T`.
//!
//! # Method
//!
//! *Contact*: spectral collocation on panels, mapped at touch and separation where `x` is smooth
//! in the square root of time; exact product integration within a panel; past panels through
//! closed-form integrals of Legendre polynomials against `sqrt(z - u)`. *Flight*: closed form; the
//! gap is convex, so the next contact exists exactly when the body still moves towards the
//! structure, and is found by Newton's method from both sides. *Past*: Gauss rules of the positive
//! measure `f ds`, by age, on a time origin that moves along. *End*: see
//! [`Outcome::Sustained`].
//!
//! # Example
//!
//! ```
//! use vibroimpact_sim::infinite::{Outcome, Settings, Structure, solve};
//!
//! let solution = solve(Structure::Beam, 15.0, &Settings::default())?;
//! assert_eq!(solution.outcome, Outcome::Sustained);
//! assert_eq!(solution.separations(), 4);
//! let now = solution.at(0.5).unwrap();
//! assert!(now.force > 0.0 && now.compression > 0.0);
//! # Ok::<(), vibroimpact_sim::InvalidInput>(())
//! ```

mod asymptotic;
mod collocate;
mod contact;
mod flight;
mod free;
mod groups;
mod history;
mod panel;
mod rule;
mod semi_analytical;
mod solution;
mod solve;
mod sustained;
mod turning;
mod units;

pub use asymptotic::{Attached, attached, displacement_eq_2_47};
pub use groups::{Groups, Impact, Material};
pub use semi_analytical::FirstContact;
pub use solution::{Contact, Extremum, Outcome, Solution, State};
pub use solve::solve;
pub use turning::{CriticalS, MOST_TURNING_POINTS, TurningPoint, critical_s, turning_point, turning_points};

use invalid_input::InvalidInput;

/// Smallest and largest `S` that [`solve`] accepts.
pub const S_RANGE: std::ops::RangeInclusive<f64> = 1e-12..=1e8;

/// The struck structure, which decides the kernel `K` of the Volterra equation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Structure {
    /// Infinite Euler-Bernoulli beam: `K = sqrt(t)` (thesis Eq. 2.1).
    Beam,
    /// Thin infinite plate: `K = 1` (Zener 1941; thesis 2.1).
    Plate,
}

/// Accuracy and extent of a solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Collocation nodes per panel, 8 to 32. Default 20.
    pub nodes: usize,
    /// Largest relative size of the last Legendre coefficients of the force in a panel, 1e-14 to
    /// 1e-3. Default 1e-10.
    pub tolerance: f64,
    /// Sustained contact is followed at least up to this time (units of `T`). Default 0: as far as
    /// it takes to know that it lasts.
    pub horizon: f64,
    /// Whether to solve a second time with more nodes, for [`Solution::error`]. Default true.
    pub estimate_error: bool,
    /// Most panels to try before stopping ([`StopReason::Steps`](crate::StopReason)). Default 200,000. Only `S`
    /// close above the critical value needs many: the separations number 33 at `S = 1.6`, 120 at
    /// a relative distance of 1e-3, 1,008 at 1e-5, 4,401 at 1e-6 and more than 16,000 at 1e-7; nearer still times leave
    /// the range of numbers first ([`StopReason::DigitsExhausted`](crate::StopReason)).
    pub max_panels: usize,
    /// Most contacts to follow: 1 for the first alone. Where the body would come back once more, the run stops
    /// ([`StopReason::SubImpacts`](crate::StopReason)), known up to the next touch. Default: no limit.
    pub max_contacts: usize,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            nodes: 20,
            tolerance: 1e-10,
            horizon: 0.0,
            estimate_error: true,
            max_panels: 200_000,
            max_contacts: usize::MAX,
        }
    }
}

impl Settings {
    fn check(&self) -> Result<(), InvalidInput> {
        InvalidInput::unless(rule::NODES.contains(&self.nodes), "nodes", self.nodes, "8 to 32")?;
        let tolerance = (1e-14..=1e-3).contains(&self.tolerance);
        InvalidInput::unless(tolerance, "tolerance", self.tolerance, "1e-14 to 1e-3")?;
        let horizon = (0.0..=1e12).contains(&self.horizon);
        InvalidInput::unless(horizon, "horizon", self.horizon, "0 to 1e12 (units of T)")?;
        InvalidInput::unless(self.max_panels > 0, "max_panels", self.max_panels, "at least 1")?;
        InvalidInput::unless(self.max_contacts > 0, "max_contacts", self.max_contacts, "at least 1")
    }
}
