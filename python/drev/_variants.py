"""A run for each combination of parameter values, in parallel: drev's runs release Python's lock."""
import os
import threading
import time
from concurrent.futures import ThreadPoolExecutor, wait

from . import _drev, _errors, _progress


def _word(name, values):
    if isinstance(values, str):
        return f"{name}={values}"
    texts = [v if isinstance(v, str) else repr(float(v)) if isinstance(v, float) else str(v) for v in values]
    return f"{name}=" + ",".join(texts)


class Variant:
    """One variant: `parameters`, `status`, and `run`, or `error` if it failed."""

    def __init__(self, parameters):
        self.parameters = parameters
        self.run = None
        self.error = None

    @property
    def name(self):
        return ",".join(f"{k}={v}" for k, v in self.parameters.items())

    @property
    def status(self):
        """How its run ended: run.status, or "bad_input", "output_error", "failed" if there is none; "not_started"."""
        if self.run is not None:
            return self.run.status
        if self.error is None:
            return "not_started"
        kinds = ((_errors.ModelError, "bad_input"), (_errors.OutputError, "output_error"))
        return next((status for kind, status in kinds if isinstance(self.error, kind)), "failed")

    def __repr__(self):
        return f"<drev.Variant {self.name}: {self.status}>"


class Variants(list):
    """A sequence of drev.Variant, in the order of the values."""

    @classmethod
    def _compute(cls, case, values, jobs, progress, options):
        words = [_word(name, given) for name, given in values.items()]
        variants = cls(Variant(dict(pairs)) for pairs in _drev.read_variants(words))
        jobs = jobs or os.cpu_count() or 1
        stop = _drev.Stop()
        bar = _progress.told(progress) or _Line()
        out = options.pop("out", None)

        def compute(variant):
            if stop.is_set():
                return
            more = {**options, "out": os.path.join(os.fspath(out), variant.name)} if out else options
            try:
                variant.run = case.set(**variant.parameters)._simulate(more, False, None, False, stop)
            except (_errors.ModelError, _errors.SolverError, _errors.OutputError) as error:
                variant.error = error
                variant.run = getattr(error, "result", None)
            except _errors.Interrupted as error:
                variant.run = error.result

        if variants:  # A fault that all variants share is reported once.
            with case._findings():
                _drev.check_variants(case._request("run", options, words={"--vary": words}))
        began = time.monotonic()
        with ThreadPoolExecutor(jobs, thread_name_prefix="drev") as pool:
            futures = [pool.submit(compute, variant) for variant in variants]
            try:
                waiting = set(futures)
                while waiting:
                    _, waiting = wait(waiting, timeout=0.2)
                    done = 1 - len(waiting) / len(futures)
                    if done > 0:
                        bar(done, (time.monotonic() - began) * (1 - done) / done)
            except BaseException as error:
                stop.set()
                for future in futures:
                    future.cancel()
                pool.shutdown(wait=True)
                if isinstance(error, KeyboardInterrupt):
                    ended = sum(v.run is not None and v.run.status != "interrupted" for v in variants)
                    message = f"{case.name}: interrupted, {ended} of {len(variants)} runs have ended"
                    raise _errors.Interrupted(message, variants) from None
                raise
            finally:
                _progress.close(bar)
        for future in futures:
            future.result()
        return variants

    def to_pandas(self):
        """A pandas.DataFrame with one row for each variant: its parameters, status, and the value of each figure."""
        import pandas

        rows = []
        for v in self:
            figures = {k: f.value for k, f in v.run.figures.items()} if v.run is not None else {}
            rows.append({**v.parameters, "status": v.status, **figures})
        return pandas.DataFrame(rows).apply(_numbers)


def _numbers(column):
    import pandas

    try:
        return pandas.to_numeric(column)
    except (ValueError, TypeError):
        return column


class _Line:
    """A progress line on stderr, if that is a terminal."""

    def __init__(self):
        import sys

        self._stream = sys.stderr if sys.stderr is not None and sys.stderr.isatty() else None
        self._began = time.monotonic()
        self._lock = threading.Lock()

    def __call__(self, part, left):
        if self._stream is None or (time.monotonic() - self._began < 1 and part < 1):
            return
        with self._lock:
            end = "\r\033[K" if part >= 1 else ""
            self._stream.write(f"\r\033[K{part:6.1%}, {left:.0f} s left{end}")
            self._stream.flush()
