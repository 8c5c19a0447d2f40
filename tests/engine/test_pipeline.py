"""One frame's way through all stages: what is refused, what is bridged, where it starts."""

import numpy as np
import pytest

from studio.engine.pipeline import Pipeline, ready_angles
from studio.engine.retarget import MAPPINGS, arm_angles
from studio.engine.robot import load_robot
from studio.engine.skeleton import (
    SIDES,
    Hand,
    HandState,
    Joint,
    Side,
    Skeleton,
    Tracking,
    all_tracked,
)
from tests.engine.people import held, person

ARM = ((0.8, 0.5, 0.3), (0.7, 0.2, -0.7))
ARMING = held((HandState.LASSO, 12), (HandState.OPEN, 12), (HandState.CLOSED, 12))


def pipeline(side: Side = "left", mapping="exact", gate="sequence") -> Pipeline:
    return Pipeline.for_robot(load_robot(), side, mapping, gate)


def noisy(time: float, rng: np.random.Generator, arm=ARM, hand=HandState.UNKNOWN) -> Skeleton:
    still = person(time, arm, hand=hand)
    return Skeleton(
        time, still.positions + 1e-4 * rng.normal(size=(25, 3)), all_tracked(), Hand(hand)
    )


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("mapping", MAPPINGS)
def test_a_still_person_is_reached(side: Side, mapping) -> None:
    arm = [(v[0], v[1] if side == "left" else -v[1], v[2]) for v in ARM]
    line, memory = pipeline(side, mapping, "open"), pipeline(side, mapping, "open").start()
    for i in range(90):
        memory, outcome = line.advance(memory, person(i / 30, arm, side), i / 30)
    assert np.allclose(outcome.command.sent, arm_angles(*arm, side, mapping), atol=1e-9)
    assert not outcome.command.limited


def test_nothing_moves_before_the_gate_is_armed() -> None:
    line = pipeline()
    memory = line.start()
    for i, state in enumerate(ARMING):
        memory, outcome = line.advance(memory, person(i / 30, ARM, hand=state), i / 30)
        moved = not np.array_equal(outcome.command.sent, ready_angles("left", "exact"))
        assert moved == outcome.gate.armed
        assert (outcome.wanted is None) == (not outcome.gate.armed)
        assert bool(outcome.held) == (not outcome.gate.armed)
    assert outcome.gate.armed


def test_a_refused_arm_holds_the_robot_with_words() -> None:
    line = pipeline(gate="open")
    memory = line.start()
    for i in range(60):
        memory, _ = line.advance(memory, person(i / 30, ARM), i / 30)
    lost = all_tracked()
    lost[Joint.WRIST_LEFT] = Tracking.NOT_TRACKED
    away = person(2.0, ((0, 1, 0), (0, 1, 0)))
    memory, outcome = line.advance(memory, Skeleton(2.0, away.positions, lost), 2.0)
    assert outcome.held == "left wrist not tracked"
    assert np.allclose(outcome.command.sent, arm_angles(*ARM, "left"), atol=1e-6)


def test_duplicate_frames_change_nothing_but_the_wait() -> None:
    """A recorder that writes every frame twice gives the filters what one that does not gives."""
    rng = np.random.default_rng(7)
    frames = [noisy(i / 15, rng) for i in range(20)]
    line = pipeline(gate="open")
    once, twice = line.start(), line.start()
    for i, frame in enumerate(frames):
        again = Skeleton(frame.time + 1 / 30, frame.positions, frame.tracking)
        once, _ = line.advance(once, frame, i / 15)
        twice, first = line.advance(twice, frame, i / 15)
        twice, second = line.advance(twice, again, i / 15 + 1 / 30)
        once, _ = line.advance(once, None, i / 15 + 1 / 30)
        assert once.wanted == twice.wanted
        assert first.wanted == second.wanted


@pytest.mark.parametrize("mapping", MAPPINGS)
def test_the_ready_pose_mirrors_and_lies_inside_the_limits(mapping) -> None:
    left, right = ready_angles("left", mapping), ready_angles("right", mapping)
    assert np.allclose(left, np.array([-1, 1, -1, 1]) * right, atol=1e-12)
    limits = load_robot().limits_of([f"left_{joint}" for joint in ("s0", "s1", "e0", "e1")])
    assert ((limits.lower < left) & (left < limits.upper)).all()
    reference = (0.081, -0.521, -0.419, 1.391) if mapping == "exact" else (0.0, -0.349, 0.0, 1.231)
    assert np.allclose(left, reference, atol=2e-3)
