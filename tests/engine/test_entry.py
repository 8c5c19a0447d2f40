"""A card: trimming takes from what was recorded, and takes nothing for good."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.demonstration import SHORTEST
from studio.engine.entry import LONGEST_NAME, Entry
from studio.engine.errors import StudioError
from studio.engine.export.material import cut
from studio.engine.robot import CONTROL_PERIOD
from tests.engine.cards_at_hand import take

CARD = Entry.of(1, take(1))
LENGTH = CARD.whole.duration
moments = st.floats(-1.0, LENGTH + 1.0)


@settings(deadline=None, derandomize=True, max_examples=60)
@given(moments, moments)
def test_what_is_kept_is_what_was_shown_between_the_handles(begin: float, end: float) -> None:
    begin, end = min(begin, end), max(begin, end)
    inside = min(end, LENGTH) - max(begin, 0.0)
    if inside < SHORTEST - 2 * CONTROL_PERIOD:
        with pytest.raises(StudioError, match="trim less"):
            CARD.trimmed(begin, end)
    elif inside > SHORTEST + 2 * CONTROL_PERIOD:
        kept = CARD.trimmed(begin, end)
        assert kept.span == pytest.approx(
            (max(begin, 0.0), min(end, LENGTH)), abs=CONTROL_PERIOD / 2 + 1e-9
        )
        shown = kept.demonstration
        assert shown.times[0] == 0.0
        np.testing.assert_allclose(shown.sent, CARD.whole.at(shown.times + kept.span[0]))
        assert kept.whole is CARD.whole
        back = kept.trimmed(0.0, LENGTH).demonstration
        assert np.array_equal(back.sent, CARD.demonstration.sent)
        assert np.array_equal(back.times, CARD.demonstration.times)


def test_a_second_is_enough() -> None:
    assert CARD.trimmed(2.0, 3.0).demonstration.duration == pytest.approx(SHORTEST)
    assert not CARD.is_trimmed
    assert CARD.trimmed(2.0, 3.0).is_trimmed


def test_a_trimmed_take_from_elsewhere_can_be_widened_again() -> None:
    kept = CARD.trimmed(1.0, 3.0)
    again = Entry.of(7, replace(kept.take, included=False))
    assert (again.number, again.included, again.span) == (7, False, kept.span)
    assert again.trimmed(0.0, LENGTH).demonstration.duration == CARD.demonstration.duration


def test_a_take_that_no_armed_stretch_holds_is_its_own_whole() -> None:
    given = take(1)
    early = cut(given.recording, "early", 0, given.demonstration.last_sample)
    card = Entry.of(1, replace(given, demonstration=early))
    assert card.whole is early
    assert card.span == (0.0, pytest.approx(early.duration))


@pytest.mark.parametrize("name", ["", "  ", "two\nlines", "x" * (LONGEST_NAME + 1), "a\0b"])
def test_a_name_that_cannot_be_shown_is_refused(name: str) -> None:
    with pytest.raises(StudioError, match="in one line"):
        CARD.renamed(name)


@pytest.mark.parametrize("name", ["../../etc/passwd", "C:\\x", "Zoë's push", "<b>", "CON"])
def test_any_other_name_is_only_a_name(name: str) -> None:
    renamed = CARD.renamed(f" {name} ")
    assert (renamed.name, renamed.whole.name, renamed.take.demonstration.name) == (name,) * 3
    assert renamed.trimmed(1.0, 3.0).name == name
