"""Made-up people for the tests: skeletons whose left and right arms point where one says."""

from collections.abc import Sequence
from itertools import groupby

import numpy as np

from studio.engine.skeleton import Hand, HandState, Joint, Side, Skeleton, all_tracked
from studio.engine.sources.recording import SkeletonRecording, from_skeletons


def person(
    time: float = 0.0,
    arm: tuple[Sequence[float], Sequence[float]] = ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    side: Side = "left",
    hand: HandState = HandState.UNKNOWN,
    yaw: float = 0.0,
    body_id: str = "0",
) -> Skeleton:
    """Return someone 2 m away whose arm's two bones point along ``arm``, in the torso's frame."""
    torso = np.zeros((25, 3))  # x forward, y left, z up
    torso[Joint.SPINE_SHOULDER] = (0.0, 0.0, 0.5)
    for name, y in (("left", 1.0), ("right", -1.0)):
        torso[Joint.of("shoulder", name)] = (0.0, 0.18 * y, 0.45)
        torso[Joint.of("hip", name)] = (0.0, 0.1 * y, 0.0)
        torso[Joint.of("elbow", name)] = (0.0, 0.2 * y, 0.2)
        torso[Joint.of("wrist", name)] = (0.1, 0.2 * y, 0.0)
    shoulder = torso[Joint.of("shoulder", side)]
    upper_arm, forearm = (np.asarray(v) / np.linalg.norm(v) for v in arm)
    torso[Joint.of("elbow", side)] = shoulder + 0.28 * upper_arm
    torso[Joint.of("wrist", side)] = shoulder + 0.28 * upper_arm + 0.25 * forearm
    turn = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    forward, left, up = (torso @ turn.T).T
    camera = np.column_stack([-left, up, 2.0 - forward])
    return Skeleton(time, camera, all_tracked(), Hand(hand), Hand(), body_id)


def hand_stream(states: Sequence[HandState], rate: float = 30.0) -> SkeletonRecording:
    """Return a person whose left hand shows one state after another."""
    people = [person(i / rate, hand=state) for i, state in enumerate(states)]
    return from_skeletons(people, path="made up", format="test")


def held(*runs: tuple[HandState, int]) -> list[HandState]:
    """Return states held for so many frames each."""
    return [state for state, frames in runs for _ in range(frames)]


def runs_of(states: Sequence[HandState]) -> list[tuple[HandState, int]]:
    """Return the unbroken runs in a sequence of states; undoes `held`."""
    return [(state, len(list(group))) for state, group in groupby(states)]
