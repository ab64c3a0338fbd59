//! The bar and the ball, their bounces with every contact resolved, and the EMOC law fitted to some of them.

use beam_modes::{Beam, End, Modes, RectangularSegment, Segment};
use contact_models::{Body, Hertz};
use emoc::{Impact, Parameters, Site};
use fitting::{Parameter, Problem};
use std::error::Error;
use vibroimpact_sim::modal::{Mode, Settings, Solver, Start, Striker, Structure};

pub const LENGTH_M: f64 = 0.3;
pub const THICKNESS_M: f64 = 0.01;
pub const GRAVITY_M_S2: f64 = 9.81;
/// Steel, of ball and bar.
const MODULUS_PA: f64 = 2e11;
const DENSITY_KG_M3: f64 = 7800.0;
const POISSON: f64 = 0.3;
/// Modes of the resolved impact; the response of those above is their static compliance.
const MODES: usize = 80;
/// Modes in the law: up to 65 kHz, as far as the 50 modes of the thesis's beams reach.
pub const LAW_MODES: usize = 16;
/// Entries of the table of locations that the game uses.
const TABLE: usize = 300;
/// A resolved bounce starts with the ball this high above the bar at rest, which is more than the bar's amplitude.
const ABOVE_M: f64 = 2e-3;

/// A pinned steel bar.
pub struct Bar {
    beam: Beam,
    modes: Modes,
    /// Damping ratio of every mode.
    damping_ratio: f64,
}

/// A steel ball.
#[derive(Clone, Copy)]
pub struct Ball {
    pub radius_m: f64,
}

impl Ball {
    pub fn mass_kg(self) -> f64 {
        DENSITY_KG_M3 * 4.0 / 3.0 * std::f64::consts::PI * self.radius_m.powi(3)
    }

    pub fn on_flat(self) -> Result<Hertz, Box<dyn Error>> {
        let ball = Body { youngs_modulus_pa: MODULUS_PA, poissons_ratio: POISSON, radius_m: self.radius_m };
        Ok(Hertz::from_bodies(&ball, &Body::flat(MODULUS_PA, POISSON))?)
    }
}

impl Bar {
    pub fn new(damping_ratio: f64) -> Result<Bar, Box<dyn Error>> {
        let segment = Segment::from(RectangularSegment {
            length_m: LENGTH_M,
            youngs_modulus_pa: MODULUS_PA,
            density_kg_m3: DENSITY_KG_M3,
            width_m: 0.02,
            thickness_m: THICKNESS_M,
        });
        let beam = Beam { segments: vec![segment], ends: [End::Pinned, End::Pinned] };
        Ok(Bar { modes: beam.modes(MODES)?, beam, damping_ratio })
    }

    /// The bar in the form of the solver, at a location.
    pub fn structure(&self, x_m: f64) -> Result<Structure, Box<dyn Error>> {
        // Two remainder modes for all others.
        let modes = self.modes.seen_from(x_m)?.into_iter().chain(self.beam.remainder(x_m, MODES, 2)?);
        Ok(Structure::from_modes(modes, self.damping_ratio))
    }

    /// Drops the ball from a height and resolves every contact of its first bounces. The bar continues to vibrate between them;
    /// gravity acts in flight, and is neglected during the few milliseconds of a bounce.
    pub fn bounces(&self, ball: Ball, x_m: f64, height_m: f64, count: usize) -> Result<Vec<Bounce>, Box<dyn Error>> {
        let structure = self.structure(x_m)?;
        let displacement =
            |amplitude: &[f64]| structure.modes.iter().zip(amplitude).map(|(mode, a)| mode.shape * a).sum::<f64>();
        let (mass_kg, hertz) = (ball.mass_kg(), ball.on_flat()?);
        let solver = Solver::new(&structure)?;
        let settings = Settings { estimate_uncertainty: false, ..Settings::default() };
        let mut start = Start::at_rest(structure.modes.len());
        // As if it had left from there, upwards.
        let (mut from_m, mut speed_m_s) = (height_m, 0.0);
        let mut bounces = Vec::new();
        while bounces.len() < count {
            let Some((time_s, fallen_m_s)) = flight(from_m - ABOVE_M, speed_m_s) else { break };
            ring(&structure.modes, &mut start, time_s);
            start.gap_m = ABOVE_M - displacement(&start.amplitude);
            let striker = Striker { mass_kg, speed_m_s: fallen_m_s };
            let found = solver.solve(&striker, &hertz, Some(&start), &settings)?;
            let (Some(first), Some(last)) = (found.sub_impacts.first(), found.sub_impacts.last()) else { break };
            let mut touch = start.clone();
            ring(&structure.modes, &mut touch, first.start_s);
            (from_m, speed_m_s) = (displacement(&found.amplitude), found.striker_velocity_m_s.max(0.0));
            bounces.push(Bounce {
                restitution: speed_m_s / fallen_m_s,
                height_m: speed_m_s.powi(2) / (2.0 * GRAVITY_M_S2),
                duration_s: last.end_s - first.start_s,
                flight_s: time_s + first.start_s,
                fallen_m_s,
                touch,
            });
            (start.amplitude, start.rate) = (found.amplitude, found.rate);
        }
        Ok(bounces)
    }

    /// Fits the law's three parameters to resolved first bounces of some balls at some locations.
    pub fn law(&self, balls: &[Ball], locations_m: &[f64], height_m: f64) -> Result<Law, Box<dyn Error>> {
        let site =
            |x_m: f64| -> Result<Site, Box<dyn Error>> { Ok(Site::new(&self.modes.shapes_at(x_m)?[..LAW_MODES])?) };
        let mut seen = Vec::new();
        for &x_m in locations_m {
            let site = site(x_m)?;
            for &ball in balls {
                for bounce in self.bounces(ball, x_m, height_m, 1)? {
                    seen.push((Impact::new(ball.mass_kg(), &site)?, bounce.restitution));
                }
            }
        }
        let law = |p: &[f64]| Parameters { mu0: p[0], alpha0: p[1], alpha1: p[2], notional_restitution: 1.0 };
        let fitted = fitting::fit(
            &Problem {
                parameters: ["mu0", "alpha0", "alpha1"].map(|name| Parameter::positive(name, 1.0, (1e-3, 1e3))).into(),
                count: seen.len(),
                residuals: &|p, residuals| {
                    for (residual, (impact, restitution)) in residuals.iter_mut().zip(&seen) {
                        *residual = law(p).rebound(impact).map_or(f64::NAN, |found| found.restitution - restitution);
                    }
                },
                jacobian: None,
            },
            &fitting::Settings { starts: 24, ..fitting::Settings::default() },
        )?;
        let sites = (0..=TABLE).map(|i| site(LENGTH_M * i as f64 / TABLE as f64)).collect::<Result<_, _>>()?;
        Ok(Law { parameters: law(&fitted.parameters), sites })
    }
}

/// One bounce, every contact resolved.
pub struct Bounce {
    /// Speed after it over speed before it.
    pub restitution: f64,
    /// Height of the rebound.
    pub height_m: f64,
    /// From the first touch to the last separation.
    pub duration_s: f64,
    /// From the last separation before it, or from the release of the ball, to the first touch.
    pub flight_s: f64,
    /// Speed at the first touch.
    pub fallen_m_s: f64,
    /// Motion of the bar at that time.
    pub touch: Start,
}

// ANCHOR: law
/// The data of the game: three numbers, and the numbers of the law for each location.
pub struct Law {
    pub parameters: Parameters,
    sites: Vec<Site>,
}

impl Law {
    /// Restitution of a ball at a location, from a table and a closed form.
    pub fn restitution(&self, mass_kg: f64, x_m: f64) -> f64 {
        let nearest = (x_m / LENGTH_M * TABLE as f64).round() as usize;
        let site = &self.sites[nearest.min(TABLE)];
        let rebound = Impact::new(mass_kg, site).and_then(|impact| self.parameters.rebound(&impact));
        rebound.map_or(0.0, |rebound| rebound.restitution)
    }
}
// ANCHOR_END: law

/// Time and downward speed when a ball thrown upwards has fallen by `drop_m`; `None` if it stays below.
fn flight(drop_m: f64, speed_m_s: f64) -> Option<(f64, f64)> {
    let squared = speed_m_s.powi(2) + 2.0 * GRAVITY_M_S2 * drop_m;
    (squared > 0.0).then(|| ((speed_m_s + squared.sqrt()) / GRAVITY_M_S2, squared.sqrt()))
}

/// Free vibration of the bar.
pub fn ring(modes: &[Mode], state: &mut Start, time_s: f64) {
    for ((mode, a), rate) in modes.iter().zip(&mut state.amplitude).zip(&mut state.rate) {
        let decay = mode.damping_ratio * mode.omega_rad_s;
        let omega_d = mode.omega_rad_s * (1.0 - mode.damping_ratio.powi(2)).sqrt();
        let (sin, cos) = (omega_d * time_s).sin_cos();
        let shrunk = (-decay * time_s).exp();
        let along = (*rate + decay * *a) / omega_d;
        (*a, *rate) =
            (shrunk * (*a * cos + along * sin), shrunk * (*rate * cos - (decay * along + omega_d * *a) * sin));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_free_mode_satisfies_its_equation() {
        let mode = [Mode { omega_rad_s: 30.0, damping_ratio: 0.1, shape: 1.0 }];
        let at = |t| {
            let mut state = Start { amplitude: vec![0.3], rate: vec![-2.0], gap_m: 0.0 };
            ring(&mode, &mut state, t);
            (state.amplitude[0], state.rate[0])
        };
        let (t, h) = (0.07, 1e-5);
        let ((a, rate), before, after) = (at(t), at(t - h), at(t + h));
        assert!(((after.0 - before.0) / (2.0 * h) - rate).abs() < 1e-6);
        let acceleration = (after.1 - before.1) / (2.0 * h);
        assert!((acceleration + 2.0 * 0.1 * 30.0 * rate + 900.0 * a).abs() < 1e-4, "{acceleration}");
        assert_eq!(at(0.0), (0.3, -2.0));
    }
}
