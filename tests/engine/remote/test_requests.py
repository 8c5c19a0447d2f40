"""After a Stop no target counts until a program begins anew; files go with who has sent them."""

import base64
import time
from pathlib import Path

import pytest

from studio.engine import commands
from studio.engine.remote.guest import Guest
from studio.engine.remote.requests import STOPPED
from studio.engine.resources import samples_folder
from studio.engine.snapshot import Mode
from tests.engine.remote.receiving import Hall, open_hall
from tests.engine.skeleton_files import skeleton_files
from tests.remote.house import PATIENCE

TARGET = {"type": "set_joint_target", "targets": {"left_s0": 1.0}}
SAMPLE = (samples_folder() / "demonstration-1.mcap").read_bytes()


@pytest.fixture
def hall(tmp_path: Path):
    with open_hall(tmp_path) as opened:
        yield opened


def driving(hall: Hall) -> Guest:
    guest = hall.enter()
    hall.ask(guest, TARGET)
    hall.tick(3)
    assert hall.session.snapshot.mode is Mode.DRIVEN
    hall.told(guest)
    return guest


def stopped_by(hall: Hall, who: str, guest: Guest) -> None:
    """Have a page, a watching program or the program itself press Stop."""
    if who == "page":
        hall.session.post(commands.Stop())
        hall.tick()
    else:
        hall.do(hall.enter() if who == "watcher" else guest, "stop")
    assert hall.session.snapshot.mode is Mode.IDLE


def sent(hall: Hall, guest: Guest, ticks: int = 90) -> list[dict]:
    """What a program is told that goes on sending targets, tick by tick."""
    told = []
    for _ in range(ticks):
        told += hall.ask(guest, TARGET)
        hall.tick()
        told += hall.told(guest)
    return [each for each in told if each["type"] != "role"]


@pytest.mark.parametrize("who", ["page", "watcher", "itself"])
def test_after_a_stop_by_anybody_targets_are_refused_and_that_is_said_once(
    hall: Hall, who: str
) -> None:
    guest = driving(hall)
    stopped_by(hall, who, guest)
    hall.told(guest)
    (error,) = sent(hall, guest)
    assert (error["type"], error["id"], error["words"]) == ("error", None, STOPPED)
    assert hall.session.snapshot.mode is Mode.IDLE
    assert hall.session.snapshot.message.text == "Stopped."  # the page goes on saying so
    (states,) = hall.ask(guest, {"type": "get", "id": 1, "what": "joint_states"})
    assert states["stopped"]


def test_a_target_behind_the_stop_in_the_same_tick_drives_nobody_either(hall: Hall) -> None:
    guest = driving(hall)
    hall.session.post(commands.Stop())
    for _ in range(3):
        hall.ask(guest, TARGET)
    hall.ask(guest, {"type": "do", "id": 9, "command": TARGET})
    hall.tick()
    told = hall.told(guest)
    assert hall.session.snapshot.mode is Mode.IDLE
    assert sorted(each["id"] or 0 for each in told if each["words"] == STOPPED) == [0, 9]
    assert sent(hall, guest) == []


def test_an_answered_target_is_refused_each_time(hall: Hall) -> None:
    guest = driving(hall)
    hall.do(guest, "stop")
    for _ in range(2):
        (error,) = hall.ask(guest, {"type": "do", "id": 4, "command": TARGET})
        assert (error["id"], error["words"]) == (4, STOPPED)


def test_it_is_begun_anew_by_a_command_and_stopped_anew(hall: Hall) -> None:
    guest = driving(hall)
    for _ in range(2):
        stopped_by(hall, "page", guest)
        assert [each["words"] for each in sent(hall, guest, 10)] == [STOPPED]
        assert hall.do(guest, "begin_driving")["type"] == "done"
        assert hall.session.snapshot.mode is Mode.IDLE  # it goes nowhere by itself
        assert sent(hall, guest, 10) == []
        assert hall.session.snapshot.mode is Mode.DRIVEN


def test_only_who_controls_begins_anew_and_not_while_somebody_teaches(hall: Hall) -> None:
    guest, other = driving(hall), hall.enter()
    hall.do(guest, "stop")
    asked = {"type": "do", "id": 5, "command": {"type": "begin_driving"}}
    assert "ask for control" in hall.ask(other, asked)[-1]["words"]
    hall.do(guest, "use_demonstrator")
    hall.do(guest, "record")
    refused = hall.do(guest, "begin_driving")
    assert (refused["type"], "Somebody teaches" in refused["words"]) == ("error", True)


def test_while_the_clock_is_in_its_hand_a_stop_is_a_stop(hall: Hall) -> None:
    guest, other = driving(hall), hall.enter()
    hall.ask(guest, {"type": "take_clock", "id": 1})
    hall.ask(other, {"type": "do", "id": 2, "command": {"type": "stop"}})
    hall.session.hear()
    hall.told(guest)
    (error,) = sent(hall, guest, 40)  # its steps: time passes, and nothing moves
    assert error["words"] == STOPPED
    assert hall.session.snapshot.mode is Mode.IDLE


def uploaded(hall: Hall, guest: Guest, content: bytes, name: str = "mine.mcap") -> str:
    part, upload = 200_000, None
    for start in range(0, len(content), part):
        encoded = base64.b64encode(content[start : start + part]).decode()
        asked = {"type": "upload", "id": 3, "content": encoded, "name": name, "upload": upload}
        upload = hall.ask(guest, asked)[-1]["upload"]
    assert upload is not None
    return upload


def kept(hall: Hall) -> list[str]:
    """The files that lie in the folder of uploads."""
    uploads = hall.reception._shelf._uploads
    return [] if uploads is None else sorted(p.name for p in Path(uploads._folder.name).iterdir())


def until(hall: Hall, reached) -> None:
    end = time.monotonic() + PATIENCE
    while not reached():
        assert time.monotonic() < end, hall.session.snapshot.message.text
        hall.tick()
        hall.reception.look()
        time.sleep(0.002)


def test_what_a_program_sent_goes_with_it(hall: Hall) -> None:
    guest, other = hall.enter(), hall.enter()
    for _ in range(3):
        uploaded(hall, guest, b"nothing of use")
    mine = uploaded(hall, other, b"of another")
    hall.reception.leave(guest)
    hall.reception.look()
    assert kept(hall) == [mine]
    assert hall.reception._shelf.size > 0
    hall.reception.leave(other)
    hall.reception.look()
    assert (kept(hall), hall.reception._shelf.size) == ([], 0)


def test_what_is_still_to_be_read_is_kept_until_it_was(hall: Hall) -> None:
    guest = hall.enter()
    uploads = [uploaded(hall, guest, SAMPLE, f"{number}.mcap") for number in range(2)]
    for upload in uploads:
        place = {"type": "uploaded", "upload": upload}
        hall.ask(guest, {"type": "do", "command": {"type": "add_from", "file": place}})
    hall.reception.leave(guest)
    hall.reception.look()
    assert kept(hall) == uploads  # nobody has even begun
    hall.session.hear()
    hall.reception.look()
    assert kept(hall) == uploads
    until(hall, lambda: len(hall.session.snapshot.entries) == 2)  # a file was lost to neither
    until(hall, lambda: kept(hall) == [])


def test_what_is_followed_is_kept_until_another_is(hall: Hall) -> None:
    guest = hall.enter()
    upload = uploaded(hall, guest, skeleton_files()["table 101"], "table.csv")
    place = {"type": "uploaded", "upload": upload}
    hall.do(guest, "use_file", file=place)
    hall.reception.leave(guest)
    until(hall, lambda: hall.session.snapshot.source is not None)
    hall.reception.look()
    assert kept(hall) == [upload]
    hall.session.post(commands.FollowBody(None))  # reads it anew
    hall.tick()
    until(hall, lambda: hall.session.snapshot.who.reading is None)
    assert not hall.session.snapshot.message.is_error
    assert kept(hall) == [upload]
    hall.session.post(commands.UseDemonstrator())
    until(hall, lambda: kept(hall) == [])
