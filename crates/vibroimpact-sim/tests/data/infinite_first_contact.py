"""Reference values for the first contact with an infinite beam, in 25-digit arithmetic.

    x(t) = t - int_0^t [(t-s) + sqrt(t-s)] sqrt(S) max(x,0)^(3/2) ds

One global panel t = D sin^2(pi phi / 2), phi in (0, 1), with n Gauss-Legendre nodes for the force;
the duration D by Newton's method on x(D) = 0. Prints S, D and the rebound ratio (minus the speed
of the body after the contact) as CSV, each for two numbers of nodes to show what is converged.
Needs mpmath (pip install mpmath). Run: python3 infinite_first_contact.py > infinite_first_contact.csv
"""
from mpmath import mp, mpf, sqrt, sin, cos, asin, pi, matrix, lu_solve
import mpmath

mp.dps = 25


def gauss(n):
    """Gauss-Legendre rule on (0, 1)."""
    out = []
    for i in range(n):
        x = mpmath.cos(pi * (mpf(i) + mpf(3) / 4) / (n + mpf(1) / 2))
        for _ in range(100):
            p0, p1 = mpf(1), x
            for k in range(2, n + 1):
                p0, p1 = p1, ((2 * k - 1) * x * p1 - (k - 1) * p0) / k
            d = n * (x * p1 - p0) / (x * x - 1)
            step = p1 / d
            x -= step
            if abs(step) < mpf(10) ** (-23):
                break
        out.append(((1 + x) / 2, 1 / ((1 - x * x) * d * d)))
    return sorted(out)


class Rule:
    """Product integration of the two kernels for a contact of unit duration."""

    def __init__(self, n):
        self.n = n
        nodes = gauss(n)
        self.phi = [p for p, _ in nodes]
        quad = gauss(6 * n)
        bary = []
        for j in range(n):
            b = mpf(1)
            for k in range(n):
                if k != j:
                    b *= 2 * (self.phi[j] - self.phi[k])
            bary.append(1 / b)
        self.t, self.rows = [], []
        for a_phi in self.phi + [mpf(1)]:
            sa = sin(pi * a_phi / 2)
            row = [mpf(0)] * n, [mpf(0)] * n
            for y, w in quad:
                th = pi * y / 2
                st, ct = sin(th), cos(th)
                psi = 2 / pi * asin(min(sa * st, mpf(1)))
                ds = w * pi / 2 * 2 * sa * sa * st * ct
                lag = (sa * ct) ** 2
                terms = [b / (psi - p) for b, p in zip(bary, self.phi)]
                total = sum(terms)
                for j in range(n):
                    value = terms[j] / total * ds
                    row[0][j] += value * lag
                    row[1][j] += value * sqrt(lag)
            self.t.append(sa * sa)
            self.rows.append(row)
        self.mass = [w * pi * sin(pi * p / 2) * cos(pi * p / 2) for p, w in nodes]


def contact(rule, S):
    n, root = rule.n, sqrt(mpf(S))
    # natural time: sqrt(S) (w^(5/2) + w^2) = 1
    lo, hi = mpf("1e-6"), mpf("1e6")
    for _ in range(80):
        mid = sqrt(lo * hi)
        lo, hi = (mid, hi) if root * (mid ** mpf("2.5") + mid ** 2) < 1 else (lo, mid)
    D = 4 * lo
    x = [lo * sin(pi * p) for p in rule.phi]

    def solve(D, x):
        for _ in range(60):
            f = [root * max(v, 0) ** mpf("1.5") for v in x]
            df = [mpf("1.5") * root * sqrt(max(v, 0)) for v in x]
            A, r = matrix(n, n), matrix(n, 1)
            for i in range(n):
                lin, mem = rule.rows[i]
                w = [D ** 2 * lin[j] + D ** mpf("1.5") * mem[j] for j in range(n)]
                r[i] = D * rule.t[i] - x[i] - sum(a * b for a, b in zip(w, f))
                for j in range(n):
                    A[i, j] = w[j] * df[j]
                A[i, i] += 1
            s = lu_solve(A, r)
            x = [a + b for a, b in zip(x, s)]
            if max(abs(v) for v in s) < mpf(10) ** (-20) * lo:
                break
        f = [root * max(v, 0) ** mpf("1.5") for v in x]
        lin, mem = rule.rows[n]
        end = D - sum((D ** 2 * a + D ** mpf("1.5") * b) * g for a, b, g in zip(lin, mem, f))
        return x, end, D * sum(a * b for a, b in zip(rule.mass, f)) - 1

    D0, (x, e0, u) = D, solve(D, x)
    D1 = D * mpf("0.98")
    x, e1, u = solve(D1, x)
    for _ in range(40):
        D2 = D1 - e1 * (D1 - D0) / (e1 - e0)
        D2 = max(min(D2, mpf("1.2") * D1), mpf("0.8") * D1)
        (D0, e0), D1 = (D1, e1), D2
        x, e1, u = solve(D1, x)
        if abs(D1 - D0) < mpf(10) ** (-18) * D1:
            break
    return D1, u


if __name__ == "__main__":
    print("s,nodes,duration,rebound_ratio")
    rules = [Rule(28), Rule(36)]
    for S in ["1e-10", "1e-3", "1", "1.5", "15", "1e3"]:
        for rule in rules:
            D, u = contact(rule, S)
            print(f"{S},{rule.n},{mpmath.nstr(D, 18)},{mpmath.nstr(u, 18)}", flush=True)
