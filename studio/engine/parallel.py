"""Independent tasks, side by side: the one place that knows joblib, and never its pickles on disk.

What runs where is joblib's choice of backend, so a study moves to a cluster unchanged:

    with joblib.parallel_config(backend="dask"):  # or "ray"
        sweep(taught, ...)
"""

from collections.abc import Callable, Sequence
from typing import TypeVar

from studio.engine.errors import StudioError

Task = TypeVar("Task")
Result = TypeVar("Result")


def run_all(
    function: Callable[[Task], Result], tasks: Sequence[Task], jobs: int | None = None
) -> list[Result]:
    """Return what the function makes of every task, in order.

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
        return [function(task) for task in tasks]
    if len(tasks) == 0:
        return []
    results: list[Result] = Parallel(n_jobs=jobs)(delayed(function)(task) for task in tasks)
    return results
