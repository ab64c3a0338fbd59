"""Some of the first 500 natural frequencies of stepped Timoshenko beams to 25 digits, independent of the crate's method.

Which root of the characteristic determinant has which number is told by finite elements: polynomials of degree 16 for
displacement and rotation on elements that the 500th mode crosses some five times, all frequencies of a dense matrix. Each root
is then refined by the secant method on the determinant of beam_system_reference.py, with as many digits beyond 45 as the waves
lose, and its sign change at a distance of 1e-24 is asserted. Needs mpmath and numpy; takes some minutes; prints the CSV beside
this file.
"""

import numpy as np
from mpmath import mp, mpf, nstr

from beam_system_reference import determinant

# name, ends, segments: (length, EI, m, kappa G A, rho I); elements of each segment
CASES = [
    ("thick", ("clamped", "free"), [("0.6", "1", "1", "400", "0.001"), ("0.4", "0.4", "0.6", "280", "0.0004")], (60, 40)),
    ("forty thicknesses", ("clamped", "pinned"),
     [("0.5", "273", "1", "140000", "0.0005"), ("0.5", "34.2", "0.5", "70000", "0.00025")], (50, 60)),
    ("slender", ("free", "pinned"),
     [("0.3", "1", "1", "4000000", "0.0000001"), ("0.45", "0.4", "0.8", "3000000", "0.00000008"),
      ("0.25", "1", "1", "4000000", "0.0000001")], (30, 50, 25)),
]
MODES = [1, 2, 3, 5, 10, 20, 40, 60, 80, 100, 125, 150, 200, 250, 300, 350, 400, 450, 475, 490, 499, 500]
DEGREE = 16
HELD = {"clamped": ("w", "t"), "pinned": ("w",), "free": (), "guided": ("t",)}


def element(length):
    """Integrals of products of the two linear functions and of integrated Legendre polynomials, and of their slopes."""
    nodes, weights = np.polynomial.legendre.leggauss(DEGREE + 2)
    legendre = np.polynomial.legendre.legvander(nodes, DEGREE + 1)
    values, slopes = [0.5 * (1 - nodes), 0.5 * (1 + nodes)], [-0.5 + 0 * nodes, 0.5 + 0 * nodes]
    for j in range(1, DEGREE):
        values.append((legendre[:, j + 1] - legendre[:, j - 1]) / np.sqrt(4 * j + 2))
        slopes.append(np.sqrt(j + 0.5) * legendre[:, j])
    values, slopes = np.array(values), np.array(slopes) * 2 / length
    weights = weights * length / 2
    return values * weights @ values.T, slopes * weights @ slopes.T, slopes * weights @ values.T


def finite_elements(case):
    _, ends, segments, counts = case
    elements = [(segment, count) for segment, count in zip(segments, counts) for _ in range(count)]
    size = len(elements) * DEGREE + 1
    stiffness, mass = np.zeros((2 * size, 2 * size)), np.zeros((2 * size, 2 * size))
    for e, ((length, rigidity, m, shear, rotary), count) in enumerate(elements):
        vv, ss, sv = element(float(length) / count)
        w = np.array([e * DEGREE, (e + 1) * DEGREE] + list(range(e * DEGREE + 1, (e + 1) * DEGREE)))
        t = w + size
        shear = float(shear)
        stiffness[np.ix_(w, w)] += shear * ss
        stiffness[np.ix_(t, t)] += float(rigidity) * ss + shear * vv
        stiffness[np.ix_(w, t)] -= shear * sv
        stiffness[np.ix_(t, w)] -= shear * sv.T
        mass[np.ix_(w, w)] += float(m) * vv
        mass[np.ix_(t, t)] += float(rotary) * vv
    held = {(0 if what == "w" else size) + end for end, which in zip((0, size - 1), ends) for what in HELD[which]}
    kept = [i for i in range(2 * size) if i not in held]
    scale = 1 / np.sqrt(np.diag(mass)[kept])
    stiffness = stiffness[np.ix_(kept, kept)] * scale[:, None] * scale
    mass = mass[np.ix_(kept, kept)] * scale[:, None] * scale
    lower = np.linalg.cholesky(mass)
    reduced = np.linalg.solve(lower, np.linalg.solve(lower, stiffness).T)
    squares = np.linalg.eigvalsh(0.5 * (reduced + reduced.T))
    return np.sqrt(np.abs(squares[:max(MODES) + 1]))


def digits_lost(case, omega):
    """Decimal digits that waves lose: by growing over the beam, and in the Taylor series of those that travel."""
    growth = 0.0
    for length, rigidity, m, shear, rotary in case[2]:
        length, rigidity, m, shear, rotary = map(float, (length, rigidity, m, shear, rotary))
        # EI k^4 + (m EI/S + rho I) omega^2 k^2 + m omega^2 (rho I omega^2/S - 1) = 0 in k^2 of exp(kx)
        half = 0.5 * (m / shear + rotary / rigidity) * omega**2
        root = np.sqrt(half**2 + m * omega**2 * (1 - rotary * omega**2 / shear) / rigidity)
        growth += length * (np.sqrt(max(root - half, 0.0)) + np.sqrt(half + root))
    return growth / np.log(10)


def refined(case, guess, gap):
    posed = (case[0], case[1], case[2], [], "0", "0")
    mp.dps = 45 + int(1.2 * digits_lost(case, guess))
    a, b = mpf(guess) * (1 - mpf("1e-10")), mpf(guess) * (1 + mpf("1e-10"))
    fa, fb = determinant(a, posed), determinant(b, posed)
    for _ in range(12):
        c = b - fb * (b - a) / (fb - fa)
        if abs(c - b) < mpf("1e-26") * c:
            break
        a, fa, b, fb = b, fb, c, determinant(c, posed)
    below, above = (determinant(c * (1 + sign * mpf("1e-24")), posed) for sign in (-1, 1))
    assert (below > 0) != (above > 0), (case[0], guess)
    assert abs(c / mpf(guess) - 1) < 1e-4 * gap, (case[0], guess, c)
    return c


print("case,mode,omega_rad_s")
for case in CASES:
    omega = finite_elements(case)
    rigid = 1 if case[1] == ("free", "pinned") else 0
    for n in MODES:
        if n > rigid:
            gap = min(omega[n] - omega[n - 1], omega[n - 1] - omega[n - 2] if n > 1 else omega[0]) / omega[n - 1]
            print(f"{case[0]},{n},{nstr(refined(case, omega[n - 1], gap), 25)}", flush=True)
