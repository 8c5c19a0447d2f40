"""A standing person: whole, and alike on both sides."""

import pytest

from studio.engine.skeleton import Joint
from studio.engine.standing import TRUNK


def test_all_joints_but_the_arms_are_there() -> None:
    arms = {"elbow", "wrist", "hand", "hand_tip", "thumb"}
    left_out = {Joint.of(part, side) for part in arms for side in ("left", "right")}
    assert set(TRUNK) == set(Joint) - left_out


def test_the_right_side_mirrors_the_left() -> None:
    for part in ("shoulder", "hip", "knee", "ankle", "foot"):
        x, y, z = TRUNK[Joint.of(part, "left")]
        assert TRUNK[Joint.of(part, "right")] == pytest.approx((x, -y, z))
