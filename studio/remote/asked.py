"""What a program sends. All but joint targets may have an ``id``, which the answer repeats."""

from typing import Annotated, Literal

import msgspec

from studio.remote.commands import Command, SetJointTarget
from studio.remote.message import Id, Message, Text

FASTEST = 30.0  # [Hz] of a stream: the studio's ticks
SLOWEST = 0.01  # [Hz]
MOST_TICKS = 3000  # of one request: 100 s
PART = 256 * 1024  # [bytes] of a file in one message, at most

Stream = Literal["joint_states", "gate", "block", "snapshot"]
Rate = Annotated[float, msgspec.Meta(ge=SLOWEST, le=FASTEST)]
Ticks = Annotated[int, msgspec.Meta(ge=1, le=MOST_TICKS)]
Patience = Annotated[float, msgspec.Meta(ge=0.1, le=600.0)]
Index = Annotated[int, msgspec.Meta(ge=0, le=2**53 - 1)]


class Do(Message, frozen=True):
    """Do what a panel's button does. With an ``id`` it is answered once that took effect."""

    command: Command
    id: Id | None = None


class Get(Message, frozen=True):
    """Read something now: the answer is what the stream of that name sends."""

    id: Id
    what: Stream


class Subscribe(Message, frozen=True):
    """Send a stream from now on. Of what is not read in time the newest is kept."""

    id: Id
    stream: Stream
    rate: Rate = FASTEST  # [Hz] of the session's time, on average and at most


class Unsubscribe(Message, frozen=True):
    """Send a stream no more."""

    id: Id
    stream: Stream


class Control(Message, frozen=True):
    """Ask for control, hand it over to whoever asks, keep it, or let go of it."""

    id: Id
    action: Literal["look", "ask", "hand_over", "keep", "let_go"] = "look"


class TakeClock(Message, frozen=True):
    """Let the world stand still between steps. The answer comes once it does.

    Without a step for ``patience`` [s] the clock goes back.
    """

    id: Id
    patience: Patience = 5.0


class Step(Message, frozen=True):
    """Let ticks of 1/30 s pass; answered when they have."""

    id: Id
    ticks: Ticks = 1


class GiveClock(Message, frozen=True):
    """Let time go on by itself."""

    id: Id


class Fetch(Message, frozen=True):
    """Read something large that was learned; see the answers of these names."""

    id: Id
    what: Literal["lesson", "reproduction", "equations", "field"]


class FetchDemonstration(Message, frozen=True):
    """Read a listed demonstration whole."""

    id: Id
    number: int


class FetchFile(Message, frozen=True):
    """Read a part of a file that the newest export has written, from ``offset`` on."""

    id: Id
    name: Text  # as the snapshot's export lists it
    offset: Index = 0  # [bytes]


class Upload(Message, frozen=True):
    """Send a file, part by part; commands then name it by what the answers say."""

    id: Id
    content: Annotated[bytes, msgspec.Meta(max_length=PART)]  # in base64
    name: Text = ""  # as people know it; of the first part
    upload: Text | None = None  # of the parts after the first: what the answer to that one said


Asked = (
    Do
    | SetJointTarget
    | Get
    | Subscribe
    | Unsubscribe
    | Control
    | TakeClock
    | Step
    | GiveClock
    | Fetch
    | FetchDemonstration
    | FetchFile
    | Upload
)
