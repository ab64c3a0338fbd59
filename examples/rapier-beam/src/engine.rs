//! The side of the game: a rapier world with a ball above a bar, and a hook that sets the restitution of each contact.

use crate::beam::{Ball, GRAVITY_M_S2, LENGTH_M, THICKNESS_M};
use rapier2d::prelude::*;

/// The engine's time step (s).
pub const STEP_S: f64 = 1.0 / 2000.0;
/// Longer than any sequence of bounces here.
const MOST_STEPS: u32 = 20_000;

// ANCHOR: hook
/// Evaluates the restitution at the location of each contact.
struct ByPlace<F>(F);

impl<F: Fn(f64) -> f64 + Sync> PhysicsHooks for ByPlace<F> {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let Some(contact) = context.rigid_mut() else { return };
        // Inside the hook the anchors are points of the world.
        if let Some(first) = contact.solver_contacts.first() {
            let x_m = f64::from(first.anchor1.x);
            *contact.restitution = (self.0)(x_m) as f32;
        }
    }
}
// ANCHOR_END: hook

/// One bounce in the engine.
pub struct Bounce {
    /// Speed in the last step before (m/s).
    pub speed_before_m_s: f64,
    /// Speed in the first step after (m/s).
    pub speed_after_m_s: f64,
    /// Highest point after it, of the ball's lowest point above the bar (m).
    pub height_m: f64,
}

impl Bounce {
    pub fn restitution(&self) -> f64 {
        self.speed_after_m_s / self.speed_before_m_s
    }
}

/// Drops a ball on the bar and returns its first bounces.
pub fn bounces(
    ball: Ball,
    x_m: f64,
    height_m: f64,
    count: usize,
    restitution: impl Fn(f64) -> f64 + Sync,
) -> Vec<Bounce> {
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::new(0.0, -GRAVITY_M_S2 as f32);
    world.integration_parameters.dt = STEP_S as f32;
    // A typical length of this scene, by which the engine scales its tolerances.
    world.integration_parameters.length_unit = ball.radius_m as f32;
    let (half_length, half_thickness) = (0.5 * LENGTH_M as f32, 0.5 * THICKNESS_M as f32);
    world.insert(
        RigidBodyBuilder::fixed().translation(Vector::new(half_length, -half_thickness)),
        ColliderBuilder::cuboid(half_length, half_thickness).friction(0.0),
    );
    let radius = ball.radius_m as f32;
    let (handle, _) = world.insert(
        RigidBodyBuilder::dynamic()
            .translation(Vector::new(x_m as f32, radius + height_m as f32))
            .lock_rotations()
            .can_sleep(false)
            .ccd_enabled(true),
        ColliderBuilder::ball(radius).friction(0.0).active_hooks(ActiveHooks::MODIFY_SOLVER_CONTACTS),
    );
    let hook = ByPlace(restitution);
    let mut bounces: Vec<Bounce> = Vec::new();
    let mut before = 0.0_f64;
    for _ in 0..MOST_STEPS {
        world.step_with_events(&hook, &());
        let body = &world.bodies[handle];
        let (speed, height) = (f64::from(body.linvel().y), f64::from(body.translation().y) - ball.radius_m);
        if before < 0.0 && speed >= 0.0 {
            if bounces.len() == count {
                break;
            }
            bounces.push(Bounce { speed_before_m_s: -before, speed_after_m_s: speed, height_m: height });
        } else if let Some(last) = bounces.last_mut() {
            last.height_m = last.height_m.max(height);
        }
        before = speed;
    }
    bounces
}
