"""How well an arm's motion would come over, as JSON and in words: for `studio inspect`.

The measures and their definitions are `studio.engine.motion_measures`'. A file without end is not
measured without end.
"""

import math
from dataclasses import replace

from studio.engine.arms import Arms, sides_of
from studio.engine.calibration import Calibration
from studio.engine.motion_measures import ArmMeasures, LimitBite, measure_arm
from studio.engine.retarget import Mapping
from studio.engine.sources.recording import SkeletonRecording

LONGEST_MEASURED = 600.0  # [s]; ten minutes take some twenty seconds to measure


def measure(
    recording: SkeletonRecording,
    arms: Arms,
    mapping: Mapping,
    mirrored: bool = False,
    calibration: Calibration | None = None,
) -> tuple[ArmMeasures, ...]:
    """Return the measures of each of the robot's ``arms`` over a recording's `beginning`."""
    if not len(recording):
        return ()
    first = beginning(recording)
    return tuple(
        measure_arm(first, side, mapping, mirrored, calibration) for side in sides_of(arms)
    )


def beginning(recording: SkeletonRecording) -> SkeletonRecording:
    """Return the first `LONGEST_MEASURED` seconds."""
    frames = int((recording.frame_times - recording.frame_times[0] <= LONGEST_MEASURED).sum())
    inside = int((recording.frame_indices < frames).sum())
    return replace(
        recording,
        skeletons=recording.skeletons[:inside],
        frame_indices=recording.frame_indices[:inside],
        frame_times=recording.frame_times[:frames],
    )


def motion_dict(found: ArmMeasures) -> dict[str, object]:
    """Return an arm's measures as JSON knows them; null where nothing moved."""
    return {
        "arm": found.side,
        "mapping": found.mapping,
        "ticks": found.ticks,
        "inside_limits": _known(found.share_inside),
        "position_limits": [_limit(bite, found.ticks) for bite in found.bites],
        "velocity_limit": _known(_share(found.velocity_limited, found.ticks)),
        "e0_flips": found.flips,
        "e0_flips_excused": found.flips - found.unexcused_flips,
        "e0_flips_if_clamped_only": found.raw_flips,
        "lag_ms": {
            "filter": _known(1000 * found.lag_of_filter),
            "end_to_end": _known(1000 * found.lag_end_to_end),
            "limiter_alone": _known(1000 * found.lag_of_limiter),
        },
        "jitter_mm": {
            "before": _known(1000 * found.jitter_before),
            "after": _known(1000 * found.jitter_after),
            "quiet_ticks": found.quiet,
        },
    }


def motion_lines(found: ArmMeasures) -> list[str]:
    """Return an arm's measures in words."""
    if not found.ticks:
        return ["nothing to measure: the arm is never seen for long enough"]
    bitten = ", ".join(_bitten(bite, found.ticks) for bite in found.bites if bite.ticks)
    too_fast = 100 * _share(found.velocity_limited, found.ticks)
    return [
        f"limits      {100 * found.share_inside:.0f} % of {found.ticks} ticks inside; "
        f"{bitten or 'none bit'}; too fast in {too_fast:.0f} %",
        f"e0          {found.flips} changes of side, {found.flips - found.unexcused_flips} of them "
        f"the person's own; clamping alone: {found.raw_flips}",
        f"lag         filter {_ms(found.lag_of_filter)}, end to end {_ms(found.lag_end_to_end)}, "
        f"velocity limit alone {_ms(found.lag_of_limiter)}",
        f"jitter      {_mm(found.jitter_before)} before, {_mm(found.jitter_after)} after, over "
        f"{found.quiet} quiet ticks",
    ]


def _limit(bite: LimitBite, ticks: int) -> dict[str, object]:
    return {
        "joint": bite.joint,
        "share": _known(_share(bite.ticks, ticks)),
        "mean_deg": math.degrees(bite.mean),
        "largest_deg": math.degrees(bite.largest),
    }


def _bitten(bite: LimitBite, ticks: int) -> str:
    mean, largest = math.degrees(bite.mean), math.degrees(bite.largest)
    share = 100 * _share(bite.ticks, ticks)
    return f"{bite.joint} beyond in {share:.0f} % by {mean:.0f}° (at most {largest:.0f}°)"


def _share(count: int, ticks: int) -> float:
    return count / ticks if ticks else math.nan


def _known(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _ms(seconds: float) -> str:
    return f"{1000 * seconds:.0f} ms" if math.isfinite(seconds) else "unknown"


def _mm(meters: float) -> str:
    return f"{1000 * meters:.1f} mm" if math.isfinite(meters) else "unknown"
