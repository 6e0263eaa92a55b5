"""The equation of motion of a model, evaluated from Python."""
import numpy as np

from ._modes import Modes


class System:
    """The equation of motion M z'' = force(t, z, z'), as Model.build() returns it.

    z are deviations from the nominal motion [rad or m] of the unknowns, in the order of `unknowns`; prescribed nodes
    and ideal gears are eliminated. One thread at a time may evaluate one System.
    """

    def __init__(self, handle, keep=None):
        self._handle = handle
        self._keep = keep
        #: number of unknowns
        self.size = handle.size

    @property
    def unknowns(self):
        """Names of the nodes that represent the unknowns."""
        return self._handle.unknowns

    @property
    def nodes(self):
        """The names of all nodes."""
        return self._handle.node_names

    @property
    def channels(self):
        """(name, unit) of every channel."""
        return self._handle.channels

    @property
    def breakpoints(self):
        """Times at which a load or prescribed motion has a jump or a kink [s]: integrate from one to the next."""
        return self._handle.breakpoints

    @property
    def initial(self):
        """Deviations and rates at the start."""
        return self._handle.initial

    def _writable(self, out):
        """`out`, or a new array. One that would have to be copied is refused: the copy would be filled."""
        if out is None:
            return np.empty(self.size)
        if not isinstance(out, np.ndarray):
            raise TypeError(f"out must be an array of float64, not {type(out).__name__}")
        if out.dtype != np.float64 or out.ndim != 1 or not out.flags.c_contiguous or not out.flags.writeable:
            state = ("C-contiguous" if out.flags.c_contiguous else f"strides {out.strides}") + (
                "" if out.flags.writeable else ", read-only")
            raise TypeError(
                "out must be a writable, C-contiguous array of float64 with one dimension, "
                f"not {out.dtype} of shape {out.shape}, {state}")
        return out

    def force(self, t, deviations, rates, out=None):
        """p - C z' - K z minus the forces of the laws [N m or N] at time t [s]. float64 arrays of `size` entries; `out`,
        writable and C-contiguous, is filled and returned."""
        out = self._writable(out)
        self._handle.force(t, deviations, rates, out)
        return out

    def acceleration(self, t, deviations, rates, out=None):
        """Acceleration z'' = M^-1 force [rad/s2 or m/s2]. Raises SolverError if a node has no inertia."""
        out = self._writable(out)
        self._handle.acceleration(t, deviations, rates, out)
        return out

    def modes(self, count=None, contact="closed"):
        """Undamped modes as from ModelCase.modes(): drev.Modes. The model is not built again."""
        return Modes(self._handle.modes(count, contact))

    def matrix(self, which, sparse=None):
        """ "mass", "damping" or "stiffness": constant matrices over the unknowns, laws and loads not in them.

        sparse: True: scipy.sparse.csc_matrix, on drev's memory; False: a NumPy array; None: sparse above 500 unknowns.
        """
        if which not in ("mass", "damping", "stiffness"):
            raise ValueError(f"which must be mass, damping or stiffness, not {which!r}")
        values, rows, starts = self._handle.matrix(which)
        if self.size > 500 if sparse is None else sparse:
            from scipy.sparse import csc_matrix

            return csc_matrix((values, rows, starts), shape=(self.size, self.size))
        full = np.zeros((self.size, self.size))
        full[rows, np.repeat(np.arange(self.size), np.diff(starts))] = values
        return full

    def __repr__(self):
        return f"<drev.System of {self.size} unknowns>"
