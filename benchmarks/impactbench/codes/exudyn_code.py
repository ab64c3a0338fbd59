"""Exudyn: mass points, springs and the law of the contact as a user function in Python, implicit generalised alpha with steps
that do not know of the contact. The setting is the number of steps over the time of the problem.
"""

import math

import exudyn
from exudyn.itemInterface import (CoordinateSpringDamper, LoadCoordinate, MarkerNodeCoordinate, Mass1D, Node1D,
                                  NodePointGround)

from template import bench

COUNTS = [1e3, 3e3, 1e4]


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


def solve(problem, count):
    """Every body with one mode: the coordinate is that of its point, and its mass is shape^-2."""
    bodies, contacts = problem["bodies"], problem["contacts"]
    if not bodies or any(len(body["shape"]) != 1 for body in bodies):
        return None
    laws = [force_of(contact["law"]) for contact in contacts]
    if any(law is None for law in laws):
        return None
    system = exudyn.SystemContainer()
    world = system.AddSystem()
    ground = world.AddMarker(MarkerNodeCoordinate(nodeNumber=world.AddNode(NodePointGround()), coordinate=0))
    nodes, markers = {}, {}
    for body in bodies:
        shape = body["shape"][0]
        mass = shape**-2
        node = world.AddNode(Node1D(referenceCoordinates=[0.0], initialCoordinates=[shape * body["amplitude"][0]],
                                    initialVelocities=[shape * body["rate"][0]]))
        world.AddObject(Mass1D(nodeNumber=node, mass=mass))
        nodes[body["name"]] = node
        markers[body["name"]] = world.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
        omega, ratio = body["omega_rad_s"][0], body["damping_ratio"][0]
        if omega > 0:
            world.AddObject(CoordinateSpringDamper(markerNumbers=[ground, markers[body["name"]]],
                                                   stiffness=omega**2 * mass, damping=2 * ratio * omega * mass))
        elif problem["gravity_m_s2"] != 0:
            world.AddLoad(LoadCoordinate(markerNumber=markers[body["name"]], load=-mass * problem["gravity_m_s2"]))
    for contact, law in zip(contacts, laws):
        gap = contact["gap_m"]
        lower = markers[contact["lower"]] if "lower" in contact else ground

        def spring(mbs, t, number, u, v, k, d, offset, law=law, gap=gap):
            # u is the distance of the upper point above the lower one
            return -law(-u - gap, -v)

        world.AddObject(CoordinateSpringDamper(markerNumbers=[lower, markers[contact["upper"]]], stiffness=0.0,
                                               springForceUserFunction=spring))
    world.Assemble()
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = int(count)
    settings.timeIntegration.endTime = problem["end_s"]
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.9
    settings.timeIntegration.newton.useModifiedNewton = False
    world.SolveDynamic(settings)
    variables = exudyn.OutputVariableType
    values = []
    for quantity in problem["quantities"]:
        of = variables.CoordinatesTotal if quantity["what"] == "displacement_m" else variables.Coordinates_t
        found = world.GetNodeOutput(nodes[quantity["body"]], of)
        values.append(float(found if not hasattr(found, "__len__") else found[0]))
    if any(math.isnan(value) for value in values):
        raise ArithmeticError("not a number")
    return values


bench("exudyn", "Exudyn, generalised alpha", COUNTS, solve, f"exudyn {exudyn.__version__}")
