"""A robot follows a stream of skeletons, tick by tick: the headless form of live teaching."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from itertools import count

import numpy as np

from studio.engine.errors import FileError
from studio.engine.live.source import LiveSource
from studio.engine.live.stamps import Rebased, rebase
from studio.engine.performance import send, start_world
from studio.engine.pipeline import Outcome, Pipeline
from studio.engine.recording import Recording, RecordingInfo, Sample
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE
from studio.engine.scene import USUAL, Scene
from studio.engine.skeleton import FloatArray, Skeleton
from studio.engine.sources import SkeletonRecording
from studio.engine.world import World

LONGEST = 2 * 3600  # [s] of a stream; a wrong stamp must not keep the studio busy for years
_ROUNDING = 1e-6  # of a tick: a stamp of n/30 s belongs to tick n, whatever its last bit says


def ticks_of(times: FloatArray) -> FloatArray:
    """Return the tick at which each stamp (n,) [s] is first seen; the first stamp's is 0."""
    since = (np.asarray(times) - times[0]) * CONTROL_RATE if len(times) else np.empty(0)
    ticks: FloatArray = np.ceil(since - _ROUNDING).astype(int)
    return ticks


def newest_frames(stream: SkeletonRecording) -> Iterator[Skeleton | None]:
    """Return what each 30 Hz tick sees: the newest skeleton, or None where none is new."""
    ticks = ticks_of(stream.frame_times)
    if len(ticks) and ticks[-1] > LONGEST * CONTROL_RATE:
        raise FileError(
            f"{stream.path}: its stamps span {ticks[-1] / CONTROL_RATE / 3600:,.0f} hours; streams "
            f"up to {LONGEST // 3600} hours are followed: cut it, or mend its stamps"
        )
    newest = dict(zip(ticks[stream.frame_indices].tolist(), stream, strict=True))
    for tick in range(int(ticks[-1]) + 1 if len(ticks) else 0):
        yield newest.get(tick)


def live_frames(live: LiveSource) -> Iterator[Skeleton | None]:
    """Return what each 30 Hz tick sees of a live stream, its stamps moved onto the ticks."""
    last: Rebased | None = None
    for tick in count():
        taken = live.take()
        if taken is None or taken.skeleton is None:
            yield None
        else:
            time = tick * CONTROL_PERIOD
            last = rebase(last, taken.stream, taken.skeleton.time, time)
            yield replace(taken.skeleton, time=last.time)


def follow_steps(
    frames: Iterable[Skeleton | None],
    pipeline: Pipeline,
    world: World,
    given: Callable[[Outcome], None] = lambda _: None,
) -> Iterator[Sample]:
    """Let the robot in ``world`` follow ``frames`` through ``pipeline``, one sample a tick.

    ``given`` hears what a tick decided as soon as the robot has its command.
    """
    memory = pipeline.start()
    for tick, skeleton in enumerate(frames):
        time = tick * CONTROL_PERIOD
        memory, outcome = pipeline.advance(memory, skeleton, time)
        send(world, pipeline.arms, outcome.command.sent, pipeline.hands.options, outcome.hands)
        given(outcome)
        yield Sample.of(time, skeleton, outcome, world.step())


def follow(stream: SkeletonRecording, pipeline: Pipeline, scene: Scene | None = None) -> Recording:
    """Follow a whole stream in a fresh world, of the usual scene or ``scene``; return all of it."""
    info = RecordingInfo.of(pipeline, stream, scene or USUAL)
    with start_world(pipeline.arms, pipeline.mapping, pipeline.hands.options, scene) as world:
        return Recording(info, tuple(follow_steps(newest_frames(stream), pipeline, world)))
