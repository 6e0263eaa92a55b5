"""Reads results/camshaft as docs/results.md shows it; arguments: the directory and a channel."""
import sys

directory, channel = sys.argv[1:]

# [csv]
import csv
import json

with open(directory + "/history.csv") as file:
    rows = csv.reader(file)
    names = next(rows)  # time_s, then the channels with their units
    history = dict(zip(names, zip(*(map(float, row) for row in rows))))
with open(directory + "/summary.json") as file:
    summary = json.load(file)
print(summary["status"], max(map(abs, history[channel])))
# [csv]

# [hdf]
import h5py

with h5py.File(directory + "/history.h5") as file:
    time, values = file["time_s"][:], file[channel][:]
    unit = file[channel].attrs["unit"]
print(len(time), "samples, largest", abs(values).max(), unit)
# [hdf]

with h5py.File(directory + "/history.h5") as file:
    assert set(file) == set(names), (set(file), names)
    for name in names:
        assert tuple(file[name][:]) == history[name], name  # to the last bit
    assert json.loads(file.attrs["summary"]) == summary
    assert file["time_s"].attrs["unit"] == "s" and len(unit) > 0
