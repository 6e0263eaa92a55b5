"""The lowest modes of K x = omega^2 M x by SciPy's eigsh in shift-invert; arguments: matrices, shift, count.

Prints processor time without reading [s], peak memory [MB], and the elastic frequencies [Hz].
"""
import resource
import sys
import time

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import eigsh

path, shift, count = sys.argv[1], float(sys.argv[2]), int(sys.argv[3])
with open(path, "rb") as file:
    n, entries = np.fromfile(file, dtype=np.int64, count=2)
    outer = np.fromfile(file, dtype=np.int32, count=n + 1)
    inner = np.fromfile(file, dtype=np.int32, count=entries)
    stiffness = sparse.csc_matrix((np.fromfile(file, dtype=float, count=entries), inner, outer), shape=(n, n))
    mass = sparse.csc_matrix((np.fromfile(file, dtype=float, count=entries), inner, outer), shape=(n, n))
start = time.process_time()
values = eigsh(stiffness, count + 1, mass, sigma=shift, tol=1e-9, return_eigenvectors=False)
seconds = time.process_time() - start
frequencies = np.sqrt(np.sort(np.abs(values)))[1:] / (2 * np.pi)
print(seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, *frequencies)
