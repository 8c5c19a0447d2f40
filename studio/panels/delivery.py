"""What was exported goes to a browser: packed and sent beside the drawing, which never waits.

An export can be megabytes, and to pack them takes seconds.
"""

import io
import threading
import zipfile
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

from studio.engine.errors import FileError
from studio.panels.trouble import Attempt

ARCHIVE = "studio-export.zip"  # of several files; a session's own archive never is in there


class Delivery:
    """See the module: one export after the other, on a thread that ends with `close`.

    Parameters
    ----------
    send
        Gets each file's name and content.
    attempt
        Tells people why something cannot be sent.
    """

    def __init__(self, send: Callable[[str, bytes], None], attempt: Attempt) -> None:
        self._send, self._attempt = send, attempt
        self._thread = ThreadPoolExecutor(1, "delivery")
        self._closing = threading.Event()

    def take(self, files: tuple[Path, ...]) -> None:
        """Send files as soon as those before them are sent; do not wait for it."""
        self._thread.submit(self._attempt, partial(self._deliver, files))

    def close(self) -> None:
        """Send nothing more, and end the thread."""
        self._closing.set()
        self._thread.shutdown(cancel_futures=True)

    def _deliver(self, files: tuple[Path, ...]) -> None:
        try:
            for name, content in packages(files, self._closing.is_set):
                self._send(name, content)
        except OSError as error:
            raise FileError(_in_words(error)) from error


def packages(
    files: tuple[Path, ...], is_over: Callable[[], bool] = lambda: False
) -> Iterator[tuple[str, bytes]]:
    """Yield what is sent: a session's archive and a single file as they are, others as one.

    Nothing more comes once it ``is_over``.

    Raises
    ------
    OSError
        Where a file cannot be read, or is gone.
    """
    alone = [path for path in files if path.suffix == ".zip"]
    others = [path for path in files if path not in alone]
    if len(others) == 1:
        alone, others = [*alone, *others], []
    for path in alone:
        content = b"" if is_over() else path.read_bytes()
        if not is_over():
            yield path.name, content
    if others:
        packed = _packed(others, is_over)
        if not is_over():
            yield ARCHIVE, packed


def _packed(files: list[Path], is_over: Callable[[], bool]) -> bytes:
    """Return files as one archive; not all of them once it ``is_over``."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in files:
            if not is_over():
                archive.write(path, path.name)
    return packed.getvalue()


def _in_words(error: OSError) -> str:
    name = Path(str(error.filename or "a file")).name
    if isinstance(error, FileNotFoundError):
        return (
            f"{name} of the last export was not sent: a newer export took its place. "
            "Export it again if you need both"
        )
    return f"{name}: cannot be sent, since it cannot be read: {error.strerror}. Export it again"
