//! The chapter's parameters, beams and balls.

use crate::chapters::beam::{Beam, End, segment};
use crate::chapters::impact::{Ball, Setup};
use crate::chapters::material::Material;
use serde::Deserialize;
use tasks::Failure;

/// The parameter file, which explains its entries.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    #[serde(rename = "about")]
    _about: String,
    pub material: Material,
    pub side_m: f64,
    pub speed_m_s: f64,
    pub damping_ratio: f64,
    pub modes: usize,
    pub places: usize,
    pub finite_elements: usize,
    pub our_choice: Choice,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Choice {
    #[serde(rename = "about")]
    _about: String,
    pub beams: Vec<BeamChoice>,
    pub diameters_m: Vec<f64>,
    pub speed_study: SpeedStudy,
    pub convergence_study: ConvergenceStudy,
    pub detailed: Detailed,
    pub histories: Vec<Histories>,
    pub finite_element_study: Target,
    pub settled_modes: [usize; 2],
    pub ensemble: EnsembleChoice,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BeamChoice {
    pub name: String,
    pub title: String,
    pub ends: [End; 2],
    pub segments: Vec<SegmentChoice>,
}

/// Other plausible choices.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EnsembleChoice {
    pub steps_m: Vec<f64>,
    pub slim_thickness_fractions: Vec<f64>,
    pub named_diameters_mm: Vec<u32>,
}

impl EnsembleChoice {
    /// Every list of twelve balls in equal steps of whole millimetres, of 4 mm or more as the named diameters demand,
    /// that contains all named diameters.
    pub fn ball_lists(&self) -> Vec<Vec<u32>> {
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
pub struct SegmentChoice {
    pub length_m: f64,
    pub thickness_fraction: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpeedStudy {
    pub beam: String,
    pub diameter_m: f64,
    pub locations_m: Vec<f64>,
    pub factor: f64,
    pub speeds: usize,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConvergenceStudy {
    pub beam: String,
    pub diameter_m: f64,
    pub locations_m: Vec<f64>,
    pub most_modes: usize,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Detailed {
    pub beam: String,
    pub diameter_m: f64,
    pub locations_m: Vec<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Histories {
    pub figure: String,
    pub beam: String,
    pub diameter_m: f64,
    pub locations_m: Vec<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Target {
    pub beam: String,
    pub diameter_m: f64,
    pub other_diameters_m: Vec<f64>,
}

/// The chapter's beams and balls with everything that its sections vary.
pub struct Case {
    pub parameters: Parameters,
    pub beams: Vec<Beam>,
    pub balls: Vec<Ball>,
}

impl Case {
    pub fn load() -> Result<Case, Failure> {
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

    pub fn beam(&self, name: &str) -> Result<&Beam, Failure> {
        self.beams.iter().find(|b| b.name == name).ok_or_else(|| format!("no beam is called {name}").into())
    }

    pub fn ball(&self, diameter_m: f64) -> Result<Ball, Failure> {
        Ball::new(&self.parameters.material, diameter_m)
    }

    /// A few of the balls, from light to heavy.
    pub fn every_third_ball(&self) -> Vec<Ball> {
        self.balls.iter().copied().skip(1).step_by(3).collect()
    }

    /// The chapter's model: 40 modes, damped, plain truncation.
    pub fn setup<'a>(&'a self, beam: &'a Beam, ball: Ball, location_m: f64) -> Setup<'a> {
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
    pub fn places(&self, beam: &Beam) -> Vec<f64> {
        let steps = self.parameters.places.max(2) - 1;
        let length = beam.model.beam.length_m();
        (0..=steps).map(|i| length * i as f64 / steps as f64).collect()
    }
}
