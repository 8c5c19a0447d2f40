"""A program's message, read: or an error that names the place and the cure."""

import re
from typing import Any

import msgspec

from studio.engine.errors import StudioError
from studio.remote.asked import Asked
from studio.remote.message import Id

LARGEST_MESSAGE = 512 * 1024  # [bytes] a part of a file in base64, and room
CURE = "docs/remote.md lists all messages, docs/remote.schema.json describes them"
_DECODER = msgspec.json.Decoder(Asked)
_PLACED = re.compile(r"(?P<words>.*?)(?: - at `(?P<place>[^`]*)`)?", re.DOTALL)


class _WithId(msgspec.Struct):
    """What any message may have, whatever else is wrong with it."""

    id: Id | None = None


_IDS = msgspec.json.Decoder(_WithId)


class UnreadableError(StudioError):
    """A message that is none of those that there are."""

    def __init__(self, words: str, place: str = "", id: int | None = None) -> None:
        super().__init__(words)
        self.place, self.id = place, id


def read_message(text: str | bytes) -> Any:
    """Return the message, one of `Asked`.

    Raises
    ------
    UnreadableError
        Where it is none.
    """
    if isinstance(text, bytes):
        raise UnreadableError("messages are JSON in text frames, and this one was binary")
    try:
        return _DECODER.decode(text)
    except msgspec.ValidationError as error:
        found = _PLACED.fullmatch(str(error))
        words, place = (found["words"], found["place"] or "$") if found else (str(error), "$")
        raise UnreadableError(f"at {place}: {words}. {CURE}", place, _id_of(text)) from None
    except msgspec.DecodeError as error:
        raise UnreadableError(f"{error}: send one JSON object a message. {CURE}") from None
    except RecursionError:
        raise UnreadableError("JSON that is nested too deeply: no message is") from None


def _id_of(text: str) -> int | None:
    """Return the id of a message that could not be read, so that who asked is answered."""
    try:
        return _IDS.decode(text).id
    except (msgspec.MsgspecError, RecursionError):
        return None
