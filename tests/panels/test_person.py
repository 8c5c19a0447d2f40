"""The person stands where they were placed, and shows what is seen of them."""

from dataclasses import replace

import numpy as np
import pytest

from studio.engine.skeleton import Hand, HandState, Joint, Skeleton, Tracking, all_tracked
from studio.engine.snapshot import SourceStatus
from studio.panels.palette import HAND
from studio.panels.person import hand_words, joint_colors, shown_state
from studio.panels.placing import Placing


def test_a_person_is_placed_once_and_another_one_anew(lesson) -> None:
    """A step aside is seen as a step; whoever comes next begins at the same spot."""
    now, placing = lesson["sourced"], Placing()
    first = placing.of(now)
    aside = replace(now.skeleton, positions=now.skeleton.positions + np.array([0.5, 0.0, 0.0]))
    moved = replace(now, skeleton=aside)
    assert placing.of(moved) is first
    another = placing.of(replace(now, skeleton=replace(aside, body_id="another")))
    assert another.offset != pytest.approx(first.offset)
    assert placing.of(replace(now, skeleton=None)) is None


def test_a_streams_person_stays_while_its_frames_are_counted(lesson) -> None:
    now, placing = lesson["sourced"], Placing()
    live = SourceStatus("live stream", 1, 0.0, has_hand_states=True, is_live=True)
    first = placing.of(replace(now, source=live))
    assert placing.of(replace(now, source=replace(live, frames=2))) is first


def test_the_hand_wears_what_the_gate_takes_it_for(lesson) -> None:
    """A state that the source is not sure of is none, for the gate and in the picture alike."""
    now = lesson["lasso"]
    assert shown_state(now) is now.gate.state
    unsure = replace(now.gate, state=HandState.UNKNOWN)
    assert shown_state(replace(now, gate=unsure)) is HandState.UNKNOWN
    unwatched = replace(now, gate=None)
    assert shown_state(unwatched) is now.skeleton.left_hand.state
    assert shown_state(replace(unwatched, skeleton=None)) is HandState.UNKNOWN


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
