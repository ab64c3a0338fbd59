"""Natural frequencies of beams with shear, rotary inertia, attachments, supports, axial force and foundation in
multiple precision, independent of the crate's method.

The four first-order equations of a segment are integrated by their Taylor series in as many digits as the growth needs;
no wave number appears. Every sign change of the characteristic determinant on a grid in omega is refined by bisection and
the secant method. Needs mpmath; takes some ten minutes; prints the CSV beside this file.
"""

from mpmath import mp, mpf, nstr

# segments: (length, EI, m, kappa G A or None, rho I); fixed: (segment after which, mass, rotary inertia, spring,
# rotational spring) or (segment after which, "support"); tension; foundation; modes; largest omega; grid points; digits of the scan
CASES = [
    ("timoshenko halves", ("clamped", "free"), [("0.6", "1", "1", "400", "0.001"), ("0.4", "0.4", "0.6", "280", "0.0004")],
     [], "0", "0", 50, 2200, 5000, 45),
    ("timoshenko fittings", ("free", "pinned"),
     [("0.3", "1", "1", "400", "0.001"), ("0.45", "1", "1", "400", "0.001"), ("0.25", "0.4", "0.6", "280", "0.0004")],
     [(0, "0.2", "0.01", "50", "3"), (1, "support")], "0", "0", 60, 2500, 8000, 45),
    ("compressed on foundation", ("clamped", "pinned"),
     [("0.5", "1", "1", None, "0"), ("0.25", "0.3", "2", None, "0"), ("0.25", "0.3", "2", None, "0")],
     [(1, "0.1", "0", "0", "0")], "-5", "3000", 16, 3500, 1000, 50),
    ("taut", ("pinned", "free"), [("0.5", "1", "1", None, "0"), ("0.5", "0.3", "2", None, "0")],
     [(0, "0.5", "0.02", "0", "0")], "2000", "0", 16, 3500, 1000, 50),
]
FREE = {"clamped": (2, 3), "pinned": (1, 3), "free": (0, 1), "guided": (0, 2)}
ZERO = {"clamped": (0, 1), "pinned": (0, 2), "free": (2, 3), "guided": (1, 3)}


def along(z, length, s, r, p, j):
    """w' = t + s V, t' = r M, M' = -V - j t, V' = -p w over the length."""
    total, term, n = list(z), list(z), 0
    while True:
        n += 1
        h = length / n
        w, t, m, v = term
        term = [h * (t + s * v), h * r * m, h * (-v - j * t), -h * p * w]
        total = [a + b for a, b in zip(total, term)]
        if n > 8 and max(abs(x) for x in term) <= mp.eps * max(abs(x) for x in total):
            return total


def determinant(omega, case):
    _, ends, segments, fixed, tension, foundation, *_ = case
    o2 = omega * omega
    columns = [[mpf(int(i == free)) for i in range(4)] for free in FREE[ends[0]]]
    for index, (length, rigidity, mass, shear, rotary) in enumerate(segments):
        s = 1 / mpf(shear) if shear else mpf(0)
        p = mpf(mass) * o2 - mpf(foundation)
        j = mpf(rotary) * o2 - mpf(tension)
        columns = [along(z, mpf(length), s, 1 / mpf(rigidity), p, j) for z in columns]
        for place, *what in fixed:
            if place != index:
                continue
            if what[0] == "support":
                u, v = columns
                columns = [[u[0] * b - v[0] * a for a, b in zip(u, v)], [mpf(0), mpf(0), mpf(0), mpf(1)]]
            else:
                weight, inertia, spring, turn = map(mpf, what)
                columns = [[w, t, m + (turn - o2 * inertia) * t, v + (spring - o2 * weight) * w]
                           for w, t, m, v in columns]
        size = max(abs(x) for z in columns for x in z)
        columns = [[x / size for x in z] for z in columns]
    a, b = ZERO[ends[1]]
    return columns[0][a] * columns[1][b] - columns[1][a] * columns[0][b]


def roots(case):
    modes, top, points, scan = case[6:]
    mp.dps = scan
    grid = [mpf(top) * (mpf(i) + mpf("0.37")) / points for i in range(points)]
    found, before = [], None
    for omega in grid:
        value = determinant(omega, case)
        if before is not None and (value > 0) != (before[1] > 0):
            mp.dps = 60
            low, high = [(edge, determinant(edge, case)) for edge in (before[0], omega)]
            for _ in range(60):
                middle = (low[0] + high[0]) / 2
                if abs(high[1] - low[1]) > 0:
                    secant = low[0] - low[1] * (high[0] - low[0]) / (high[1] - low[1])
                    if _ % 3 and low[0] < secant < high[0]:
                        middle = secant
                value_there = determinant(middle, case)
                if (value_there > 0) == (low[1] > 0):
                    low = (middle, value_there)
                else:
                    high = (middle, value_there)
                if high[0] - low[0] < mpf(10) ** -18 * high[0] or value_there == 0:
                    break
            best = low if abs(low[1]) < abs(high[1]) else high
            found.append(best[0])
            mp.dps = scan
            if len(found) == modes:
                return found
        before = (omega, value)
    raise SystemExit(f"{case[0]}: {len(found)} roots below {top}")


if __name__ == "__main__":
    print("case,mode,omega_rad_s")
    for case in CASES:
        for n, omega in enumerate(roots(case), 1):
            print(f"{case[0]},{n},{nstr(omega, 17)}")
