"""What FMI offers beyond steps: derivatives of outputs by inputs, values inside a step, event mode at contact changes."""
import csv
import os
import subprocess

import fmpy
import numpy

import halves
from client import Fmu, difference, get, set_values, simulate


def inside(export, model, write):
    """Derivatives, and values inside steps. Of accelerations by a torque 1/J, of a shaft's torque by the speed of its end its damping; of angles zero."""
    for fmi in "32":
        names = ["load.acceleration_rad_per_s2", "motor.acceleration_rad_per_s2", "load.angle_rad", "shaft.torque_Nm"]
        fmu = Fmu(export(model("drive"), "drive_" + fmi, "--fmi", fmi, "--torque", "load", "--record", ",".join(names)))
        slave = fmu.instance()
        slave.doStep(currentCommunicationPoint=0.0, communicationStepSize=1e-3)
        outputs = [fmu.references[name] for name in names]
        before = get(fmu, slave, names)
        known = [fmu.references["load.input_torque_Nm"]]
        found = slave.getDirectionalDerivative(outputs, known, [2.0])
        assert abs(found[0] - 2.0 / 0.035) < 1e-8 / 0.035 and abs(found[1]) < 1e-8 and list(found[2:]) == [0.0, 0.0]
        assert get(fmu, slave, names) == before
        right = Fmu(export(write("right_slope.toml", halves.RIGHT_FILE), "right_slope_" + fmi, "--fmi", fmi, "--speed", "port",
                           "--record", "port.reaction_Nm,shaft_2.torque_Nm"))
        other = right.instance()
        # The shaft's torque is k (q_b - q_a) + c (q_b' - q_a') with the port at a; the reaction drives the port.
        outputs = [right.references["port.reaction_Nm"], right.references["shaft_2.torque_Nm"]]
        speed = [right.references["port.input_speed_rad_per_s"]]
        found = other.getDirectionalDerivative(outputs, speed, [1.0])
        assert abs(found[0] - 0.05) < 1e-9 and abs(found[1] + 0.05) < 1e-9, list(found)
        for fails, words in (((outputs, outputs, [1.0, 1.0]), "is no input"), ((speed, speed, [1.0]), "is no output")):
            try:
                other.getDirectionalDerivative(*fails)
            except fmpy.fmi1.FMICallException:
                assert fmi == "2" or any(words in message for message in other.messages), other.messages
            else:
                raise AssertionError("a derivative of what is no output was given")
        if fmi == "3":
            inside_steps(fmu)


def started(fmu, **options):
    from fmpy.fmi3 import FMU3Slave, fmi3LogMessageCallback

    slave = FMU3Slave(guid=fmu.description.guid, unzipDirectory=fmu.folder, instanceName="one",
                      modelIdentifier=fmu.description.coSimulation.modelIdentifier)
    slave.messages = []
    slave.instantiate(logMessage=fmi3LogMessageCallback(lambda *given: slave.messages.append(given[-1].decode())),
                      **options)
    slave.enterInitializationMode(startTime=0.0)
    slave.exitInitializationMode()
    return slave


def inside_steps(fmu):
    """The importer is shown points inside a step, on the motion that short steps give, and may set nothing there."""
    names = ["load.angle_rad", "shaft.torque_Nm"]
    seen, refused = [], []

    def update(environment, t, set_requested, get_allowed, finished, can_return_early, wants_early, early_time):
        assert get_allowed and finished and not set_requested and not can_return_early
        seen.append([t] + get(fmu, slave, ["time"] + names))
        if len(seen) == 2:
            try:
                set_values(fmu, slave, {"load.input_torque_Nm": 1.0})
            except fmpy.fmi1.FMICallException:
                refused.append(slave.messages[-1])

    slave = started(fmu, intermediateUpdate=update,
                    requiredIntermediateVariables=[fmu.references[name] for name in names])
    slave.doStep(currentCommunicationPoint=0.0, communicationStepSize=0.01)
    times = [row[0] for row in seen]
    assert len(seen) > 20 and times == sorted(times) and abs(times[-1] - 0.01) < 1e-15
    assert [row[1] for row in seen] == times and refused and "inside a step" in refused[0]
    assert seen[-1][2:] == get(fmu, slave, names)
    # Another instance, stepped to some of these times.
    other, at = fmu.instance(), 0.0
    for row in seen[3::7]:
        other.doStep(currentCommunicationPoint=at, communicationStepSize=row[0] - at)
        at = row[0]
        for value, expected in zip(row[2:], get(fmu, other, names)):
            assert abs(value - expected) < 1e-8 * max(1e-3, abs(expected)), (row, expected)


def at_points(fmu, changes):
    """A change of contact at the very end of a step is one of that step, which does not end early, and not of the next."""
    slave, t = started(fmu, eventModeUsed=True, earlyReturnAllowed=True), 0.0
    slave.updateDiscreteStates()
    slave.enterStepMode()
    for end in changes:
        event, _, early, t = slave.doStep(currentCommunicationPoint=t, communicationStepSize=end - t)
        assert event and (not early or abs(t - end) < 1e-9 * end), (t, end)
        slave.enterEventMode()
        slave.updateDiscreteStates()
        slave.enterStepMode()


def events(drev, export, model, folder):
    """In event mode with early return, steps end where drev run says that contacts change, to 1e-9 s, and the motion is that
    without; without early return nothing ends early."""
    names = ["wheel.angle_rad", "mesh.force_N"]
    file = os.path.join(folder, "events.csv")
    subprocess.run([drev, "run", model("gear_pair"), "--duration", "0.02", "--events", file], check=True,
                   stdout=subprocess.DEVNULL)
    with open(file, encoding="utf-8") as text:
        expected = [float(row["time_s"]) for row in csv.DictReader(text)]
    fmu = Fmu(export(model("gear_pair"), "pair_events", "--record", ",".join(names)))
    h, count = 1e-3, 20
    plain = simulate(fmu, names, count * h, h)
    for early_allowed in (True, False):
        slave, found, t, rows = started(fmu, eventModeUsed=True, earlyReturnAllowed=early_allowed), [], 0.0, []
        slave.updateDiscreteStates()
        slave.enterStepMode()
        for i in range(count):
            end = (i + 1) * h
            while t < end - 1e-12:
                event, ends, early, t = slave.doStep(currentCommunicationPoint=t, communicationStepSize=end - t)
                assert event == early and not ends and (early or abs(t - end) < 1e-12)
                if event:
                    found.append(t)
                    slave.enterEventMode()
                    assert not any(slave.updateDiscreteStates()[:5])
                    slave.enterStepMode()
            rows.append(get(fmu, slave, names))
        if not early_allowed:
            assert found == []
            continue
        assert len(found) == len(expected), (len(found), len(expected))
        assert max(abs(a - b) for a, b in zip(found, expected)) < 1e-9
        assert difference(numpy.array(rows), plain[1:]) < 1e-9
        at_points(fmu, found)
    print(f"event mode: {len(found) or len(expected)} contact changes as in drev run")
