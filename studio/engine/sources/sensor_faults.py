"""A Kinect's faults at the size they have in real recordings, laid over a clean motion.

Noise grows with speed, has heavy tails and is correlated from frame to frame; wrists spike and are
inferred in short runs; frames are lost, stall and burst; hand states change at 15 Hz at most, drop
out, and Lasso flickers with Closed.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from studio.engine.skeleton import (
    FRAME_RATE,
    JOINT_COUNT,
    FloatArray,
    Hand,
    HandState,
    Joint,
    Skeleton,
    Tracking,
)

# Root mean square of the noise of an axis [m] at 0.05 m/s and below, at 0.25, at 0.5 and above.
_SPEEDS = np.array([0.05, 0.25, 0.5])  # [m/s]
_NOISE = {
    "shoulder": (0.0003, 0.0015, 0.003),
    "elbow": (0.0008, 0.003, 0.007),
    "wrist": (0.0007, 0.004, 0.008),
    "hand": (0.0014, 0.003, 0.0055),
}
_CORRELATION = 0.45  # lag 1; gives the -0.17 to -0.36 measured in differences of forearm length
_TAILS = 3.0  # degrees of freedom of Student's t: robust σ well below the root mean square
_WRIST_SPIKES = 8.0 / 60.0  # [1/s] of more than 5 cm, an arm
_INFERRED = {"elbow": 0.02, "wrist": 0.07, "hand": 0.13}  # share of frames
_INFERRED_RUNS = (1, 1, 2, 2, 3, 8)  # frames, each as likely as the others
_LOST_FRAMES = 0.015
_STALLS = 1.0 / 60.0  # [1/s] of 167 ms, with a burst of 1 ms behind
_HAND_GAPS = 0.35  # [1/s] of Unknown or NotTracked while a sign is held
_GAP_LENGTHS = (2, 2, 2, 2, 4, 6, 8, 12)  # frames: median 2, three quarters below 8
_DIGITS = 6  # of a meter: a Kinect tells single precision
_LASSO_FLICKER = 0.4  # [1/s] of two frames of Closed


def sense(
    positions: FloatArray,
    left_hand: Sequence[HandState],
    rng: np.random.Generator,
    right_hand: Sequence[HandState] | None = None,
) -> tuple[Skeleton, ...]:
    """Return clean positions (T, 25, 3) [m] at 30 Hz and hand states as a sensor shows them.

    A right hand of which nothing is said is open, and seen so.
    """
    noisy = positions + _noise(positions, rng)
    for side in ("left", "right"):
        _spike(noisy, Joint[f"WRIST_{side.upper()}"], rng)
    noisy = noisy.round(_DIGITS)
    tracking = _tracking(len(positions), rng)
    hands = _hand_states(left_hand, rng)
    times, kept = _stamps(len(positions), rng)
    others = [HandState.OPEN] * len(positions)
    if right_hand is not None:
        others = _hand_states(right_hand, rng)
    return tuple(
        Skeleton(float(times[i]), noisy[i], tracking[i], Hand(hands[i]), Hand(others[i]), "1")
        for i in kept
    )


def _noise(positions: FloatArray, rng: np.random.Generator) -> FloatArray:
    speed = np.linalg.norm(np.gradient(positions, 1.0 / FRAME_RATE, axis=0), axis=-1)  # (T, 25)
    size = np.empty_like(speed)
    for joint in Joint:
        kind = next((k for k in _NOISE if joint.name.lower().startswith(k)), "shoulder")
        size[:, joint] = np.interp(speed[:, joint], _SPEEDS, _NOISE[kind])
    white = rng.standard_t(_TAILS, positions.shape) / np.sqrt(_TAILS / (_TAILS - 2.0))
    noise = np.empty_like(positions)
    noise[0] = white[0]
    innovation = np.sqrt(1.0 - _CORRELATION**2)
    for i in range(1, len(positions)):
        noise[i] = _CORRELATION * noise[i - 1] + innovation * white[i]
    sized: FloatArray = noise * size[..., None]
    return sized


def _spike(positions: FloatArray, joint: Joint, rng: np.random.Generator) -> None:
    """Throw one joint off by 5 to 12 cm for a frame, now and then."""
    for i in np.flatnonzero(rng.random(len(positions)) < _WRIST_SPIKES / FRAME_RATE):
        direction = rng.normal(size=3)
        positions[i, joint] += rng.uniform(0.05, 0.12) * direction / np.linalg.norm(direction)


def _tracking(count: int, rng: np.random.Generator) -> NDArray[np.int8]:
    tracking = np.full((count, JOINT_COUNT), Tracking.TRACKED, dtype=np.int8)
    mean_run = float(np.mean(_INFERRED_RUNS))
    for joint in Joint:
        share = _INFERRED.get(joint.name.lower().split("_")[0], 0.0)
        for start in np.flatnonzero(rng.random(count) < share / mean_run):
            tracking[start : start + rng.choice(_INFERRED_RUNS), joint] = Tracking.INFERRED
    return tracking


def _hand_states(signed: Sequence[HandState], rng: np.random.Generator) -> list[HandState]:
    """Return what the sensor reports of the signs: at 15 Hz, with gaps and flicker."""
    states = [signed[i - i % 2] for i in range(len(signed))]
    for i in range(0, len(states), 2):
        flickers = signed[i] is HandState.LASSO and rng.random() < 2.0 * _LASSO_FLICKER / FRAME_RATE
        if flickers:
            states[i : i + 2] = [HandState.CLOSED] * len(states[i : i + 2])
        if rng.random() < 2.0 * _HAND_GAPS / FRAME_RATE:
            unseen = HandState.UNKNOWN if rng.random() < 0.8 else HandState.NOT_TRACKED
            end = min(i + int(rng.choice(_GAP_LENGTHS)), len(states))
            states[i:end] = [unseen] * (end - i)
    return states


def _stamps(count: int, rng: np.random.Generator) -> tuple[FloatArray, list[int]]:
    """Return stamps [s] for all frames and the indices of those that arrive."""
    times = np.arange(count) / FRAME_RATE
    kept = [i for i in range(count) if i == 0 or rng.random() >= _LOST_FRAMES]
    for i in np.flatnonzero(rng.random(count - 6) < _STALLS / FRAME_RATE):
        # Frames i + 1 to i + 3 never come; i + 4 comes late, and i + 5 is right behind it.
        kept = [k for k in kept if not i + 1 <= k <= i + 3]
        times[i + 4] = times[i] + 0.167
        times[i + 5] = times[i + 4] + 0.001
    return times, kept
