"""The skeletons of a file as the rest of the studio takes them: one body's, in order of time."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from studio.engine.errors import StudioError
from studio.engine.skeleton import FloatArray, Skeleton
from studio.engine.sources.family import (
    Frame,
    ParsedFile,
    any_hand_state,
    check_time,
    gather,
    shown,
)
from studio.engine.sources.following import Following, choose_body

_Array = TypeVar("_Array", bound=NDArray[np.generic])


@dataclass(frozen=True, eq=False)
class SkeletonRecording(Sequence[Skeleton]):
    """One body's n skeletons, out of a file of F frames.

    A sequence of the chosen body's skeletons: one for each frame in which it is seen, duplicate
    frames included. ``by_frame`` also tells the frames without it.
    """

    path: str
    format: str  # short and stable, such as "table 101"
    skeletons: tuple[Skeleton, ...]  # n
    frame_indices: NDArray[np.int64]  # (n,) each skeleton's frame in the file, counted from 0
    frame_times: FloatArray  # (F,) [s]
    bodies: Mapping[str, int]  # all ids seen in the file, and in how many frames
    has_hand_states: bool
    has_tracking: bool  # where not, every joint passes for tracked
    has_stamps: bool  # where not, 30 frames a second are assumed

    @overload
    def __getitem__(self, index: int) -> Skeleton: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Skeleton, ...]: ...
    def __getitem__(self, index: int | slice) -> Skeleton | tuple[Skeleton, ...]:
        return self.skeletons[index]

    def __len__(self) -> int:
        return len(self.skeletons)

    @property
    def frames(self) -> int:
        """How many frames the file has, with the chosen body or without."""
        return len(self.frame_times)

    @property
    def seconds(self) -> float:
        """The time from the first frame to the last [s]."""
        return float(self.frame_times[-1] - self.frame_times[0]) if self.frames else 0.0

    def by_frame(self) -> Iterator[tuple[float, Skeleton | None]]:
        """Yield every frame's time [s] and its skeleton, None where the chosen body is not seen."""
        seen = dict(zip(self.frame_indices.tolist(), self.skeletons, strict=True))
        for index, time in enumerate(self.frame_times.tolist()):
            yield time, seen.get(index)

    def as_parsed(self) -> ParsedFile:
        """Return the file as if it showed the chosen body alone."""
        frames = [
            Frame(time, () if skeleton is None else (skeleton,))
            for time, skeleton in self.by_frame()
        ]
        return ParsedFile(
            self.format, frames, self.has_hand_states, self.has_tracking, self.has_stamps
        )


def from_skeletons(
    skeletons: Iterable[Skeleton], path: str, format: str, body: str | None = None
) -> SkeletonRecording:
    """Return skeletons that did not come from a skeleton file as if they had.

    ``path`` and ``format`` say where they are from, such as "demonstrator:1" and "demonstrator".
    Raises StudioError where their time runs backwards, or where ``body`` is asked for and not seen.
    """
    frames = gather((skeleton.time, skeleton) for skeleton in skeletons)
    for before, after in pairwise(frames):
        check_time(after.time, before.time)
    parsed = ParsedFile(
        format, frames, has_hand_states=any_hand_state(frames), has_tracking=True, has_stamps=True
    )
    return follow(parsed, path, body)


def follow(parsed: ParsedFile, path: str, body: str | None = None) -> SkeletonRecording:
    """Choose one body of each frame: the one asked for, or the one to follow.

    Without ``body``, the one nearest to the sensor in the floor plane is taken, which is nearest to
    the middle and to the sensor, and kept; see `studio.engine.sources.following`.

    Raises
    ------
    StudioError
        Where no frame shows the body asked for; the message lists those that are seen.
    """
    bodies = Counter(skeleton.body_id for frame in parsed.frames for skeleton in frame.bodies)
    if body is not None and body not in bodies:
        known = ", ".join(sorted(bodies)) or "none"
        raise StudioError(f"expected a body that is seen, not {shown(body)}; seen: {known}")
    skeletons: list[Skeleton] = []
    indices: list[int] = []
    following: Following | None = None
    for index, frame in enumerate(parsed.frames):
        following, skeleton = choose_body(following, frame, only=body)
        if skeleton is not None:
            skeletons.append(skeleton)
            indices.append(index)
    return SkeletonRecording(
        path=path,
        format=parsed.format,
        skeletons=tuple(skeletons),
        frame_indices=_read_only(np.array(indices, dtype=np.int64)),
        frame_times=_read_only(np.array([frame.time for frame in parsed.frames], dtype=float)),
        bodies=dict(bodies),
        has_hand_states=parsed.has_hand_states,
        has_tracking=parsed.has_tracking,
        has_stamps=parsed.has_stamps,
    )


def _read_only(array: _Array) -> _Array:
    array.setflags(write=False)
    return array
