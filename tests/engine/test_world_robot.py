import tempfile

import numpy as np
import pybullet
import pytest

from studio.engine import world_robot
from studio.engine.clearance import Clearance
from studio.engine.robot import BASE_HEIGHT, load_robot, urdf_without_visuals
from studio.engine.scene import Scene
from studio.engine.skeleton import FloatArray
from studio.engine.world import World
from tests.engine.motions import EMPTY, command, play, rows


def in_one_piece(client: int, _fingers: bool, _looks: bool) -> list[int]:
    """Load the robot as the one body that its description describes."""
    with tempfile.NamedTemporaryFile(suffix=".urdf") as file:
        file.write(urdf_without_visuals())
        file.flush()
        return [
            pybullet.loadURDF(
                file.name,
                basePosition=(0.0, 0.0, BASE_HEIGHT),
                useFixedBase=True,
                flags=pybullet.URDF_USE_INERTIA_FROM_FILE,
                physicsClientId=client,
            )
        ]


def converged(told: FloatArray) -> FloatArray:
    """Return how the joints follow in free air if the engine iterates till nothing changes."""
    with World(EMPTY, command(told[0])) as world:
        pybullet.setPhysicsEngineParameter(
            numSolverIterations=300, solverResidualThreshold=0.0, physicsClientId=world._client
        )
        found = []
        for row in told:
            world.apply(command(row))
            found.append(world.step().joint_positions)
    return np.array(found)


def test_three_bodies_are_the_same_robot_as_one(monkeypatch: pytest.MonkeyPatch) -> None:
    told = rows("bend")[:60]
    apart, pushed = converged(told), play(Scene(), rows("sweep exact"))
    monkeypatch.setattr(world_robot, "load_bodies", in_one_piece)
    np.testing.assert_allclose(converged(told), apart, atol=1e-12)
    whole = play(Scene(), rows("sweep exact"))
    assert pushed[-1].block_down
    assert whole[-1].block_down


def test_no_arm_reaches_down_to_the_floor() -> None:
    """So it need not be looked for there."""
    robot = load_robot(fingers=True)
    limits, random = robot.limits, np.random.default_rng(0)
    clearance = Clearance.of(robot, Scene(), np.zeros(19), range(14))
    lowest = np.inf
    for _ in range(10):
        poses = random.uniform(limits.lower, limits.upper, (1000, 19))
        corners = np.where(random.random(poses.shape) < 0.5, limits.lower, limits.upper)
        poses = np.where(random.random(poses.shape) < 0.5, poses, corners)
        poses[:, [1, 8]] = limits.upper[1]  # the shoulder as low as it goes
        lines = clearance.lines(poses)[:, clearance.moving]
        ends = np.minimum(lines[..., 2, 0], lines[..., 2, 0] + lines[..., 2, 1])
        lowest = min(lowest, (ends - clearance.capsules.radii[clearance.moving]).min())
    assert BASE_HEIGHT + lowest > 0.15


def test_arms_pass_through_each_other_as_links_of_one_body_do() -> None:
    """To keep them apart is the guard's work, and a world is driven without one here."""
    with World(EMPTY) as world:
        world.apply({"left_s0": -1.6, "right_s0": 1.6})
        for _ in range(60):
            state = world.step()
    np.testing.assert_allclose(state.joint_positions[[0, 7]], [-1.6, 1.6], atol=1e-3)


def test_only_news_are_told_to_the_motors(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[tuple[int, int]] = []
    tell = pybullet.setJointMotorControl2

    def listen(body: int, joint: int, mode: int, **settings: float) -> None:
        if mode == pybullet.POSITION_CONTROL:
            told.append((body, joint))
        tell(body, joint, mode, **settings)

    monkeypatch.setattr(pybullet, "setJointMotorControl2", listen)
    motion = rows("sweep exact")
    with World(EMPTY, command(motion[0])) as world:
        world.step()
        assert len(set(told)) == len(told) == 15
        told.clear()
        world.step()
        assert not told
        world.apply({"left_e1": motion[0][3] + 0.02})
        world.step()
        assert len(told) == 1
