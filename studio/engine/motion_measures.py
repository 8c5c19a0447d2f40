"""How well an arm's motion comes over: side flips, jitter, lag, and what the limits take away.

Definitions, each a law with a bar in tests/bench/bench_arm.py:

- A **flip** is a jump of the target's e0 by more than π from one tick to the next. It is excused
  where, within `EXCUSE_WITHIN` of it, the person's own forearm (under a zero-phase filter) stays
  `EXCUSE_PAST` beyond ±180° for `EXCUSE_FOR`: somebody who has really turned that far.
- **Jitter** is the root mean square of the second difference of the wrist, at Baxter's link
  lengths, on the 30 Hz grid, over quiet ticks (wrist under 0.10 m/s): before, of the raw mapping
  clamped; after, of the target before the velocity limit, which alone makes anything look smooth.
- **Lag** is where the correlation of the wrist's velocity with that of the zero-phase reference is
  highest, on a 10 ms grid; of the target, of what is sent, and of what the velocity limit alone
  would send. Pooled, the correlations are added up before the highest is looked for.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from studio.engine.calibration import Calibration
from studio.engine.motion_signals import (
    correlation_of,
    flips_of,
    lag_of,
    quiet_ticks,
    squares_of,
    wrist_path,
)
from studio.engine.motion_trace import ArmTrace, Directions, Mask, solved, trace_arm
from studio.engine.problems import runs_of
from studio.engine.reach import Reach
from studio.engine.retarget import DRIVEN_JOINTS, Mapping, solve_arm
from studio.engine.robot import CONTROL_RATE, load_robot
from studio.engine.skeleton import FloatArray, Side
from studio.engine.sources.recording import SkeletonRecording

EXCUSE_WITHIN = 1.0  # [s]
EXCUSE_PAST = math.radians(30)
EXCUSE_FOR = 0.3  # [s]


@dataclass(frozen=True, eq=False)
class LimitBite:
    """How often a joint's position limit bit, and by how much the person was beyond it."""

    joint: str  # s0, s1, e0 or e1
    ticks: int
    mean: float  # [rad] beyond the limit, over the ticks in which it bit; 0 without any
    largest: float  # [rad]


@dataclass(frozen=True, eq=False)
class ArmMeasures:
    """The measures of one arm in one recording. Lags and ratios are NaN where nothing moved."""

    side: Side  # the robot's
    mapping: Mapping
    ticks: int  # of 1/30 s in which the arm was known
    inside: int  # of them: all four raw angles inside the position limits
    bites: tuple[LimitBite, ...]  # one a joint
    flips: int  # of the target
    unexcused_flips: int
    raw_flips: int  # that clamping alone would make
    quiet: int  # second differences that jitter is taken over
    squares_before: float  # [m²] their sums of squares: raw and clamped,
    squares_after: float  # [m²] and of the target
    velocity_limited: int  # ticks in which the velocity limit bit on the target
    correlation: dict[str, FloatArray]  # of wanted, sent and sent_unfiltered, at each lag (101,)

    @property
    def minutes(self) -> float:
        """How long the arm was known [min]."""
        return self.ticks / CONTROL_RATE / 60.0

    @property
    def share_inside(self) -> float:
        """Share of ticks in which the raw angles lie inside the position limits."""
        return self.inside / self.ticks if self.ticks else np.nan

    @property
    def flips_per_minute(self) -> float:
        """Side flips of the target an arm-minute."""
        return self.flips / self.minutes if self.ticks else np.nan

    @property
    def jitter_before(self) -> float:
        """Root mean square second difference of the wrist, raw and clamped [m]."""
        return float(np.sqrt(self.squares_before / self.quiet)) if self.quiet else np.nan

    @property
    def jitter_after(self) -> float:
        """The same of the target, before the velocity limit [m]."""
        return float(np.sqrt(self.squares_after / self.quiet)) if self.quiet else np.nan

    @property
    def lag_of_filter(self) -> float:
        """Lag of the target, before the velocity limit [s]."""
        return lag_of(self.correlation["wanted"])

    @property
    def lag_end_to_end(self) -> float:
        """Lag of what is sent [s]."""
        return lag_of(self.correlation["sent"])

    @property
    def lag_of_limiter(self) -> float:
        """Lag of what the velocity limit alone would send, without any filter [s]."""
        return lag_of(self.correlation["sent_unfiltered"])


def measure_arm(
    recording: SkeletonRecording,
    side: Side,
    mapping: Mapping = "exact",
    mirrored: bool = False,
    calibration: Calibration | None = None,
) -> ArmMeasures:
    """Measure one of the robot's arms over a recording, the gate open all the time.

    Raises
    ------
    FileError
        Where its stamps span too long a time to be followed.
    """
    return measures_of(trace_arm(recording, side, mapping, mirrored, calibration))


def measures_of(trace: ArmTrace) -> ArmMeasures:
    """Return the measures of an arm that was traced already."""
    reach = Reach.for_robot(load_robot(), trace.side, trace.mapping)
    smooth = solved(trace.smooth, lambda u, f: reach.step(None, u, f, 0.0)[1])
    reference = wrist_path(smooth, trace.side)
    quiet = quiet_ticks(reference)
    before, after = (
        squares_of(wrist_path(x, trace.side), quiet) for x in (trace.clamped, trace.wanted)
    )
    both = np.isfinite(before) & np.isfinite(after)
    flips = flips_of(trace.wanted[:, 2])
    known = trace.raw.known
    paths = {name: getattr(trace, name) for name in ("wanted", "sent", "sent_unfiltered")}
    return ArmMeasures(
        side=trace.side,
        mapping=trace.mapping,
        ticks=int(known.sum()),
        inside=int(_inside(trace)[known].sum()),
        bites=_bites(trace),
        flips=len(flips),
        unexcused_flips=sum(not _excused(trace, tick) for tick in flips),
        raw_flips=len(flips_of(trace.clamped[:, 2])),
        quiet=int(both.sum()),
        squares_before=float(before[both].sum()),
        squares_after=float(after[both].sum()),
        velocity_limited=int(_behind(trace).sum()),
        correlation={
            name: correlation_of(reference, wrist_path(angles, trace.side))
            for name, angles in paths.items()
        },
    )


def pooled(measures: Sequence[ArmMeasures]) -> ArmMeasures:
    """Return several measures, one or more, as one: counts, sums and correlations are added up."""
    first = measures[0]
    return replace(
        first,
        **{name: sum(getattr(each, name) for each in measures) for name in _COUNTS},
        bites=tuple(_merged(bites) for bites in zip(*(m.bites for m in measures), strict=True)),
        correlation={
            name: np.sum([each.correlation[name] for each in measures], axis=0)
            for name in first.correlation
        },
    )


_COUNTS = (
    "ticks",
    "inside",
    "flips",
    "unexcused_flips",
    "raw_flips",
    "quiet",
    "squares_before",
    "squares_after",
    "velocity_limited",
)


def _bites(trace: ArmTrace) -> tuple[LimitBite, ...]:
    known = trace.raw.known
    beyond = np.abs(trace.free[known] - trace.clamped[known])
    return tuple(
        _bite(joint, column) for joint, column in zip(DRIVEN_JOINTS, beyond.T, strict=True)
    )


def _bite(joint: str, beyond: FloatArray) -> LimitBite:
    bitten = beyond[beyond > 0.0]
    if not len(bitten):
        return LimitBite(joint, 0, 0.0, 0.0)
    return LimitBite(joint, len(bitten), float(bitten.mean()), float(bitten.max()))


def _merged(bites: Sequence[LimitBite]) -> LimitBite:
    ticks = sum(bite.ticks for bite in bites)
    total = sum(bite.ticks * bite.mean for bite in bites)
    largest = max(bite.largest for bite in bites)
    return LimitBite(bites[0].joint, ticks, total / ticks if ticks else 0.0, largest)


def _excused(trace: ArmTrace, tick: int) -> bool:
    """Tell whether the person's forearm has really gone well past ±180° around this flip."""
    side = math.copysign(1.0, trace.wanted[tick, 2])
    around = round(EXCUSE_WITHIN * CONTROL_RATE)
    near = slice(max(tick - around, 0), tick + around + 1)
    smooth = Directions(trace.smooth.upper_arm[near], trace.smooth.forearm[near])
    e0 = side * solved(smooth, lambda u, f: solve_arm(u, f, trace.side, trace.mapping))[:, 2]
    past: Mask = (e0 < 0.0) & (e0 + math.pi > EXCUSE_PAST)
    needed = round(EXCUSE_FOR * CONTROL_RATE)
    return any(last - first + 1 >= needed for first, last in runs_of(past))


def _inside(trace: ArmTrace) -> Mask:
    """Return in which ticks (T,) clamping changes nothing; False where the arm is unknown."""
    return np.asarray((trace.free == trace.clamped).all(axis=1), dtype=bool)


def _behind(trace: ArmTrace) -> Mask:
    """Return in which ticks (T,) the velocity limit kept the robot from its target."""
    behind = np.abs(trace.wanted - trace.sent) > 1e-9
    return np.asarray(behind.any(axis=1), dtype=bool)
