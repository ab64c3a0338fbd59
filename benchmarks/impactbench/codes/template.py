"""What every code outside Rust shares: it reads the problems, times a function on each, and writes the table.

A code is a program beside this one:

    from template import bench, only_ball

    def solve(problem, setting):
        ball = only_ball(problem)               # None unless a free mass meets the ground
        if ball is None:
            return None                         # a dash: this code cannot do it
        ...
        return [velocity_at_the_end]            # the numbers asked for, in order

    bench("mycode", "my code, as it is used", [1e-3, 1e-4], solve, versions="mycode 1.0")
"""

import csv
import json
import math
import pathlib
import platform
import time

HERE = pathlib.Path(__file__).resolve().parent
LONGEST_S = 2.0
BUDGET_S = 0.15


def problems():
    """Every problem, as its file has it."""
    return [json.loads(path.read_text()) for path in sorted((HERE.parent / "problems").glob("*.json"))]


def only_ball(problem):
    """Mass and downward speed of the only body, if it is a free mass that touches the ground without gravity."""
    if len(problem["bodies"]) != 1 or len(problem["contacts"]) != 1 or problem["gravity_m_s2"] != 0:
        return None
    body, contact = problem["bodies"][0], problem["contacts"][0]
    if body["omega_rad_s"] != [0.0] or "lower" in contact or contact["gap_m"] != 0:
        return None
    shape = body["shape"][0]
    return {"mass_kg": shape**-2, "speed_m_s": -shape * body["rate"][0], "law": contact["law"]}


def oscillator(problem):
    """Mass, stiffness, downward speed and stop of a mass on a spring that meets an elastic stop."""
    if problem["family"] != "stop":
        return None
    body, contact = problem["bodies"][0], problem["contacts"][0]
    shape, omega = body["shape"][0], body["omega_rad_s"][0]
    return {
        "mass_kg": shape**-2,
        "stiffness_n_m": omega**2 * shape**-2,
        "speed_m_s": -shape * body["rate"][0],
        "gap_m": contact["gap_m"],
        "stop_n_m": contact["law"]["stiffness_n_m"],
    }


def damping_ratio(restitution):
    """That of spring and dashpot which do not pull, by bisection on e = exp(-2 z acos(z)/sqrt(1 - z^2))."""

    def obtained(z):
        if z < 1:
            return math.exp(-2 * z * math.acos(z) / math.sqrt(1 - z * z))
        return math.exp(-2 * z * math.acosh(z) / math.sqrt(z * z - 1))

    low, high = 0.0, 20.0
    for _ in range(100):
        middle = 0.5 * (low + high)
        if middle != 1.0 and obtained(middle) > restitution:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def timed(run):
    """What a run gives, and the least time of repeated ones."""
    began, least = time.perf_counter(), math.inf
    while True:
        start = time.perf_counter()
        found = run()
        least = min(least, time.perf_counter() - start)
        if time.perf_counter() - began > BUDGET_S:
            return found, least


def bench(name, code, settings, solve, versions):
    """Offers every problem at every setting, from coarse to fine, and writes NAME.csv and NAME.txt."""
    rows = []
    for problem in problems():
        for setting in settings:
            row = {"problem": problem["name"], "code": code, "setting": setting, "time_s": "", "status": "ok", "values": ""}
            try:
                values, seconds = timed(lambda: solve(problem, setting))
            except Exception as fault:
                rows.append(row | {"status": str(fault).splitlines()[0]})
                continue
            if values is None:
                break
            rows.append(row | {"time_s": seconds, "values": " ".join(repr(float(value)) for value in values)})
            if seconds > LONGEST_S:
                rows[-1] |= {"time_s": "", "status": "too slow", "values": ""}
                break
    results = HERE.parent / "results"
    with open(results / f"{name}.csv", "a", newline="") as file:
        table = csv.DictWriter(file, ["problem", "code", "setting", "time_s", "status", "values"])
        if file.tell() == 0:
            table.writeheader()
        table.writerows(rows)
    processor = platform.processor() or platform.machine()
    cpu = pathlib.Path("/proc/cpuinfo")
    if cpu.exists():
        models = [line.split(": ")[1] for line in cpu.read_text().splitlines() if line.startswith("model name")]
        processor = models[0] if models else processor
    about = f"{time.strftime('%Y-%m-%d')}; {processor}; Python {platform.python_version()}, {versions}\n"
    (results / f"{name}.txt").write_text(about)
