"""What the joints' plots show: data alone, NaN where nothing is known."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from studio.engine.compare_status import Alone
from studio.engine.demonstration import SAMPLES, DemonstrationSet, resample
from studio.engine.performance import joint_columns
from studio.engine.robot import load_robot
from studio.engine.skeleton import FloatArray
from studio.engine.snapshot import Snapshot
from studio.panels.readiness import fitting

SMALLEST_RANGE, ROUND = 15.0, 5.0  # [deg] of the angle's axis
KEPT = 0.6  # of an axis is the curves', before rounding, where it grows to limits near enough
_CLEAR = np.array((-2.0, 2.0))  # [deg] from a limit to the axis's end, so that its line is seen
MOST_THIN = 6  # demonstrations with a line of their own; the envelope holds all


@dataclass(frozen=True, eq=False)
class Curves:
    """All of them over the same stamps."""

    joints: tuple[str, ...]  # D names
    stamps: FloatArray  # (142,) [s]
    low: FloatArray  # (142, D) [deg] the demonstrations' envelope
    high: FloatArray  # (142, D) [deg]
    thin: tuple[FloatArray, ...]  # (142, D) [deg] each
    mean: FloatArray  # (142, D) [deg]
    chosen: FloatArray  # (142, D) [deg]
    network: FloatArray  # (142, D) [deg]
    robot: FloatArray  # (142, D) [deg] measured while it does it alone
    second: FloatArray  # (142, D) [deg] the same of B
    limits: FloatArray  # (2, D) [deg]
    playhead: int = -1  # the sample where it is; -1: nothing is played

    def of_joint(self, column: int, axis: tuple[float, float]) -> tuple[FloatArray, ...]:
        """Return a plot's series: the stamps, each curve, limits, and the playhead.

        Each is (142,), or (143,) with the sample at the playhead twice: its line stands upright.
        """
        at = np.arange(len(self.stamps))
        upright = np.full(len(at), np.nan)
        if self.playhead >= 0:
            at = np.insert(at, self.playhead, self.playhead)
            upright = np.insert(upright, self.playhead, axis[0])
            upright[self.playhead + 1] = axis[1]
        curves = (
            *(self.low, self.high),
            *self.thin,
            *(self.mean, self.chosen, self.network, self.robot, self.second),
        )
        lower, upper = self.limits[:, column]
        return (
            self.stamps[at],
            *(curve[at, column] for curve in curves),
            np.full(len(at), lower),
            np.full(len(at), upper),
            upright,
        )

    def axis_of(self, column: int, to_limits: bool) -> tuple[float, float]:
        """Return round bounds [deg] of a joint's axis: about all curves, and its limits.

        Unless it goes ``to_limits``, these are left out where the curves would be squashed.
        """
        shown = (self.low, self.high, self.chosen, self.network, self.robot, self.second)
        values = np.concatenate([curve[:, column] for curve in shown])
        limits = self.limits[:, column]
        kept = np.array([True, True]) if to_limits else near(values, limits)
        return axis_range(np.append(values, (limits + _CLEAR)[kept]))


def curves_of(now: Snapshot) -> Curves | None:
    """Return what is known of the taught motion, or None where nothing was taught."""
    listed = [entry.demonstration for entry in fitting(now)]
    if now.lesson is None and not listed:
        return None
    taught = DemonstrationSet.of(listed) if now.lesson is None else now.lesson.taught
    stamps = np.linspace(0.0, taught.duration, SAMPLES)
    nothing = np.full_like(taught.mean, np.nan)
    chosen = now.entries[now.chosen].demonstration if now.entries else None
    alike = chosen is not None and chosen.joints == taught.joints
    limits = load_robot().limits_of(taught.joints)
    curves = Curves(
        joints=taught.joints,
        stamps=stamps,
        low=np.degrees(taught.rows.min(axis=0)),
        high=np.degrees(taught.rows.max(axis=0)),
        thin=tuple(np.degrees(rows) for rows in taught.rows[:MOST_THIN]),
        mean=np.degrees(taught.mean),
        chosen=np.degrees(resample(chosen)) if chosen is not None and alike else nothing,
        network=nothing if now.lesson is None else np.degrees(now.lesson.curve),
        robot=nothing,
        second=nothing,
        limits=np.degrees(np.stack([limits.lower, limits.upper])),
    )
    return _played(curves, now, taught)


def _played(curves: Curves, now: Snapshot, taught: DemonstrationSet) -> Curves:
    """Add what robots did: of what is played for the first time as much as has been seen."""
    playing, head = now.compare.playing, _head(now)
    curves = replace(curves, playhead=min(head, SAMPLES - 1))
    if not playing:
        done = now.reproduction
        if now.lesson is None or done is None:
            return curves
        alone = Alone(now.lesson, done.performance)
        return replace(curves, robot=_measured(alone, curves, taught))
    rows = [_measured(alone, curves, taught) for alone in playing]
    if now.reproduction is None:
        for row in rows:
            row[head + 1 :] = np.nan
    second = rows[1] if len(rows) > 1 else curves.second
    return replace(curves, robot=rows[0], second=second)


def _head(now: Snapshot) -> int:
    """Return the sample at the playhead, at the same share of the motion; -1 without one."""
    timeline = now.compare.timeline
    return int(now.time / timeline.motion * (SAMPLES - 1)) if timeline.motion else -1


def _measured(alone: Alone, curves: Curves, taught: DemonstrationSet) -> FloatArray:
    """Return what was measured (142, D) [deg], NaN where another motion was performed."""
    if alone.performance is None or alone.lesson.taught.joints != taught.joints:
        return np.full_like(curves.mean, np.nan)
    columns = joint_columns(taught.joints)
    measured: FloatArray = np.degrees(alone.performance.measured_at(curves.stamps)[:, columns])
    return measured


def near(values: FloatArray, limits: FloatArray) -> NDArray[np.bool_]:
    """Return which of two limits [deg] the curves have room for: both, the nearer one, or none."""
    lowest, highest = float(np.nanmin(values)), float(np.nanmax(values))
    room = max(highest - lowest, SMALLEST_RANGE) * (1.0 / KEPT - 1.0)
    gaps = np.maximum((lowest - limits[0], limits[1] - highest), 0.0)
    if gaps.sum() <= room:
        return np.array([True, True])
    nearer: NDArray[np.bool_] = np.arange(2) == gaps.argmin()
    return nearer & (gaps <= room)


def axis_range(values: FloatArray) -> tuple[float, float]:
    """Return round bounds [deg] about all that is known, wide enough not to make much of little."""
    lowest, highest = float(np.nanmin(values)), float(np.nanmax(values))
    short = max(0.0, SMALLEST_RANGE - (highest - lowest)) / 2.0
    lower, upper = (lowest - short) / ROUND, (highest + short) / ROUND
    return ROUND * float(np.floor(lower)), ROUND * float(np.ceil(upper))


def shown_columns(joints: Sequence[str], side: str) -> list[int]:
    """Return which joints' plots are shown: of two arms' joints one side's, else all."""
    of_side = [i for i, joint in enumerate(joints) if joint.startswith(f"{side}_")]
    return of_side or list(range(len(joints)))
