#!/usr/bin/env python3
"""One free problem, two solvers, one run: a twisted clamped rod that sags under its weight, clear of the wall.

Ours (bench/compare_free, built by `make bench`) against scipy.integrate.solve_bvp on the explicit first-order form of the
same equations (II.2.48-53). Each solver is given the loosest tolerance with which its *true* error between nodes, against
the other's tightest solution, is below the target; then it is timed from a cold start and from the solution one per cent of the load away
(warm), best of several. Our cold time includes the search, the stability verdict and the certificate. The two tightest
solutions must agree ten times better than the target, so each program checks the other.

Exit code 0: compared; 1: the solutions disagree or a solver missed the target.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import time

import numpy as np
from scipy.integrate import solve_bvp

ETA2, NU, TENSION, TORQUE, WEIGHT = 1 / 400, 1 / 3, -5.0, 3.0, 20.0  # as in compare_free.cpp; L = B = 1
COLUMNS = ["delta1", "delta2", "F1", "F2", "F3", "M1", "M2"]
TOLERANCES = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11]


def rates(_, y):
    """Straight axis (U = 0), weight along -D2. Unknowns d1 d2 g1 g2 w1 w2 M3 phi F1 F2 F3."""
    d1, d2, g1, g2, w1, w2, m3, phi, f1, f2, f3 = y
    alpha = 1 + ETA2 * f3
    g3 = np.sqrt(1 - g1**2 - g2**2)
    q = 1 + g3
    j1 = alpha * g3
    k1 = (1 - g1**2 / q, -g1 * g2 / q)
    k2 = (-g1 * g2 / q, 1 - g2**2 / q)
    dg1 = (w2 * k1[0] - w1 * k2[0]) / j1
    dg2 = (w2 * k1[1] - w1 * k2[1]) / j1
    w3 = -j1 * (g1 * dg2 - dg1 * g2) / q
    s1, s2, s3 = -WEIGHT * k1[1], -WEIGHT * k2[1], -WEIGHT * g2
    return np.array([
        g1 / g3, g2 / g3, dg1, dg2,
        (-w2 * m3 + w3 * w2 + alpha * f2) / j1,
        (-w3 * w1 + w1 * m3 - alpha * f1) / j1,
        0 * m3,
        ((1 + NU) * m3 - w3) / j1,
        (-w2 * f3 + w3 * f2 - s1) / j1,
        (-w3 * f1 + w1 * f3 - s2) / j1,
        (-w1 * f2 + w2 * f1 - s3) / j1,
    ])


def ends_under(tension):
    return lambda a, b: np.array(
        [a[0], a[1], a[2], a[3], a[7], b[0], b[1], b[2], b[3], b[6] - TORQUE, b[10] - tension])


def solve_scipy(tolerance, tension=TENSION, start=None):
    if start is None:
        x = np.linspace(0, 1, 11)
        y = np.zeros((11, x.size))
        y[6], y[10] = TORQUE, tension
    else:
        x, y = start.x, start(start.x)
    began = time.perf_counter()
    result = solve_bvp(rates, ends_under(tension), x, y, tol=tolerance, max_nodes=200000)
    seconds = time.perf_counter() - began
    if not result.success:
        return None, seconds, 0
    return result.sol, seconds, result.x.size


def scipy_columns(sol, S):
    d1, d2, _, _, w1, w2, _, _, f1, f2, f3 = sol(S)
    return dict(zip(COLUMNS, (d1, d2, f1, f2, f3, w1, w2)))


def error(a, b):
    """Largest difference, each column in units of its own kind's largest value."""
    groups = (("delta1", "delta2"), ("F1", "F2", "F3"), ("M1", "M2"))
    return max(max(np.abs(a[c] - b[c]).max() for c in g) / max(np.abs(b[c]).max() for c in g) for g in groups)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build/bench"), help="build directory")
    parser.add_argument("--target", type=float, default=1e-8, help="true relative error that both must reach")
    parser.add_argument("--repeats", type=int, default=5, help="timed solves of SciPy; ours are ten times as many")
    a = parser.parse_args()

    def ours(tolerance, repeats):
        out = subprocess.run([a.build / "bench" / "compare_free", repr(tolerance), str(repeats)], check=True,
                             capture_output=True, text=True).stdout
        data = json.loads(out)
        return {c: np.array(data[c]) for c in ["S"] + COLUMNS}, (data["seconds"], data["warm_seconds"])

    finest, _ = ours(TOLERANCES[-1], 1)
    S = finest["S"]
    # SciPy's difference Jacobian stops it short of the tightest tolerances: its finest solution is the tightest it finds.
    sol = next((s for s in (solve_scipy(t)[0] for t in reversed(TOLERANCES)) if s is not None), None)
    if sol is None:
        sys.exit("SciPy did not solve the problem")
    reference = scipy_columns(sol, S)
    agreement = error(finest, reference)
    print(f"tightest solutions agree to {agreement:.1e} (relative, {S.size} points)")
    if agreement > a.target / 10:
        sys.exit("the two programs disagree: nothing to compare")

    for tolerance in TOLERANCES:
        fields, _ = ours(tolerance, 1)
        ours_error = error(fields, reference)
        if ours_error < a.target:
            _, ours_seconds = ours(tolerance, 10 * a.repeats)
            print(f"tendril: tolerance {tolerance:.0e}, true error {ours_error:.1e}, "
                  f"cold, certified {1e3 * ours_seconds[0]:.3f} ms, warm {1e3 * ours_seconds[1]:.3f} ms")
            break
    else:
        sys.exit("tendril missed the target")
    for tolerance in TOLERANCES:
        sol, seconds, nodes = solve_scipy(tolerance)
        if sol is not None and (scipy_error := error(scipy_columns(sol, S), finest)) < a.target:
            seconds = min([seconds] + [solve_scipy(tolerance)[1] for _ in range(a.repeats - 1)])
            near = solve_scipy(tolerance, TENSION / 1.01)[0]
            warm = min(solve_scipy(tolerance, TENSION, near)[1] for _ in range(a.repeats))
            print(f"SciPy:   tolerance {tolerance:.0e}, true error {scipy_error:.1e}, "
                  f"cold {1e3 * seconds:.1f} ms, warm {1e3 * warm:.1f} ms, {nodes} nodes")
            break
    else:
        sys.exit("SciPy missed the target")
    print(f"ratio SciPy/tendril: cold {seconds / ours_seconds[0]:.0f}, warm {warm / ours_seconds[1]:.0f}")


if __name__ == "__main__":
    main()
