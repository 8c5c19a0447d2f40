"""Programs that are killed or stopped in mid-motion: Baxter stands, time goes on, others go in."""

import signal
import sys
from pathlib import Path

import numpy as np
import pytest

from studio.engine.live import doorway
from studio.engine.remote.reception import CLOSED
from studio.engine.robot import JOINT_NAMES
from studio.engine.snapshot import Mode
from studio.remote import commands
from tests.remote.house import House, eventually, goes_on, open_house, stands_still

MISBEHAVING = Path(__file__).with_name("misbehaving.py")
S0 = JOINT_NAMES.index("left_s0")


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    with open_house(tmp_path_factory.mktemp("house"), speed=2.0) as opened:
        yield opened


def begun(house: House, what: str):
    program = house.start(sys.executable, MISBEHAVING, what, house.url)
    assert program.stdout is not None
    assert program.stdout.readline() == "ready\n"
    return program


def is_safe(house: House) -> None:
    """The robot holds, nobody controls, time goes on, and the next program can do all."""
    eventually(lambda: house.seat.holder is None and house.seat.present == 0)
    eventually(lambda: house.now.mode is Mode.IDLE)
    assert goes_on(house)
    assert stands_still(house)
    with house.connect() as studio:
        assert "stands where it was taught" in studio.do(commands.PutBlockBack())


def test_killed_while_it_drives(house: House) -> None:
    program = begun(house, "drive")
    eventually(lambda: house.now.mode is Mode.DRIVEN)
    program.kill()
    program.wait()
    at = house.now.world.joint_positions[S0]
    eventually(lambda: house.seat.holder is None)
    eventually(lambda: house.now.mode is Mode.IDLE)
    assert CLOSED in house.now.message.text
    assert abs(house.now.world.joint_positions[S0] - at) < 0.5
    is_safe(house)


def test_killed_while_it_has_the_clock(house: House) -> None:
    program = begun(house, "hold_clock")
    program.kill()
    eventually(lambda: not house.loop.steps.is_held)
    is_safe(house)


def test_killed_while_it_records_the_recording_is_kept(house: House) -> None:
    program = begun(house, "record")
    eventually(lambda: house.now.mode is Mode.RECORDING and house.now.recorded > 20)
    program.kill()
    is_safe(house)
    assert list(house.folder.glob("*.mcap"))


def test_killed_while_it_is_told_a_stream(house: House) -> None:
    program = begun(house, "watch")
    program.kill()
    is_safe(house)


def test_stalled_while_it_drives(house: House) -> None:
    program = begun(house, "drive")
    program.send_signal(signal.SIGSTOP)
    eventually(lambda: house.now.driven is None)
    assert "has sent nothing for 2 s" in house.now.message.text
    assert stands_still(house)
    assert goes_on(house)
    program.send_signal(signal.SIGCONT)  # followed softly again, as at its beginning
    eventually(lambda: house.now.driven is not None)
    before = np.array(house.now.world.joint_positions)
    assert not (house.now.driven and house.now.driven.follows)
    eventually(lambda: abs(house.now.world.joint_positions - before)[S0] > 0.02)
    program.kill()
    is_safe(house)


def test_stalled_with_the_clock_it_goes_back(house: House) -> None:
    program = begun(house, "hold_clock")
    program.send_signal(signal.SIGSTOP)
    eventually(lambda: not house.loop.steps.is_held)
    assert goes_on(house)
    eventually(lambda: house.now.driven is None)
    assert stands_still(house)
    program.kill()
    is_safe(house)


def test_stalled_for_good_it_is_sent_away(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr("studio.engine.remote.server._HOUSE", _impatient())
    with open_house(tmp_path) as house:
        program = begun(house, "watch")
        other = begun(house, "drive")
        program.send_signal(signal.SIGSTOP)
        other.send_signal(signal.SIGSTOP)
        eventually(lambda: house.seat.present == 0)
        is_safe(house)


def _impatient() -> doorway.House:
    from dataclasses import replace  # noqa: PLC0415

    from studio.engine.remote import server  # noqa: PLC0415

    return replace(server._HOUSE, alive_every=1.0)
