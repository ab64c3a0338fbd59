//! Chapter 4: four beams, twelve balls, twenty-five places.

mod courses;
mod finite_elements;
mod settled;
mod studies;
pub(super) mod tables;

use super::Failure;
use super::beam::{Beam, End, segment};
use super::impact::{Ball, Material, Setup};
use super::study::Study;
use serde::Deserialize;
use std::f64::consts::PI;
use vibroimpact::report::Comparison;

const INTRODUCTION: &str = "Steel balls strike four steel beams, all of 1 m length and lightly damped (2 % of critical \
damping in every mode), with 40 modes and Hertzian contact. The tables `restitution-*.csv` hold the net restitution of \
every ball at every place; chapter 7 fits its model to them. The thesis does not print where its stepped beams have \
their step, how thin the slim part is, or the list of balls: here the step is half way, the slim part has half the \
thickness, and the balls are 9 to 53 mm in steps of 4 mm, which contains every mass that the chapter names. These are \
our choices (`datasets/chapter4.json`), so the figures of the stepped beams can be compared in kind only.";

/// The parameter file; see its own remarks.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Parameters {
    #[serde(rename = "about")]
    _about: String,
    material: Material,
    side_m: f64,
    speed_m_s: f64,
    damping_ratio: f64,
    pub(super) modes: usize,
    places: usize,
    finite_elements: usize,
    our_choice: Choice,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Choice {
    #[serde(rename = "about")]
    _about: String,
    beams: Vec<BeamChoice>,
    diameters_m: Vec<f64>,
    speed_study: SpeedStudy,
    convergence_study: ConvergenceStudy,
    detailed: Detailed,
    histories: Vec<Histories>,
    finite_element_study: Target,
    settled_modes: [usize; 2],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BeamChoice {
    name: String,
    title: String,
    ends: [End; 2],
    segments: Vec<SegmentChoice>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SegmentChoice {
    length_m: f64,
    thickness_fraction: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SpeedStudy {
    beam: String,
    diameter_m: f64,
    locations_m: Vec<f64>,
    factor: f64,
    speeds: usize,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ConvergenceStudy {
    beam: String,
    diameter_m: f64,
    locations_m: Vec<f64>,
    most_modes: usize,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Detailed {
    beam: String,
    diameter_m: f64,
    locations_m: Vec<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Histories {
    figure: String,
    beam: String,
    diameter_m: f64,
    locations_m: Vec<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Target {
    beam: String,
    diameter_m: f64,
}

/// The chapter's beams and balls with everything that its sections vary.
pub(super) struct Case {
    pub(super) parameters: Parameters,
    pub(super) beams: Vec<Beam>,
    balls: Vec<Ball>,
}

impl Case {
    pub(super) fn load() -> Result<Case, Failure> {
        let parameters: Parameters = serde_json::from_str(include_str!("../../../../datasets/chapter4.json"))?;
        let choice = &parameters.our_choice;
        let most = choice.settled_modes.iter().copied().fold(choice.convergence_study.most_modes, usize::max);
        let beam = |b: &BeamChoice| {
            let cut =
                |s: &SegmentChoice| segment(&parameters.material, s.length_m, parameters.side_m, s.thickness_fraction);
            Beam::new(&b.name, &b.title, b.ends, b.segments.iter().map(cut).collect(), most)
        };
        let beams = choice.beams.iter().map(beam).collect::<Result<_, Failure>>()?;
        let balls =
            choice.diameters_m.iter().map(|&d| Ball::new(&parameters.material, d)).collect::<Result<_, Failure>>()?;
        Ok(Case { parameters, beams, balls })
    }

    fn beam(&self, name: &str) -> Result<&Beam, Failure> {
        self.beams.iter().find(|b| b.name == name).ok_or_else(|| format!("no beam is called {name}").into())
    }

    fn ball(&self, diameter_m: f64) -> Result<Ball, Failure> {
        Ball::new(&self.parameters.material, diameter_m)
    }

    /// The chapter's model: 40 modes, damped, plain truncation.
    fn setup<'a>(&'a self, beam: &'a Beam, ball: Ball, location_m: f64) -> Setup<'a> {
        Setup {
            beam,
            location_m,
            ball,
            law: ball.hertz(),
            speed_m_s: self.parameters.speed_m_s,
            damping_ratio: self.parameters.damping_ratio,
            residual: false,
            modes: self.parameters.modes,
        }
    }

    /// Equally spaced places, both ends included.
    fn places(&self, beam: &Beam) -> Vec<f64> {
        let steps = self.parameters.places.max(2) - 1;
        let length = beam.model.length_m();
        (0..=steps).map(|i| length * i as f64 / steps as f64).collect()
    }
}

/// Runs the chapter and returns the text that introduces its report.
pub(super) fn run(study: &mut Study) -> Result<&'static str, Failure> {
    let case = Case::load()?;
    numbers(study, &case)?;
    studies::run(study, &case)?;
    courses::run(study, &case)?;
    let tables = tables::run(study, &case)?;
    settled::run(study, &case, &tables)?;
    finite_elements::run(study, &case)?;
    Ok(INTRODUCTION)
}

/// The numbers of section 4.2.
fn numbers(study: &mut Study, case: &Case) -> Result<(), Failure> {
    let (small, middle, large) = (case.ball(0.025)?, case.ball(0.033)?, case.ball(0.053)?);
    study.state(Comparison::printed("mass of the 25 mm ball (kg)", "4.2", "0.0638", small.mass_kg));
    study.state(Comparison::printed(
        "Hertz stiffness, 25 mm ball (N/m^1.5)",
        "4.2",
        "1.638e10",
        small.stiffness_n_m1_5,
    ));
    study.state(Comparison::printed("mass of the 33 mm ball (kg)", "Fig. 4.3", "0.147", middle.mass_kg));
    study.state(Comparison::printed("mass of the 53 mm ball (kg)", "Fig. 4.10", "0.608", large.mass_kg));
    let pinned = case.beam("pinned-pinned")?;
    let omega = pinned.omega_rad_s();
    study.state(Comparison::printed(
        "40th over first natural frequency, pinned-pinned",
        "4.2",
        "1600",
        omega[39] / omega[0],
    ));
    study.state(Comparison::range(
        "smallest place other than 0 (m)",
        "4.2",
        "0.04166…",
        (0.04166, 0.04167),
        case.places(pinned)[1],
    ));
    study.state(Comparison::about(
        "first natural frequency, pinned-pinned (Hz)",
        "3.3.1, same beam",
        "close to 26",
        26.0,
        0.5,
        omega[0] / (2.0 * PI),
    ));
    Ok(())
}
