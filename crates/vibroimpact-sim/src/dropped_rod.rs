//! A tilted rod dropped on an immovable surface (thesis chapter 8, Fig. 8.1).
//!
//! The rod falls without rotation and meets the frictionless surface with its hemispherical end. Seen from the contact,
//! it is a structure of two rigid-body motions, bending modes and axial modes, and the surface is a striker of infinite
//! mass. With the inclination `theta` from the horizontal, the mass-normalised shapes in the direction of the surface's
//! normal are
//!
//! | motion | shape at the contact | thesis |
//! |---|---|---|
//! | translation | `1/sqrt(m)` | 8.4 |
//! | rotation | `sqrt(3) cos(theta)/sqrt(m)` | 8.4 |
//! | bending mode | `phi_l(0) cos(theta)`, `phi_l(0) = 2/sqrt(m)` | 8.5, with `omega^2 q` for the misprinted `omega^2 q^2` |
//! | axial mode | `phi_a(0) sin(theta)`, `phi_a(0) = sqrt(2)/sqrt(m)` | 8.6, likewise |
//!
//! The first two give the thesis's rigid-body mass `m/(1 + 3 cos^2 theta)` (Eq. 8.9), and the restitution is that of
//! the contact point's rigid-body motion.
//!
//! ```
//! use vibroimpact_sim::dropped_rod::DroppedRod;
//! use vibroimpact_sim::modal::{Settings, Solver};
//! let rod = DroppedRod {
//!     length_m: 0.2,
//!     diameter_m: 0.0127,
//!     youngs_modulus_pa: 2.1e11,
//!     density_kg_m3: 7876.74,
//!     poissons_ratio: 0.3,
//!     inclination_rad: 0.9,
//!     bending_modes: 20,
//!     axial_modes: 20,
//!     damping_ratio: 0.0,
//! };
//! let impact = rod.drop(1.0)?;
//! let solution = Solver::new(&impact.structure)?.solve(&impact.surface, &impact.law, Some(&impact.start), &Settings::default())?;
//! assert!(solution.restitution.unwrap() < 1.0);
//! # Ok::<(), vibroimpact_sim::InvalidInput>(())
//! ```

use crate::modal::{Mode, Start, Striker, Structure};
use beam_modes::{
    Beam, End, MOST_REMAINDER_MODES, PointMode, Rod, RodEnd, RodSegment, Segment, enough_for_remainder, remainder_modes,
};
use contact_models::{Body, Hertz};
use invalid_input::InvalidInput;
use std::f64::consts::PI;

/// Largest number of bending modes, and of axial modes.
pub const MOST_MODES: usize = 10_000;

/// A rod of circular cross-section with hemispherical ends, about to touch the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DroppedRod {
    /// Length (m).
    pub length_m: f64,
    /// Diameter (m); the ends are hemispheres of half of it in radius.
    pub diameter_m: f64,
    /// Young's modulus of the rod (Pa).
    pub youngs_modulus_pa: f64,
    /// Density (kg/m^3).
    pub density_kg_m3: f64,
    /// Poisson's ratio of the rod.
    pub poissons_ratio: f64,
    /// Angle between the rod and the surface (rad), 0 (lying) to pi/2 (upright).
    pub inclination_rad: f64,
    /// Number of bending modes. Truncated modes are represented by remainder modes ([`beam_modes::remainder_modes`]).
    pub bending_modes: usize,
    /// Number of axial modes. Truncated modes are represented in the same way.
    pub axial_modes: usize,
    /// Damping ratio of the elastic modes.
    pub damping_ratio: f64,
}

/// A drop as an impact on a modal structure.
#[derive(Debug, Clone, PartialEq)]
pub struct Drop {
    /// The rod, seen from its contact point: two rigid-body motions, bending modes, axial modes, remainder modes.
    pub structure: Structure,
    /// Number of remainder modes among the modes.
    pub remainder_modes: usize,
    /// The immovable surface.
    pub surface: Striker,
    /// The rod's fall.
    pub start: Start,
    /// Hertz contact of the hemispherical end with a flat surface of infinite stiffness.
    pub law: Hertz,
}

impl DroppedRod {
    /// Mass (kg), of a plain cylinder.
    pub fn mass_kg(&self) -> f64 {
        self.density_kg_m3 * self.area_m2() * self.length_m
    }

    /// Effective mass of the rigid rod at the contact point (kg), thesis Eq. 8.9.
    pub fn rigid_body_mass_kg(&self) -> f64 {
        self.mass_kg() / (1.0 + 3.0 * self.inclination_rad.cos().powi(2))
    }

    /// Number of bending modes below the first axial one (thesis 8.2.2).
    ///
    /// # Errors
    /// As [`DroppedRod::drop`].
    pub fn bending_modes_below_first_axial(&self) -> Result<usize, InvalidInput> {
        self.check()?;
        let first_axial = PI / self.length_m * (self.youngs_modulus_pa / self.density_kg_m3).sqrt();
        let mut count = 8;
        loop {
            let bending = self.beam().modes(count)?;
            let omega = bending.omega_rad_s();
            if omega.last().is_none_or(|omega| *omega > first_axial) || count > 100_000 {
                return Ok(omega.iter().filter(|omega| **omega > 0.0 && **omega < first_axial).count());
            }
            count *= 2;
        }
    }

    /// The drop with this speed at first touch (m/s).
    ///
    /// # Errors
    /// Names the field, its value and what would be allowed.
    pub fn drop(&self, speed_m_s: f64) -> Result<Drop, InvalidInput> {
        self.check()?;
        InvalidInput::unless(
            speed_m_s > 0.0 && speed_m_s < 1e6,
            "speed_m_s",
            speed_m_s,
            "greater than 0 and less than 1e6 m/s",
        )?;
        let (sin, cos) = self.inclination_rad.sin_cos();
        let root = self.mass_kg().sqrt();
        let rigid = |shape| Mode { omega_rad_s: 0.0, damping_ratio: 0.0, shape };
        let mut modes = vec![rigid(1.0 / root), rigid(3f64.sqrt() * cos / root)];

        let (beam, rod) = (self.beam(), self.rod());
        // both free ends: two rigid-body motions of bending come first, one of translation along the axis
        let families = [(self.bending_modes, 2, cos), (self.axial_modes, 1, sin)];
        let whole = [beam.static_compliance(0.0)?, rod.static_compliance(0.0)?];
        let found = [
            beam.modes(2 + enough_for_remainder(self.bending_modes))?,
            rod.modes(1 + enough_for_remainder(self.axial_modes))?,
        ];
        let (mut elastic, mut tail, mut rest_m_n) = (Vec::new(), Vec::new(), 0.0);
        for (((kept, rigid, direction), whole), family) in families.into_iter().zip(whole).zip(&found) {
            rest_m_n += whole * direction * direction;
            for (k, mode) in family.seen_from(0.0)?.into_iter().skip(rigid).enumerate() {
                let mode = PointMode { shape: mode.shape * direction, ..mode };
                rest_m_n -= (mode.shape / mode.omega_rad_s).powi(2);
                (if k < kept { &mut elastic } else { &mut tail }).push(mode);
            }
        }
        let remainder = remainder_modes(&tail, rest_m_n.max(0.0), MOST_REMAINDER_MODES)?;
        let remainder_count = remainder.len();
        modes.extend(Structure::from_modes(elastic.into_iter().chain(remainder), self.damping_ratio).modes);
        let mut start = Start::at_rest(modes.len());
        start.rate[0] = speed_m_s * root;
        let end = Body {
            youngs_modulus_pa: self.youngs_modulus_pa,
            poissons_ratio: self.poissons_ratio,
            radius_m: 0.5 * self.diameter_m,
        };
        let law = Hertz::from_bodies(&end, &Body::rigid(f64::INFINITY))?;
        Ok(Drop {
            structure: Structure { modes },
            remainder_modes: remainder_count,
            surface: Striker { mass_kg: f64::INFINITY, speed_m_s: 0.0 },
            start,
            law,
        })
    }

    fn check(&self) -> Result<(), InvalidInput> {
        for (field, value) in [
            ("length_m", self.length_m),
            ("diameter_m", self.diameter_m),
            ("youngs_modulus_pa", self.youngs_modulus_pa),
            ("density_kg_m3", self.density_kg_m3),
        ] {
            InvalidInput::unless((1e-12..=1e15).contains(&value), field, value, "a number from 1e-12 to 1e15")?;
        }
        let angle = self.inclination_rad;
        InvalidInput::unless(
            (0.0..=0.5 * PI).contains(&angle),
            "inclination_rad",
            angle,
            "an angle from 0 to pi/2 rad",
        )?;
        let few = |modes| modes <= MOST_MODES;
        InvalidInput::unless(few(self.bending_modes), "bending_modes", self.bending_modes, "at most 10000")?;
        InvalidInput::unless(few(self.axial_modes), "axial_modes", self.axial_modes, "at most 10000")
    }

    fn area_m2(&self) -> f64 {
        0.25 * PI * self.diameter_m.powi(2)
    }

    fn mass_per_length_kg_m(&self) -> f64 {
        self.density_kg_m3 * self.area_m2()
    }

    fn beam(&self) -> Beam {
        let segment = Segment {
            length_m: self.length_m,
            flexural_rigidity_n_m2: self.youngs_modulus_pa * PI / 64.0 * self.diameter_m.powi(4),
            mass_per_length_kg_m: self.mass_per_length_kg_m(),
        };
        Beam { segments: vec![segment], ends: [End::Free, End::Free] }
    }

    fn rod(&self) -> Rod {
        let segment = RodSegment {
            length_m: self.length_m,
            axial_rigidity_n: self.youngs_modulus_pa * self.area_m2(),
            mass_per_length_kg_m: self.mass_per_length_kg_m(),
        };
        Rod { segments: vec![segment], ends: [RodEnd::Free, RodEnd::Free] }
    }
}
