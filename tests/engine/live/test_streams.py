"""What publishers do, on real sockets, leaves the session armed only if it should be; and running.

Time is the tests' own here, tick by tick; the bytes go over loopback.
"""

import socket
from pathlib import Path

import numpy as np
import pytest

from studio.engine import commands
from studio.engine.follow import follow, ticks_of
from studio.engine.live.reception import LARGEST_MESSAGE, SILENCE
from studio.engine.mcap_file import read_recording
from studio.engine.pipeline import Pipeline
from studio.engine.robot import load_robot
from studio.engine.session import Session
from studio.engine.skeleton import HandState
from studio.engine.snapshot import Mode
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.sources.family import Frame
from tests.engine.live.streaming import (
    SIGNS,
    LiveStudio,
    answers,
    demonstrated,
    eventually,
    message,
    publisher,
    signing,
)
from tests.engine.people import hanging

CLOSED = HandState.CLOSED


@pytest.fixture
def studio(tmp_path: Path):
    with LiveStudio(tmp_path / "recordings") as made:
        yield made


@pytest.fixture
def watching(studio: LiveStudio) -> LiveStudio:
    studio.do(commands.UseLive(), commands.Watch())
    return studio


def test_the_person_is_seen_before_anybody_follows(studio: LiveStudio) -> None:
    waiting = studio.do(commands.UseLive())
    assert "Nobody sends yet" in waiting.message.text
    assert studio.url in waiting.message.text
    assert waiting.source.is_live
    with publisher(studio.url) as sensor:
        seen = studio.show(sensor, signing(0.0, CLOSED))
        assert (seen.mode, seen.skeleton.left_hand.state) == (Mode.IDLE, CLOSED)
        assert seen.live.driver.startswith("Publisher 1")
        assert seen.live.protocol == "studio jsonl"
    eventually(lambda: studio.live.status().driver == "")
    assert studio.wait().skeleton is None  # who has left is not shown as if still there


def test_a_session_without_a_listener_says_so(tmp_path: Path) -> None:
    session = Session(tmp_path)
    session.post(commands.UseLive())
    assert "live streams" in session.tick().message.text
    assert session.snapshot.message.is_error
    assert session.snapshot.live is None
    session.close()


@pytest.mark.parametrize("kind", ["jsonl", "node-kinect2", "kinectron"])
def test_any_protocol_arms(watching: LiveStudio, kind: str) -> None:
    with publisher(watching.url) as sensor:
        armed = watching.arm(sensor, kind)
        assert armed.mode is Mode.ARMED
        assert armed.live.latency.total is not None


def test_live_file_and_replay_are_one(studio: LiveStudio) -> None:
    """Three roads: the stream, the file that it plays, and the recording of it."""
    frames = demonstrated()
    ticks = ticks_of(np.array([frame.time for frame in frames])).tolist()
    studio.do(commands.UseLive())
    with publisher(studio.url) as sensor:
        studio.session.post(commands.Record())
        for tick in range(ticks[-1] + 1):
            due = [frame for frame, when in zip(frames, ticks, strict=True) if when == tick]
            studio.show(sensor, *map(message, due))
        ended = studio.do(commands.Stop())
    assert ended.mode is Mode.IDLE
    assert [entry.block_down for entry in ended.entries] == [True]
    live = read_recording(Path(ended.saved_as))
    assert live.info.source == "live stream (studio jsonl)"
    pipeline = Pipeline.for_robot(load_robot(), "left")
    again = follow(live.skeletons("again", "test"), pipeline)
    file = follow(demonstrate(0, 1), pipeline)
    for here, there, from_file in zip(live.samples, again.samples, file.samples, strict=False):
        assert np.array_equal(here.sent, there.sent)
        assert here.gate.armed == from_file.gate.armed
        assert np.allclose(here.sent, from_file.sent, atol=1e-12)
    assert len(again.samples) == len(file.samples) == ticks[-1] + 1


def test_a_killed_publisher_disarms(watching: LiveStudio) -> None:
    with publisher(watching.url) as sensor:
        assert watching.arm(sensor).gate.armed
        sensor.socket.shutdown(socket.SHUT_RDWR)  # without a word of goodbye
        eventually(lambda: watching.live.status().driver == "")
    alone = watching.wait(20)
    assert (alone.mode, alone.gate.armed) == (Mode.WATCHING, False)
    held = alone.world.joint_positions
    assert np.abs(watching.wait(30).world.joint_positions - held).max() < 0.05


def test_a_restarted_publisher_has_to_sign_again(watching: LiveStudio) -> None:
    """Even at once, with the same person, and with stamps that begin anew."""
    with publisher(watching.url) as sensor:
        assert watching.arm(sensor, start=500.0).gate.armed
    eventually(lambda: watching.live.status().driver == "")
    with publisher(watching.url) as sensor:
        assert not watching.show(sensor, signing(0.0, CLOSED)).gate.armed
        for n in range(1, 40):
            assert not watching.show(sensor, signing(n / 30, CLOSED)).gate.armed
        assert watching.arm(sensor, start=2.0).gate.armed


def test_a_clock_set_back_has_to_sign_again(watching: LiveStudio) -> None:
    with publisher(watching.url) as sensor:
        assert watching.arm(sensor, start=500.0).gate.armed
        assert not watching.show(sensor, signing(3.0, CLOSED)).gate.armed


def test_a_slow_publisher_stays_armed_and_a_stalled_one_does_not(watching: LiveStudio) -> None:
    with publisher(watching.url) as sensor:
        assert watching.arm(sensor).gate.armed
        for n in range(10):  # 5 Hz
            watching.wait(5)
            assert watching.show(sensor, signing(2.0 + n / 5, CLOSED)).gate.armed
        assert not watching.wait(20).gate.armed
        assert not watching.show(sensor, signing(9.0, CLOSED)).gate.armed


def test_a_burst_after_a_stall_moves_nothing_on(watching: LiveStudio) -> None:
    """The signs all at once are one look at the last of them."""
    with publisher(watching.url) as sensor:
        burst = [signing(n / 30, state) for n, state in enumerate(SIGNS)]
        seen = watching.show(sensor, *burst)
        assert (seen.gate.armed, seen.gate.lit) == (False, 0)
        assert seen.live.counts.dropped == len(SIGNS) - 1


@pytest.mark.parametrize("factor", [0.01, 1000.0])
def test_a_publisher_cannot_make_time_pass(watching: LiveStudio, factor: float) -> None:
    """Whatever its stamps say, the gate arms at the same tick."""
    with publisher(watching.url) as sensor:
        armed = []
        for n, state in enumerate(SIGNS):
            armed.append(watching.show(sensor, signing(factor * n / 30, state)).gate.armed)
    assert armed.count(True) > 0
    assert armed.index(True) == _honest(watching)


def _honest(watching: LiveStudio) -> int:
    watching.wait(30)
    with publisher(watching.url) as sensor:
        for n, state in enumerate(SIGNS):
            if watching.show(sensor, signing(n / 30, state)).gate.armed:
                return n
    raise AssertionError("never armed")


def test_frozen_stamps_arm_nothing(watching: LiveStudio) -> None:
    with publisher(watching.url) as sensor:
        for state in SIGNS:
            seen = watching.show(sensor, signing(1.0, state))
        assert not seen.gate.armed
        assert seen.live.counts.late == len(SIGNS) - 1
        assert "late" in answers(sensor, 3)[-1]["error"]


def test_a_flood_of_frames_leaves_an_armed_robot_armed(watching: LiveStudio) -> None:
    """At 1,000 Hz, 33 frames a tick, for a second."""
    with publisher(watching.url) as sensor:
        assert watching.arm(sensor).gate.armed
        before = watching.live.status().counts
        for n in range(30):
            flood = [signing(2.0 + (33 * n + m) / 1000, CLOSED) for m in range(33)]
            assert watching.show(sensor, *flood).gate.armed
        counts = watching.live.status().counts
        assert counts.too_fast - before.too_fast > 800
        assert counts.used - before.used >= 30


@pytest.mark.parametrize("garbage", ["hello", b"\x00\xff"])
def test_garbage_instead_of_frames_disarms(watching: LiveStudio, garbage) -> None:
    with publisher(watching.url) as sensor:
        assert watching.arm(sensor).gate.armed
        for _ in range(20):
            ended = watching.show(sensor, garbage)
        assert (ended.mode, ended.gate.armed) == (Mode.WATCHING, False)
        assert watching.live.status().counts.unreadable > 0
        assert "error" in answers(sensor, 3)[-1]
        watching.wait(60)  # the debt for garbage is paid by waiting
        assert watching.arm(sensor, start=10.0).gate.armed


def test_an_oversized_message_ends_the_stream_and_disarms(watching: LiveStudio) -> None:
    with publisher(watching.url) as sensor:
        assert watching.arm(sensor).gate.armed
        sensor.send("x" * (LARGEST_MESSAGE + 1))
        eventually(lambda: watching.live.status().driver == "")
        assert not watching.wait(20).gate.armed


def test_who_waits_changes_nothing_and_who_takes_over_has_to_sign(watching: LiveStudio) -> None:
    with publisher(watching.url) as second:
        with publisher(watching.url) as first:
            assert watching.arm(first).gate.armed
            for n in range(10):
                watching.send(second, signing(n / 30, HandState.LASSO))
                assert watching.show(first, signing(2.0 + n / 30, CLOSED)).gate.armed
        eventually(lambda: watching.live.status().driver == "")
        over = watching.show(second, signing(9.0, CLOSED))
        assert not over.gate.armed
        assert over.live.driver.startswith("Publisher 1")  # it was the first to connect
        assert watching.arm(second, start=10.0).gate.armed


def test_a_silent_driver_gives_way_and_cannot_move_anything_then(watching: LiveStudio) -> None:
    with publisher(watching.url) as first, publisher(watching.url) as second:
        assert watching.arm(first).gate.armed
        watching.wait(int(SILENCE * 30) + 2)
        assert watching.arm(second).gate.armed
        watching.send(first, signing(99.0, HandState.LASSO))
        assert watching.wait().live.counts.waiting == 1
        assert answers(first, 3)[-1]["status"] == "waiting"


def test_stop_lets_go_while_frames_go_on(watching: LiveStudio) -> None:
    with publisher(watching.url) as sensor:
        assert watching.arm(sensor).gate.armed
        watching.do(commands.Stop())
        seen = watching.show(sensor, signing(2.0, CLOSED))
        assert (seen.mode, seen.gate) == (Mode.IDLE, None)
        watching.do(commands.Watch())
        assert not watching.show(sensor, signing(2.1, CLOSED)).gate.armed


def test_watching_for_long_keeps_nothing(watching: LiveStudio) -> None:
    with publisher(watching.url) as sensor:
        watching.arm(sensor)
    assert watching.session._activity.samples == []


def test_a_recording_without_an_end_is_ended(studio: LiveStudio, monkeypatch) -> None:
    monkeypatch.setattr("studio.engine.tape.LONGEST_RECORDING", 2.0)
    studio.do(commands.UseLive(), commands.Record())
    with publisher(studio.url) as sensor:
        studio.arm(sensor)
    ended = studio.wait(62)
    assert ended.mode is Mode.IDLE
    assert "minutes" in ended.message.text


def test_a_live_recording_tells_its_latency_once_a_second(studio: LiveStudio) -> None:
    studio.do(commands.UseLive(), commands.Record())
    with publisher(studio.url) as sensor:
        studio.arm(sensor)
        studio.wait(40)
        saved = studio.do(commands.Stop()).saved_as
    samples = read_recording(Path(saved)).samples
    told = [i for i, sample in enumerate(samples) if sample.latency is not None]
    assert told == list(range(29, len(samples), 30))
    assert samples[29].latency.total is not None


def test_a_person_before_a_live_sensor_calibrates(studio: LiveStudio) -> None:
    studio.do(commands.UseLive(), commands.Calibrate())
    with publisher(studio.url) as sensor:
        for number in range(75):
            frame = Frame(number / 30, (hanging(number / 30, 0.1),))
            now = studio.show(sensor, message(frame))
            assert now.skeleton is not None
    assert now.mode is Mode.IDLE
    assert now.choices.calibration.lean == pytest.approx(0.1, abs=1e-4)
    assert now.calibrated_with == "live stream"
