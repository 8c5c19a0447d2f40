"""What holds for all tests, before NumPy is imported anywhere."""

import os

# Several test processes share few cores: threads of linear algebra would only wait for each other.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# A hundred programs are started: without this each would compile the whole project for itself,
# whatever the user's environment says. What is written are __pycache__ folders, no file of Git's.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)


def pytest_xdist_auto_num_workers() -> int | None:
    """Return one more than there are cores: a third of all tests' time is waiting, not computing.

    Tests wait for a browser, for another process, for a second to pass. None leaves the answer to
    pytest-xdist, where the environment tells it.
    """
    if "PYTEST_XDIST_AUTO_NUM_WORKERS" in os.environ:
        return None
    return (os.cpu_count() or 1) + 1
