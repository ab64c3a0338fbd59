//! Common parts of the physics engines in Rust: the rows of balls that they can simulate, and the table. Either a restitution
//! is requested, or the balls of a row are taken as elastic. The setting is the time step.

use serde_json::Value;
use std::path::Path;
use std::time::Instant;

pub const RADIUS_M: f64 = 0.015;
/// Steps of the longest run; the balls have met and separated long before.
pub const MOST_STEPS: usize = 200;
const STEPS_S: [f64; 4] = [1.0 / 60.0, 1e-3, 1e-4, 1e-5];
const REPEATS: usize = 20;

/// Balls one above the other, and whether there is a ground below.
pub struct Row {
    /// Mass and velocity (kg, m/s, upwards), the lowest first.
    balls: Vec<(f64, f64)>,
    pub over_ground: bool,
    pub restitution: f64,
}

/// A ball at the start.
pub struct Ball {
    pub mass_kg: f64,
    pub velocity_m_s: f64,
    pub height_m: f64,
}

impl Row {
    /// The row of balls of a problem if an engine can simulate it; otherwise the table has a dash.
    fn of(problem: &Value) -> Option<Row> {
        if problem["gravity_m_s2"] != 0.0 || problem.get("loads").is_some() {
            return None;
        }
        let bodies = problem["bodies"].as_array()?;
        let contacts = problem["contacts"].as_array()?;
        let mut balls = Vec::new();
        for body in bodies {
            let one = |field: &str| body[field].as_array().filter(|list| list.len() == 1)?[0].as_f64();
            let (shape, rate) = (one("shape")?, one("rate")?);
            if one("omega_rad_s")? != 0.0 {
                return None;
            }
            balls.push((shape.powi(-2), shape * rate));
        }
        // The first is the uppermost.
        balls.reverse();
        let law = &contacts.first()?["law"];
        match (law["kind"].as_str()?, problem["family"].as_str()?) {
            ("restitution", _) => Some(Row { balls, over_ground: true, restitution: law["restitution"].as_f64()? }),
            ("hertz", "several") => Some(Row { balls, over_ground: false, restitution: 1.0 }),
            _ => None,
        }
    }

    /// The balls, the lowest first. The moving one starts a step and a half before it touches.
    pub fn balls(&self, step_s: f64) -> impl Iterator<Item = Ball> {
        let fastest = self.balls.iter().map(|ball| ball.1.abs()).fold(0.0, f64::max);
        self.balls.iter().enumerate().map(move |(i, &(mass_kg, velocity_m_s))| {
            let before = if i + 1 == self.balls.len() { 1.5 * fastest * step_s } else { 0.0 };
            Ball { mass_kg, velocity_m_s, height_m: RADIUS_M * (1.0 + 2.0 * i as f64) + before }
        })
    }
}

/// Runs every problem at every step, and writes the table to standard output. `solve` returns the final velocities, the lowest
/// ball first.
pub fn run(code: &str, solve: impl Fn(&Row, f64) -> Vec<f64>) -> Result<(), Box<dyn std::error::Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../problems");
    let mut paths: Vec<_> = std::fs::read_dir(folder)?.map(|entry| entry.map(|e| e.path())).collect::<Result<_, _>>()?;
    paths.sort();
    println!("problem,code,setting,time_s,status,values");
    for path in paths {
        let problem: Value = serde_json::from_str(&std::fs::read_to_string(path)?)?;
        let Some(row) = Row::of(&problem) else { continue };
        for step_s in STEPS_S {
            let (mut velocities, mut least) = (Vec::new(), f64::INFINITY);
            for _ in 0..REPEATS {
                let start = Instant::now();
                velocities = solve(&row, step_s);
                least = least.min(start.elapsed().as_secs_f64());
            }
            // The first body of a problem is the uppermost.
            let values: Vec<String> = velocities.iter().rev().map(|velocity| format!("{velocity:e}")).collect();
            let name = problem["name"].as_str().unwrap_or_default();
            println!("{name},{code},{step_s:e},{least:e},ok,{}", values.join(" "));
        }
    }
    Ok(())
}
