"""Somebody at the page, by script: what is dragged and signed, and what Baxter makes of it."""

from collections.abc import Iterator

import numpy as np

from studio.engine.follow import follow_steps
from studio.engine.performance import start_world
from studio.engine.pipeline import Pipeline
from studio.engine.puppet import PuppetTeacher
from studio.engine.recording import Recording, RecordingInfo
from studio.engine.retarget import Mapping
from studio.engine.robot import load_robot
from studio.engine.skeleton import FloatArray, HandState, Joint, Side, Skeleton
from studio.engine.standing import DISTANCE, SENSOR_TO_HIP, TRUNK

SEQUENCE = (HandState.LASSO, HandState.OPEN, HandState.CLOSED)
Frames = Iterator[Skeleton | None]


def from_shoulder(side: Side, forward: float, outward: float, up: float) -> FloatArray:
    """Return a point in camera space that is so far from a shoulder [m]."""
    x, y, z = TRUNK[Joint.of("shoulder", side)]
    sign = 1.0 if side == "left" else -1.0
    return np.array([-(y + sign * outward), SENSOR_TO_HIP + z + up, DISTANCE - (x + forward)])


def wait(frames: Frames, seconds: float) -> Frames:
    for _ in range(round(seconds * 30)):
        yield next(frames)


def signed(puppet: PuppetTeacher, frames: Frames) -> Frames:
    for sign in SEQUENCE:
        puppet.sign("left", sign)
        yield from wait(frames, 0.5)
    yield from wait(frames, 3.0)  # in which the robot comes to the person


def pushed(
    puppet: PuppetTeacher, frames: Frames, side: Side, height: float, seconds: float = 2.0
) -> Frames:
    """Drag a hand inward and back, in an arc about the shoulder, as a mouse would."""
    steps = round(seconds * 30)
    for begin, end in ((0.5, -0.5), (-0.5, 0.5)):
        for k in range(1, steps + 1):
            angle = begin + (end - begin) * k / steps
            at = (0.44 * np.cos(angle), 0.44 * np.sin(angle), height)
            puppet.drag_hand(side, from_shoulder(side, *at))
            yield next(frames)
        yield from wait(frames, 0.4)


def taught(
    side: Side = "left",
    mapping: Mapping = "exact",
    height: float = -0.2,
    elbow: tuple[float, float, float] | None = None,
    seconds: float = 2.0,
) -> Recording:
    """Return what is recorded of a puppet that signs, pushes the block, and signs off."""
    puppet = PuppetTeacher()
    pipeline = Pipeline.for_robot(load_robot(), side, mapping)

    def script(frames: Frames) -> Frames:
        puppet.drag_hand(side, from_shoulder(side, 0.39, 0.21, height))
        if elbow is not None:
            puppet.drag_elbow(side, from_shoulder(side, *elbow))
        yield from wait(frames, 1.5)
        yield from signed(puppet, frames)
        yield from pushed(puppet, frames, side, height, seconds)
        puppet.sign("left", HandState.LASSO)
        yield from wait(frames, 1.0)

    with start_world(side, mapping) as world:
        samples = tuple(follow_steps(script(puppet.frames()), pipeline, world))
    return Recording(RecordingInfo.of(pipeline, puppet), samples)
