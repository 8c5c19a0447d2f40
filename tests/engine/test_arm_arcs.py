"""Arcs show the angles that they stand for."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings, strategies

from studio.engine.arm_arcs import NAMES, STEPS, arm_arcs
from studio.engine.human import human_arm_angles
from studio.engine.puppet import PuppetTeacher
from studio.engine.skeleton import SIDES, Joint

PERSON = PuppetTeacher().skeleton
shifts = strategies.lists(strategies.floats(-0.4, 0.4), min_size=75, max_size=75)


@given(shifts, strategies.sampled_from(SIDES))
@settings(deadline=None, derandomize=True, max_examples=100)
def test_every_arc_spans_its_angle(shift, side) -> None:
    """Two roads: by arrays here, by scalars there; and what is drawn turns by as much."""
    person = replace(PERSON, positions=PERSON.positions + np.reshape(shift, (25, 3)))
    angles = human_arm_angles(person, side)
    arcs = {arc.name: arc for arc in arm_arcs(person, side)}
    for name in NAMES:
        expected = getattr(angles, name)
        if np.isnan(expected):
            assert name not in arcs
            continue
        arc = arcs[name]
        assert arc.angle == pytest.approx(expected, abs=1e-7)
        steps = np.linalg.norm(np.diff(arc.points, axis=0), axis=1)
        assert steps == pytest.approx(np.full(len(steps), steps.mean()), abs=1e-9)
        # [m] from the middle of a line to the circle: nobody sees the corners
        assert steps.mean() / 2.0 * np.tan(arc.angle / (STEPS - 1) / 4.0) < 0.002


def test_arcs_stand_at_the_arm() -> None:
    """The elbow's arc begins on the upper arm and ends on the forearm."""
    at = PERSON.positions
    arc = next(arc for arc in arm_arcs(PERSON, "left") if arc.name == "elbow_pitch")
    elbow = at[Joint.ELBOW_LEFT]
    for end, joint in ((arc.points[0], Joint.SHOULDER_LEFT), (arc.points[-1], Joint.WRIST_LEFT)):
        bone, leg = at[joint] - elbow, end - elbow
        assert np.linalg.norm(np.cross(bone, leg)) == pytest.approx(0.0, abs=1e-9)
        assert bone @ leg > 0.0


def test_a_bone_without_length_has_no_arc() -> None:
    positions = PERSON.positions.copy()
    positions[Joint.THUMB_LEFT] = positions[Joint.WRIST_LEFT]
    found = [arc.name for arc in arm_arcs(replace(PERSON, positions=positions), "left")]
    assert found == list(NAMES[:4])
