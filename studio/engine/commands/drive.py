"""How a program drives the robot's joints itself."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace


@dataclass(frozen=True)
class SetJointTarget:
    """Let joints go somewhere, through limits and collision guard; the robot holds without news.

    The first one begins it, slowly. None at all is a sign of life: go on with the last ones.
    """

    targets: Mapping[str, float] = field(default_factory=dict)  # [rad] by joint, as left_s0
    closed: bool | None = None  # the grippers of the driven arms; None: as they are

    def followed_by(self, newer: "SetJointTarget") -> "SetJointTarget":
        """Return what both mean, one right after the other."""
        closed = self.closed if newer.closed is None else newer.closed
        return replace(self, targets={**self.targets, **newer.targets}, closed=closed)


@dataclass(frozen=True)
class BeginDriving:
    """Let joint targets count again: after a `Stop` none does, until this is asked for.

    The robot goes nowhere by it, only with the next target.
    """


DriveCommand = BeginDriving | SetJointTarget
