//! rapier on the problems of impactbench.

#[path = "../../rows.rs"]
mod rows;

use rapier2d_f64::prelude::*;
use rows::{MOST_STEPS, RADIUS_M, Row};

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
    let mut handles = Vec::new();
    for ball in row.balls(step_s) {
        let (handle, _) = world.insert(
            RigidBodyBuilder::dynamic()
                .translation(Vector::new(0.0, ball.height_m))
                .linvel(Vector::new(0.0, ball.velocity_m_s))
                .lock_rotations()
                .can_sleep(false)
                .ccd_enabled(true),
            ColliderBuilder::ball(RADIUS_M).mass(ball.mass_kg).friction(0.0).restitution(row.restitution),
        );
        handles.push(handle);
    }
    for _ in 0..MOST_STEPS {
        world.step();
    }
    handles.iter().map(|handle| world.bodies[*handle].linvel().y).collect()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    rows::run("rapier", solve)
}
