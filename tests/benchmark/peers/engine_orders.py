"""Vibratory torque of a crankshaft over speed by openTorsion, as its example of a six-cylinder engine calls it.

  python3 engine_orders.py FILE

FILE: a line of inertias; of stiffnesses; of dampings of the shafts; of dampings to ground of the nodes; of the
speeds [rad/s]; of the orders; then for each order a line with the torque on each node, real and imaginary part.
Prints: processor time [s]; then for each speed the sum of the amplitudes in each shaft [N m].
"""
import sys
import time

import numpy as np
import opentorsion as ot

with open(sys.argv[1]) as file:
    lines = [np.array([float(word) for word in line.split()]) for line in file]
inertias, stiffnesses, dampings, ground, speeds, orders = lines[:6]
torque = np.array([line[0::2] + 1j * line[1::2] for line in lines[6:]])

shafts = [ot.Shaft(i, i + 1, None, None, k=k, I=0, c=c) for i, (k, c) in enumerate(zip(stiffnesses, dampings))]
disks = [ot.Disk(i, inertia, c=c) for i, (inertia, c) in enumerate(zip(inertias, ground))]
assembly = ot.Assembly(shafts, disk_elements=disks)

started = time.process_time()
sums = []
for speed in speeds:
    frequencies = orders * speed
    excitation = ot.PeriodicExcitation(assembly.dofs, frequencies)
    for node in range(len(inertias)):
        if np.any(torque[:, node]):
            excitation.add_sines(node, frequencies, np.abs(torque[:, node]), np.angle(torque[:, node]))
    sums.append(assembly.vibratory_torque(excitation)[1])
print(f"{time.process_time() - started:.6f}")
for row in sums:
    print(*(f"{value:.17g}" for value in row))
