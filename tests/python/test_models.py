"""Models made in Python: what they compute, against closed forms and against the command on the same file."""
import json
import math
import subprocess
import sys

import numpy as np
import pytest
from conftest import OMEGA, swinging, two_masses

import drev


def test_two_masses_swing_as_the_closed_form_says():
    assert two_masses().modes().frequency_Hz[0] == pytest.approx(OMEGA / (2 * math.pi), rel=1e-12)
    run = swinging().run(duration_s=0.5, every_s=1e-3, record=["motor-load.twist_rad", "shaft.torque_Nm"])
    twist = 0.01 * np.cos(OMEGA * run.time)
    assert np.max(np.abs(run["motor-load.twist_rad"] - twist)) < 1e-11
    assert np.max(np.abs(run["shaft.torque_Nm"] + 8500 * twist)) < 1e-7
    assert len(run.time) == 501 and run.time[-1] == 0.5


def test_every_unit_of_a_key():
    m = two_masses()
    m.add_shaft_spring("second", ["motor", "load"], stiffness_kNm_per_rad=8.5)
    assert m.modes().frequency_Hz[0] == pytest.approx(math.sqrt(2) * OMEGA / (2 * math.pi), rel=1e-12)


def test_a_python_model_runs_as_its_file_does_in_the_command(tmp_path, drev_command):
    m = swinging(damping=0.5)
    m.set_run(duration_s=0.3, record=["shaft.torque_Nm"])
    file = tmp_path / "m.toml"
    file.write_text(m.source)
    printed = subprocess.run([drev_command, "run", file, "--out", tmp_path / "out", "--json"], capture_output=True)
    expected = json.loads(printed.stdout)
    run = m.run()
    theirs = expected["results"]
    # The command's report looks at other times beside the history's: steps end there, which moves rounding.
    assert run.summary["results"]["max_torque_Nm"] == pytest.approx(theirs["max_torque_Nm"], rel=1e-13)
    assert run.summary["results"]["frequencies_Hz"] == theirs["frequencies_Hz"]
    assert run.summary["method_reason"] == expected["method_reason"]
    rows = np.loadtxt(tmp_path / "out" / "history.csv", delimiter=",", skiprows=1)
    assert len(run.time) == len(rows) and np.max(np.abs(run.time - rows[:, 0])) < 1e-14
    assert np.max(np.abs(run["shaft.torque_Nm"] - rows[:, 1])) < 1e-10
    m.save(tmp_path / "saved.toml")
    assert np.array_equal(drev.load(tmp_path / "saved.toml").run()["shaft.torque_Nm"], run["shaft.torque_Nm"])


def test_parameters_expressions_tables_and_runs():
    m = drev.Model("all of it", summary="s", note="n")
    m.add_parameter("k_Nm_per_rad", 100.0, min=1, max=1e6, meaning="stiffness")
    m.add_list("factors", [1, 2, 3])
    m.add_table("pulse", {"time_s": np.array([0.0, 1.0, 1.0]), "torque_Nm": [3.0, 3.0, 0.0]})
    m.add_node("wall")
    m.hold("wall")
    m.add_node("disc")
    m.add_inertia("J", "disc", inertia_kg_m2=1.0)
    m.add_shaft_spring("k", ("wall", "disc"), stiffness_Nm_per_rad="factors[2] * k_Nm_per_rad")
    m.add_applied_torque("p", "disc", table="pulse")
    m.set_run(duration_s=0.1)
    m.set_run("long", duration_s=2, parameters={"k_Nm_per_rad": 50})
    hz = lambda k: pytest.approx(math.sqrt(2 * k) / (2 * math.pi), rel=1e-12)
    assert m.modes().frequency_Hz[0] == hz(100)
    assert m.set(k_Nm_per_rad=400).modes().frequency_Hz[0] == hz(400)
    assert m.modes().frequency_Hz[0] == hz(100)
    assert m.run(run="long").summary["parameters"] == {"k_Nm_per_rad": 50.0}
    assert m.run(run="long").t_end == 2.0
    assert m.run(parameters={"k_Nm_per_rad": 7}).summary["parameters"]["k_Nm_per_rad"] == 7
    assert m.parameters["k_Nm_per_rad"]["meaning"] == "stiffness"
    assert "disc.angle_rad" in m.channels


def test_every_kind_of_node_motion():
    m = drev.Model("motions")
    m.add_node("shaft", constant_speed_rpm=60)
    m.add_node("free")
    m.add_node("shaker", kind="translational")
    m.given_motion("shaker", amplitude_mm=2, frequency_Hz=5)
    m.add_node("mass", kind="translational")
    m.set_initial("mass", position_mm=3, velocity_m_per_s=0.5)
    m.add_inertia("J", "free", inertia_kg_m2=1)
    m.add_shaft_spring("a", ["shaft", "free"], stiffness_Nm_per_rad=1)
    m.add_inertia("m", "mass", mass_kg=1)
    m.add_shaft_spring("b", ["shaker", "mass"], stiffness_N_per_mm=1)
    run = m.run(duration_s=0.2, record=["shaker.position_m", "mass.velocity_m_per_s"])
    assert np.allclose(run["shaker.position_m"], 0.002 * np.cos(10 * np.pi * run.time), atol=1e-15)
    assert run["mass.velocity_m_per_s"][0] == 0.5
    n = drev.Model("reference")
    n.add_node("end")
    n.run_up("end", speed_0_rpm=0, speed_1_rpm=60, time_0_s=0, time_1_s=1)
    n.add_inertia("J", "end", inertia_kg_m2=1)
    assert n.run(duration_s=0.1).ok
    o = drev.Model("reference")
    o.add_node("end")
    o.set_reference("end", speed_rpm=60)
    o.add_inertia("J", "end", inertia_kg_m2=1)
    assert o.run(duration_s=0.1).ok


def test_a_mistyped_node_is_no_new_one():
    m = drev.Model("train")
    m.add_node("engine")
    m.add_inertia("J", "engine", inertia_kg_m2=1)
    m.set_initial("engin", angle_rad=0.1)
    with pytest.raises(drev.ModelError, match="node = engin, is no node of this model; did you mean 'engine'"):
        m.modes()


def test_everything_wrong_is_said_at_once():
    m = drev.Model("bad")
    m.add_nodes("a", "b", "a")
    m.add_inertia("J", "a", inertia_kg=3)
    m.add_shaft_spring("K", ["a", "bb"], stiffnes_Nm_per_rad=4, damping_Nms_per_rad=1)
    with pytest.raises(drev.ModelError) as caught:
        m.modes()
    texts = [str(f) for f in caught.value.findings]
    assert len(texts) == 4
    assert "node = a, is there already" in texts[0]
    assert "J.inertia_kg" in texts[1] and "inertia_kg_m2" in texts[1]
    assert '"bb" is none of the nodes; did you mean \'b\'' in texts[2]
    assert "did you mean 'stiffness_Nm_per_rad'" in texts[3]
    assert all(text in str(caught.value) for text in texts)
    assert isinstance(caught.value, ValueError)


def test_ranges_name_element_value_and_unit():
    m = two_masses(damping=-1.0)
    with pytest.raises(drev.ModelError) as caught:
        m.run()
    (finding,) = caught.value.findings
    assert finding == ("two masses/shaft", "damping", "-1", "N m s/rad", "must be >= 0 and finite")


def test_arguments_that_cannot_be():
    m = two_masses()
    with pytest.raises(TypeError, match="did you mean 'tolerance'"):
        m.run(tolerence=1e-9)
    with pytest.raises(TypeError, match="duration_s"):
        m.run(duration_ms=3)
    with pytest.raises(TypeError, match="step_s must be a number"):
        m.run(step_s=object())
    with pytest.raises(TypeError, match="record must be a text or a sequence"):
        m.run(record=3)
    with pytest.raises(drev.ModelError) as caught:
        m.run(duration_s=-3, method="exakt", record=["shft.torque_Nm"])
    texts = [str(f) for f in caught.value.findings]
    assert texts[0].startswith("arguments: duration_s = -3 s, must be between")
    assert texts[1].startswith("arguments: method name = exakt, is no method; did you mean 'exact'")
    assert "did you mean 'shaft.torque_Nm'" in texts[2]
    with pytest.raises(drev.ModelError, match="accuracy, which finds it"):
        m.run(accuracy=1e-6, step_s=1e-3)
    with pytest.raises(TypeError, match="object is no number"):
        m.add_node("x", hold=object())
    with pytest.raises(drev.ModelError, match="did you mean 'camshaft'"):
        drev.load("camshft")
    with pytest.raises(drev.ModelError, match="there is no such file"):
        drev.load("nowhere.toml")


def turned_by(torque):
    m = drev.Model("turned")
    m.add_node("a")
    m.add_inertia("J", "a", inertia_kg_m2=1.0)
    m.add_applied_torque("q", "a", table={"time_s": [0, 1], "torque_Nm": torque})
    return m


@pytest.mark.parametrize("torque", [[0.0, 1.0], np.array([0.0, 1.0])])
def test_a_model_keeps_what_it_was_given(torque):
    m = turned_by(torque)
    m.add_list("l", torque)
    ends, record = ["a", "b"], ["a.angle_rad"]
    m.add_node("b")
    m.add_inertia("J_b", "b", inertia_kg_m2=1.0)
    m.add_shaft_spring("s", ends, stiffness_Nm_per_rad=100)
    m.set_run(record=record)
    before = m.source
    torque[1], ends[1], record[0] = 5.0, "c", "b.angle_rad"
    assert m.source == before


def test_a_table_with_a_gap_names_the_key():
    with pytest.raises(drev.ModelError) as refused:
        turned_by(np.array([0.0, np.nan])).check()
    assert [f.range for f in refused.value.findings] == ["must be finite, not NaN"]
    with pytest.raises(TypeError, match=r"q\.table\.torque_Nm: entries are masked"):
        turned_by(np.ma.masked_array([0.0, 1.0], [False, True]))
    assert "[0.0, 1.0]" in turned_by(np.ma.masked_array([0.0, 1.0])).source


def test_forces_are_written_into_out_or_it_is_refused():
    system = swinging().build()
    z, v = system.initial
    for evaluate in (system.acceleration, system.force):
        expected = evaluate(0.0, z, v)
        assert np.any(expected != 0)
        out = np.zeros(2)
        assert evaluate(0.0, z, v, out=out) is out and np.array_equal(out, expected)
        for wrong in (np.zeros(4)[::2], np.zeros(2)[::-1], np.zeros(2, np.float32), np.zeros(2, int), np.zeros((2, 1)), [0.0, 0.0]):
            with pytest.raises(TypeError, match="out must be .*array of float64"):
                evaluate(0.0, z, v, out=wrong)
        fixed = np.zeros(2)
        fixed.flags.writeable = False
        with pytest.raises(TypeError, match="read-only"):
            evaluate(0.0, z, v, out=fixed)


def test_names_of_any_text():
    m = drev.Model('a "quoted" / name\\')
    m.add_node("Knoten ä 1")
    m.add_inertia("träge", "Knoten ä 1", inertia_kg_m2=1)
    assert m.run(duration_s=0.01).ok
    with pytest.raises(drev.ModelError):
        bad = two_masses()
        bad.add_node("dotted.name")
        bad.run()


def test_models_that_drev_has(root):
    assert set(drev.models()) == {"two_inertia", "two_mass_backlash", "gear_drive", "camshaft"}
    assert drev.load("camshaft", drive="held").modes(count=1).frequency_Hz[0] > 0
    with pytest.raises(drev.ModelError, match="drive"):
        drev.load("camshaft", drive="hold").run()
    long = drev.load(root / "models/drive/drive.toml", run="long")
    assert long.run().t_end == 5.0


def test_a_node_held_by_a_misspelt_name_is_a_fault():
    m = two_masses()
    m.hold("moter")
    with pytest.raises(drev.ModelError, match="node = moter, is no node of this model; did you mean 'motor'"):
        m.check()


def test_a_model_set_to_other_values_is_one_of_its_own():
    m = two_masses()
    m.set_run(duration_s=0.1)
    as_it_was = m.source
    other = m.set()
    other.add_inertia("more", "load", inertia_kg_m2=3)
    other.hold("motor")
    other.set_run(duration_s=0.2)
    assert m.source == as_it_was and other.source != as_it_was
    other.add_node("motor")  # there already: a fault of the other model alone
    m.check()


def test_docstrings_and_signatures_come_with_units():
    import inspect

    signature = inspect.signature(drev.Model.add_gear_mesh)
    assert "normal_backlash_m" in signature.parameters
    doc = drev.Model.add_gear_mesh.__doc__
    assert "Sunde" in doc and "TOTAL gap along the line of action [m], >= 0" in doc
    assert "damping_Nms_per_rad" in inspect.signature(drev.Model.add_shaft_spring).parameters
    assert "duration_s" in drev.ModelCase.run.__doc__
    stub = (drev.__path__[0] + "/__init__.pyi")
    text = open(stub, encoding="utf-8").read()
    compile(text, stub, "exec")
    for name in drev.__all__:
        assert name in text
    assert "def add_shaft_spring(self, name: str, nodes: str | Sequence[str], *, stiffness_Nm_per_rad: Value" in text


def test_large_models_are_made_in_time():
    m = drev.Model("chain")
    for i in range(3000):
        m.add_node(f"n{i}")
        m.add_inertia(f"J{i}", f"n{i}", inertia_kg_m2=1.0)
        if i:
            m.add_shaft_spring(f"k{i}", [f"n{i - 1}", f"n{i}"], stiffness_Nm_per_rad=1.0)
    exact = 2 * math.sin(math.pi / 6000) / (2 * math.pi)
    assert m.modes(count=1).frequency_Hz[0] == pytest.approx(exact, rel=1e-6)


def test_import_is_light():
    code = "import sys, drev; print([m for m in ('scipy', 'pandas', 'matplotlib', 'plotly', 'IPython') if m in sys.modules])"
    printed = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert printed.stdout.strip() == "[]"
