//! Chapter 4: four beams, twelve balls, twenty-five locations.

mod courses;
mod finite_elements;
mod settled;
mod studies;
pub(super) mod tables;
pub(super) mod trends;

use super::Failure;
use super::beam::{Beam, End, segment};
use super::impact::{Ball, Setup};
use super::material::Material;
use super::statement::Statement;
use super::study::Study;
use serde::Deserialize;

const INTRODUCTION: &str = "Steel balls strike four steel beams, all of 1 m length and lightly damped (2 % of critical \
damping in every mode), with 40 modes and Hertzian contact. The tables `restitution-*.csv` hold the net restitution of \
every ball at every place; chapter 7 fits its model to them. The thesis does not print where its stepped beams have \
their step, how thin the slim part is, or the list of balls: here the step is half way, the slim part has half the \
thickness, and the balls are 9 to 53 mm in steps of 4 mm, which contains every mass that the chapter names. These are \
our choices (`datasets/chapter4.json`), so the figures of the stepped beams can be compared in kind only.";

/// The parameter file, which explains its entries.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Parameters {
    #[serde(rename = "about")]
    _about: String,
    pub(super) material: Material,
    pub(super) side_m: f64,
    pub(super) speed_m_s: f64,
    damping_ratio: f64,
    pub(super) modes: usize,
    pub(super) places: usize,
    finite_elements: usize,
    pub(super) our_choice: Choice,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Choice {
    #[serde(rename = "about")]
    _about: String,
    pub(super) beams: Vec<BeamChoice>,
    diameters_m: Vec<f64>,
    pub(super) speed_study: SpeedStudy,
    pub(super) convergence_study: ConvergenceStudy,
    pub(super) detailed: Detailed,
    pub(super) histories: Vec<Histories>,
    finite_element_study: Target,
    settled_modes: [usize; 2],
    pub(super) ensemble: EnsembleChoice,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BeamChoice {
    pub(super) name: String,
    pub(super) title: String,
    pub(super) ends: [End; 2],
    pub(super) segments: Vec<SegmentChoice>,
}

/// Other plausible choices.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EnsembleChoice {
    pub(super) steps_m: Vec<f64>,
    pub(super) slim_thickness_fractions: Vec<f64>,
    pub(super) named_diameters_mm: Vec<u32>,
}

impl EnsembleChoice {
    /// Every list of twelve balls in equal steps of whole millimetres, of 4 mm or more as the named diameters demand,
    /// that contains all named diameters.
    pub(super) fn ball_lists(&self) -> Vec<Vec<u32>> {
        const BALLS: u32 = 12;
        let (Some(&least), Some(&most)) = (self.named_diameters_mm.iter().min(), self.named_diameters_mm.iter().max())
        else {
            return Vec::new();
        };
        let from_step = |step: u32| (1..=least).map(move |first| (0..BALLS).map(|k| first + k * step).collect());
        let all = (1..=most).flat_map(from_step);
        all.filter(|list: &Vec<u32>| self.named_diameters_mm.iter().all(|named| list.contains(named))).collect()
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SegmentChoice {
    length_m: f64,
    thickness_fraction: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SpeedStudy {
    pub(super) beam: String,
    pub(super) diameter_m: f64,
    pub(super) locations_m: Vec<f64>,
    pub(super) factor: f64,
    speeds: usize,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ConvergenceStudy {
    pub(super) beam: String,
    pub(super) diameter_m: f64,
    pub(super) locations_m: Vec<f64>,
    most_modes: usize,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Detailed {
    pub(super) beam: String,
    pub(super) diameter_m: f64,
    pub(super) locations_m: Vec<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Histories {
    pub(super) figure: String,
    pub(super) beam: String,
    pub(super) diameter_m: f64,
    pub(super) locations_m: Vec<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Target {
    beam: String,
    diameter_m: f64,
    other_diameters_m: Vec<f64>,
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

    /// A few of the balls, from light to heavy.
    pub(super) fn every_third_ball(&self) -> Vec<Ball> {
        self.balls.iter().copied().skip(1).step_by(3).collect()
    }

    /// The chapter's model: 40 modes, damped, plain truncation.
    pub(super) fn setup<'a>(&'a self, beam: &'a Beam, ball: Ball, location_m: f64) -> Setup<'a> {
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

    /// Equally spaced locations, both ends included.
    pub(super) fn places(&self, beam: &Beam) -> Vec<f64> {
        let steps = self.parameters.places.max(2) - 1;
        let length = beam.model.beam.length_m();
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
    trends::tell(study, &tables);
    settled::run(study, &case, &tables)?;
    finite_elements::run(study, &case)?;
    Ok(INTRODUCTION)
}

/// The numbers of section 4.2.
fn numbers(study: &mut Study, case: &Case) -> Result<(), Failure> {
    let (small, middle, large) = (case.ball(0.025)?, case.ball(0.033)?, case.ball(0.053)?);
    study.claim(Statement::printed("mass of the 25 mm ball (kg)", "4.2", "0.0638", small.mass_kg));
    let stiffness = small.stiffness_n_m1_5;
    study.claim(Statement::printed("Hertz stiffness, 25 mm ball (N/m^1.5)", "4.2", "1.638e10", stiffness));
    for (diameter, source, printed, ball) in [("33", "Fig. 4.3", 0.147, middle), ("53", "Fig. 4.10", 0.608, large)] {
        study.claim(Statement::self_check(
            format!("mass of the {diameter} mm ball (kg)"),
            [source, &printed.to_string(), "half a unit of the last digit; the diameter is ours, found from the mass"],
            (printed - 5e-4, printed + 5e-4),
            ball.mass_kg,
        ));
    }
    let pinned = case.beam("pinned-pinned")?;
    let omega = pinned.omega_rad_s();
    study.claim(Statement::identity(
        "40th over first natural frequency, pinned-pinned",
        ["4.2", "1600", "40², exactly"],
        (1600.0 - 1e-6, 1600.0 + 1e-6),
        omega[39] / omega[0],
    ));
    study.claim(Statement::identity(
        "smallest location other than 0 (m)",
        ["4.2", "0.04166…", "1/24, as printed"],
        (0.04166, 0.04167),
        case.places(pinned)[1],
    ));
    Ok(())
}
