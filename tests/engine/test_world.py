import math
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from studio.engine.errors import StudioError
from studio.engine.robot import JOINT_NAMES, load_robot
from studio.engine.scene import Scene
from studio.engine.skeleton import FloatArray
from studio.engine.world import World
from tests.engine.motions import EMPTY, MOTIONS, SETTLE, command, fingerprint, play, rows


@pytest.fixture
def world() -> Iterator[World]:
    with World() as world:
        yield world


# The motors


@pytest.mark.parametrize("motion", MOTIONS)
def test_joints_are_where_they_were_told_when_the_tick_ends(motion: str) -> None:
    told = rows(motion)
    states = play(EMPTY, told)[: len(told)]
    measured = np.array([state.joint_positions[:4] for state in states])
    assert np.sqrt(np.mean((measured - told) ** 2, axis=0)).max() < 2e-3


def extreme_poses() -> list[FloatArray]:
    """Return poses over all limits: at random, in the corners, and stretched out level."""
    limits, rng = load_robot().limits, np.random.default_rng(7)
    inside = rng.uniform(limits.lower, limits.upper, (8, 15))
    corners = np.where(rng.random((8, 15)) < 0.5, limits.lower, limits.upper)
    stretched = np.zeros((4, 15))
    stretched[:, [2, 9]] = rng.uniform(-3, 3, (4, 2))
    stretched[:, [1, 8]] = [[-0.4, 0.4], [0.0, 0.2], [-0.2, 0.8], [1.047, -2.147]]
    return [*inside, *corners, *stretched]


def test_every_pose_inside_the_limits_can_be_held() -> None:
    for pose in extreme_poses():
        with World(EMPTY, dict(zip(JOINT_NAMES, pose.tolist(), strict=True))) as world:
            states = [world.step() for _ in range(45)]
        error = np.abs(states[-1].joint_positions - pose)
        assert error.max() < math.radians(0.2)
        assert np.abs(states[-1].joint_velocities).max() < 0.01


def test_without_its_spring_a_stretched_arm_would_sag(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("studio.engine.world_robot.S1_SPRING", 0.0)
    with World(EMPTY) as world:
        for _ in range(60):
            state = world.step()
    assert state.joint_positions[JOINT_NAMES.index("left_s1")] > 0.2


def fastest(scene: Scene, jumps: int, seed: int) -> FloatArray:
    """Return the top speeds (14,) of the arms, in shares of the limits, while targets jump."""
    limits, rng = load_robot().limits, np.random.default_rng(seed)
    top = np.zeros(14)
    with World(scene) as world:
        for _ in range(jumps):
            targets = rng.uniform(limits.lower, limits.upper)
            world.apply(dict(zip(JOINT_NAMES, targets.tolist(), strict=True)))
            for _ in range(40):
                speeds = np.abs(world.step().joint_velocities) / limits.velocity
                top = np.maximum(top, speeds[:14])
    return top


@pytest.mark.parametrize("seed", range(4))
def test_joints_keep_their_top_speed_when_all_targets_jump(seed: int) -> None:
    top = fastest(EMPTY, jumps=4, seed=seed)
    assert top.max() <= 1.05
    assert top[:4].max() > 0.95  # or nothing was tried


def test_where_an_arm_hits_the_desk_speeds_stay_close_to_their_limits() -> None:
    assert max(fastest(Scene(), jumps=6, seed=seed).max() for seed in range(3)) <= 1.2


def test_a_target_that_jumps_is_reached_and_not_overshot() -> None:
    with World(EMPTY) as world:
        world.apply({"left_s0": 0.5, "right_e1": 0.5})
        states = [world.step() for _ in range(45)]
    for name in ("left_s0", "right_e1"):
        angles = [state.joint_positions[JOINT_NAMES.index(name)] for state in states]
        assert angles[-1] == pytest.approx(0.5, abs=1e-3)
        assert max(angles) < 0.51


def test_targets_hold_until_they_are_set_anew() -> None:
    with World(EMPTY) as world:
        world.apply({"left_e1": 0.2})
        world.apply({"head_pan": 0.3})
        for _ in range(45):
            state = world.step()
    assert state.joint_positions[JOINT_NAMES.index("left_e1")] == pytest.approx(0.2, abs=2e-3)
    assert state.joint_positions[JOINT_NAMES.index("head_pan")] == pytest.approx(0.3, abs=2e-3)


# The contract


def test_a_fresh_world_stands_where_it_was_told() -> None:
    start = {"left_s0": 0.3, "right_w2": -1.0, "head_pan": 0.1}
    with World(Scene(), start) as world:
        state = world.state
        assert world.step().time == pytest.approx(1 / 30)
        assert world.step().time == pytest.approx(2 / 30)
    assert state.time == 0.0
    expected = [start.get(name, 0.0) for name in JOINT_NAMES]
    np.testing.assert_array_equal(state.joint_positions, expected)
    assert state.block_poses.shape == (3, 7)
    assert state.tilt == 0.0
    assert not state.touched


@pytest.mark.parametrize(
    ("targets", "said"),
    [
        ({"left_s9": 0.0}, "left_s9"),
        ({"left_s1": math.nan}, "nan"),
        ({"left_s1": math.inf}, "inf"),
        ({"left_s1": 1.06}, r"1\.0470"),
        ({"right_e1": -0.06}, r"-0\.0500"),
    ],
)
def test_impossible_targets_are_refused_and_change_nothing(
    world: World, targets: dict[str, float], said: str
) -> None:
    with pytest.raises(StudioError, match=said):
        world.apply({"left_e1": 1.0, **targets})
    for _ in range(10):
        state = world.step()
    assert abs(state.joint_positions[JOINT_NAMES.index("left_e1")]) < 2e-3
    with pytest.raises(StudioError, match=said):
        World(Scene(), targets)


def test_another_thread_is_refused(world: World) -> None:
    said: list[str] = []

    def call() -> None:
        for attempt in (world.step, lambda: world.apply({}), world.close, lambda: world.state):
            try:
                attempt()
            except StudioError as error:
                said.append(str(error))

    thread = threading.Thread(target=call)
    thread.start()
    thread.join()
    assert len(said) == 4
    assert all("thread" in message for message in said)


def test_a_closed_world_says_so() -> None:
    world = World()
    world.close()
    world.close()
    with pytest.raises(StudioError, match="closed"):
        world.step()


def test_states_are_kept_as_they_were(world: World) -> None:
    first = world.step()
    kept = first.joint_positions.copy()
    world.apply({"left_s0": 0.5})
    world.step()
    np.testing.assert_array_equal(first.joint_positions, kept)
    with pytest.raises(ValueError, match="read-only"):
        first.block_poses[0, 0] = 1.0


def test_worlds_beside_each_other_do_not_mix() -> None:
    motion = rows("sweep exact")
    alone = play(Scene(), motion)
    with World(Scene(), command(motion[0])) as one, World(EMPTY) as other:
        states = []
        for row in motion:
            one.apply(command(row))
            other.apply({"left_s0": -row[0]})
            states.append(one.step())
            other.step()
        states += [one.step() for _ in range(SETTLE)]
    assert fingerprint(states) == fingerprint(alone)


SCRIPT = """
from tests.engine.motions import Scene, fingerprint, play, rows
print(fingerprint(play(Scene(), rows("sweep exact"))))
"""


def test_the_same_commands_lead_to_the_same_bits_in_any_process() -> None:
    here = fingerprint(play(Scene(), rows("sweep exact")))
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT],
        capture_output=True,
        text=True,
        check=True,
        cwd=Path(__file__).resolve().parents[2],
    )
    assert done.stdout == here + "\n"
