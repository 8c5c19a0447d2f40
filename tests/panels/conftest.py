"""Snapshots of one lesson from beginning to end, as a real session gives them."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from studio.engine import commands
from studio.engine.choices import Choices
from studio.engine.session import Session
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.teaching import LearnerSettings
from studio.panels import mesh_cache
from tests.engine.sessions import read

Lesson = dict[str, Snapshot]


@pytest.fixture(scope="session", autouse=True)
def mesh_folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Light meshes are made once for all tests of all workers, and not in the user's own cache."""
    workers = os.environ.get("PYTEST_XDIST_WORKER_COUNT")
    own = tmp_path_factory.getbasetemp()
    folder = (own.parent if workers else own) / "meshes"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mesh_cache, "cache_folder", lambda: folder)
        yield


@pytest.fixture(scope="session")
def lesson(tmp_path_factory: pytest.TempPathFactory) -> Lesson:
    """The snapshots by what is going on in them; nobody may change them."""
    session = Session(tmp_path_factory.mktemp("recordings"))
    try:
        return dict(_lived_through(session))
    finally:
        session.close()


def _lived_through(session: Session):
    def do(*orders: commands.Command) -> Snapshot:
        for order in orders:
            session.post(order)
        return session.tick()

    def until(reached) -> Snapshot:
        for _ in range(900):
            if reached(now := session.tick()):
                return now
        raise AssertionError(session.snapshot.message.text)

    yield "start", session.tick()
    yield "error", read(session, commands.UseFile(Path("nowhere.json"), "<b>nowhere</b>.json"))
    yield "sourced", do(commands.UseDemonstrator())
    yield "recording", do(commands.Record())
    yield "lasso", until(lambda now: now.gate is not None and now.gate.lit == 1)
    yield "coming", until(lambda now: now.gate is not None and now.gate.armed)
    yield "armed", until(lambda now: not now.held)
    yield "recorded", until(lambda now: now.mode is Mode.IDLE)
    yield "trained on one", do(commands.Train(LearnerSettings("rbf", 20)))
    do(commands.UseDemonstrator(), commands.Record())
    yield "taught twice", until(lambda now: now.mode is Mode.IDLE)
    yield "trained", do(commands.Train(LearnerSettings("rbf", 20)), commands.Choose(2))
    yield "playing", do(commands.PlayReproduction())
    yield "halfway", until(lambda now: now.time > now.duration / 2)
    yield "played", until(lambda now: now.mode is Mode.IDLE)
    yield "replaying", do(commands.PlayDemonstration())
    yield "stopped", do(commands.Stop())
    yield "open", do(commands.Configure(Choices("right", "paper", "open")), commands.Watch())
