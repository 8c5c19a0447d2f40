"""Any file of skeletons, or of a recording, as our own JSONL or as MCAP: `studio convert`."""

import gzip
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from studio.engine.errors import FileError, StudioError
from studio.engine.mcap_file import MCAP_FORMAT, is_recording, read_recording
from studio.engine.recording import Recording
from studio.engine.sources import mcap_skeletons
from studio.engine.sources.family import ParsedFile, any_hand_state, gather
from studio.engine.sources.files import read_frames
from studio.engine.sources.jsonl import file_to_lines
from studio.engine.sources.whole_file import written_whole

_ASSUMED = {  # where the source does not tell it, which the new file says too
    "hand_states": "hands as unknown, since the source tells no hand states",
    "tracking": "every joint as tracked, since the source tells no tracking",
    "stamps": "30 frames a second, since the source tells no stamps",
}


@dataclass(frozen=True)
class Conversion:
    """What was converted."""

    source: str
    target: str
    format: str  # of the source
    frames: int
    bodies: int  # in all frames together
    notes: tuple[str, ...]  # what the new file does not hold, or takes for granted


def convert(source: Path, target: Path, force: bool = False) -> Conversion:
    """Read a file of skeletons and write all its bodies anew; the target's suffix says how.

    Parameters
    ----------
    source : Path
        A file in any format that is read, or a recording (MCAP).
    target : Path
        Ends in ``.jsonl``, ``.jsonl.gz`` or ``.mcap``.
    force : bool
        Whether a target that exists is overwritten. It is never half written.

    Raises
    ------
    FileError
        Where the source cannot be used, or the target cannot or must not be written.
    """
    write = _writer_for(target)
    if os.path.lexists(target) and not force:
        raise FileError(f"{target}: exists; choose another name, or overwrite it by --force")
    parsed, notes = read_any(source)
    try:
        with written_whole(target) as unfinished:
            write(unfinished, parsed)
    except FileError:
        raise
    except StudioError as error:
        raise FileError(f"{source}: cannot be converted: {error}") from None
    bodies = sum(len(frame.bodies) for frame in parsed.frames)
    assumed = (note for name, note in _ASSUMED.items() if name not in parsed.tells)
    return Conversion(
        str(source), str(target), parsed.format, len(parsed.frames), bodies, (*notes, *assumed)
    )


def read_any(path: Path) -> tuple[ParsedFile, tuple[str, ...]]:
    """Return the frames of a skeleton file or of a recording, and what of it they leave out.

    Raises
    ------
    FileError
        As `read_frames` and `read_recording` do.
    """
    if not is_recording(path):
        return read_frames(path), ()
    recording = read_recording(path)
    seen = [sample.skeleton for sample in recording.samples if sample.skeleton is not None]
    frames = gather((skeleton.time, skeleton) for skeleton in seen)
    parsed = ParsedFile(MCAP_FORMAT, frames, any_hand_state(frames), True, True)
    return parsed, (*filter(None, [recording.warning]), *_left_out(recording))


def _left_out(recording: Recording) -> Iterator[str]:
    """Yield what a recording's skeletons do not tell, or never told."""
    yield "the skeletons alone, without gate, commands, joints and blocks"
    yield "tracking and stamps pass for told: a recording does not keep if its source told them"
    without = sum(sample.skeleton is None for sample in recording.samples)
    if without:
        yield (
            f"no frames for {without} of {len(recording.samples)} ticks, which brought no new "
            "skeleton: a recording does not keep whether nobody was in sight"
        )


def _writer_for(target: Path) -> Callable[[Path, ParsedFile], None]:
    for suffix, write in _WRITERS.items():
        if target.name.endswith(suffix) and target.name != suffix:
            return write
    raise FileError(f"{target}: expected a name that ends in {', '.join(_WRITERS)}")


def _write_jsonl(path: Path, parsed: ParsedFile) -> None:
    with path.open("w", encoding="utf-8") as stream:
        stream.writelines(file_to_lines(parsed))


def _write_packed_jsonl(path: Path, parsed: ParsedFile) -> None:
    # Neither name nor time in its head, so that the same frames give the same bytes.
    with path.open("wb") as file, gzip.GzipFile("", "wb", fileobj=file, mtime=0) as stream:
        stream.writelines(line.encode() for line in file_to_lines(parsed))


_WRITERS: dict[str, Callable[[Path, ParsedFile], None]] = {
    ".jsonl": _write_jsonl,
    ".jsonl.gz": _write_packed_jsonl,
    ".mcap": mcap_skeletons.write,
}
