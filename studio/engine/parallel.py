"""Independent tasks, side by side: the one place that knows joblib, and never its pickles on disk.

What runs where is joblib's choice of backend, so a study moves to a cluster unchanged:

    with joblib.parallel_config(backend="dask"):  # or "ray"
        sweep(taught, ...)
"""

import os
from collections.abc import Callable, Iterator, Sequence
from importlib.util import find_spec
from typing import TypeVar

from studio.engine.errors import StudioError

Task = TypeVar("Task")
Result = TypeVar("Result")


def has_joblib() -> bool:
    """Tell whether several jobs at once are possible here."""
    return find_spec("joblib") is not None


def most_jobs() -> int:
    """Return how many jobs at once are worth while here: 1 without joblib, else the processors."""
    if not has_joblib():
        return 1
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def run_all(
    function: Callable[[Task], Result], tasks: Sequence[Task], jobs: int | None = None
) -> list[Result]:
    """Return what the function makes of every task, in order; see `run_each`."""
    return list(run_each(function, tasks, jobs))


def run_each(
    function: Callable[[Task], Result], tasks: Sequence[Task], jobs: int | None = None
) -> Iterator[Result]:
    """Yield what the function makes of every task, in order, each as soon as it is there.

    Parameters
    ----------
    function : defined at the top of a module, so that other processes find it
    tasks : what it is given, one at a time
    jobs : how many at once; None leaves it to joblib's configuration, and is 1 where there is none

    Raises
    ------
    StudioError
        Where fewer than one job is asked for, or several are and joblib is not installed.

    """
    if jobs is not None and jobs < 1:
        raise StudioError(f"jobs: how many at once, 1 or more, not {jobs}")
    try:
        from joblib import Parallel, delayed  # noqa: PLC0415 - it comes with an extra
    except ModuleNotFoundError:
        if jobs not in (None, 1):
            raise StudioError(
                f"{jobs} jobs at once need joblib: pip install 'teaching-studio[compare]'"
            ) from None
        yield from map(function, tasks)
        return
    if len(tasks) == 0:
        return
    side_by_side = Parallel(n_jobs=jobs, return_as="generator")
    yield from side_by_side(delayed(function)(task) for task in tasks)
