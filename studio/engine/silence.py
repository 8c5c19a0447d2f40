"""Keep a C library's chatter off standard output, which belongs to what a command prints."""

import contextlib
import ctypes
import io
import logging
import os
import sys
import tempfile
import threading
from collections.abc import Iterator
from typing import IO, cast

_STDOUT = 1
_lock = threading.RLock()
_logger = logging.getLogger(__name__)


@contextlib.contextmanager
def silenced_stdout() -> Iterator[None]:
    """Send what C code writes to descriptor 1 to the debug log instead.

    What Python prints meanwhile, in this thread or another one, goes where it always went.
    """
    with _lock, contextlib.ExitStack() as stack, tempfile.TemporaryFile() as sink:
        _flush()
        kept = os.dup(_STDOUT)
        stack.callback(os.close, kept)
        if _prints_to_stdout():
            copy = stack.enter_context(open(os.dup(kept), "w", buffering=1, encoding="utf-8"))
            stack.enter_context(contextlib.redirect_stdout(copy))
        os.dup2(sink.fileno(), _STDOUT)
        try:
            yield
        finally:
            _flush()
            os.dup2(kept, _STDOUT)
            sink.seek(0)
            if said := sink.read().decode(errors="replace").strip():
                _logger.debug("%s", said)


def _prints_to_stdout() -> bool:
    """Tell whether Python's standard output is descriptor 1, not a notebook's or a test's."""
    try:
        return sys.stdout.fileno() == _STDOUT
    except (AttributeError, io.UnsupportedOperation, ValueError):
        return False


def _flush() -> None:
    """Empty Python's and C's buffers: C keeps its own until exit if its output is a pipe."""
    if sys.stdout is not None:
        cast(IO[str], sys.stdout).flush()
    ctypes.CDLL(None).fflush(None)
