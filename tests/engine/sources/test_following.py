"""One person is followed: who, who takes over and when, and that a short absence is bridged."""

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.gate import Gate
from studio.engine.skeleton import Hand, HandState, Joint, Skeleton, all_tracked
from studio.engine.sources.family import Frame
from studio.engine.sources.following import PATIENCE, choose_body


def body(name: str, x: float = 0.0, z: float = 2.0, hand: HandState = HandState.OPEN) -> Skeleton:
    positions = np.zeros((25, 3))
    positions[Joint.SPINE_MID] = x, 5.0, z  # the height must not count
    return Skeleton(0.0, positions, all_tracked(), Hand(hand), body_id=name)


def followed(scene: Sequence[Sequence[Skeleton]], rate: float = 30.0, **chosen: str) -> list[str]:
    """Return the id followed in each frame, "" where nobody is."""
    memory, names = None, []
    for index, bodies in enumerate(scene):
        memory, skeleton = choose_body(memory, Frame(index / rate, tuple(bodies)), **chosen)
        names.append("" if skeleton is None else skeleton.body_id)
    return names


def test_the_nearest_in_the_floor_plane_is_taken_and_kept_while_seen():
    far, near = body("far", 0.1, 3.0), body("near", 0.0, 2.0)
    aside = body("aside", 1.9, 1.9)  # nearer by z, farther in the floor plane
    closer = body("closer", 0.0, 1.0)
    assert followed([[far, near, aside], [closer, far, near]]) == ["near", "near"]


@pytest.mark.parametrize("rate", [15, 30, 60])
def test_who_goes_missing_is_waited_for_and_then_the_next_takes_over(rate):
    a, b = body("a"), body("b", z=3.0)
    missing = int(PATIENCE * rate)
    scene = [[a, b], *[[b]] * missing, [a, b], *[[b]] * (missing + 2)]
    expected = ["a", *[""] * missing, "a", *[""] * missing, "b"]
    assert followed(scene, rate)[: len(expected)] == expected


def test_a_wait_also_passes_while_nobody_is_in_sight():
    a, b = body("a"), body("b")
    assert followed([[a], *[[]] * 20, [b]]) == ["a", *[""] * 20, "b"]
    assert followed([[a], *[[]] * 5, [b]]) == ["a", *[""] * 6]


def test_the_one_asked_for_is_waited_for_for_ever():
    a, b = body("a"), body("b")
    assert followed([[a], [a, b], *[[a]] * 60], only="b") == ["", "b", *[""] * 60]


def test_who_takes_over_finds_the_gate_closed():
    """The gate lets go of a body no later than somebody else is taken."""
    assert Gate().body_lost_after <= PATIENCE
    signs = [HandState.LASSO] * 12 + [HandState.OPEN] * 12 + [HandState.CLOSED] * 12
    other = body("b", 0.0, 3.0, HandState.CLOSED)
    scene = [[body("a", hand=sign), other] for sign in signs] + [[other]] * 40
    gate, gate_memory, memory, seen = Gate(), None, None, []
    for index, bodies in enumerate(scene):
        memory, skeleton = choose_body(memory, Frame(index / 30, tuple(bodies)))
        gate_memory, status = gate.step(gate_memory, skeleton, index / 30)
        seen.append((status.armed, None if skeleton is None else skeleton.body_id))
    assert (True, "a") in seen
    assert (True, None) in seen  # still armed while waiting
    assert (False, "b") in seen
    assert (True, "b") not in seen


@settings(deadline=None, derandomize=True)
@given(st.lists(st.dictionaries(st.sampled_from("abc"), st.floats(0.5, 9.0), max_size=3)))
def test_following_is_greedy_patient_and_complete(scene):
    names = followed([[body(name, 0.0, z) for name, z in each.items()] for each in scene], 5.0)
    last, since = "", 0
    for index, (present, name) in enumerate(zip(scene, names, strict=True)):
        if last in present:
            assert name == last
        elif last and index - since <= 2:  # 0.4 s of 5 Hz frames
            assert name == ""
        elif present:
            assert present[name] == min(present.values())
        if name:
            last, since = name, index
