"""Lowest modes of a chain by SciPy's eigsh in shift-invert.

  python3 modes.py FILE N COUNT SHIFT

FILE: inertias, K's diagonal and its lower neighbour (first entry unused), N doubles each. SHIFT
[(rad/s)^2]. Prints: processor time [s], then the frequencies [rad/s].
"""
import sys
import time

import numpy as np
from scipy.sparse import diags
from scipy.sparse.linalg import eigsh

path, n, count, shift = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), float(sys.argv[4])
inertia, main, low = np.fromfile(path).reshape(3, n)
K = diags([low[1:], main, low[1:]], [-1, 0, 1], format="csc")
M = diags(inertia, format="csc")
started = time.process_time()
values = eigsh(K, k=count, M=M, sigma=shift, which="LM")[0]
print(f"{time.process_time() - started:.6f}")
print(*(f"{w:.17g}" for w in np.sort(np.sqrt(values))))
