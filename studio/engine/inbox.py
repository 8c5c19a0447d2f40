"""A session's inbox: any thread puts commands in, the session takes them out in their order.

Joint targets of a program are no queue: the newest wins, joint by joint, as long as no other
command lies between them. So a flood of them costs nothing, and a Stop sent after one is after it.
"""

import threading
from collections import deque
from collections.abc import Callable

from studio.engine.commands import Command, SetJointTarget
from studio.engine.snapshot import Message

Answer = Callable[[Message | None], None]  # what the session said of a command, if anything


def nobody(_: Message | None) -> None:
    """Answer nobody."""


class Inbox:
    """See the module."""

    def __init__(self) -> None:
        self._posted: deque[tuple[Command, tuple[Answer, ...]]] = deque()
        self._lock = threading.Lock()

    def put(self, command: Command, answer: Answer = nobody) -> None:
        """Put a command in; ``answer`` is called once it has taken effect, on the session's thread.

        An answer to joint targets that newer ones replace is called once for all of them.
        """
        with self._lock:
            answers: tuple[Answer, ...] = (answer,)
            last, before = self._posted[-1] if self._posted else (None, ())
            if isinstance(last, SetJointTarget) and isinstance(command, SetJointTarget):
                self._posted.pop()
                command = last.followed_by(command)
                answers = before if answer in before else (*before, answer)
            self._posted.append((command, answers))

    def serve(
        self, take: Callable[[Command], None], newest: Callable[[], Message]
    ) -> list[Callable[[], None]]:
        """Have all commands taken; return what tells whoever asked what came of theirs.

        ``newest`` is the session's newest message.
        """
        answers: list[Callable[[], None]] = []
        while (posted := self._next()) is not None:
            command, waiting = posted
            before = newest()
            take(command)
            told = None if newest() is before else newest()
            answers += [_bound(answer, told) for answer in waiting if answer is not nobody]
        return answers

    def _next(self) -> tuple[Command, tuple[Answer, ...]] | None:
        with self._lock:
            return self._posted.popleft() if self._posted else None


def _bound(answer: Answer, told: Message | None) -> Callable[[], None]:
    return lambda: answer(told)
