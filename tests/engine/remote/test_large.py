"""What is large is made once, however many ask for it, until there is another one."""

from types import SimpleNamespace

import msgspec
import pytest

from studio.engine.errors import StudioError
from studio.engine.remote import large as module
from studio.engine.remote.large import LargeAnswers
from studio.engine.snapshot import Snapshot
from studio.remote import told
from studio.remote.asked import Fetch


@pytest.fixture
def made(monkeypatch) -> list[str]:
    """What was made, in its order."""
    calls: list[str] = []

    def large(asked: Fetch, now: Snapshot) -> told.Equations:
        if getattr(now, asked.what, "something") is None:
            raise StudioError("there is none yet")
        calls.append(asked.what)
        return told.Equations(id=asked.id, equations={"which": str(len(calls))})

    monkeypatch.setattr(module, "large", large)
    return calls


def snapshot(**of: object) -> SimpleNamespace:
    return SimpleNamespace(**{"lesson": None, "reproduction": None, **of})


@pytest.mark.parametrize("what", ["lesson", "reproduction"])
def test_it_is_made_anew_for_another_one_only_and_each_answer_has_its_own_id(
    made: list[str], what: str
) -> None:
    answers, first, second = LargeAnswers(), object(), object()
    told_first = [answers.to(Fetch(n, what), snapshot(**{what: first})) for n in range(5)]
    assert made == [what]
    assert [each.id for each in told_first] == list(range(5))
    other = answers.to(Fetch(9, what), snapshot(**{what: second}))
    assert made == [what, what]
    assert msgspec.structs.replace(other, id=0) != told_first[0]
    with pytest.raises(StudioError):
        answers.to(Fetch(10, what), snapshot())
    answers.to(Fetch(11, what), snapshot(**{what: second}))


def test_what_changes_without_a_new_object_is_made_each_time(made: list[str]) -> None:
    answers = LargeAnswers()
    for number in range(3):
        answers.to(Fetch(number, "equations"), snapshot())
    assert made == ["equations"] * 3
