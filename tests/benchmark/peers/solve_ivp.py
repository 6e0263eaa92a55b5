"""The held camshaft by SciPy's solve_ivp.

  python3 solve_ivp.py FOLDER METHOD RTOL DURATION

FOLDER as peer_files.hpp writes it. Prints: processor time [s], steps, evaluations, then time [s] and angle
[rad] of the free end at the end of each step. Unknowns by station, z and z', so that LSODA's Jacobian is
banded. Absolute tolerances as the other peers have them (chain.hpp).
"""
import sys
import time

import numpy as np
from scipy.integrate import solve_ivp

folder, method, rtol, duration = sys.argv[1], sys.argv[2], float(sys.argv[3]), float(sys.argv[4])


def read(name):
    return np.loadtxt(f"{folder}/{name}.txt", ndmin=2)


inertia = np.diag(read("M"))
n = inertia.size
K = read("K") / inertia[:, None]
C = np.diag(read("C")) / inertia
main, low, up = np.diag(K).copy(), np.diag(K, -1).copy(), np.diag(K, 1).copy()
tables, loads, (omega, end) = read("tables"), read("loads"), read("run").ravel()
knots = tables.shape[0]
rows, phase = loads[:, 0].astype(int) - 1, loads[:, 2]
first = (loads[:, 1].astype(int) - 1) * knots
value = tables.T.ravel()
rise = (np.roll(tables, -1, axis=0) - tables).T.ravel()
share = 1.0 / inertia[rows]


def motion(t, y):
    dy = np.empty_like(y)
    z, v, a = y[0::2], y[1::2], dy[1::2]
    dy[0::2] = v
    a[:] = -main * z - C * v
    a[1:] -= low * z[:-1]
    a[:-1] -= up * z[1:]
    x = ((omega * t + phase + z[rows]) * (knots / (2 * np.pi))) % knots
    k = x.astype(int)
    entry = first + np.minimum(k, knots - 1)
    a[rows] += share * (value[entry] + rise[entry] * (x - k))
    return dy


options = {"lband": 3, "uband": 3} if method == "LSODA" else {}
atol = np.tile([1e-2 * rtol, rtol], n)
started = time.process_time()
run = solve_ivp(motion, (0.0, duration), np.zeros(2 * n), method=method, rtol=rtol, atol=atol, **options)
seconds = time.process_time() - started
if not run.success:
    sys.exit(run.message)
print(f"{seconds:.6f} {run.t.size - 1} {run.nfev}")
for t, angle in zip(run.t[1:], run.y[2 * (int(end) - 1), 1:]):
    print(f"{t:.17g} {angle:.17g}")
