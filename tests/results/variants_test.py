"""variants.json is as docs/variants.schema.json says, and variants.h5 has its rows; arguments: drev, the schema, a folder."""
import json
import os
import subprocess
import sys

import h5py
import jsonschema

from schema import opened

drev, schema_path, folder = sys.argv[1:]
schema, validator = opened(schema_path, folder)


def study(out, *words, code=0):
    run = subprocess.run([drev, "run", *words, "--table", "--json", "--out", out], capture_output=True, text=True)
    assert run.returncode == code, (words, run.returncode, run.stderr)
    result = json.loads(run.stdout)
    errors = list(validator.iter_errors(result))
    assert not errors, errors
    return result


results = [
    study("sobol", "gear_drive", "--vary", "backlash_mm=uniform(0.1,0.2)", "--vary", "engine_rpm=normal(750,10)",
          "--sample", "saltelli:64", "--step", "2e-5", "--duration", "0.02"),
    study("correlated", "gear_drive", "--vary", "backlash_mm=uniform(0.1,0.2)", "--vary", "engine_rpm=normal(750,10)",
          "--sample", "lhs:20", "--correlate", "backlash_mm,engine_rpm=0.5", "--method", "exact"),
    study("orders", "camshaft", "--set", "cylinders=6", "drive=held", "--vary", "firing_order=orders(6)",
          "--record", "end.angle_rad", "--step", "1e-4", "--duration", "0.01"),
    study("failed", "gear_drive", "--vary", "backlash_mm=0.1,-1", "--duration", "0.01", code=2)]

with open(os.path.join(os.path.dirname(schema_path), "optimum.schema.json")) as file:
    optimum_schema = json.load(file)
jsonschema.Draft202012Validator.check_schema(optimum_schema)
run = subprocess.run([drev, "optimise", "gear_drive", "--minimise", "max_mesh_force_N", "--step", "2e-5", "--duration", "0.01",
                      "--vary", "backlash_mm=uniform(0.1,0.2)", "--variants", "12", "--json"], capture_output=True, text=True)
assert run.returncode == 0, run.stderr
optimum = json.loads(run.stdout)
jsonschema.Draft202012Validator(optimum_schema).validate(optimum)
assert optimum.keys() == optimum_schema["properties"].keys() and optimum["status"] == "success" and len(optimum["best"]) == 10

met = set()


def note(value, at, path):
    """The keys of the schema that a value meets."""
    if "$ref" in at:
        name = at["$ref"].split("/")[-1]
        return note(value, schema["$defs"][name], name)
    for part in at.get("anyOf", []):
        if value is not None or part.get("type") == "null":
            note(value, part, path)
    if isinstance(value, dict):
        for key, part in at.get("properties", {}).items():
            if value.get(key) is not None:
                met.add(path + "." + key)
            note(value.get(key), part, path + "." + key)
    if isinstance(value, list):
        for item in value:
            note(item, at.get("items", {}), path)


def keys(at, path):
    for key, part in at.get("properties", {}).items():
        yield path + "." + key
        yield from keys(part, path + "." + key)
    if "items" in at:
        yield from keys(at["items"], path)


for result in results:
    note(result, schema, "")
unmet = set(keys(schema, "")) - met
for name, part in schema["$defs"].items():
    unmet |= set(keys(part, name)) - met
assert not unmet, sorted(unmet)

with h5py.File("orders/variants.h5") as file:
    assert file["firing_order"].shape == (120,) and file["firing_order"][0] == b"1-2-3-4-5-6"
    assert h5py.check_enum_dtype(file["status"].dtype)["success"] == 0 and not file["status"][:].any()
    summary = results[2]
    assert json.loads(file.attrs["summary"]) == summary
    for figure in summary["figures"]:
        column = file[figure["name"]]
        assert column.attrs["unit"] == figure["unit"]
        if figure["count"] == 0:
            continue
        assert abs(column[:].mean() - figure["mean"]) <= 1e-12 * abs(column[:]).max()
        assert abs(column[:].std(ddof=1) - figure["deviation"]) <= 1e-9 * abs(column[:]).max()
        assert column[figure["max"]["variant"]] == column[:].max() == figure["max"]["value"]
        assert sum(figure["histogram"]) == 120
    assert (file["end.angle_rad.max"][:] >= file["end.angle_rad.min"][:]).all()
with h5py.File("correlated/variants.h5") as file:
    assert sorted(int((x - 0.1) / 0.1 * 20) for x in file["backlash_mm"][:]) == list(range(20))
print(len(results), "studies are as the schema says")
