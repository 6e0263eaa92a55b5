"""The Python package beside openTorsion and ROSS on their own examples, and what a call costs.

    PYTHONPATH=build/release/python build/venv/bin/python tests/benchmark/python_bench.py [--write]

Processor time, medians of runs by turns; building the models left out on both sides. --write puts the tables into
docs/performance.md. Frequencies are compared first: a ratio of times stands for equal results.
"""
import contextlib
import io
import os
import pathlib
import statistics
import subprocess
import sys
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import drev


def seconds(function, least=0.05):
    """Of one call, from as many as take `least`."""
    function()
    count, spent = 0, 0.0
    while spent < least:
        began = time.process_time()
        function()
        spent += time.process_time() - began
        count += 1
    return spent / count


def by_turns(mine, theirs, turns=5):
    pairs = [(seconds(mine), seconds(theirs)) for _ in range(turns)]
    return tuple(statistics.median(side) for side in zip(*pairs))


def drill_string(count):
    from opentorsion import Assembly, Disk, Shaft

    length, outer, inner, modulus, density = 800.0, 0.78, 0.65, 75e9, 8000
    m = drev.Model("drill string")
    m.add_nodes(*[f"n{i}" for i in range(count + 1)])
    m.add_inertia("top", "n0", inertia_kg_m2=200)
    m.add_inertia("bit", f"n{count}", inertia_kg_m2=10)
    for i in range(count):
        m.add_distributed_shaft(f"s{i}", [f"n{i}", f"n{i + 1}"], shear_modulus_Pa=modulus, density_kg_per_m3=density,
                                outer_diameter_m=outer, inner_diameter_m=inner, length_m=length / count)
    shafts = [Shaft(i, i + 1, 1e3 * length / count, 1e3 * outer, idl=1e3 * inner, G=modulus, rho=density)
              for i in range(count)]
    assembly = Assembly(shafts, disk_elements=[Disk(0, 200), Disk(count, 10)])

    def theirs():
        hz = assembly.modal_analysis()[0] / (2 * np.pi)
        return hz[::2][hz[::2] > 1e-2]

    return m, theirs


def geared_train():
    from opentorsion import Assembly, Disk, Gear, Shaft

    first = Gear(1, 200, 0.5)
    second = Gear(2, 200, 0.5, parent=first)
    gears = [first, second, Gear(3, 800, 0.8, parent=first), Gear(4, 800, 0.8, parent=second)]
    shafts = [Shaft(0, 1, 2.5e3, 0.2e3, G=68e9, rho=0), Shaft(3, 5, 3.5e3, 0.25e3, G=68e9, rho=0),
              Shaft(4, 6, 3.5e3, 0.25e3, G=68e9, rho=0)]
    assembly = Assembly(shafts, disk_elements=[Disk(0, 3200), Disk(5, 450), Disk(6, 450)], gear_elements=gears)
    m = drev.Model("geared train")
    m.add_nodes(*[f"n{i}" for i in range(7)])
    for node, inertia in ((0, 3200), (5, 450), (6, 450), (1, 200), (2, 200), (3, 800), (4, 800)):
        m.add_inertia(f"J{node}", f"n{node}", inertia_kg_m2=inertia)
    for shaft in shafts:
        m.add_shaft_spring(f"k{shaft.nl}", [f"n{shaft.nl}", f"n{shaft.nr}"], stiffness_Nm_per_rad=shaft.k)
    for a, b, ratio in ((1, 2, -1.0), (1, 3, -0.5 / 0.8), (2, 4, -0.5 / 0.8)):
        m.add_ideal_gear(f"g{b}", [f"n{a}", f"n{b}"], ratio=ratio)

    def theirs():
        hz = assembly.modal_analysis()[0] / (2 * np.pi)
        return hz[::2][hz[::2] > 1e-2]

    return m, theirs


def ross_rotor():
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        import ross
        from ross.utils import convert_6dof_to_torsional

        rotor = ross.rotor_example_6dof()
        torsional = convert_6dof_to_torsional(rotor)
    m = drev.Model("rotor_example_6dof")
    m.add_nodes(*[f"n{i}" for i in rotor.nodes])
    for i, e in enumerate(rotor.shaft_elements):
        m.add_distributed_shaft(f"s{i}", [f"n{e.n_l}", f"n{e.n_r}"], shear_modulus_Pa=e.material.G_s,
                                density_kg_per_m3=e.material.rho, outer_diameter_m=e.odl, inner_diameter_m=e.idl,
                                length_m=e.L)
    for i, d in enumerate(rotor.disk_elements):
        m.add_inertia(f"d{i}", f"n{d.n}", inertia_kg_m2=d.Ip)
    return m, lambda: np.sort(torsional.run_modal(0).wn) / (2 * np.pi)


def peers():
    rows = []
    cases = [("geared train (Friswell 9.6.3), 4 unknowns", "openTorsion", geared_train),
             ("drill string (Friswell 9.9), 51 unknowns", "openTorsion", lambda: drill_string(50)),
             ("drill string, 201 unknowns", "openTorsion", lambda: drill_string(200)),
             ("rotor_example_6dof, torsional part, 7 unknowns", "ROSS", ross_rotor)]
    for name, peer, make in cases:
        try:
            m, theirs = make()
        except ImportError as error:
            rows.append(f"| {name} | {peer} | left out: {error} | | | |")
            continue
        count = min(10, len(theirs()))
        system = m.build()
        mine = lambda: system.modes(count)
        off = np.max(np.abs(mine().frequency_Hz / theirs()[:count] - 1))
        assert off < 1e-5, (name, off)
        a, b = by_turns(mine, theirs)
        rows.append(f"| {name} | {peer} | {off:.0e} | {1e3 * a:.3g} | {1e3 * b:.3g} | {b / a:.2g} |")
    head = ["| modes of | peer | largest difference | drev [ms] | peer [ms] | peer : drev |", "|---|---|---|---|---|---|"]
    return head + rows


def python_seconds(code, turns=7):
    """User and system time of a process of its own, less that of an interpreter that does nothing."""
    def once(text):
        before = os.times()
        subprocess.run([sys.executable, "-c", text], check=True)
        after = os.times()
        return after.children_user + after.children_system - before.children_user - before.children_system

    return statistics.median(once(code) for _ in range(turns)) - statistics.median(once("pass") for _ in range(turns))


def costs():
    m = drev.Model("one node")
    m.add_node("a")
    m.add_inertia("J", "a", inertia_kg_m2=1.0)
    m.add_ground_spring("k", "a", stiffness_Nm_per_rad=100.0, damping_Nms_per_rad=0.1)
    system = m.build()
    z, v, out = np.array([0.1]), np.array([0.2]), np.empty(1)
    calls = range(20000)

    def force():
        for _ in calls:
            system.force(0.0, z, v, out)

    def nothing():
        for _ in calls:
            pass

    each = min(seconds(force, 0.2) - seconds(nothing, 0.02) for _ in range(5)) / len(calls)
    numpy_alone, both = python_seconds("import numpy"), python_seconds("import drev")
    return ["| what | processor time |", "|---|---|",
            f"| `import drev` | {both:.3f} s, of which NumPy {numpy_alone:.3f} s |",
            f"| `System.force` of one node, the call and the work | {1e6 * each:.2f} us |"]


def main():
    lines = peers() + [""] + costs()
    print("\n".join(lines))
    if sys.argv[1:] != ["--write"]:
        return
    page = pathlib.Path(__file__).resolve().parents[2] / "docs/performance.md"
    text = page.read_text(encoding="utf-8")
    begin, end = "<!-- python_bench.py -->\n", "<!-- end of python_bench.py -->"
    head, rest = text.split(begin)
    page.write_text(head + begin + "\n".join(lines) + "\n" + end + rest.split(end)[1], encoding="utf-8")


if __name__ == "__main__":
    main()
