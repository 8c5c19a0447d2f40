"""The half of `studio link check` that moves: one joint after the other, by 6°, slowly."""

from collections.abc import Callable, Iterator

import numpy as np

from studio.engine.errors import StudioError
from studio.engine.links import consent
from studio.engine.links.check import RISES, Finding, Looking
from studio.engine.links.driver import STALE
from studio.engine.links.gatekeeper import step
from studio.engine.links.link import RobotState
from studio.engine.links.memory import Memory, Seen
from studio.engine.links.status import Phase
from studio.engine.links.wanted import Wanted
from studio.engine.robot import CONTROL_RATE, JOINT_NAMES, load_robot
from studio.engine.scene import Scene
from studio.engine.skeleton import FloatArray, Side

BY = 0.1  # [rad] of each joint
SPEED = 0.1  # [rad/s]
_OWN = 0.05  # [rad] that the joint has to be measured to go, of its 0.1,
_ASIDE = 0.03  # [rad] and all others at most
_STANDS = 0.01  # [rad] that a robot may sag which stands still
_WAITS = 8.0  # [s] for the robot to power its motors, or to take the power off
_PATIENCE = 15.0  # [s] for a person to press the emergency stop
_SETTLES = 1.5  # [s] that a compliant arm may take to come to what was sent
_LOOKS = 0.5  # [s] at a robot that has to stand

# Puts a question to a person; None where nobody is there to answer.
Ask = Callable[[str], bool | None]


class MovingCheck:
    """See the module.

    Parameters
    ----------
    looking
        At a robot that is heard.
    side
        The arm to move.
    ask
        Asks a person what was to be seen.
    """

    def __init__(self, looking: Looking, side: Side, ask: Ask) -> None:
        self._looking, self._side, self._ask = looking, side, ask
        self._memory, self._scene = Memory(), Scene(arms=side)
        self._goal: FloatArray = np.zeros(len(JOINT_NAMES))

    def findings(self) -> Iterator[Finding]:
        """Move and tell; whatever happens, it ends with nothing sent and the power taken off."""
        try:
            yield self._begin()
            if self._memory.phase is Phase.READY:
                for joint in load_robot().arm_joints(self._side):
                    yield self._joint(joint)
                yield self._watchdog()
                yield self._emergency_stop()
        except StudioError as error:
            yield Finding("moving", False, str(error))
        finally:
            self._memory = consent.stop(self._memory, "The check is over.")
            self._looking.thread.put(None)
            self._looking.thread.order(lambda link: link.disable())  # after Ctrl-C, too
        yield self._power_off()

    def _begin(self) -> Finding:
        """Enable, and confirm the start where the robot is: a way of nothing."""
        thread = self._looking.thread
        self._memory = consent.enable(self._memory, self._seen())
        thread.enable()
        self._until(lambda: self._memory.phase is not Phase.ENABLING)
        if self._memory.phase is not Phase.WAITING:
            return Finding("enabling", False, self._memory.why)
        ratio = self._memory.ratio
        thread.order(lambda link: link.set_speed(ratio))
        self._goal = np.nan_to_num(self._state().positions)
        wanted, limits = self._wanted(), thread.limits
        self._memory = consent.confirm(self._memory, self._seen(), wanted, limits, confirmed=True)
        self._until(lambda: self._memory.phase is not Phase.STARTING)
        is_ready = self._memory.phase is Phase.READY
        words = f"enabled, at {100 * ratio:.0f} % of its top speed" if is_ready else ""
        return Finding("enabling", is_ready, words or self._memory.why)

    def _joint(self, joint: str) -> Finding:
        """Move one joint there and back; see that it moved, the right way, and no other did."""
        column = JOINT_NAMES.index(joint)
        limits = load_robot().limits_of([joint])
        begun = self._state().positions
        up = begun[column] + 2 * BY < limits.upper[0]
        sign = 1.0 if up else -1.0
        self._ramp(column, sign * BY)
        moved = sign * (self._state().positions - begun)
        guarded = self._memory.why
        self._ramp(column, -sign * BY)
        name = f"{joint} {'+' if up else '-'}{np.degrees(BY):.0f}°"
        if self._memory.phase is not Phase.READY:
            return Finding(name, False, self._memory.why)
        own, others = float(moved[column]), np.nan_to_num(np.delete(np.abs(moved), column))
        went = f"went {np.degrees(sign * own):+.1f}°, all others {np.degrees(others.max()):.1f}°"
        if own < _OWN or others.max() > _ASIDE:
            return Finding(name, False, f"{went} at most. {guarded}".strip())
        rises = RISES[joint.partition("_")[2]]
        seen = self._ask(
            f"{joint} {'rose' if up else 'fell'} and came back. Where it rises, {rises}. Was it so?"
        )
        words = {True: "and a person saw it", False: "but a person saw it go wrong", None: ""}
        return Finding(
            name, seen is not False, f"{went}; {words[seen] or f'where it rises, {rises}'}"
        )

    def _watchdog(self) -> Finding:
        """Send nothing in mid-motion, as a studio that stalls: the robot has to stand."""
        column = JOINT_NAMES.index(f"{self._side}_s0")
        before = self._looking.thread.sent
        self._ramp(column, BY / 2, waits=False)
        sent = self._looking.thread.sent
        if self._memory.phase is not Phase.READY or sent == before:
            words = self._memory.why or "the guard held it"
            return Finding("watchdog", False, f"nothing was sent that could end: {words}")
        self._looking.wait_for(lambda: False, 2 * STALE)
        stood, late = self._state().positions, self._looking.thread.sent - sent
        self._looking.wait_for(lambda: False, _LOOKS)
        sagged = float(np.nanmax(np.abs(self._state().positions - stood)))
        self._ramp(column, -BY / 2)
        words = f"after {2 * STALE:.1f} s without commands it moved by {np.degrees(sagged):.1f}°"
        return Finding("watchdog", late <= 1 and sagged < _STANDS, words)

    def _emergency_stop(self) -> Finding:
        """Let a person press it, and see that nothing is sent any more."""
        name = "emergency stop pressed"
        if not self._ask(
            f"Will you press the emergency stop (in CoppeliaSim: Pause) within {_PATIENCE:.0f} s "
            "from your answer on?"
        ):
            return Finding(name, None, "not tried: press it once while the robot follows")
        self._until(lambda: self._memory.phase is Phase.OFF, _PATIENCE)
        state = self._seen().state
        stopped = state is not None and bool(state.stop)
        words = self._memory.why if stopped else "it was not heard; press it, and see that it holds"
        return Finding(name, stopped, words)

    def _power_off(self) -> Finding:
        def is_off() -> bool:
            state = self._seen().state
            return state is not None and not state.enabled

        off = self._looking.wait_for(is_off, _WAITS)
        return Finding("disabling", off, "no power" if off else "it still tells of power")

    def _ramp(self, column: int, by: float, waits: bool = True) -> None:
        """Let a joint's goal go on by some angle, slowly, and wait until the robot is there."""
        ticks = round(abs(by) / SPEED * CONTROL_RATE)
        for _ in range(ticks):
            self._goal = self._goal.copy()
            self._goal[column] += by / ticks
            self._tick()
        goal = self._goal[column]

        def is_there() -> bool:
            gap = abs(self._state().positions[column] - goal)
            return bool(gap < _STANDS) or self._memory.phase is not Phase.READY

        if waits:
            self._until(is_there, _SETTLES)

    def _until(self, reached: Callable[[], bool], seconds: float = _WAITS) -> None:
        end = self._looking.now() + seconds
        while not reached() and self._looking.now() < end:
            self._tick()

    def _tick(self) -> None:
        self._memory, outcome = step(self._memory, self._seen(), self._wanted())
        self._looking.thread.put(outcome.targets)
        self._looking.tick()

    def _wanted(self) -> Wanted:
        return Wanted(self._goal, True, "", self._side, self._scene)

    def _seen(self) -> Seen:
        thread = self._looking.thread
        return Seen.of(thread.heard, self._looking.now(), thread.trouble)

    def _state(self) -> RobotState:
        state = self._seen().state
        if state is None:
            raise StudioError(f"the robot is not heard any more: {self._looking.thread.trouble}")
        return state
