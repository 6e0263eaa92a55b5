"""What drev writes as JSON is as docs/results.schema.json says; arguments: drev, the schema, a folder.

Every kind of run is tried, every key of the schema must be met with a value, and the validator must refuse
what is wrong in one place.
"""
import copy
import json
import os
import re
import signal
import subprocess
import sys
import time

from schema import opened

drev, schema_path, folder = sys.argv[1:]
schema, validator = opened(schema_path, folder)


def printed(*words, code=0):
    run = subprocess.run([drev, *words, "--json"], capture_output=True, text=True)
    assert run.returncode == code, (words, run.returncode, run.stderr)
    return json.loads(run.stdout)


def read(path):
    with open(path) as file:
        return json.load(file)


def ended_by(number, path):
    """The partial summary of a run that a signal has ended."""
    run = subprocess.Popen([drev, "run", "camshaft", "--set", "duration_s=10000", "--out", path],
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    history = path + "/history.partial.csv"
    while run.poll() is None and not (os.path.exists(history) and os.path.getsize(history)):
        time.sleep(0.02)
    run.send_signal(number)
    run.wait()
    return read(path + "/summary.partial.json")


models = os.path.join(os.path.dirname(schema_path), "..", "models")

with open("torn.toml", "w") as file:
    file.write("format = 1\n[nodes\n")
os.mkdir("trains")
with open("trains/other.toml", "w") as file:
    file.write("colour = 1\n")
with open("trains/at_rest.toml", "w") as file:
    file.write('format = 1\nnote = "one disc"\n[nodes]\na = {}\n[elements]\n'
               'J = { type = "inertia", node = "a", inertia_kg_m2 = 1 }\n')

short = "duration_s=0.05"
with open("long.toml", "w") as file:
    file.write('format = 1\n[nodes]\na = {}\nb = {}\n[elements]\n'
               'Ja = { type = "inertia", node = "a", inertia_kg_m2 = 5 }\n'
               'Jb = { type = "inertia", node = "b", inertia_kg_m2 = 5 }\n'
               's = { type = "distributed_shaft", nodes = ["a", "b"], shear_modulus_GPa = 80, segments = 40,'
               ' density_kg_per_m3 = 7850, outer_diameter_mm = 100, length_m = 5 }\n'
               'drive = { type = "applied_torque", node = "a",'
               ' harmonics = { frequency_Hz = [10], amplitude_Nm = [2000], phase_deg = [-90] } }\n'
               '[run]\nduration_s = 0.2\n')

with open("turning.toml", "w") as file:
    file.write('format = 1\n[nodes]\na = { nominal_speed_rpm = 900 }\nb = {}\n[elements]\n'
               'Ja = { type = "inertia", node = "a", inertia_kg_m2 = 1 }\n'
               'Jb = { type = "inertia", node = "b", inertia_kg_m2 = 1 }\n'
               's = { type = "shaft_spring", nodes = ["a", "b"], stiffness_Nm_per_rad = 9000, '
               'damping_Nms_per_rad = 20 }\n'
               'drag = { type = "dashpot", node = "b", damping_Nms_per_rad = 3 }\n'
               'pulse = { type = "engine_order_torque", node = "a", mean_Nm = 200, '
               'harmonics = { order = [2], amplitude_Nm = [50] } }\n'
               '[run]\nduration_s = 3\nsettle = "auto"\n')
with open("turning.toml") as file, open("run_up.toml", "w") as copied:
    copied.write(file.read().replace("nominal_speed_rpm = 900",
                                     "hold = true, run_up = { speed_0_rpm = 300, speed_1_rpm = 1500, time_1_s = 3 }"))
with open("turning.toml") as file, open("from_rest.toml", "w") as copied:  # nothing turns nominally
    copied.write(file.read().replace("nominal_speed_rpm = 900", "").replace('settle = "auto"\n', ""))
with open("turning.toml") as file, open("many_segments.toml", "w") as copied:
    copied.write(file.read().replace('stiffness_Nm_per_rad = 9000, damping_Nms_per_rad = 20',
                                     'shear_modulus_GPa = 80, segments = 450, density_kg_per_m3 = 7850, '
                                     'outer_diameter_mm = 100, length_m = 5')
                 .replace('"shaft_spring"', '"distributed_shaft"'))

with open("class.toml", "w") as file:
    file.write('format = 1\nnote = "shaft and mesh"\n[parameters]\nfires = 1\n'
               '[nodes]\na = { nominal_speed_rpm = 900 }\nb = {}\nc = {}\n[elements]\n'
               'Ja = { type = "inertia", node = "a", inertia_kg_m2 = 1 }\n'
               'Jb = { type = "inertia", node = "b", inertia_kg_m2 = 1 }\n'
               'Jc = { type = "inertia", node = "c", inertia_kg_m2 = 1 }\n'
               's = { type = "shaft_spring", nodes = ["a", "b"], stiffness_Nm_per_rad = 9000, '
               'damping_Nms_per_rad = 2 }\n'
               'z = { type = "gear_mesh", nodes = ["b", "c"], base_radius_1_mm = 50, base_radius_2_mm = 50, '
               'stiffness_N_per_um = 50, damping_Ns_per_m = 2000 }\n'
               'drag = { type = "dashpot", node = "c", damping_Nms_per_rad = 0.2 }\n'
               'pulse = { type = "engine_order_torque", node = "a", mean_Nm = "20 * fires", '
               'harmonics = { order = [2], amplitude_Nm = ["300 * fires + 5"] } }\n'
               '[run]\nduration_s = 0.5\n[class]\nrated_speed_rpm = 1500\nmisfire = { fires = 0 }\n'
               '[class.sections]\ns = { diameter_mm = 25, tensile_strength_MPa = 500, shape_factor = 0.6, '
               'permissible_heat_W = 50, sn_range_MPa = 100 }\n')

with open("governed.toml", "w") as file:  # a mode that grows
    file.write("""
format = 1
[nodes]
a = { nominal_speed_rpm = 600 }
[elements]
J = { type = "inertia", node = "a", inertia_kg_m2 = 2 }
gov = { type = "speed_governor", node = "a", proportional_gain_Nms_per_rad = 10, integral_gain_Nm_per_rad = 100, actuator_lag_s = 0.5 }
t = { type = "engine_order_torque", node = "a", harmonics = { order = [1], amplitude_Nm = [100] } }
""")
with open("spline.toml", "w") as file:  # a contact in N m
    file.write('format = 1\n[nodes]\na = { initial_speed_rad_per_s = 2 }\nb = {}\n[elements]\n'
               'Ja = { type = "inertia", node = "a", inertia_kg_m2 = 1 }\n'
               'Jb = { type = "inertia", node = "b", inertia_kg_m2 = 1 }\n'
               's = { type = "polyline_spring", nodes = ["a", "b"], dead_band = { stiffness_Nm_per_rad = 2000, '
               'half_gap_rad = 0.01 } }\n[run]\nduration_s = 0.2\n')

with open("pair.toml", "w") as file:  # folds
    file.write('format = 1\nnote = "gear pair"\n[nodes]\na = { nominal_speed_rpm = 9 }\nb = {}\n[elements]\n'
               'J_a = { type = "inertia", node = "a", inertia_kg_m2 = 2 }\n'
               'J_b = { type = "inertia", node = "b", inertia_kg_m2 = 2 }\n'
               'T_a = { type = "engine_order_torque", node = "a", mean_Nm = 0.1 }\n'
               'T_b = { type = "engine_order_torque", node = "b", mean_Nm = 0.1 }\n'
               'mesh = { type = "gear_mesh", nodes = ["a", "b"], base_radius_1_m = 1, base_radius_2_m = 1, teeth_1 = 1, '
               'teeth_2 = 1, stiffness_N_per_m = 1, normal_backlash_m = 2, damping_Ns_per_m = 0.1, '
               'damping_law = "always", transmission_error = { order = [1], amplitude_m = [0.05] } }\n')
with open("pair.toml") as file, open("chaos.toml", "w") as copied:  # no stable motion
    copied.write(file.read().replace("amplitude_m = [0.05]", "amplitude_m = [0.5]"))
with open("pair.toml") as file, open("uneven.toml", "w") as copied:  # a load that does not repeat in the cycle given
    copied.write(file.read() + """
uneven = { type = "engine_order_torque", node = "b", harmonics = { order = [0.3], amplitude_Nm = [0.05] } }
""")

with open("gears.toml", "w") as file:
    file.write('[geometry]\nmodule_mm = 4\nload_N_per_mm = 100\npoints = 10\n'
               'loads = { load_N_per_mm = [30, 100] }\ngear_1 = { teeth = 20, profile_shift = -0.1, width_mm = 30, bore_diameter_mm = 35 }\n'
               'gear_2 = { teeth = 40, profile_shift = 0.1, width_mm = 30, bore_diameter_mm = 70 }\n')
with open("shaft.toml", "w") as file:
    file.write('format = 1\nnote = "one step"\n[nodes]\na = { nominal_speed_rpm = 60 }\nb = {}\n[elements]\n'
               's = { type = "contour_shaft", nodes = ["a", "b"], shear_modulus_GPa = 80, density_kg_per_m3 = 7850, '
               'stations = [{ length_mm = 100, outer_diameter_mm = 50, fillet_end_mm = 4 }, '
               '{ length_mm = 100, outer_diameter_mm = 80 }] }\n')

results = {
    "gear": printed("gear", "gears.toml"),
    "exact": printed("run", "camshaft", "--set", short),
    "held": printed("run", "camshaft", "--set", "drive=held", short),
    "translational": printed("run", "two_mass_backlash"),
    "constant steps": printed("run", "two_mass_backlash", "--method", "hht:0.1", "--step", "0.001"),
    "controlled": printed("run", "gear_drive", "--set", short, "--method", "sdirk4", "--tolerance", "1e-4"),
    "accuracy": printed("run", "two_mass_backlash", "--accuracy", "1e-4"),
    "contact in N m": printed("run", "spline.toml", "--accuracy", "1e-4"),
    "statistics": printed("run", "gear_drive", "--accuracy", "1e-2"),
    "reduced": printed("run", "long.toml", "--reduce", "5%"),
    "turning": printed("run", "turning.toml"),
    "run_up": printed("run", "run_up.toml"),
    "from rest": printed("run", "from_rest.toml"),
    "friction": printed("run", models + "/vehicle_clutch/vehicle_clutch.toml"),
    "file": printed("run", "trains/at_rest.toml"),
    "modes": printed("modes", "camshaft"),
    "open": printed("modes", "gear_drive", "--contact", "open"),
    "damped": printed("modes", "turning.toml", "--damped", "--speed", "900"),
    "sweep": printed("sweep", "turning.toml", "--speeds", "300:100:1200", "--orders", "0.5,2,4", "--balance", "b",
                     "--absolute-sum"),
    "closed": printed("sweep", "camshaft", "--speeds", "600,700", "--orders", "1:1:6", "--contact", "closed"),
    "branches": printed("sweep", "pair.toml", "--speeds", "7.6,8.2", "--orders", "1", "--tolerance", "1e-3",
                        "--balance", "b"),
    "statistics of runs": printed("sweep", "chaos.toml", "--speeds", "9.549,9.55", "--orders", "1", "--tolerance",
                                  "1e-2"),
    "load beyond the cycle": printed("sweep", "uneven.toml", "--speeds", "7.6,8.2", "--cycle", "1"),
    "class": printed("class", "class.toml", "--speeds", "300:10:1000", "--orders", "2", "--contact", "closed"),
    "shaft": printed("shaft", "shaft.toml"),
    "counted": printed("run", "class.toml", "--rainflow", "z.force_N", "--energy"),
    "campbell": printed("campbell", "turning.toml", "--speeds", "300:100:1800", "--orders", "2,4"),
    "growing": printed("sweep", "governed.toml", "--speeds", "600", "--orders", "1"),
    "long sweep": printed("sweep", "many_segments.toml", "--speeds", "900", "--orders", "3000"),
    "unstable": printed("run", "two_mass_backlash", "--set", "k_1_N_per_m=2e8", "k_2_N_per_m=2e8", "--step", "1e-3",
                        code=1),
    "energy_error": printed("run", "two_mass_backlash", "--set", "k_1_N_per_m=1e6", "k_2_N_per_m=1e6", "--step",
                            "2e-3", code=1),
    "many": printed("run", "two_inertia", "torn.toml", "trains", "--out", "many", code=2),
    "varied": printed("run", "two_inertia", "--vary", "duration_s=0.01,0.02", "--out", "varied"),
    "interrupted": ended_by(signal.SIGINT, "interrupted"),
    "killed": ended_by(signal.SIGKILL, "killed"),
}
results["summary.json"] = read("many/two_inertia/summary.json")
results["runs.json"] = read("many/runs.json")
statuses = {name: result.get("status") for name, result in results.items()}
assert results["reduced"]["reduction"]["used"] and not results["exact"]["reduction"]["used"]
assert (statuses["unstable"], statuses["interrupted"], statuses["killed"]) == ("unstable", "interrupted", "running")

for name, result in results.items():
    for error in validator.iter_errors(result):
        sys.exit(f"{name}: {'/'.join(map(str, error.absolute_path))}: {error.message}")

# Every key is described, numbers with their unit, and was met with a value.
met = set()


def meet(value):
    if isinstance(value, dict):
        met.update(key for key, inner in value.items() if inner is not None)
    for inner in value.values() if isinstance(value, dict) else value if isinstance(value, list) else []:
        meet(inner)


meet(list(results.values()))
for kind, definition in schema["$defs"].items():
    for key, about in definition["properties"].items():
        assert about.get("description"), (kind, key)
        types = about.get("type", [])
        if {"number", "integer"} & set([types] if isinstance(types, str) else types):
            unit = re.search(r"\[[^]]+\]", about["description"])
            assert unit, (kind, key, "has no unit")
            suffix = re.search(r"_(deg|m|N|Nm|s|J|W|Hz|per_s)$", key)
            spelt = {"Nm": "N m", "per_s": "1/s"}
            assert not suffix or unit[0] == f"[{spelt.get(suffix[1], suffix[1])}]", (kind, key, unit[0])
        assert key in met, (kind, key, "was never met with a value")


# It can refuse.
def refused(name, change):
    wrong = copy.deepcopy(results[name])
    change(wrong)
    assert not validator.is_valid(wrong), (name, "was taken, wrong as it is")


refused("exact", lambda r: r.pop("energy"))
refused("exact", lambda r: r.pop("kind"))
refused("exact", lambda r: r.update(colour="red"))
refused("exact", lambda r: r.update(steps=1.5))
refused("exact", lambda r: r.update(status="good"))
refused("exact", lambda r: r.update({"$schema": "urn:drev:results:0"}))
refused("exact", lambda r: r["results"].update(max_torque_Nm="36602"))
refused("exact", lambda r: r["results"]["contacts"][0]["impact_speed"]["both"].pop("p99"))
refused("exact", lambda r: r.update(status="running"))  # which has no figures
refused("killed", lambda r: r.update(status="success"))  # which has them
refused("accuracy", lambda r: r["accuracy"]["figures"][0].pop("error"))
refused("reduced", lambda r: r["reduction"].pop("reason"))
refused("modes", lambda r: r["frequencies_Hz"].append("fast"))
refused("damped", lambda r: r["modes"][0]["energy"][0].pop("elastic"))
refused("sweep", lambda r: r["sections"][0].update(half_range="large"))
refused("sweep", lambda r: r.pop("criticals"))
refused("branches", lambda r: r["branches"][0]["sections"][0].pop("heat_W"))
refused("campbell", lambda r: r["modes"][0].pop("damping_ratio"))
refused("many", lambda r: r["runs"][0]["summary"].pop("results"))
refused("many", lambda r: r["runs"][1].pop("reason"))
print(len(results), "results are as the schema says")
