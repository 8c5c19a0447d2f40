"""What the gate says: why it is not armed, what to do about it, and how much time is left."""

from dataclasses import dataclass

from studio.engine.gate_machine import SEQUENCE, Event, Phase
from studio.engine.skeleton import HandState, Side

NOBODY = "nobody in sight"
WHY = {  # why the gate fell back
    Event.BODY_LOST: "nobody was in sight",
    Event.OTHER_BODY: "another person took over",
    Event.HAND_LOST: "the hand was lost for too long",
    Event.TOO_LATE: "the next sign came too late",
    Event.CLOSED: "Closed came instead of Open",
    Event.LASSO_HELD: "Lasso held: disarmed",
}


@dataclass(frozen=True)
class Situation:
    """What a status is put into words from; times in seconds."""

    phase: Phase
    open: bool  # no signs are asked for
    hand: Side
    why: str  # what made the gate fall back last
    body_missing: float  # for how long nobody has been seen; 0 where somebody is
    hand_lost: float  # for how long no sign has been seen; 0 where one is
    unsure: bool  # a sign may be seen, but the source is not sure of it
    to_hold: float  # for how long the sign that is shown has to be held yet; 0: none is awaited
    left: float | None  # until the gate falls back if nothing changes; None where no clock runs


def reason_of(now: Situation) -> str:
    """Return why the gate is not armed, without numbers, so that frames can be counted by it."""
    if now.phase is Phase.ARMED:
        return ""
    if now.phase is Phase.NOBODY:
        other = WHY[Event.OTHER_BODY]
        return other if now.why == other else NOBODY
    return f"waiting for {_named(SEQUENCE[now.phase.lit])} of the {now.hand} hand"


def detail_of(now: Situation) -> str:
    """Return the same for a person: what is wrong, what to do, and the time left."""
    if now.phase is Phase.NOBODY:
        return reason_of(now)
    missing = _missing(now)
    if now.phase is Phase.ARMED:
        return _armed(now, missing)
    awaited, trouble = SEQUENCE[now.phase.lit], missing or now.why
    if now.to_hold and not missing:
        demand = f"hold {awaited.value.upper()} {now.to_hold:.1f} s more"
    else:  # short where there is more to say, for the page's narrow column
        demand = f"waiting for {_named(awaited)}" if trouble else reason_of(now)
    left = "" if now.left is None else f"{now.left:.1f} s left"
    return "; ".join(part for part in (trouble, demand, left) if part)


def _armed(now: Situation, missing: str) -> str:
    if now.left is not None:
        return f"armed: {missing or 'Lasso is held'}; disarms in {now.left:.1f} s"
    return "the gate stands open" if now.open else "armed: hold Lasso to disarm"


def _missing(now: Situation) -> str:
    """Return what is not seen, if anything."""
    if now.body_missing > 0.0:
        return f"{NOBODY} for {now.body_missing:.1f} s"
    if now.hand_lost > 0.0 and not now.open:
        unseen = "uncertain" if now.unsure else "unseen"
        return f"{now.hand} hand {unseen} for {now.hand_lost:.1f} s"
    return ""


def _named(sign: HandState) -> str:
    return sign.value.capitalize()
