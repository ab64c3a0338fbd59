"""Natural frequencies of stepped beams in multiple precision, independent of the crate's method.

Transfer matrices of hyperbolic functions in as many digits as their growth needs; every sign change of the
characteristic determinant on a fine grid in sqrt(omega), refined by the secant method. The number of roots is checked
against the waves that fit (mean spacing), so that none is missed. Needs mpmath; prints the CSV beside this file.
"""

import sys
from mpmath import mp, mpf, cos, sin, exp, sqrt, pi, matrix, nstr

# name, ends, [(length m, rigidity N m^2, mass per length kg/m), ...], number of modes
CASES = [
    ("halves", ("clamped", "free"), [("0.5", "1", "1"), ("0.5", "0.2", "0.5")], 500),
    ("thirds", ("free", "pinned"), [("0.25", "3", "1"), ("0.5", "1", "0.75"), ("0.125", "40", "2")], 120),
    ("soft hinge", ("guided", "clamped"), [("0.5", "1", "1"), ("0.001", "0.000001", "0.01"), ("0.4", "1", "1")], 60),
]
FREE = {"clamped": (2, 3), "pinned": (1, 3), "free": (0, 1), "guided": (0, 2)}
ZERO = {"clamped": (0, 1), "pinned": (0, 2), "free": (2, 3), "guided": (1, 3)}


def determinant(q, ends, segments):
    """Zero at a natural frequency; q = sqrt(omega). The state is (w, w', EI w'', EI w''')."""
    columns = []
    for free in FREE[ends[0]]:
        columns.append([mpf(int(i == free)) for i in range(4)])
    for length, rigidity, mass in segments:
        k = q * (mass / rigidity) ** (mpf(1) / 4)
        y = k * length
        c, s, e = cos(y), sin(y), exp(y)
        ch, sh = (e + 1 / e) / 2, (e - 1 / e) / 2
        f = [(ch + c) / 2, (sh + s) / 2 / k, (ch - c) / 2 / k**2, (sh - s) / 2 / k**3]
        k4 = k**4
        g = [f[0], k4 * f[3], k4 * f[2], k4 * f[1]]
        for column in columns:
            w = [column[0], column[1], column[2] / rigidity, column[3] / rigidity]
            new = [
                f[0] * w[0] + f[1] * w[1] + f[2] * w[2] + f[3] * w[3],
                g[1] * w[0] + f[0] * w[1] + f[1] * w[2] + f[2] * w[3],
                g[2] * w[0] + g[1] * w[1] + f[0] * w[2] + f[1] * w[3],
                g[3] * w[0] + g[2] * w[1] + g[1] * w[2] + f[0] * w[3],
            ]
            column[:] = [new[0], new[1], new[2] * rigidity, new[3] * rigidity]
    i, j = ZERO[ends[1]]
    return columns[0][i] * columns[1][j] - columns[1][i] * columns[0][j]


def roots(ends, segments, wanted):
    phase = sum(length * (mass / rigidity) ** (mpf(1) / 4) for length, rigidity, mass in segments)
    spacing = pi / phase
    step = spacing / 12
    found, q = [], spacing / 50
    before = determinant(q, ends, segments)
    while len(found) < wanted:
        following = q + step
        # digits for the growth exp(sum k l), squared by the determinant, and 30 to keep
        mp.dps = int(2 * following * phase / 2.3) + 40
        after = determinant(following, ends, segments)
        if before * after < 0:
            a, fa, b, fb = q, before, following, after
            while abs(b - a) > mpf(10) ** -22 * b:
                # Illinois
                x = (a * fb - b * fa) / (fb - fa)
                fx = determinant(x, ends, segments)
                if fx == 0:
                    a = b = x
                    break
                if (fx > 0) == (fb > 0):
                    b, fb, fa = x, fx, fa / 2
                else:
                    a, fa, b, fb = b, fb, x, fx
                if abs(fx) < mpf(10) ** -30 * abs(before):
                    b = a = x
            found.append(b)
        q, before = following, after
    return found, found[-1] / spacing


print("case,mode,omega_rad_s")
for name, ends, segments, wanted in CASES:
    mp.dps = 50
    numbers = [tuple(mpf(v) for v in segment) for segment in segments]
    found, expected = roots(ends, numbers, wanted)
    print(f"{name}: {len(found)} elastic roots where {nstr(expected, 6)} half waves fit", file=sys.stderr)
    for n, q in enumerate(found, 1):
        print(f"{name},{n},{nstr(q * q, 20)}")
