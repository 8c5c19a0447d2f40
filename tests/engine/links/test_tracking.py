"""Who follows, however late or compliant, never goes astray; who goes elsewhere is known soon."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.links.tracking import ASIDE, BEHIND_FOR, Tracking
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE

TOP = np.array([1.0, 2.0])  # [rad/s]
JOINTS = ("left_s0", "left_e1")


def walk(seed: int, ticks: int = 300) -> np.ndarray:
    """Commands (ticks, 2) [rad] no faster than TOP."""
    random = np.random.default_rng(seed)
    speed = np.repeat(random.uniform(-1, 1, (ticks // 10, 2)), 10, axis=0) * TOP
    return np.cumsum(speed * CONTROL_PERIOD, axis=0)


def trouble(sent: np.ndarray, measured: np.ndarray) -> tuple[int, str]:
    """When it is found to go astray, and in which words; at the end, none."""
    memory = Tracking.begin(sent[0])
    for tick, (told, found) in enumerate(zip(sent, measured, strict=True)):
        memory, words = memory.step(JOINTS, told, found, TOP)
        if words:
            return tick, words
    return len(sent), ""


@settings(deadline=None, derandomize=True, max_examples=50)
@given(
    st.integers(0, 2**32 - 1),
    st.integers(0, round(BEHIND_FOR * CONTROL_RATE)),
    st.floats(-0.1, 0.1),
)
def test_a_follower_is_never_astray(seed: int, delay: int, sag: float) -> None:
    sent = walk(seed)
    measured = np.vstack([np.repeat(sent[:1], delay, axis=0), sent])[: len(sent)] + sag
    assert trouble(sent, measured) == (len(sent), "")


@settings(deadline=None, derandomize=True, max_examples=50)
@given(st.floats(0.05, 1.0), st.sampled_from([0, 1]), st.sampled_from([-1.0, 1.0]))
def test_a_wrong_sign_is_found_before_it_is_far(share: float, joint: int, way: float) -> None:
    sent = np.zeros((600, 2))
    sent[:, joint] = way * share * TOP[joint] * CONTROL_PERIOD * np.arange(600)
    tick, words = trouble(sent, -sent)
    assert f"{JOINTS[joint]} went elsewhere" in words
    assert abs(sent[tick, joint]) < ASIDE + 2 * TOP[joint] * CONTROL_PERIOD


def test_nobody_moves_and_nothing_is_wrong() -> None:
    sent = np.zeros((10, 2))
    assert trouble(sent, sent) == (10, "")


def test_who_is_stuck_is_found() -> None:
    sent = np.outer(np.arange(60) * CONTROL_PERIOD, TOP)
    tick, words = trouble(sent, np.zeros_like(sent))
    assert "does not come along" in words
    assert tick * CONTROL_PERIOD < BEHIND_FOR + 0.3
