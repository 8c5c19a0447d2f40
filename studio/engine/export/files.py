"""How files are written: whole or not at all, and archives of them the same bytes every time."""

from pathlib import Path
from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile, ZipInfo

from studio.engine.errors import FileError
from studio.engine.sources.whole_file import written_whole

_NO_DATE = (1980, 1, 1, 0, 0, 0)  # the earliest that an archive knows: who packs it reads no clock


def write_text(path: Path, text: str) -> None:
    """Write a text file, its lines ended as they are; raise FileError where it cannot be."""
    write_bytes(path, text.encode("utf-8"))


def write_bytes(path: Path, content: bytes) -> None:
    """Write a file; raise FileError where it cannot be."""
    with written_whole(path) as unfinished:
        unfinished.write_bytes(content)


def pack(archive: ZipFile, name: str, content: bytes, packed: bool = True) -> None:
    """Add a file to an archive, without date, owner and rights."""
    entry = ZipInfo(name, _NO_DATE)
    entry.compress_type = ZIP_DEFLATED if packed else ZIP_STORED
    archive.writestr(entry, content)


def ready_folder(folder: Path) -> None:
    """Make a folder if there is none; raise FileError where that is impossible."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(
            f"{folder}: cannot be made a folder: {error.strerror}; choose another one"
        ) from error
