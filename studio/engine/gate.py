"""The gate: the left hand's Lasso => Open => Closed starts control, and the screen says why not.

Its states and transitions are drawn in `studio.engine.gate_machine`; here is what makes them
happen: time, and not frames, so that 15, 30 and 60 Hz give the same (`studio.engine.signs`). A sign
is believed once it has been observed for ``believe_after``. It is too late when the next one is not
believed ``longest_dwell`` after the last sight of the one before. The hand is lost after an
unbroken run of Unknown and NotTracked, to which a state belongs that the source is not sure of.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from studio.engine.errors import StudioError
from studio.engine.gate_machine import (
    GATE_MODES,
    SEQUENCE,
    SIGN_EVENTS,
    Event,
    GateMode,
    Phase,
    transition,
)
from studio.engine.gate_words import NOBODY, WHY, Situation, detail_of, reason_of
from studio.engine.identity import is_another
from studio.engine.signs import (
    LONGEST_SIGHT,
    NANOSECONDS,
    UNSEEN,
    HandMemory,
    nanoseconds,
    reaches,
)
from studio.engine.skeleton import HandState, Side, Skeleton

__all__ = [
    "GATE_MODES",
    "NOBODY",
    "SEQUENCE",
    "UNSEEN",
    "Gate",
    "GateMemory",
    "GateMode",
    "GateStatus",
]
_AWAITED = {
    Phase.WAITING: HandState.LASSO,
    Phase.LASSO_SEEN: HandState.OPEN,
    Phase.OPEN_SEEN: HandState.CLOSED,
    Phase.ARMED: HandState.LASSO,  # held, it disarms
}
_BELIEVED = {Phase.LASSO_SEEN: HandState.LASSO, Phase.OPEN_SEEN: HandState.OPEN}


@dataclass(frozen=True)
class GateStatus:
    """What the gate thinks after a frame, for the robot and for the screen."""

    armed: bool
    lit: int  # how many of SEQUENCE are believed, 0 to 3; 3 means armed
    reason: str  # why it is not armed, without numbers, so that frames can be counted by it
    detail: str  # the same for a person, with the time left
    state: HandState  # the hand's, in the newest frame; UNKNOWN where the source is not sure of it
    held: float  # [s] for which the awaited sign has been observed; armed: Lasso, which disarms
    needed: float  # [s] for which it has to be
    confidence: float = 1.0  # of the hand's state, as the source tells it
    left: float | None = None  # [s] until the gate falls back if nothing changes


@dataclass(frozen=True)
class GateMemory:
    """What the gate knows."""

    phase: Phase = Phase.NOBODY
    seen: Skeleton | None = None  # the newest frame of the body
    hand: HandMemory = field(default_factory=HandMemory)
    sight: int = 0  # [ns] until when the newest believed sign has been seen
    why: str = ""  # what made the gate fall back last


@dataclass(frozen=True)
class Gate:
    """Settings, in seconds (defaults tried on real recordings); `step` does the work.

    Raises
    ------
    StudioError
        Where a setting is no time, or a gap could outlast the dwell.
    """

    mode: GateMode = "sequence"
    hand: Side = "left"
    believe_after: float = 0.3  # observed time after which a sign is believed
    longest_gap: float = 0.8  # unbroken run of Unknown and NotTracked that is bridged
    longest_dwell: float = 2.0  # from the last sight of one step to the belief in the next
    hand_lost_after: float = 2.0  # the same run, while armed
    body_lost_after: float = 0.5
    lasso_disarms_after: float = 0.5
    # Below it a state counts as Unknown. Kinects tell no confidence, so theirs is 1; NTU's is 0 for
    # a hand that is not tracked; a tracker of images tells how sure it is.
    minimum_confidence: float = 0.5

    def __post_init__(self) -> None:
        before_arming = (self.believe_after, self.longest_gap, self.longest_dwell)
        armed = (self.hand_lost_after, self.body_lost_after, self.lasso_disarms_after)
        if not all(time > 0.0 for time in (*before_arming, *armed)):
            raise StudioError(f"a gate's times are above zero, not as in {self}")
        if not self.longest_gap < self.longest_dwell:
            raise StudioError("a gate's longest gap must be shorter than its longest dwell")

    def step(
        self, memory: GateMemory | None, skeleton: Skeleton | None, time: float
    ) -> tuple[GateMemory, GateStatus]:
        """Take the newest frame at ``time`` [s], or None where there is no new one.

        Reset is ``memory = None``. The returned status is a refusal in words unless it is armed.
        """
        now = nanoseconds(time)
        memory = self.remember(memory, skeleton, now)
        return memory, self._status(memory, now)

    def remember(
        self, memory: GateMemory | None, skeleton: Skeleton | None, now: int
    ) -> GateMemory:
        """Return what the gate knows after a frame at ``now`` [ns]; `step` without the words."""
        memory = self._pass_time(memory or GateMemory(), now)
        if skeleton is None:
            return memory
        if memory.seen is None or not is_another(memory.seen, skeleton):
            return self._observe(memory, skeleton, now)
        # Who takes over begins with the next frame, so that the robot is let go once.
        return self._take(memory, Event.OTHER_BODY)

    def _take(self, memory: GateMemory, event: Event) -> GateMemory:
        """Go where an event leads, and remember why if that is backwards."""
        phase = transition(self.mode, memory.phase, event)
        if phase is memory.phase:
            return memory
        if phase is Phase.NOBODY:
            return GateMemory(why=WHY[event])
        return replace(memory, phase=phase, why=WHY[event] if phase is Phase.WAITING else "")

    def _pass_time(self, memory: GateMemory, now: int) -> GateMemory:
        """Fall back where something has been missing for too long."""
        if memory.phase is Phase.NOBODY:
            return memory
        if now - memory.hand.time > nanoseconds(self.body_lost_after):
            return self._take(memory, Event.BODY_LOST)
        if memory.hand.lost_for(now) > nanoseconds(self._bridged(memory.phase)):
            memory = self._take(memory, Event.HAND_LOST)
        if now - self._sight(memory, now) > nanoseconds(self.longest_dwell):
            memory = self._take(memory, Event.TOO_LATE)
        hand = memory.hand.forgotten(now, nanoseconds(self.longest_gap))
        return memory if hand is memory.hand else replace(memory, hand=hand)

    def _observe(self, memory: GateMemory, skeleton: Skeleton, now: int) -> GateMemory:
        """Take note of a frame; the signs that its coming makes believed are events."""
        if memory.phase is Phase.NOBODY:
            phase = transition(self.mode, memory.phase, Event.BODY_SEEN)
            memory = GateMemory(phase, skeleton, HandMemory(now), why=memory.why)
        for event in self._events(memory.hand, now):
            memory = self._take(memory, event)
        seen = skeleton.hand(self.hand)
        state = seen.state if seen.confidence >= self.minimum_confidence else HandState.UNKNOWN
        hand = memory.hand.showing(state, seen.confidence, now)
        sight = self._sight(memory, now)
        return GateMemory(memory.phase, skeleton, hand, sight, memory.why)

    def _events(self, hand: HandMemory, now: int) -> Iterator[Event]:
        """Yield what the hold of the hand's sign amounts to when another frame comes now."""
        held = hand.held_by(now)
        if hand.sign is None or held == hand.held:
            return
        if reaches(hand.held, held, nanoseconds(self.believe_after)):
            yield SIGN_EVENTS[hand.sign]
        disarm = nanoseconds(self.lasso_disarms_after)
        if hand.sign is HandState.LASSO and reaches(hand.held, held, disarm):
            yield Event.LASSO_HELD

    def _sight(self, memory: GateMemory, now: int) -> int:
        """Return until when [ns] the newest believed sign has been seen; now where none waits."""
        believed = _BELIEVED.get(memory.phase)
        if believed is None:
            return now
        return memory.hand.seen_until(now) if memory.hand.state is believed else memory.sight

    def _bridged(self, phase: Phase) -> float:
        """Return for how long [s] the hand may be lost."""
        return self.hand_lost_after if phase is Phase.ARMED else self.longest_gap

    def _status(self, memory: GateMemory, now: int) -> GateStatus:
        hand, phase = memory.hand, memory.phase
        armed = phase is Phase.ARMED
        needed = self.lasso_disarms_after if armed else self.believe_after
        held = hand.held / NANOSECONDS if hand.sign is _AWAITED.get(phase) else 0.0
        if not armed and held >= needed:  # the Lasso that disarmed is no new sign
            held = 0.0
        missing = 0 if phase is Phase.NOBODY else now - hand.time
        situation = Situation(
            phase=phase,
            open=self.mode == "open",
            hand=self.hand,
            why=memory.why,
            body_missing=missing / NANOSECONDS if missing > LONGEST_SIGHT else 0.0,
            hand_lost=hand.lost_for(now) / NANOSECONDS,
            unsure=hand.confidence < self.minimum_confidence,
            to_hold=needed - held if held else 0.0,
            left=self._left(memory, now),
        )
        return GateStatus(
            armed=armed,
            lit=phase.lit,
            reason=reason_of(situation),
            detail=detail_of(situation),
            state=hand.state,
            held=held,
            needed=needed,
            confidence=hand.confidence,
            left=situation.left,
        )

    def _left(self, memory: GateMemory, now: int) -> float | None:
        """Return the time [s] until the gate falls back if nothing changes; None for no end."""
        hand, phase = memory.hand, memory.phase
        left: list[float] = []
        if phase is not Phase.NOBODY and now - hand.time > LONGEST_SIGHT:
            left.append(self.body_lost_after - (now - hand.time) / NANOSECONDS)
        if self.mode == "sequence" and hand.lost_for(now) and phase is not Phase.WAITING:
            left.append(self._bridged(phase) - hand.lost_for(now) / NANOSECONDS)
        if now > self._sight(memory, now):
            left.append(self.longest_dwell - (now - self._sight(memory, now)) / NANOSECONDS)
        if self.mode == "sequence" and phase is Phase.ARMED and hand.state is HandState.LASSO:
            left.append(self.lasso_disarms_after - hand.held / NANOSECONDS)
        return max(min(left), 0.0) if left else None
