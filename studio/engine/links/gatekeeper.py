"""The one door: every command to a robot is made here, and by nothing else.

No command is made unless the robot was enabled by a person here, is enabled as it says itself,
was heard within `STALE`, has no emergency stop, and either

- a person has confirmed the first move, and it is on its slow way to the start pose, or
- it has come there, and the gate is armed or a motion plays (`wanted.Wanted.permitted`), and what
  is wanted is near where the robot is, and has not jumped since the last tick.

Whatever is made keeps the position limits, a share of the velocity limits, and the collision
guard. A lost connection, an emergency stop, a robot that is disabled, turns the other way or
does not come along: then nothing is sent, and people have to enable *and* confirm anew. All of
it is memory in, memory out; no clock, no network.
"""

from dataclasses import replace

import numpy as np

from studio.engine.links.consent import stop
from studio.engine.links.driver import STALE
from studio.engine.links.link import RobotState
from studio.engine.links.memory import Memory, Outcome, Seen
from studio.engine.links.status import Phase
from studio.engine.links.tracking import Tracking
from studio.engine.links.wanted import Wanted
from studio.engine.links.way import Way
from studio.engine.robot import CONTROL_PERIOD, CONTROL_RATE
from studio.engine.skeleton import FloatArray

NEAR = 0.15  # [rad] that the robot may be off what is wanted where commands begin
ARRIVED = 0.1  # [rad] as near as a compliant robot has to come to the start pose
JUMP = 3 * CONTROL_PERIOD  # [s] of top speed: what is wanted farther in one tick has jumped
_ENABLES_WITHIN = 5 * CONTROL_RATE  # ticks that a robot may take to power its motors
_SETTLES_WITHIN = 3 * CONTROL_RATE  # ticks that it may take to come to what was sent
_STUCK = 0.015  # [rad/s]: a tenth of the start's speed; slower, it comes no further
_NOTHING = Outcome()
_AGAIN = "Enable and confirm anew."


def step(
    memory: Memory, seen: Seen, wanted: Wanted, elapsed: float = CONTROL_PERIOD
) -> tuple[Memory, Outcome]:
    """Do one control tick: return what is kept, and the only command that may leave in it.

    ``elapsed`` [s] is how much time has really passed since the tick before, a control period at
    most and above zero: ticks that come faster, as a program may have them come, move no robot
    faster.
    """
    if memory.phase is Phase.OFF:
        return memory, _NOTHING
    state, trouble = seen.state, _unheard(seen)
    if state is None or trouble:
        return stop(memory, f"{trouble} {_AGAIN}"), _NOTHING
    if memory.phase is Phase.ENABLING:
        return _enabling(memory, state), _NOTHING
    trouble = _unable(state)
    if trouble:
        return stop(memory, f"{trouble} {_AGAIN}"), _NOTHING
    if memory.way is None:
        return memory, _NOTHING
    return _on_the_way(memory, memory.way, state, wanted, elapsed)


def _unheard(seen: Seen) -> str:
    """Return why the robot is not heard as it is now, in words."""
    if seen.state is None:
        return f"The connection is lost: {seen.trouble or 'it tells nothing'}."
    return f"The robot's states come {seen.age:.1f} s late." if seen.age > STALE else ""


def _unable(state: RobotState) -> str:
    """Return why an enabled robot can't go on, in words."""
    if state.stop:
        return state.stop
    if not state.enabled:
        return "The robot was disabled."
    missing = ", ".join(state.untold)
    return f"The robot does not tell {missing} any more." if missing else ""


def _on_the_way(
    memory: Memory, way: Way, state: RobotState, wanted: Wanted, elapsed: float
) -> tuple[Memory, Outcome]:
    if not way.fits(wanted):
        words = "Arms, hands or scene have changed: confirm the start anew."
        return _waiting(memory, words), _NOTHING
    way = way.beside(state.positions)
    memory, measured = replace(memory, way=way), state.positions[way.columns]
    if memory.phase is Phase.STARTING:
        return _starting(memory, way, measured, elapsed)
    return _following(memory, way, measured, wanted, elapsed)


def _enabling(memory: Memory, state: RobotState) -> Memory:
    if state.stop and not state.resets:
        return stop(memory, f"{state.stop} {_AGAIN}")
    if state.enabled and not state.stop:
        return _waiting(memory, "Enabled. The first move has to be confirmed.")
    if memory.ticks >= _ENABLES_WITHIN:
        return stop(memory, f"The robot did not power its motors. {state.fault}".strip())
    return replace(memory, ticks=memory.ticks + 1)


def _waiting(memory: Memory, why: str) -> Memory:
    return Memory(Phase.WAITING, why, memory.ratio)


def _starting(
    memory: Memory, way: Way, measured: FloatArray, elapsed: float
) -> tuple[Memory, Outcome]:
    """Go on to the start pose, and wait there until the robot has come."""
    goal, sent = memory.goal, memory.sent
    if goal is None or sent is None or memory.tracking is None:
        return _waiting(memory, memory.why), _NOTHING
    tracking, astray = memory.tracking.step(way.joints, sent, measured, memory.top(way))
    if astray:
        return stop(memory, f"{astray} {_AGAIN}"), _NOTHING
    if np.array_equal(sent, goal) and np.abs(measured - goal).max() < ARRIVED:
        return replace(memory, phase=Phase.READY, why="", sent=None, tracking=None), _NOTHING
    command = way.start_step(sent, goal, memory.ratio, elapsed)
    rests = float(np.abs(command.sent - sent).max()) < _STUCK * elapsed
    ticks = memory.ticks + 1 if rests else 0
    if ticks > _SETTLES_WITHIN:
        why = command.guarded or "it does not come to what was sent"
        words = f"The start pose is not reached: {why}. Lead the arm nearer by hand, then confirm."
        return _waiting(memory, words), _NOTHING
    memory = replace(memory, sent=command.sent, tracking=tracking, ticks=ticks)
    return memory, _command(way, command.sent, goal, command.guarded)


def _following(
    memory: Memory, way: Way, measured: FloatArray, wanted: Wanted, elapsed: float
) -> tuple[Memory, Outcome]:
    """Follow what is wanted, as long as gate or playing permit it."""
    if not wanted.permitted:
        why = f"Ready; nothing is sent: {wanted.why_not}."
        return replace(memory, why=why, sent=None, wanted=None, tracking=None), _NOTHING
    target, before = way.within(wanted.positions), memory.wanted
    sent = np.clip(measured, way.limits.lower, way.limits.upper)
    tracking = Tracking.begin(sent)
    if memory.sent is not None and memory.tracking is not None and before is not None:
        sent, tracking = memory.sent, memory.tracking
        far = np.abs(target - before) > JUMP * way.limits.velocity
        why = "What is shown jumped"
    else:
        far = np.abs(target - sent) > NEAR
        why = f"The robot is {np.degrees(np.abs(target - sent).max()):.0f}° off what is shown"
    if far.any():
        return _waiting(memory, f"{why}: confirm that it may go there."), _NOTHING
    tracking, astray = tracking.step(way.joints, sent, measured, memory.top(way))
    if astray:
        return stop(memory, f"{astray} {_AGAIN}"), _NOTHING
    command = way.step(sent, target, memory.ratio, elapsed)
    memory = replace(memory, why="", sent=command.sent, wanted=target, tracking=tracking)
    return memory, _command(way, command.sent, target, command.guarded)


def _command(way: Way, sent: FloatArray, target: FloatArray, guarded: str) -> Outcome:
    lag = float(np.abs(target - sent).max())
    return Outcome(dict(zip(way.joints, sent.tolist(), strict=True)), lag, guarded)
