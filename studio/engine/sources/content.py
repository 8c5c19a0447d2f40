"""The bytes of a file, whatever it is: plain or gzip, told from the content, and never too many."""

import gzip
import os
import stat
import zlib
from pathlib import Path
from typing import IO

from studio.engine.errors import FileError

MAXIMUM_BYTES = 128 * 1024 * 1024  # about 45 minutes of kinect2-socket JSON
_CHUNK_BYTES = 1024 * 1024
_GZIP_MAGIC = b"\x1f\x8b"


def read_content(path: str | os.PathLike[str]) -> bytes:
    """Return what a file holds, decompressed if it is gzip.

    Raises
    ------
    FileError
        Where there is no such file, it is no regular file (a folder, a device), it is empty or
        unreadable, its gzip data are damaged, or it holds more than ``MAXIMUM_BYTES``.
    """
    name = os.fspath(path)
    try:
        _check_regular(name)
        with Path(name).open("rb") as stream:
            compressed = stream.peek(2)[:2] == _GZIP_MAGIC
            data = _read_gzip(name, stream) if compressed else _read_capped(name, stream)
    except FileNotFoundError:
        raise FileError(f"{name}: there is no such file") from None
    except (OSError, ValueError) as error:  # ValueError: a name with a zero byte in it
        reason = getattr(error, "strerror", None) or str(error)
        raise FileError(f"{name}: cannot be read: {reason}") from None
    if not data:
        raise FileError(f"{name}: the file is empty; expected a recording of skeletons")
    return data


def decode(name: str, data: bytes) -> str:
    """Return a file's text, without a byte order mark; raise FileError where it is not UTF-8."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise FileError(
            f"{name}: byte {error.start}: expected text in UTF-8, "
            f"found the byte 0x{data[error.start]:02x}"
        ) from None


def _check_regular(name: str) -> None:
    mode = Path(name).stat().st_mode
    if stat.S_ISDIR(mode):
        raise FileError(f"{name}: this is a folder; expected one file")
    if not stat.S_ISREG(mode):  # a pipe or a device may never end
        raise FileError(f"{name}: this is not a regular file")


def _read_capped(name: str, stream: IO[bytes] | gzip.GzipFile) -> bytes:
    chunks: list[bytes] = []
    count = 0
    while chunk := stream.read(_CHUNK_BYTES):
        chunks.append(chunk)
        count += len(chunk)
        if count > MAXIMUM_BYTES:
            raise FileError(
                f"{name}: holds more than {MAXIMUM_BYTES / 2**20:g} MiB (decompressed), the most "
                "that is read; cut it into shorter recordings"
            )
    return b"".join(chunks)


def _read_gzip(name: str, stream: IO[bytes]) -> bytes:
    with gzip.GzipFile(fileobj=stream) as decompressed:
        try:
            return _read_capped(name, decompressed)
        except (EOFError, gzip.BadGzipFile, zlib.error) as error:
            raise FileError(
                f"{name}: near byte {stream.tell()}: expected gzip data to its end, "
                f"found them damaged or cut off ({error}); fetch or pack the file again"
            ) from None
