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

STDOUT, STDERR = 1, 2
_NAMES = {STDOUT: "stdout", STDERR: "stderr"}
_lock = threading.RLock()
_logger = logging.getLogger(__name__)


@contextlib.contextmanager
def silenced(descriptor: int) -> Iterator[None]:
    """Send what C code writes to descriptor 1 or 2 to the debug log instead.

    What Python prints meanwhile, in this thread or another one, goes where it always went.
    """
    with _lock, contextlib.ExitStack() as stack, tempfile.TemporaryFile() as sink:
        _flush()
        kept = os.dup(descriptor)
        stack.callback(os.close, kept)
        stack.enter_context(_python_printing_to(kept, descriptor))
        os.dup2(sink.fileno(), descriptor)
        try:
            yield
        finally:
            _flush()
            os.dup2(kept, descriptor)
            sink.seek(0)
            said = sink.read().decode(errors="replace").strip()
    if said:
        _logger.debug("%s", said)


@contextlib.contextmanager
def _python_printing_to(kept: int, descriptor: int) -> Iterator[None]:
    """Let Python's stream, if it is the descriptor's and not a notebook's, write to ``kept``."""
    name = _NAMES[descriptor]
    stream = getattr(sys, name)
    try:
        belongs = stream.fileno() == descriptor
    except (AttributeError, io.UnsupportedOperation, ValueError):
        belongs = False
    if not belongs:
        yield
        return
    with open(os.dup(kept), "w", buffering=1, encoding=stream.encoding) as copy:
        setattr(sys, name, copy)
        try:
            yield
        finally:
            setattr(sys, name, stream)


def _flush() -> None:
    """Empty Python's and C's buffers: C keeps its own until exit if its output is a pipe."""
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            stream.flush()
    ctypes.CDLL(None).fflush(None)
