"""Both mappings against a second library's kinematics, and their laws."""

import math
from xml.etree import ElementTree

import numpy as np
import pybullet
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.arms import driven_joints
from studio.engine.errors import StudioError
from studio.engine.performance import whole_body
from studio.engine.resources import resource_root
from studio.engine.retarget import DRIVEN_JOINTS, arm_angles, solve_elbow
from studio.engine.robot import load_robot
from studio.engine.skeleton import SIDES, Side

DIRECTIONS = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: math.hypot(*v) > 1e-3)
laws = settings(deadline=None, derandomize=True, max_examples=200)


@pytest.fixture(scope="module")
def bullet(tmp_path_factory):
    """Return joint-center directions (upper arm, forearm) of an arm by pybullet's kinematics."""
    urdf = tmp_path_factory.mktemp("urdf") / "baxter.urdf"
    tree = ElementTree.parse(resource_root() / "urdf" / "baxter.urdf")
    for link in tree.iter("link"):  # pybullet cannot resolve package://
        for visual in link.findall("visual"):
            link.remove(visual)
    tree.write(urdf)
    client = pybullet.connect(pybullet.DIRECT)
    robot = pybullet.loadURDF(str(urdf), useFixedBase=True, physicsClientId=client)
    index = {
        pybullet.getJointInfo(robot, i, physicsClientId=client)[1].decode(): i
        for i in range(pybullet.getNumJoints(robot, physicsClientId=client))
    }

    def directions(side: Side, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        for joint, angle in zip(DRIVEN_JOINTS, angles, strict=True):
            pybullet.resetJointState(robot, index[f"{side}_{joint}"], angle, physicsClientId=client)
        shoulder, elbow, wrist = (
            np.array(
                pybullet.getLinkState(
                    robot,
                    index[f"{side}_{joint}"],
                    computeForwardKinematics=True,
                    physicsClientId=client,
                )[4]
            )
            for joint in ("s1", "e1", "w1")
        )
        return unit(elbow - shoulder), unit(wrist - elbow)

    yield directions
    pybullet.disconnect(client)


def unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


@pytest.mark.parametrize("side", SIDES)
def test_exact_mapping_points_the_joint_centers_where_the_person_points(side: Side, bullet) -> None:
    """10,000 random reachable poses: the directions come back within 1e-6."""
    limits = load_robot().limits_of([f"{side}_{joint}" for joint in DRIVEN_JOINTS])
    poses = np.random.default_rng(1).uniform(limits.lower, limits.upper, (10_000, 4))
    worst = 0.0
    for pose in poses:
        wanted = bullet(side, pose)
        reached = bullet(side, arm_angles(*wanted, side))
        worst = max(worst, *(np.abs(a - b).max() for a, b in zip(wanted, reached, strict=True)))
    assert worst < 1e-6


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("bend", [1e-9, 1e-11, 2e-12, 1e-13, 0.0])
def test_an_arm_that_is_nearly_straight_or_folded_points_as_well(side: Side, bend: float) -> None:
    """Where the plane of the arm is mostly rounding; by our own kinematics, which are finer."""
    rng = np.random.default_rng(4)
    u = np.array([unit(rng.normal(size=3)) for _ in range(200)])
    f = [unit(rng.choice([-1.0, 1.0]) * v + bend * rng.normal(size=3)) for v in u]
    rows = np.array([arm_angles(*pair, side) for pair in zip(u, f, strict=True)])
    body = whole_body(rows, driven_joints(side))
    shoulder, elbow, wrist = (
        load_robot().forward_kinematics(f"{side}_{link}", body)[:, :3, 3]
        for link in ("lower_shoulder", "lower_elbow", "lower_forearm")
    )
    for bone, wanted in ((elbow - shoulder, u), (wrist - elbow, f)):
        assert np.abs(bone / np.linalg.norm(bone, axis=1, keepdims=True) - wanted).max() < 1e-9


@pytest.mark.parametrize("side", SIDES)
def test_paper_mapping_opens_the_elbow_as_the_person_does(side: Side) -> None:
    rng = np.random.default_rng(2)
    for _ in range(500):
        u, f = unit(rng.normal(size=3)), unit(rng.normal(size=3))
        s0, s1, e0, e1 = arm_angles(u, f, side, "paper")
        mount = 0.7854 if side == "left" else -0.7854
        axis = [
            math.cos(s1) * math.cos(s0 + mount),
            math.cos(s1) * math.sin(s0 + mount),
            -math.sin(s1),
        ]
        assert e0 == 0.0
        assert np.allclose(axis, u, atol=1e-9)  # s0 and s1 turn the arm's axis to the upper arm
        assert e1 == pytest.approx(math.acos(np.clip(u @ f, -1, 1)), abs=1e-6)


@laws
@given(u=DIRECTIONS, f=DIRECTIONS, mapping=st.sampled_from(["exact", "paper"]))
def test_mirrored_person_gives_the_mirrored_arm(u, f, mapping) -> None:
    """Reflecting y and swapping the arms turns s0 and e0 around and leaves s1 and e1."""
    left = arm_angles(u, f, "left", mapping)
    right = arm_angles((u[0], -u[1], u[2]), (f[0], -f[1], f[2]), "right", mapping)
    signed = np.array([-1.0, 1.0, -1.0, 1.0]) * right
    same_turn = np.abs(np.remainder(left - signed + np.pi, 2 * np.pi) - np.pi)
    straight = np.linalg.norm(np.cross(unit(np.array(u)), unit(np.array(f)))) < 1e-6
    steep = math.hypot(u[0], u[1]) / math.hypot(*u) < 1e-3
    if not straight and not steep:  # there e0 or s0 is anyone's choice
        assert same_turn.max() < 1e-6


@laws
@given(
    u=DIRECTIONS,
    f=DIRECTIONS,
    side=st.sampled_from(SIDES),
    mapping=st.sampled_from(["exact", "paper"]),
)
def test_any_two_directions_have_finite_angles(u, f, side, mapping) -> None:
    for forearm in (f, u, tuple(-x for x in u)):
        assert np.isfinite(arm_angles(u, forearm, side, mapping)).all()


@pytest.mark.parametrize("side", SIDES)
def test_a_clamped_shoulder_still_points_the_forearm(side: Side, bullet) -> None:
    rng = np.random.default_rng(3)
    for _ in range(300):
        f = unit(rng.normal(size=3))
        s0, s1 = rng.uniform((-1.7, -2.1), (1.7, 1.0))
        e0, e1 = solve_elbow(tuple(f), side, s0, s1)
        assert np.allclose(bullet(side, [s0, s1, e0, e1])[1], f, atol=1e-6)


@pytest.mark.parametrize("bad", [(0, 0, 0), (math.nan, 0, 1), (math.inf, 0, 0), (1, 0), "up"])
def test_what_is_no_direction_is_refused_in_words(bad) -> None:
    with pytest.raises(StudioError, match="upper_arm"):
        arm_angles(bad, (1, 0, 0), "left")


def test_unknown_choices_are_refused() -> None:
    for side, mapping in (("middle", "exact"), ("left", "guess")):
        with pytest.raises(StudioError, match=mapping if side == "left" else side):
            arm_angles((1, 0, 0), (0, 0, 1), side, mapping)
