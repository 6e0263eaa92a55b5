"""drev: torsional dynamics of drivetrains. docs/python.md is the guide; help(drev.Model) begins with an example."""
from ._case import (
    ModelCase,
    compare_reports,
    import_model,
    last_interrupted,
    load,
    load_plugins,
    models,
    source_study,
)
from ._drev import __version__
from ._errors import Finding, Interrupted, ModelError, NotTrustedWarning, OutputError, SlowWarning, SolverError
from ._model import Model
from ._modes import DampedModes, Modes
from ._run import Figure, Run
from ._study import Study
from ._system import System
from ._tables import Advice, Branch, Campbell, Chart, Judgement, Optimum, Result, Section, Sweep
from ._variants import Variant, Variants

__all__ = [name for name in dir() if not name.startswith("_")] + ["__version__"]
