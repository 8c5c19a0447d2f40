"""Dask on this machine: two workers, where it is installed; in CI it has to be."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec

import pytest


@contextmanager
def two_workers(processes: bool) -> Iterator[None]:
    """Let joblib's tasks run on a LocalCluster, each worker a process of its own if so asked."""
    missing = [name for name in ("joblib", "distributed") if find_spec(name) is None]
    if missing:
        words = f"{' and '.join(missing)} missing: they come with the extra cluster"
        assert not os.environ.get("CI"), words
        pytest.skip(words)
    import distributed  # noqa: PLC0415 - it may be missing
    import joblib  # noqa: PLC0415

    local = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with (
        distributed.LocalCluster(**local, processes=processes) as cluster,
        distributed.Client(cluster),
        joblib.parallel_config(backend="dask"),
    ):
        yield
