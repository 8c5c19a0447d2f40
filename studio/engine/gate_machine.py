"""The gate's states and what leads from one to the next.

::

              body seen          Lasso            Open            Closed
    NOBODY ------------> WAITING -----> LASSO_SEEN -----> OPEN_SEEN -----> ARMED
      ^                  ^  ^  ^           |  ^             |    |          |
      |                  |  |  |           |  +--- Lasso ---+    |          |
      |                  |  |  +-- Closed, hand lost, too late   |          |
      |                  |  +------------- hand lost, too late --+          |
      |                  +------------------------- hand lost, Lasso held --+
      +--- body lost, another body: from every state

Whatever the diagram does not show changes nothing. With the mode "open" nobody has to sign: a body
in sight arms, its leaving and another body disarm. Stop is the beginning anew: NOBODY.
"""

from enum import Enum, auto
from typing import Literal

from studio.engine.skeleton import HandState

GateMode = Literal["sequence", "open"]
GATE_MODES: tuple[GateMode, GateMode] = ("sequence", "open")
SEQUENCE = (HandState.LASSO, HandState.OPEN, HandState.CLOSED)


class Phase(Enum):
    """Where the gate stands."""

    NOBODY = -1
    WAITING = 0
    LASSO_SEEN = 1
    OPEN_SEEN = 2
    ARMED = 3

    @property
    def lit(self) -> int:
        """How many signs of SEQUENCE are believed."""
        return max(self.value, 0)


class Event(Enum):
    """What can happen to the gate; a sign happens when it is believed."""

    BODY_SEEN = auto()
    BODY_LOST = auto()
    OTHER_BODY = auto()
    HAND_LOST = auto()
    TOO_LATE = auto()
    LASSO = auto()
    OPEN = auto()
    CLOSED = auto()
    LASSO_HELD = auto()


SIGN_EVENTS = {
    HandState.LASSO: Event.LASSO,
    HandState.OPEN: Event.OPEN,
    HandState.CLOSED: Event.CLOSED,
}
_BODY_GONE = {
    (phase, event): Phase.NOBODY
    for phase in (Phase.WAITING, Phase.LASSO_SEEN, Phase.OPEN_SEEN, Phase.ARMED)
    for event in (Event.BODY_LOST, Event.OTHER_BODY)
}
TRANSITIONS: dict[GateMode, dict[tuple[Phase, Event], Phase]] = {
    "sequence": {
        (Phase.NOBODY, Event.BODY_SEEN): Phase.WAITING,
        (Phase.WAITING, Event.LASSO): Phase.LASSO_SEEN,
        (Phase.LASSO_SEEN, Event.OPEN): Phase.OPEN_SEEN,
        (Phase.LASSO_SEEN, Event.CLOSED): Phase.WAITING,
        (Phase.LASSO_SEEN, Event.HAND_LOST): Phase.WAITING,
        (Phase.LASSO_SEEN, Event.TOO_LATE): Phase.WAITING,
        (Phase.OPEN_SEEN, Event.CLOSED): Phase.ARMED,
        (Phase.OPEN_SEEN, Event.LASSO): Phase.LASSO_SEEN,
        (Phase.OPEN_SEEN, Event.HAND_LOST): Phase.WAITING,
        (Phase.OPEN_SEEN, Event.TOO_LATE): Phase.WAITING,
        (Phase.ARMED, Event.HAND_LOST): Phase.WAITING,
        (Phase.ARMED, Event.LASSO_HELD): Phase.WAITING,
        **_BODY_GONE,
    },
    "open": {
        (Phase.NOBODY, Event.BODY_SEEN): Phase.ARMED,
        (Phase.ARMED, Event.BODY_LOST): Phase.NOBODY,
        (Phase.ARMED, Event.OTHER_BODY): Phase.NOBODY,
    },
}


def transition(mode: GateMode, phase: Phase, event: Event) -> Phase:
    """Return where an event leads: the gate's one transition function."""
    return TRANSITIONS[mode].get((phase, event), phase)
