"""What the page relies on of a session, beyond what the engine's own tests hold."""

from pathlib import Path

import pytest

from studio.engine import commands
from studio.engine.choices import Choices
from studio.engine.session import Session
from studio.engine.snapshot import Mode
from tests.engine.sessions import until_read


@pytest.fixture
def session(tmp_path: Path):
    made = Session(tmp_path)
    yield made
    made.close()


def test_a_refused_command_stops_nothing(session: Session, tmp_path: Path) -> None:
    session.post(commands.UseDemonstrator())
    session.post(commands.Record())
    session.tick()
    broken = tmp_path / "broken.json"
    broken.write_text("{")
    session.post(commands.UseFile(broken))
    now = until_read(session)
    assert (now.message.is_error, now.mode) == (True, Mode.RECORDING)
    refused = (
        commands.Configure(Choices("right", "exact", "sequence")),
        commands.Choose(7),
    )
    for command in refused:
        session.post(command)
        now = session.tick()
        assert now.message.is_error, command
        assert now.mode is Mode.RECORDING


def test_the_sources_person_waits_before_being_watched(session: Session) -> None:
    assert session.tick().skeleton is None
    session.post(commands.UseDemonstrator())
    waiting = session.tick().skeleton
    assert waiting is not None
    assert session.tick().skeleton is waiting
    session.post(commands.Watch())
    session.tick()
    assert session.tick().skeleton is not waiting


def test_only_what_was_learned_counts_as_alone(lesson) -> None:
    assert lesson["playing"].alone
    assert not lesson["replaying"].alone
    assert not lesson["played"].alone
