"""General solvers of Python on the impacts of the work-precision report; called by benchmarks/peers.sh.

Every impact is integrated phase by phase, as the Rust peers do it: free flight, and one smooth branch of the contact law,
each ended by the solver's own event location. The equations are vectorised; a call of them costs a few microseconds,
most of it Python's own. Times are therefore an upper bound for the methods; numbers of evaluations are not.
"""

import csv
import math
import os
import platform
import signal
import sys
import time
from importlib.metadata import version

import numpy as np
from scipy.integrate import solve_ivp
from sksundae.cvode import CVODE

TOLERANCES = {"flight": [1e-4, 1e-6, 1e-8, 1e-10, 1e-12], "whole": [1e-4, 1e-8, 1e-12]}


class TooSlow(Exception):
    pass


class Impact:
    def __init__(self, path):
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
            # which margin it was
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


def main(problems, package, cap):
    known = references(os.path.join(package, "reference", "impacts.csv"))
    solvers = {
        "scipy DOP853": by_scipy("DOP853"),
        "scipy LSODA": by_scipy("LSODA"),
        "scipy Radau": by_scipy("Radau"),
        "scipy BDF": by_scipy("BDF"),
        "CVODE BDF": by_cvode("BDF"),
        "CVODE Adams": by_cvode("Adams"),
    }

    def late(*_):
        raise TooSlow

    signal.signal(signal.SIGALRM, late)
    folder = os.path.join(package, "outside")
    only = os.environ.get("ONLY", "").split()
    with open(os.path.join(folder, "outside.csv"), "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow("problem,solver,origin,setting,norm,error,time_s,cost,cost_unit,status".split(","))
        for path in sorted(os.listdir(problems)):
            impact = Impact(os.path.join(problems, path))
            if only and impact.name not in only:
                continue
            wanted = known[impact.name]
            end = 1.02 * wanted["times"][-1]
            for exact in [True, False]:
                for name, advance in solvers.items():
                    label, origin = (f"{name} + exact flight", "assisted") if exact else (name, "peer")
                    slow = False
                    for tolerance in TOLERANCES["flight" if exact else "whole"]:
                        write = lambda norm, error, seconds, cost, status: table.writerow(
                            [impact.name, label, origin, repr(tolerance), norm, error, seconds, cost,
                             "right-hand sides", status])
                        if slow:
                            write("", "", "", "", "not tried: a looser setting took too long")
                            continue
                        try:
                            signal.setitimer(signal.ITIMER_REAL, cap)
                            start = time.perf_counter()
                            e, times, impulses, cost = follow(impact, advance, exact, end, tolerance)
                            seconds = time.perf_counter() - start
                            signal.setitimer(signal.ITIMER_REAL, 0)
                            alike = len(times) == len(wanted["times"])
                            worst = max(abs(a - b) for a, b in zip(times, wanted["times"])) / wanted["times"][-1]
                            write("restitution", abs(e - wanted["restitution"]), seconds, cost, "ok")
                            write("total impulse", abs(sum(impulses) / wanted["impulse"] - 1), seconds, cost, "ok")
                            write("contact times", worst if alike else 1.0, seconds, cost, "ok")
                            contacts = abs((len(times) + 1) // 2 - len(wanted["times"]) // 2)
                            write("number of sub-impacts", float(contacts), seconds, cost, "ok")
                        except TooSlow:
                            slow = True
                            write("", "", "", "", f"too slow: over {cap:g} s")
                        except Exception as error:
                            signal.setitimer(signal.ITIMER_REAL, 0)
                            write("", "", "", "", " ".join(str(error).split())[:100])
                        file.flush()
                print(impact.name, "with exact flight" if exact else "whole", flush=True)
    processor = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if "model name" in line), "unknown")
    with open(os.path.join(folder, "versions.txt"), "w") as file:
        file.write(f"{time.strftime('%Y-%m-%d')}; {processor}, {os.cpu_count()} cores, load "
                   f"{os.getloadavg()[0]:.1f} at the end; Python {platform.python_version()}, numpy {version('numpy')}, "
                   f"scipy {version('scipy')}, scikit-sundae {version('scikit-sundae')}; one run each, at most {cap:g} s.\n")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], float(sys.argv[3]))
