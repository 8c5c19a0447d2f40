"""The gripper: a person's hand, closed for a while, closes it, and open opens it.

The sign is believed after the same observed time as the gate's (`studio.engine.signs`), so that a
flicker does nothing. Unknown, NotTracked and Lasso hold what was; so does a gate that is closed. A
sign that is interrupted for longer than the gate would bridge begins anew.
"""

from dataclasses import dataclass, field

from studio.engine.signs import HandMemory, lasts, nanoseconds
from studio.engine.skeleton import HandState, Side, Skeleton


@dataclass(frozen=True)
class GripMemory:
    """What is known of the hand, and what the gripper does."""

    hand: HandMemory = field(default_factory=HandMemory)
    closed: bool = False


@dataclass(frozen=True)
class Gripper:
    """Settings; `step` does the work."""

    hand: Side = "right"  # the left one signs to the gate
    believe_after: float = 0.3  # [s] of observed time
    longest_gap: float = 0.8  # [s] without a sign, or without any frame, that is bridged
    minimum_confidence: float = 0.5  # below it a state counts as Unknown

    def step(
        self, memory: GripMemory, skeleton: Skeleton | None, armed: bool, time: float
    ) -> GripMemory:
        """Take the newest frame at ``time`` [s], or None where none is new."""
        if not armed:
            return GripMemory(closed=memory.closed)
        if skeleton is None:
            return memory
        now, seen = nanoseconds(time), skeleton.hand(self.hand)
        sure = seen.confidence >= self.minimum_confidence
        hand = self._bridged(memory.hand, now)
        closed = self._believed(hand, now, memory.closed)
        state = seen.state if sure else HandState.UNKNOWN
        return GripMemory(hand.showing(state, seen.confidence, now), closed)

    def _bridged(self, hand: HandMemory, now: int) -> HandMemory:
        """Return what still holds of the hand when another frame comes now."""
        longest = nanoseconds(self.longest_gap)
        return HandMemory() if now - hand.time > longest else hand.forgotten(now, longest)

    def _believed(self, hand: HandMemory, now: int, closed: bool) -> bool:
        """Return what the gripper does, now that the newest sign has lasted until ``now``."""
        is_sign = hand.sign in (HandState.OPEN, HandState.CLOSED)
        if is_sign and lasts(hand.held_by(now), nanoseconds(self.believe_after)):
            return hand.sign is HandState.CLOSED
        return closed
