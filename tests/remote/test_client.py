"""The Python client: V-REP's four ways of calling, and what it says where something is wrong."""

import base64
import hashlib
import re
import shutil
import socket
import subprocess
import sys
import threading
import time
from itertools import pairwise
from pathlib import Path

import msgspec
import pytest

from studio.engine.resources import samples_folder
from studio.engine.snapshot import Mode
from studio.remote import (
    Block,
    Gate,
    JointStates,
    LateError,
    LostError,
    RefusedError,
    Snapshot,
    Studio,
    UnreachableError,
    commands,
    connect,
    link,
)
from studio.remote.files import Recorded, Sample
from tests.remote.house import PATIENCE, ROOT, House, eventually, goes_on, open_house

GUID = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"  # of RFC 6455
SPEED = 4.0  # of the session's time: what is said to take so many ticks is asked for in ticks
SAMPLE = samples_folder() / "demonstration-1.mcap"


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    with open_house(tmp_path_factory.mktemp("house"), speed=SPEED) as opened:
        yield opened


@pytest.fixture
def studio(house: House):
    with house.connect() as connected:
        yield connected
    eventually(lambda: house.seat.present == 0)


def test_it_needs_neither_engine_nor_page() -> None:
    code = (
        "import sys, studio.remote\n"
        "heavy = {'pybullet', 'viser', 'numpy', 'scipy', 'studio.engine', 'studio.panels'}\n"
        "assert not heavy & set(sys.modules), heavy & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True)


def test_blocking_is_answered_in_words_once_it_took_effect(house: House, studio) -> None:
    assert studio.do(commands.UseDemonstrator()).startswith("Source: demonstrator")
    now = studio.snapshot()
    assert now.source is not None
    assert now.mode == house.now.mode == "idle"
    with pytest.raises(RefusedError, match="no such demonstration"):
        studio.do(commands.Choose(99))
    with pytest.raises(RefusedError, match=r"speed: 0\.25 to 2"):
        studio.do(commands.SetSpeed(7.0))


def test_the_welcome_names_the_joints_and_their_limits(house: House, studio) -> None:
    welcome = studio.welcome
    assert len(welcome.joints) == len(welcome.lower) == len(welcome.velocity) == 15
    states = studio.joint_states()
    inside = zip(welcome.lower, states.positions, welcome.upper, strict=True)
    assert all(low - 1e-3 <= at <= high + 1e-3 for low, at, high in inside)


def test_non_blocking_moves_the_joints_and_the_newest_wins(house: House, studio) -> None:
    studio.do(commands.PutBlockBack())
    studio.do(commands.BeginDriving())
    for angle in (0.9, -0.9, 0.5, -0.3):
        studio.set_joint_target({"left_s0": angle})
    now = studio.move_to({"left_s0": -0.3}, PATIENCE)
    place = studio.welcome.joints.index("left_s0")
    assert now.positions[place] == pytest.approx(-0.3, abs=0.03)
    assert now.mode == "driven"
    studio.send(commands.Stop())
    eventually(lambda: house.now.mode is Mode.IDLE)


def test_what_cannot_be_driven_is_told_without_a_question(studio) -> None:
    studio.do(commands.BeginDriving())
    studio.set_joint_target({"left_w9": 0.0})
    eventually(lambda: any("left_w9" in words for words in studio.complaints))
    studio.set_joint_target({"left_s0": 0.0}, closed=True)
    studio.do(commands.Stop())


def test_without_news_the_robot_holds_and_nobody_drives_it_any_more(house: House, studio) -> None:
    studio.do(commands.PutBlockBack())
    studio.do(commands.BeginDriving())
    place = studio.welcome.joints.index("left_s0")
    before = studio.joint_states().positions[place]
    studio.set_joint_target({"left_s0": 1.5})  # slowly at first: 0.15 rad in half a second
    eventually(lambda: "has sent nothing for 2 s" in house.now.message.text)
    assert house.now.driven is None
    moved = abs(studio.joint_states().positions[place] - before)
    assert 0.05 < moved < 0.5


@pytest.mark.parametrize("kind", [JointStates, Gate, Block, Snapshot])
def test_streams_come_at_the_rate_that_was_asked_for(house: House, studio, kind) -> None:
    frames = studio.stream(kind, rate=10.0)
    seen = [next(frames) for _ in range(4)]
    for before, after in pairwise(seen):  # on a busy machine some may be missed, and are counted
        assert after.tick - before.tick == 3 * (1 + after.missed - before.missed)
    frames.close()


def test_synchronous_the_world_stands_still_between_steps(house: House, studio) -> None:
    with studio.clock(PATIENCE) as clock:
        before = house.now.world.time
        time.sleep(0.1)
        assert house.now.world.time == before
        assert clock.step().state.time == pytest.approx(before + 1 / 30)
        assert clock.step(30).state.time == pytest.approx(before + 31 / 30)
        # Commands take effect all the same, in no time.
        assert "stands where it was taught" in studio.do(commands.PutBlockBack())
        assert house.now.world.time == 0.0
    assert goes_on(house)


def test_the_same_steps_give_the_same_motion_bit_for_bit(house: House, studio) -> None:
    def moved() -> list[float]:
        with studio.clock(PATIENCE) as clock:
            studio.do(commands.PutBlockBack())
            studio.do(commands.BeginDriving())
            for k in range(40):
                studio.set_joint_target({"left_s0": -0.01 * k, "left_s1": -0.2})
                time.sleep(0.0005 * (k % 3))  # however long the program thinks
                clock.step()
            return clock.now.state.positions

    assert moved() == moved()


def test_a_clock_that_is_not_wound_goes_back(house: House, studio) -> None:
    with studio.clock(patience=0.3) as clock:
        eventually(lambda: goes_on(house))
        with pytest.raises(RefusedError, match="take_clock first"):
            clock.step()
    assert "no step was asked for in 0.3 s" in studio._link.clock_lost


def test_files_are_uploaded_named_and_fetched(house: House, studio, tmp_path: Path) -> None:
    before = len(studio.snapshot().entries)
    uploaded = studio.upload(SAMPLE)
    assert studio.do(commands.UseFile(uploaded)) == f"Reading {SAMPLE.name}."
    now = studio.wait_for(lambda now: len(now.entries) == before + 1, PATIENCE)
    assert now.entries[-1].name == SAMPLE.stem
    shutil.copy(samples_folder() / "demonstration-2.mcap", house.folder / "mine.mcap")
    studio.wait_for(lambda now: any(f.name == "mine.mcap" for f in now.collection.files), PATIENCE)
    studio.do(commands.AddFrom(Recorded("mine.mcap")))
    now = studio.wait_for(lambda now: len(now.entries) == before + 2, PATIENCE)
    whole = studio.demonstration(now.entries[-1].number)
    assert len(whole.times) == len(whole.sent) > 100
    studio.do(commands.Export(("mcap",)))
    done = studio.wait_for(lambda now: now.export.number > 0 and not now.export.running, PATIENCE)
    fetched = studio.fetch_file(done.export.files[0])
    assert fetched == house.now.export.files[0].read_bytes()


@pytest.mark.parametrize("name", ["../secret.mcap", "/etc/passwd", "", "no.mcap"])
def test_a_name_is_no_way_through_folders(studio, name: str, tmp_path: Path) -> None:
    for place in (Recorded(name), Sample(name)):
        with pytest.raises(RefusedError, match="is not in"):
            studio.do(commands.UseFile(place))
    with pytest.raises(RefusedError):
        studio.fetch_file(name)


def test_what_is_large_is_told_when_it_is_asked_for(house: House, studio) -> None:
    with pytest.raises(RefusedError, match="send train first"):
        studio.lesson()
    with pytest.raises(RefusedError, match="send play_reproduction first"):
        studio.reproduction()
    with pytest.raises(RefusedError, match="train a field first"):
        studio.field()
    before = len(studio.snapshot().entries)
    studio.do(commands.UseFile(Sample("demonstration-1.mcap")))
    studio.wait_for(lambda now: len(now.entries) > before, PATIENCE)
    studio.do(commands.Train(commands.LearnerSettings("rbf", 30)))
    studio.wait_for(lambda now: now.lesson is not None, PATIENCE)
    lesson = studio.lesson()
    assert lesson.model is not None
    assert lesson.model["learner"] == "RBFRegressor"
    assert (len(lesson.curve), len(lesson.curve[0])) == (142, len(lesson.summary.joints))
    with studio.clock(PATIENCE) as clock:
        studio.do(commands.PlayReproduction())
        done = clock.wait_for(lambda now: now.reproduction is not None, PATIENCE)
    assert done.reproduction is not None
    reproduction = studio.reproduction()
    assert reproduction.block_down == done.reproduction.block_down
    assert len(reproduction.measured) == len(reproduction.times)
    assert isinstance(studio.equations().equations, dict)


def test_no_studio_there_is_told_in_words() -> None:
    with pytest.raises(UnreachableError, match="studio serve --remote"):
        connect("ws://127.0.0.1:9", timeout=2.0)
    with pytest.raises(UnreachableError):
        connect("no address", timeout=2.0)


def test_a_closed_line_is_lost_and_a_late_answer_is_late(house: House) -> None:
    studio = house.connect()
    with pytest.raises(LateError, match="not answered"):
        studio.do(commands.Stop(), timeout=0.0)
    studio.close()
    with pytest.raises(LostError):
        studio.do(commands.Stop())


def test_beyond_this_machine_only_with_the_token(tmp_path: Path) -> None:
    with open_house(tmp_path, token="eight-letters") as house:
        for token in (None, "wrong-letters"):
            with pytest.raises(UnreachableError, match="wants its token"):
                house.connect(token=token)
        with house.connect(token="eight-letters") as studio:
            assert studio.snapshot().mode == "idle"


def send_without_end(studio: Studio) -> None:
    while True:
        studio.set_joint_target(dict.fromkeys(studio.welcome.joints, 0.0))


def test_a_studio_that_reads_nothing_holds_up_nobody_for_long(house: House) -> None:
    """A stand-in for one that has stalled: it says welcome, and then never reads again."""
    with house.connect() as studio:
        welcome = msgspec.json.encode(studio.welcome)
    with socket.create_server(("127.0.0.1", 0)) as listening:
        listening.settimeout(PATIENCE)

        def stall() -> None:
            line, _ = listening.accept()
            held.append(line)
            key = re.search(rb"Sec-WebSocket-Key: (.*?)\r", line.recv(4096))
            assert key is not None
            accepted = base64.b64encode(hashlib.sha1(key[1] + GUID).digest())
            line.sendall(
                b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\n"
                b"Connection: Upgrade\r\nSec-WebSocket-Accept: " + accepted + b"\r\n\r\n"
            )
            line.sendall(b"\x81\x7e" + len(welcome).to_bytes(2, "big") + welcome)

        held: list[socket.socket] = []
        stalling = threading.Thread(target=stall)
        stalling.start()
        studio = connect(f"ws://127.0.0.1:{listening.getsockname()[1]}", timeout=PATIENCE)
        stalling.join()
        studio._link.timeout = 0.2
        link._limit_sending(studio._link._socket, 0.2)
        with pytest.raises(LateError):
            studio.snapshot()
        begun = time.monotonic()
        with pytest.raises(LostError):
            send_without_end(studio)
        assert time.monotonic() - begun < PATIENCE
        studio.close()
        held[0].close()
