"""Results of sweeps, Campbell diagrams, judgements, advice and charts: the command's JSON, with arrays where useful."""
import html as _html
from functools import cached_property

import numpy as np

from ._run import report_frame


def _array(values):
    """The values as an array, with NaN for null (not finite)."""
    return np.array([np.nan if v is None else v for v in values], dtype=float)


class Result:
    """`data` is the object that the command prints with --json (docs/results.md)."""

    _report_keyword = True

    def __init__(self, case, command, keywords, data):
        self._case, self._command = case, command
        self._keywords = {k: v for k, v in keywords.items() if k not in ("out", "report")}
        #: the command's JSON
        self.data = data

    @cached_property
    def text(self):
        """The table that the command prints. It is computed when it is first asked for, as the result was."""
        return self._case._execute(self._command, {**self._keywords, "progress": False}, as_json=False)

    @cached_property
    def report_html(self):
        """The report as a page of HTML. It is computed when it is first asked for, as the result was."""
        return self._case._report(self._command, {**self._keywords, "progress": False})

    def _repr_html_(self):
        return report_frame(self.report_html) if self._report_keyword else f"<pre>{_html.escape(self.text)}</pre>"

    def __str__(self):
        return self.text

    def __repr__(self):
        return f"<drev.{type(self).__name__} of {self.data.get('model', self._case.name)}>"


class Section:
    """A torque or force over the speeds of a sweep. Arrays over `speeds_rpm`, of amplitudes orders x speeds."""

    def __init__(self, data):
        self.name, self.unit = data["name"], data["unit"]
        for key in ("half_range", "maximum", "minimum", "mean", "heat_W"):
            setattr(self, key, _array(data[key]))
        rows = zip(data["amplitude"], data["phase_deg"])
        #: complex amplitudes of exp(i order phi)
        self.amplitude = np.array([_array(a) * np.exp(1j * np.deg2rad(_array(p))) for a, p in rows])
        self.twist_half_range = _array(data["twist"]["half_range"]) if data.get("twist") else None

    def __repr__(self):
        return f"<drev.Section {self.name} [{self.unit}]>"


class Branch:
    """A curve of periodic motions over the speed; arrays along its arc, sections by name."""

    def __init__(self, data, names):
        self.speed_rpm = _array(data["speed_rpm"])
        self.stable = np.array([bool(s) for s in data["stable"]])
        self.separates = np.array(data["separates"], dtype=bool)
        self.error = _array(data["error"])
        self.half_range = {n: _array(s["half_range"]) for n, s in zip(names, data["sections"])}
        self.maximum = {n: _array(s["maximum"]) for n, s in zip(names, data["sections"])}
        self.minimum = {n: _array(s["minimum"]) for n, s in zip(names, data["sections"])}


class Sweep(Result):
    """Steady vibration over speed: `sections` of a linear train, `branches` and `changes` of one with contacts."""

    @property
    def is_linear(self):
        return self.data["kind"] == "sweep"

    @property
    def _report_keyword(self):
        return self.is_linear

    @cached_property
    def speeds_rpm(self):
        return _array(self.data["speeds_rpm"])

    @cached_property
    def orders(self):
        return _array(self.data["orders"])

    @cached_property
    def sections(self):
        """Sections, name -> Section; for branches only their names and units (`data`)."""
        return {s["name"]: Section(s) for s in self.data["sections"]} if self.is_linear else {}

    @cached_property
    def branches(self):
        """Curves of periodic motions of a train with contacts; empty for a linear train."""
        names = [s["name"] for s in self.data["sections"]]
        return [Branch(b, names) for b in self.data.get("branches", [])]

    @property
    def criticals(self):
        """Speeds at which an order meets a natural frequency, with the amplitudes there."""
        return self.data.get("criticals", [])

    @property
    def changes(self):
        """Folds, period doublings, openings of contacts."""
        return self.data.get("changes", [])

    def to_pandas(self):
        """Half ranges: one row for each speed (for branches: each motion), one column for each section."""
        import pandas

        if self.is_linear:
            return pandas.DataFrame(
                {name: s.half_range for name, s in self.sections.items()},
                index=pandas.Index(self.speeds_rpm, name="speed_rpm"),
            )
        parts = [
            pandas.DataFrame({"curve": i, "speed_rpm": b.speed_rpm, "stable": b.stable, **b.half_range})
            for i, b in enumerate(self.branches, 1)
        ]
        return pandas.concat(parts, ignore_index=True)

    def plot(self, *sections, backend="matplotlib", **more):
        """Plots half ranges over speed; default: every section."""
        from . import _plots

        return _plots.sweep(self, sections, backend, **more)


class Campbell(Result):
    """Damped natural frequencies over speed, and the speeds at which orders meet them."""

    @cached_property
    def speeds_rpm(self):
        """Speeds at which the frequencies are given; a single one if nothing depends on the speed."""
        return _array(self.data["mode_speeds_rpm"])

    @cached_property
    def frequency_Hz(self):
        """Damped natural frequencies, modes x speeds [Hz]; NaN where a mode is overdamped."""
        return np.array([_array(m["frequency_Hz"]) for m in self.data["modes"]])

    @cached_property
    def damping_ratio(self):
        """Damping ratios, modes x speeds [-]; NaN where a mode is overdamped."""
        return np.array([_array(m["damping_ratio"]) for m in self.data["modes"]])

    @property
    def criticals(self):
        return self.data["criticals"]

    def to_pandas(self):
        """The critical speeds, one row each."""
        import pandas

        return pandas.DataFrame(self.criticals)

    def plot(self, backend="matplotlib", **more):
        """Plots the Campbell diagram: frequencies, orders, and the speeds at which they meet."""
        from . import _plots

        return _plots.campbell(self, backend, **more)


class Judgement(Result):
    """A sweep judged by the limits of its sections (docs/class_report.md)."""


class Advice(Result):
    """The cheapest model that gives a figure accurately enough."""

    _report_keyword = False

    @property
    def chosen(self):
        """The name of the chosen model."""
        return self.data["chosen"]

    @property
    def sentence(self):
        return self.data["advice"]

    def to_pandas(self):
        """A table with one row for each model that was tried."""
        import pandas

        return pandas.DataFrame(self.data["rungs"])

    def __str__(self):
        return self.sentence


class Optimum(Result):
    """The parameters at which a figure is smallest or largest."""

    _report_keyword = False

    @property
    def value(self):
        """The best value of the figure."""
        return self.data["best"][0]["value"]

    @property
    def parameters(self):
        """The varied parameters at the best variant: name -> value."""
        return self.data["best"][0]["varied"]

    @property
    def certain(self):
        """Whether every combination was computed and has the figure, without a warning; a search proves nothing."""
        return self.data["all_combinations"] and self.data["without_figure"] == 0 and self.data["with_warning"] == 0

    @property
    def text(self):
        where = ", ".join(f"{name} {value}" for name, value in self.parameters.items())
        return f"{self.data['goal']} {self.data['figure']}: {self.value:.8g} {self.data['unit']} at {where}"

    def to_pandas(self):
        """The best variants, one row each."""
        import pandas

        return pandas.DataFrame([{**best["varied"], self.data["figure"]: best["value"]} for best in self.data["best"]])


class Chart(Result):
    """Error of the methods against processor time and work."""

    _report_keyword = False

    def plot(self, backend="matplotlib", **more):
        """Plots error over processor time, both logarithmic."""
        from . import _plots

        return _plots.chart(self, backend, **more)
