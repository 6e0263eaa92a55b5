"""Plots: one line each, in both libraries, with the data that the results have."""
import numpy as np
import pytest
from conftest import swinging, two_masses

import drev

pyplot = pytest.importorskip("matplotlib.pyplot")
objects = pytest.importorskip("plotly.graph_objects")


@pytest.fixture(params=["matplotlib", "plotly"])
def backend(request):
    yield request.param
    pyplot.close("all")


def curves(figure):
    """(x, y) of every line and bar."""
    if isinstance(figure, objects.Figure):
        return [(np.asarray(t.x), np.asarray(t.y)) for t in figure.data]
    lines = [(line.get_xdata(), line.get_ydata()) for ax in figure.axes for line in ax.lines]
    return lines + [(None, np.array([p.get_height() for p in bars])) for ax in figure.axes for bars in ax.containers]


def test_histories(backend):
    run = swinging().run(duration_s=0.1, record=["motor.angle_rad", "shaft.torque_Nm"])
    (_, angle), (_, torque) = curves(run.plot(backend=backend))
    assert np.array_equal(angle, run["motor.angle_rad"]) and np.array_equal(torque, run["shaft.torque_Nm"])
    assert len(curves(run.plot("shaft.torque_Nm", backend=backend))) == 1
    with pytest.raises(KeyError):
        run.plot("nothing", backend=backend)
    with pytest.raises(ValueError, match="matplotlib"):
        run.plot(backend="gnuplot")


def test_modes(backend):
    m = two_masses(damping=0.5)
    (_, shape), = curves(m.modes().plot(backend=backend))
    assert np.allclose(shape, [1.0, -0.012 / 0.035])
    (_, amplitude), = curves(m.damped_modes().plot(1, backend=backend))
    assert np.allclose(amplitude, [1.0, 0.012 / 0.035])
    with pytest.raises(ValueError, match="mode 2 is none of 1 to 1"):
        m.modes().plot(2, backend=backend)


def test_sweeps_and_campbell(backend, root):
    case = drev.load(root / "models/genset/genset.toml")
    sweep = case.sweep(speeds_rpm="300:100:600", orders=[3, 6], contact="closed")
    name = next(iter(sweep.sections))
    (x, y), = curves(sweep.plot(name, backend=backend))
    assert np.array_equal(x, sweep.speeds_rpm) and np.array_equal(y, sweep.sections[name].half_range)
    assert len(curves(sweep.plot(backend=backend))) == len(sweep.sections)
    campbell = case.campbell(speeds_rpm="300:100:600", contact="closed")
    drawn = curves(campbell.plot(backend=backend))
    orders = {c["order"] for c in campbell.criticals}
    assert len(drawn) == len(campbell.frequency_Hz) + len(orders) + bool(orders)
    branches = drev.load(root / "models/gear_pair/gear_pair.toml").sweep(speeds_rpm="1900:100:2200")
    assert curves(branches.plot("mesh.force_N", backend=backend))


def test_contacts_and_charts(backend):
    case = drev.load("two_mass_backlash")
    drawn = curves(case.run().plot_contacts(backend=backend))
    assert list(drawn[0][1]) == [7, 10] and list(drawn[1][1]) == [9, 11]
    with pytest.raises(ValueError, match="no contact"):
        swinging().run(duration_s=0.1).plot_contacts(backend=backend)
    chart = drev.load("two_inertia").chart(methods=["exact", "rk4"], limit_s=0.03)
    assert len(curves(chart.plot(backend=backend))) == 2
