"""The quadratic programs of the work-precision report (EMOC's P_1) by DAQP, a dual active-set method written in C.

It has no tuning parameters: at every tolerance it ends with the same active set, and the solution is that of the
corresponding linear system.
"""

import time

import daqp
import numpy as np

BUDGET_S, MOST_RUNS = 0.15, 400


class Program:
    """`min x.H x/2` with diagonal `H`, subject to `rows x >= bounds`; the restitution is `x[0]`."""

    def __init__(self, path):
        lines = [line.split() for line in open(path)]
        self.name = lines[0][1]
        self.reference = float(lines[1][1]) / float(lines[1][2])
        self.hessian = np.diag([float(word) for word in lines[2][1:]])
        table = np.array([[float(word) for word in line] for line in lines[3:]])
        self.bounds, self.rows = np.ascontiguousarray(table[:, 0]), np.ascontiguousarray(table[:, 1:])

    def row(self):
        """A row of the report: least time of repeated solves, the first of which is a warm-up."""
        linear = np.zeros(len(self.hessian))
        above, kinds = np.full(len(self.bounds), 1e30), np.zeros(len(self.bounds), dtype=np.int32)
        begin, times = time.perf_counter(), []
        while len(times) < 2 or (time.perf_counter() - begin < BUDGET_S and len(times) <= MOST_RUNS):
            start = time.perf_counter()
            x, _, flag, told = daqp.solve(self.hessian, linear, self.rows, above, self.bounds, kinds)
            times.append(time.perf_counter() - start)
        head = [self.name, "P_1 by DAQP (active set)", "peer", "1.0"]
        if flag != 1:
            return [*head, "", "", "", "", "iterations", f"exit flag {flag}"]
        return [*head, "restitution", abs(x[0] - self.reference), min(times[1:]), told["iterations"], "iterations", "ok"]
