//! Physical parameters and the groups that make the problem nondimensional (thesis 2.2).

use super::problem::Structure;
use crate::modal::Striker;
use beam_modes::Segment;
use invalid_input::InvalidInput;
use std::f64::consts::PI;

/// A compact body about to strike an infinite structure, described by four constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// The struck structure.
    pub structure: Structure,
    /// Impulse response: beam, `C` in `y = P C sqrt(t)` (Eq. 2.2), unit m/(N s^1.5); plate, `alpha`
    /// in `y = P alpha`, unit m/(N s).
    pub impulse_response: f64,
    /// Hertz stiffness `k_H` (N/m^1.5).
    pub stiffness_n_m1_5: f64,
    /// Mass `m` of the body (kg).
    pub mass_kg: f64,
    /// Speed of impact `v` (m/s).
    pub speed_m_s: f64,
}

/// Young's modulus, Poisson's ratio and density of a material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Young's modulus (Pa).
    pub youngs_modulus_pa: f64,
    /// Poisson's ratio, above -1 and at most 0.5.
    pub poissons_ratio: f64,
    /// Density (kg/m^3).
    pub density_kg_m3: f64,
}

/// Bending stiffness and mass of an infinite beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamSection {
    /// Flexural rigidity `E I` (N m^2).
    pub flexural_rigidity_n_m2: f64,
    /// Mass per length `rho A` (kg/m).
    pub mass_per_length_kg_m: f64,
}

/// The section of a stretch of a beam that goes on without ends.
impl From<Segment> for BeamSection {
    fn from(segment: Segment) -> BeamSection {
        let Segment { flexural_rigidity_n_m2, mass_per_length_kg_m, .. } = segment;
        BeamSection { flexural_rigidity_n_m2, mass_per_length_kg_m }
    }
}

/// Bending stiffness and mass of a thin infinite plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateSection {
    /// Flexural rigidity `E h^3 / (12 (1 - nu^2))` (N m).
    pub flexural_rigidity_n_m: f64,
    /// Mass per area `rho h` (kg/m^2).
    pub mass_per_area_kg_m2: f64,
}

/// `S` and the units in which the nondimensional solution is to be read (Eqs. 2.8 to 2.13).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Groups {
    /// The nondimensional number `S` (Eq. 2.8).
    pub s: f64,
    /// Unit of time `T` (Eq. 2.9).
    pub time_s: f64,
    /// Unit of force `F` (Eq. 2.10).
    pub force_n: f64,
    /// Unit of displacement of this crate, `v T`.
    pub displacement_m: f64,
    /// Unit of speed of this crate, `v`.
    pub speed_m_s: f64,
    /// The thesis's unit of length `D = (F/k_H)^(2/3)` (Eq. 2.11); `v T = S^(1/3) D`.
    pub thesis_length_m: f64,
    /// The thesis's unit of velocity `D/T` (Eq. 2.12).
    pub thesis_velocity_m_s: f64,
    /// The thesis's unit of mass `T^2 F/D` (Eq. 2.13).
    pub thesis_mass_kg: f64,
}

impl Material {
    /// Steel as in thesis 2.2.3: 200 GPa, 0.3, 7800 kg/m^3.
    pub const STEEL: Material = Material { youngs_modulus_pa: 200e9, poissons_ratio: 0.3, density_kg_m3: 7800.0 };

    fn check(&self) -> Result<(), InvalidInput> {
        InvalidInput::require_positive("youngs_modulus_pa", self.youngs_modulus_pa)?;
        InvalidInput::require_positive("density_kg_m3", self.density_kg_m3)?;
        let ratio = self.poissons_ratio > -1.0 && self.poissons_ratio <= 0.5;
        InvalidInput::unless(
            ratio,
            "poissons_ratio",
            self.poissons_ratio,
            "a number greater than -1 and not greater than 0.5",
        )
    }

    /// Hertz stiffness `2 E sqrt(R) / (3 (1 - nu^2))` (N/m^1.5) of a body with local radius `R` on a
    /// flat surface of the same material (thesis 2.2.1).
    pub fn hertz_stiffness(&self, radius_m: f64) -> f64 {
        2.0 * self.youngs_modulus_pa * radius_m.sqrt() / (3.0 * (1.0 - self.poissons_ratio.powi(2)))
    }

    /// A sphere of the material, moving at this speed.
    fn sphere(&self, radius_m: f64, speed_m_s: f64) -> Striker {
        Striker { mass_kg: 4.0 / 3.0 * PI * radius_m.powi(3) * self.density_kg_m3, speed_m_s }
    }
}

impl Impact {
    /// Of a striker on a beam, with this Hertz stiffness (N/m^1.5) of their contact.
    ///
    /// # Errors
    /// [`InvalidInput`] unless all are finite and positive.
    pub fn on_beam(beam: BeamSection, striker: Striker, stiffness_n_m1_5: f64) -> Result<Impact, InvalidInput> {
        let BeamSection { flexural_rigidity_n_m2, mass_per_length_kg_m } = beam;
        let Striker { mass_kg, speed_m_s } = striker;
        InvalidInput::require_positive("flexural_rigidity_n_m2", flexural_rigidity_n_m2)?;
        InvalidInput::require_positive("mass_per_length_kg_m", mass_per_length_kg_m)?;
        let impulse_response =
            flexural_rigidity_n_m2.powf(-0.25) * mass_per_length_kg_m.powf(-0.75) / (2.0 * PI).sqrt();
        Impact { structure: Structure::Beam, impulse_response, stiffness_n_m1_5, mass_kg, speed_m_s }.checked()
    }

    /// A sphere on a beam of rectangular section, both of one material; it strikes across the
    /// thickness.
    ///
    /// # Errors
    /// [`InvalidInput`] unless all are finite and positive and Poisson's ratio possible.
    ///
    /// ```
    /// use vibroimpact_sim::infinite::{Impact, Material};
    /// // third row of thesis Table 2.1
    /// let impact = Impact::sphere_on_beam(Material::STEEL, 0.028, 0.028, 0.033, 0.5)?;
    /// assert!((impact.groups()?.s / 15.556 - 1.0).abs() < 2e-3);
    /// # Ok::<(), vibroimpact_sim::InvalidInput>(())
    /// ```
    pub fn sphere_on_beam(
        material: Material,
        width_m: f64,
        thickness_m: f64,
        radius_m: f64,
        speed_m_s: f64,
    ) -> Result<Impact, InvalidInput> {
        material.check()?;
        InvalidInput::require_positive("width_m", width_m)?;
        InvalidInput::require_positive("thickness_m", thickness_m)?;
        InvalidInput::require_positive("radius_m", radius_m)?;
        let beam = BeamSection {
            flexural_rigidity_n_m2: material.youngs_modulus_pa * width_m * thickness_m.powi(3) / 12.0,
            mass_per_length_kg_m: material.density_kg_m3 * width_m * thickness_m,
        };
        Impact::on_beam(beam, material.sphere(radius_m, speed_m_s), material.hertz_stiffness(radius_m))
    }

    /// Of a striker on a thin plate, with this Hertz stiffness (N/m^1.5) of their contact. The impulse response is
    /// `1 / (8 sqrt(rigidity * mass per area))` (Zener 1941).
    ///
    /// # Errors
    /// [`InvalidInput`] unless all are finite and positive.
    pub fn on_plate(plate: PlateSection, striker: Striker, stiffness_n_m1_5: f64) -> Result<Impact, InvalidInput> {
        let PlateSection { flexural_rigidity_n_m, mass_per_area_kg_m2 } = plate;
        let Striker { mass_kg, speed_m_s } = striker;
        InvalidInput::require_positive("flexural_rigidity_n_m", flexural_rigidity_n_m)?;
        InvalidInput::require_positive("mass_per_area_kg_m2", mass_per_area_kg_m2)?;
        let impulse_response = 0.125 / (flexural_rigidity_n_m * mass_per_area_kg_m2).sqrt();
        Impact { structure: Structure::Plate, impulse_response, stiffness_n_m1_5, mass_kg, speed_m_s }.checked()
    }

    /// A sphere on a thin plate, both of one material.
    ///
    /// # Errors
    /// [`InvalidInput`] unless all are finite and positive and Poisson's ratio possible.
    pub fn sphere_on_plate(
        material: Material,
        thickness_m: f64,
        radius_m: f64,
        speed_m_s: f64,
    ) -> Result<Impact, InvalidInput> {
        material.check()?;
        InvalidInput::require_positive("thickness_m", thickness_m)?;
        InvalidInput::require_positive("radius_m", radius_m)?;
        let plate = PlateSection {
            flexural_rigidity_n_m: material.youngs_modulus_pa * thickness_m.powi(3)
                / (12.0 * (1.0 - material.poissons_ratio.powi(2))),
            mass_per_area_kg_m2: material.density_kg_m3 * thickness_m,
        };
        Impact::on_plate(plate, material.sphere(radius_m, speed_m_s), material.hertz_stiffness(radius_m))
    }

    fn checked(self) -> Result<Impact, InvalidInput> {
        InvalidInput::require_positive("impulse_response", self.impulse_response)?;
        InvalidInput::require_positive("stiffness_n_m1_5", self.stiffness_n_m1_5)?;
        InvalidInput::require_positive("mass_kg", self.mass_kg)?;
        InvalidInput::require_positive("speed_m_s", self.speed_m_s)?;
        Ok(self)
    }

    /// `S` and the units. For the plate `T = alpha m`, `F = v / alpha` and
    /// `S = alpha^5 k_H^2 m^3 v`.
    ///
    /// # Errors
    /// [`InvalidInput`] if a constant is not finite and positive, or `S` or a unit overflows.
    pub fn groups(&self) -> Result<Groups, InvalidInput> {
        self.checked()?;
        let (c, k, m, v) = (self.impulse_response, self.stiffness_n_m1_5, self.mass_kg, self.speed_m_s);
        let time_s = match self.structure {
            Structure::Beam => (c * m).powi(2),
            Structure::Plate => c * m,
        };
        let force_n = m * v / time_s;
        let displacement_m = v * time_s;
        let root_s = k * displacement_m * displacement_m.sqrt() / force_n;
        let thesis_length_m = (force_n / k).powf(2.0 / 3.0);
        let groups = Groups {
            s: root_s * root_s,
            time_s,
            force_n,
            displacement_m,
            speed_m_s: v,
            thesis_length_m,
            thesis_velocity_m_s: thesis_length_m / time_s,
            thesis_mass_kg: time_s * time_s * force_n / thesis_length_m,
        };
        for (field, value) in [("time_s", time_s), ("force_n", force_n), ("s", groups.s)] {
            InvalidInput::require_positive(field, value)?;
        }
        Ok(groups)
    }
}
