"""The joints of one arm or both, by their full names and in one order."""

import pytest

from studio.engine.arms import (
    ARMS,
    driven_joints,
    in_words,
    learned_columns,
    learned_joints,
    short_names,
    sides_of,
)
from studio.engine.retarget import MAPPINGS
from studio.engine.robot import JOINT_NAMES


@pytest.mark.parametrize("arms", ARMS)
@pytest.mark.parametrize("mapping", MAPPINGS)
def test_names_are_the_robots_and_columns_lead_to_them(arms, mapping) -> None:
    driven, learned = driven_joints(arms), learned_joints(arms, mapping)
    assert set(driven) <= set(JOINT_NAMES)
    assert [driven[column] for column in learned_columns(arms, mapping)] == list(learned)
    assert len(driven) == 4 * len(sides_of(arms))
    assert len(learned) == (4 if mapping == "exact" else 3) * len(sides_of(arms))


def test_the_side_is_left_out_where_there_is_only_one() -> None:
    assert short_names(driven_joints("right")) == ("s0", "s1", "e0", "e1")
    assert short_names(driven_joints("both")) == driven_joints("both")


def test_both_is_the_left_and_then_the_right() -> None:
    assert driven_joints("both") == driven_joints("left") + driven_joints("right")
    assert [in_words(arms) for arms in ARMS] == ["left arm", "right arm", "both arms"]
