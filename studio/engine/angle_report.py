"""Over which ranges a person's arm moved, by the paper's six angles (Fig. 5): for `studio inspect`.

The robot is driven by directions and not by these; they are what the paper plots and speaks of.
"""

import math
from dataclasses import dataclass

import numpy as np

from studio.engine.human import HumanArmAngles, human_arm_angles
from studio.engine.skeleton import Joint, Side, Skeleton, Tracking, other_side
from studio.engine.sources.recording import SkeletonRecording

PERCENTILES = (5, 95)
NAMES = tuple(HumanArmAngles.__dataclass_fields__)


@dataclass(frozen=True)
class AngleRanges:
    """The percentiles [rad] of each angle over the frames that show all its joints."""

    side: Side  # the person's
    frames: int  # in which all joints of the arm and of the hand are seen
    ranges: dict[str, tuple[float, float]]  # by the names of `HumanArmAngles`; the known ones

    def to_dict(self) -> dict[str, object]:
        """Return the same as JSON knows it: degrees, null for what is never known."""
        told = {f"{name}_deg": list(map(math.degrees, self.ranges.get(name, ()))) for name in NAMES}
        return {"arm": self.side, "frames": self.frames, **{n: x or None for n, x in told.items()}}

    def __str__(self) -> str:
        known = [
            f"{name.replace('_', ' ')} {math.degrees(low):.0f}° to {math.degrees(high):.0f}°"
            for name, (low, high) in self.ranges.items()
        ]
        return ", ".join(known) or "never seen whole"


def angle_ranges(recording: SkeletonRecording, side: Side) -> AngleRanges:
    """Return the ranges of one of the person's arms."""
    seen = [skeleton for skeleton in recording if _is_seen(skeleton, side)]
    angles = [human_arm_angles(skeleton, side) for skeleton in seen]
    ranges = {}
    for name in NAMES:
        known = [angle for each in angles if math.isfinite(angle := getattr(each, name))]
        if known:
            low, high = np.percentile(known, PERCENTILES).tolist()
            ranges[name] = (low, high)
    return AngleRanges(side, len(seen), ranges)


def _is_seen(skeleton: Skeleton, side: Side) -> bool:
    parts = ("hip", "shoulder", "elbow", "wrist", "thumb", "hand_tip")
    joints = [*(Joint.of(part, side) for part in parts), Joint.of("shoulder", other_side(side))]
    return bool((skeleton.tracking[joints] != Tracking.NOT_TRACKED).all())
