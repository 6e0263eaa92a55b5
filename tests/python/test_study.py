"""Many variants with a row of figures each: numbers of single runs and of the command, over threads, processes and Dask."""
import subprocess
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest
from conftest import swinging

import drev

VALUES = {"backlash_mm": "0.1:0.02:0.3", "engine_rpm": [700, 750]}
STEPS = {"step_s": 2e-5, "duration_s": 0.01}


def same(one, other):
    assert one.columns.keys() == other.columns.keys() and len(one) == len(other)
    assert list(one) == list(one.keys()) == list(dict(one)) == list(one.columns) and "none" not in one
    for name in one.columns:
        assert np.array_equal(one[name], other[name], equal_nan=True), name


def test_a_study_has_the_figures_of_single_runs():
    drive = drev.load("gear_drive")
    study = drive.study({"backlash_mm": [0.1, 0.2]}, method="exact", duration_s=0.01)
    assert list(study.status) == ["success"] * 2 and study.units["max_mesh_force_N"] == "N"
    for backlash, force in zip(study["backlash_mm"], study["max_mesh_force_N"]):
        run = drive.set(backlash_mm=backlash).run(method="exact", duration_s=0.01)
        assert run.figures["max_mesh_force_N"].value == pytest.approx(force, rel=1e-9)


def test_any_number_of_threads_gives_the_same_rows():
    drive = drev.load("gear_drive")
    same(drive.study(VALUES, jobs=1, **STEPS), drive.study(VALUES, jobs=3, **STEPS))


def test_what_is_wrong_is_a_model_error():
    with pytest.raises(TypeError, match=r"sample is an argument of study\(\)"):
        drev.load("gear_drive").vary({"backlash_mm": "uniform(0.1,0.2)"}, sample="lhs:5", **STEPS)
    with pytest.raises(drev.ModelError, match="needs sample"):
        drev.load("gear_drive").study({"backlash_mm": "uniform(0,1)"}, **STEPS)
    with pytest.raises(drev.ModelError, match="did you mean"):
        drev.load("gear_drive").study({"backlash_m": [1, 2]}, **STEPS)


def test_variants_have_the_warnings_of_their_runs(tmp_path):
    pair = drev.load("two_inertia")
    frequencies, steps = [5, 40], {"step_s": 2e-3, "duration_s": 0.1}
    study = pair.study({"torque_frequency_Hz": frequencies}, **steps)
    assert list(study.status) == ["success", "success"] and study.reasons == {}
    # 40 Hz in steps of 2 ms: 12.5 of them a period. Single runs here end steps where they record, and so have none to warn of.
    assert study.warnings.keys() == {1} and "too long for what acts" in study.warnings[1]
    for resume in (False, True):  # computed, then from its table
        stored = pair.study({"torque_frequency_Hz": frequencies}, out=tmp_path, resume=resume, **steps)
        assert stored.warnings == study.warnings and stored.reasons == {}


def test_each_variant_has_its_own_status_reason_and_duration(tmp_path):
    drive = drev.load("gear_drive")
    study = drive.study({"backlash_mm": [99, 0.1, 20]}, **STEPS)
    assert list(study.status) == ["bad_input", "success", "bad_input"]
    assert study.reasons.keys() == {0, 2} and "= 99 mm" in study.reasons[0] and "= 20 mm" in study.reasons[2]
    for resume in (False, True):  # computed, then from its table
        stored = drive.study({"backlash_mm": [99, 0.1, 20]}, out=tmp_path, resume=resume, **STEPS)
        assert stored.reasons == study.reasons
    with pytest.raises(drev.ModelError, match="= 99 mm"):
        drive.study({"backlash_mm": [99, 20]}, **STEPS)
    with pytest.raises(drev.ModelError, match="is the duration of the runs"):
        drive.study({"duration_s": [0.01, 0.02]}, **STEPS)
    with pytest.raises(drev.ModelError, match="is the duration of the runs"):
        drive.vary({"duration_s": [0.01, 0.02]}, **STEPS)
    assert drive.run(**STEPS).summary["parameters"]["duration_s"] == 0.01
    runs = drive.vary({"backlash_mm": [99, 0.1, 20]}, **STEPS)
    assert [v.status for v in runs] == ["bad_input", "success", "bad_input"]
    assert list(runs.to_pandas()["status"]) == ["bad_input", "success", "bad_input"]
    with pytest.raises(drev.ModelError, match="= 99 mm"):
        drive.vary({"backlash_mm": [99, 20]}, **STEPS)


def test_processes_give_the_same_rows_of_a_model_made_in_python():
    m = swinging()
    m.add_parameter("k_Nm_per_rad", 100.0)
    m.add_ground_spring("ground", "load", stiffness_Nm_per_rad="k_Nm_per_rad")
    m.set_run(duration_s=0.01)
    values = {"k_Nm_per_rad": [100, 200]}
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        same(m.study(values, client=pool), m.study(values))
        m.add_law("law", "load", lambda x, rate, t: x)
        with pytest.raises(TypeError, match="cannot be sent to other processes"):
            m.study(values, client=pool)


def test_correlations_are_numbers_of_any_kind():
    values = {"backlash_mm": "uniform(0.1,0.2)", "engine_rpm": "uniform(700,750)"}
    drive = drev.load("gear_drive")
    one, other = (
        drive.study(values, sample="lhs:2", correlate={("backlash_mm", "engine_rpm"): c}, **STEPS) for c in (0.5, np.float64(0.5))
    )
    same(one, other)


def test_dask_gives_the_same_rows():
    distributed = pytest.importorskip("distributed")
    drive = drev.load("gear_drive")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            study = drive.study(VALUES, client=client, **STEPS)
    same(study, drive.study(VALUES, **STEPS))


def test_a_study_in_a_folder_is_durable_and_is_that_of_the_command(tmp_path, drev_command):
    drive = drev.load("gear_drive")
    words = [drev_command, "run", "gear_drive", "--table", "--step", "2e-5", "--duration", "0.01", "--out", tmp_path / "command"]
    for name, values in {"backlash_mm": "0.1:0.02:0.3", "engine_rpm": "700,750"}.items():
        words += ["--vary", f"{name}={values}"]
    subprocess.run(words, check=True, capture_output=True)
    calls = []

    def interrupt(part, left):
        calls.append(part)
        if len(calls) == 1:
            raise KeyboardInterrupt

    with pytest.raises(drev.Interrupted, match="resume=True goes on"):
        drive.study(VALUES, out=tmp_path / "python", jobs=1, progress=interrupt, **STEPS)
    assert (tmp_path / "python/variants.partial.store").exists()
    with pytest.raises(drev.ModelError, match="resume"):
        drive.study(VALUES, out=tmp_path / "python", **STEPS)
    with pytest.raises(drev.ModelError, match="another study"):
        drive.study(VALUES, out=tmp_path / "python", resume=True, step_s=2e-5, duration_s=0.02)
    study = drive.study(VALUES, out=tmp_path / "python", resume=True, **STEPS)
    same(study, drive.study(VALUES, **STEPS))
    assert (tmp_path / "python/variants.h5").read_bytes() == (tmp_path / "command/variants.h5").read_bytes()
    assert not (tmp_path / "python/variants.partial.store").exists()
    same(study, drive.study(VALUES, out=tmp_path / "python", resume=True, **STEPS))  # from the table


def test_an_optimum_is_that_of_all_combinations():
    drive = drev.load("gear_drive")
    found = drive.optimise({"backlash_mm": [0.1, 0.15, 0.2]}, minimise="max_mesh_force_N", **STEPS)
    study = drive.study({"backlash_mm": [0.1, 0.15, 0.2]}, **STEPS)
    assert found.certain and found.value == study["max_mesh_force_N"].min()
    assert found.parameters["backlash_mm"] == study["backlash_mm"][study["max_mesh_force_N"].argmin()]
    assert "least max_mesh_force_N" in str(found)
    partly = drive.optimise({"backlash_mm": [0.1, 0.15, 20]}, minimise="max_mesh_force_N", **STEPS)
    assert not partly.certain and "= 20 mm" in partly.data["failures"][0]["reason"]
    searched = drive.optimise({"backlash_mm": "uniform(0.1,0.2)"}, maximise="max_mesh_force_N", variants=20, **STEPS)
    assert not searched.certain and searched.value >= found.value and searched.data["variants"] <= 20
    with pytest.raises(drev.ModelError, match="did you mean"):
        drive.optimise({"backlash_mm": [0.1]}, minimise="max_mesh_force", **STEPS)
