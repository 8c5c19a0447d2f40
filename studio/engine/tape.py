"""A recording in the making: in memory and, tick by tick, in its file."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from studio.engine.errors import FileError
from studio.engine.live.latency import LatencyChain
from studio.engine.mcap_file import RecordingWriter
from studio.engine.recording import Recording, RecordingInfo, Sample
from studio.engine.robot import CONTROL_RATE

LONGEST_RECORDING = 15 * 60  # [s] of a source without an end; 100 MB in memory


@dataclass(frozen=True)
class Plan:
    """What a recording is made for."""

    replaces: int | None = None  # the listed demonstration whose place it takes
    repeats: bool = False  # whether the next one begins once a demonstration is over
    goes_on: bool = False  # whether one is over already


NO_PLAN = Plan()


class Tape:
    """See the module.

    Raises
    ------
    FileError
        Where the file exists already or cannot be written.
    """

    def __init__(self, path: Path, info: RecordingInfo, plan: Plan) -> None:
        self.path, self.plan = path, plan
        self.samples: list[Sample] = []
        self._info, self._writer = info, RecordingWriter(path, info)
        self._began = 0.0  # [s] of the run, when its first tick was

    def write(self, sample: Sample, latency: Callable[[], LatencyChain | None]) -> None:
        """Write a tick down at once, so that a crash loses less than a second."""
        if not self.samples:
            self._began = sample.time
        sample = replace(sample, time=sample.time - self._began)
        if len(self.samples) % CONTROL_RATE == CONTROL_RATE - 1:  # once a second
            sample = replace(sample, latency=latency())
        self.samples.append(sample)
        self._writer.write(sample)

    def close(self) -> None:
        """Finish the file; without samples, remove it. May be called twice."""
        self._writer.close()

    @property
    def recording(self) -> Recording:
        """What has been recorded so far."""
        return Recording(self._info, tuple(self.samples))

    @property
    def is_long_enough(self) -> bool:
        """Whether it has come to the longest that is kept."""
        return len(self.samples) >= LONGEST_RECORDING * CONTROL_RATE


def next_recording_path(folder: Path) -> Path:
    """Return the first free ``demonstration-001.mcap`` in a folder."""
    for number in range(1, 10_000):
        path = folder / f"demonstration-{number:03d}.mcap"
        if not path.exists():
            return path
    raise FileError(f"{folder}: holds 9,999 demonstrations; move some away")
