"""The gate: the left hand's Lasso => Open => Closed starts control, and the screen says why not.

::

                Lasso              Open               Closed
    (nothing) --------> LASSO lit --------> OPEN lit --------> ARMED
        ^                   |                   |                 |
        +---- too slow, hand lost, body lost, another body, ------+
              a sign out of order                       Lasso held

Time decides, not frames, so that 15, 30 and 60 Hz give the same; times are compared in whole
nanoseconds, since the settings are multiples of 1/30 s and floats go wrong on half of them.
Unknown and NotTracked mean "hold what you knew", for a bounded time; they never mean Open.
"""

from dataclasses import dataclass, replace
from typing import Literal

from studio.engine.skeleton import HandState, Side, Skeleton

GateMode = Literal["sequence", "open"]
GATE_MODES: tuple[GateMode, GateMode] = ("sequence", "open")
SEQUENCE = (HandState.LASSO, HandState.OPEN, HandState.CLOSED)
UNSEEN = (HandState.UNKNOWN, HandState.NOT_TRACKED)
NOBODY = "nobody in sight"
NANOSECONDS = 1_000_000_000
LONGEST_SIGHT = NANOSECONDS // 10  # of a state between two frames: a stalled sensor saw nothing


@dataclass(frozen=True)
class GateStatus:
    """What the gate thinks after a frame, for the robot and for the screen."""

    armed: bool
    lit: int  # how many of SEQUENCE are believed, 0 to 3; 3 means armed
    reason: str  # why it is not armed, without numbers, so that frames can be counted by it
    detail: str  # the same for a person, with the time left
    state: HandState  # the hand's, in this frame
    held: float  # [s] for which the current state has been observed
    needed: float  # [s] for which it has to be


@dataclass(frozen=True)
class GateMemory:
    """What the gate knows; times in nanoseconds."""

    lit: int = 0
    candidate: HandState | None = None  # the state now seen, or seen last before the hand was lost
    held: int = 0  # observed time of the candidate
    spent: bool = False  # the candidate has disarmed the gate and does not count as a new sign
    last_state: HandState = HandState.UNKNOWN
    last_time: int = 0  # of the last frame with a body
    sight: int = 0  # when the last believed step was last seen
    lost_since: int | None = None  # start of the unbroken run of Unknown and NotTracked
    body_id: str | None = None
    why: str = ""  # what closed the gate last, for the screen


@dataclass(frozen=True)
class Gate:
    """Settings, in seconds (defaults tried on real recordings); `step` does the work."""

    mode: GateMode = "sequence"
    hand: Side = "left"
    believe_after: float = 0.3  # observed time after which a state is believed
    longest_gap: float = 0.8  # unbroken run of Unknown and NotTracked that is bridged
    longest_dwell: float = 2.0  # from the last sight of one step to the belief in the next
    hand_lost_after: float = 2.0  # the same run, while armed
    body_lost_after: float = 0.5
    lasso_disarms_after: float = 0.5

    def step(
        self, memory: GateMemory | None, skeleton: Skeleton | None, time: float
    ) -> tuple[GateMemory, GateStatus]:
        """Take the newest frame at ``time`` [s], or None where there is no new one.

        Reset is ``memory = None``. The returned status is a refusal in words unless it is armed.
        """
        now = round(time * NANOSECONDS)
        memory = memory or GateMemory(last_time=now)
        if skeleton is not None and memory.body_id not in (None, skeleton.body_id):
            memory = GateMemory(last_time=now, why="another person took over")
        unseen = now - memory.last_time  # also where a stream leaves out frames with nobody in them
        if unseen > _ns(self.body_lost_after) and memory.body_id is not None:
            memory = GateMemory(last_time=now, why=NOBODY)
        if skeleton is None:
            return memory, self._status(memory, now)
        memory = self._observe(memory, skeleton, now)
        if self.mode == "sequence":
            memory = self._disarm(memory, now) if memory.lit == len(SEQUENCE) else memory
            memory = self._follow(memory, now) if memory.lit < len(SEQUENCE) else memory
        return memory, self._status(memory, now)

    def _observe(self, memory: GateMemory, skeleton: Skeleton, now: int) -> GateMemory:
        """Take note of the hand's state and of how long it has been seen."""
        state, before = skeleton.hand(self.hand).state, memory
        memory = replace(memory, last_state=state, last_time=now, body_id=skeleton.body_id)
        if state in UNSEEN:
            since = now if memory.lost_since is None else memory.lost_since
            return replace(memory, lost_since=since)
        if state is not memory.candidate:
            held, spent = 0, False
        else:
            in_sight = min(now - before.last_time, LONGEST_SIGHT)
            held = memory.held + (in_sight if before.last_state is state else 0)
            spent = memory.spent
        lost = memory.lost_since
        if lost is not None and memory.lit < len(SEQUENCE) and now - lost > _ns(self.longest_gap):
            memory, held = _closed(memory, "the hand was lost for too long"), 0
        sight = now if memory.lit and state is SEQUENCE[memory.lit - 1] else memory.sight
        return replace(
            memory, candidate=state, held=held, spent=spent, sight=sight, lost_since=None
        )

    def _disarm(self, memory: GateMemory, now: int) -> GateMemory:
        """Close an armed gate where the hand says so or has been lost."""
        lost = memory.lost_since
        if lost is not None and now - lost > _ns(self.hand_lost_after):
            return _closed(memory, "the hand was lost for too long")
        lasso = memory.candidate is HandState.LASSO and lost is None
        if lasso and memory.held >= _ns(self.lasso_disarms_after):
            return replace(_closed(memory, "Lasso held: disarmed"), spent=True)
        return memory

    def _follow(self, memory: GateMemory, now: int) -> GateMemory:
        """Advance along the sequence, or fall back from it."""
        lost = memory.lost_since
        if lost is not None and now - lost > _ns(self.longest_gap):
            return replace(
                _closed(memory, "the hand was lost for too long"), candidate=None, held=0
            )
        if memory.lit and now - memory.sight > _ns(self.longest_dwell):
            memory = _closed(memory, "the next sign came too late")
        believed = memory.held >= _ns(self.believe_after) and not memory.spent and lost is None
        if not believed or (memory.lit and memory.candidate is SEQUENCE[memory.lit - 1]):
            return memory
        if memory.candidate is SEQUENCE[memory.lit]:
            return replace(memory, lit=memory.lit + 1, sight=now, why="")
        if memory.candidate is SEQUENCE[0]:
            return replace(memory, lit=1, sight=now, why="")
        return _closed(memory, "a sign out of order") if memory.lit else memory

    def _status(self, memory: GateMemory, now: int) -> GateStatus:
        if self.mode == "open":
            lit = len(SEQUENCE) if memory.body_id is not None else 0
            reason = "" if lit else memory.why or NOBODY
            return GateStatus(bool(lit), lit, reason, reason, memory.last_state, 0.0, 0.0)
        armed = memory.lit == len(SEQUENCE)
        hand = f"{self.hand} hand"
        needed = self.lasso_disarms_after if armed else self.believe_after
        held = memory.held / NANOSECONDS
        if armed:
            reason, detail = "", "armed: hold Lasso to disarm"
        elif memory.body_id is None:
            reason = detail = NOBODY
        else:
            awaited = SEQUENCE[memory.lit]
            reason = f"waiting for {awaited.value.capitalize()} of the {hand}"
            detail = reason if not memory.why else f"{memory.why}; {reason}"
            if memory.lost_since is not None:
                detail = (
                    f"{hand} unseen for {(now - memory.lost_since) / NANOSECONDS:.1f} s; {reason}"
                )
            elif memory.candidate is awaited and not memory.spent:
                detail = f"hold {awaited.value.upper()} {max(needed - held, 0.0):.1f} s more"
        return GateStatus(armed, memory.lit, reason, detail, memory.last_state, held, needed)


def _closed(memory: GateMemory, why: str) -> GateMemory:
    return replace(memory, lit=0, why=why)


def _ns(seconds: float) -> int:
    return round(seconds * NANOSECONDS)
