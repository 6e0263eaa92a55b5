"""Results as arrays: without a copy, read-only, alive as long as an array is; figures with their errors."""
import gc
import pickle
import weakref

import numpy as np
import pytest
from conftest import OMEGA, swinging, two_masses

import drev


def address(array):
    return array.__array_interface__["data"][0]


def test_histories_are_views_of_one_memory():
    run = swinging().run(duration_s=0.1)
    torque = run[run.channels[0]]
    assert not torque.flags.owndata and not torque.flags.writeable
    assert address(torque) == address(run[run.channels[0]])
    assert address(run.time) == address(run._handle.times)
    with pytest.raises(ValueError):
        torque[0] = 1.0
    with pytest.raises(KeyError, match="was not recorded; there are"):
        run["nothing"]


def test_an_array_outlives_its_run_and_model():
    m = swinging()
    run = m.run(duration_s=0.1, record=["shaft.torque_Nm"])
    torque, expected = run["shaft.torque_Nm"], run["shaft.torque_Nm"].copy()
    gone = weakref.ref(run)
    shapes = m.modes().shapes
    del run, m
    gc.collect()
    assert gone() is None
    filler = [np.ones(2000) for _ in range(200)]  # whoever freed it would have it overwritten
    assert np.array_equal(torque, expected) and filler
    assert shapes.shape == (2, 1) and shapes[0, 0] == pytest.approx(0.035 / 0.012 * -shapes[1, 0])


def test_mode_shapes():
    modes = two_masses().modes()
    assert modes.rigid_modes == 1 and modes.nodes == ["motor", "load"] and len(modes) == 1
    assert not modes.shapes.flags.owndata and address(modes.shapes) == address(modes._handle.shapes)
    assert modes.error_Hz[0] < 1e-9
    mass = np.array([0.012, 0.035])
    assert modes.shapes[:, 0] @ (mass * modes.shapes[:, 0]) == pytest.approx(1.0, rel=1e-12)
    with pytest.raises(drev.ModelError, match="count = 5, must be a whole number from 1 to 1"):
        two_masses().modes(count=5)
    with pytest.raises(TypeError, match="damped_modes"):
        two_masses().modes(speed_rpm=3)


def test_damped_modes():
    c = 0.5
    damped = two_masses(damping=c).damped_modes()
    ratio = c * (1 / 0.012 + 1 / 0.035) / (2 * OMEGA)
    assert damped.damping_ratio[0] == pytest.approx(ratio, rel=1e-10)
    assert damped.eigenvalues[0] == pytest.approx(OMEGA * (-ratio + 1j * np.sqrt(1 - ratio**2)), rel=1e-10)
    assert damped.natural_frequency_Hz[0] == pytest.approx(OMEGA / (2 * np.pi), rel=1e-10)
    assert damped.shapes.dtype == complex and damped.shapes.shape == (2, 1)
    assert damped.dissipated[damped.elements.index("shaft"), 0] == pytest.approx(1.0)
    assert damped.kinetic.sum() == pytest.approx(1.0)


def test_modes_have_the_json_of_their_command():
    m = two_masses(damping=0.5)
    modes, damped = m.modes(count=1), m.damped_modes()
    assert modes.data["kind"] == "modes" and damped.data["kind"] == "damped_modes"
    assert modes.data["frequencies_Hz"] == list(modes.frequency_Hz)
    assert pickle.loads(pickle.dumps(damped)).data == damped.data
    assert m.build().modes().data is None  # which no command computes


def test_figures_have_errors():
    run = drev.load("two_mass_backlash").run(accuracy=1e-6)
    force = run.figures["max_force_N"]
    assert force.unit == "N" and force.of == "spring_1" and 0 < force.error <= 1e-6 * force.value
    assert run.figures["spring_1.front_contacts"].value == 7
    assert str(drev.Figure(1.0, 0.25, "N m", "shaft")) == "1 +- 0.25 N m (shaft)" and float(force) == force.value
    unchecked = drev.load("two_mass_backlash").run()
    assert unchecked.figures["max_force_N"].error is None
    assert abs(unchecked.figures["max_force_N"].value - force.value) < 1e-6 * force.value
    assert drev.load("two_mass_backlash").accuracy(1e-4)["peak torque"].error is not None


def test_the_equation_of_motion():
    m = two_masses(damping=0.5)
    m.add_polyline_spring("stop", "load", with_stops=dict(stiffness_Nm_per_rad=10.0, travel_rad=1e-3, stop_stiffness_Nm_per_rad=1e4))
    m.add_applied_torque("p", "motor", harmonics=dict(frequency_Hz=[2.0], amplitude_Nm=[3.0], phase_deg=[0.0]))
    system = m.build()
    z, v = np.array([1e-3, 3e-3]), np.array([0.1, -0.2])
    twist, rate = z[1] - z[0], v[1] - v[0]
    shaft = 8500 * twist + 0.5 * rate
    stop = 10.0 * 1e-3 + 1e4 * 2e-3
    expected = np.array([3 * np.cos(4 * np.pi * 0.1) + shaft, -shaft - stop])
    assert np.allclose(system.force(0.1, z, v), expected, rtol=1e-12)
    assert np.allclose(system.acceleration(0.1, z, v), expected / [0.012, 0.035], rtol=1e-12)
    assert np.array_equal(system.matrix("mass"), np.diag([0.012, 0.035]))
    assert np.array_equal(system.matrix("stiffness")[:2, :2], 8500 * np.array([[1, -1], [-1, 1]]))
    assert system.unknowns == ["motor", "load"]
    with pytest.raises(ValueError, match="2 unknowns"):
        system.force(0.0, np.zeros(3), np.zeros(2))
    with pytest.raises(TypeError):
        system.force(0.0, [0.0, 0.0], np.zeros(2))
    bar = drev.Model("bar")  # a mass matrix that is not diagonal
    bar.add_nodes("a", "b")
    bar.hold("a")
    bar.add_distributed_shaft("bar", ["a", "b"], shear_modulus_GPa=80, density_kg_per_m3=7850, outer_diameter_mm=80,
                              length_m=1.0, segments=3, mass="consistent")
    system = bar.build()
    z = np.array([1e-3, 2e-3, -1e-3])
    expected = np.linalg.solve(system.matrix("mass"), -system.matrix("stiffness") @ z)
    assert np.allclose(system.acceleration(0.0, z, np.zeros(3)), expected, rtol=1e-10)


def test_modes_of_what_was_built():
    m = two_masses()
    modes = m.build().modes(count=1)
    assert np.array_equal(modes.frequency_Hz, m.modes().frequency_Hz) and modes.model == "two masses"
    assert np.array_equal(modes.shapes, m.modes().shapes)
    with pytest.raises(ValueError, match="closed or open"):
        m.build().modes(contact="ajar")
    with pytest.raises(drev.ModelError):
        m.build().modes(count=5)


def test_scipy_integrates_what_drev_does():
    integrate = pytest.importorskip("scipy.integrate")
    system = swinging(damping=0.5).build()
    z, v = system.initial
    rates = lambda t, y: np.concatenate([y[2:], system.acceleration(t, y[:2].copy(), y[2:].copy())])
    theirs = integrate.solve_ivp(rates, (0, 0.05), np.concatenate([z, v]), "DOP853", rtol=1e-11, atol=1e-13)
    run = swinging(damping=0.5).run(duration_s=0.05, record=["motor.angle_rad"])
    assert abs(theirs.y[0, -1] - run["motor.angle_rad"][-1]) < 1e-10
    sparse = pytest.importorskip("scipy.sparse")
    assert sparse.issparse(system.matrix("mass", sparse=True))


def test_pandas_and_xarray():
    run = swinging().run(duration_s=0.1)
    pandas = pytest.importorskip("pandas")
    frame = run.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and list(frame) == run.channels and frame.index.name == "time_s"
    pytest.importorskip("xarray")
    data = run.to_xarray()
    assert data["motor.angle_rad"].attrs["units"] == "rad" and data.sizes["time_s"] == len(run)
    assert two_masses().modes().to_pandas()["frequency_Hz"][1] == pytest.approx(OMEGA / (2 * np.pi))


def test_a_run_iterates_over_its_channels_as_a_table_does():
    run = swinging().run(duration_s=0.1)
    assert list(run) == list(run.keys()) == run.channels and all(name in run for name in run)
    samples = dict(run)
    assert list(samples) == run.channels
    assert all(len(samples[name]) == len(run) and (samples[name] == run[name]).all() for name in run)


def test_results_and_models_are_pickled():
    m = swinging()
    run = m.run(duration_s=0.1)
    for _ in range(2):  # what was unpickled is pickled again
        m = pickle.loads(pickle.dumps(m))
        again = pickle.loads(pickle.dumps(run))
        assert again.summary == run.summary and again.text == run.text and again.ok
        assert again.figures == run.figures and again.notes == run.notes
        assert again.channels == run.channels and len(run) > 2
        assert all(np.array_equal(again[name], run[name]) for name in run.channels)
        assert np.array_equal(again.time, run.time)
        run = again
    assert np.array_equal(m.run(duration_s=0.1).time, run.time)
    modes, damped = m.modes(), m.damped_modes()
    again = pickle.loads(pickle.dumps(modes))
    assert np.array_equal(again.shapes, modes.shapes) and str(again) == str(modes) and repr(again) == repr(modes)
    again = pickle.loads(pickle.dumps(damped))
    assert np.array_equal(again.elastic, damped.elastic) and np.array_equal(again.eigenvalues, damped.eigenvalues)
    assert str(again) == str(damped)
    campbell = drev.load("camshaft", drive="held").campbell(speeds_rpm="300:100:600")
    again = pickle.loads(pickle.dumps(campbell))
    assert again.data == campbell.data and np.array_equal(again.frequency_Hz, campbell.frequency_Hz)


def test_a_notebook_shows_the_report():
    run = swinging().run(duration_s=0.1, report_html=True)
    shown = run._repr_html_()
    assert shown.startswith("<iframe srcdoc=") and "two masses" in shown and "</iframe>" in shown
    assert "<pre>" in swinging().run(duration_s=0.1)._repr_html_()
    assert "<table>" in two_masses().modes()._repr_html_()
