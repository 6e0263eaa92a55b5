"""Many variants of one model, a row of figures each: in lockstep here, or over whatever runs tasks (Dask)."""
import json
import os
import threading
import time
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait

import numpy as np

from . import _drev, _errors, _progress
from ._variants import _word

_TASK_SECONDS = 0.5  # that a task should take
_known = threading.local()  # the study that a worker's thread had last


def _distribution(given):
    """What stands behind NAME= : a text as the command takes it, or a sequence of values."""
    return _word("", given)[1:]


def _request_of(spec):
    return _drev.Request("run", *spec, None, None)


def _rows(spec, first, count, stop=None):
    """Rows of blocks [first, first + count) as numbers, and the seconds that they took. Called by workers."""
    began = time.perf_counter()
    if getattr(_known, "spec", None) != spec:
        _known.study, _known.spec = _drev.Study(_request_of(spec)), spec
    numbers = np.array(_known.study.rows(first, count, stop or _drev.Stop()).numbers)
    return first, numbers, time.perf_counter() - began


class Study:
    """The rows of a study. study["deflection_deg"]: a column; `columns`: every one by its name, parameters first;
    `units`; `status`: of each variant; `description`: what the rows follow from."""

    def __init__(self, source, numbers):
        self.description = json.loads(source.description)
        self.units = dict(source.figures)
        names = [name for name, _ in source.figures]
        table = numbers.reshape(-1, 1 + len(names))
        parameters = [dict(source.parameters(i)) for i in range(source.count)]
        self.columns = {}
        for name in parameters[0]:
            texts = [p[name] for p in parameters]
            try:
                self.columns[name] = np.array([float(text) for text in texts])
            except ValueError:
                self.columns[name] = np.array(texts)
        self.status = np.array(_drev.variant_statuses)[table[:, 0].astype(int)]
        for at, name in enumerate(names):
            self.columns[name] = np.ascontiguousarray(table[:, 1 + at])

    def __getitem__(self, name):
        return self.columns[name]

    def __len__(self):
        return len(self.status)

    def to_pandas(self):
        """A row a variant: parameters, status, figures."""
        import pandas

        return pandas.DataFrame({**self.columns, "status": self.status})

    def __repr__(self):
        good = int((self.status == "success").sum())
        return f"<drev.Study of {self.description['model']}: {good} of {len(self)} succeeded>"


def compute(case, values, sample, correlate, client, jobs, progress, options):
    words = {"--vary": [f"{name}={_distribution(given)}" for name, given in values.items()], "--table": [""]}
    if sample:
        words["--sample"] = [sample]
    if correlate:
        words["--correlate"] = [f"{a},{b}={value!r}" for (a, b), value in correlate.items()]
    request, spec = case._study_request(options, words)
    with case._findings():
        source = _drev.Study(request)
    stop = _drev.Stop()
    if client is None:
        jobs = jobs or os.cpu_count() or 1
        pool = ThreadPoolExecutor(jobs, thread_name_prefix="drev")
        submit = lambda first, count: pool.submit(_rows, spec, first, count, stop)
    else:
        if case._keep() is not None:
            raise TypeError("a model with laws or loads in Python cannot be sent to other processes")
        pool = client.get_executor() if hasattr(client, "get_executor") else client
        jobs = jobs or (len(client.nthreads()) if hasattr(client, "nthreads") else os.cpu_count() or 1)
        submit = lambda first, count: pool.submit(_rows, spec, first, count)
    bar = _progress.told(progress)
    began = time.monotonic()
    parts, waiting, next_block, each, done = {}, set(), 0, 1, 0
    try:
        while next_block < source.blocks or waiting:
            while next_block < source.blocks and len(waiting) < 2 * jobs:
                count = max(1, min(each, (source.blocks - next_block) // (2 * jobs)))
                waiting.add(submit(next_block, count))
                next_block += count
            ended, waiting = wait(waiting, timeout=0.2, return_when=FIRST_COMPLETED)
            for future in ended:
                first, numbers, seconds = future.result()
                parts[first] = numbers
                done += len(numbers)
                blocks = len(numbers) / (1 + len(source.figures)) / source.block_size
                each = int(min(4096, max(1, _TASK_SECONDS * blocks / max(seconds, 1e-6))))
            if bar and done:
                part = done / (source.count * (1 + len(source.figures)))
                bar(part, (time.monotonic() - began) * (1 - part) / part)
    except BaseException as error:
        stop.set()
        for future in waiting:
            future.cancel()
        if isinstance(error, KeyboardInterrupt):
            raise _errors.Interrupted(f"{case.name}: interrupted", None) from None
        raise
    finally:
        if client is None:
            pool.shutdown(wait=True)
        _progress.close(bar)
    return Study(source, np.concatenate([parts[first] for first in sorted(parts)]))
