"""Siconos by its time stepping. A restitution is an impact law of Newton on a rigid body (Moreau and Jean's scheme). An elastic
stop is linear complementarity between a compliant gap and its force, 0 <= gap + force/stiffness, 0 <= force, of a first-order
system by the midpoint rule (Euler and Moreau's scheme at one half). Curved and damped laws are beyond it. The setting is the
number of steps."""

import numpy
import siconos.kernel as siconos

from template import System, bench, only_ball

COUNTS = [100, 1000, 10000, 100000]


def bounce(problem, count):
    """A ball with a restitution, or elastic balls in a row: rigid impacts."""
    rigid = problem["family"] == "several" and problem["gravity_m_s2"] == 0 and "loads" not in problem
    ball = only_ball(problem)
    if ball is not None and ball["law"]["kind"] == "restitution":
        restitution = ball["law"]["restitution"]
    elif rigid and all(contact["law"]["kind"] == "hertz" for contact in problem["contacts"]):
        restitution = 1.0
    else:
        return None
    system = System(problem)
    model = siconos.NonSmoothDynamicalSystem(0, 2 * system.end)
    balls = []
    for amplitude, rate in zip(system.amplitude, system.rate):
        # In modal coordinates every mass is one.
        balls.append(siconos.LagrangianLinearTIDS([float(amplitude)], [float(rate)], numpy.eye(1)))
        model.insertDynamicalSystem(balls[-1])
    for psi, gap, _ in system.contacts:
        seen = numpy.flatnonzero(psi)
        relation = siconos.LagrangianLinearTIR(-psi[seen].reshape(1, -1), [float(gap)])
        contact = siconos.Interaction(siconos.NewtonImpactNSL(restitution), relation)
        model.link(contact, *(balls[k] for k in seen))
    step(model, siconos.MoreauJeanOSI(0.5), system.end, count)
    return system.answers(*(numpy.array([float(of(ball)[0]) for ball in balls]) for of in (lambda b: b.q(), lambda b: b.velocity())))


def press(problem, count):
    """Elastic stops."""
    system = System(problem)
    laws = system.powers()
    if laws is None or any(n != 1.0 or d or c for _, n, d, c in laws):
        return None
    n, m, swings = len(system.omega), len(laws), len(system.harmonics)
    size = 2 * n + 2 * swings
    a, b, start = numpy.zeros((size, size)), numpy.zeros(size), numpy.zeros(size)
    a[:n, n : 2 * n] = numpy.eye(n)
    a[n : 2 * n, :n] = -numpy.diag(system.omega**2)
    a[n : 2 * n, n : 2 * n] = -numpy.diag(2 * system.ratio * system.omega)
    b[n : 2 * n] = system.constant
    start[: 2 * n] = numpy.concatenate([system.amplitude, system.rate])
    for h, (omega, phase, row) in enumerate(system.harmonics):
        # A harmonic load is an additional oscillator.
        sine, cosine = 2 * n + 2 * h, 2 * n + 2 * h + 1
        a[sine, cosine], a[cosine, sine] = omega, -omega
        start[sine], start[cosine] = numpy.sin(phase), numpy.cos(phase)
        a[n : 2 * n, sine] = row
    push, see, give, gaps = numpy.zeros((size, m)), numpy.zeros((m, size)), numpy.zeros((m, m)), numpy.zeros(m)
    for i, ((psi, gap, _), law) in enumerate(zip(system.contacts, laws)):
        push[n : 2 * n, i], see[i, :n], gaps[i], give[i, i] = -psi, -psi, gap, 1 / law[0]
    body = siconos.FirstOrderLinearTIDS(start, a, b)
    relation = siconos.FirstOrderLinearTIR(see, push)
    relation.setDPtr(give)
    relation.setePtr(gaps)
    model = siconos.NonSmoothDynamicalSystem(0, 2 * system.end)
    model.insertDynamicalSystem(body)
    model.link(siconos.Interaction(siconos.ComplementarityConditionNSL(m), relation), body)
    step(model, siconos.EulerMoreauOSI(0.5, 0.5), system.end, count)
    state = numpy.array(body.x())
    return system.answers(state[:n], state[n : 2 * n])


def step(model, scheme, end, count):
    simulation = siconos.TimeStepping(model, siconos.TimeDiscretisation(0, end / count), scheme, siconos.LCP())
    for _ in range(count):
        simulation.computeOneStep()
        simulation.nextStep()


if __name__ == "__main__":
    bench("siconos", "Siconos, impact law", COUNTS[:3], bounce, "siconos 4.4.0 (Debian)")
    bench("siconos", "Siconos, complementarity", COUNTS, press, "siconos 4.4.0 (Debian)")
