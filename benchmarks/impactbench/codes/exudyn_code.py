"""Exudyn: all bodies as one system of second order with unit mass matrix, whose contacts are a user function in Python.

Two of its integrators: the implicit generalised alpha with fixed steps, whose setting is their number, and the explicit
Dormand-Prince pair of order 5 with adaptive steps, whose setting is the tolerance. Neither detects contacts.
"""

import exudyn
import numpy
from exudyn.itemInterface import NodeGenericODE2, ObjectGenericODE2

from template import System, bench

COUNTS = [1e3, 3e3, 1e4]
TOLERANCES = [1e-3, 1e-5, 1e-7, 1e-9]


def solve(explicit):
    def at(problem, setting):
        system = System(problem)
        laws = system.powers()
        if laws is None:
            return None

        def force(mbs, t, number, q, q_t):
            q, q_t = numpy.atleast_1d(q), numpy.atleast_1d(q_t)
            total = system.force(t)
            for (psi, gap, _), (k, n, d, c) in zip(system.contacts, laws):
                xi, rate = psi @ q - gap, psi @ q_t
                if xi > 0:
                    total -= psi * max(k * xi**n * (1 + d * rate) + c * rate, 0.0)
            return total

        container = exudyn.SystemContainer()
        world = container.AddSystem()
        count = len(system.omega)
        node = world.AddNode(
            NodeGenericODE2(
                referenceCoordinates=[0.0] * count,
                initialCoordinates=list(system.amplitude),
                initialCoordinates_t=list(system.rate),
                numberOfODE2Coordinates=count,
            )
        )
        world.AddObject(
            ObjectGenericODE2(
                nodeNumbers=[node],
                massMatrix=numpy.eye(count),
                stiffnessMatrix=numpy.diag(system.omega**2),
                dampingMatrix=numpy.diag(2 * system.ratio * system.omega),
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
            integration.absoluteTolerance = setting * max(abs(system.rate).max(), 1e-3) * min(1e-4, problem["end_s"])
            world.SolveDynamic(settings, solverType=exudyn.DynamicSolverType.DOPRI5)
        else:
            integration.numberOfSteps = int(setting)
            integration.generalizedAlpha.spectralRadius = 0.9
            world.SolveDynamic(settings)
        q = numpy.atleast_1d(world.GetNodeOutput(node, exudyn.OutputVariableType.Coordinates))
        q_t = numpy.atleast_1d(world.GetNodeOutput(node, exudyn.OutputVariableType.Coordinates_t))
        return system.answers(q, q_t)

    return at


VERSIONS = f"exudyn {exudyn.__version__}"
bench("exudyn", "Exudyn, generalised alpha", COUNTS, solve(explicit=False), VERSIONS)
bench("exudyn", "Exudyn, DOPRI5", TOLERANCES, solve(explicit=True), VERSIONS)
