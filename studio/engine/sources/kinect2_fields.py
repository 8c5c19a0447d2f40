"""What the JSON formats of Kinect programs have in common: ids, hand states, empty seats."""

from collections.abc import Collection

from studio.engine.errors import StudioError
from studio.engine.skeleton import Hand, HandState
from studio.engine.sources.family import check_body_id, shown

HAND_KEYS = ("leftHandState", "rightHandState")
_WORDS = {state.value.replace("_", ""): state for state in HandState}  # "nottracked"


def is_person(body: dict[str, object]) -> bool:
    """Return whether a body is somebody; a sensor with six seats also tells of the empty ones."""
    return body.get("tracked", True) not in (False, 0)


def hand_of(body: dict[str, object], key: str) -> Hand:
    """Return a hand whose state is the SDK's number or a lower-case word; unknown where absent.

    Raises
    ------
    StudioError
        Where the state is neither; the message names the key.
    """
    state = body.get(key, 0)
    if isinstance(state, str) and state in _WORDS:
        return Hand(_WORDS[state])
    if isinstance(state, int):
        try:
            return Hand(HandState.from_number(state))
        except ValueError:
            pass  # the message below names the key as well
    raise StudioError(
        f'expected "{key}" as 0 to {len(HandState) - 1} or one of {", ".join(_WORDS)}, '
        f"found {shown(state)}"
    )


def body_id_of(value: object, key: str) -> str:
    """Return a body's id; raise StudioError where it is neither a whole number nor a short text."""
    if isinstance(value, bool) or not isinstance(value, int | str):
        raise StudioError(f'expected "{key}" as a whole number or text, found {shown(value)}')
    body_id = str(value)
    check_body_id(body_id)
    return body_id


def check_new(body_id: str, seen: Collection[str]) -> None:
    """Raise StudioError where a frame has told of this body already."""
    if body_id in seen:
        raise StudioError(f"expected each id once in a frame, found {body_id} twice")
