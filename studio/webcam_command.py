"""The command ``studio webcam``."""

import os
import sys
from dataclasses import dataclass
from pathlib import Path

from studio.console import log
from studio.engine.errors import FileError
from studio.engine.live.access import Address, check_url
from studio.stream_token import VARIABLE, stream_token
from studio.webcam_environment import TRACKER, cache_folder, tracker_python


@dataclass(frozen=True)
class Webcam:
    """Take a webcam or a video as the sensor of a running studio.

    The first time, its tracker (MediaPipe) is set up in your cache folder. No picture is stored,
    and none leaves this computer: the studio gets where body and hands are.
    """

    camera: int = 0
    """The camera's number."""
    video: Path | None = None
    """A video file instead of a camera."""
    to: str = Address().url
    """Where the studio takes live streams."""
    token: str | None = None
    """What the studio wants to be shown, if anything; STUDIO_TOKEN says it unseen."""
    out: Path | None = None
    """Write what is found to this file (JSON lines) instead; `studio inspect` reads it."""
    mirror: bool = False
    """The camera's pictures come mirrored: text in them reads backwards."""
    speed: float = 1.0
    """Of a video; 0: every picture, without waiting."""
    loop: bool = False
    """Begin the video again at its end."""
    python: str = sys.executable
    """The Python 3.9 to 3.12 to set the tracker up with; by default the studio's own."""

    def run(self) -> int:
        """Become the tracker, so that Ctrl-C and its exit status are its own."""
        if self.video is not None and not self.video.is_file():
            raise FileError(f"{self.video}: there is no such file")
        if self.out is not None and self.out.exists():
            raise FileError(f"{self.out}: is there already: move it, or name another file")
        check_url(self.to)
        token = stream_token(self.token)
        shown = {} if token is None else {VARIABLE: token}  # what is typed, others can read
        interpreter = tracker_python(self.python, cache_folder(), log)
        sys.stdout.flush()
        # -I: nothing of the studio's own environment may get into the tracker's.
        told = [str(interpreter), "-I", *self.arguments()]
        os.execve(interpreter, told, {**os.environ, **shown})

    def arguments(self) -> list[str]:
        """Return what the tracker is told, but the token."""
        told = [f"--camera={self.camera}", f"--to={self.to}", f"--speed={self.speed}"]
        for name, path in (("--video", self.video), ("--out", self.out)):
            told += [] if path is None else [f"{name}={path}"]
        for name, given in (("--mirror", self.mirror), ("--loop", self.loop)):
            told += [name] if given else []
        return [str(TRACKER), *told]
