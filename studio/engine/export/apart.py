"""Exports in a process of their own, so that a live session goes on meanwhile.

Pictures and plays need worlds of pybullet, which shares one process between threads badly, and
all of them keep Python busy for many ticks. So the session is packed, and `studio export` opens it.
"""

import json
import queue
import re
import shutil
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import IO

from studio.engine.errors import FileError, StudioError
from studio.engine.export import session_file
from studio.engine.export.anonymous import anonymous as without_names
from studio.engine.export.files import ready_folder
from studio.engine.export.kind import Job
from studio.engine.export.material import Material
from studio.engine.export.registry import KINDS

_PERCENT = re.compile(r"^studio: (\w+): (\d+)%$")
_ASKED_EVERY = 0.2  # [s] whether to go on
_PACKED = 0.02  # share of the work
APART = (*KINDS, "replay")  # the last one is the panels'


def export_apart(
    material: Material, names: Sequence[str], job: Job, anonymous: bool = False
) -> tuple[Path, ...]:
    """Write some kinds of files as `export` does, those of the panels included.

    The other process learns and plays anew what is not in the material's session: the same.

    Raises
    ------
    StudioError
        Where something that it needs is missing, or the process fails; the message says why.
    FileError
        Where a file cannot be written.
    StoppedError
        Where the job was stopped; no file is there then.
    """
    kinds = list(dict.fromkeys(names))
    for name in kinds:
        if name not in APART:
            raise StudioError(f"there is no export {name!r}; there are {', '.join(APART)}")
    ready_folder(job.folder)
    shown = without_names(material) if anonymous else material
    with tempfile.TemporaryDirectory() as scratch:
        (session,) = session_file.write(shown, Job(Path(scratch), job.part(0.0, _PACKED).progress))
        made = Path(scratch, "made")
        command = [sys.executable, "-m", "studio", "export", str(session), "--to", str(made)]
        _run([*command, "--json", "--kinds", *kinds], kinds, job.part(_PACKED, 1.0))
        try:
            written = tuple(
                Path(shutil.move(path, job.folder / path.name)) for path in sorted(made.iterdir())
            )
        except OSError as error:
            raise FileError(f"{job.folder}: cannot be written to: {error.strerror}") from error
    job.done(1.0)
    return written


def _run(command: list[str], kinds: list[str], job: Job) -> None:
    """Run a command to its end, or to where the job is stopped."""
    said, share, answer = "", 0.0, ""
    heard: queue.SimpleQueue[str | None] = queue.SimpleQueue()
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace"
    ) as process:
        listener = threading.Thread(target=_listen, args=(process.stderr, heard))
        listener.start()
        try:
            for line in _lines(heard):
                said = line or said
                found = _PERCENT.match(line)
                if found is not None and found[1] in kinds:
                    share = (kinds.index(found[1]) + int(found[2]) / 100.0) / len(kinds)
                job.done(share)  # in its silence, too: somebody may wish to stop it
            answer = process.stdout.read() if process.stdout is not None else ""
            process.wait()
        finally:
            if process.poll() is None:
                process.kill()  # what it wrote so far is in a folder that goes with it
            listener.join()
    if process.returncode != 0:
        raise StudioError(_why(answer) or f"the export ended early: {said or 'nobody knows why'}")


def _listen(stream: IO[str] | None, heard: "queue.SimpleQueue[str | None]") -> None:
    """Put what is said into a queue, then None."""
    for line in stream or ():
        heard.put(line.strip())
    heard.put(None)


def _lines(heard: "queue.SimpleQueue[str | None]") -> Iterator[str]:
    """Yield what is said, and nothing now and then while nothing is."""
    while True:
        try:
            line = heard.get(timeout=_ASKED_EVERY)
        except queue.Empty:
            line = ""
        if line is None:
            return
        yield line


def _why(answer: str) -> str:
    """Return the error that a command told as JSON, or nothing."""
    try:
        found = json.loads(answer)
    except ValueError:
        return ""
    return str(found.get("error", "")) if isinstance(found, dict) else ""
