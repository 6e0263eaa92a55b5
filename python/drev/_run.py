"""Results of a run: figures with their errors, and the recorded channels as NumPy arrays on drev's own memory."""
import html as _html
import json
from functools import cached_property
from typing import NamedTuple, Optional


class Figure(NamedTuple):
    """A figure of a run. error: absolute error in the same unit; None: not checked (see run(accuracy=...))."""

    value: float
    error: Optional[float] = None
    unit: str = ""
    of: str = ""  #: element or channel that the figure belongs to

    def __float__(self):
        return float(self.value)

    def __str__(self):
        error = "" if self.error is None else f" +- {self.error:.2g}"
        of = f" ({self.of})" if self.of else ""
        return f"{self.value:.7g}{error} {self.unit}{of}".rstrip()


#: key of the summary's results -> keys of its error, unit, of
_FIGURES = {
    "deflection_deg": ("deflection_error", "deg", "deflection_of"),
    "deflection_m": ("deflection_error", "m", "deflection_of"),
    "max_torque_Nm": ("max_error", "N m", "max_torque_at"),
    "max_force_N": ("max_error", "N", "max_force_at"),
    "max_mesh_force_N": ("max_mesh_force_error", "N", "max_mesh_force_at"),
    "static_torque_Nm": (None, "N m", "static_at"),
    "static_force_N": (None, "N", "static_at"),
    "dynamic_amplification": (None, "", None),
}
_CONTACT_FIGURES = {
    "front_contacts": ("front_contacts_error", ""),
    "back_contacts": ("back_contacts_error", ""),
    "time_separated_s": ("time_separated_error_s", "s"),
    "max_force_N": ("max_force_error_N", "N"),
    "max_torque_Nm": ("max_torque_error_Nm", "N m"),
}


class Stored:
    """What a handle of the extension module gives, on Python's memory: results are pickled with it in the handle's place.

    names: its attributes. calls: {method: arguments}, what each of its methods returns for each argument.
    """

    def __init__(self, handle, names, calls):
        self._given = {name: getattr(handle, name) for name in names}
        self._calls = {name: {a: getattr(handle, name)(a) for a in arguments} for name, arguments in calls.items()}

    def __getattr__(self, name):
        if name in self.__dict__.get("_given", {}):
            return self._given[name]
        if name in self.__dict__.get("_calls", {}):
            return self._calls[name].__getitem__
        raise AttributeError(name)


def report_frame(page, height=760):
    """The report page in a separate frame, for notebooks."""
    return (
        f'<iframe srcdoc="{_html.escape(page, quote=True)}" style="width:100%;height:{height}px;border:1px solid #ccc">'
        "</iframe>"
    )


class Run:
    """A run in time. run["shaft.torque_Nm"] is a channel over run.time, read-only and without a copy."""

    def __init__(self, handle, report_html=None, keep=None):
        self._handle = handle
        self._keep = keep
        #: the report as an HTML page; None: it was not requested
        self.report_html = report_html
        #: "success", or the kind of failure in one word (docs/results.md)
        self.status = handle.status
        self._column = {name: i for i, (name, _) in enumerate(handle.channels)}
        #: unit of each channel
        self.units = dict(handle.channels)

    def __reduce__(self):
        names = ("status", "channels", "json", "text", "notes", "times")
        return Run, (Stored(self._handle, names, {"samples": range(len(self._column))}), self.report_html)

    @property
    def ok(self):
        """True for success only."""
        return self.status == "success"

    @cached_property
    def summary(self):
        """All results, as in summary.json (docs/results.md)."""
        return json.loads(self._handle.json)

    @property
    def text(self):
        """The table that `drev run` prints."""
        return self._handle.text

    @property
    def notes(self):
        """Sentences on the run and its files."""
        return list(self.summary["notes"]) + list(self._handle.notes)

    @property
    def t_end(self):
        """Time that the run reached [s]."""
        return self.summary["t_end_s"] if "t_end_s" in self.summary else 0.0

    @cached_property
    def time(self):
        """Times of the samples [s]."""
        return self._handle.times

    @property
    def channels(self):
        """The names of the recorded channels."""
        return list(self._column)

    def __getitem__(self, channel):
        if channel not in self._column:
            raise KeyError(f"{channel!r} was not recorded; there are {', '.join(self._column)}")
        return self._handle.samples(self._column[channel])

    def __contains__(self, channel):
        return channel in self._column

    def keys(self):
        """The names of the recorded channels, so that dict(run) has the samples of each."""
        return self.channels

    def __iter__(self):
        return iter(self._column)

    def __len__(self):
        return len(self.time)

    @cached_property
    def figures(self):
        """Figures, name -> Figure(value, error, unit, of): largest values, contacts, and those of run(accuracy=...)."""
        results = self.summary["results"]
        found = {}
        for key, (error, unit, of) in _FIGURES.items():
            if results.get(key) is not None:
                found[key] = Figure(results[key], results[error] if error else None, unit, results.get(of) or "")
        for contact in results["contacts"]:
            for key, (error, unit) in _CONTACT_FIGURES.items():
                if contact[key] is not None:
                    name = f"{contact['element']}.{key}"
                    found[name] = Figure(contact[key], contact[error], unit, contact["element"])
        accuracy = self.summary.get("accuracy")
        for figure in accuracy["figures"] if accuracy else []:
            found[figure["name"]] = Figure(figure["value"], figure["error"], figure["unit"] or "")
        return found

    @property
    def contacts(self):
        """Statistics of each contact: impacts, time separated, forces and speeds with their distributions."""
        return self.summary["results"]["contacts"]

    def to_pandas(self):
        """A pandas.DataFrame with one column for each channel, over time_s."""
        import pandas

        return pandas.DataFrame(
            {name: self[name] for name in self._column}, index=pandas.Index(self.time, name="time_s")
        )

    def to_xarray(self):
        """An xarray.Dataset with one variable for each channel, with its unit, over time_s."""
        import xarray

        return xarray.Dataset(
            {name: ("time_s", self[name], {"units": self.units[name]}) for name in self._column},
            {"time_s": ("time_s", self.time, {"units": "s"})},
            {"model": self.summary["model"], "method": self.summary["method"], "status": self.status},
        )

    def plot(self, *channels, backend="matplotlib", **more):
        """Plots channels over time, one panel for each unit; default: all. backend: "matplotlib" or "plotly"."""
        from . import _plots

        return _plots.history(self, channels or self.channels, backend, **more)

    def plot_contacts(self, backend="matplotlib", **more):
        """Plots the impacts of each contact and their speeds."""
        from . import _plots

        return _plots.contacts(self, backend, **more)

    def _repr_html_(self):
        if self.report_html:
            return report_frame(self.report_html)
        return f"<pre>{_html.escape(self.text)}</pre>"

    def __repr__(self):
        return f"<drev.Run of {self.summary['model']}: {self.status}, {self.t_end} s, {len(self)} samples>"

    def __str__(self):
        return self.text
