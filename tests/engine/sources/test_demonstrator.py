"""The demonstrator: the same by seed, different by take, with a real sensor's faults in size."""

import numpy as np
import pytest

from studio.engine.follow import follow, newest_frames
from studio.engine.pipeline import Pipeline
from studio.engine.robot import CONTROL_PERIOD, load_robot
from studio.engine.skeleton import HandState, Joint, Tracking
from studio.engine.sources.demonstrator import FULL_SEQUENCE, demonstrate
from tests.engine.people import runs_of


@pytest.fixture(scope="module")
def takes():
    return [demonstrate(seed=3, take=take) for take in range(1, 13)]


def test_a_seed_gives_the_same_bytes() -> None:
    first, second = demonstrate(5, 2), demonstrate(5, 2)
    assert len(first) == len(second)
    for a, b in zip(first, second, strict=True):
        assert a.positions.tobytes() == b.positions.tobytes()
        assert (a.time, a.left_hand, a.tracking.tobytes()) == (
            b.time,
            b.left_hand,
            b.tracking.tobytes(),
        )


def test_every_take_differs_in_timing_and_height(takes) -> None:
    lengths = [take[-1].time for take in takes]
    assert np.std(lengths) > 0.1
    highest = [max(s.positions[Joint.WRIST_LEFT, 1] for s in take) for take in takes]
    assert np.std(highest) > 0.005


@pytest.mark.parametrize(
    "signs",
    [
        (HandState.OPEN, HandState.CLOSED),
        (HandState.LASSO, HandState.CLOSED),
        (HandState.CLOSED, HandState.OPEN, HandState.LASSO),
        (),
    ],
)
def test_other_signs_never_arm(signs) -> None:
    recording = follow(demonstrate(1, 1, signs), Pipeline.for_robot(load_robot(), "left"))
    assert not any(sample.gate.armed for sample in recording.samples)


def test_it_arms_once_in_every_take_and_disarms_itself(takes) -> None:
    pipeline = Pipeline.for_robot(load_robot(), "left")
    for take in takes:
        armed, memory = [], pipeline.start()
        for tick, skeleton in enumerate(newest_frames(take)):
            memory, gate = pipeline.observe(memory, skeleton, tick * CONTROL_PERIOD)
            armed.append(gate.armed)
        changes = np.flatnonzero(np.diff(np.array(armed, dtype=int)))
        assert len(changes) == 2
        assert not armed[-1]


def residual(takes, joint: Joint, fast: bool) -> np.ndarray:
    """Return what is left of a joint [m] when its slow motion is taken away, by its speed."""
    found = []
    for take in takes:
        path = np.array([s.positions[joint] for s in take])
        smooth = np.apply_along_axis(lambda x: np.convolve(x, np.ones(5) / 5, "same"), 0, path)
        speed = np.linalg.norm(np.gradient(smooth, 1 / 30, axis=0), axis=1)[10:-10]
        chosen = speed > 0.4 if fast else speed < 0.05
        found.append((path - smooth)[10:-10][chosen].ravel())
    return np.concatenate(found)


@pytest.mark.parametrize(
    ("joint", "still", "moving"),
    [(Joint.WRIST_LEFT, 0.7e-3, 8e-3), (Joint.ELBOW_LEFT, 0.8e-3, 7e-3)],
)
def test_noise_has_the_measured_size_and_heavy_tails(takes, joint, still, moving) -> None:
    quiet, busy = residual(takes, joint, fast=False), residual(takes, joint, fast=True)
    robust = 1.4826 * np.median(np.abs(quiet))
    assert 0.2 * still < robust < still
    assert np.std(busy) > 3.0 * robust
    assert 0.3 * moving < np.std(busy) < 1.5 * moving
    assert np.mean(quiet**4) / np.mean(quiet**2) ** 2 > 4.0  # a normal distribution has 3


def test_frames_are_lost_and_states_change_in_pairs(takes) -> None:
    gaps = np.concatenate([np.diff([s.time for s in take]) for take in takes])
    assert np.median(gaps) == pytest.approx(1 / 30, abs=1e-3)
    assert 0.003 < np.mean(gaps > 0.05) < 0.04
    assert (gaps > 0).all()
    inferred = np.mean(
        [s.tracking[Joint.WRIST_LEFT] == Tracking.INFERRED for t in takes for s in t]
    )
    assert 0.03 < inferred < 0.12
    unseen = [runs_of([s.left_hand.state for s in take]) for take in takes]
    lengths = [n for runs in unseen for state, n in runs if state not in (*FULL_SEQUENCE,)]
    assert len(lengths) > 10
    assert np.median(lengths) <= 4
