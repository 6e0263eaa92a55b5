"""A model and the computations with it: the commands of drev, one method each."""
import contextlib
import copy
import json
import os
import re
import tempfile
import warnings

from . import _commands, _drev, _errors, _progress, _study
from ._modes import DampedModes, Modes
from ._run import Run
from ._system import System
from ._tables import Advice, Campbell, Chart, Judgement, Optimum, Result, Sweep
from ._variants import Variants

_last_interrupted = None

_PROGRESS = ("progress", "True (default): a bar in a terminal or notebook; False: none; or a callable (part, seconds left)")


def last_interrupted():
    """The partial result of the run that Ctrl-C ended last; None: there was none."""
    return _last_interrupted


def _parameter_text(value):
    if isinstance(value, bool):
        return str(value).lower()
    return value if isinstance(value, str) else repr(float(value)) if isinstance(value, float) else str(value)


class ModelCase:
    """A model with its parameters and runs. drev.load() reads one, drev.Model makes one."""

    def __init__(self, model, run=None, parameters=None):
        self._model = os.fspath(model)
        self._run = run
        self._parameters = dict(parameters or {})

    # Attributes that the extension module reads.
    def _text(self):
        return None

    def _keep(self):
        """The objects that must live as long as a result of this model."""
        return None

    def _request(self, command, keywords, function=None, progress=None, stop=None, name=None, words=None):
        keywords = dict(keywords)
        more = keywords.pop("parameters", None) or {}
        options = {**_commands.options(command, keywords, function or command), **(words or {})}
        if self._run is not None:
            options.setdefault("--run", [self._run])
        parameters = [(k, _parameter_text(v)) for k, v in {**self._parameters, **more}.items()]
        if command == "run":
            options["MODEL"] = [self._model]
        return _drev.Request(command, name or self._model, self._text(), parameters, options, progress, stop)

    @contextlib.contextmanager
    def _findings(self):
        """Findings on a model made in Python name its elements, not lines of the text made from it."""
        try:
            yield
        except _errors.ModelError as error:
            if self._text() is None:
                raise
            place = re.compile(re.escape(self._model) + r":\d+:\d+(: )?")
            findings = [
                f._replace(place=place.sub("", f.place) or self._model, range=place.sub("", f.range))
                for f in error.findings
            ]
            raise _errors.ModelError(findings) from None

    def _execute(self, command, keywords, function=None, as_json=True, words=None):
        keywords = dict(keywords)
        bar = _progress.told(keywords.pop("progress", None))
        try:
            with self._findings():
                code, text = _drev.execute(self._request(command, keywords, function, bar, words=words), as_json)
        finally:
            _progress.close(bar)
        return json.loads(text) if as_json else text

    def _report(self, command, keywords):
        """The report page that the command writes with --report."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "report.html")
            self._execute(command, {**keywords, "report": path})
            with open(path, encoding="utf-8") as file:
                return file.read()

    def _result(self, kind, command, keywords, function=None):
        return kind(self, command, keywords, self._execute(command, keywords, function))

    @property
    def name(self):
        """The name of the model, or of the file that it is read from."""
        return self._model

    def set(self, **parameters):
        """The same model with other values of the named parameters (see `parameters`)."""
        case = copy.copy(self)
        case._parameters = {**self._parameters, **parameters}
        return case

    @property
    def info(self):
        """Parameters, runs and channels of the model, as `drev list MODEL --json` gives them."""
        return self._execute("list", {})

    @property
    def parameters(self):
        """The model's parameters: name -> {unit, default, range, meaning, ...}."""
        return {p["name"]: p for p in self.info["parameters"]}

    @property
    def channels(self):
        """Every channel that can be recorded: name -> unit."""
        return dict(self.build().channels)

    @_commands.documented(
        "run",
        """Simulates the model in time and returns a drev.Run.

Raises ModelError for bad input, SolverError where the run failed (what there is: error.result), Interrupted where
Ctrl-C ended it (error.result); warns with NotTrustedWarning where the energy balance is off, or the run warns of something
else (summary["warnings"]).""",
        ("parameters", "{name: value} of the model, on top of those of the model case"),
        ("report_html", "True: the run has its report, which a notebook shows (default: in notebooks)"),
        _PROGRESS,
    )
    def run(self, *, progress=None, parameters=None, report_html=None, **options):
        return self._simulate(options, progress, parameters, report_html)

    def _simulate(self, options, progress=None, parameters=None, report_html=None, stop=None):
        global _last_interrupted
        if report_html is None:
            report_html = _progress.in_notebook() and not options.get("report")
        bar = _progress.told(progress)
        with contextlib.ExitStack() as stack:
            stack.callback(_progress.close, bar)
            path = None
            if report_html:
                path = os.path.join(stack.enter_context(tempfile.TemporaryDirectory()), "report.html")
                options = {**options, "report": path}
            stack.enter_context(self._findings())
            request = self._request("run", {**options, "parameters": parameters}, "run", bar, stop)
            handle = _drev.run(request)
            html = None
            if path and os.path.exists(path):
                with open(path, encoding="utf-8") as file:
                    html = file.read()
        run = Run(handle, html, self._keep())
        message = f"{self.name}: {run.status}: {_errors._in_python(run.summary['reason'] or handle.warning)}"
        if run.status == "interrupted" or handle.stopped:
            _last_interrupted = run
            raise _errors.Interrupted(f"{self.name}: interrupted at t = {run.t_end} s", run)
        if run.status == "output_error" or not handle.written:
            raise _errors.OutputError("; ".join(handle.notes) or message)
        if run.status == "energy_error":
            warnings.warn(message, _errors.NotTrustedWarning, stacklevel=3)
        elif run.status != "success":
            raise _errors.SolverError(message, run)
        for warning in run.summary["warnings"]:
            warnings.warn(f"{self.name}: {_errors._in_python(warning)}", _errors.NotTrustedWarning, stacklevel=3)
        return run

    @_commands.documented("modes", "Natural frequencies and shapes without damping: drev.Modes.", _PROGRESS)
    def modes(self, *, progress=None, **options):
        for keyword in ("speed_rpm", "out"):
            if options.pop(keyword, None) is not None:
                raise TypeError(f"{keyword} is an argument of damped_modes()")
        with self._findings():
            handle = _drev.modes(self._request("modes", options, "modes", _progress.told(progress)))
        return Modes(handle, lambda: self._execute("modes", options, "modes"))

    @_commands.documented(
        "modes", "Eigenvalues, damping ratios, complex shapes and energies: drev.DampedModes.", _PROGRESS
    )
    def damped_modes(self, *, progress=None, **options):
        with self._findings():
            request = self._request("modes", options, "damped_modes", _progress.told(progress))
            handle = _drev.damped_modes(request)
        asked = {**options, "out": None}
        return DampedModes(handle, lambda: self._execute("modes", asked, "damped_modes", words={"--damped": [""]}))

    @_commands.documented(
        "sweep",
        """Steady vibration by orders over speed: drev.Sweep. Of a model with contacts, branches and jumps.

`speeds_rpm` must be given: an ascending sequence, or "FIRST:STEP:LAST".""",
        _PROGRESS,
    )
    def sweep(self, **options):
        return self._result(Sweep, "sweep", options)

    @_commands.documented(
        "campbell", "Damped natural frequencies over speed, and where orders meet them: drev.Campbell.", _PROGRESS
    )
    def campbell(self, **options):
        return self._result(Campbell, "campbell", options)

    @_commands.documented(
        "class", "Judges a sweep by what sections may carry, as `drev class` does: drev.Judgement.", _PROGRESS
    )
    def judge(self, **options):
        return self._result(Judgement, "class", options, "judge")

    @_commands.documented(
        "advise", "The cheapest model that finds a figure well enough, measured: drev.Advice.", _PROGRESS
    )
    def advise(self, **options):
        return self._result(Advice, "advise", options)

    @_commands.documented("chart", "Error of the methods against run time and work: drev.Chart.", _PROGRESS)
    def chart(self, **options):
        return self._result(Chart, "chart", options)

    def accuracy(self, accuracy=1e-6, **options):
        """The figures of a run with their errors: run(accuracy=...).figures, name -> drev.Figure."""
        return self.run(accuracy=accuracy, **options).figures

    def vary(self, values, *, jobs=None, progress=None, **options):
        """A run for each combination of parameter values, in parallel: drev.Variants.

        values: {name: values}, values a sequence, or a text such as "1:0.5:3" or "a,b,c".
        jobs: number of parallel runs; default: one per processor. Other arguments: those of run(); with out=DIR each
        run writes its files to DIR/NAME=VALUE. A failed run is among the results with its error.
        """
        for keyword in ("sample", "correlate"):
            if options.get(keyword) is not None:
                raise TypeError(f"{keyword} is an argument of study(), which draws from distributions")
        return Variants._compute(self, values, jobs, progress, options)

    def study(
        self, values, *, sample=None, correlate=None, client=None, jobs=None, progress=None, out=None, resume=False, **options
    ):
        """A row of figures for each of many variants, in lockstep if steps are constant: drev.Study (docs/reliability.md).

        values: {name: values}, values a sequence, or a text: "1:0.5:3", "orders(9)", with a sample "uniform(1,2)",
        "normal(1,0.1)". sample: "lhs:1000", "sobol:1000", ...; correlate: {(name, name): correlation}. client: a
        dask.distributed.Client, or an executor of concurrent.futures, whose workers have drev; default: `jobs` threads.
        out: a folder in which each block of variants is on the disk before it counts as done, and at the end the table
        variants.h5 and variants.json, as `drev run --table` writes them; resume: continues the study in this folder,
        which must be the same one, or begins it. Other arguments: those of run(), such as step_s and duration_s.
        """
        return _study.compute(self, values, sample, correlate, client, jobs, progress, out, resume, options)

    @_commands.documented(
        "optimise",
        """The parameters at which a figure is least, or largest: drev.Optimum (docs/parameter_study.md).

`values`: {name: values}, values a sequence or a text: "uniform(1,2)", "1:0.5:3", "orders(9)". `minimise` or `maximise`
must be given: a figure, such as "max_torque_Nm". Warns with NotTrustedWarning of what the best variant's run warns of.""",
        ("jobs", "so many threads; default: one a processor"),
        _PROGRESS,
    )
    def optimise(self, values, *, jobs=None, **options):
        words = {"--vary": [f"{name}={_study._distribution(given)}" for name, given in values.items()]}
        if jobs is not None:
            words["--jobs"] = [str(jobs)]
        found = Optimum(self, "optimise", options, self._execute("optimise", options, words=words))
        if found.data["status"] == "failed":
            raise _errors.SolverError(f"{self.name}: no variant has a {found.data['figure']}", found)
        for best in found.data["best"][:1]:
            if best["warning"]:
                warnings.warn(f"{self.name}: {_errors._in_python(best['warning'])}", _errors.NotTrustedWarning, stacklevel=2)
        return found

    def _study_request(self, keywords, words):
        """The request for the study, and its picklable part."""
        options = {**_commands.options("run", dict(keywords), "run"), **words, "MODEL": [self._model]}
        if self._run is not None:
            options.setdefault("--run", [self._run])
        parameters = [(k, _parameter_text(v)) for k, v in self._parameters.items()]
        spec = (self._model, self._text(), parameters, options)
        return _drev.Request("run", *spec, None, None), spec

    def check(self):
        """Checks the model: the counts of nodes and elements, and the runs. Raises ModelError with all faults."""
        return self._execute("check", {})

    def build(self):
        """The equation of motion of the model for evaluation in Python: drev.System."""
        with self._findings():
            return System(_drev.build(self._request("list", {}, "build")), self._keep())

    def to_toml(self):
        """The model as the text of a model file with its parameters evaluated: every number with all digits."""
        return self._execute("export", {}, as_json=False)

    def export_fmu(self, path, **options):
        """Writes the model as an FMU for co-simulation, `path`, which ends in .fmu (docs/fmi.md).

        Options, as for the command: torque and speed (nodes whose torque [N m] or speed [rad/s] is an input), record
        (channels that are outputs), fmi ("3" or "2").
        """
        self._execute("export", {"fmu": path, **options}, "export_fmu", as_json=False)

    def save(self, path):
        """Writes the model file `path`, which ends in .toml."""
        self._execute("export", {"out": path}, "save", as_json=False)

    def __repr__(self):
        set_to = "".join(f", {k}={v!r}" for k, v in self._parameters.items())
        return f"<drev.{type(self).__name__} {self.name!r}{set_to}>"


def load(model, run=None, **parameters):
    """Loads a model file (FILE.toml) or a built-in model by its name (drev.models()), with values of its parameters.

    run: name of the run in the file, [run.NAME]; default: its [run]. Raises ModelError with all faults of the file.
    """
    case = ModelCase(model, run, parameters)
    case.info
    return case


def models():
    """The built-in models: name -> summary."""
    return dict(_drev.built_in_models())


def import_model(file):
    """Imports an assembly of openTorsion (.json) or a mass-elastic table (.csv) as a model (docs/import.md)."""
    from ._model import Model

    name = os.path.splitext(os.path.basename(os.fspath(file)))[0]
    request = _drev.Request("import", "", None, [], {"FILE": [os.fspath(file)]}, None, None)
    return Model._of_text(name, _drev.execute(request, False)[1])


def source_study(only=None, out=None):
    """Repeats and judges the studies of the camshaft in its source, as `drev study` does. Takes about a minute."""
    options = _commands.options("study", {"only": only, "out": out}, "source_study")
    return _drev.execute(_drev.Request("study", "", None, [], options, None, None), False)[1]


def compare_reports(*runs, out):
    """The report of one run again, or of two runs compared: folders of run(out=...), or their report.html."""
    options = {"RUN": [os.fspath(run) for run in runs], "--out": [os.fspath(out)]}
    return _drev.execute(_drev.Request("report", "", None, [], options, None, None), False)[1]


def load_plugins(*files):
    """Loads user-defined C++ elements from shared libraries (docs/plugins.md). drev.Model has add_TYPE for each."""
    from ._elements import add_methods
    from ._model import Model

    _drev.load_plugins([os.fspath(file) for file in files])
    add_methods(Model)


__all__ = ["ModelCase", "load", "models", "import_model", "source_study", "compare_reports", "load_plugins", "last_interrupted", "Result"]
