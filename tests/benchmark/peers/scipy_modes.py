#!/usr/bin/python3
"""Ten lowest modes of the chains of bench_large by SciPy (Debian: python3-scipy), seconds of processor time.

eigsh in shift-invert about 0, matrices assembled beforehand; at 38 unknowns also scipy.linalg.eigh
(dsygvd, all modes). One line a figure, as bench_large prints them. Threads: OPENBLAS_NUM_THREADS=1.

    OPENBLAS_NUM_THREADS=1 /usr/bin/python3 tests/benchmark/peers/scipy_modes.py [sizes]
"""
import sys
import time

import numpy
import scipy.linalg
from scipy.sparse import diags, identity
from scipy.sparse.linalg import eigsh

INERTIA, STIFFNESS = 1.0, 1e6


def chain(n):
    """M and K of n inertias on n shafts, the first one to ground."""
    main = numpy.full(n, 2.0 * STIFFNESS)
    main[-1] = STIFFNESS
    side = numpy.full(n - 1, -STIFFNESS)
    return (INERTIA * identity(n, format="csc"), diags([side, main, side], [-1, 0, 1], format="csc"))


def median_seconds(call, repeats):
    times = []
    for _ in range(repeats):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return sorted(times)[repeats // 2]


def main():
    sizes = [int(float(a)) for a in sys.argv[1:]] or [38, 200, 2000, 20000, 200000, 1000000]
    for n in sizes:
        m, k = chain(n)
        exact = 2.0 * numpy.sqrt(STIFFNESS / INERTIA) * numpy.sin(
            (2 * numpy.arange(1, 11) - 1) * numpy.pi / (4.0 * n + 2.0))
        error = 0.0

        def lowest():
            nonlocal error
            found = eigsh(k, k=10, M=m, sigma=0.0, which="LM")[0]
            error = numpy.max(numpy.abs(numpy.sqrt(numpy.sort(found)) / exact - 1.0))

        repeats = 101 if n <= 200 else 11 if n <= 20000 else 3
        print("modes_scipy chain %d %.4g s" % (n, median_seconds(lowest, repeats)), flush=True)
        print("modes_scipy_error chain %d %.2g" % (n, error), flush=True)
        if n <= 200:
            dense_m, dense_k = m.toarray(), k.toarray()
            print("modes_scipy_dense chain %d %.4g s" % (n, median_seconds(
                lambda: scipy.linalg.eigh(dense_k, dense_m, driver="gvd"), repeats)), flush=True)


if __name__ == "__main__":
    main()
