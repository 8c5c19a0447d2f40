"""What a file holds, whatever it is: plain or gzip, told from the content, and never too much."""

import codecs
import gzip
import io
import os
import stat
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from studio.engine.errors import FileError

MAXIMUM_BYTES = 128 * 1024 * 1024  # read whole: about 45 minutes of kinect2-socket JSON
MAXIMUM_STREAM_BYTES = 512 * 1024 * 1024  # read line by line: two hours or more of one body
MAXIMUM_LINE = 4 * 1024 * 1024  # characters; a frame of six bodies takes some 40,000
MAXIMUM_LINES = 20_000_000  # blank ones included; NTU RGB+D takes 27 a body and frame
HEAD_BYTES = 64 * 1024  # enough to tell a format by
_CHUNK_BYTES = 1024 * 1024
_GZIP_MAGIC = b"\x1f\x8b"

Told = Callable[[float], None]  # hears what share of a file has been read, 0 to 1


def unheard(_: float) -> None:
    """Nobody wants to know."""


class Content:
    """The decompressed bytes of a file, to be read once: whole, or line by line.

    ``head`` are its first bytes, which stay to be read. Errors name the file.
    """

    def __init__(
        self,
        name: str,
        stream: IO[bytes] | gzip.GzipFile,
        on_read: Callable[[], None] = lambda: None,
    ) -> None:
        self.name = name
        self._stream, self._on_read = stream, on_read
        self._count = 0  # bytes read so far
        self.head = self._read(HEAD_BYTES)

    def text(self) -> str:
        """Return the whole text, without a byte order mark.

        Raises
        ------
        FileError
            Where it is not UTF-8, damaged, or larger than `MAXIMUM_BYTES`.
        """
        data = b"".join(self._chunks(MAXIMUM_BYTES))
        try:
            return data.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            found = f"found the byte 0x{data[error.start]:02x}"
            raise FileError(
                f"{self.name}: byte {error.start}: expected text in UTF-8, {found}"
            ) from None

    def lines(self) -> Iterator[str]:
        """Yield line after line of the text, whatever ends them, in little memory.

        Raises
        ------
        FileError
            Where it is not UTF-8, damaged, larger than `MAXIMUM_STREAM_BYTES`, or has a line longer
            than `MAXIMUM_LINE` or more lines than `MAXIMUM_LINES`.
        """
        utf8 = codecs.getincrementaldecoder("utf-8-sig")()
        decoder = io.IncrementalNewlineDecoder(utf8, translate=True)
        count, rest = 0, ""
        for chunk in self._chunks(MAXIMUM_STREAM_BYTES):
            lines = (rest + self._decoded(decoder, chunk, count)).split("\n")
            rest = lines.pop()
            count += len(lines)
            if count > MAXIMUM_LINES:
                raise FileError(f"{self.name}: more than {MAXIMUM_LINES:,} lines; cut it")
            yield from lines
            if len(rest) > MAXIMUM_LINE:
                raise FileError(
                    f"{self.name}: line {count + 1}: longer than {MAXIMUM_LINE:,} characters; "
                    "expected one frame a line"
                )
        *lines, rest = (rest + self._decoded(decoder, b"", count)).split("\n")
        yield from lines
        if rest:  # a last line without an end
            yield rest

    def _decoded(self, decoder: io.IncrementalNewlineDecoder, chunk: bytes, line: int) -> str:
        try:
            return decoder.decode(chunk, final=not chunk)
        except UnicodeDecodeError as error:
            found = "an end within a letter" if not chunk else f"{error.object[error.start]:#04x}"
            raise FileError(
                f"{self.name}: after line {line}: expected text in UTF-8, found {found}"
            ) from None

    def _chunks(self, limit: int) -> Iterator[bytes]:
        chunk = self.head
        while chunk:
            if self._count > limit:
                raise FileError(
                    f"{self.name}: holds more than {limit / 2**20:g} MiB (decompressed), the most "
                    "that is read of its format; cut it into shorter recordings"
                )
            yield chunk
            chunk = self._read(_CHUNK_BYTES)

    def _read(self, count: int) -> bytes:
        try:
            chunk = self._stream.read(count)
        except (EOFError, gzip.BadGzipFile, zlib.error) as error:
            found = "cut off or damaged" if isinstance(error, EOFError) else f"damaged ({error})"
            raise FileError(
                f"{self.name}: after {self._stream.tell():,} bytes (decompressed): expected "
                f"gzip data to its end, found them {found}; fetch or pack the file again"
            ) from None
        except OSError as error:
            raise _unreadable(self.name, error) from None
        self._count += len(chunk)
        self._on_read()
        return chunk


@contextmanager
def open_content(path: str | os.PathLike[str], told: Told = unheard) -> Iterator[Content]:
    """Open what a file holds, decompressed if it is gzip; ``told`` hears how much was read.

    Raises
    ------
    FileError
        Where there is no such file, it is no regular file (a folder, a device), it is empty or
        unreadable, or its gzip data are damaged; while it is read, what `Content` says.
    """
    name = os.fspath(path)
    with _opened(name) as stream:
        compressed = stream.peek(2)[:2] == _GZIP_MAGIC
        size = max(os.fstat(stream.fileno()).st_size, 1)
        content = Content(
            name,
            gzip.GzipFile(fileobj=stream) if compressed else stream,
            lambda: told(min(stream.tell() / size, 1.0)),
        )
        if not content.head:
            raise FileError(f"{name}: the file is empty; expected a recording of skeletons")
        yield content


def content_of(name: str, data: bytes) -> Content:
    """Return the content of a file that is at hand already."""
    return Content(name, io.BytesIO(data))


def _opened(name: str) -> io.BufferedReader:
    try:
        _check_regular(name)
        return Path(name).open("rb")
    except FileNotFoundError:
        raise FileError(f"{name}: there is no such file") from None
    except (OSError, ValueError) as error:  # ValueError: a name with a zero byte in it
        raise _unreadable(name, error) from None


def _unreadable(name: str, error: OSError | ValueError) -> FileError:
    return FileError(f"{name}: cannot be read: {getattr(error, 'strerror', None) or error}")


def _check_regular(name: str) -> None:
    mode = Path(name).stat().st_mode
    if stat.S_ISDIR(mode):
        raise FileError(f"{name}: this is a folder; expected one file")
    if not stat.S_ISREG(mode):  # a pipe or a device may never end
        raise FileError(f"{name}: this is not a regular file")
