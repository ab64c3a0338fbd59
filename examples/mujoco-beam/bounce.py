"""Steel balls dropped on a pinned steel bar in MuJoCo, with the restitution of the location in place of a constant.

    pip install mujoco numpy
    python bounce.py

MuJoCo has no restitution, but the stiffness and damping of a contact. Before a ball touches, the law EMOC (the C header of the
crate `emoc`, compiled here) gives the restitution at its location, with the vibration of the bar after earlier bounces. The damping
ratio for this restitution is written into the ball's `solref`, and MuJoCo simulates the contact. The program prints the
restitution of the law and that of MuJoCo, and fails if they differ.
"""

import ctypes
import math
import pathlib
import subprocess
import tempfile

import mujoco
import numpy

HERE = pathlib.Path(__file__).resolve().parent
# The bar and the law of examples/rapier-beam.
LENGTH_M, WIDTH_M, THICKNESS_M, MODULUS_PA, DENSITY_KG_M3 = 0.3, 0.02, 0.01, 2e11, 7800.0
DAMPING_RATIO, MODES, LAW = 0.001, 16, (0.159, 8.957, 1.506)
HEIGHT_M, GRAVITY_M_S2, BOUNCES = 0.5, 9.81, 3
# The contact in MuJoCo: the step, and a duration that many steps resolve.
STEP_S, CONTACT_S = 2e-5, 2e-3


def library():
    """emoc.c, compiled."""
    out = pathlib.Path(tempfile.mkdtemp()) / "emoc.so"
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", out, HERE / "emoc.c", "-lm"], check=True)
    found = ctypes.CDLL(str(out))
    found.emoc_strike.restype = ctypes.c_double
    return found


EMOC = library()


def array(values):
    return values.ctypes.data_as(ctypes.POINTER(ctypes.c_double))


def damping_ratio(restitution):
    """The damping ratio of a spring and dashpot that do not pull, from e = exp(-2 z acos(z)/sqrt(1 - z^2)), by bisection."""
    low, high = 0.0, 1.0 - 1e-12
    for _ in range(60):
        middle = 0.5 * (low + high)
        obtained = math.exp(-2 * middle * math.acos(middle) / math.sqrt(1 - middle * middle))
        low, high = (middle, high) if obtained > restitution else (low, middle)
    return low


class Bar:
    """The modes of the bar at a location, and their motion."""

    def __init__(self, x_m):
        number = numpy.arange(1, MODES + 1)
        mass = DENSITY_KG_M3 * WIDTH_M * THICKNESS_M
        rigidity = MODULUS_PA * WIDTH_M * THICKNESS_M**3 / 12
        self.omega = (number * math.pi / LENGTH_M) ** 2 * math.sqrt(rigidity / mass)
        self.phi = math.sqrt(2 / (mass * LENGTH_M)) * numpy.sin(number * math.pi * x_m / LENGTH_M)
        self.amplitudes, self.rates = numpy.zeros(MODES), numpy.zeros(MODES)

    def ring(self, time_s):
        EMOC.emoc_ring_all(array(self.omega), ctypes.c_double(DAMPING_RATIO), ctypes.c_double(time_s),
                           array(self.amplitudes), array(self.rates), ctypes.c_size_t(MODES))

    def strike(self, mass_kg, velocity_m_s, contact_s):
        law = numpy.array(LAW)
        return EMOC.emoc_strike(array(law), ctypes.c_double(mass_kg), ctypes.c_double(velocity_m_s), array(self.phi),
                                array(self.omega), array(self.rates), ctypes.c_size_t(MODES), ctypes.c_double(contact_s))


def hertz_s(radius_m, mass_kg, speed_m_s):
    """Duration of a Hertz contact of a steel ball on flat steel."""
    stiffness = 4 / 3 * math.sqrt(radius_m) * MODULUS_PA / (2 * (1 - 0.3**2))
    return 2.9432 * (1.25 * mass_kg / stiffness) ** 0.4 * speed_m_s**-0.2


def drop(radius_m, x_m):
    """Restitutions by the law and by MuJoCo, of successive bounces."""
    mass_kg = DENSITY_KG_M3 * 4 / 3 * math.pi * radius_m**3
    model = mujoco.MjModel.from_xml_string(f"""
        <mujoco><option timestep="{STEP_S}" gravity="0 0 {-GRAVITY_M_S2}"/><worldbody>
          <geom type="plane" size="1 1 .1" condim="1"/>
          <body pos="0 0 {radius_m + HEIGHT_M}"><joint type="slide" axis="0 0 1"/>
            <geom name="ball" type="sphere" size="{radius_m}" mass="{mass_kg}" condim="1" priority="1"
                  solimp="0.95 0.95 0.001"/></body>
        </worldbody></mujoco>""")
    data, ball, bar = mujoco.MjData(model), model.geom("ball").id, Bar(x_m)
    omega = math.pi / CONTACT_S
    found, flown_s = [], 0.0
    while len(found) < BOUNCES:
        gap, velocity = data.qpos[0] + HEIGHT_M, data.qvel[0]
        if velocity < 0 and gap + velocity * STEP_S <= 0:
            # ANCHOR: contact
            bar.ring(flown_s)
            asked = bar.strike(mass_kg, velocity, hertz_s(radius_m, mass_kg, -velocity))
            if asked <= 0:
                # the bar swings away: a plane that stands still cannot show this
                break
            # a contact without a source of energy has at most 1
            zeta = damping_ratio(min(max(asked, 1e-3), 1.0))
            model.geom_solref[ball] = (-(omega**2), -2 * zeta * omega)
            # ANCHOR_END: contact
            came, flown_s = -velocity, 0.0
            while data.qpos[0] + HEIGHT_M <= 0 or data.qvel[0] < 0:
                mujoco.mj_step(model, data)
            found.append((asked, data.qvel[0] / came))
        mujoco.mj_step(model, data)
        flown_s += STEP_S
    return found


print("restitution by the law, and as MuJoCo has it, of successive bounces from 500 mm")
furthest = 0.0
for radius_m in (0.008, 0.014, 0.02):
    for x_m in (0.0375, 0.075, 0.1125, 0.15):
        bounces = drop(radius_m, x_m)
        furthest = max(furthest, abs(bounces[0][0] - bounces[0][1]))
        cells = "   ".join(f"{asked:.3f} {had:.3f}" for asked, had in bounces)
        print(f"ball of {2e3 * radius_m:.0f} mm at {1e3 * x_m:5.1f} mm   {cells}")
print(f"first bounces: MuJoCo is within {furthest:.3f} of the law")
assert furthest < 0.01
