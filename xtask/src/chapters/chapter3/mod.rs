//! Chapter 3: one beam, one ball, and the conditions under which the restitution converges as modes are added.

mod convergence;
mod dissipation;
mod luck;
mod motion;
mod numbers;
mod residual;
pub(super) mod scatter;

use super::Failure;
use super::beam::{Beam, End, segment};
use super::impact::{Ball, Setup};
use super::material::Material;
use super::study::Study;
use contact_models::{Hysteretic, Law, Viscous};
use serde::Deserialize;

const INTRODUCTION: &str = "A steel ball strikes a pinned-pinned steel beam; contact is Hertzian, or Hertzian with \
a little dissipation; the beam is undamped, or every mode has 2 % of critical damping. Every sub-impact is resolved. \
The chapter's question is how the net restitution depends on the number N of modes that are kept. Figures carry the \
numbers of the thesis. The restitution of undamped impacts with many modes amplifies any disturbance by factors of \
10⁵ and more; the column `restitution_uncertainty` of the tables tells how many digits of each result can be \
trusted. *Scatter* below is the standard deviation of the restitution over the numbers of modes.";

/// The parameter file, which explains its entries.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Parameters {
    #[serde(rename = "about")]
    _about: String,
    pub(super) beam: Pinned,
    pub(super) material: Material,
    pub(super) ball_diameter_m: f64,
    speed_m_s: f64,
    pub(super) locations_m: [f64; 2],
    pub(super) damping_ratio: f64,
    viscous_damping_s_m: f64,
    hysteretic: Hysteresis,
    #[serde(rename = "loop")]
    prescribed_loop: Hysteresis,
    wall_speeds_m_s: Vec<f64>,
    other_speeds_m_s: Vec<f64>,
    pub(super) other_diameters_m: [f64; 2],
    scan: Scan,
    pub(super) our_choice: Choice,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Pinned {
    pub(super) length_m: f64,
    pub(super) side_m: f64,
    ends: [End; 2],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Hysteresis {
    stiffness_n_m1_5: Option<f64>,
    theta_m: f64,
    beta: f64,
    k_bar: f64,
    epsilon_m: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Scan {
    from_m: f64,
    to_m: f64,
    diameter_m: f64,
    modes: usize,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Choice {
    #[serde(rename = "about")]
    _about: String,
    pub(super) most_modes: usize,
    scan_places: usize,
    energy_modes: Vec<usize>,
    heavy_diameter_m: f64,
    stiffness_scan: StiffnessScan,
    pub(super) residual_modes: Vec<usize>,
}

/// Contact stiffnesses as multiples of the printed one.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StiffnessScan {
    from: f64,
    to: f64,
    values: usize,
}

/// The chapter's beam and ball with everything that its sections vary.
pub(super) struct Case {
    pub(super) parameters: Parameters,
    pub(super) beam: Beam,
    ball: Ball,
}

impl Case {
    pub(super) fn load() -> Result<Case, Failure> {
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
    pub(super) fn setup(&self, location_m: f64, modes: usize) -> Setup<'_> {
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
    fn viscous(&self) -> Result<Law, Failure> {
        Ok(Viscous::new(self.ball.stiffness_n_m1_5, self.parameters.viscous_damping_s_m)?.into())
    }

    /// Thesis Eqs. 3.16 and 3.17; the stiffness is divided by `1 + theta_m + beta`, so that first
    /// loading is Hertz's.
    fn hysteretic(&self) -> Result<Law, Failure> {
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
    pub(super) fn golden_m(&self) -> f64 {
        self.parameters.locations_m[1]
    }
}

/// Runs the chapter and returns the text that introduces its report.
pub(super) fn run(study: &mut Study) -> Result<&'static str, Failure> {
    let case = Case::load()?;
    numbers::run(study, &case)?;
    dissipation::run(study, &case)?;
    motion::run(study, &case)?;
    convergence::run(study, &case)?;
    luck::run(study, &case)?;
    residual::run(study, &case)?;
    Ok(INTRODUCTION)
}
