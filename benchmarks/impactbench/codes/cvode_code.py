"""CVODE of SUNDIALS with its root finding, by the program built from cvode/solve.c. The setting is the tolerance."""

import os
import pathlib
import signal
import subprocess
import tempfile

import numpy

from template import BUDGET_S, System, bench

PROGRAM = os.environ["CVODE"]
TOLERANCES = [1e-4, 1e-6, 1e-8, 1e-10, 1e-12]


def solve(formula):
    def at(problem, tolerance):
        system = System(problem)
        text = system.text()
        if text is None:
            return None
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "problem.txt"
            file.write_text(text)
            words = [PROGRAM, file, formula, repr(tolerance), repr(system.scale()), str(BUDGET_S)]
            done = subprocess.run(words, capture_output=True, text=True)
        if done.returncode == -signal.SIGKILL:
            raise TimeoutError("too slow")
        if done.returncode:
            raise ArithmeticError((done.stderr.split("\n")[0] or "no answer").replace(",", ";"))
        seconds, *state = map(float, done.stdout.split())
        q, rate = numpy.split(numpy.array(state), 2)
        return system.answers(q, rate), seconds

    return at


if __name__ == "__main__":
    VERSIONS = f"SUNDIALS {os.environ['CVODE_VERSION']}"
    bench("cvode", "CVODE, Adams", TOLERANCES, solve("adams"), VERSIONS)
    bench("cvode", "CVODE, BDF", TOLERANCES, solve("bdf"), VERSIONS)
