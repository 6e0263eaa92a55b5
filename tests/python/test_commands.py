"""Sweeps, Campbell diagrams, judgements, advice, charts, studies: the same as the command gives, as arrays."""
import json
import subprocess

import numpy as np
import pytest
from conftest import two_masses

import drev


def command(drev_command, *words):
    return json.loads(subprocess.run([drev_command, *map(str, words), "--json"], capture_output=True).stdout)


def test_sweep_and_campbell(root, drev_command):
    file = root / "models/genset/genset.toml"
    case = drev.load(file)
    sweep = case.sweep(speeds_rpm=np.arange(300, 901, 100.0), orders=[0.5, 1, 3], contact="closed")
    expected = command(drev_command, "sweep", file, "--speeds", "300:100:900", "--orders", "0.5,1,3",
                       "--contact", "closed")
    assert sweep.data == expected and sweep.is_linear
    section = sweep.sections[expected["sections"][0]["name"]]
    assert section.amplitude.shape == (3, 7)
    assert np.allclose(abs(section.amplitude), expected["sections"][0]["amplitude"], rtol=1e-15)
    assert np.array_equal(section.half_range, expected["sections"][0]["half_range"])
    assert "half range" in str(sweep) and "<iframe" in sweep._repr_html_()
    campbell = case.campbell(speeds_rpm="300:100:900", contact="closed")
    assert campbell.data == command(drev_command, "campbell", file, "--speeds", "300:100:900", "--contact", "closed")
    assert campbell.frequency_Hz.shape == (len(campbell.data["modes"]), len(campbell.speeds_rpm))
    with pytest.raises(drev.ModelError, match="speeds_rpm.*is missing"):
        case.sweep()


def test_a_sweep_with_contacts_has_branches(root, drev_command):
    file = root / "models/gear_pair/gear_pair.toml"
    sweep = drev.load(file).sweep(speeds_rpm="1900:100:2100")
    assert not sweep.is_linear and sweep.data == command(drev_command, "sweep", file, "--speeds", "1900:100:2100")
    assert "curve" in sweep._repr_html_()
    sweep = drev.load(file).sweep(speeds_rpm="1600:200:2000")
    assert "fold" in [change["what"] for change in sweep.changes]
    branch = sweep.branches[0]
    assert len(branch.speed_rpm) == len(branch.stable) == len(branch.half_range["mesh.force_N"])
    assert not branch.stable.all() and branch.stable.any()


def test_judgement(root):
    case = drev.load(root / "models/genset/genset.toml")
    with pytest.raises(drev.ModelError):
        two_masses().judge(speeds_rpm="300:100:900")
    judged = case.judge(speeds_rpm="600:300:1800", contact="closed")
    assert judged.data["kind"] == "class"


def test_advice_and_chart():
    advice = drev.load("two_inertia").advise(figure="peak torque", within="5%")
    assert advice.chosen in [rung["name"] for rung in advice.data["rungs"]] and advice.sentence == str(advice)
    with pytest.raises(drev.ModelError, match="figure"):
        drev.load("two_inertia").advise(figure="nothing")
    chart = drev.load("two_inertia").chart(methods=["exact", "rk4"], limit_s=0.03)
    assert {c["method"] for c in chart.data["curves"]} == {"exact", "rk4"}


def test_variants_are_runs_of_their_own(tmp_path):
    case = drev.load("two_mass_backlash")
    name = next(iter(case.parameters))
    values = [case.parameters[name]["default"] * f for f in (0.9, 1.0, 1.1)]
    several = case.vary({name: values}, jobs=2)
    assert len(several) == 3 and all(v.run.ok for v in several)
    for variant, value in zip(several, values):
        alone = case.run(parameters={name: value})
        assert alone.figures == variant.run.figures
    for variant in case.vary({name: values[:2]}, out=tmp_path):
        assert (tmp_path / variant.name / "summary.json").exists()
    assert len(case.vary({name: f"{values[0]}:{values[0]}:{2 * values[0]}"})) == 2
    with pytest.raises(drev.ModelError, match="is no parameter|none of"):
        case.vary({"nothing": [1]})
    with pytest.raises(drev.ModelError, match="twice"):
        case.vary({name: [1.0, 1.0]})


def test_import_check_reports(root, tmp_path):
    assembly = {"shafts": [], "disks": []}
    (tmp_path / "bad.json").write_text(json.dumps(assembly))
    with pytest.raises(drev.ModelError):
        drev.import_model(tmp_path / "bad.json")
    assert drev.load(root / "models/drive/drive.toml").check()["nodes"] == 2
    two_masses().run(duration_s=0.01, out=tmp_path / "a")
    two_masses(stiffness=9000.0).run(duration_s=0.01, out=tmp_path / "b")
    drev.compare_reports(tmp_path / "a", tmp_path / "b", out=tmp_path / "both.html")
    assert (tmp_path / "both.html").stat().st_size > 1e5
    with pytest.raises(drev.ModelError):
        drev.load_plugins(tmp_path / "none.so")
    with pytest.raises(drev.ModelError, match="only"):
        drev.source_study(only=["nothing"])
