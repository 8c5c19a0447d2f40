"""Writes what arrives into our JSONL: all bodies, under stamps that never run back."""

import os
from dataclasses import replace
from pathlib import Path
from typing import TextIO

from studio.engine.errors import FileError
from studio.engine.live.player import encoder
from studio.engine.sources.family import Frame

_BELIEVED = 1.0  # [s] between a sensor's time and ours; more is a clock that was set anew


class FrameRecorder:
    """Keeps all frames of all streams in one file; `record` is a live source's ``on_frame``.

    The sensor's stamps are kept from frame to frame, and the time of arrival where another stream
    begins or they are not to be believed. A context manager.

    Raises
    ------
    FileError
        Where the file exists already, or can't be written.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        self.frames = 0
        self.failure = ""  # why nothing is written any more
        self._encode = encoder("jsonl")
        self._begun: float | None = None  # arrival of the first frame [s]
        self._last = (0, 0.0, 0.0)  # the last frame's stream, stamp and time in the file [s]
        try:
            self._file: TextIO = self.path.open("x", encoding="utf-8", newline="\n")
        except OSError as error:
            raise FileError(f"{self.path}: cannot be written: {error.strerror}") from error

    def record(self, stream: int, frame: Frame, arrival: float) -> None:
        """Write a frame; a full disk ends the recording, not the stream."""
        if self.failure:
            return
        time = self._placed(stream, frame.time, arrival)
        bodies = tuple(replace(body, time=time) for body in frame.bodies)
        try:
            self._file.write(self._encode(Frame(time, bodies)) + "\n")
        except OSError as error:
            self.failure = f"{self.path}: cannot be written: {error.strerror}"
        else:
            self.frames += 1

    def __enter__(self) -> "FrameRecorder":
        return self

    def __exit__(self, *_: object) -> None:
        try:
            self._file.close()
        except OSError as error:
            self.failure = f"{self.path}: cannot be written: {error.strerror}"
        if not self.frames:
            self.path.unlink(missing_ok=True)

    def _placed(self, stream: int, stamp: float, arrival: float) -> float:
        """Return a frame's time in the file [s]."""
        if self._begun is None:
            self._begun = arrival
        since = arrival - self._begun
        last_stream, last_stamp, last_time = self._last
        time = last_time + stamp - last_stamp
        if stream != last_stream or abs(time - since) > _BELIEVED:
            time = since
        time = max(time, last_time)
        self._last = (stream, stamp, time)
        return time
