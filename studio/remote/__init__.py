"""The studio from outside: the messages of its WebSocket, and a client for Python programs.

    from studio.remote import commands, connect

    with connect("ws://127.0.0.1:8766") as studio:
        print(studio.do(commands.UseDemonstrator()))

It needs neither the engine nor the page. docs/remote.md is the guide.
"""

from studio.remote import commands
from studio.remote.client import Clock, Studio, connect
from studio.remote.errors import (
    LateError,
    LostError,
    RefusedError,
    RemoteError,
    UnreachableError,
)
from studio.remote.snapshot import Snapshot
from studio.remote.told import Block, Gate, JointStates

__all__ = [
    "Block",
    "Clock",
    "Gate",
    "JointStates",
    "LateError",
    "LostError",
    "RefusedError",
    "RemoteError",
    "Snapshot",
    "Studio",
    "UnreachableError",
    "commands",
    "connect",
]
