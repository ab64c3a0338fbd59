"""The common part of the codes outside Rust: it reads the problems, times a function on each, and writes the table.

A code is a program in the same folder:

    from template import bench, only_ball

    def solve(problem, setting):
        ball = only_ball(problem)               # None unless a free mass meets the ground
        if ball is None:
            return None                         # a dash: this code cannot solve it
        ...
        return [velocity_at_the_end]            # the requested quantities, in order

    bench("mycode", "my code, as it is used", [1e-3, 1e-4], solve, versions="mycode 1.0")
"""

import csv
import json
import math
import multiprocessing
import os
import pathlib
import platform
import resource
import signal
import time

import numpy

HERE = pathlib.Path(__file__).resolve().parent
LONGEST_S = 2.0
BUDGET_S = 0.15
# no code gets more than one core
os.environ |= {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBER_OF_CPUS")}


def problems():
    """Every problem, as in its file."""
    return [json.loads(path.read_text()) for path in sorted((HERE.parent / "problems").glob("*.json"))]


def only_ball(problem):
    """Mass and downward speed of the only body, if it is a free mass that touches the ground without gravity."""
    if len(problem["bodies"]) != 1 or len(problem["contacts"]) != 1 or problem["gravity_m_s2"] != 0 or "loads" in problem:
        return None
    body, contact = problem["bodies"][0], problem["contacts"][0]
    if body["omega_rad_s"] != [0.0] or "lower" in contact or contact["gap_m"] != 0:
        return None
    shape = body["shape"][0]
    return {"mass_kg": shape**-2, "speed_m_s": -shape * body["rate"][0], "law": contact["law"]}


def oscillator(problem):
    """Mass, stiffness, downward speed and stop of a mass on a spring that meets an elastic stop."""
    if problem["family"] != "stop" or len(problem["bodies"]) != 1 or "loads" in problem:
        return None
    if len(problem["bodies"][0]["shape"]) != 1:
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


def power_law(law):
    """Stiffness k, exponent n, damping d and dashpot c of a force k xi^n (1 + d xi') + c xi', which does not pull; `None` for
    another law."""
    k = law.get("stiffness_n_m1_5", law.get("stiffness_n_m", law.get("stiffness_n_m_n")))
    if law["kind"] in ("hertz", "viscous"):
        return k, 1.5, law.get("damping_s_m", 0.0), 0.0
    if law["kind"] in ("linear-spring", "kelvin-voigt"):
        return k, 1.0, 0.0, law.get("damping_n_s_m", 0.0)
    if law["kind"] == "hunt-crossley":
        return k, law["exponent"], law["damping_s_m"], 0.0
    return None


class System:
    """A problem as one system in its modes, q'' + 2 ratio omega q' + omega^2 q = constant + harmonics - psi force, and
    compressions psi q - gap. Upper bodies are pushed up, lower ones down."""

    def __init__(self, problem):
        bodies = {body["name"]: body for body in problem["bodies"]}
        places, count = {}, 0
        for name, body in bodies.items():
            places[name] = slice(count, count + len(body["shape"]))
            count += len(body["shape"])

        def together(field):
            return numpy.array([value for body in bodies.values() for value in body[field]], dtype=float)

        def spread(name, shape):
            row = numpy.zeros(count)
            row[places[name]] = bodies[name]["shape"] if shape is None else shape
            return row

        self.end = problem["end_s"]
        self.omega, self.ratio = together("omega_rad_s"), together("damping_ratio")
        self.amplitude, self.rate = together("amplitude"), together("rate")
        self.constant = numpy.zeros(count)
        for name, body in bodies.items():
            if body["omega_rad_s"] == [0.0]:
                self.constant[places[name]] = -problem["gravity_m_s2"] / body["shape"][0]
        self.harmonics = []
        for load in problem.get("loads", []):
            row = load["force_n"] * spread(load["body"], load.get("shape"))
            if load["omega_rad_s"] == 0.0:
                self.constant += row * math.sin(load["phase_rad"])
            else:
                self.harmonics.append((load["omega_rad_s"], load["phase_rad"], row))
        self.contacts = []
        for contact in problem["contacts"]:
            psi = numpy.zeros(count)
            for side, sign in (("upper", -1), ("lower", 1)):
                if side in contact:
                    psi += sign * spread(contact[side], contact.get(side + "_shape"))
            self.contacts.append((psi, contact["gap_m"], contact["law"]))
        self.asked = [
            (spread(quantity["body"], quantity.get("shape")), quantity["what"] == "velocity_m_s")
            for quantity in problem["quantities"]
            if problem["bodies"]
        ]

    def force(self, time):
        """Modal forces of gravity and loads."""
        total = self.constant.copy()
        for omega, phase, row in self.harmonics:
            total += row * math.sin(omega * time + phase)
        return total

    def powers(self):
        """The laws in the form of `power_law`; `None` if one of them is different, or if there is no contact."""
        laws = [power_law(law) for _, _, law in self.contacts]
        return None if not laws or None in laws else laws

    def scale(self):
        """A typical modal rate of the motion."""
        driven = abs(self.constant) + sum(abs(row) for _, _, row in self.harmonics)
        driven = driven * numpy.minimum(self.end, 1 / numpy.maximum(self.omega, 1e-12))
        return float(max(numpy.linalg.norm(self.rate), numpy.linalg.norm(driven)))

    def text(self):
        """The system in the form of `cvode/system.h`; `None` if a law is not a power."""
        laws = self.powers()
        if laws is None:
            return None
        lines = [[len(self.omega), len(self.contacts), len(self.harmonics)], [self.end]]
        lines += [self.omega, self.ratio, self.amplitude, self.rate, self.constant]
        for (psi, gap, _), law in zip(self.contacts, laws):
            lines += [[*law, gap], psi]
        for omega, phase, row in self.harmonics:
            lines += [[omega, phase], row]
        return "\n".join(" ".join(repr(float(value)) for value in line) for line in lines) + "\n"

    def answers(self, q, rate):
        """The requested quantities."""
        values = [float(row @ (rate if velocity else q)) for row, velocity in self.asked]
        if not numpy.all(numpy.isfinite(values)):
            raise ArithmeticError("not a number")
        return values


def damping_ratio(restitution):
    """The damping ratio of a spring and dashpot that do not pull, by bisection on e = exp(-2 z acos(z)/sqrt(1 - z^2))."""

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
    """The result of a run, and the mean processor time of repeated runs, which does not depend on other programs."""
    began, count = time.process_time(), 0
    while True:
        found = run()
        count += 1
        spent = time.process_time() - began
        if found is None or isinstance(found, tuple) or spent > BUDGET_S:
            return found, spent / count


def attempt(run, pipe):
    """Sends the result of a run: its values or `None`, its time, its status."""
    # This process and the programs that it starts are ended if they take longer.
    resource.setrlimit(resource.RLIMIT_CPU, (int(2 * LONGEST_S),) * 2)
    try:
        values, seconds = timed(run)
        if isinstance(values, tuple):
            # A separate program, which has measured its own time.
            values, seconds = values
        pipe.send((values, seconds, "ok"))
    except Exception as fault:
        pipe.send((None, None, str(fault).splitlines()[0] if str(fault) else type(fault).__name__))


def guarded(run):
    """The same from a separate process, which may crash or take too long."""
    context = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe(duplex=False)
    process = context.Process(target=attempt, args=(run, theirs))
    process.start()
    theirs.close()
    try:
        found = ours.recv() if ours.poll(20 * LONGEST_S) else (None, None, "too slow")
    except EOFError:
        process.join(1)
        found = (None, None, "too slow" if process.exitcode == -signal.SIGKILL else "crashed")
    process.kill()
    process.join()
    return found if found[1] is None or found[1] <= LONGEST_S else (None, None, "too slow")


def bench(name, code, settings, solve, versions):
    """Runs every problem at every setting, from coarse to fine, and writes NAME.csv and NAME.txt."""
    results = HERE.parent / "results"
    cpu = pathlib.Path("/proc/cpuinfo")
    models = [line.split(": ")[1] for line in cpu.read_text().splitlines() if line.startswith("model name")] if cpu.exists() else []
    processor = models[0] if models else platform.processor() or platform.machine()
    about = f"{time.strftime('%Y-%m-%d')}; {processor}; Python {platform.python_version()}, {versions}\n"
    (results / f"{name}.txt").write_text(about)
    with open(results / f"{name}.csv", "a", newline="") as file:
        table = csv.DictWriter(file, ["problem", "code", "setting", "time_s", "status", "values"])
        if file.tell() == 0:
            table.writeheader()
        for problem in problems():
            table.writerows(sweep(problem, code, settings, solve))
            file.flush()


def sweep(problem, code, settings, solve):
    """The rows of a problem; empty if the code cannot take part."""
    rows = []
    for setting in settings:
        row = {"problem": problem["name"], "code": code, "setting": setting, "time_s": "", "status": "ok", "values": ""}
        values, seconds, status = guarded(lambda: solve(problem, setting))
        if status != "ok":
            rows.append(row | {"status": status})
            if status == "too slow":
                break
        elif values is None:
            break
        else:
            rows.append(row | {"time_s": seconds, "values": " ".join(repr(float(value)) for value in values)})
    return rows
