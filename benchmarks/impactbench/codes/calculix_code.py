"""CalculiX: implicit dynamics with a fixed step and without numerical damping. A mode is a unit mass on a spring, an equation ties
the point of a contact to the modes, and a contact is a nonlinear spring that has no force across the gap. Dashpots work only in
steady states in CalculiX, so that only problems without damping are solved. The setting is the number of steps."""

import os
import pathlib
import signal
import subprocess
import tempfile

import numpy

from template import System, bench

COUNTS = [30, 100, 300, 1000]
# Number of points of a nonlinear force, which CalculiX interpolates linearly.
POINTS = 100


def number(value):
    """A number in the twenty characters of a field."""
    return f"{float(value):.11E}"


def table(system, gap, law):
    """Force as a function of elongation, for a spring under compression."""
    k, n, _, _ = law
    if n == 1.0:
        depths = [1.0]
    else:
        # From the total energy of the motion, with a margin.
        deepest = 2 * ((n + 1) / (2 * k) * system.scale() ** 2) ** (1 / (n + 1))
        depths = deepest * (numpy.arange(POINTS, 0, -1) / POINTS) ** 2
    lines = [f"{number(-k * depth**n)},{number(-gap - depth)}" for depth in depths]
    return lines + [f"0.,{number(-gap)}", f"0.,{number(10.0 + abs(gap))}"]


def deck(system, laws, count):
    modes, end = len(system.omega), system.end
    lines = ["*NODE,NSET=ALL"]
    lines += [f"{1 + k},0.,0.,0." for k in range(modes)]
    points = [1001 + 2 * i for i in range(len(laws))]
    for point in points:
        lines += [f"{point},0.,0.,0.", f"{point + 1},100.,0.,0."]
    lines += ["*NSET,NSET=MODES", *(f"{1 + k}," for k in range(modes))]
    lines += ["*ELEMENT,TYPE=MASS,ELSET=M", *(f"{1 + k},{1 + k}" for k in range(modes)), "*MASS,ELSET=M", "1."]
    for k, omega in enumerate(system.omega):
        if omega > 0:
            lines += [f"*ELEMENT,TYPE=SPRING1,ELSET=S{k}", f"{2001 + k},{1 + k}"]
            lines += [f"*SPRING,ELSET=S{k}", "1", number(omega**2)]
    for i, (point, (psi, gap, _), law) in enumerate(zip(points, system.contacts, laws)):
        lines += [f"*ELEMENT,TYPE=SPRINGA,ELSET=C{i}", f"{4001 + i},{point},{point + 1}"]
        lines += [f"*SPRING,ELSET=C{i},NONLINEAR", *table(system, gap, law)]
        seen = numpy.flatnonzero(psi)
        lines += ["*EQUATION", str(1 + len(seen)), f"{point},1,1."]
        lines += [f"{1 + k},1,{number(-psi[k])}" for k in seen]
    lines += ["*BOUNDARY", *(f"{1 + k},2,3" for k in range(modes))]
    for point in points:
        lines += [f"{point},2,3", f"{point + 1},1,3"]
    for kind, values in (("DISPLACEMENT", system.amplitude), ("VELOCITY", system.rate)):
        lines += [f"*INITIAL CONDITIONS,TYPE={kind}", *(f"{1 + k},1,{number(value)}" for k, value in enumerate(values))]
    for h, (omega, phase, _) in enumerate(system.harmonics):
        times = numpy.linspace(0, end, 1 + int(max(200, 200 * omega * end / 6)))
        lines += [f"*AMPLITUDE,NAME=H{h}"]
        lines += [f"{number(time)},{number(value)}" for time, value in zip(times, numpy.sin(omega * times + phase))]
    lines += [f"*STEP,INC={10 * count}", "*DYNAMIC,DIRECT,ALPHA=0.", f"{number(end / count)},{number(end)}"]
    if system.constant.any():
        lines += ["*CLOAD", *(f"{1 + k},1,{number(value)}" for k, value in enumerate(system.constant) if value)]
    for h, (_, _, row) in enumerate(system.harmonics):
        lines += [f"*CLOAD,AMPLITUDE=H{h}", *(f"{1 + k},1,{number(value)}" for k, value in enumerate(row) if value)]
    lines += [f"*NODE PRINT,NSET=MODES,FREQUENCY={100 * count}", "U,V", "*END STEP"]
    return "\n".join(lines) + "\n"


def solve(problem, count):
    system = System(problem)
    laws = system.powers()
    if laws is None or (system.ratio * system.omega).any() or any(d or c for _, _, d, c in laws):
        return None
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as folder:
        (pathlib.Path(folder) / "deck.inp").write_text(deck(system, laws, count))
        before = os.times()
        done = subprocess.run(["ccx", "deck"], cwd=folder, stdout=subprocess.DEVNULL)
        if done.returncode == -signal.SIGKILL:
            raise TimeoutError("too slow")
        after = os.times()
        result = pathlib.Path(folder) / "deck.dat"
        printed = result.read_text().split("\n") if result.exists() else []
    seconds = after.children_user + after.children_system - before.children_user - before.children_system
    rows = [line.split() for line in printed]
    numbers = [float(row[1]) for row in rows if len(row) == 4 and row[0].isdigit()]
    if len(numbers) != 2 * len(system.omega):
        raise ArithmeticError("no convergence")
    return system.answers(numpy.array(numbers[: len(system.omega)]), numpy.array(numbers[len(system.omega) :])), seconds


VERSION = subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout.split()[-1]
if __name__ == "__main__":
    bench("calculix", "CalculiX", COUNTS, solve, f"CalculiX {VERSION}")
