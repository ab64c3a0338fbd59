//! Avian on the problems of impactbench: with its default substeps, with swept collision so that no ball passes through
//! another, and without the speed below which bodies do not bounce (1 m/s by default).

#[path = "../../rows.rs"]
mod rows;

use avian2d::dynamics::solver::SolverConfig;
use avian2d::math::Vector;
use avian2d::prelude::*;
use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;
use rows::{MOST_STEPS, RADIUS_M, Row};
use std::time::Duration;

fn solve(row: &Row, step_s: f64) -> Vec<f64> {
    let step = Duration::from_secs_f64(step_s);
    let mut app = App::new();
    app.add_plugins((
        MinimalPlugins,
        TransformPlugin,
        PhysicsPlugins::default().with_length_unit(RADIUS_M),
    ))
    .insert_resource(TimeUpdateStrategy::ManualDuration(step))
    .insert_resource(Time::<Fixed>::from_duration(step))
    .insert_resource(Gravity(Vector::ZERO))
    .insert_resource(SolverConfig { restitution_threshold: 0.0, ..default() });
    app.finish();
    let surface = |restitution: f64| (Restitution::new(restitution), Friction::ZERO);
    if row.over_ground {
        let ground = (RigidBody::Static, Position(Vector::new(0.0, -1.0)), Collider::rectangle(2.0, 2.0));
        app.world_mut().spawn((ground, surface(row.restitution)));
    }
    let mut balls = Vec::new();
    for ball in row.balls(step_s) {
        let body = (
            RigidBody::Dynamic,
            Position(Vector::new(0.0, ball.height_m)),
            LinearVelocity(Vector::new(0.0, ball.velocity_m_s)),
            LockedAxes::ROTATION_LOCKED,
            SleepingDisabled,
            SweptCcd::default(),
            Collider::circle(RADIUS_M),
            Mass(ball.mass_kg as f32),
        );
        balls.push(app.world_mut().spawn((body, surface(row.restitution))).id());
    }
    for _ in 0..MOST_STEPS {
        app.update();
    }
    let velocity = |ball: &Entity| app.world().get::<LinearVelocity>(*ball).map_or(f64::NAN, |velocity| velocity.y);
    balls.iter().map(velocity).collect()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    rows::run("Avian", solve)
}
