"""The check of the messages can fail: an undocumented one, of either side, does not pass."""

import json

import pytest

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
