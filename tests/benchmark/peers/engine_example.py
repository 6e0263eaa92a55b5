"""openTorsion's example of a six-cylinder diesel (its repository, examples/ICE_example.py), in the same steps: the torque
of a cylinder from measured pressure at each speed, its Fourier components, the phases of the firing order, shafts
with a loss factor, vibratory torque by openTorsion.

  python3 engine_example.py PRESSURE PEAKS SPEED...

PRESSURE: angle [deg], pressure [MPa]; PEAKS: speed [rpm], pressure [MPa]; both with a header. SPEED: rpm.
As in the example: 500 angles with both ends of the cycle, so that its orders are 0.499, 0.998, ...; x'' by a series.
Otherwise: the curves are read once, in place of at each speed; a peak beyond the table's ends is the one at the end,
in place of an error.
Prints: processor time and time by the clock with the damping matrix summed up from the elements at each frequency, as the
example does [s]; both with it made of two matrices [s]; then for each speed the sum of the amplitudes in each shaft [N m].
"""
import sys
import time

import numpy as np
import opentorsion as ot

pressure, peaks = (np.loadtxt(name, delimiter=",", skiprows=1) for name in sys.argv[1:3])
speeds = np.array([float(word) for word in sys.argv[3:]])
LOSS_FACTOR, CYLINDERS, LINES = 0.035, range(2, 8), 25
inertias = [0.0170, 0.0090, 0.0467, 0.0327, 0.0467, 0.0467, 0.0327, 0.0487, 2.0750]
stiffnesses = [1.106e6, 1.631e6, 1.253e6, 1.253e6, 1.678e6, 1.253e6, 1.253e6, 1.976e6]
firing = np.array([0, 4, 2, 5, 1, 3]) * 2 / 3 * np.pi

shafts = [ot.Shaft(i, i + 1, None, None, k=k, I=0) for i, k in enumerate(stiffnesses)]
disks = [ot.Disk(i, inertia, c=2.0 if i in CYLINDERS else 0.0) for i, inertia in enumerate(inertias)]
assembly = ot.Assembly(shafts, disk_elements=disks)


def cylinder_torque(rpm):
    degrees = np.linspace(0, 720, 500)
    angle, speed = np.radians(degrees), 2 * np.pi * rpm / 60
    crank, rod, bore, mass = 0.137 / 2, 0.207, 0.105, 2.521
    ratio = crank / rod
    gas = np.interp(degrees, *pressure.T) / 15.2 * np.interp(rpm, *peaks.T) * 1e6 * np.pi * bore**2 / 4
    series = (np.cos(angle) + ratio * np.cos(2 * angle) - ratio**3 / 4 * np.cos(4 * angle)
              + 9 * ratio**5 / 128 * np.cos(6 * angle))
    swing = np.arcsin(ratio * np.sin(angle))
    return (gas - mass * crank * series * speed**2) * np.sin(angle + swing) / np.cos(swing) * crank, angle


def by_elements(omega):
    damping = np.zeros((assembly.dofs, assembly.dofs))
    for shaft in assembly.shaft_elements:
        ends = np.array([shaft.nl, shaft.nr])
        damping[np.ix_(ends, ends)] += LOSS_FACTOR / omega * shaft.K()
    for disk in assembly.disk_elements:
        damping[disk.node, disk.node] += np.ravel(disk.C())[0]
    return damping


stiffness, to_ground = assembly.K, np.diag([np.ravel(disk.C())[0] for disk in disks])


def by_matrices(omega):
    return LOSS_FACTOR / omega * stiffness + to_ground


def response(rpm, damping):
    torque, angle = cylinder_torque(rpm)
    lines = np.fft.rfft(torque)[1:LINES] * 2 / len(torque)
    orders = np.fft.rfftfreq(len(torque))[1:LINES] / (angle[1] - angle[0]) * 2 * np.pi
    omegas = orders * rpm * 2 * np.pi / 60
    excitation = ot.PeriodicExcitation(assembly.dofs, omegas)
    for node in CYLINDERS:
        excitation.add_sines(node, omegas, np.abs(lines), np.angle(lines) + firing[node - 2] * orders)
    return assembly.vibratory_torque(excitation, C_func=damping)[1]


for damping in (by_elements, by_matrices):
    started, clock = time.process_time(), time.perf_counter()
    sums = [response(rpm, damping) for rpm in speeds]
    print(f"{time.process_time() - started:.6f} {time.perf_counter() - clock:.6f}")
for row in sums:
    print(*(f"{value:.17g}" for value in row))
