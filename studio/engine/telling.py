"""What a session tells people: one newest message, and errors in words instead of an end."""

from collections.abc import Callable

from studio.engine.errors import StudioError
from studio.engine.faults import Faults
from studio.engine.snapshot import Message


class Telling:
    """See the module; `message` is the newest one.

    Parameters
    ----------
    first
        The first message.
    hold
        Lets the robot hold still, whatever was half done.
    """

    def __init__(self, first: str, hold: Callable[[], None]) -> None:
        self.message = Message(0, first)
        self._hold, self._faults = hold, Faults()

    def say(self, text: str, is_error: bool = False) -> None:
        """Tell something; nothing is told by no words."""
        if text:
            self.message = Message(self.message.number + 1, text, is_error)

    def attempt(self, work: Callable[[], None]) -> bool:
        """Do some work, and tell whether it was done; an error becomes a message."""
        try:
            work()
        except (StudioError, OSError) as error:  # in a file or a request
            self.say(str(error), is_error=True)
            return False
        except Exception as fault:  # of ours: whatever was half done, the robot stops
            self.attempt(self._hold)
            self.say(self._faults.in_words(fault), is_error=True)
            return False
        return True
