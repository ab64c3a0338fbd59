//! A bar that still vibrates when the ball returns: the law with the bar at rest, and with the bar's motion carried from bounce
//! to bounce.

use crate::beam::{Ball, Bar, Bounce, LAW_MODES, LENGTH_M, Law, ring};
use crate::drops::{BALLS, COMPARED, DROP_M, fitted};
use emoc::{Coefficients, Impact, MovingImpact, Site};
use std::error::Error;
use std::f64::consts::PI;
use std::fmt::Write as _;
use vibroimpact_sim::modal::{Mode, Start};

/// Damping ratios of the bar: one with which it hardly vibrates any more when the ball returns, and that of bare steel.
const DAMPINGS: [f64; 2] = [0.01, 0.001];
/// Number of bounces. Each amplifies errors, so that a fourth one depends on the last digits of the solver.
const BOUNCES: usize = 3;
/// Ways to predict a bounce.
const WAYS: [&str; 5] =
    ["constant", "EMOC, bar at rest", "EMOC, its own motion", "EMOC, half sine", "EMOC, true motion"];

// ANCHOR: carried
/// The data of the bar that the game keeps between bounces, for one location.
struct Carried<'a> {
    modes: &'a [Mode],
    motion: Start,
}

impl Carried<'_> {
    fn at_rest(modes: &[Mode]) -> Carried<'_> {
        Carried { modes, motion: Start::at_rest(modes.len()) }
    }

    /// Free vibration of the bar: the exact motion of each mode.
    fn ring(&mut self, time_s: f64) {
        ring(self.modes, &mut self.motion, time_s);
    }

    /// Returns the ball's velocity after it has met the bar at this speed, and excites the bar: by the speeds of least energy
    /// in the law, or, with a duration of the contact, by the law's impulse as a half sine.
    fn strike(&mut self, impact: &MovingImpact, half_sine_s: Option<f64>) -> Result<f64, emoc::InvalidInput> {
        let found = MovingImpact { rates: &self.motion.rate, ..*impact }.rebound()?;
        let share = |omega_rad_s: f64, duration_s: f64| {
            let q = omega_rad_s * duration_s / PI;
            // Its limit where the cosine and the difference vanish.
            if (q - 1.0).abs() < 1e-6 { PI / 4.0 } else { (0.5 * PI * q).cos() / (1.0 - q * q) }
        };
        let struck = |(k, mode): (usize, &Mode)| match half_sine_s {
            None => MovingImpact { rates: &self.motion.rate, ..*impact }.modal_rate(&found, k),
            Some(duration_s) => {
                self.motion.rate[k] - mode.shape * found.impulse_n_s * share(mode.omega_rad_s, duration_s)
            }
        };
        self.motion.rate = self.modes.iter().enumerate().map(struck).collect();
        Ok(found.velocity_m_s)
    }
}
// ANCHOR_END: carried

/// Mean errors of the restitution, bounce by bounce.
pub fn table() -> Result<String, Box<dyn Error>> {
    let mut out = String::new();
    for damping in DAMPINGS {
        let bar = Bar::new(damping)?;
        let law = fitted(&bar)?;
        for ball in BALLS {
            let (name, percent) = (2e3 * ball.radius_m, 1e2 * damping);
            writeln!(out, "ball of {name:.0} mm, damping {percent} %: mean error of the restitution in bounce")?;
            let numbers: String = (1..=BOUNCES).map(|bounce| format!("{bounce:>7}")).collect();
            writeln!(out, "                      {numbers}")?;
            let errors = errors(&bar, &law, ball)?;
            for (way, name) in WAYS.iter().enumerate() {
                let means: String = errors.iter().map(|of_bounce| mean(of_bounce, way)).collect();
                writeln!(out, "{name:<22}{means}")?;
            }
            let counts: String = errors.iter().map(|of_bounce| format!("{:>7}", of_bounce.len())).collect();
            writeln!(out, "locations             {counts}\n")?;
        }
    }
    out.truncate(out.trim_end().len());
    Ok(out + "\n")
}

fn mean(errors: &[[f64; WAYS.len()]], way: usize) -> String {
    if errors.is_empty() {
        return format!("{:>7}", "-");
    }
    format!("{:7.3}", errors.iter().map(|of_location| of_location[way]).sum::<f64>() / errors.len() as f64)
}

/// Errors of each way in each bounce at the locations where there is one. The fall before a bounce is that of the resolved
/// motion.
fn errors(bar: &Bar, law: &Law, ball: Ball) -> Result<Vec<Vec<[f64; WAYS.len()]>>, Box<dyn Error>> {
    let locations = (1..=COMPARED).map(|i| 0.5 * LENGTH_M * i as f64 / COMPARED as f64);
    let resolved = locations
        .map(|x_m| Ok((x_m, bar.bounces(ball, x_m, DROP_M, BOUNCES)?)))
        .collect::<Result<Vec<_>, Box<dyn Error>>>()?;
    let constant = resolved.iter().map(|(_, bounces)| bounces[0].restitution).sum::<f64>() / COMPARED as f64;
    let mut errors = vec![Vec::new(); BOUNCES];
    for (x_m, bounces) in &resolved {
        let modes = &bar.structure(*x_m)?.modes[..LAW_MODES];
        let phi: Vec<f64> = modes.iter().map(|mode| mode.shape).collect();
        let coefficients = law.parameters.coefficients(&Impact::new(ball.mass_kg(), &Site::new(&phi)?)?)?;
        let foretold = foretold(ball, bounces, modes, &phi, coefficients)?;
        for ((of_bounce, bounce), foretold) in errors.iter_mut().zip(bounces).zip(foretold) {
            let [at_rest, own, half_sine, known] = foretold.map(|speed_m_s| speed_m_s / bounce.fallen_m_s);
            let ways = [constant, at_rest, own, half_sine, known];
            of_bounce.push(ways.map(|restitution| (restitution - bounce.restitution).abs()));
        }
    }
    Ok(errors)
}

/// Speeds after each bounce: with the bar at rest, with its motion carried in two ways, and with its true motion.
fn foretold(
    ball: Ball,
    bounces: &[Bounce],
    modes: &[Mode],
    phi: &[f64],
    coefficients: Coefficients,
) -> Result<Vec<[f64; 4]>, Box<dyn Error>> {
    let (mass_kg, stiffness) = (ball.mass_kg(), ball.on_flat()?.stiffness_n_m1_5);
    let (mut own, mut half_sine) = (Carried::at_rest(modes), Carried::at_rest(modes));
    let mut speeds = Vec::new();
    let mut lasted_s = 0.0;
    for bounce in bounces {
        own.ring(bounce.flight_s + lasted_s);
        half_sine.ring(bounce.flight_s + lasted_s);
        lasted_s = bounce.duration_s;
        let still = vec![0.0; phi.len()];
        let impact = MovingImpact { mass_kg, velocity_m_s: -bounce.fallen_m_s, coefficients, phi, rates: &still };
        // As long as Hertz contact with a wall lasts.
        let duration_s = 3.218 * (mass_kg.powi(2) / (stiffness.powi(2) * bounce.fallen_m_s)).powf(0.2);
        let known = MovingImpact { rates: &bounce.touch.rate[..LAW_MODES], ..impact }.rebound()?.velocity_m_s;
        let carried = [own.strike(&impact, None)?, half_sine.strike(&impact, Some(duration_s))?];
        speeds.push([impact.rebound()?.velocity_m_s, carried[0], carried[1], known].map(|speed| speed.max(0.0)));
    }
    Ok(speeds)
}
