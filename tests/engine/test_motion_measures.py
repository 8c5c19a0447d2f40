"""The measures against motions whose answer is known, and real recordings against their bars."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from studio.engine.motion_measures import ArmMeasures, measure_arm, measures_of, pooled
from studio.engine.motion_signals import wrist_path
from studio.engine.motion_trace import ArmTrace, trace_arm
from studio.engine.skeleton import SIDES, Skeleton, all_tracked
from studio.engine.sources import read_skeletons
from studio.engine.sources.recording import SkeletonRecording, from_skeletons
from tests.engine.people import person

Arm = tuple[tuple[float, float, float], tuple[float, float, float]]
STILL: Arm = ((0.9, 0.4, 0.1), (0.8, 0.0, 0.6))


def stream(arms: list[Arm], noise: float = 0.0) -> SkeletonRecording:
    """Return a person whose left arm points as told, 30 times a second, with some noise [m]."""
    rng = np.random.default_rng(1)
    people = [person(i / 30, arm) for i, arm in enumerate(arms)]
    noisy = [
        Skeleton(each.time, each.positions + noise * rng.normal(size=(25, 3)), all_tracked())
        for each in people
    ]
    return from_skeletons(noisy, "made up", "test")


def swinging(seconds: float) -> list[Arm]:
    """Return an arm whose forearm swings, well inside all limits and slower than any."""
    angles = [0.3 * math.sin(2 * math.pi * 0.4 * i / 30) for i in range(round(30 * seconds))]
    return [(STILL[0], (math.cos(a), math.sin(a), -0.6)) for a in angles]


def rolling(e0s: list[float]) -> list[Arm]:
    """Return an arm stretched forward, its forearm bent by 90°, at about these e0 [deg]."""
    tilts = [math.radians(270.0 - e0) for e0 in e0s]  # e0 is 180° where the forearm points up
    return [((1.0, 0.0, 0.0), (0.0, math.cos(a), math.sin(a))) for a in tilts]


@pytest.fixture(scope="module")
def swing() -> ArmTrace:
    return trace_arm(stream(swinging(10.0)), "left")


def test_a_slow_clean_swing_has_little_lag_and_meets_no_limit(swing: ArmTrace) -> None:
    found = measures_of(swing)
    assert (found.flips, found.raw_flips, found.velocity_limited) == (0, 0, 0)
    assert found.share_inside == 1.0
    assert [(bite.joint, bite.ticks) for bite in found.bites] == [
        (joint, 0) for joint in ("s0", "s1", "e0", "e1")
    ]
    assert 0.0 < found.lag_of_filter == found.lag_end_to_end < 0.12
    assert found.lag_of_limiter <= 0.01
    assert found.ticks == 300
    assert found.minutes == pytest.approx(10 / 60)


def test_a_delay_that_is_put_in_is_the_lag_that_comes_out(swing: ArmTrace) -> None:
    late = np.roll(swing.wanted, 6, axis=0)
    late[:6] = late[6]
    plain, shifted = measures_of(swing), measures_of(replace(swing, wanted=late))
    assert shifted.lag_of_filter - plain.lag_of_filter == pytest.approx(0.2, abs=0.011)
    assert shifted.lag_end_to_end == plain.lag_end_to_end


def test_jitter_is_the_second_difference_of_the_quiet_wrist() -> None:
    trace = trace_arm(stream([STILL] * 200, noise=0.002), "left")
    found = measures_of(trace)
    for angles, measured in ((trace.clamped, found.jitter_before),
                             (trace.wanted, found.jitter_after)):  # fmt: skip
        second = np.linalg.norm(np.diff(wrist_path(angles, "left"), 2, axis=0), axis=1)
        assert measured == pytest.approx(np.sqrt(np.mean(second**2)), rel=0.02)
    assert found.quiet == pytest.approx(198, abs=6)
    assert found.jitter_after < 0.5 * found.jitter_before


def test_waving_about_180_degrees_flips_a_clamp_and_not_the_stages() -> None:
    wave = [180.0 + 20.0 * math.sin(2 * math.pi * 0.5 * i / 30) for i in range(240)]
    found = measure_arm(stream(rolling([150.0] * 30 + wave)), "left")
    assert found.flips == 0
    assert found.raw_flips >= 7
    assert found.bites[2].joint == "e0"
    assert 0 < found.bites[2].ticks < 240
    assert 0.0 < found.bites[2].mean <= found.bites[2].largest < math.radians(5.1)


def test_a_flip_is_excused_by_a_forearm_that_really_went_there_and_by_nothing_else() -> None:
    roll = [min(150.0 + i, 270.0) for i in range(200)]
    trace = trace_arm(stream(rolling(roll)), "left")
    found = measures_of(trace)
    assert (found.flips, found.unexcused_flips) == (1, 0)
    still = trace_arm(stream(rolling([150.0] * 200)), "left")
    jumpy = still.wanted.copy()
    jumpy[100:, 2] -= math.radians(320)
    found = measures_of(replace(still, wanted=jumpy))
    assert (found.flips, found.unexcused_flips) == (1, 1)


def test_an_arm_below_reach_is_counted_with_how_far_it_hangs() -> None:
    found = measure_arm(stream([((0.5, 0.1, -2.0), (1.0, 0.0, 0.0))] * 60, 1e-6), "left")
    assert found.share_inside == 0.0
    s1 = found.bites[1]
    assert (s1.joint, s1.ticks) == ("s1", 60)
    assert s1.mean == pytest.approx(s1.largest, rel=1e-3)
    assert 0.05 < s1.mean < 0.5


def test_what_lies_in_a_gap_is_unknown_and_not_measured() -> None:
    arms = swinging(8.0)
    whole = stream(arms)
    cut = [each for i, each in enumerate(whole) if not 100 <= i < 130]
    found = measure_arm(from_skeletons(cut, "made up", "test"), "left")
    assert found.ticks == pytest.approx(240 - 30, abs=2)
    assert found.lag_of_filter == pytest.approx(measure_arm(whole, "left").lag_of_filter, abs=0.04)


@pytest.mark.parametrize("arms", [[], [STILL], [STILL] * 5])
def test_too_little_gives_no_numbers_and_no_error(arms: list[Arm]) -> None:
    found = measure_arm(stream(arms), "left")
    assert found.flips == found.quiet == 0
    assert math.isnan(found.lag_of_filter)
    assert math.isnan(found.jitter_before)


def test_pooling_adds_up(swing: ArmTrace) -> None:
    one, two = measures_of(swing), measure_arm(stream([STILL] * 100, noise=0.002), "left")
    both = pooled([one, two])
    assert both.ticks == one.ticks + two.ticks
    assert both.jitter_after**2 * both.quiet == pytest.approx(one.squares_after + two.squares_after)
    assert pooled([one]).lag_end_to_end == one.lag_end_to_end
    assert both.bites[1].ticks == one.bites[1].ticks + two.bites[1].ticks


REAL = Path(__file__).resolve().parents[3] / "shared" / "data" / "kinect"


@pytest.fixture(scope="module")
def real() -> list[ArmMeasures]:
    if not REAL.is_dir():
        pytest.skip(f"no real recordings at {REAL}")
    files = [path for path in sorted(REAL.glob("*/*")) if path.is_file()]
    return [measure_arm(read_skeletons(path), side) for path in files for side in SIDES]


def test_real_recordings_keep_the_bars(real: list[ArmMeasures]) -> None:
    """The bars of tests/bench/bench_arm.py, which prints what is reached."""
    found = pooled(real)
    assert found.flips / found.minutes <= 1.0
    assert found.unexcused_flips / found.minutes <= 0.5
    assert found.jitter_after <= 0.4 * found.jitter_before
    assert found.lag_of_filter <= 0.10
    assert max(each.lag_of_filter for each in real) <= 0.15
    assert found.lag_end_to_end - found.lag_of_limiter <= 0.08
