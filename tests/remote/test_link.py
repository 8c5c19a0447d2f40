"""Streams in the client: what is read is of the newest subscription, of one reader at a time."""

from pathlib import Path

import pytest

from studio.engine.snapshot import Mode
from studio.remote import Block, JointStates, LostError, RefusedError
from studio.remote.link import Frames
from tests.remote.house import PATIENCE, House, eventually, open_house


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    with open_house(tmp_path_factory.mktemp("house"), speed=3.0) as opened:
        yield opened


@pytest.fixture
def studio(house: House):
    with house.connect() as connected:
        yield connected


def read_slowly(house: House, studio) -> int:
    """Let frames pile up that nobody looks at; return the tick that it is then."""
    frames = studio.stream(JointStates)
    before = next(frames).tick
    eventually(lambda: studio.joint_states().tick > before + 30)
    frames.close()
    return studio.joint_states().tick


def test_the_first_frame_of_a_subscription_is_of_it(house: House, studio) -> None:
    tick = read_slowly(house, studio)
    frames = studio.stream(JointStates)
    assert next(frames).tick >= tick
    frames.close()


def test_begun_anew_while_it_is_read_the_old_one_ends_and_the_new_one_goes_on(studio) -> None:
    old = studio.stream(JointStates)
    tick = next(old).tick
    eventually(lambda: studio.joint_states().tick > tick + 30)
    tick = studio.joint_states().tick
    new, other = studio.stream(JointStates, rate=15.0), studio.stream(Block)
    assert next(new).tick >= tick
    with pytest.raises(LostError, match="begun to read the stream anew"):
        list(old)
    old.close()  # and takes nothing from the new one
    for _ in range(5):
        next(new)
        next(other)


def test_a_name_that_is_used_again_does_not_end_what_it_stands_for(studio) -> None:
    frames = studio.stream(JointStates)
    next(frames)
    frames = studio.stream(JointStates)  # only now the first one is closed
    ticks = [next(frames).tick for _ in range(5)]
    assert ticks == sorted(set(ticks))


def test_what_has_come_is_read_before_the_end() -> None:
    frames = Frames()
    frames.add("frame")
    frames.end("gone")
    assert frames.next(0.0) == "frame"
    with pytest.raises(LostError, match="gone"):
        frames.next(0.0)


def test_begun_on_a_lost_line_nobody_waits(tmp_path: Path) -> None:
    with open_house(tmp_path) as house:
        studio = house.connect()
        studio.close()
        with pytest.raises(LostError):
            studio._link.begin("gate").next(5.0)


# Driving, and who stops it; on the wire that is in tests/engine/remote/test_requests.py.


def test_stopped_on_its_way_it_is_said_and_begun_anew_by_the_next_call(house, studio) -> None:
    for move in (studio.move_to, lambda targets: in_steps(studio, targets)):
        house.stop_once_driven()
        with pytest.raises(RefusedError, match="stopped Baxter on its way"):
            move({"left_s0": 1.0})
        assert studio.joint_states().stopped
    studio.set_joint_target({"left_s0": 0.1})
    eventually(lambda: any("begin_driving" in words for words in studio.complaints))
    assert house.now.mode is Mode.IDLE
    assert studio.move_to({"left_s0": 0.05}, PATIENCE).mode == "driven"


def in_steps(studio, targets: dict[str, float]) -> None:
    with studio.clock(PATIENCE) as clock:
        clock.move_to(targets)
