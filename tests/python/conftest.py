"""Models that the tests share."""
import math
import pathlib

import pytest

import drev

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture
def root():
    return ROOT


def two_masses(stiffness=8500.0, damping=0.0):
    m = drev.Model("two masses")
    m.add_nodes("motor", "load")
    m.add_inertia("J_motor", "motor", inertia_kg_m2=0.012)
    m.add_inertia("J_load", "load", inertia_kg_m2=0.035)
    m.add_shaft_spring("shaft", ["motor", "load"], stiffness_Nm_per_rad=stiffness, damping_Nms_per_rad=damping)
    return m


def swinging(**more):
    """Two masses let go with a twist of 0.01 rad: twist = 0.01 cos(omega t)."""
    m = two_masses(**more)
    m.set_initial("motor", angle_rad=0.01)
    return m


#: rad/s: sqrt(k (1/J_1 + 1/J_2))
OMEGA = math.sqrt(8500.0 * (1 / 0.012 + 1 / 0.035))


@pytest.fixture
def drev_command():
    """The command drev of the same build."""
    import os

    return os.environ["DREV_COMMAND"]
