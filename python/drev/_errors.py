"""Errors: everything that is wrong comes at once, each finding with its place, value, unit and admissible range."""
import re
from typing import NamedTuple

#: What the command line calls an option, and Python a keyword: filled by _commands.
keyword_of = {"MODEL": "model"}


class Finding(NamedTuple):
    """One thing that is wrong."""

    place: str  #: model, node, element and key, or "arguments"
    parameter: str  #: as it was spelled; "" where the place says it
    value: str  #: as it was given
    unit: str  #: "" if it has none
    range: str  #: what is admissible, e.g. "must be >= 0"

    def __str__(self):
        value = f" = {self.value} {self.unit}".rstrip() if self.value else ""
        head = ": ".join(part for part in (self.place, f"{self.parameter}{value}") if part)
        return f"{head}, {self.range}" if self.range else head


class ModelError(ValueError):
    """Bad input: a model, a parameter or an argument that cannot be. `findings` has everything that is wrong."""

    def __init__(self, findings):
        self.findings = list(findings)
        lines = [str(finding) for finding in self.findings]
        super().__init__(lines[0] if len(lines) == 1 else f"{len(lines)} faults:\n  " + "\n  ".join(lines))

    def __reduce__(self):
        return type(self), (self.findings,)


class SolverError(RuntimeError):
    """A computation that could not do its job. `result` has what there is of a run; None: nothing."""

    def __init__(self, message, result=None):
        super().__init__(message)
        self.result = result


class OutputError(OSError):
    """A file that could not be written."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C ended a run. `result` has what there is of it, and drev.last_interrupted() too."""

    def __init__(self, message, result=None):
        super().__init__(message)
        self.result = result


class NotTrustedWarning(UserWarning):
    """A run came to its end, but its energy balance is off."""


class SlowWarning(UserWarning):
    """A law or load is a Python callable, which costs about a thousand times what one of the catalogue does."""


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
