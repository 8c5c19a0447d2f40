"""A file that is written whole or not at all."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from studio.engine.errors import FileError


@contextmanager
def written_whole(path: Path) -> Iterator[Path]:
    """Yield where to write to; what is there takes the file's name once the block ends well.

    Raises
    ------
    FileError
        Where the file cannot be written.
    """
    unfinished = path.with_name(path.name + ".unfinished")
    try:
        try:
            yield unfinished
            unfinished.replace(path)
        finally:
            unfinished.unlink(missing_ok=True)
    except OSError as error:
        raise FileError(f"{path}: cannot be written: {error.strerror or error}") from None
