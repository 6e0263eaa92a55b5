"""While a run goes on: Ctrl-C, progress, threads, Python callables; and what errors leave behind."""
import os
import signal
import subprocess
import sys
import threading
import time
import warnings

import numpy as np
import pytest
from conftest import swinging, two_masses

import drev

warnings.simplefilter("ignore", drev.SlowWarning)


def press_ctrl_c(*_):
    os.kill(os.getpid(), signal.SIGINT)


def test_ctrl_c_keeps_what_there_is():
    with pytest.raises(drev.Interrupted) as caught:
        swinging().run(duration_s=1e5, every_s=1.0, progress=press_ctrl_c)
    run = caught.value.result
    assert run.status == "interrupted" and 0 < run.t_end < 1e5
    assert len(run.time) >= run.t_end and drev.last_interrupted() is run
    assert isinstance(caught.value, KeyboardInterrupt)
    assert swinging().run(duration_s=0.01).ok  # the next run is not interrupted


def test_ctrl_c_inside_a_callable():
    m = two_masses()

    pressed = []

    def law(x, rate, t):
        if t > 0.05 and not pressed:
            pressed.append(t)
            press_ctrl_c()
        return 0.0, 0.0, 0.0

    m.add_law("law", ["motor", "load"], law)
    with pytest.raises(drev.Interrupted) as caught:
        m.run(duration_s=10.0, method="average_acceleration", step_s=1e-4)
    run = caught.value.result
    assert run.status == "interrupted" and 0.04 < run.t_end < 1.0 and len(run.time) > 1


def test_ctrl_c_ends_a_study_and_keeps_its_runs():
    m = swinging()
    m.add_parameter("count", 1, min=0, max=1e6, whole=True)
    with pytest.raises(drev.Interrupted, match="runs have ended") as caught:
        m.vary({"count": "1:1:1000"}, jobs=2, duration_s=200.0, every_s=0.1, progress=press_ctrl_c)
    variants = caught.value.result
    ended = [v for v in variants if v.run is not None and v.run.ok]
    assert len(variants) == 1000 and 0 <= len(ended) < 1000 and variants[-1].run is None


def test_memory_of_runs_is_freed():
    resource = pytest.importorskip("resource")
    m = swinging()

    def peak_after(runs):
        for _ in range(runs):
            m.run(duration_s=0.2, every_s=1e-5)  # 20,001 rows, 5 channels: a megabyte
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    before = peak_after(5)
    assert peak_after(40) - before < 10_000  # kB


def test_signal_handlers_of_python_are_kept():
    class Mine(Exception):
        pass

    def handler(*_):
        raise Mine

    before = signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(Mine):
            swinging().run(duration_s=1e5, every_s=1.0)
    finally:
        signal.signal(signal.SIGALRM, before)


def test_progress_is_told():
    seen = []
    m = swinging()
    m.run(duration_s=500.0, every_s=1.0, progress=lambda part, left: seen.append((part, left)))
    assert seen and all(0 < part <= 1 for part, _ in seen) and seen == sorted(seen, key=lambda s: s[0])

    def fails(part, left):
        raise RuntimeError("no more")

    with pytest.raises(RuntimeError, match="no more"):
        m.run(duration_s=500.0, every_s=1.0, progress=fails)


def test_a_notebook_gets_a_bar(monkeypatch):
    display = pytest.importorskip("IPython.display")
    shown = []

    class Handle:
        def update(self, bar):
            shown.append(bar.data)

    def remember(bar, display_id):
        shown.append(bar.data)
        return Handle()

    from drev._progress import NotebookBar

    monkeypatch.setattr(display, "display", remember)
    bar = NotebookBar()
    bar(0.1, 0.5)  # nothing for what ends at once
    assert shown == []
    bar(0.25, 120.0)
    bar(0.5, 80.0)
    bar.close()
    assert ["25.0%, 2 min left" in shown[0], "50.0%, 80 s left" in shown[1], shown[2]] == [True, True, ""]


def test_threads_run_side_by_side_and_python_goes_on():
    results, ticks = {}, 0

    def work(k):
        results[k] = swinging(stiffness=1000.0 * (k + 1)).run(duration_s=100.0, every_s=0.1)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(2)]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        ticks += 1
        time.sleep(0.001)
    assert ticks > 5  # the interpreter's lock was free
    for k in range(2):
        alone = swinging(stiffness=1000.0 * (k + 1)).run(duration_s=100.0, every_s=0.1)
        for channel in alone.channels:
            assert np.array_equal(results[k][channel], alone[channel])


def cubic(**more):
    m = drev.Model("cubic")
    m.add_nodes("a", "b")
    m.add_inertia("J_a", "a", inertia_kg_m2=1.0)
    m.add_inertia("J_b", "b", inertia_kg_m2=2.0)
    m.set_initial("a", angle_rad=0.1)
    m.add_law("k", ["a", "b"], **more)
    return m


def test_a_law_in_python_keeps_its_energy():
    with_slopes = cubic(
        torque=lambda x, rate, t: (1e3 * x + 1e6 * x**3, 1e3 + 3e6 * x**2, 0.0),
        energy=lambda x: 500 * x**2 + 2.5e5 * x**4,
    ).run(duration_s=0.3)
    plain = cubic(torque=lambda x, rate, t: 1e3 * x + 1e6 * x**3).run(duration_s=0.3)
    assert with_slopes.ok and plain.ok
    assert abs(with_slopes.summary["energy_error"]) < 1e-9 and abs(plain.summary["energy_error"]) < 1e-9
    assert np.max(np.abs(with_slopes["a.angle_rad"] - plain["a.angle_rad"])) < 1e-12
    # Deepest twist from the energy: 500 x^2 + 2.5e5 x^4 is all there is.
    assert with_slopes.figures["max_torque_Nm"].value == pytest.approx(1e3 * 0.1 + 1e6 * 0.1**3, rel=1e-9)
    # A step scheme of another family finds the same motion.
    stepped = cubic(torque=lambda x, rate, t: 1e3 * x + 1e6 * x**3).run(
        duration_s=0.02, method="sdirk4", tolerance=1e-9
    )
    short = cubic(torque=lambda x, rate, t: 1e3 * x + 1e6 * x**3).run(duration_s=0.02)
    assert abs(stepped["a.angle_rad"][-1] - short["a.angle_rad"][-1]) < 1e-6


def test_an_energy_that_is_not_that_of_the_law_is_noticed():
    with pytest.warns(drev.NotTrustedWarning):
        run = cubic(torque=lambda x, rate, t: (1e3 * x, 1e3, 0.0), energy=lambda x: 50 * x**2).run(duration_s=0.3)
    assert run.status == "energy_error"


def test_loads_in_python():
    m = drev.Model("loads")
    m.add_nodes("time", "motion")
    m.add_inertia("J_1", "time", inertia_kg_m2=2.0)
    m.add_inertia("J_2", "motion", inertia_kg_m2=2.0)
    m.set_initial("motion", angle_rad=1.0)
    m.add_load("of time", "time", lambda t: np.sin(3 * t))
    m.add_load("of motion", "motion", lambda t, angle, speed: -8 * angle)
    run = m.run(duration_s=1.0, record=["time.angle_rad", "motion.angle_rad"])
    t = run.time
    assert np.max(np.abs(run["time.angle_rad"] - (t / 6 - np.sin(3 * t) / 18))) < 1e-10
    assert np.max(np.abs(run["motion.angle_rad"] - np.cos(2 * t))) < 1e-9
    step = drev.Model("step")
    step.add_node("a")
    step.add_inertia("J", "a", inertia_kg_m2=1.0)
    step.add_load("p", "a", lambda t: 1.0 if t >= 0.3 else 0.0, breakpoints_s=[0.3])
    assert step.run(duration_s=1.0)["a.angle_rad"][-1] == pytest.approx(0.5 * 0.7**2, rel=1e-9)


def test_callables_that_fail():
    with pytest.raises(ZeroDivisionError):
        cubic(torque=lambda x, rate, t: 1 / 0).run()
    with pytest.raises(drev.SolverError, match=r"law 'k': its Python callable returned nan at \(-0.1, 0, 0\)"):
        cubic(torque=lambda x, rate, t: float("nan")).run()
    with pytest.raises(TypeError, match="law 'k'.*must return a number.*not None"):
        cubic(torque=lambda x, rate, t: None).modes()
    with pytest.raises(TypeError, match="positional argument"):
        cubic(torque=lambda x: x).run()
    with pytest.raises(TypeError, match="must be callable, not 3"):
        cubic(torque=3)
    with pytest.raises(drev.ModelError, match="cannot be written as a file"):
        cubic(torque=lambda x, rate, t: x).to_toml()

    def late(x, rate, t):
        if t > 0.1:
            raise KeyError("late")
        return 1e3 * x

    with pytest.raises(KeyError, match="late"):
        cubic(torque=late).run(duration_s=1.0)


def test_callables_live_as_long_as_what_uses_them(monkeypatch):
    system = cubic(torque=lambda x, rate, t: 5.0 * x).build()
    assert system.force(0.0, np.array([0.1, 0.0]), np.zeros(2))[0] == pytest.approx(-0.5)
    with pytest.warns(drev.SlowWarning):
        monkeypatch.setattr("drev._model._slow_was_said", False)
        cubic(torque=lambda x, rate, t: x)


def test_a_run_that_fails_says_so_and_keeps_what_there_is():
    case = drev.load("two_mass_backlash", k_1_N_per_m=2e8, k_2_N_per_m=2e8)
    with pytest.raises(drev.SolverError, match="two_mass_backlash: unstable: ") as caught:
        case.run(step_s=1e-3)
    run = caught.value.result
    assert run.status == "unstable" and not run.ok and 0 < len(run.time) < 10001


def test_an_energy_balance_that_is_off_warns():
    with pytest.warns(drev.NotTrustedWarning):
        run = drev.load("gear_drive").run(method="average_acceleration", step_s=0.1, duration_s=0.2)
    assert run.status == "energy_error" and not run.ok and len(run.time) > 100


def test_a_start_that_is_no_steady_state_warns():
    # A disc rattles in a wide gap without ever repeating.
    m = drev.Model("rattle")
    m.add_node("motor", constant_speed_rad_per_s=100)
    m.add_node("disc")
    m.add_inertia("J", "disc", inertia_kg_m2=2)
    m.add_parameter("gap_rad", 0.02)
    teeth = {"stiffness_Nm_per_rad": 2e5, "gap_rad": "gap_rad", "damping_Nms_per_rad": 20}
    m.add_dead_band_coupling("teeth", ["motor", "disc"], **teeth)
    harmonics = {"order": [1], "amplitude_Nm": [500]}
    m.add_engine_order_torque("load", "disc", mean_Nm=20, twist_feedback=False, harmonics=harmonics)
    m.set_run(duration_s=0.1, start="periodic")
    with pytest.warns(drev.NotTrustedWarning, match="rattle: the run does not start in a periodic steady state") as said:
        assert m.run().ok
    assert said[0].filename == __file__
    with pytest.warns(drev.NotTrustedWarning, match="does not start in a periodic steady state"):
        best = m.optimise({"gap_rad": [0, 0.02]}, maximise="max_torque_Nm")
    assert not best.certain


def test_files_that_cannot_be_written():
    with pytest.raises(drev.OutputError):
        swinging().run(duration_s=0.1, out="/proc/nothing")


def test_the_interpreter_ends_without_a_word(tmp_path):
    code = """
import drev, numpy as np
m = drev.Model("m"); m.add_node("a"); m.add_inertia("J", "a", inertia_kg_m2=1.0)
m.add_law("k", "a", lambda x, v, t: x)
run = m.run(duration_s=0.1); array = run.time; system = m.build()
m.cycle = m
"""
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", code], capture_output=True, text=True)
    assert done.returncode == 0 and done.stderr == "" and done.stdout == ""


def chain(discs):
    """Discs on a row of shafts, excited in the first order: for computations that take long."""
    m = drev.Model("chain")
    m.add_node("n_0", nominal_speed_rpm=600)
    for i in range(discs):
        if i > 0:
            m.add_node(f"n_{i}")
            m.add_shaft_spring(f"s_{i}", [f"n_{i - 1}", f"n_{i}"], stiffness_Nm_per_rad=1e5, damping_Nms_per_rad=1.0)
        m.add_inertia(f"J_{i}", f"n_{i}", inertia_kg_m2=0.1 + 0.001 * i)
    return m


@pytest.mark.parametrize("asked", ["sweep", "campbell", "damped_modes", "advise"])
def test_ctrl_c_is_answered_promptly(asked):
    timer = threading.Timer(0.5, press_ctrl_c)
    backlash = drev.load("gear_drive")
    m = chain(300)
    speeds = [100 + 0.01 * i for i in range(30000)]
    ask = {"sweep": lambda: m.sweep(speeds_rpm=speeds, record=["s_1.torque_Nm"]),
           "campbell": lambda: m.campbell(speeds_rpm=speeds, record=["s_1.torque_Nm"]),
           "damped_modes": lambda: chain(700).damped_modes(),
           "advise": lambda: backlash.advise(within=1e-4)}[asked]
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            ask()
            timer.join()  # it was faster than the timer
            time.sleep(1)
    finally:
        timer.cancel()


def test_a_program_ends_in_order_behind_an_interrupted_computation():
    code = """
import os, signal, sys, threading
import drev
from test_control import chain
threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    chain(700).damped_modes()
except KeyboardInterrupt:
    print("interrupted")
sys.exit(3)
"""
    for _ in range(4):
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                              env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)})
        assert (done.returncode, done.stdout, done.stderr) == (3, "interrupted\n", "")
