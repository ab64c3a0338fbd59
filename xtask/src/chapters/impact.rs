//! One impact of the chapters: beam, location, ball and number of modes.

use super::beam::Beam;
use super::material::Material;
use contact_models::{Body, Hertz, Law};
use serde::Serialize;
use std::f64::consts::PI;
use tasks::Failure;
use vibroimpact_sim::modal::{History, Settings, Solution, Solver, Striker, Structure};

/// A solid ball.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ball {
    pub diameter_m: f64,
    pub mass_kg: f64,
    /// Hertz stiffness against a flat of the same material (thesis Eqs. 3.14 and 4.8).
    pub stiffness_n_m1_5: f64,
}

impl Ball {
    pub fn new(material: &Material, diameter_m: f64) -> Result<Ball, Failure> {
        let (modulus, ratio) = (material.youngs_modulus_pa, material.poissons_ratio);
        let sphere = Body { youngs_modulus_pa: modulus, poissons_ratio: ratio, radius_m: 0.5 * diameter_m };
        let hertz = Hertz::from_bodies(&sphere, &Body::flat(modulus, ratio))?;
        let mass_kg = material.density_kg_m3 * PI / 6.0 * diameter_m.powi(3);
        Ok(Ball { diameter_m, mass_kg, stiffness_n_m1_5: hertz.stiffness_n_m1_5 })
    }

    pub fn hertz(&self) -> Law {
        Law::Hertz(Hertz { stiffness_n_m1_5: self.stiffness_n_m1_5 })
    }
}

/// Everything that defines one impact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Setup<'a> {
    pub beam: &'a Beam,
    pub location_m: f64,
    pub ball: Ball,
    pub law: Law,
    pub speed_m_s: f64,
    pub damping_ratio: f64,
    /// Whether remainder modes represent the truncated modes.
    pub residual: bool,
    pub modes: usize,
}

/// Tolerance of the restitutions of the chapters.
const TOLERANCE: f64 = 1e-7;

impl Setup<'_> {
    fn structure(&self) -> Result<Structure, Failure> {
        self.beam.structure(self.location_m, self.modes, self.damping_ratio, self.residual)
    }

    fn striker(&self) -> Striker {
        Striker { mass_kg: self.ball.mass_kg, speed_m_s: self.speed_m_s }
    }

    fn settings() -> Settings {
        Settings { tolerance: TOLERANCE, ..Settings::default() }
    }

    /// A solver for the structure of this setup, which can be reused for several balls, speeds and laws.
    pub fn solver(&self) -> Result<Solver, Failure> {
        Ok(Solver::new(&self.structure()?)?)
    }

    /// Solves the impact with a solver made for the same beam, location and modes.
    pub fn solve_with(&self, solver: &Solver) -> Result<Row, Failure> {
        let solution = solver.solve(&self.striker(), &self.law, None, &Setup::settings())?;
        Ok(Row::new(self, &solution))
    }

    /// The same without an estimate of the uncertainty, for tables of which only counts and means are reported.
    pub fn solve_once_with(&self, solver: &Solver) -> Result<Row, Failure> {
        let settings = Settings { estimate_uncertainty: false, ..Setup::settings() };
        Ok(Row::new(self, &solver.solve(&self.striker(), &self.law, None, &settings)?))
    }

    /// Solves the impact.
    pub fn solve(&self) -> Result<Row, Failure> {
        self.solve_with(&self.solver()?)
    }

    /// Solves the impact and returns its motion in time.
    pub fn record(&self) -> Result<(Solution, History<Law>), Failure> {
        Ok(self.solver()?.record(&self.striker(), &self.law, None, &Setup::settings())?)
    }
}

/// One impact and its result, as a row of a table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Row {
    pub beam: String,
    pub mass_kg: f64,
    pub diameter_m: f64,
    pub location_m: f64,
    pub restitution: Option<f64>,
    pub restitution_uncertainty: Option<f64>,
    pub sub_impacts: usize,
    pub last_separation_s: f64,
    pub outcome: &'static str,
    pub law: &'static str,
    pub speed_m_s: f64,
    pub damping_ratio: f64,
    pub modes: usize,
    pub residual_compliance: bool,
}

impl Row {
    fn new(setup: &Setup, solution: &Solution) -> Row {
        Row {
            beam: setup.beam.name.clone(),
            mass_kg: setup.ball.mass_kg,
            diameter_m: setup.ball.diameter_m,
            location_m: setup.location_m,
            restitution: solution.restitution,
            restitution_uncertainty: solution.restitution_uncertainty,
            sub_impacts: solution.sub_impacts.len(),
            last_separation_s: solution.sub_impacts.last().map_or(0.0, |s| s.end_s),
            outcome: solution.outcome.as_str(),
            law: setup.law.name(),
            speed_m_s: setup.speed_m_s,
            damping_ratio: setup.damping_ratio,
            modes: setup.modes,
            residual_compliance: setup.residual,
        }
    }

    /// The restitution as a number. NaN if there is none; figures omit NaN, and statements reject it.
    pub fn e(&self) -> f64 {
        self.restitution.unwrap_or(f64::NAN)
    }
}
