"""A robot of a few lines, and the gatekeeper before it: what most tests of links share."""

import threading
import time

import numpy as np

from studio.engine.arms import HANGING, driven_joints
from studio.engine.links import consent
from studio.engine.links.driver import LinkThread
from studio.engine.links.gatekeeper import step
from studio.engine.links.link import RobotLink, RobotState
from studio.engine.links.memory import Memory, Outcome, Seen
from studio.engine.links.status import Phase
from studio.engine.links.wanted import Wanted
from studio.engine.pipeline import ready_pose
from studio.engine.robot import CONTROL_PERIOD, JOINT_NAMES, load_robot
from studio.engine.scene import Scene
from studio.engine.skeleton import SIDES, FloatArray
from tests.engine.links.unhurried import CLOCK, PATIENCE, eventually

ROBOT = load_robot()
LEFT = ROBOT.arm_joints("left")


def hanging() -> FloatArray:
    """Both arms beside the desk."""
    return posed({}, hang=True)


def posed(angles: dict[str, float], hang: bool = False) -> FloatArray:
    """All joints, the right arm hanging, others at zero unless named."""
    whole = dict.fromkeys(JOINT_NAMES, 0.0)
    for side in SIDES if hang else ("right",):
        whole |= dict(zip(driven_joints(side), HANGING[side], strict=True))
    return np.array([{**whole, **angles}[name] for name in JOINT_NAMES])


def ready() -> FloatArray:
    """Where the robot on the page waits."""
    angles = zip(driven_joints("left"), ready_pose("left", "exact").tolist(), strict=True)
    return posed(dict(angles))


def near() -> FloatArray:
    """A little off that, so that the start does not take long."""
    return ready() + posed({"left_s0": -0.2, "left_s1": -0.1, "left_e1": 0.1}) - posed({})


class Model:
    """A robot that does what it is told, if it is enabled."""

    def __init__(self, start: FloatArray | None = None) -> None:
        self.positions = near() if start is None else start.copy()
        self.enabled, self.stop, self.resets = False, "", False
        self.signs = np.ones(len(JOINT_NAMES))
        self.order = np.arange(len(JOINT_NAMES))  # whose motor a name really turns
        self.stuck = False
        self.commands: list[dict[str, float]] = []
        self.heard: dict[str, float] | None = None

    def state(self) -> RobotState:
        return RobotState(self.positions.copy(), self.enabled, self.stop, self.resets)

    def obey(self, targets: dict[str, float] | None) -> None:
        """Go on as far as the targets do; without any it holds, and begins anew with the next."""
        if targets is None:
            self.heard = None
            return
        self.commands.append(targets)
        if not self.enabled or self.stop or self.stuck:
            return
        if self.heard is None:
            self.heard = {name: self.positions[JOINT_NAMES.index(name)] for name in targets}
        for name, angle in targets.items():
            index = self.order[JOINT_NAMES.index(name)]
            self.positions[index] += self.signs[index] * (angle - self.heard[name])
        self.heard = dict(targets)


class Rig:
    """The gatekeeper's memory, a model, and what is wanted of it."""

    def __init__(self, model: Model | None = None) -> None:
        self.model = model or Model()
        self.memory, self.age = Memory(), 0.0
        self.wanted, self.permitted, self.arms = ready(), False, "left"
        self.lost = False

    @property
    def seen(self) -> Seen:
        return Seen(trouble="gone") if self.lost else Seen(self.model.state(), self.age)

    @property
    def asked(self) -> Wanted:
        why = "" if self.permitted else "the gate is closed"
        return Wanted(self.wanted, self.permitted, why, self.arms, SCENES[self.arms])

    def enable(self) -> None:
        self.memory = consent.enable(self.memory, self.seen)
        self.model.enabled = True

    def confirm(self, confirmed: bool = True) -> None:
        self.memory = consent.confirm(self.memory, self.seen, self.asked, {}, confirmed)

    def tick(self) -> Outcome:
        self.memory, outcome = step(self.memory, self.seen, self.asked)
        self.model.obey(outcome.targets)
        return outcome

    def ticks(self, count: int) -> list[Outcome]:
        return [self.tick() for _ in range(count)]

    def started(self) -> "Rig":
        """Enable, confirm, and come to the start pose."""
        self.enable()
        self.tick()
        self.confirm()
        for _ in range(round(60 / CONTROL_PERIOD)):
            self.tick()
            if self.memory.phase == "ready":
                return self
        raise AssertionError(self.memory.why)


SCENES = {arms: Scene(arms=arms) for arms in ("left", "right", "both")}


HASTE = 3.0  # times more ticks a second than a session has, and as much quicker motors


class LiveRig:
    """The gatekeeper before a genuine link, by `CLOCK`: what the session does, without one."""

    def __init__(self, link: RobotLink) -> None:
        self.thread = LinkThread(link, CLOCK)
        self.memory = Memory()
        self.wanted, self.permitted = start_of({}), False

    def __enter__(self) -> "LiveRig":
        return self

    def __exit__(self, *_: object) -> None:
        self.thread.close()

    @property
    def seen(self) -> Seen:
        return Seen.of(self.thread.heard, CLOCK(), self.thread.trouble)

    @property
    def phase(self) -> Phase:
        return self.memory.phase

    @property
    def why(self) -> str:
        return self.memory.why

    def measured(self, joint: str) -> float:
        return float(self.thread.heard.state.positions[JOINT_NAMES.index(joint)])

    def enable(self) -> None:
        self.memory = consent.enable(self.memory, self.seen)
        self.thread.order(lambda link: link.enable())
        self.until(lambda: self.phase is not Phase.ENABLING)
        self.thread.order(lambda link: link.set_speed(self.memory.ratio))

    def confirm(self) -> None:
        asked = Wanted(self.wanted, self.permitted, "", "left", SCENES["left"])
        own = self.thread.limits
        self.memory = consent.confirm(self.memory, self.seen, asked, own, True)

    def tick(self) -> None:
        why = "" if self.permitted else "the gate is closed"
        asked = Wanted(self.wanted, self.permitted, why, "left", SCENES["left"])
        self.memory, outcome = step(self.memory, self.seen, asked)
        self.thread.put(outcome.targets)
        CLOCK.sleep(CONTROL_PERIOD / HASTE)

    def until(self, reached) -> "LiveRig":
        end = time.monotonic() + PATIENCE
        while not reached():
            assert time.monotonic() < end, f"never: {self.phase} {self.why} {self.seen.trouble}"
            self.tick()
        return self

    def settle(self) -> None:
        """Wait until all that is on its way to the robot has come there, or been dropped."""
        passed = threading.Event()
        self.thread.order(lambda _: passed.set())
        eventually(lambda: passed.is_set() or not self.thread.is_open)
        CLOCK.sleep(0.1)

    def heard(self) -> "LiveRig":
        return self.until(lambda: self.seen.state is not None)

    def started(self) -> "LiveRig":
        """Enable, confirm, and come to where it is wanted, which is near."""
        self.heard()
        self.enable()
        self.confirm()
        return self.until(lambda: self.phase is Phase.READY)

    def moving(self) -> "LiveRig":
        """Let it move on and on: joint s0, slowly."""
        self.started()
        self.permitted = True
        for _ in range(5):
            self.move("left_s0", 0.01)
            self.tick()
        assert self.phase is Phase.READY, self.why
        return self

    def move(self, joint: str, by: float) -> None:
        self.wanted = self.wanted.copy()
        self.wanted[JOINT_NAMES.index(joint)] += by


def start_of(angles: dict[str, float]) -> FloatArray:
    """Where a stand-in's robot starts, but for some joints."""
    return np.array([angles.get(name, 0.0) for name in JOINT_NAMES])
