import math

import numpy as np
import pytest

from studio.engine.human import TorsoFrame
from studio.engine.pipeline import ready_angles
from studio.engine.retarget import Angles
from studio.engine.robot import JOINT_NAMES, load_robot
from studio.engine.skeleton import SIDES, FloatArray, Joint, Side, Tracking
from studio.engine.vectors import Vector
from studio.engine.wrist import AT_REST, Wrist, WristAngles, hand_direction, turning_alike
from tests.engine.people import person

ROBOT = load_robot()
UPRIGHT = TorsoFrame((0.0, 0.0, -1.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0))


def hand(side: Side, arm: Angles, wrist: WristAngles) -> FloatArray:
    """Return the hand's rotation (3, 3): the other road, by the robot's own kinematics."""
    body = np.zeros(len(JOINT_NAMES))
    start = JOINT_NAMES.index(f"{side}_s0")
    body[start : start + 7] = (*arm, *wrist)
    return ROBOT.forward_kinematics(f"{side}_hand", body)[:3, :3]


def random_arms(count: int, seed: int = 0) -> list[Angles]:
    limits = ROBOT.limits_of([f"left_{joint}" for joint in ("s0", "s1", "e0", "e1")])
    rows = np.random.default_rng(seed).uniform(limits.lower, limits.upper, (count, 4))
    return [(s0, s1, e0, e1) for s0, s1, e0, e1 in rows.tolist()]


def is_inside(wrist: Wrist, angles: WristAngles, by: float = 0.0) -> bool:
    return bool(
        (np.array(angles) >= wrist.lower + by).all()
        and (np.array(angles) <= wrist.upper - by).all()
    )


@pytest.mark.parametrize("side", SIDES)
def test_a_level_hand_is_level_and_heads_as_the_forearm_does(side: Side) -> None:
    wrist, level = Wrist.for_robot(ROBOT, side), 0
    for arm in random_arms(200):
        angles = wrist.level(arm, AT_REST)
        assert is_inside(wrist, angles)
        forearm = hand(side, arm, AT_REST)[:, 2]
        if not is_inside(wrist, angles, 1e-6) or math.hypot(*forearm[:2]) < 0.2:
            continue
        turned = hand(side, arm, angles)
        bent = math.acos(min(1.0, math.hypot(*forearm[:2])))
        if bent > math.radians(5.1):
            np.testing.assert_allclose(turned[2, 1:], 0.0, atol=1e-9)  # opens and points level
            heading = forearm[:2] / math.hypot(*forearm[:2])
            np.testing.assert_allclose(turned[:2, 2], heading, atol=1e-9)
            level += 1
    assert level > 100


def test_a_forearm_that_is_level_already_keeps_w0() -> None:
    wrist = Wrist.for_robot(ROBOT, "left")
    arm = (0.0, 0.0, 0.0, 0.03)  # almost level
    for w0 in (-1.0, 0.0, 0.7):
        angles = wrist.level(arm, (w0, 0.0, -w0))
        assert angles[0] == w0
        assert abs(hand("left", arm, angles)[2, 2]) < 0.05
        assert abs(hand("left", arm, angles)[2, 1]) < 0.05


def test_under_a_forearm_that_stands_on_end_the_wrist_stays() -> None:
    wrist, before = Wrist.for_robot(ROBOT, "left"), (0.1, 0.2, 0.3)
    assert wrist.level((0.0, 0.0, 0.0, math.pi / 2), before) == before


@pytest.mark.parametrize("side", SIDES)
def test_a_hand_follows_a_direction_without_twisting(side: Side) -> None:
    wrist, random = Wrist.for_robot(ROBOT, side), np.random.default_rng(1)
    followed = 0
    for arm in random_arms(200, seed=2):
        forearm = hand(side, arm, AT_REST)
        wanted = forearm[:, 2] + random.normal(scale=0.5, size=3)
        wanted /= np.linalg.norm(wanted)
        x, y, z = wanted.tolist()
        angles = wrist.follow(arm, (x, y, z), AT_REST)
        assert is_inside(wrist, angles)
        if is_inside(wrist, angles, 1e-6) and np.linalg.norm(np.cross(wanted, forearm[:, 2])) > 0.1:
            turned = hand(side, arm, angles)
            np.testing.assert_allclose(turned[:, 2], wanted, atol=1e-9)
            # Turned about an axis across both, by the angle between them: the shortest way.
            relative = forearm.T @ turned
            assert math.acos((np.trace(relative) - 1) / 2) == pytest.approx(
                math.acos(wanted @ forearm[:, 2])
            )
            followed += 1
    assert followed > 100


@pytest.mark.parametrize("mode", ["level", "follow"])
def test_what_changes_little_is_followed_by_little(mode: str) -> None:
    """The wrist does not swing round from one tick to the next."""
    wrist = Wrist.for_robot(ROBOT, "left")
    angles = AT_REST
    found = []
    for t in np.linspace(0.0, 4.0, 240):
        s0, s1, e0, e1 = ready_angles("left", "exact").tolist()
        arm = (s0 + 0.3 * math.sin(t), s1, e0 + 0.4 * math.sin(2 * t), e1 + 0.2 * math.cos(t))
        direction: Vector = (0.8, 0.6 * math.cos(t), 0.6 * math.sin(t))
        if mode == "level":
            angles = wrist.level(arm, angles)
        else:
            angles = wrist.follow(arm, direction, angles)
        found.append(angles)
    assert np.abs(np.diff(found[1:], axis=0)).max() < 0.15


def test_triples_that_turn_alike_do_so_and_the_nearest_counts() -> None:
    random = np.random.default_rng(3)
    arm = ready_angles("left", "exact").tolist()
    for _ in range(50):
        angles, near = random.uniform(-3.0, 3.0, (2, 3))
        found = turning_alike(angles, near)
        one, other = (hand("left", arm, tuple(each)) for each in (angles, found))
        np.testing.assert_allclose(one, other, atol=1e-9)
        assert np.sum((found - near) ** 2) <= np.sum((angles - near) ** 2) + 1e-12
        flipped = angles * (1, -1, 1) + (math.pi, 0.0, -math.pi)
        np.testing.assert_allclose(turning_alike(flipped, near), found, atol=1e-9)


def test_a_hands_direction_is_told_in_the_torsos_frame() -> None:
    skeleton = person()
    for side in SIDES:
        positions = skeleton.positions.copy()
        wrist, tip = Joint.of("wrist", side), Joint.of("hand_tip", side)
        positions[tip] = positions[wrist] + [0.0, 0.0, -0.1]  # towards the sensor: forward
        seen = type(skeleton)(**{**vars(skeleton), "positions": positions})
        assert hand_direction(seen, side, UPRIGHT) == pytest.approx((1.0, 0.0, 0.0))


@pytest.mark.parametrize("part", ["wrist", "hand_tip"])
def test_a_hand_that_is_inferred_or_has_no_length_points_nowhere(part: str) -> None:
    skeleton = person()
    tracking = skeleton.tracking.copy()
    tracking[Joint.of(part, "left")] = Tracking.INFERRED
    seen = type(skeleton)(**{**vars(skeleton), "tracking": tracking})
    assert hand_direction(seen, "left", UPRIGHT) is None
    positions = skeleton.positions.copy()
    positions[Joint.of("hand_tip", "left")] = positions[Joint.of("wrist", "left")]
    seen = type(skeleton)(**{**vars(skeleton), "positions": positions})
    assert hand_direction(seen, "left", UPRIGHT) is None
