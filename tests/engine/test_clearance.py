"""Two roads to one distance: our capsules, and pybullet's search on the very shapes."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pybullet
import pytest

from studio.engine.clearance import Clearance, Pairs
from studio.engine.robot import BASE_HEIGHT, JOINT_NAMES, load_robot
from studio.engine.scene import Scene
from studio.engine.skeleton import FloatArray
from studio.engine.world_robot import load_bodies

ROBOT = load_robot()
REST = np.zeros(15)
ARMS = Clearance.of(ROBOT, Scene(), REST, range(14))
FAR = 0.3  # [m] up to which the two are compared
SKINS = 2e-3  # [m]: to each of two shapes pybullet adds a skin of 1 mm


def random_poses(count: int, seed: int = 0) -> FloatArray:
    limits = ROBOT.limits
    poses = np.random.default_rng(seed).uniform(limits.lower, limits.upper, (count, 15))
    poses[:, -1] = 0.0
    return poses


class Bullet:
    """The robot and the desk, as pybullet has them."""

    def __init__(self) -> None:
        self.client = pybullet.connect(pybullet.DIRECT)
        bodies = load_bodies(self.client, fingers=False, looks=False)
        found = [
            (body, pybullet.getJointInfo(body, i, physicsClientId=self.client))
            for body in bodies
            for i in range(pybullet.getNumJoints(body, physicsClientId=self.client))
        ]
        self.motors = {info[1].decode(): (body, info[0]) for body, info in found}
        self.links = {info[12].decode(): (body, info[0]) for body, info in found}
        self.links["base"] = (bodies[0], -1)
        desk = Scene().placed_desk
        half = [side / 2 for side in desk.size]
        shape = pybullet.createCollisionShape(
            pybullet.GEOM_BOX, halfExtents=half, physicsClientId=self.client
        )
        self.desk = pybullet.createMultiBody(
            0.0, shape, basePosition=desk.position, physicsClientId=self.client
        )

    def put(self, angles: FloatArray) -> None:
        for name, angle in zip(JOINT_NAMES, angles.tolist(), strict=True):
            pybullet.resetJointState(*self.motors[name], angle, physicsClientId=self.client)

    def distance(self, one: str, other: str) -> float:
        (body, link), second = self.links[one], self.links.get(other, (self.desk, -1))
        found = pybullet.getClosestPoints(
            body, second[0], FAR, link, second[1], physicsClientId=self.client
        )
        return min((point[8] for point in found), default=FAR)


@pytest.fixture(scope="module")
def bullet() -> Iterator[Bullet]:
    bullet = Bullet()
    yield bullet
    pybullet.disconnect(physicsClientId=bullet.client)


def by_links(
    clearance: Clearance, pairs: Pairs, distances: FloatArray
) -> dict[tuple[str, str], float]:
    """Return the least distance of each two links, or of a link and the desk."""
    least: dict[tuple[str, str], float] = {}
    for index, distance in enumerate(distances.tolist()):
        one = clearance.capsules.parts[pairs.first[index]]
        others = clearance.capsules.parts if index < pairs.rounded else clearance.boxes.parts
        other = others[pairs.second[index]]
        key = (one.link, other.link or other.name)
        if key[::-1] in least:
            key = key[::-1]
        least[key] = min(least.get(key, FAR), distance)
    return least


def test_never_less_safe_than_pybullet_and_little_more_cautious(bullet: Bullet) -> None:
    caution = []
    for angles in random_poses(60):
        bullet.put(angles)
        ours = by_links(ARMS, ARMS.pairs, ARMS.distances(ARMS.lines(angles), ARMS.pairs))
        for (one, other), distance in ours.items():
            theirs = bullet.distance(one, other)
            if 0.0 < theirs < FAR:
                caution.append(theirs - distance)
    assert len(caution) > 1000
    assert min(caution) > -SKINS
    assert max(caution) < 0.1  # two flat ends, each covered by a cap of 4.6 cm
    assert np.median(caution) < 0.012


def test_the_broad_phase_leaves_out_nothing_that_is_near() -> None:
    for angles in random_poses(50, seed=1):
        lines = ARMS.lines(angles)
        distances = ARMS.distances(lines, ARMS.pairs)
        for reach in (ARMS.pairs.stop, ARMS.pairs.slow):
            near = ARMS.pairs.chosen(ARMS.within(lines, reach))
            found = set(zip(near.first.tolist(), near.second.tolist(), strict=True))
            needed = np.flatnonzero(distances < reach)
            first, second = ARMS.pairs.first[needed], ARMS.pairs.second[needed]
            assert found >= set(zip(first.tolist(), second.tolist(), strict=True))
            assert len(near) < len(ARMS.pairs)


def test_no_pair_comes_nearer_than_its_two_travel() -> None:
    for angles in random_poses(30, seed=4):
        moved = angles + np.random.default_rng(5).normal(scale=0.1, size=15)
        lines = ARMS.lines(np.stack([angles, moved]))
        before, after = ARMS.distances(lines, ARMS.pairs)
        travels = ARMS.travels(lines[0], lines[1])
        assert (before - after <= travels + 1e-9).all()
        assert (travels < 1.4 * np.abs(moved - angles).sum()).all()


def test_no_pair_comes_nearer_than_the_levers_of_its_joints_allow() -> None:
    random = np.random.default_rng(6)
    shares = []
    for angles in random_poses(30, seed=7):
        turns = random.normal(scale=0.1, size=15) * (random.random(15) < 0.5)
        turns[-1] = 0.0
        ways = np.linspace(angles, angles + turns, 7)
        before, *after = ARMS.distances(ARMS.lines(ways), ARMS.pairs)
        most = ARMS.may_travel(turns[:14])
        nearest = before - np.min(after, axis=0)
        assert (nearest <= most + 1e-12).all()
        shares.append(np.max(nearest / np.maximum(most, 1e-3)))
    assert max(shares) > 0.5  # it is no empty bound


def test_many_poses_at_once_are_each_of_them() -> None:
    poses = random_poses(6, seed=2)
    together = ARMS.distances(ARMS.lines(poses), ARMS.pairs)
    alone = [ARMS.distances(ARMS.lines(each), ARMS.pairs) for each in poses]
    np.testing.assert_allclose(together, alone, atol=1e-12)


def test_one_arm_alone_is_as_far_from_things_as_both_are() -> None:
    left = Clearance.of(ROBOT, Scene(), REST, range(7))
    angles = random_poses(1, seed=3)[0]
    angles[7:] = 0.0
    ours = by_links(left, left.pairs, left.distances(left.lines(angles), left.pairs))
    both = by_links(ARMS, ARMS.pairs, ARMS.distances(ARMS.lines(angles), ARMS.pairs))
    assert ours
    for links, distance in ours.items():
        assert distance == pytest.approx(both.get(links, both.get(links[::-1])), abs=1e-12)


def test_only_what_moves_is_watched() -> None:
    left = Clearance.of(ROBOT, Scene(), REST, range(7))
    for index in range(len(left.pairs)):
        assert any(name.startswith("left") for name in left.names(left.pairs, index))


def test_the_desk_follows_the_scene() -> None:
    """Raised by 5 cm, the desk is 5 cm nearer to the hand above it."""
    angles = REST.copy()
    angles[:4] = (-0.4, 0.0, 0.0, 0.4)
    x, y, z = Scene().desk.position
    raised = Scene(desk=replace(Scene().desk, position=(x, y, z + 0.05)))
    found = []
    for scene in (Scene(), raised):
        clearance = Clearance.of(ROBOT, scene, REST, range(7))
        distances = clearance.distances(clearance.lines(angles), clearance.pairs)
        found.append(by_links(clearance, clearance.pairs, distances)["left_hand", "desk"])
    assert 0.0 < found[1] < found[0] < BASE_HEIGHT
    assert found[0] - found[1] == pytest.approx(0.05, abs=1e-3)
