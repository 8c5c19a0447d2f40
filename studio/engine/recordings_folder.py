"""What lies in the recordings folder: recordings and sessions, each told at a glance.

A glance reads a file's index and no tick, so that a folder of hundreds is listed at once. What is
broken further inside is told when it is opened.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from stat import S_ISREG

from mcap.reader import SeekingReader

from studio.engine.errors import FileError
from studio.engine.export.session_reader import is_session
from studio.engine.mcap_log import BROKEN, is_mcap
from studio.engine.mcap_messages import CHANNELS
from studio.engine.sources.mcap_skeletons import holds_skeletons

MOST_FILES = 500  # the newest ones
SMALLEST = 64  # [bytes]; an MCAP file of nothing is larger
KINDS = (".mcap", ".zip")
_TICKS = "/world"  # the channel that every tick writes to, last


@dataclass(frozen=True)
class FolderFile:
    """A file at a glance."""

    path: Path
    size: int  # [bytes]
    modified: float  # [s] since 1970
    seconds: float | None = None  # how long it is; None: unknown
    problem: str = ""  # why it is of no use, or only part of it
    can_open: bool = True
    was_read: bool = True  # whether its index was looked at

    @property
    def is_session(self) -> bool:
        """Whether it is a whole session's archive."""
        return self.path.suffix == ".zip"

    def is_as(self, other: "FolderFile") -> bool:
        """Tell whether both are the same file, unchanged, as far as the folder tells."""
        return (self.size, self.modified) == (other.size, other.modified)


Known = Mapping[Path, FolderFile]


def look_into(folder: Path, known: Known, most: int) -> tuple[FolderFile, ...]:
    """Return what lies in a folder, the newest first; a folder that is not there holds nothing.

    What is ``known`` is not read again, and of the others ``most`` at once: the next look reads
    more of them.

    Raises
    ------
    FileError
        Where the folder cannot be listed.
    """
    try:
        paths = [path for path in folder.iterdir() if path.suffix in KINDS]
    except FileNotFoundError:
        return ()
    except OSError as error:
        raise FileError(f"{folder}: cannot be listed: {error.strerror}") from None
    found = [file for file in map(_bare, paths) if file is not None]
    found.sort(key=lambda file: (-file.modified, file.path.name))
    looked = []
    for file in found[:MOST_FILES]:
        before = known.get(file.path)
        if before is not None and before.was_read and before.is_as(file):
            looked.append(before)
        elif most > 0:
            looked.append(_glanced(file))
            most -= 1
        else:
            looked.append(file)
    return tuple(looked)


def _bare(path: Path) -> FolderFile | None:
    """Return what the folder itself tells of a file; None where it is none, or has gone."""
    try:
        state = path.stat()
    except OSError:
        return None
    bare = FolderFile(path, state.st_size, state.st_mtime, was_read=False)
    return bare if S_ISREG(state.st_mode) else None


def _glanced(file: FolderFile) -> FolderFile:
    seconds, problem, can_open = _glance(file)
    return FolderFile(file.path, file.size, file.modified, seconds, problem, can_open)


def _glance(file: FolderFile) -> tuple[float | None, str, bool]:
    """Return a file's length [s], what is wrong with it, and whether it is worth opening."""
    if file.is_session:
        fits = is_session(file.path)
        return None, "" if fits else "not an archive of a session", fits
    if file.size < SMALLEST:
        return None, "nothing is in it", False
    if not is_mcap(file.path):
        return None, "not an MCAP file", False
    if holds_skeletons(file.path):
        return None, "skeletons without a robot: upload it in 1 Source", False
    return _of_index(file)


def _of_index(file: FolderFile) -> tuple[float | None, str, bool]:
    try:
        with file.path.open("rb") as stream:
            summary = SeekingReader(stream, record_size_limit=file.size).get_summary()
    except OSError as error:
        return None, f"cannot be read: {error.strerror or error}", False
    except (*BROKEN, RuntimeError):  # that one: an iterator that ends within another one
        return None, "cut off: what is whole of it can be opened", True
    statistics = None if summary is None else summary.statistics
    if summary is None or statistics is None:
        return None, "cut off: what is whole of it can be opened", True
    topics = {channel.topic for channel in summary.channels.values()}
    if not topics <= set(CHANNELS) or _TICKS not in topics:
        return None, "a recording of something else than this studio's", False
    return (statistics.message_end_time - statistics.message_start_time) / 1e9, "", True
