"""No test of a link fails because the machine is slow; nor does one wait for what is not tested."""

import importlib
from collections.abc import Iterator
from contextlib import suppress

import pytest

from studio.engine.links import coppeliasim, driver, rosbridge
from tests.engine.links.unhurried import CLOCK, PATIENCE


@pytest.fixture(scope="package", autouse=True)
def clock_runs() -> Iterator[None]:
    for library in ("roslibpy", "coppeliasim_zmqremoteapi_client"):
        with suppress(ImportError):  # imported now: it takes a second, in which robots grow silent
            importlib.import_module(library)
    with CLOCK.running():
        yield


@pytest.fixture(autouse=True)
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(driver, "RETRY", 0.05)
    monkeypatch.setattr(driver, "_LONGEST_CLOSE", PATIENCE)
    monkeypatch.setattr(rosbridge, "_CONNECTS_WITHIN", PATIENCE)
    monkeypatch.setattr(coppeliasim, "_ANSWERS_WITHIN", PATIENCE)
