import hashlib
import math
import subprocess
import sys
import threading
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from studio.engine.errors import StudioError
from studio.engine.robot import JOINT_NAMES, load_robot
from studio.engine.scene import Block, Desk, Scene
from studio.engine.skeleton import SIDES, FloatArray, Side
from studio.engine.world import World, WorldState

DRIVEN = ("s0", "s1", "e0", "e1")
SETTLE = 45  # ticks after a motion

# Ways to push the block down: stamps [s] and s0, s1, e0, e1 [rad] of the left arm. The first bends
# the elbow; the other two turn the shoulder alone, as the exact and the paper's mapping have it.
BEND = (
    (0.0, 1.0, 2.8, 3.2, 5.4, 5.9),
    (
        (0.234, 0.999, -2.212, 1.177),
        (0.270, 0.964, -1.966, 1.036),
        (0.140, 0.787, -1.201, 1.611),
        (0.140, 0.787, -1.201, 1.611),
        (0.234, 0.999, -2.212, 1.177),
        (0.234, 0.999, -2.212, 1.177),
    ),
)


def sweep(start: tuple[float, ...], s0: float) -> tuple[tuple[float, ...], tuple[object, ...]]:
    there = (s0, *start[1:])
    return (0.0, 0.6, 2.8, 3.2, 5.4, 5.8), (start, start, there, there, start, start)


MOTIONS = {
    "bend": BEND,
    "sweep exact": sweep((0.081, -0.521, -0.419, 1.391), -1.054),
    "sweep paper": sweep((0.0, -0.349, 0.0, 1.231), -1.134),
}
# A scene in which nothing is in the way.
EMPTY = Scene(
    desk=Desk((0.1, 0.1, 0.1), (9.0, 9.0, 0.05), 0.5),
    blocks=(Block((0.1, 0.1, 0.1), (7.0, 7.0, 0.05), 0.4, 0.5),),
)


def rows(name: str, side: Side = "left") -> FloatArray:
    """Return a motion (T, 4) [rad] at 30 Hz: minimum-jerk pieces from stamp to stamp."""
    stamps, angles = (np.array(part) for part in MOTIONS[name])
    times = np.arange(round(stamps[-1] * 30) + 1) / 30
    piece = np.clip(np.searchsorted(stamps, times, side="right") - 1, 0, len(stamps) - 2)
    share = ((times - stamps[piece]) / np.diff(stamps)[piece])[:, None]
    smooth = share**3 * (10 - 15 * share + 6 * share**2)
    motion = angles[piece] + (angles[piece + 1] - angles[piece]) * smooth
    return motion if side == "left" else motion * [-1, 1, -1, 1]


def command(row: FloatArray, side: Side = "left") -> dict[str, float]:
    return dict(zip((f"{side}_{joint}" for joint in DRIVEN), row.tolist(), strict=True))


def play(scene: Scene, motion: FloatArray, side: Side = "left") -> list[WorldState]:
    """Return the states after each command, and after a time to settle."""
    with World(scene, command(motion[0], side)) as world:
        states = []
        for row in motion:
            world.apply(command(row, side))
            states.append(world.step())
        return states + [world.step() for _ in range(SETTLE)]


def moved(scene: Scene, x: float, y: float) -> Scene:
    block = scene.blocks[0]
    at = (block.position[0] + x, block.position[1] + y, block.position[2])
    return replace(scene, blocks=(replace(block, position=at), *scene.blocks[1:]))


def fingerprint(states: list[WorldState]) -> str:
    numbers = [
        np.concatenate([s.joint_positions, s.joint_velocities, s.block_poses.ravel()])
        for s in states
    ]
    return hashlib.sha256(np.array(numbers).tobytes()).hexdigest()


@pytest.fixture
def world() -> Iterator[World]:
    with World() as world:
        yield world


# The task


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("motion", MOTIONS)
def test_the_block_can_be_pushed_down_and_the_others_stay(motion: str, side: Side) -> None:
    states = play(Scene(arm=side), rows(motion, side), side)
    assert states[-1].block_down
    assert not states[0].touched
    others = states[-1].block_poses[1:, :3] - states[0].block_poses[1:, :3]
    assert np.abs(others).max() < 5e-4


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize(("x", "y"), [(0.02, 0.02), (0.02, -0.02), (-0.02, 0.02), (-0.02, -0.02)])
def test_the_block_may_stand_two_centimeters_off(motion: str, x: float, y: float) -> None:
    assert play(moved(Scene(), x, y), rows(motion))[-1].block_down


@pytest.mark.parametrize("motion", MOTIONS)
def test_an_arm_that_stays_where_it_is_leaves_the_block_standing(motion: str) -> None:
    states = play(Scene(), np.repeat(rows(motion)[:1], 150, axis=0))
    assert not any(state.touched or state.block_down for state in states)
    assert states[-1].tilt < math.radians(0.05)


def test_idle_blocks_stand_still(world: World) -> None:
    for _ in range(150):
        state = world.step()
    places = np.array([block.position for block in world.scene.placed_blocks])
    np.testing.assert_allclose(state.block_poses[:, :3], places, atol=3e-4)
    assert np.abs(state.block_poses[:, 3:6]).max() < 1e-3


@pytest.mark.parametrize(("taught", "counts"), [("right", True), ("left", False)])
def test_a_push_by_the_arm_that_is_not_taught_does_not_count(taught: Side, counts: bool) -> None:
    scene = Scene(arm="right")
    if taught == "left":  # told mirrored, so that everything stands in the same places
        scene = Scene(desk=scene.placed_desk, blocks=scene.placed_blocks, arm="left")
    last = play(scene, rows("sweep exact", "right"), "right")[-1]
    assert last.tilt > math.radians(60)
    assert last.touched == counts
    assert last.block_down == counts


def test_a_block_that_falls_by_itself_does_not_count() -> None:
    high = Block((0.06, 0.06, 0.3), (1.04, 0.2, 0.88), 0.4, 0.6)
    with World(Scene(blocks=(high,))) as world:
        states = [world.step() for _ in range(60)]
    assert states[-1].tilt < math.radians(5)
    edge = replace(high, position=(1.09, 0.2, 0.88))  # its middle is beyond the desk's edge
    with World(Scene(blocks=(edge,))) as world:
        states = [world.step() for _ in range(120)]
    assert max(state.tilt for state in states) > math.radians(60)
    assert not any(state.touched or state.block_down for state in states)


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
    monkeypatch.setattr("studio.engine.world.S1_SPRING", 0.0)
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
import sys
sys.path.insert(0, {folder!r})
from test_world import Scene, fingerprint, play, rows
print(fingerprint(play(Scene(), rows("sweep exact"))))
"""


def test_the_same_commands_lead_to_the_same_bits_in_any_process() -> None:
    here = fingerprint(play(Scene(), rows("sweep exact")))
    script = SCRIPT.format(folder=str(Path(__file__).parent))
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert done.stdout == here + "\n"
