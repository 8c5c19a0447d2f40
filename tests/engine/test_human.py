"""The torso's frame and the paper's six angles, against the law of cosines and by symmetry."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.human import ArmVectors, Held, arm_vectors, human_arm_angles
from studio.engine.skeleton import SIDES, Joint, Side, Skeleton, Tracking, all_tracked
from tests.engine.people import person

DIRECTIONS = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: math.hypot(*v) > 1e-2)
laws = settings(deadline=None, derandomize=True, max_examples=100)


@laws
@given(u=DIRECTIONS, f=DIRECTIONS, yaw=st.floats(-3.0, 3.0), side=st.sampled_from(SIDES))
def test_directions_do_not_depend_on_how_one_stands(u, f, yaw: float, side: Side) -> None:
    seen = arm_vectors(person(arm=(u, f), side=side, yaw=yaw), side)
    assert isinstance(seen, ArmVectors)
    for vector, wanted in ((seen.upper_arm, u), (seen.forearm, f)):
        in_torso = seen.torso.from_camera(vector)
        assert np.allclose(in_torso, np.array(wanted) / np.linalg.norm(wanted), atol=1e-9)


def test_the_torso_frame_is_ros_convention() -> None:
    """Facing the sensor: forward is towards it, left is the person's, up is up."""
    seen = arm_vectors(person(), "left")
    assert isinstance(seen, ArmVectors)
    assert np.allclose(
        (seen.torso.x, seen.torso.y, seen.torso.z), ((0, 0, -1), (-1, 0, 0), (0, 1, 0))
    )


def changed(skeleton: Skeleton, joint: Joint, tracking: Tracking) -> Skeleton:
    states = all_tracked()
    states[joint] = tracking
    return Skeleton(skeleton.time, skeleton.positions, states)


def test_a_joint_not_tracked_is_refused_by_name_and_an_inferred_one_is_not() -> None:
    lost = arm_vectors(changed(person(), Joint.WRIST_LEFT, Tracking.NOT_TRACKED), "left")
    assert lost == Held("left wrist not tracked")
    assert isinstance(
        arm_vectors(changed(person(), Joint.WRIST_LEFT, Tracking.INFERRED), "left"), ArmVectors
    )
    spine = arm_vectors(changed(person(), Joint.SPINE_BASE, Tracking.NOT_TRACKED), "left")
    assert spine == Held("spine base not tracked")


def test_bodies_without_extent_are_refused_in_words() -> None:
    nowhere = Skeleton(0.0, np.zeros((25, 3)), all_tracked())
    assert arm_vectors(nowhere, "left") == Held("shoulders and spine span no torso")
    folded = person().positions.copy()
    folded[Joint.WRIST_LEFT] = folded[Joint.ELBOW_LEFT]
    held = arm_vectors(Skeleton(0.0, folded, all_tracked()), "left")
    assert held == Held("left forearm shorter than 2 cm")


@pytest.mark.parametrize("scale", [10.0, 100.0, 1000.0, 1e200])
def test_bones_longer_than_anybodys_are_refused_in_words(scale: float) -> None:
    wrong = Skeleton(0.0, scale * person().positions, all_tracked())
    held = arm_vectors(wrong, "left")
    assert held == Held("left upper arm longer than 1 m: are these meters?")


def test_the_longest_arms_are_followed() -> None:
    tall = Skeleton(0.0, 1.6 * person().positions, all_tracked())  # bones of 0.45 m
    assert isinstance(arm_vectors(tall, "left"), ArmVectors)


def cosine_law(a: np.ndarray, b: np.ndarray) -> float:
    """Return the angle of two vectors by the paper's Eq. 3."""
    return math.acos(np.clip(a @ b / (np.linalg.norm(a) * np.linalg.norm(b)), -1.0, 1.0))


@pytest.mark.parametrize("side", SIDES)
def test_six_angles_equal_the_papers_equations(side: Side) -> None:
    rng = np.random.default_rng(4)
    for _ in range(200):
        skeleton = Skeleton(0.0, rng.normal(size=(25, 3)), all_tracked())
        at = {name: skeleton.positions[Joint.of(name, side)] for name in
              ("hip", "shoulder", "elbow", "wrist", "thumb", "hand_tip")}  # fmt: skip
        o, e, f, g, n, q = at.values()
        d = skeleton.positions[Joint.of("shoulder", "right" if side == "left" else "left")]
        floor = np.array([1.0, 0.0, 1.0])
        le, me = np.cross(f - e, g - f), np.cross(f - e, e - d)
        angles = human_arm_angles(skeleton, side)
        assert angles.shoulder_yaw == pytest.approx(cosine_law((d - o) * floor, (f - o) * floor))
        assert angles.shoulder_pitch == pytest.approx(cosine_law(o - e, f - e))
        assert angles.shoulder_roll == pytest.approx(cosine_law(le, me))
        assert angles.elbow_pitch == pytest.approx(cosine_law(e - f, g - f))
        assert angles.elbow_roll == pytest.approx(cosine_law(le, n - g))
        assert angles.hand_yaw == pytest.approx(cosine_law(n - g, q - g))


def test_an_angle_without_a_bone_is_nan_and_the_others_stand() -> None:
    angles = human_arm_angles(person(), "left")  # has no thumb and no hand tip of its own
    assert angles.elbow_pitch == pytest.approx(math.pi / 2)
    straight = human_arm_angles(person(arm=((1, 0, 0), (1, 0, 0))), "left")
    assert straight.elbow_pitch == pytest.approx(math.pi)
    assert math.isnan(straight.elbow_roll)
