"""Whose click is heard: viser's threads, each of which knows the browser that it works for.

All browsers share one set of controls, so that whoever reloads finds them as they were. viser tells
a callback in its event which browser it was. Panels need not care: they post commands, and who
asks is known here, wherever on its thread a command is posted.
"""

import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any, TypeVar

import viser

_Result = TypeVar("_Result")
_THREADS = 32  # as many as viser has
_heard = threading.local()


class _Hearing(ThreadPoolExecutor):
    """Threads on which `speaker` tells for whom they work."""

    def submit(self, fn: Callable[..., _Result], /, *args: Any, **kwargs: Any) -> "Future[_Result]":
        """Do something with an event, a drag or a client, on a thread."""
        client = getattr(args[0], "client_id", None) if args else None
        return super().submit(_for, client, fn, *args, **kwargs)


def hear(server: viser.ViserServer) -> None:
    """Let `speaker` tell, in all callbacks of a server's controls and scene, whose they are."""
    # viser has no other way in; where a later one renames this, nobody is told apart, and all act.
    threads = _Hearing(_THREADS)
    for owner in (server, server.gui, server.scene):
        owner._thread_executor = threads


def speaker() -> int | None:
    """Return the browser that this thread works for; None where it works for none."""
    client: int | None = getattr(_heard, "client", None)
    return client


@contextmanager
def heard_as(client: int | None) -> Iterator[None]:
    """Let `speaker` tell on this thread whom it works for; for callbacks on viser's own loop."""
    _heard.client = client
    try:
        yield
    finally:
        _heard.client = None


def _for(client: int | None, fn: Callable[..., _Result], *args: Any, **kwargs: Any) -> _Result:
    with heard_as(client):
        return fn(*args, **kwargs)
