//! The fall of a striker on the structure.
//!
//! Gravity `g` acts on the striker. The structure is at rest under its own weight before the impact, and its motion relative to that is
//! what it is without gravity. At the start the striker is at the height `h_0` above the undeflected structure and moves down with
//! `v_0`; it would arrive with `v`,
//!
//! ```text
//! v^2 = v_0^2 + 2 g h_0.
//! ```
//!
//! As it always comes back, no flight is the last. Its rebound is the first flight that rises above the undeflected structure by more
//! than a hundredth of the height `v^2/2g` of its fall. From the velocity `v_s` and the height `h_s` at the separation before follows
//! what a drop test measures,
//!
//! ```text
//! e = sqrt(v_s^2 + 2 g h_s)/v.
//! ```
//!
//! If there is no such flight for the time of four rebounds without losses, `8 v/g`, and of four vibrations of the structure with the
//! striker, the striker stays on it: `e = 0`. The latter have at most the period `2 pi sqrt(sum 1/omega_k^2 + m sum phi_k^2/omega_k^2)`
//! (Dunkerley 1894). A soft contact may last longer; the search does not end during the first one, or before four times
//! its duration have passed since. If the striker rises and turns down again within it, the time until then counts in
//! place of the whole.

use super::posed::STRIKER;
use super::problem::{Mode, SCALE_MIN, SPEED_MIN, Start, Striker, arrives_m_s, height_m};
use crate::assembly::problem::SCALE_MAX;
use crate::assembly::{Force, Load};
use invalid_input::InvalidInput;
use std::f64::consts::TAU;

/// Least height of a rebound, as a share of that of the fall.
const LEAST_RISE: f64 = 0.01;
/// The search for the rebound ends after so many rebounds without losses, and so many of the slowest vibrations.
const WAITED: f64 = 4.0;

/// A fall under gravity.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fall {
    gravity_m_s2: f64,
    /// Height above the undeflected structure at the start (m).
    height_m: f64,
    /// Speed of the striker at the start (m/s).
    speed_m_s: f64,
    mass_kg: f64,
    /// The longest period of the structure with the striker, at most (s).
    slowest_s: f64,
}

/// Checks an acceleration of gravity.
pub(crate) fn check_gravity(gravity_m_s2: f64) -> Result<(), InvalidInput> {
    let allowed = gravity_m_s2 == 0.0 || (SCALE_MIN..=SCALE_MAX).contains(&gravity_m_s2);
    InvalidInput::unless(allowed, "gravity_m_s2", gravity_m_s2, "0, or a positive number from 1e-30 to 1e30")
}

impl Fall {
    /// The fall of a striker onto some modes; `None` without gravity.
    ///
    /// # Errors
    /// If one of the bodies does not fall, or both do, or the striker lies on the structure.
    pub fn new(
        gravity_m_s2: f64,
        modes: &[Mode],
        striker: &Striker,
        start: &Start,
    ) -> Result<Option<Fall>, InvalidInput> {
        if gravity_m_s2 == 0.0 {
            return Ok(None);
        }
        let require = |holds, allowed: &str| InvalidInput::unless(holds, "gravity_m_s2", gravity_m_s2, allowed);
        require(striker.mass_kg.is_finite(), "0, because the striker is an immovable stop")?;
        let held = !modes.iter().any(|mode| mode.is_rigid() && mode.is_moved());
        require(held, "0, because the structure is not held and would fall as well")?;
        let Striker { mass_kg, speed_m_s } = *striker;
        let vibrating = modes.iter().filter(|mode| mode.is_moved());
        let square_s2: f64 =
            vibrating.map(|mode| (1.0 + mass_kg * mode.shape * mode.shape) / mode.omega_rad_s.powi(2)).sum();
        let slowest_s = TAU * square_s2.sqrt();
        let fall = Fall { gravity_m_s2, height_m: height_m(modes, start), speed_m_s, mass_kg, slowest_s };
        let falls = (speed_m_s > 0.0 || fall.height_m > 0.0) && fall.arrives_m_s() >= SPEED_MIN;
        require(falls, "0, because the striker touches the structure and does not move towards it")?;
        Ok(Some(fall))
    }

    /// The speed with which it would arrive at the undeflected structure.
    pub fn arrives_m_s(&self) -> f64 {
        arrives_m_s(self.gravity_m_s2, self.speed_m_s, self.height_m)
    }

    /// The weight of the striker.
    pub fn weight(&self) -> Load {
        let force = Force::Constant { force_n: -self.gravity_m_s2 };
        Load { body: STRIKER, shape: vec![self.mass_kg.sqrt()], force }
    }

    /// Displacement of the striker above which a flight is a rebound (m).
    pub fn rebound_above_m(&self) -> f64 {
        LEAST_RISE * self.arrives_m_s().powi(2) / (2.0 * self.gravity_m_s2) - self.height_m
    }

    /// Time at which the search for a rebound ends (s).
    pub fn end_s(&self) -> f64 {
        let speed = self.arrives_m_s();
        let rebound_s = 2.0 * speed / self.gravity_m_s2;
        (speed - self.speed_m_s) / self.gravity_m_s2 + WAITED * (rebound_s + self.slowest_s)
    }

    /// Restitution of a rebound that begins with this displacement and velocity of the striker.
    pub fn restitution(&self, displacement_m: f64, velocity_m_s: f64) -> f64 {
        let square = (velocity_m_s / self.arrives_m_s()).powi(2) + self.share(displacement_m);
        square.max(0.0).sqrt()
    }

    /// Its derivatives with respect to displacement (1/m) and velocity (s/m).
    pub fn restitution_by(&self, displacement_m: f64, velocity_m_s: f64) -> [f64; 2] {
        // e de = (g du + v dv)/v_arrival^2
        let scale = self.arrives_m_s().powi(2) * self.restitution(displacement_m, velocity_m_s);
        [self.gravity_m_s2 / scale, velocity_m_s / scale]
    }

    /// The height above the undeflected structure at this displacement, as a share of that of the fall.
    pub fn share(&self, displacement_m: f64) -> f64 {
        2.0 * self.gravity_m_s2 * (self.height_m + displacement_m) / self.arrives_m_s().powi(2)
    }

    /// Potential energy of the striker with this displacement (J).
    pub fn potential_j(&self, displacement_m: f64) -> f64 {
        self.mass_kg * self.gravity_m_s2 * (self.height_m + displacement_m)
    }

    /// Time until a striker with this velocity turns round (s).
    pub fn rises_for_s(&self, velocity_m_s: f64) -> f64 {
        velocity_m_s.max(0.0) / self.gravity_m_s2
    }
}
