"""Many variants of one model, with one row of figures each: in lockstep here, or by an executor of tasks (Dask)."""
import json
import os
import threading
import time
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait

import numpy as np

from . import _commands, _drev, _errors, _progress
from ._variants import _word

_TASK_SECONDS = 0.5  # time that a task should take [s]
_SYNC_SECONDS = 0.5  # longest time until a computed row would survive a power failure [s]
_known = threading.local()  # the last study of each worker thread


def _distribution(given):
    """The text after NAME= : a text as the command accepts it, or a sequence of values."""
    return _word("", given)[1:]


def _request_of(spec):
    return _drev.Request("run", *spec, None, None)


def _rows(spec, first, count, stop=None):
    """Rows of blocks [first, first + count), the reasons of those that failed, and their computing time [s]. Called by workers."""
    began = time.perf_counter()
    if getattr(_known, "spec", None) != spec:
        _known.study, _known.spec = _drev.Study(_request_of(spec)), spec
    rows = _known.study.rows(first, count, stop or _drev.Stop())
    return first, np.array(rows.numbers), list(rows.reasons), time.perf_counter() - began


class Study:
    """The rows of a study. study["deflection_deg"]: a column; `columns`: every one by its name, parameters first;
    `units`; `status`: of each variant; `reasons`: why variants failed, by their numbers, `warnings`: what a single run
    with these parameters would warn of (of a study that was complete already: of the first 1000 each);
    `description`: what the rows follow from."""

    def __init__(self, source, numbers, reasons):
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
        self.reasons = {at: text for at, text in reasons.items() if self.status[at] != "success"}
        self.warnings = {at: text for at, text in reasons.items() if self.status[at] == "success"}
        for at, name in enumerate(names):
            self.columns[name] = np.ascontiguousarray(table[:, 1 + at])

    def __getitem__(self, name):
        return self.columns[name]

    def keys(self):
        """The names of the columns, so that dict(study) has each of them."""
        return list(self.columns)

    def __iter__(self):
        return iter(self.columns)

    def __contains__(self, name):
        return name in self.columns

    def __len__(self):
        return len(self.status)

    def to_pandas(self):
        """A pandas.DataFrame with one row for each variant: parameters, status, figures."""
        import pandas

        return pandas.DataFrame({**self.columns, "status": self.status})

    def __repr__(self):
        good = int((self.status == "success").sum())
        return f"<drev.Study of {self.description['model']}: {good} of {len(self)} succeeded>"


def compute(case, values, sample, correlate, client, jobs, progress, out, resume, options):
    if resume and out is None:
        raise TypeError("resume needs out, the folder of the study to go on with")
    words = {"--vary": [f"{name}={_distribution(given)}" for name, given in values.items()], "--table": [""]}
    if sample:
        words["--sample"] = [sample]
    if correlate:
        words["--correlate"] = [f"{a},{b}={_commands._text('correlate', value)}" for (a, b), value in correlate.items()]
    request, spec = case._study_request(options, words)
    with case._findings():
        source = _drev.Study(request)
        store = None if out is None else _drev.StudyStore(source, os.fspath(out), bool(resume))
    if store and store.complete:
        return Study(source, np.array(store.rows()), store.reasons())
    stop = _drev.Stop()
    if client is None:
        jobs = jobs or os.cpu_count() or 1
        pool = ThreadPoolExecutor(jobs, thread_name_prefix="drev")
        submit = lambda first, count: pool.submit(_rows, spec, first, count, stop)
    else:
        if case._keep():
            raise TypeError("a model with laws or loads in Python cannot be sent to other processes")
        pool = client.get_executor() if hasattr(client, "get_executor") else client
        jobs = jobs or (len(client.nthreads()) if hasattr(client, "nthreads") else os.cpu_count() or 1)
        submit = lambda first, count: pool.submit(_rows, spec, first, count)
    bar = _progress.told(progress)
    began = synced = time.monotonic()
    missing = store.missing() if store else [(0, source.blocks)]
    left = sum(count for _, count in missing)
    parts, failed, waiting, each, done, all_blocks = {}, {}, set(), 1, 0, left
    try:
        while left or waiting:
            while left and len(waiting) < 2 * jobs:
                first, count = missing[0]
                size = min(count, max(1, min(each, left // (2 * jobs))))
                waiting.add(submit(first, size))
                missing[0] = first + size, count - size
                if size == count:
                    del missing[0]
                left -= size
            ended, waiting = wait(waiting, timeout=0.2, return_when=FIRST_COMPLETED)
            for future in ended:
                first, numbers, reasons, seconds = future.result()
                if store:
                    store.put(first, numbers, reasons)
                else:
                    parts[first] = numbers
                    for block, texts in enumerate(reasons, first):
                        failed.update({block * source.block_size + i: text for i, text in enumerate(texts) if text})
                done += len(reasons)
                each = int(min(4096, max(1, _TASK_SECONDS * len(reasons) / max(seconds, 1e-6))))
            if store and time.monotonic() - synced > _SYNC_SECONDS:
                store.sync()
                synced = time.monotonic()
            if bar and done:
                part = done / all_blocks
                bar(part, (time.monotonic() - began) * (1 - part) / part)
    except BaseException as error:
        stop.set()
        for future in waiting:
            future.cancel()
        if store:
            store.sync()
        if isinstance(error, KeyboardInterrupt):
            kept = f"; what is done is kept in {store.path}, resume=True goes on" if store else ""
            raise _errors.Interrupted(f"{case.name}: interrupted{kept}", None) from None
        raise
    finally:
        if client is None:
            pool.shutdown(wait=True)
        _progress.close(bar)
    if not store:
        return Study(source, np.concatenate([parts[first] for first in sorted(parts)]), dict(sorted(failed.items())))
    store.sync()
    rows, reasons = np.array(store.rows()), store.reasons()
    store.finish()
    return Study(source, rows, reasons)
