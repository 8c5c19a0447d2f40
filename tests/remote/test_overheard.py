"""The check of the messages can fail: an undocumented one, of either side, does not pass."""

import json

import pytest
from websockets.sync.client import connect

from studio.remote.asked import MOST_TICKS
from tests.remote.house import open_house
from tests.remote.overheard import Overheard, UndocumentedError

DOCUMENTED = {"type": "done", "id": 1, "words": ""}


def told(**changes: object) -> Overheard:
    overheard = Overheard()
    message = {k: v for k, v in {**DOCUMENTED, **changes}.items() if v is not None}
    overheard("told", json.dumps(message))
    return overheard


def test_a_documented_message_passes() -> None:
    assert told().check() == 1


@pytest.mark.parametrize(
    "changes", [{"type": "whatever"}, {"type": None}, {"more": 1}, {"id": "1"}, {"id": None}]
)
def test_any_other_does_not(changes: dict[str, object]) -> None:
    with pytest.raises(UndocumentedError):
        told(**changes).check()


def test_a_message_of_the_other_side_is_none() -> None:
    overheard = Overheard()
    overheard("asked", json.dumps(DOCUMENTED))
    with pytest.raises(UndocumentedError, match="no message of type 'done'"):
        overheard.check()


def test_a_house_in_which_one_was_exchanged_fails(tmp_path) -> None:
    with pytest.raises(UndocumentedError), open_house(tmp_path) as house, house.connect():
        house.overheard("told", '{"type": "rumor"}')


@pytest.mark.parametrize("message", ["rumor", "[]", "42", '{"type": "rumor"}'])
def test_garbage_passes_only_where_it_was_declared(tmp_path, message: str) -> None:
    """Of a program's own, which the studio refuses: it does not go unheard for that."""
    with pytest.raises(UndocumentedError), open_house(tmp_path) as house:
        say(house.url, message)
    with open_house(tmp_path) as house:
        house.overheard.garbage.add(message)
        say(house.url, message)
    overheard = Overheard()
    overheard.garbage.add(message)
    overheard("told", message)  # the studio itself says none
    with pytest.raises(UndocumentedError):
        overheard.check()


def say(url: str, message: str) -> None:
    with connect(url, compression=None, proxy=None) as line:
        line.send(message)
        while json.loads(line.recv())["type"] != "error":
            pass


def test_of_many_messages_that_are_alike_each_is_checked() -> None:
    overheard = Overheard()
    for ticks in range(1, 31):
        overheard("asked", json.dumps({"type": "step", "id": 1, "ticks": ticks}))
    assert overheard.check() == 30
    overheard("asked", json.dumps({"type": "step", "id": 1, "ticks": MOST_TICKS + 1}))
    with pytest.raises(UndocumentedError, match="ticks"):
        overheard.check()


# What the house itself lets pass.


def test_a_program_that_fails_is_tried_again_only_where_the_robot_was_halted(tmp_path) -> None:
    fails = tmp_path / "fails.py"
    fails.write_text("print('tried'); raise SystemExit(1)")
    with open_house(tmp_path) as house, house.connect():
        with pytest.raises(AssertionError, match="tried"):
            house.run_python(fails, tries=3)
        assert house.failed == 1
