//! The game's side: a world of rapier with a ball and a beam, and a hook that sets the restitution of each contact.

use crate::law::Beam;
use rapier2d::prelude::*;

/// Half the beam's thickness (m).
const HALF_THICKNESS_M: f64 = 0.0057;
/// The engine's time step (s).
const STEP_S: f32 = 1.0 / 2000.0;
/// Of a physics world by default (m/s^2).
const GRAVITY_M_S2: f32 = 9.81;
/// Steps after which the engine is done with a bounce.
const SETTLE: u32 = 4;
/// Longer than any fall here.
const MOST_STEPS: u32 = 10_000;

/// Asks for the restitution at the place of each contact.
struct ByPlace<F>(F);

impl<F: Fn(f64) -> f64 + Sync> PhysicsHooks for ByPlace<F> {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let Some(contact) = context.rigid_mut() else { return };
        // inside the hook the anchors are points of the world
        if let Some(place) = contact.solver_contacts.first().map(|first| first.anchor1.x) {
            *contact.restitution = (self.0)(f64::from(place)) as f32;
        }
    }
}

/// Drops the beam's ball at a place from a height, and gives the speed after the first bounce over that before.
pub fn drop(beam: &Beam, x_m: f64, height_m: f64, restitution: impl Fn(f64) -> f64 + Sync) -> f64 {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = STEP_S;
    // a length that is typical of this scene, by which the engine scales its tolerances
    world.integration_parameters.length_unit = 0.02;
    let half_length = 0.5 * beam.length_m as f32;
    world.insert(
        RigidBodyBuilder::fixed().translation(Vector::new(half_length, -HALF_THICKNESS_M as f32)),
        ColliderBuilder::cuboid(half_length, HALF_THICKNESS_M as f32).friction(0.0),
    );
    let (ball, _) = world.insert(
        RigidBodyBuilder::dynamic().translation(Vector::new(x_m as f32, (beam.ball_radius_m + height_m) as f32)).ccd_enabled(true),
        ColliderBuilder::ball(beam.ball_radius_m as f32)
            .mass(beam.ball_mass_kg as f32)
            .friction(0.0)
            .active_hooks(ActiveHooks::MODIFY_SOLVER_CONTACTS),
    );
    let hook = ByPlace(restitution);
    let (mut lowest, mut steps_since) = (0.0_f32, 0);
    for _ in 0..MOST_STEPS {
        world.step_with_events(&hook, &());
        let velocity = world.bodies[ball].linvel().y;
        if velocity < lowest {
            (lowest, steps_since) = (velocity, 0);
            continue;
        }
        steps_since += 1;
        if steps_since == SETTLE {
            // what gravity has taken since, given back
            let lost = if velocity > 0.0 { GRAVITY_M_S2 * STEP_S * SETTLE as f32 } else { 0.0 };
            return f64::from((velocity.max(0.0) + lost) / -lowest);
        }
    }
    f64::NAN
}
