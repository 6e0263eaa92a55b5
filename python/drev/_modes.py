"""Modes as NumPy arrays on drev's own memory, read-only."""
from functools import cached_property

from ._run import Stored


class _Table:
    """The rows of a table as a DataFrame, HTML and text."""

    _ask = None

    def _columns(self):
        raise NotImplementedError

    @cached_property
    def data(self):
        """The object that `drev modes` prints with --json. It is computed when it is first asked for, as the modes were.
        None: the modes are those of a drev.System, which no command computes."""
        return self._ask and self._ask()

    def to_pandas(self):
        """A pandas.DataFrame with one row for each mode."""
        import pandas

        columns = self._columns()
        return pandas.DataFrame(columns, index=pandas.RangeIndex(1, len(self) + 1, name="mode"))

    def _rows(self):
        columns = self._columns()
        return list(columns), [[f"{v:.7g}" for v in row] for row in zip(*columns.values())]

    def __str__(self):
        names, rows = self._rows()
        rows = [["mode"] + names] + [[str(i)] + row for i, row in enumerate(rows, 1)]
        widths = [max(len(row[c]) for row in rows) for c in range(len(rows[0]))]
        return "\n".join("  ".join(cell.rjust(w) for cell, w in zip(row, widths)) for row in rows)

    def _repr_html_(self):
        names, rows = self._rows()
        head = "".join(f"<th>{name}</th>" for name in ["mode"] + names)
        body = "".join(
            f"<tr><td>{i}</td>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for i, row in enumerate(rows, 1)
        )
        return f"<table><tr>{head}</tr>{body}</table>"


class _Kept:
    """What data is in another process."""

    def __init__(self, data):
        self._data = data

    def __call__(self):
        return self._data


class Modes(_Table):
    """Undamped elastic modes K x = omega^2 M x, contacts in the state `contact`."""

    def __init__(self, handle, ask=None):
        self._handle = handle
        self._ask = ask
        self.model = handle.model
        #: number of modes with 0 Hz, which are not among those below
        self.rigid_modes = handle.rigid_modes
        self.contact = handle.contact
        #: how the modes were found, in one line
        self.how = handle.how
        #: rows of `shapes`
        self.nodes = handle.nodes

    def __reduce__(self):
        names = ("model", "rigid_modes", "contact", "how", "nodes", "frequency_Hz", "error_Hz", "shapes")
        return Modes, (Stored(self._handle, names, {}), _Kept(self.data))

    @cached_property
    def frequency_Hz(self):
        """Natural frequencies in ascending order [Hz]."""
        return self._handle.frequency_Hz

    @cached_property
    def error_Hz(self):
        """Error of each frequency by rounding [Hz]."""
        return self._handle.error_Hz

    @cached_property
    def shapes(self):
        """Mode shapes, nodes x modes; x' M x = 1, the entry of largest magnitude is positive."""
        return self._handle.shapes

    def _columns(self):
        return {"frequency_Hz": self.frequency_Hz, "error_Hz": self.error_Hz}

    def __len__(self):
        return len(self.frequency_Hz)

    def plot(self, *modes, backend="matplotlib", **more):
        """Plots the shapes over the nodes; modes: numbers from 1, default: the first four."""
        from . import _plots

        return _plots.modes(self, modes, backend, **more)

    def __repr__(self):
        return f"<drev.Modes of {self.model}: {len(self)} elastic, {self.rigid_modes} rigid, contacts {self.contact}>"


class DampedModes(_Table):
    """Damped oscillating modes of (lambda^2 M + lambda C + K) x = 0."""

    def __init__(self, handle, ask=None):
        self._handle = handle
        self._ask = ask
        self.model = handle.model
        self.rigid_modes = handle.rigid_modes
        self.contact = handle.contact
        #: rows of `shapes`
        self.nodes = handle.nodes
        #: rows of kinetic, elastic and dissipated
        self.elements = handle.elements

    def __reduce__(self):
        names = ("model", "rigid_modes", "contact", "nodes", "elements", "eigenvalues", "frequency_Hz",
                 "natural_frequency_Hz", "damping_ratio", "real_eigenvalues", "shapes")
        return DampedModes, (Stored(self._handle, names, {"energy": ("kinetic", "elastic", "dissipated")}), _Kept(self.data))

    @cached_property
    def eigenvalues(self):
        """Eigenvalues lambda [1/s], Im > 0."""
        return self._handle.eigenvalues

    @cached_property
    def frequency_Hz(self):
        """Damped natural frequencies Im lambda / (2 pi) [Hz]."""
        return self._handle.frequency_Hz

    @cached_property
    def natural_frequency_Hz(self):
        """Natural frequencies |lambda| / (2 pi) [Hz]."""
        return self._handle.natural_frequency_Hz

    @cached_property
    def damping_ratio(self):
        """Damping ratios -Re lambda / |lambda| [-]."""
        return self._handle.damping_ratio

    @cached_property
    def real_eigenvalues(self):
        """Real eigenvalues, of the speeds of rigid-body motions and of overdamped modes [1/s]."""
        return self._handle.real_eigenvalues

    @cached_property
    def shapes(self):
        """Complex mode shapes, nodes x modes; the entry of largest magnitude is 1."""
        return self._handle.shapes

    @property
    def kinetic(self):
        """Share of each element in each mode's kinetic energy: elements x modes."""
        return self._handle.energy("kinetic")

    @property
    def elastic(self):
        """Share of each element in each mode's elastic energy: elements x modes."""
        return self._handle.energy("elastic")

    @property
    def dissipated(self):
        """Share of each element in the heat of a cycle of each mode: elements x modes."""
        return self._handle.energy("dissipated")

    def _columns(self):
        return {
            "frequency_Hz": self.frequency_Hz,
            "modulus_Hz": self.natural_frequency_Hz,
            "damping_ratio": self.damping_ratio,
        }

    def __len__(self):
        return len(self.frequency_Hz)

    def plot(self, *modes, backend="matplotlib", **more):
        """Plots the amplitudes of the shapes over the nodes; modes: numbers from 1, default: the first four."""
        from . import _plots

        return _plots.modes(self, modes, backend, **more)

    def __repr__(self):
        return f"<drev.DampedModes of {self.model}: {len(self)}, contacts {self.contact}>"
