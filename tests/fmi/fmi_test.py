"""FMUs of drev in FMPy, a client that shares no code with drev.   fmi_test.py DREV MODELS FOLDER [part]
Says SKIPPED where FMPy is not installed."""
import json
import os
import shutil
import subprocess
import sys
import xml.etree.ElementTree
import zipfile

try:
    import fmpy
except ImportError:
    print("SKIPPED: FMPy is not installed (pip install fmpy)")
    sys.exit(0)

import numpy
from fmpy.validation import validate_fmu

import advanced
import halves
import imported
from client import Fmu, difference, get, run, set_values, simulate

DREV, MODELS, FOLDER = map(os.path.abspath, sys.argv[1:4])


def export(model, name, *options):
    path = os.path.join(FOLDER, name + ".fmu")
    subprocess.run([DREV, "export", model, "--fmu", path, *options], check=True)
    problems = validate_fmu(path)
    assert problems == [], problems
    return path


def model(name):
    return os.path.join(MODELS, name, name + ".toml")


def write(name, text):
    path = os.path.join(FOLDER, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def direct():
    """The same as drev run, to 1e-9 of each channel's largest value, at communication steps of 1e-5 to 1e-2 s."""
    cases = [("drive", 0.1, ["load.angle_rad", "shaft.torque_Nm", "motor.acceleration_rad_per_s2"]),
             ("gear_pair", 0.1, ["wheel.angle_rad", "mesh.force_N"]),
             ("camshaft_with_gear_drive", 0.02, ["end.angle_rad", "mesh_1.force_N", "shaft_gear.torque_Nm"])]
    for name, duration, channels in cases:
        fmus = [Fmu(export(model(name), f"{name}_{fmi}", "--fmi", fmi, "--record", ",".join(channels)))
                for fmi in "32"]
        for h in (1e-5, 1e-4, 1e-3, 1e-2):
            length = min(duration, 1000 * h)
            expected = run(DREV, model(name), channels, length, h, os.path.join(FOLDER, f"run_{name}_{h}"))
            found = simulate(fmus[0], channels, length, h)
            print(f"{name}, steps of {h} s: {difference(found, expected):.1e}")
            assert difference(found, expected) < 1e-9
            if h > 1e-4:
                assert (found == simulate(fmus[1], channels, length, h)).all(), "FMI 2 and 3 differ"


def by_simulate_fmu():
    """FMPy's own simulation, a parameter and an input that it steps through a signal."""
    path = export(model("drive"), "signal", "--torque", "load", "--record", "load.actual_speed_rad_per_s")
    h = 1e-3
    times = numpy.arange(0, 0.1, h)
    signal = numpy.array([(t, 3.0 if t > 0.0295 else 0.0) for t in times],
                         dtype=[("time", float), ("load.input_torque_Nm", float)])
    result = fmpy.simulate_fmu(path, stop_time=0.1, output_interval=h, input=signal,
                               start_values={"torque_Nm": 0.0})
    # Without the motor's torque the two inertias take up the angular impulse of the input: 3 N m from 0.03 s on, and FMPy's
    # inputs are straight lines between its samples, held at their values at the start of each step.
    fmu = Fmu(path)
    held = simulate(fmu, ["load.actual_speed_rad_per_s"], 0.1, h,
                    inputs=lambda t: {"load.input_torque_Nm": 3.0 if t > 0.0295 else 0.0}, values={"torque_Nm": 0.0})
    assert difference(result["load.actual_speed_rad_per_s"][:, None], held) < 1e-12
    mean = 3.0 * 0.07 / (0.012 + 0.035)
    assert abs(held[-1, 0] - mean) < 0.15 * mean, (held[-1, 0], mean)


def inputs():
    """A torque that is an input equals the same torque in the file; a speed that is an input likewise."""
    base = model("drive")
    knots = [0.0, 0.013, 0.013, 0.03, 0.03, 1.0]
    values = [2.0, 2.0, -7.0, -7.0, 4.0, 4.0]
    table = write("table.toml", f'format = 1\ninclude = "{os.path.relpath(base, FOLDER)}"\n[elements]\nextra = {{ type = '
                  f'"applied_torque", node = "load", table = {{ time_s = {knots}, torque_Nm = {values} }} }}\n')
    names = ["load.angle_rad", "shaft.torque_Nm", "load.acceleration_rad_per_s2"]
    expected = run(DREV, table, names, 0.05, 1e-3, os.path.join(FOLDER, "run_table"))
    fmu = Fmu(export(base, "drive_torque", "--torque", "load", "--record", ",".join(names)))
    found = simulate(fmu, names, 0.05, 1e-3,
                     inputs=lambda t: {"load.input_torque_Nm": 2.0 if t < 0.0129 else -7.0 if t < 0.0299 else 4.0})
    # Accelerations jump at the knots, where the FMU gives those ahead of the jump.
    print(f"input torque: {difference(found[:, :2], expected[:, :2]):.1e}")
    assert difference(found[:, :2], expected[:, :2]) < 1e-9
    assert difference(found[1:12], expected[1:12]) < 1e-9

    names = ["wheel.angle_rad", "mesh.force_N", "pinion.actual_angle_rad"]
    path = export(model("gear_pair"), "pair_speed", "--speed", "pinion", "--record", ",".join(names))
    expected = run(DREV, model("gear_pair"), names[:2], 0.05, 1e-3, os.path.join(FOLDER, "run_pair"))
    found = simulate(Fmu(path), names, 0.05, 1e-3)
    speed = 2000 * 2 * numpy.pi / 60
    assert difference(found[:, :2], expected) < 1e-9
    assert abs(found[-1, 2] - 0.05 * speed) < 1e-9
    # 1 rad/s more than nominal over 10 ms: an angle of 0.05 times the nominal speed and 0.01 rad more.
    found = simulate(Fmu(path), names, 0.05, 1e-3,
                     inputs=lambda t: {"pinion.input_speed_rad_per_s": speed + (1.0 if 0.0095 < t < 0.0195 else 0.0)})
    assert abs(found[-1, 2] - 0.05 * speed - 0.01) < 1e-9, found[-1, 2]


def coupled():
    """Two halves of a train, speed one way and torque the other, against the whole: the inputs are held over a step, so
    that the error is of first order in it."""
    whole = Fmu(export(write("whole.toml", halves.WHOLE_FILE), "whole", "--record", "load.angle_rad,motor.angle_rad"))
    left = Fmu(export(write("left.toml", halves.LEFT_FILE), "left", "--torque", "hub", "--record",
                      "hub.actual_speed_rad_per_s,motor.angle_rad"))
    right = Fmu(export(write("right.toml", halves.RIGHT_FILE), "right", "--speed", "port", "--record",
                       "port.reaction_Nm,load.angle_rad"))
    errors = []
    for h in (4e-4, 1e-4, 2.5e-5):
        a, b = left.instance("left", stop_time=0.1), right.instance("right", stop_time=0.1)
        rows = [[0.0, 0.0]]
        for i in range(round(0.1 / h)):
            speed, = get(left, a, ["hub.actual_speed_rad_per_s"])
            reaction, = get(right, b, ["port.reaction_Nm"])
            set_values(left, a, {"hub.input_torque_Nm": -reaction})
            set_values(right, b, {"port.input_speed_rad_per_s": speed})
            for slave in (a, b):
                slave.doStep(currentCommunicationPoint=i * h, communicationStepSize=h)
            rows.append(get(right, b, ["load.angle_rad"]) + get(left, a, ["motor.angle_rad"]))
        for slave in (a, b):
            slave.terminate()
            slave.freeInstance()
        expected = simulate(whole, ["load.angle_rad", "motor.angle_rad"], 0.1, h)
        errors.append(difference(numpy.array(rows), expected))
    print("two halves against the whole, steps of 400, 100, 25 us:", " ".join(f"{e:.1e}" for e in errors))
    assert errors[0] < 2e-2 and errors[2] < 2e-3
    for coarse, fine in zip(errors, errors[1:]):
        assert 3.4 < coarse / fine < 4.6, "not of first order"


def states():
    """A state saved and restored gives the same bytes, in the instance and, as bytes, in another one."""
    for fmi in "32":
        fmu = Fmu(export(model("gear_pair"), "states_" + fmi, "--fmi", fmi, "--torque", "wheel", "--record",
                         "wheel.angle_rad,mesh.force_N"))
        names = ["wheel.angle_rad", "mesh.force_N"]
        one, other = fmu.instance("one"), fmu.instance("other")  # two at once

        def go(slave, first, count):
            rows = []
            for i in range(first, first + count):
                set_values(fmu, slave, {"wheel.input_torque_Nm": float(i % 7)})
                slave.doStep(currentCommunicationPoint=i * 1e-3, communicationStepSize=1e-3)
                rows.append(get(fmu, slave, names))
            return rows
        save, restore, pack = one.getFMUState, one.setFMUState, one.serializeFMUState
        go(one, 0, 10)
        state = save()
        kept = bytes(pack(state))
        first = go(one, 10, 20)
        restore(state)
        assert bytes(pack(save())) == kept, "the bytes differ"
        assert go(one, 10, 20) == first, "the restored state goes on otherwise"
        other.setFMUState(other.deserializeFMUState(kept))
        assert go(other, 10, 20) == first, "the state goes on otherwise in another instance"
        one.freeFMUState(state)
        for slave in (one, other):
            slave.terminate()
            slave.freeInstance()


def parameters():
    """Parameters as --set gives them; what cannot be is refused with drev's finding and changes nothing."""
    name, channels = model("camshaft_with_gear_drive"), ["end.angle_rad", "mesh_2.force_N"]
    fmu = Fmu(export(name, "cam_wide", "--set", "engine_rpm=700", "--record", ",".join(channels)))
    units = {unit.name: unit.baseUnit for unit in fmu.description.unitDefinitions}
    assert (units["mm"].m, units["mm"].factor) == (1, 1e-3)
    assert (units["rpm"].rad, units["rpm"].s) == (1, -1) and abs(units["rpm"].factor - 0.10471975511965977) < 1e-16
    expected = run(DREV, name, channels, 0.01, 1e-3, os.path.join(FOLDER, "run_wide"),
                   ["--set", "engine_rpm=700", "--set", "backlash_mm=0.4"])
    found = simulate(fmu, channels, 0.01, 1e-3, values={"backlash_mm": 0.4})
    assert difference(found, expected) < 1e-9
    slave = fmu.instance(enter=False)
    for value, words in ((11.0, "must be"), (float("nan"), "finite")):
        try:
            set_values(fmu, slave, {"backlash_mm": value})
        except fmpy.fmi1.FMICallException:
            assert any(words in message for message in slave.messages), slave.messages
        else:
            raise AssertionError("a value out of range was taken")
    assert get(fmu, slave, ["backlash_mm", "engine_rpm"]) == [0.15, 700.0]
    slave.freeInstance()


def tunable():
    """Parameters that leave unknowns and given motions alone are tunable: changed amid a run, the motion goes on under the
    new value. Those that do not are fixed."""
    path = export(model("gear_pair"), "tunable", "--record", "wheel.angle_rad,mesh.force_N")
    fmu = Fmu(path)
    kinds = {v.name: v.variability for v in fmu.description.modelVariables if v.causality == "parameter"}
    assert kinds == {"speed_rpm": "fixed", "torque_Nm": "tunable", "backlash_um": "tunable"}, kinds
    # Outputs may be read inside a step; a parameter's unit is spelled as a channel's.
    declared = xml.etree.ElementTree.fromstring(zipfile.ZipFile(path).read("modelDescription.xml"))
    inside = {v.get("name") for v in declared.iter("Float64") if v.get("intermediateUpdate") == "true"}
    assert inside == {"wheel.angle_rad", "mesh.force_N"}, inside
    assert "N m" in {v.get("unit") for v in declared.iter("Float64")}
    names = ["wheel.angle_rad", "mesh.force_N"]
    # An input torque of 20 N m more from the tenth step on is the same as the load's mean torque of 20 N m more.
    by_input = Fmu(export(model("gear_pair"), "by_input", "--torque", "wheel", "--record", ",".join(names)))
    expected = simulate(by_input, names, 0.05, 1e-3, inputs=lambda t: {"wheel.input_torque_Nm": 20.0 * (t > 9.5e-3)})
    found = simulate(fmu, names, 0.05, 1e-3, inputs=lambda t: {"torque_Nm": 50.0 + 20.0 * (t > 9.5e-3)})
    print(f"tunable torque: {difference(found, expected):.1e}")
    assert difference(found, expected) < 1e-9
    slave = fmu.instance()
    try:
        set_values(fmu, slave, {"speed_rpm": 2100.0})
    except fmpy.fmi1.FMICallException:
        assert any("fixed" in message for message in slave.messages), slave.messages
    else:
        raise AssertionError("a fixed parameter was changed")
    slave.freeInstance()


def unsettled():
    """A periodic start that is no steady state is said when the instance starts, as drev run says it."""
    path = export(write("rattle.toml", """format = 1
[nodes]
motor = { constant_speed_rad_per_s = 100 }
disc = {}
[elements]
J = { type = "inertia", node = "disc", inertia_kg_m2 = 2 }
teeth = { type = "dead_band_coupling", nodes = ["motor", "disc"], stiffness_Nm_per_rad = 2e5, gap_rad = 0.02, \
damping_Nms_per_rad = 20 }
load = { type = "engine_order_torque", node = "disc", mean_Nm = 20, twist_feedback = false, \
harmonics = { order = [1], amplitude_Nm = [500] } }
[run]
start = "periodic"
duration_s = 0.1
""".replace("\\\n", "")), "rattle", "--record", "disc.angle_rad")
    fmu = Fmu(path)
    slave = fmu.instance()
    assert len(slave.messages) == 1 and "does not start in a periodic steady state" in slave.messages[0], slave.messages
    slave.doStep(currentCommunicationPoint=0.0, communicationStepSize=1e-3)
    assert len(slave.messages) == 1
    slave.terminate()
    slave.freeInstance()
    # In a model, what the FMU answers with a warning is a warning of the run.
    warned = write("warned.toml", """format = 1
[nodes]
a = {}
[elements]
J = { type = "inertia", node = "a", inertia_kg_m2 = 1 }
f = { type = "fmu", node = "a", file = "rattle.fmu", step_s = 0.01, outputs = [{ variable = "disc.angle_rad" }] }
[run]
duration_s = 0.02
""")
    for options in ((), ("--step", "1e-3")):
        done = subprocess.run([DREV, "run", warned, "--json", *options], check=True, capture_output=True, text=True)
        said = json.loads(done.stdout)["warnings"]
        assert any("f: rattle.fmu: fmi3ExitInitializationMode answered 'warning'; the FMU logged:" in text for text in said), said


def hostile():
    """Random calls with wrong arguments, in a process of its own, must neither crash it nor be answered with success."""
    path = export(model("gear_pair"), "hostile", "--torque", "wheel", "--record", "wheel.angle_rad,mesh.force_N")
    script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "hostile.py")
    done = subprocess.run([sys.executable, script, path], check=False, capture_output=True, text=True)
    assert done.returncode == 0, (done.returncode, done.stdout[-2000:], done.stderr[-2000:])
    print(done.stdout.strip())


def refused():
    """What cannot be an FMU is refused by the command, with everything wrong at once."""
    def complaint(*options):
        done = subprocess.run([DREV, "export", *options], check=False, capture_output=True, text=True)
        assert done.returncode == 2, done
        return done.stderr
    text = complaint(model("drive"), "--fmu", os.path.join(FOLDER, "no.fmu"), "--torque", "lod", "--speed", "motor")
    assert "did you mean 'load'" in text and "is free" in text, text
    assert ".fmu" in complaint(model("drive"), "--fmu", "drive.zip")
    assert "no.such" in complaint(model("drive"), "--fmu", os.path.join(FOLDER, "no.fmu"), "--record", "no.such")
    assert "--fmu" in complaint(model("drive"), "--torque", "load")
    assert not os.path.exists(os.path.join(FOLDER, "no.fmu"))


def documented():
    """The example of docs/fmi.md, run."""
    with open(os.path.join(os.path.dirname(MODELS), "docs", "fmi.md"), encoding="utf-8") as file:
        page = file.read()

    def code(language):
        return page.split("```" + language + "\n")[1].split("```")[0]
    command = code("sh").replace("drev export", f"'{DREV}' export").replace("models/", MODELS + "/")
    subprocess.run(command, shell=True, check=True, cwd=FOLDER)
    done = subprocess.run([sys.executable, "-c", code("python")], check=True, cwd=FOLDER, capture_output=True, text=True)
    # 30 N m on the load and a harmonic torque of 10 N m on the motor: at most J_motor/(J_motor + J_load) of the step, doubled,
    # and what the harmonic excites.
    torque = float(done.stdout.split()[0])
    assert 5.0 < torque < 40.0, done.stdout


def import_of_fmus():
    """FMUs as elements of models."""
    imported.coupled_back(DREV, export, write, FOLDER)
    imported.refused_imports(DREV, write, FOLDER)
    imported.hostile_archives(DREV, write, FOLDER)


def beyond_steps():
    """Derivatives, intermediate values, event mode."""
    advanced.inside(export, model, write)
    advanced.events(DREV, export, model, FOLDER)


PARTS = [documented, direct, by_simulate_fmu, inputs, coupled, states, parameters, tunable, unsettled, hostile, refused,
         import_of_fmus, beyond_steps]
shutil.rmtree(FOLDER, ignore_errors=True)
os.makedirs(FOLDER)
for part in PARTS:
    if len(sys.argv) < 5 or part.__name__ in sys.argv[4:]:
        part()
        print("passed:", part.__name__)
