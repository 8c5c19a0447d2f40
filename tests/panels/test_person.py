"""The person is drawn where they stand, and as surely as they are seen."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
import viser

from studio.engine.skeleton import (
    FloatArray,
    Hand,
    HandState,
    Joint,
    Skeleton,
    Tracking,
    all_tracked,
)
from studio.engine.snapshot import SourceStatus
from studio.engine.sources.demonstrator import demonstrate
from studio.panels.palette import HAND
from studio.panels.person import PersonView, hand_words, joint_colors


@pytest.fixture
def view() -> Iterator[PersonView]:
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    try:
        yield PersonView(server.scene)
    finally:
        server.stop()


def test_a_live_persons_steps_are_seen_as_steps(lesson, view: PersonView) -> None:
    """Whom a live stream shows stays placed, however many frames have come; others are not."""
    take = demonstrate(seed=3)
    aside = replace(take[1], positions=take[0].positions + np.array([0.5, 0.0, 0.0]))
    live = SourceStatus("live stream", 1, 0.0, True, is_live=True)

    def drawn(skeleton: Skeleton, source: SourceStatus) -> FloatArray:
        view.draw(replace(lesson["sourced"], source=source, skeleton=skeleton))
        return np.array(view._joints.batched_positions)

    first = drawn(take[0], live)
    then = drawn(aside, replace(live, frames=2, seconds=1.0))
    np.testing.assert_allclose(then - first, np.tile((0.0, -0.5, 0.0), (25, 1)), atol=1e-6)
    other = drawn(replace(aside, body_id="other"), replace(live, frames=3))
    np.testing.assert_allclose(other, first, atol=1e-6)
    drawn(take[0], live)
    np.testing.assert_allclose(drawn(aside, replace(live, name="a file")), first, atol=1e-6)


def test_guessed_joints_are_pale() -> None:
    tracking = all_tracked()
    tracking[Joint.WRIST_LEFT] = Tracking.INFERRED
    colors = joint_colors(Skeleton(0.0, np.zeros((25, 3)), tracking))
    assert colors[Joint.WRIST_LEFT].sum() > colors[Joint.HAND_LEFT].sum()
    assert len(np.unique(colors, axis=0)) == 2


def test_each_sign_has_its_color_and_its_word() -> None:
    signs = (HandState.LASSO, HandState.OPEN, HandState.CLOSED)
    assert len({HAND[sign] for sign in (*signs, HandState.UNKNOWN)}) == 4
    assert hand_words(Hand(HandState.NOT_TRACKED).state) == "left hand: NOT TRACKED"
