"""Steps an FMU through FMPy's classes for FMI 2 and 3, and reads what drev run writes."""
import csv
import os
import subprocess

import fmpy
import numpy
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave


class Fmu:
    """An extracted FMU, and instances of it."""

    def __init__(self, path):
        self.folder = fmpy.extract(path)
        self.description = fmpy.read_model_description(self.folder)
        self.references = {v.name: v.valueReference for v in self.description.modelVariables}
        self.three = self.description.fmiVersion.startswith("3")

    def instance(self, name="one", start_time=0.0, stop_time=None, tolerance=None, values=(), enter=True):
        arguments = dict(unzipDirectory=self.folder, modelIdentifier=self.description.coSimulation.modelIdentifier,
                         instanceName=name)
        slave = (FMU3Slave(guid=self.description.guid, **arguments) if self.three
                 else FMU2Slave(guid=self.description.guid, **arguments))
        slave.messages = []

        def log(*given):
            slave.messages.append(given[-1].decode())
        if self.three:
            slave.instantiate(logMessage=fmpy.fmi3.fmi3LogMessageCallback(log))
        else:
            slave.instantiate()
        if not enter:
            return slave
        set_values(self, slave, dict(values))
        if not self.three:
            slave.setupExperiment(startTime=start_time, stopTime=stop_time, tolerance=tolerance)
            slave.enterInitializationMode()
        else:
            slave.enterInitializationMode(startTime=start_time, stopTime=stop_time, tolerance=tolerance)
        slave.exitInitializationMode()
        return slave


def set_values(fmu, slave, values):
    for name, value in values.items():
        reference = [fmu.references[name]]
        if isinstance(value, str):
            slave.setString(reference, [value])
        elif isinstance(value, int):
            (slave.setInt32 if fmu.three else slave.setInteger)(reference, [value])
        else:
            (slave.setFloat64 if fmu.three else slave.setReal)(reference, [value])


def get(fmu, slave, names):
    references = [fmu.references[name] for name in names]
    return list((slave.getFloat64 if fmu.three else slave.getReal)(references))


def simulate(fmu, names, duration, h, inputs=None, values=(), slave=None):
    """Rows of outputs at 0, h, 2 h, ...; inputs(t): their values over the step from t."""
    slave = slave or fmu.instance(stop_time=duration, values=values)
    rows = [get(fmu, slave, names)]
    for i in range(round(duration / h)):
        if inputs:
            set_values(fmu, slave, inputs(i * h))
        slave.doStep(currentCommunicationPoint=i * h, communicationStepSize=h)
        rows.append(get(fmu, slave, names))
    assert slave.messages == [], slave.messages
    slave.terminate()
    slave.freeInstance()
    return numpy.array(rows)


def run(drev, model, names, duration, every, folder, options=(), method="exact"):
    """The same rows from drev run."""
    subprocess.run([drev, "run", model, "--method", method, "--duration", repr(duration), "--every", repr(every),
                    "--record", ",".join(names), "--out", folder, *options], check=True, stdout=subprocess.DEVNULL)
    with open(os.path.join(folder, "history.csv"), encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    head = rows[0]
    table = numpy.array([[float(cell) for cell in row] for row in rows[1:]])
    return table[:, [head.index(name) for name in names]]


def difference(a, b):
    """Largest difference of any column, relative to the column's largest value."""
    n = min(len(a), len(b))
    assert abs(len(a) - len(b)) <= 1, (len(a), len(b))
    scale = numpy.abs(b).max(axis=0)
    assert (scale > 0).all(), "a channel is zero throughout"
    return float((numpy.abs(a[:n] - b[:n]).max(axis=0) / scale).max())
