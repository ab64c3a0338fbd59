//! Limits of an answer: whether its theories hold, each with a number.
//!
//! A solver does not check whether its equations apply. The following numbers do; they are computed from the solved impact. Each
//! has a limit within which the theory holds and one beyond which it does not:
//!
//! | check | figure | within | outside |
//! |---|---|---|---|
//! | `wavelength` | half wavelength of the fastest relevant mode over the thickness | from 6 (with shear 0.5) | below 2.2 (0.25) |
//! | `spectrum` | share of the contact force's spectrum that is faster than the first of these limits | at most 0.01 | above 0.1 |
//! | `pressure` | largest Hertz pressure over the yield strength, where that is given | at most 1.6 | above 4.5 |
//! | `contact_radius` | largest contact radius over the radius of the ball | at most 0.1 | above 0.3 |
//! | `indentation` | the same over the thickness of the structure | at most 0.2 | above 0.5 |
//! | `edge` | distance from the nearest end, edge, support or step over the thickness (Hertz contact) | at least 1 | below 0.25 |
//! | `ball` | duration of the hardest contact over the lowest period of the ball | at least 5 | below 2 |
//! | `early_response` | change of the first contact by Timoshenko's theory over the speed of impact | at most 0.01 | above 0.05 |
//! | `gravity` | speed gained in a fall as long as the interaction, over the speed of impact | at most 0.01 | above 0.1 |
//! | `compression` | scenes of bodies: largest overlap of the surfaces over the thickness of the thinner body | at most 0.1 | above 0.5 |
//!
//! *Waves.* Euler-Bernoulli's frequencies are 5 % too high where half a wavelength is six times the thickness, and 27 %
//! where it is 2.2 times; the same holds for Kirchhoff's theory of plates. The frequencies of Timoshenko's first spectrum agree
//! with those of Rayleigh and Lamb within 0.4 % down to 0.44. Those of the second, which begins at 0.8, are too high by 3 % there
//! and by 5 % at 0.5, the limit with shear. A mode is relevant if it is among the slowest that take up 99 % of the energy
//! `1/2 phi_k^2 |F(omega_k)|^2` that the contacts transfer to vibration, each contact for itself. `F` is the Fourier transform of
//! the force of a contact, and by Parseval's theorem the share beyond `omega` is
//!
//! ```text
//! 1 - sum int_0^omega |F|^2 d omega' / (pi sum int F^2 dt).                                                       (1)
//! ```
//!
//! *Contact.* On a ball of radius `R` Hertz's circle of contact has `a^2 = R delta`, and the greatest pressure is
//!
//! ```text
//! p = 3 F / (2 pi a^2).                                                                                           (2)
//! ```
//!
//! Metals yield first, below the surface, at `p = 1.6 Y`, and flow over the whole contact at a mean pressure of `3 Y`, that
//! is `p = 4.5 Y` (K. L. Johnson, *Contact Mechanics*, 1985, 4.2 and 6.3). Hertz's law assumes half-spaces, which is
//! right while `a` is small compared with radius and thickness.
//!
//! *Edge.* The stresses at an end that a theory of bending neglects decay as `e^(-4.2 x/h)` (P. F. Papkovich, 1940): to
//! 1.5 % over one thickness, and to 35 % over a quarter.
//!
//! *Ball.* The lowest mode of a solid ball that an impact excites is the one that makes it oblong, `omega R / c_t = 2.64`
//! (H. Lamb, 1882; 2.64 to 2.65 for Poisson's ratios of 0.25 to 0.33), with `c_t = sqrt(G/rho)`.
//!
//! *Early response.* The initial response of Timoshenko's beam is that of an impedance and not the square root of time. Its
//! mobility determines how the first contact would end, Eqs. (3) and (4) in `early.rs`.
//!
//! *Gravity* is neglected during an impact; between contacts a ball that falls on the structure gains the speed `g t`.

mod check;
mod checks;
mod course;
mod early;
mod section;
mod text;

use crate::scene::{InvalidInput, Scene};
use crate::simulate::Simulation;
pub use check::{Check, Verdict};
use course::Course;
pub use text::trust_text;

impl Scene {
    /// Checks whether the theories behind a simulation of this scene hold, if the scene states the necessary data: the thickness of
    /// the structure, the ball's radius and material, a yield strength.
    ///
    /// ```
    /// use vibroimpact::Scene;
    /// use vibroimpact::trust::Verdict;
    ///
    /// let scene = Scene::from_json(r#"{
    ///     "structure": { "kind": "beam", "ends": ["pinned", "pinned"], "damping_ratio": 0.02,
    ///         "segments": [{ "length_m": 1, "youngs_modulus_pa": 2e11, "density_kg_m3": 7800,
    ///                        "width_m": 0.011323, "thickness_m": 0.011323 }] },
    ///     "striker": { "density_kg_m3": 7800, "radius_m": 0.015, "speed_m_s": 1 },
    ///     "contact": { "law": "hertz", "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3 },
    ///     "location_m": 0.4, "yield_strength_pa": 1e9
    /// }"#)?;
    /// let checks = scene.trust(&scene.simulate()?)?;
    /// let pressure = checks.iter().find(|check| check.check == "pressure").unwrap();
    /// assert!(pressure.verdict == Verdict::Doubtful && pressure.value > 2.0);
    /// # Ok::<(), vibroimpact::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Scene::simulate`], for a simulation of another scene.
    pub fn trust(&self, simulation: &Simulation) -> Result<Vec<Check>, InvalidInput> {
        let course = Course::of(self, simulation)?;
        let waves = section::section(self)?;
        let early = match simulation {
            Simulation::Infinite { scale, solution } => early::response(self, solution, scale.time_s)?,
            _ => None,
        };
        let mut found = checks::waves(&course, waves.as_ref());
        found.extend(early);
        found.extend(checks::contact(self, &course, waves.as_ref())?);
        Ok(found)
    }
}
