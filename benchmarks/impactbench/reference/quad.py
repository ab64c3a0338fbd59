"""Writes quad.csv: the numbers asked for by quad.c, and how far they may be off, of the problems that it can take.

    reference/run.sh
"""

import csv
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction

# processor time of a problem (s)
LONGEST_S = 120
HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "codes"))
from template import System, problems  # noqa: E402


def cost(problem):
    """How long it takes, roughly: radians of the fastest mode, modes."""
    omega = [value for body in problem["bodies"] for value in body["omega_rad_s"]]
    return len(omega) * (100 + max(omega, default=0) * problem["end_s"])


def refer(problem):
    text = System(problem).text() if problem["bodies"] else None
    if text is None or problem["family"] == "restitution":
        return []
    system = System(problem)
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "problem.txt"
        file.write_text(text)
        limit = (LONGEST_S, LONGEST_S)
        done = subprocess.run([os.environ["QUAD"], file], capture_output=True, text=True,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, limit))
    if done.returncode:
        print(problem["name"], "takes too long" if done.returncode == -9 else "failed", file=sys.stderr)
        return []
    fine, coarse = ([Fraction(word) for word in line.split()] for line in done.stdout.splitlines())
    rows = []
    for number, (row, velocity) in enumerate(system.asked):
        start = len(row) if velocity else 0
        value, other = (sum(Fraction(float(shape)) * x for shape, x in zip(row, state[start:])) for state in (fine, coarse))
        rows.append({"problem": problem["name"], "quantity": number, "value": repr(float(value)),
                     "uncertainty": f"{float(abs(value - other)):.1e}"})
    print(problem["name"], rows[-1]["value"], rows[-1]["uncertainty"], file=sys.stderr)
    return rows


names = sys.argv[1:]
wanted = [problem for problem in problems() if not names or problem["name"] in names]
wanted.sort(key=cost)
table = csv.DictWriter(sys.stdout, ["problem", "quantity", "value", "uncertainty"], lineterminator="\n")
table.writeheader()
with ThreadPoolExecutor(2) as pool:
    for rows in pool.map(refer, wanted):
        table.writerows(rows)
        sys.stdout.flush()
