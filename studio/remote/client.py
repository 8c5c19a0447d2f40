"""The studio in a program's hands: V-REP's four ways of calling, typed.

with connect("ws://127.0.0.1:8766") as studio:
studio.do(commands.UseDemonstrator())                   # blocking: answered
studio.set_joint_target({"left_s0": 0.1})               # non-blocking: the newest wins
for state in studio.stream(JointStates, rate=10.0):    # streaming
...
with studio.clock() as clock:                           # synchronous
clock.step()
"""

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Literal, TypeVar

from studio.remote import asked, told
from studio.remote.arriving import is_there, not_there
from studio.remote.asked import PART, Asked
from studio.remote.commands import BeginDriving, Command, SetJointTarget
from studio.remote.errors import LateError, RemoteError
from studio.remote.files import Uploaded
from studio.remote.link import STREAMS, Frame, Link
from studio.remote.snapshot import Snapshot

_Answer = TypeVar("_Answer")
_Frame = TypeVar("_Frame", bound=Frame)
URL = "ws://127.0.0.1:8766"
TIMEOUT = 5.0  # [s]
_LOOK_EVERY = 0.05  # [s] whether something has come to pass
_SEND_EVERY = 1.0 / 30.0  # [s] a target, while it is waited for
_AT_ONCE = 5  # ticks between two looks


def connect(url: str = URL, token: str | None = None, timeout: float = TIMEOUT) -> "Studio":
    """Return the studio at an address; a context manager, which closes the connection.

    Parameters
    ----------
    url
        As `studio serve --remote` prints it.
    token
        What the studio wants to be shown, if anything.
    timeout
        How long [s] everything may take, unless it says otherwise.

    Raises
    ------
    UnreachableError
        Where there is no studio, or it does not let this program in.
    """
    return Studio(Link(url, token, timeout))


class Studio:
    """See the module.

    All methods raise LostError once the connection has ended; those that wait also RefusedError,
    where the studio says why it cannot be, and LateError.
    """

    def __init__(self, link: Link) -> None:
        self._link = link

    def __enter__(self) -> "Studio":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the connection; the studio lets go of whatever this program did."""
        self._link.close()

    @property
    def welcome(self) -> told.Welcome:
        """What the studio said first: the joints, in their order, and their limits."""
        return self._link.welcome

    @property
    def complaints(self) -> tuple[str, ...]:
        """What was wrong with messages that have no answer, the newest last."""
        return tuple(self._link.complaints)

    # Blocking.

    def do(self, command: Command, timeout: float | None = None) -> str:
        """Do what a panel's button does; return what the studio says once it took effect."""
        return self._ask(lambda n: asked.Do(command, n), told.Done, timeout).words

    def control(
        self, action: Literal["look", "ask", "hand_over", "keep", "let_go"] = "look"
    ) -> told.Role:
        """Look who controls, ask for control, hand it over to whoever asks, keep it, let go."""
        return self._ask(lambda n: asked.Control(n, action), told.Role)

    def take_control(self, timeout: float = 20.0) -> None:
        """Ask for control until it is given; without an answer of its holder in 15 s."""
        if not self.control("ask").controls:
            self._until(lambda: self.control().controls, timeout, "control")

    def snapshot(self) -> Snapshot:
        """Return everything that a panel may draw."""
        return self._ask(lambda n: asked.Get(n, "snapshot"), Snapshot)

    def joint_states(self) -> told.JointStates:
        """Return where all joints are."""
        return self._ask(lambda n: asked.Get(n, "joint_states"), told.JointStates)

    def gate(self) -> told.Gate:
        """Return whether the robot follows a person, or why not."""
        return self._ask(lambda n: asked.Get(n, "gate"), told.Gate)

    def block(self) -> told.Block:
        """Return where the blocks are, and whether the task's is down."""
        return self._ask(lambda n: asked.Get(n, "block"), told.Block)

    def lesson(self) -> told.Lesson:
        """Return what was learned, the network as its file has it."""
        return self._ask(lambda n: asked.Fetch(n, "lesson"), told.Lesson)

    def reproduction(self) -> told.Reproduction:
        """Return what Baxter did alone."""
        return self._ask(lambda n: asked.Fetch(n, "reproduction"), told.Reproduction)

    def equations(self) -> told.Equations:
        """Return all numbers of what was learned."""
        return self._ask(lambda n: asked.Fetch(n, "equations"), told.Equations)

    def field(self) -> told.Field:
        """Return the field that is shown."""
        return self._ask(lambda n: asked.Fetch(n, "field"), told.Field)

    def demonstration(self, number: int) -> told.Demonstration:
        """Return a listed demonstration."""
        return self._ask(lambda n: asked.FetchDemonstration(n, number), told.Demonstration)

    def upload(self, path: str | Path) -> Uploaded:
        """Send a file; commands then name it by what this returns."""
        content, name = Path(path).read_bytes(), Path(path).name
        upload: str | None = None
        for start in range(0, max(len(content), 1), PART):
            part, before = content[start : start + PART], upload
            upload = self._ask(
                lambda n: asked.Upload(n, part, name, before),  # noqa: B023 - called at once
                told.UploadTaken,
            ).upload
        return Uploaded(upload or "")

    def fetch_file(self, name: str) -> bytes:
        """Return a file of the newest export, by its name in the snapshot."""
        content = b""
        while True:
            offset = len(content)
            part = self._ask(
                lambda n: asked.FetchFile(n, name, offset),  # noqa: B023 - called at once
                told.FilePart,
            )
            content += part.content
            if not part.content or len(content) >= part.size:
                return content

    def wait_for(self, condition: Callable[[Snapshot], bool], timeout: float = 60.0) -> Snapshot:
        """Return the first snapshot that is as wanted."""
        found: list[Snapshot] = []

        def reached() -> bool:
            now = self.snapshot()
            found.append(now)
            return condition(now)

        self._until(reached, timeout, "what was waited for")
        return found[-1]

    def move_to(self, targets: Mapping[str, float], timeout: float = 20.0) -> told.JointStates:
        """Let joints go somewhere, slowly at first; return where all are once they are there.

        It begins to drive, also after a Stop. One that comes meanwhile ends it: RefusedError.
        Limits and collision guard may keep them from it: then LateError says so.
        """
        self.do(BeginDriving())
        end = time.monotonic() + timeout
        now = self.joint_states()
        while time.monotonic() < end:
            self.set_joint_target(targets)
            time.sleep(_SEND_EVERY)
            now = self.joint_states()
            if is_there(self._link, targets, now):
                return now
        raise LateError(not_there(self._link, now))

    # Non-blocking.

    def send(self, command: Command) -> None:
        """Do what a panel's button does, without waiting for an answer."""
        self._link.send(asked.Do(command))

    def set_joint_target(self, targets: Mapping[str, float], closed: bool | None = None) -> None:
        """Let joints [rad] go somewhere from the next tick on; the newest call wins.

        After a Stop, by anybody, that is refused (see `complaints`) until `move_to`, or
        ``do(commands.BeginDriving())``.
        """
        self._link.send(SetJointTarget(dict(targets), closed))

    # Streaming.

    def stream(
        self, kind: type[_Frame], rate: float = asked.FASTEST, timeout: float | None = None
    ) -> Iterator[_Frame]:
        """Subscribe at once; then yield what comes from then on, until the loop over it ends.

        Of each kind one stream is read at a time: the next one ends it, in words (LostError).
        ``kind`` is JointStates, Gate, Block or Snapshot, ``rate`` [Hz] of the session's time.
        """
        stream = STREAMS[kind]
        self._ask(lambda n: asked.Unsubscribe(n, stream), told.Done)  # so that no old frame comes
        frames = self._link.begin(stream)
        self._ask(lambda n: asked.Subscribe(n, stream, rate), told.Done)
        patience = self._link.timeout + 1.0 / rate if timeout is None else timeout

        def each() -> Iterator[_Frame]:
            try:
                while True:
                    frame = frames.next(patience)
                    if isinstance(frame, kind):
                        yield frame
            finally:
                if self._link.is_newest(stream, frames):
                    with suppress(RemoteError):
                        self._ask(lambda n: asked.Unsubscribe(n, stream), told.Done)

        return each()

    # Synchronous.

    @contextmanager
    def clock(self, patience: float = TIMEOUT) -> Iterator["Clock"]:
        """Take the clock: the world stands still between steps.

        Without a step for ``patience`` [s] it is lost.
        """
        first = self._ask(lambda n: asked.TakeClock(n, patience), told.Stepped)
        try:
            yield Clock(self, self._link, first)
        finally:
            with suppress(RemoteError):
                self._ask(asked.GiveClock, told.Done)

    def _ask(
        self, build: Callable[[int], Asked], kind: type[_Answer], timeout: float | None = None
    ) -> _Answer:
        return self._link.ask(build, kind, timeout)

    def _until(self, reached: Callable[[], bool], timeout: float, what: str) -> None:
        end = time.monotonic() + timeout
        while not reached():
            if time.monotonic() > end:
                raise LateError(f"{what} has not come in {timeout:g} s")
            time.sleep(_LOOK_EVERY)


class Clock:
    """The studio's clock, in a program's hand; ``now`` is the world as the last step left it."""

    def __init__(self, studio: Studio, link: Link, first: told.Stepped) -> None:
        self._studio, self._link = studio, link
        self.now = first

    def step(self, ticks: int = 1, timeout: float | None = None) -> told.Stepped:
        """Let ticks of 1/30 s pass, and return what they led to."""
        patience = self._link.timeout + ticks * 0.1 if timeout is None else timeout
        self.now = self._link.ask(lambda n: asked.Step(n, ticks), told.Stepped, patience)
        return self.now

    def move_to(self, targets: Mapping[str, float], most: int = 600) -> told.Stepped:
        """Let joints go somewhere as `Studio.move_to` does, in ``most`` ticks."""
        self._studio.do(BeginDriving())
        for _ in range(most):
            self._link.send(SetJointTarget(dict(targets)))
            if is_there(self._link, targets, self.step().state):
                return self.now
        raise LateError(not_there(self._link, self.now.state))

    def wait_for(self, condition: Callable[[Snapshot], bool], timeout: float = 60.0) -> Snapshot:
        """Step until everything is as wanted, and return the snapshot that is."""
        end = time.monotonic() + timeout  # what other processes do takes that time
        while not condition(now := self._studio.snapshot()):
            if time.monotonic() > end:
                raise LateError(f"what was waited for has not come in {timeout:g} s")
            self.step(_AT_ONCE)
        return now
