"""What every file format is read into, and what a format has to offer to be read.

A family is one module: ``recognizes`` looks at the beginning of a text, ``read`` turns the content
into frames, line by line where the format allows it. Neither knows the file's name; ``registry``
puts that on every error. A new format is a new module and one entry in the registry.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from studio.engine.errors import StudioError
from studio.engine.skeleton import SIDES, HandState, Skeleton
from studio.engine.sources.content import Content

MAXIMUM_TIME = 1e12  # s, 30,000 years; beyond it a number is no stamp, and sums of it overflow
MAXIMUM_ID_LENGTH = 100  # characters; the SDK's own ids are numbers of 64 bits


@dataclass(frozen=True)
class Frame:
    """All bodies that were seen at one moment; none is a frame with nobody in it."""

    time: float  # [s]
    bodies: tuple[Skeleton, ...] = ()


TELLS = ("hand_states", "tracking", "stamps")  # what a format may tell or not, by its names


@dataclass(frozen=True)
class ParsedFile:
    """A file's frames with all their bodies, and what its format does not tell."""

    format: str  # short and stable: "kinect2-socket 0.3", "table 101", "studio jsonl 1"
    frames: Sequence[Frame]
    has_hand_states: bool
    has_tracking: bool
    has_stamps: bool

    @property
    def tells(self) -> tuple[str, ...]:
        """What it tells, by the names in `TELLS`."""
        flags = (self.has_hand_states, self.has_tracking, self.has_stamps)
        return tuple(name for name, told in zip(TELLS, flags, strict=True) if told)


@dataclass(frozen=True)
class Family:
    """One family of formats: its name for people, how it is recognized and how it is read."""

    name: str
    recognizes: Callable[[str], bool]  # given the first characters of a text
    read: Callable[[Content], ParsedFile]  # raises StudioError that names the place, not the file


def gather(entries: Iterable[tuple[float, Skeleton | None]]) -> list[Frame]:
    """Return the frames of a stream that tells one body, or nobody, at a time.

    Bodies of equal time are one frame; a body that comes again at the same time starts a new one.
    """
    frames: list[Frame] = []
    for time, skeleton in entries:
        others = frames[-1].bodies if frames and frames[-1].time == time else ()
        if skeleton is None:
            frames.append(Frame(time))
        elif others and all(other.body_id != skeleton.body_id for other in others):
            frames[-1] = Frame(time, (*others, skeleton))
        else:
            frames.append(Frame(time, (skeleton,)))
    return frames


def any_hand_state(frames: Iterable[Frame]) -> bool:
    """Return whether any hand is in a state other than unknown: what tells that a sensor looks."""
    return any(
        body.hand(side).state is not HandState.UNKNOWN
        for frame in frames
        for body in frame.bodies
        for side in SIDES
    )


def check_time(time: float, previous: float | None) -> None:
    """Raise StudioError where a stamp is no time, or runs back behind the one before."""
    if not math.isfinite(time) or abs(time) > MAXIMUM_TIME:
        raise StudioError(f"expected a time in seconds, found {time!r}")
    if previous is not None and time < previous:
        raise StudioError(
            f"the time goes backwards, from {previous!r} s to {time!r} s; "
            "expected stamps that rise or stay"
        )


def check_body_id(body_id: str) -> None:
    """Raise StudioError where an id cannot be shown to a person: too long, or no valid text."""
    if not body_id or len(body_id) > MAXIMUM_ID_LENGTH or not body_id.isprintable():
        raise StudioError(
            f"expected a body's id, 1 to {MAXIMUM_ID_LENGTH} printable characters, "
            f"found {shown(body_id)}"
        )


def shown(value: object) -> str:
    """Return a value as an error message shows it: in ASCII and never long."""
    if isinstance(value, list):
        return f"a list of {len(value)}"
    if isinstance(value, dict):
        return f"an object with {len(value)} keys"
    text = ascii(value[:60] if isinstance(value, str) else value)
    return text if len(text) <= 60 else text[:57] + "..."
