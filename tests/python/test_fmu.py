"""An FMU that another tool wrote, PythonFMU, as a governor in a model: the example of docs/fmi.md."""
import math
import re

import numpy as np
import pytest

import drev

pythonfmu = pytest.importorskip("pythonfmu")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The page's governor as Governor.fmu, and its model as governed.toml."""
    from conftest import ROOT
    from pythonfmu.builder import FmuBuilder

    folder = tmp_path_factory.mktemp("governor")
    page = (ROOT / "docs/fmi.md").read_text(encoding="utf-8")
    code = re.search(r"<!-- governor -->\n```python\n(.*?)```", page, re.DOTALL).group(1)
    (folder / "Governor.py").write_text(code, encoding="utf-8")
    # The same that finds no fuel from 0.05 s on.
    fails = "        if current_time > 0.045:\n            raise ValueError('no fuel')\n"
    code = code.replace("Governor(", "Failing(").replace("        e = self", fails + "        e = self", 1)
    (folder / "Failing.py").write_text(code, encoding="utf-8")
    for name in ("Governor.py", "Failing.py"):
        FmuBuilder.build_FMU(str(folder / name), dest=str(folder))
    model = re.search(r"```toml\n(.*?)```", page, re.DOTALL).group(1)
    (folder / "governed.toml").write_text(model, encoding="utf-8")
    return folder


def speeds(count):
    """Of the loop of inertia 2 kg m^2, gains 30 and 400, load 5 N m, step 10 ms: w_(k+1) = (2 - a - b) w_k - (1 - a) w_(k-1)."""
    a, b, first = 30 * 0.01 / 2, 400 * 0.01**2 / 2, -0.01 * 5 / 2
    r = math.sqrt(1 - a)
    phi = math.acos((2 - a - b) / (2 * r))
    return np.array([first * r ** (k - 1) * math.sin(k * phi) / math.sin(phi) for k in range(count)])


def test_the_governor_of_the_guide_follows_its_z_transform(folder):
    model = drev.load(str(folder / "governed.toml"))
    for method in ({"method": "exact"}, {"method": "average_acceleration", "step_s": 0.0025}):
        run = model.run(every_s=0.01, **method)
        assert run.ok and len(run.time) == 101
        assert np.max(np.abs(run["engine.speed_rad_per_s"] - speeds(101))) < 1e-12
    with pytest.raises(drev.SolverError, match="governor is a controller that is sampled every 0.01 s"):
        model.modes()


def test_the_same_built_in_python(folder):
    m = drev.Model("governed")
    m.add_node("engine", nominal_speed_rad_per_s=100)
    m.add_inertia("J", "engine", inertia_kg_m2=2)
    m.add_applied_torque("load", "engine", torque_Nm=-5)
    m.add_fmu("governor", "engine", file=str(folder / "Governor.fmu"), step_ms=10,
              inputs=[{"variable": "speed", "channel": "engine.actual_speed_rad_per_s"}],
              outputs=[{"variable": "torque"}],
              parameters=[{"variable": name, "value": value} for name, value in
                          (("Kp", 30), ("Ki", 400), ("reference", 100))])
    run = m.run(duration_s=1, every_s=0.01, record=["engine.speed_rad_per_s"])
    assert np.max(np.abs(run["engine.speed_rad_per_s"] - speeds(101))) < 1e-12
    assert "communication point" in drev.Model.add_fmu.__doc__


def test_what_the_fmu_logs_is_said(folder):
    text = (folder / "governed.toml").read_text(encoding="utf-8")
    (folder / "failing.toml").write_text(text.replace("Governor.fmu", "Failing.fmu"), encoding="utf-8")
    with pytest.raises(drev.SolverError, match=r"Failing.fmu: fmi2DoStep \(t = 0.05 s, step 0.01 s\).*no fuel") as caught:
        drev.load(str(folder / "failing.toml")).run()
    assert 0.0 < caught.value.result.time[-1] <= 0.06


def test_an_fmu_from_python(tmp_path):
    fmpy = pytest.importorskip("fmpy")
    from conftest import two_masses

    m = two_masses()
    path = str(tmp_path / "train.fmu")
    m.export_fmu(path, torque=["load"], record=["shaft.torque_Nm"], fmi="2")
    signal = np.array([(0.0, 5.0), (1.0, 5.0)], dtype=[("time", float), ("load.input_torque_Nm", float)])
    found = fmpy.simulate_fmu(path, stop_time=0.05, output_interval=1e-3, input=signal)
    m.add_applied_torque("step", "load", torque_Nm=5)
    run = m.run(duration_s=0.05, every_s=1e-3, record=["shaft.torque_Nm"])
    assert np.max(np.abs(found["shaft.torque_Nm"][:51] - run["shaft.torque_Nm"][:51])) < 1e-9
