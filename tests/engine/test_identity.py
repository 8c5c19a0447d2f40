"""Whoever is suddenly elsewhere is somebody else, and finds the gate closed."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.gate import Gate
from studio.engine.identity import FASTEST, SHORTEST, is_another
from studio.engine.pipeline import Pipeline
from studio.engine.robot import load_robot
from studio.engine.skeleton import HandState, Joint, Skeleton, Tracking
from studio.engine.sources.demonstrator import demonstrate
from tests.engine.people import held, person

SIGNS = held((HandState.LASSO, 15), (HandState.OPEN, 15), (HandState.CLOSED, 60))
JUMP = 60  # the frame in which somebody else is there


def moved(seen: Skeleton, by: tuple[float, float, float]) -> Skeleton:
    return replace(seen, positions=seen.positions + np.array(by))


def people(by: tuple[float, float, float]) -> list[Skeleton]:
    """Return somebody who arms the gate, and from frame `JUMP` on stands elsewhere."""
    frames = [person(i / 30, hand=sign) for i, sign in enumerate(SIGNS)]
    return frames[:JUMP] + [moved(each, by) for each in frames[JUMP:]]


@settings(deadline=None, derandomize=True)
@given(
    seconds=st.floats(0.0, 2.0),
    way=st.floats(0.0, 8.0),
    angle=st.floats(0.0, 6.3),
)
def test_how_far_one_gets_decides(seconds: float, way: float, angle: float) -> None:
    after = moved(person(seconds), (way * np.cos(angle), 0.0, way * np.sin(angle)))
    allowed = FASTEST * max(seconds, SHORTEST)
    if abs(way - allowed) > 1e-6:
        assert is_another(person(), after) == (way > allowed)


def test_half_a_meter_within_a_fifth_of_a_second() -> None:
    assert pytest.approx(0.5) == FASTEST * SHORTEST
    assert is_another(person(), person(0.03, body_id="1"))


def test_what_is_not_tracked_does_not_decide_and_another_part_of_the_trunk_does() -> None:
    unseen = person().tracking.copy()
    unseen[Joint.SPINE_BASE] = Tracking.NOT_TRACKED
    lost = person(1 / 30).positions.copy()
    lost[Joint.SPINE_BASE] = 0.0
    assert not is_another(person(), Skeleton(1 / 30, lost, unseen))
    assert is_another(person(), Skeleton(1 / 30, lost + 1.0, unseen))
    nothing = np.zeros_like(unseen)
    assert not is_another(person(), Skeleton(1 / 30, lost + 1.0, nothing))


def test_the_demonstrator_is_one_person() -> None:
    for seed in range(4):
        take = demonstrate(seed, 1)
        assert not any(is_another(a, b) for a, b in itertools.pairwise(take))


@pytest.mark.parametrize("by", [(1.5, 0.0, 1.0), (0.6, 0.0, 0.0), (0.0, 0.0, -0.6)])
def test_who_appears_elsewhere_under_the_same_id_finds_the_gate_closed(by) -> None:
    gate, memory, armed = Gate(), None, []
    pipeline = Pipeline.for_robot(load_robot(), "left")
    whole, sent = pipeline.start(), []
    for frame, seen in enumerate(people(by)):
        memory, status = gate.step(memory, seen, frame / 30)
        whole, outcome = pipeline.advance(whole, seen, frame / 30)
        armed.append(status.armed)
        assert outcome.gate.armed == status.armed
        sent.append(outcome.command.sent)
    assert armed[JUMP - 1]
    assert not any(armed[JUMP:])
    assert np.ptp(sent[JUMP:], axis=0).max() == 0.0  # the robot stays


def test_a_step_aside_is_no_other_person() -> None:
    gate, memory = Gate(), None
    for frame, seen in enumerate(people((0.4, 0.0, 0.0))):
        memory, status = gate.step(memory, seen, frame / 30)
    assert status.armed


def test_the_pipeline_forgets_the_arms_of_who_is_gone() -> None:
    """With the gate held open the robot comes to the other one as softly as at first."""
    pipeline = Pipeline.for_robot(load_robot(), "left", gate_mode="open")
    memory = pipeline.start()
    for frame in range(300):
        memory, _ = pipeline.advance(memory, person(frame / 30), frame / 30)
    assert memory.engaged[0].released
    memory, outcome = pipeline.advance(memory, moved(person(10.0), (1.0, 0.0, 0.0)), 10.0)
    assert not outcome.gate.armed
    assert memory.engaged == (None,)
    memory, _ = pipeline.advance(memory, moved(person(301 / 30), (1.0, 0.0, 0.0)), 301 / 30)
    assert memory.engaged[0].since == pytest.approx(301 / 30)
    assert not memory.engaged[0].released
