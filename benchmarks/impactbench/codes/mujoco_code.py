"""MuJoCo: contacts and joint limits are springs with dashpots per unit of mass, as stated by solref.

A restitution is asked for in two ways: by the exact relation of a dashpot that does not pull, which `vibroimpact law` prints,
and by the field's formula. The setting is the time step over the duration of the contact.
"""

import math

import mujoco

from template import bench, damping_ratio, only_ball, oscillator

SHARES = [0.1, 0.03, 0.01, 0.003, 0.001]


def drop(stiffness, damping, speed, step):
    """Velocity of a ball after its contact, with stiffness and damping per unit of mass."""
    solref = f'condim="1" solref="{-stiffness!r} {-damping!r}" solimp="0.95 0.95 0.001"'
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="{step!r}" gravity="0 0 0"/><worldbody>
        <geom type="plane" size="9 9 .1" {solref}/>
        <body pos="0 0 0.05"><joint type="slide" axis="0 0 1"/><geom type="sphere" size="0.05" {solref}/></body>
        </worldbody></mujoco>"""
    )
    data = mujoco.MjData(model)
    data.qvel[0] = -speed
    lasts = 3 * math.pi / math.sqrt(stiffness)
    for _ in range(math.ceil(lasts / step) + 5):
        mujoco.mj_step(model, data)
        if data.qpos[0] > 0 and data.qvel[0] > 0:
            break
    return [float(data.qvel[0])]


def swing(case, end, step):
    """Velocity of a mass on a spring at the end, a joint limit being the stop."""
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="{step!r}" gravity="0 0 0" integrator="implicitfast"/><compiler autolimits="true"/>
        <worldbody><body><joint type="slide" axis="0 0 1" stiffness="{case['stiffness_n_m']!r}"
        range="{-case['gap_m'] if case['gap_m'] > 0 else -1e-15!r} 1e3"
        solreflimit="{-case['stop_n_m'] / case['mass_kg']!r} 0" solimplimit="0.95 0.95 0.001"/>
        <geom type="sphere" size="0.05" mass="{case['mass_kg']!r}"/></body></worldbody></mujoco>"""
    )
    data = mujoco.MjData(model)
    data.qvel[0] = -case["speed_m_s"]
    for _ in range(round(end / step)):
        mujoco.mj_step(model, data)
    return [float(data.qvel[0])]


def solve(ratio):
    def at(problem, share):
        case = oscillator(problem)
        if case is not None:
            if ratio is not damping_ratio:
                return None
            fastest = math.sqrt((case["stop_n_m"] + case["stiffness_n_m"]) / case["mass_kg"])
            step = share * math.pi / fastest
            return swing(case, problem["end_s"], problem["end_s"] / math.ceil(problem["end_s"] / step))
        ball = only_ball(problem)
        if ball is None:
            return None
        law, mass = ball["law"], ball["mass_kg"]
        if law["kind"] == "restitution":
            # A contact of a tenth of a second; without restitution it is heavily damped.
            omega = 10 * math.pi
            zeta = ratio(max(law["restitution"], 1e-3)) if law["restitution"] < 1 else 0.0
            return drop(omega**2, 2 * zeta * omega, ball["speed_m_s"], share * 0.1)
        if ratio is damping_ratio and law["kind"] in ("linear-spring", "kelvin-voigt"):
            stiffness = law["stiffness_n_m"] / mass
            damping = law.get("damping_n_s_m", 0.0) / mass
            return drop(stiffness, damping, ball["speed_m_s"], share * math.pi / math.sqrt(stiffness))
        return None

    return at


def of_the_field(restitution):
    decrement = -math.log(restitution)
    return decrement / math.hypot(math.pi, decrement)


VERSIONS = f"mujoco {mujoco.__version__}"
bench("mujoco", "MuJoCo, solref exact", SHARES, solve(damping_ratio), VERSIONS)
bench("mujoco", "MuJoCo, solref by the formula", SHARES, solve(of_the_field), VERSIONS)
