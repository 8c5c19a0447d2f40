"""What can go wrong for a program, as one small tree.

RemoteError
├── UnreachableError  no studio there, or it does not let this program in
├── LostError         the connection has ended
├── LateError         no answer in time
└── RefusedError      the studio says why it cannot be; ``place`` is where in the message
"""


class RemoteError(Exception):
    """Base of all errors of the client."""


class UnreachableError(RemoteError):
    """There is no studio at that address, or it does not let this program in."""


class LostError(RemoteError):
    """The connection has ended; the studio has let go of whatever this program did."""


class LateError(RemoteError):
    """What was waited for has not come in time."""


class RefusedError(RemoteError):
    """What was asked cannot be."""

    def __init__(self, words: str, place: str = "") -> None:
        super().__init__(words)
        self.place = place
