"""Files of programs: what they upload, what they may name, and what they fetch.

A name is compared with those of files that the studio knows, and is never a way through folders.
"""

import logging
import threading
from collections.abc import Set
from dataclasses import dataclass
from pathlib import Path

from studio.engine.errors import FileError, StudioError
from studio.engine.resources import samples_folder
from studio.engine.snapshot import Snapshot
from studio.engine.uploads import LARGEST, Uploads, shown_name
from studio.remote.asked import PART, FetchFile, Upload
from studio.remote.files import OnStudio, Place, Recorded, Sample, Uploaded
from studio.remote.told import FilePart, UploadTaken

_LOG = logging.getLogger(__name__)
MOST_KEPT = 4 * LARGEST  # [bytes] of all uploads together
_LEAST = 4096  # [bytes] that the smallest file counts for: what it takes of a disk


@dataclass
class _Kept:
    owner: str
    name: str
    path: Path
    size: int = 0  # [bytes]

    @property
    def weight(self) -> int:
        """What it takes of the studio's disk [bytes]."""
        return max(self.size, _LEAST)


class Shelf:
    """See the module; `close` deletes what was uploaded."""

    def __init__(self) -> None:
        self._uploads: Uploads | None = None  # its folder is there from the first upload on
        self._kept: dict[str, _Kept] = {}
        self._stuck: set[str] = set()  # what could not be deleted, and that was said
        self.size = 0  # [bytes] that all of them take
        self._lock = threading.Lock()

    def take(self, owner: str, asked: Upload) -> UploadTaken:
        """Keep a part of a program's file.

        Raises
        ------
        FileError
            Where it is empty, or more than is taken.
        StudioError
            Where it goes on with a file that this program has not begun.
        """
        with self._lock:
            if self.size + max(len(asked.content), _LEAST) > MOST_KEPT:
                raise FileError(
                    f"{shown_name(asked.name)}: the studio keeps {MOST_KEPT // 2**20} MB of "
                    "programs' uploads, and has them: a program's are freed when it leaves"
                )
            self._uploads = self._uploads or Uploads()
            if asked.upload is None:
                path = self._uploads.keep(asked.name, asked.content)
                kept, before = _Kept(owner, shown_name(asked.name), path), 0
                self._kept[path.name] = kept
            else:
                kept = self._of(owner, asked.upload)
                self._uploads.add(kept.name, kept.path, asked.content)
                before = kept.weight
            kept.size += len(asked.content)
            self.size += kept.weight - before
            return UploadTaken(id=asked.id, upload=kept.path.name, size=kept.size)

    def free(self, owner: str, needed: Set[Path]) -> bool:
        """Delete what a program has uploaded, but for ``needed`` files; tell whether that is all.

        A recording on the list is in memory as a whole, and needs no file.
        """
        with self._lock:
            mine = [name for name, kept in self._kept.items() if kept.owner == owner]
            spare = [name for name in mine if self._kept[name].path not in needed]
            gone = [name for name in spare if self._delete(name)]
            return len(gone) == len(mine)

    def find(self, owner: str, place: Place, now: Snapshot) -> tuple[Path, str]:
        """Return where a file is that a program names, and what people call it.

        Raises
        ------
        StudioError
            Where there is no such file.
        """
        match place:
            case Uploaded(upload=upload):
                kept = self._of(owner, upload)
                return kept.path, kept.name
            case Recorded(name=name):
                known = [file.path for file in now.collection.files]
                return _named(name, known, "the recordings folder")
            case Sample(name=name):
                return _named(name, sorted(samples_folder().iterdir()), "the samples")
            case OnStudio(path=path):
                return Path(path), ""

    def part(self, asked: FetchFile, now: Snapshot) -> FilePart:
        """Return a part of a file that the newest export wrote.

        Raises
        ------
        StudioError
            Where there is no such file, or no such part of it.
        """
        path, name = _named(asked.name, list(now.export.files), "the newest export")
        size = path.stat().st_size
        if asked.offset > size:
            raise StudioError(f"{name} has {size} bytes, and none at {asked.offset}")
        with path.open("rb") as stream:
            stream.seek(asked.offset)
            content = stream.read(PART)
        return FilePart(id=asked.id, name=name, offset=asked.offset, size=size, content=content)

    def close(self) -> None:
        """Delete all uploads."""
        if self._uploads is not None:
            self._uploads.close()

    def _delete(self, name: str) -> bool:
        """Delete a file and tell whether it is gone; the lock is held.

        One that the disk does not let go of stays counted, for it takes room, and is tried again.
        """
        kept = self._kept[name]
        try:
            if self._uploads is not None:
                self._uploads.free(kept.path)
        except OSError as error:
            if name not in self._stuck:
                self._stuck.add(name)
                _LOG.warning("%s, an upload, cannot be deleted: %s", kept.path, error)
            return False
        del self._kept[name]
        self.size -= kept.weight
        return True

    def _of(self, owner: str, upload: str) -> _Kept:
        kept = self._kept.get(upload)
        if kept is None or kept.owner != owner:
            raise StudioError(f"this connection has uploaded no {upload!r:.40}: upload it first")
        return kept


def _named(name: str, known: list[Path], where: str) -> tuple[Path, str]:
    for path in known:
        if path.name == name:
            return path, name
    there = ", ".join(path.name for path in known[:5]) or "nothing"
    raise StudioError(f"{shown_name(name)} is not in {where}, where there is {there}")
