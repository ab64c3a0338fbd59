"""PyBullet: rigid bodies with a restitution. The setting is the time step. The ball starts in contact, as in
the problem: from a distance, the rebound depends by up to 0.5 on the remaining distance in the step of the contact."""

import pybullet

from template import bench, only_ball

STEPS = [1 / 60, 1 / 240, 1e-3, 1e-4]
CLIENT = pybullet.connect(pybullet.DIRECT)


def solve(problem, step):
    ball = only_ball(problem)
    if ball is None or ball["law"]["kind"] != "restitution":
        return None
    pybullet.resetSimulation()
    # By default bodies bounce only above 0.2 m/s.
    pybullet.setPhysicsEngineParameter(fixedTimeStep=step, restitutionVelocityThreshold=0.0)
    ground = pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
    shape = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=0.015)
    body = pybullet.createMultiBody(ball["mass_kg"], shape, basePosition=[0, 0, 0.015])
    for each in (ground, body):
        pybullet.changeDynamics(each, -1, restitution=1.0 if each == ground else ball["law"]["restitution"],
                                linearDamping=0, angularDamping=0, lateralFriction=0,
                                activationState=pybullet.ACTIVATION_STATE_DISABLE_SLEEPING)
    # Without it a fast ball passes through the ground within a step.
    pybullet.changeDynamics(body, -1, ccdSweptSphereRadius=0.01)
    pybullet.resetBaseVelocity(body, [0, 0, -ball["speed_m_s"]])
    for _ in range(40):
        pybullet.stepSimulation()
    return [pybullet.getBaseVelocity(body)[0][2]]


bench("pybullet", "PyBullet", STEPS, solve, f"pybullet API {pybullet.getAPIVersion()}")
