"""Tables of sweeps in an HDF5 file are those of the CSV files; arguments: drev, the folder of models, a folder.

Every column of every table is compared, of a linear sweep and of one with branches, and the summary.
"""
import csv
import json
import math
import os
import shutil
import subprocess
import sys

import h5py

drev, models, folder = sys.argv[1:]
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
os.chdir(folder)


def sweep(out, *words):
    subprocess.run([drev, "sweep", *words, "--out", out, "--quiet"], check=True)


def same(text, value):
    if isinstance(value, bytes):
        return text == value.decode()
    return math.isnan(value) if text == "" else float(text) == value


def compare(words, tables):
    sweep("tables", *words)
    sweep("new/tables.h5", *words)
    columns = 0
    with h5py.File("new/tables.h5") as file:
        assert sorted(file) == sorted(tables), list(file)
        with open("tables/summary.json") as summary:
            assert json.loads(file.attrs["summary"])["kind"] == json.load(summary)["kind"]
        for table in tables:
            with open(f"tables/{table}.csv", newline="") as text:
                names, *rows = csv.reader(text)
            for c, name in enumerate(names):
                values = file[table][name][:]
                assert len(values) == len(rows), (table, name, len(values), len(rows))
                assert all(same(row[c], value) for row, value in zip(rows, values)), (table, name)
                columns += 1
            assert len(file[table]) == len(names), table
    shutil.rmtree("tables")
    return columns


linear = compare([models + "/engine/engine.toml", "--speeds", "700:50:1500"], ["sweep", "orders", "criticals"])
nonlinear = compare([models + "/gear_pair/gear_pair.toml", "--speeds", "1500:200:2500"],
                    ["branches", "orders", "changes"])
assert linear > 40 and nonlinear > 15, (linear, nonlinear)
refused = subprocess.run([drev, "sweep", models + "/engine/engine.toml", "--speeds", "900",
                          "--out", "new/tables.h5/no.h5"], capture_output=True, text=True)
assert refused.returncode != 0 and "tables.h5" in refused.stderr, refused.stderr
print(linear, "and", nonlinear, "columns")
