"""A person calibrates: the robot holds still until two seconds show the neutral pose.

Whoever presses the button may have to walk to the sensor first. So what counts is the newest two
seconds, whenever they come within `PATIENCE`.
"""

from collections import deque

from studio.engine.calibration import HANGING, LONGEST_SIGHT, SECONDS, Calibration, calibrate
from studio.engine.errors import StudioError
from studio.engine.human import Held, arm_vectors
from studio.engine.identity import is_another
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.skeleton import SIDES, Skeleton
from studio.engine.snapshot import Mode, Progress
from studio.engine.teachers import Teacher
from studio.engine.vectors import Vector, angle_between
from studio.engine.world import World

PATIENCE = 20.0  # [s]
INVITATION = f"Stand upright, both arms hanging, and keep still for {SECONDS:g} seconds."
# [s] for which the pose may flicker without being begun anew: as long as a slow sensor may pause
_BRIDGED = LONGEST_SIGHT + CONTROL_PERIOD
_ROUNDING = 1e-6  # [s] of times that were added up
_DOWN: Vector = (0.0, 0.0, -1.0)


class Calibrating:
    """The activity; see the module. The world is taken over from the activity before."""

    mode, guarded = Mode.CALIBRATING, ""

    def __init__(self, teacher: Teacher, world: World) -> None:
        self.teacher, self.world = teacher, world
        self.time = 0.0
        self.duration = min(teacher.seconds or PATIENCE, PATIENCE)
        self.skeleton: Skeleton | None = None  # the newest one
        self.found: Calibration | None = None
        self.refusal = "calibration: nobody is seen: step into the sensor's view"
        self._frames = teacher.frames()
        self._newest: deque[tuple[float, Skeleton]] = deque()  # of the pose: when [s], and whom
        self._seen_at = 0.0  # [s] when the pose was last seen

    def step(self) -> bool:
        """Watch for one tick; return False once it is found, or nothing more is to be seen."""
        self.world.step()
        if self.found is not None or self.time > PATIENCE:
            return False
        try:
            skeleton = next(self._frames)
        except StopIteration:
            return False
        self.time += CONTROL_PERIOD
        if skeleton is not None:
            self._see(skeleton)
        elif self.time - self._seen_at > _BRIDGED:
            self._newest.clear()
        return True

    def close(self) -> None:
        """Nothing to keep."""

    @property
    def progress(self) -> Progress:
        """How much of the pose has been seen without a break, and what the person should do."""
        left = SECONDS * (1.0 - self._share)
        return Progress(self._share, f"Keep still: {left:.1f} s" if self._newest else INVITATION)

    @property
    def _share(self) -> float:
        if not self._newest:
            return 0.0
        seconds = self._newest[-1][0] - self._newest[0][0]
        return min(seconds / (SECONDS - _ROUNDING), 1.0)

    def _see(self, skeleton: Skeleton) -> None:
        before, self.skeleton = self.skeleton, skeleton
        if before is not None and is_another(before, skeleton):
            self._newest.clear()
        refusal = _why_not_neutral(skeleton)
        if not refusal:
            self._seen_at = self.time
            self._newest.append((self.time, skeleton))
            self._try()
        elif self.time - self._seen_at > _BRIDGED:
            self.refusal = f"calibration: {refusal}"
            self._newest.clear()

    def _try(self) -> None:
        """Calibrate as soon as enough has been seen; else the oldest frame makes way."""
        while self._share >= 1.0:
            try:
                self.found = calibrate([skeleton for _, skeleton in self._newest])
            except StudioError as error:
                self.refusal = str(error)
            else:
                return
            self._newest.popleft()


def _why_not_neutral(skeleton: Skeleton) -> str:
    """Return why a frame does not show both arms hanging, or nothing."""
    for side in SIDES:
        arm = arm_vectors(skeleton, side)
        if isinstance(arm, Held):
            return f"{arm.reason}: stand in full view, both arms hanging"
        bones = (arm.upper_arm, arm.forearm)
        if any(angle_between(arm.torso.from_camera(bone), _DOWN) > HANGING for bone in bones):
            return f"the {side} arm does not hang: let both arms hang relaxed at your sides"
    return ""
