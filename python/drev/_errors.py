"""Errors: all faults are reported together, each finding with its place, value, unit and admissible range."""
import re
from typing import NamedTuple

#: Name of the Python keyword for each option of the command line; filled by _commands.
keyword_of = {"MODEL": "model"}


class Finding(NamedTuple):
    """One fault of a model, a parameter or an argument."""

    place: str  #: model, node, element and key, or "arguments"
    parameter: str  #: name as it was given; "" if the place has it
    value: str  #: value as it was given
    unit: str  #: unit of the value; "" if it has none
    range: str  #: admissible range, e.g. "must be >= 0"

    def __str__(self):
        value = f" = {self.value} {self.unit}".rstrip() if self.value else ""
        head = ": ".join(part for part in (self.place, f"{self.parameter}{value}") if part)
        return f"{head}, {self.range}" if self.range else head


class ModelError(ValueError):
    """Bad input: an invalid model, parameter or argument. `findings` has all faults."""

    def __init__(self, findings):
        self.findings = list(findings)
        lines = [str(finding) for finding in self.findings]
        super().__init__(lines[0] if len(lines) == 1 else f"{len(lines)} faults:\n  " + "\n  ".join(lines))

    def __reduce__(self):
        return type(self), (self.findings,)


class SolverError(RuntimeError):
    """A computation that failed. `result` has the partial result of a run; None: there is none."""

    def __init__(self, message, result=None):
        super().__init__(message)
        self.result = result


class OutputError(OSError):
    """A file that could not be written."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C ended a run. `result` and drev.last_interrupted() have its partial result."""

    def __init__(self, message, result=None):
        super().__init__(message)
        self.result = result


class NotTrustedWarning(UserWarning):
    """A run reached its end, but the error of its energy balance is too large, or it has a warning: it does not start in the
    steady state that was asked for, say."""


class SlowWarning(UserWarning):
    """A law or load is a Python callable, which is about a thousand times as expensive as one of the catalogue."""


def _in_python(text):
    return re.sub(r"--[a-z]+(?:-[a-z]+)*", lambda m: keyword_of.get(m.group(0), m.group(0)), text)


def _finding(place, parameter, value, unit, text):
    if place == "command line":
        return Finding("arguments", keyword_of.get(parameter, _in_python(parameter)), value, unit, _in_python(text))
    return Finding(place, parameter, value, unit, _in_python(text))


# Called by the extension module, which raises what they return.
def model_error(findings):
    return ModelError([_finding(*finding) for finding in findings])


def solver_error(message):
    return SolverError(_in_python(message))


def output_error(message):
    return OutputError(message)
