//! rapier on the problems of impactbench: a restitution asked for, and rows of balls that it takes as elastic. The setting is
//! the time step. Writes the table to standard output.

use rapier2d_f64::prelude::*;
use serde_json::Value;
use std::path::Path;
use std::time::Instant;

const RADIUS_M: f64 = 0.015;
const STEPS_S: [f64; 4] = [1.0 / 60.0, 1e-3, 1e-4, 1e-5];
/// Steps of the longest run: the balls have met and parted long before.
const MOST_STEPS: usize = 200;
const REPEATS: usize = 20;

/// Balls with mass and velocity (kg, m/s, upwards), one above the other, the lowest first; whether they stand over a
/// ground; and the restitution.
struct Row {
    balls: Vec<(f64, f64)>,
    over_ground: bool,
    restitution: f64,
}

/// What of a problem rapier can take; none is a dash.
fn row(problem: &Value) -> Option<Row> {
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
    // the first is the uppermost
    balls.reverse();
    let law = &contacts.first()?["law"];
    match (law["kind"].as_str()?, problem["family"].as_str()?) {
        ("restitution", _) => Some(Row { balls, over_ground: true, restitution: law["restitution"].as_f64()? }),
        ("hertz", "several") if problem["gravity_m_s2"] == 0.0 => {
            Some(Row { balls, over_ground: false, restitution: 1.0 })
        }
        _ => None,
    }
}

/// Velocities in the end, the lowest first.
fn solve(row: &Row, step_s: f64) -> Vec<f64> {
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::new(0.0, 0.0);
    world.integration_parameters.dt = step_s;
    if row.over_ground {
        world.insert(
            RigidBodyBuilder::fixed().translation(Vector::new(0.0, -1.0)),
            ColliderBuilder::cuboid(1.0, 1.0).friction(0.0).restitution(row.restitution),
        );
    }
    let fastest = row.balls.iter().map(|ball| ball.1.abs()).fold(0.0, f64::max);
    let last = row.balls.len() - 1;
    let insert = |(i, &(mass_kg, velocity_m_s)): (usize, &(f64, f64))| {
        // the moving ball starts a step and a half before it touches
        let before = if i == last { 1.5 * fastest * step_s } else { 0.0 };
        let height = RADIUS_M * (1.0 + 2.0 * i as f64) + before;
        let (handle, _) = world.insert(
            RigidBodyBuilder::dynamic()
                .translation(Vector::new(0.0, height))
                .linvel(Vector::new(0.0, velocity_m_s))
                .lock_rotations()
                .can_sleep(false)
                .ccd_enabled(true),
            ColliderBuilder::ball(RADIUS_M).mass(mass_kg).friction(0.0).restitution(row.restitution),
        );
        handle
    };
    let handles: Vec<_> = row.balls.iter().enumerate().map(insert).collect();
    for _ in 0..MOST_STEPS {
        world.step();
    }
    handles.iter().map(|handle| world.bodies[*handle].linvel().y).collect()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../problems");
    let mut paths: Vec<_> = std::fs::read_dir(folder)?.map(|entry| entry.map(|e| e.path())).collect::<Result<_, _>>()?;
    paths.sort();
    println!("problem,code,setting,time_s,status,values");
    for path in paths {
        let problem: Value = serde_json::from_str(&std::fs::read_to_string(path)?)?;
        let Some(row) = row(&problem) else { continue };
        for step_s in STEPS_S {
            let (mut velocities, mut least) = (Vec::new(), f64::INFINITY);
            for _ in 0..REPEATS {
                let start = Instant::now();
                velocities = solve(&row, step_s);
                least = least.min(start.elapsed().as_secs_f64());
            }
            // the first body of a problem is the uppermost
            let values: Vec<String> = velocities.iter().rev().map(|velocity| format!("{velocity:e}")).collect();
            let name = problem["name"].as_str().unwrap_or_default();
            println!("{name},rapier,{step_s:e},{least:e},ok,{}", values.join(" "));
        }
    }
    Ok(())
}
