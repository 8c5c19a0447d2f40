"""Made-up people for the tests: skeletons whose left and right arms point where one says."""

import math
from collections.abc import Sequence
from itertools import groupby

import numpy as np

from studio.engine.skeleton import SIDES, Hand, HandState, Joint, Side, Skeleton, all_tracked
from studio.engine.sources.recording import SkeletonRecording, from_skeletons

DOWN = (0.0, 0.0, -1.0)


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


def hanging(time: float, lean: float = 0.0, yaw: float = 0.3, swing: float = 0.0) -> Skeleton:
    """Return somebody whose arms hang, and whose spine line leans forward by ``lean`` [rad]."""
    body = person(time, (DOWN, DOWN), yaw=yaw)
    positions = body.positions.copy()
    forward = np.array([-math.sin(yaw), 0.0, -math.cos(yaw)])  # in camera space
    up = np.array([0.0, 1.0, 0.0])
    spine = math.cos(lean) * up + math.sin(lean) * forward
    positions[Joint.SPINE_BASE] = positions[Joint.SPINE_SHOULDER] - 0.5 * spine
    bone = -math.cos(swing) * up + math.sin(swing) * forward
    for side in SIDES:
        shoulder = positions[Joint.of("shoulder", side)]
        positions[Joint.of("elbow", side)] = shoulder + 0.28 * bone
        positions[Joint.of("wrist", side)] = shoulder + 0.53 * bone
    return Skeleton(time, positions, all_tracked())


def stand(lean: float = 0.0, frames: int = 60, **other: float) -> list[Skeleton]:
    """Return the same for a while."""
    return [hanging(i / 30, lean, **other) for i in range(frames)]


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
