"""Exudyn: all bodies as one system of second order with unit mass matrix, whose contacts are a user function in Python.

Two of its integrators: the implicit generalised alpha with fixed steps, whose setting is their number, and the explicit
Dormand-Prince pair of order 5 with steps of its own choice, whose setting is the tolerance. Neither knows of contacts.
"""

import exudyn
import numpy
from exudyn.itemInterface import NodeGenericODE2, ObjectGenericODE2

from template import bench

COUNTS = [1e3, 3e3, 1e4]
TOLERANCES = [1e-3, 1e-5, 1e-7, 1e-9]


def force_of(law):
    """Force of a compression and its rate; none for a law with a history."""
    kind = law["kind"]
    if kind in ("hertz", "viscous"):
        k, d = law["stiffness_n_m1_5"], law.get("damping_s_m", 0.0)
        return lambda xi, rate: max(k * xi**1.5 * (1 + d * rate), 0.0) if xi > 0 else 0.0
    if kind in ("linear-spring", "kelvin-voigt"):
        k, c = law["stiffness_n_m"], law.get("damping_n_s_m", 0.0)
        return lambda xi, rate: max(k * xi + c * rate, 0.0) if xi > 0 else 0.0
    if kind == "hunt-crossley":
        k, n, d = law["stiffness_n_m_n"], law["exponent"], law["damping_s_m"]
        return lambda xi, rate: max(k * xi**n * (1 + d * rate), 0.0) if xi > 0 else 0.0
    return None


def posed(problem):
    """The matrices, the start, the constant forces and the contacts; none if a law is not to be had."""
    bodies = problem["bodies"]
    laws = [force_of(contact["law"]) for contact in problem["contacts"]]
    if not bodies or any(law is None for law in laws):
        return None
    places, count = {}, 0
    for body in bodies:
        places[body["name"]] = slice(count, count + len(body["shape"]))
        count += len(body["shape"])
    together = lambda field: numpy.array([value for body in bodies for value in body[field]])
    omega, ratio = together("omega_rad_s"), together("damping_ratio")
    constant = numpy.zeros(count)
    shapes = {}
    for body in bodies:
        shapes[body["name"]] = numpy.zeros(count)
        shapes[body["name"]][places[body["name"]]] = body["shape"]
        if body["omega_rad_s"] == [0.0]:
            constant[places[body["name"]]] = -problem["gravity_m_s2"] / body["shape"][0]
    contacts = []
    for contact, law in zip(problem["contacts"], laws):
        psi = -shapes[contact["upper"]]
        if "lower" in contact:
            psi = psi + shapes[contact["lower"]]
        contacts.append((psi, contact["gap_m"], law))
    return omega, ratio, together("amplitude"), together("rate"), constant, shapes, contacts


def solve(explicit):
    def at(problem, setting):
        case = posed(problem)
        if case is None:
            return None
        omega, ratio, amplitude, rate, constant, shapes, contacts = case

        def force(mbs, t, number, q, q_t):
            q, q_t = numpy.atleast_1d(q), numpy.atleast_1d(q_t)
            total = constant.copy()
            for psi, gap, law in contacts:
                pressed = law(psi @ q - gap, psi @ q_t)
                if pressed:
                    total -= psi * pressed
            return total

        system = exudyn.SystemContainer()
        world = system.AddSystem()
        count = len(omega)
        node = world.AddNode(
            NodeGenericODE2(
                referenceCoordinates=[0.0] * count,
                initialCoordinates=list(amplitude),
                initialCoordinates_t=list(rate),
                numberOfODE2Coordinates=count,
            )
        )
        world.AddObject(
            ObjectGenericODE2(
                nodeNumbers=[node],
                massMatrix=numpy.eye(count),
                stiffnessMatrix=numpy.diag(omega**2),
                dampingMatrix=numpy.diag(2 * ratio * omega),
                forceUserFunction=force,
            )
        )
        world.Assemble()
        settings = exudyn.SimulationSettings()
        integration = settings.timeIntegration
        integration.endTime = problem["end_s"]
        integration.verboseMode = 0
        settings.solution.file.write = False
        if explicit:
            integration.numberOfSteps = 10
            integration.automaticStepSize = True
            integration.minimumStepSize = 1e-14
            integration.relativeTolerance = setting
            integration.absoluteTolerance = setting * max(abs(rate).max(), 1e-3) * min(1e-4, problem["end_s"])
            world.SolveDynamic(settings, solverType=exudyn.DynamicSolverType.DOPRI5)
        else:
            integration.numberOfSteps = int(setting)
            integration.generalizedAlpha.spectralRadius = 0.9
            world.SolveDynamic(settings)
        q = numpy.atleast_1d(world.GetNodeOutput(node, exudyn.OutputVariableType.Coordinates))
        q_t = numpy.atleast_1d(world.GetNodeOutput(node, exudyn.OutputVariableType.Coordinates_t))
        values = [
            shapes[quantity["body"]] @ (q if quantity["what"] == "displacement_m" else q_t)
            for quantity in problem["quantities"]
        ]
        if not numpy.all(numpy.isfinite(values)):
            raise ArithmeticError("not a number")
        return values

    return at


VERSIONS = f"exudyn {exudyn.__version__}"
bench("exudyn", "Exudyn, generalised alpha", COUNTS, solve(explicit=False), VERSIONS)
bench("exudyn", "Exudyn, DOPRI5", TOLERANCES, solve(explicit=True), VERSIONS)
