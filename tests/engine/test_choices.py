"""What was chosen is what the pipeline does; and what a change of it costs."""

from dataclasses import replace

import pytest

from studio.engine.arms import ARMS
from studio.engine.calibration import Calibration
from studio.engine.choices import Choices
from studio.engine.hands import HandOptions

CHOSEN = Choices(
    "both", "paper", "open", True, HandOptions(True, "level"), Calibration((0.1, 0.0, -1.0))
)


def test_the_pipeline_is_what_was_chosen() -> None:
    made = CHOSEN.pipeline()
    assert (made.arms, made.mapping, made.gate.mode) == ("both", "paper", "open")
    assert (made.mirrored, made.calibration) == (True, CHOSEN.calibration)
    assert made.hands.options == CHOSEN.hands


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("arms", ARMS)
def test_the_persons_arms_are_those_that_the_pipeline_follows(arms, mirrored) -> None:
    chosen = Choices(arms, mirrored=mirrored)
    assert chosen.persons_sides == tuple(each.persons_side for each in chosen.pipeline().stages)


@pytest.mark.parametrize(
    ("change", "learns_the_same", "starts_the_same"),
    [
        ({}, True, True),
        ({"gate": "sequence", "mirrored": False, "calibration": None}, True, True),
        ({"hands": HandOptions(True, "follow")}, True, True),
        ({"hands": HandOptions(False, "level")}, True, False),
        ({"mapping": "exact"}, False, False),
        ({"arms": "left"}, False, False),
    ],
)
def test_only_arms_and_mapping_make_other_joints_and_fingers_another_world(
    change: dict, learns_the_same: bool, starts_the_same: bool
) -> None:
    changed = replace(CHOSEN, **change)
    assert (changed.joints == CHOSEN.joints) is learns_the_same
    assert changed.starts_as(CHOSEN) is starts_the_same


def test_a_fresh_world_has_fingers_where_they_were_chosen() -> None:
    for chosen, fingers in ((CHOSEN, 4), (Choices(), 0)):
        with chosen.start_world() as world:
            assert len(world.state.fingers) == fingers
