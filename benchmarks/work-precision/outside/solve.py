"""Solvers outside Rust on the problems of the work-precision report; called by benchmarks/peers.sh.

Every impact is integrated phase by phase, as by the Rust peers: free flight, and one smooth branch of the contact law,
each ended by the solver's own event location. The equations are vectorised; a call takes a few microseconds,
most of which is Python's overhead (in Octave, ten times as much). Times are therefore an upper bound for the methods; numbers of
evaluations are not. Quadratic programs are in programs.py, Octave's part in ode15s.m.
"""

import argparse
import csv
import math
import os
import platform
import shutil
import signal
import subprocess
import sys
import time
from importlib.metadata import version

import numpy as np
from scipy.integrate import solve_ivp
from sksundae.cvode import CVODE

from programs import Program

TOLERANCES = {"flight": [1e-4, 1e-6, 1e-8, 1e-10, 1e-12], "whole": [1e-4, 1e-8, 1e-12]}
# Time that Octave needs before it starts to solve, on a busy machine.
START_OF_OCTAVE_S = 5


class TooSlow(Exception):
    pass


class Impact:
    def __init__(self, path):
        self.path = path
        words = open(path).read().split()
        value = lambda key: words[words.index(key) + 1]
        self.name = value("name")
        self.mass, self.speed = float(value("mass_kg")), float(value("speed_m_s"))
        at = words.index("law")
        self.law, self.parameters = words[at + 1], [float(word) for word in words[at + 2 : at + 7]]
        at = words.index("modes")
        modes = np.array([float(word) for word in words[at + 2 :]]).reshape(int(words[at + 1]), 3)
        self.omega, self.zeta, self.phi = modes.T
        self.n = len(self.omega)
        self.stiffness, self.damping = self.omega**2, 2 * self.zeta * self.omega


class Phase:
    """One smooth phase: 'flight', or contact with 'single', 'loading' or 'unloading' branch."""

    def __init__(self, impact, kind, anchor=0.0, theta=0.0):
        self.i, self.kind, self.anchor, self.theta0 = impact, kind, anchor, theta
        self.evaluations = 0

    def theta(self, xi):
        _, middle, half, rate, eps = self.i.parameters
        if self.kind == "loading":
            goal, share = middle + half, ((self.anchor + eps) / (xi + eps)) ** rate
        else:
            goal, share = middle - half, ((xi + eps) / (self.anchor + eps)) ** rate
        return goal + (self.theta0 - goal) * share

    def compression(self, y):
        n, phi = self.i.n, self.i.phi
        return phi @ y[2 : 2 + n] - y[0], phi @ y[2 + n :] - y[1]

    def force(self, y):
        if self.kind == "flight":
            return 0.0
        xi, rate = self.compression(y)
        if xi <= 0:
            return 0.0
        hertz = self.i.parameters[0] * xi * math.sqrt(xi)
        if self.i.law == "viscous":
            return max(hertz * (1 + self.i.parameters[1] * rate), 0.0)
        if self.i.law == "hysteretic":
            return hertz * (1 + self.theta(xi))
        return hertz

    def rates(self, t, y, out=None):
        self.evaluations += 1
        i, n = self.i, self.i.n
        force = self.force(y)
        d = np.empty(2 * n + 2) if out is None else out
        d[0], d[1] = y[1], force / i.mass
        d[2 : 2 + n] = y[2 + n :]
        d[2 + n :] = -i.stiffness * y[2 : 2 + n] - i.damping * y[2 + n :] - i.phi * force
        return d

    def margins(self, y):
        xi, rate = self.compression(y)
        return {"flight": [-xi], "single": [xi], "loading": [rate], "unloading": [xi, -rate]}[self.kind]

    def tolerances(self, tolerance):
        i = self.i
        modal, contact = i.speed * math.sqrt(i.mass), 1e-4
        scales = [i.speed * contact, i.speed, *(modal * np.minimum(1 / i.omega, contact)), *([modal] * i.n)]
        return tolerance * np.array(scales)


def fly(impact, t, y, end):
    """Free flight in closed form, with the same certified search as in Rust."""
    i, n = impact, impact.n
    y = y.copy()
    cuts = np.arange(n + 1)
    reach = np.abs(i.phi) * np.hypot(y[2 : 2 + n], y[2 + n :] / i.omega)
    above = np.concatenate([np.cumsum(reach[::-1])[::-1], [0.0]])
    bend = np.concatenate([[0.0], np.cumsum((1 + 2 * i.zeta) * i.stiffness * reach)])
    damped = i.omega * np.sqrt(1 - i.zeta**2)
    fastest = i.omega.max()
    while True:
        gaps = y[0] - np.concatenate([[0.0], np.cumsum(i.phi * y[2 : 2 + n])])
        opens = y[1] - np.concatenate([[0.0], np.cumsum(i.phi * y[2 + n :])])
        gap, opening = gaps[-1], opens[-1]
        if gap <= 0 and opening < 0:
            return t, y, 0
        clear = gaps - above
        valid = (clear > 0) | ((clear == 0) & (opens > 0))
        with np.errstate(divide="ignore", invalid="ignore"):
            times = (opens + np.sqrt(opens**2 + 2 * bend * clear)) / bend
        times = np.where(valid, np.where(np.isnan(times), np.inf, times), 0.0)
        step = times.max()
        if step * fastest < 0.02:
            step = gap / -opening if opening < 0 else max(step, 1e-4 / fastest)
            if step <= 1e-15 * max(t, 1 / fastest):
                return t, y, 0
        last = t + step >= end
        step = end - t if last else step
        a, b = y[2 : 2 + n].copy(), y[2 + n :].copy()
        s, c, e = np.sin(damped * step), np.cos(damped * step), np.exp(-i.zeta * i.omega * step)
        q = (b + i.zeta * i.omega * a) / damped
        y[0] += y[1] * step
        y[2 : 2 + n] = e * (a * c + q * s)
        y[2 + n :] = e * (b * c - (i.zeta * i.omega * q + damped * a) * s)
        t += step
        if last:
            return t, y, None


def by_scipy(method):
    def advance(phase, t, y, end, tolerance):
        offsets = [min(margin, 0.0) for margin in phase.margins(y)]
        events = []
        for k, offset in enumerate(offsets):
            event = lambda t, y, k=k, offset=offset: phase.margins(y)[k] - offset
            event.terminal, event.direction = True, -1
            events.append(event)
        step = {} if phase.kind == "flight" else {"first_step": min(3e-5 * tolerance**0.4, 0.5 * (end - t))}
        found = solve_ivp(phase.rates, (0.0, end - t), y, method=method, rtol=2.3e-14, atol=phase.tolerances(tolerance),
                          events=events, **step)
        if found.status < 0:
            raise RuntimeError(found.message)
        for which, times in enumerate(found.t_events):
            if len(times):
                return t + times[-1], found.y_events[which][-1], which
        return end, found.y[:, -1], None

    return advance


def by_cvode(method):
    def advance(phase, t, y, end, tolerance):
        offsets = [min(margin, 0.0) for margin in phase.margins(y)]

        def rates(t, y, yp):
            phase.rates(t, y, yp)

        def events(t, y, g):
            g[:] = [margin - offset for margin, offset in zip(phase.margins(y), offsets)]

        events.terminal = [True] * len(offsets)
        events.direction = [-1] * len(offsets)
        step = {} if phase.kind == "flight" else {"first_step": 3e-5 * tolerance**0.4}
        solver = CVODE(rates, method=method, rtol=1e-15, atol=phase.tolerances(tolerance), eventsfn=events,
                       num_events=len(offsets), max_num_steps=10_000_000, **step)
        found = solver.solve(np.array([0.0, end - t]), y)
        if not found.success:
            raise RuntimeError(str(found.message))
        if found.t_events is not None and len(found.t_events):
            # The number of the event function.
            last = found.y[-1]
            margins = [margin - offset for margin, offset in zip(phase.margins(last), offsets)]
            return t + found.t[-1], last, int(np.argmin(np.abs(margins)))
        return end, found.y[-1], None

    return advance


def follow(impact, advance, exact_flight, end, tolerance):
    y = np.zeros(2 * impact.n + 2)
    y[1] = -impact.speed
    t, times, evaluations = 0.0, [0.0], 0
    impulses, touch = [], y[1]

    def contact():
        if impact.law == "hysteretic":
            return Phase(impact, "loading", 0.0, impact.parameters[1] + impact.parameters[2])
        return Phase(impact, "single")

    phase = contact()
    for _ in range(2000):
        if phase.kind == "flight" and exact_flight:
            t, y, which = fly(impact, t, y, end)
        else:
            t, y, which = advance(phase, t, y, end, tolerance)
            evaluations += phase.evaluations
        if which is None:
            if phase.kind != "flight":
                impulses.append(impact.mass * (y[1] - touch))
            return y[1] / impact.speed, times, impulses, evaluations
        xi = max(phase.compression(y)[0], 0.0)
        if phase.kind == "flight":
            times.append(t)
            touch, phase = y[1], contact()
        elif phase.kind == "loading":
            phase = Phase(impact, "unloading", xi, phase.theta(xi))
        elif phase.kind == "unloading" and which == 1:
            phase = Phase(impact, "loading", xi, phase.theta(xi))
        else:
            times.append(t)
            impulses.append(impact.mass * (y[1] - touch))
            phase = Phase(impact, "flight")
    raise RuntimeError("more than 2000 events")


def by_octave(impact, exact_flight, end, tolerance, limit):
    """Octave's ode15s, in a separate process; its time is counted from when it has read its files."""
    script = os.path.join(os.path.dirname(__file__), "ode15s.m")
    words = ["octave-cli", "--no-gui", "--quiet", "--norc", script, impact.path, repr(tolerance), repr(end),
             str(int(exact_flight))]
    try:
        told = subprocess.run(words, capture_output=True, text=True, timeout=limit + START_OF_OCTAVE_S).stdout
    except subprocess.TimeoutExpired:
        raise TooSlow from None
    found = dict(line.split(" ", 1) for line in told.splitlines() if " " in line)
    if "restitution" not in found:
        raise RuntimeError(found.get("failure", "ode15s ended without a result"))
    numbers = lambda key: [float(word) for word in found[key].split()]
    return (float(found["restitution"]), numbers("times"), numbers("impulses"), int(found["evaluations"]),
            float(found["seconds"]))


def in_python(advance):
    """A solver with a time limit by an alarm."""

    def solve(impact, exact_flight, end, tolerance, limit):
        signal.setitimer(signal.ITIMER_REAL, limit)
        try:
            start = time.perf_counter()
            found = follow(impact, advance, exact_flight, end, tolerance)
            return (*found, time.perf_counter() - start)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)

    return solve


def references(path):
    found = {}
    for name, kind, a, b, c in list(csv.reader(open(path)))[1:]:
        entry = found.setdefault(name, {"times": [], "impulse": 0.0})
        if kind == "net":
            entry["restitution"] = float(a)
        else:
            entry["times"] += [float(a), float(b)]
            entry["impulse"] += float(c)
    return found


def errors(wanted, restitution, times, impulses):
    """The norms of the report."""
    alike = len(times) == len(wanted["times"])
    worst = max(abs(a - b) for a, b in zip(times, wanted["times"])) / wanted["times"][-1]
    contacts = abs((len(times) + 1) // 2 - len(wanted["times"]) // 2)
    return {"restitution": abs(restitution - wanted["restitution"]),
            "total impulse": abs(sum(impulses) / wanted["impulse"] - 1),
            "contact times": worst if alike else 1.0,
            "number of sub-impacts": float(contacts)}


def sweep(impact, wanted, name, solve, exact, cap, allowance):
    """Rows of one solver on one impact, from the loosest tolerance to the tightest, within an allowance of time."""
    label, origin = (f"{name} + exact flight", "assisted") if exact else (name, "peer")
    until, stopped = time.monotonic() + allowance, None
    for tolerance in TOLERANCES["flight" if exact else "whole"]:
        row = lambda norm, error, seconds, cost, status: [
            impact.name, label, origin, repr(tolerance), norm, error, seconds, cost, "right-hand sides", status]
        limit = min(cap, until - time.monotonic())
        if stopped is None and limit < 0.1:
            stopped = "not tried: out of time"
        if stopped:
            yield row("", "", "", "", stopped)
            continue
        try:
            *found, cost, seconds = solve(impact, exact, 1.02 * wanted["times"][-1], tolerance, limit)
            for norm, error in errors(wanted, *found).items():
                yield row(norm, error, seconds, cost, "ok")
        except TooSlow:
            stopped = "not tried: a looser setting took too long"
            yield row("", "", "", "", f"too slow: over {limit:.1f} s")
        except Exception as error:
            yield row("", "", "", "", " ".join(str(error).split())[:100] or type(error).__name__)


def machine(options):
    processor = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if "model name" in line), "unknown")
    packages = ", ".join(f"{name} {version(name)}" for name in ["numpy", "scipy", "scikit-sundae", "daqp"])
    octave = "without Octave"
    if shutil.which("octave-cli"):
        told = subprocess.run(["octave-cli", "--version"], capture_output=True, text=True).stdout
        octave = told.splitlines()[0].replace(", version", "")
    return (f"{time.strftime('%Y-%m-%d')}; {processor}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} at the "
            f"end; Python {platform.python_version()}, {packages}, {octave}; impacts one run each, at most "
            f"{options.seconds:g} s and {options.minutes:g} min together.\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("exported", help="folder that `work-precision export` has written")
    parser.add_argument("package", help="folder of the package work-precision")
    parser.add_argument("--out", required=True, help="folder to write outside.csv and versions.txt to")
    parser.add_argument("--problems", help="only these, with commas between their names")
    parser.add_argument("--seconds", type=float, default=60, help="how long one solve may take")
    parser.add_argument("--minutes", type=float, default=11, help="how long all may take")
    options = parser.parse_args()

    def late(*_):
        raise TooSlow

    signal.signal(signal.SIGALRM, late)
    solvers = {
        "scipy DOP853": in_python(by_scipy("DOP853")),
        "scipy LSODA": in_python(by_scipy("LSODA")),
        "scipy Radau": in_python(by_scipy("Radau")),
        "scipy BDF": in_python(by_scipy("BDF")),
        "CVODE BDF": in_python(by_cvode("BDF")),
        "CVODE Adams": in_python(by_cvode("Adams")),
    }
    if shutil.which("octave-cli"):
        solvers["Octave ode15s"] = by_octave
    only = options.problems.split(",") if options.problems else None
    files = [os.path.join(options.exported, name) for name in sorted(os.listdir(options.exported))]
    chosen = lambda found: [one for one in found if only is None or one.name in only]
    impacts = chosen(Impact(path) for path in files if os.path.basename(path).startswith("impact-"))
    programs = chosen(Program(path) for path in files if os.path.basename(path).startswith("program-"))
    known = references(os.path.join(options.package, "reference", "impacts.csv"))
    # With exact flight first, as it costs little: the unused time of one solver is available to the others.
    jobs = [(impact, exact, name) for exact in [True, False] for impact in impacts for name in solvers]
    if not jobs and not programs:
        sys.exit(f"error: no problem of the names {options.problems}")
    os.makedirs(options.out, exist_ok=True)
    until = time.monotonic() + 60 * options.minutes
    with open(os.path.join(options.out, "outside.csv"), "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow("problem,solver,origin,setting,norm,error,time_s,cost,cost_unit,status".split(","))
        for program in programs:
            table.writerow(program.row())
        for done, (impact, exact, name) in enumerate(jobs):
            allowance = (until - time.monotonic()) / (len(jobs) - done)
            for row in sweep(impact, known[impact.name], name, solvers[name], exact, options.seconds, allowance):
                table.writerow(row)
            file.flush()
            print(f"{done + 1}/{len(jobs)} {impact.name}, {name}{' + exact flight' * exact}", flush=True)
    with open(os.path.join(options.out, "versions.txt"), "w") as file:
        file.write(machine(options))


if __name__ == "__main__":
    main()
