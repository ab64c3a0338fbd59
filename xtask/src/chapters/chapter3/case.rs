//! The chapter's parameters, beam and ball.

use crate::chapters::beam::{Beam, End, segment};
use crate::chapters::impact::{Ball, Setup};
use crate::chapters::material::Material;
use contact_models::{Hysteretic, Law, Viscous};
use serde::Deserialize;
use tasks::Failure;

/// The parameter file, which explains its entries.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    #[serde(rename = "about")]
    _about: String,
    pub beam: Pinned,
    pub material: Material,
    pub ball_diameter_m: f64,
    pub speed_m_s: f64,
    pub locations_m: [f64; 2],
    pub damping_ratio: f64,
    pub viscous_damping_s_m: f64,
    pub hysteretic: Hysteresis,
    #[serde(rename = "loop")]
    pub prescribed_loop: Hysteresis,
    pub wall_speeds_m_s: Vec<f64>,
    pub other_speeds_m_s: Vec<f64>,
    pub other_diameters_m: [f64; 2],
    pub scan: Scan,
    pub our_choice: Choice,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pinned {
    pub length_m: f64,
    pub side_m: f64,
    pub ends: [End; 2],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hysteresis {
    pub stiffness_n_m1_5: Option<f64>,
    pub theta_m: f64,
    pub beta: f64,
    pub k_bar: f64,
    pub epsilon_m: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scan {
    pub from_m: f64,
    pub to_m: f64,
    pub diameter_m: f64,
    pub modes: usize,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Choice {
    #[serde(rename = "about")]
    _about: String,
    pub most_modes: usize,
    pub scan_places: usize,
    pub energy_modes: Vec<usize>,
    pub heavy_diameter_m: f64,
    pub stiffness_scan: StiffnessScan,
    pub residual_modes: Vec<usize>,
}

/// Contact stiffnesses as multiples of the printed one.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StiffnessScan {
    pub from: f64,
    pub to: f64,
    pub values: usize,
}

/// The chapter's beam and ball with everything that its sections vary.
pub struct Case {
    pub parameters: Parameters,
    pub beam: Beam,
    pub ball: Ball,
}

impl Case {
    pub fn load() -> Result<Case, Failure> {
        let parameters: Parameters = serde_json::from_str(include_str!("../../../../datasets/chapter3.json"))?;
        let pinned = &parameters.beam;
        let segment = segment(&parameters.material, pinned.length_m, pinned.side_m, 1.0);
        let most =
            parameters.our_choice.residual_modes.iter().copied().fold(parameters.our_choice.most_modes, usize::max);
        let beam = Beam::new("pinned-pinned", "Uniform pinned-pinned beam", pinned.ends, vec![segment], most)?;
        let ball = Ball::new(&parameters.material, parameters.ball_diameter_m)?;
        Ok(Case { parameters, beam, ball })
    }

    /// The reference of the chapter: Hertzian contact, no damping, plain truncation.
    pub fn setup(&self, location_m: f64, modes: usize) -> Setup<'_> {
        Setup {
            beam: &self.beam,
            location_m,
            ball: self.ball,
            law: self.ball.hertz(),
            speed_m_s: self.parameters.speed_m_s,
            damping_ratio: 0.0,
            residual: false,
            modes,
        }
    }

    /// Thesis Eq. 3.15.
    pub fn viscous(&self) -> Result<Law, Failure> {
        Ok(Viscous::new(self.ball.stiffness_n_m1_5, self.parameters.viscous_damping_s_m)?.into())
    }

    /// Thesis Eqs. 3.16 and 3.17; the stiffness is divided by `1 + theta_m + beta`, so that first
    /// loading is Hertz's.
    pub fn hysteretic(&self) -> Result<Law, Failure> {
        let h = &self.parameters.hysteretic;
        let stiffness = self.ball.stiffness_n_m1_5 / (1.0 + h.theta_m + h.beta);
        Ok(Hysteretic {
            stiffness_n_m1_5: stiffness,
            theta_m: h.theta_m,
            beta: h.beta,
            k_bar: h.k_bar,
            epsilon_m: h.epsilon_m,
        }
        .validated()?
        .into())
    }

    /// The location that is not a simple fraction of the length.
    pub fn golden_m(&self) -> f64 {
        self.parameters.locations_m[1]
    }
}
