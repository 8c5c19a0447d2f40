"""Files that a browser or a program sends: nothing about them is believed before it is checked.

The bytes are written under a name of our own; the file's name is for people only. What is in the
file is for the engine's readers to tell, which go by content.
"""

import itertools
import tempfile
from pathlib import Path, PurePosixPath

from studio.engine.errors import FileError

LARGEST = 64 * 2**20  # [bytes] about an hour and a half of skeletons in the studio's own format
_LONGEST_NAME = 60  # characters
_CUT = "cut it into parts, or use the command: studio teach FILE"


class Uploads:
    """A temporary folder of uploaded files; `close` deletes them."""

    def __init__(self) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="teaching-studio-")
        self._numbers = itertools.count(1)

    def keep(self, name: str, content: bytes, cure: str = _CUT) -> Path:
        """Write a file's content and return where it is; ``cure`` helps where it is too large.

        Raises
        ------
        FileError
            Where the file is empty or larger than `LARGEST`.
        """
        shown = shown_name(name)
        if not content:
            raise FileError(f"{shown}: the file is empty")
        _check_size(shown, len(content), cure)
        path = Path(self._folder.name) / f"upload-{next(self._numbers)}"
        path.write_bytes(content)
        return path

    def add(self, name: str, path: Path, content: bytes) -> None:
        """Write more of a file that `keep` has begun at ``path``; raise FileError as it does."""
        _check_size(shown_name(name), path.stat().st_size + len(content))
        with path.open("ab") as file:
            file.write(content)

    def free(self, path: Path) -> None:
        """Delete a file that `keep` has begun."""
        path.unlink(missing_ok=True)

    def close(self) -> None:
        """Delete all of them."""
        self._folder.cleanup()


def _check_size(shown: str, size: int, cure: str = _CUT) -> None:
    if size > LARGEST:
        raise FileError(
            f"{shown}: {size / 2**20:.0f} MB; up to {LARGEST // 2**20} MB are taken: {cure}"
        )


def shown_name(name: str) -> str:
    """Return a file's name as people may see it: no folders, nothing unprintable, not too long."""
    last = PurePosixPath(name.replace("\\", "/")).name
    printable = "".join(letter for letter in last if letter.isprintable()).strip()
    if len(printable) > _LONGEST_NAME:
        printable = printable[: _LONGEST_NAME - 1] + "…"
    return printable or "unnamed file"
