"""The report says what the measures say, and null or "unknown" where there is nothing to say."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from studio.engine.motion_measures import ArmMeasures, LimitBite, measure_arm
from studio.engine.motion_report import LONGEST_MEASURED, measure, motion_dict, motion_lines
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.sources.recording import from_skeletons

MEASURED = ArmMeasures(
    side="right",
    mapping="exact",
    ticks=200,
    inside=150,
    bites=(LimitBite("s0", 0, 0.0, 0.0), LimitBite("s1", 50, math.radians(10), math.radians(25))),
    flips=3,
    unexcused_flips=1,
    raw_flips=7,
    quiet=4,
    squares_before=4 * 0.004**2,
    squares_after=4 * 0.001**2,
    velocity_limited=20,
    correlation={name: np.eye(101)[5] for name in ("wanted", "sent", "sent_unfiltered")},
)


def test_numbers() -> None:
    told = motion_dict(MEASURED)
    assert json.loads(json.dumps(told, allow_nan=False)) == told
    assert (told["arm"], told["inside_limits"], told["velocity_limit"]) == ("right", 0.75, 0.1)
    assert told["position_limits"][1] == {
        "joint": "s1",
        "share": 0.25,
        "mean_deg": pytest.approx(10),
        "largest_deg": pytest.approx(25),
    }
    assert (told["e0_flips"], told["e0_flips_excused"]) == (3, 2)
    assert told["lag_ms"]["filter"] == pytest.approx(50)
    assert told["jitter_mm"]["before"] == pytest.approx(4)


def test_words() -> None:
    text = "\n".join(motion_lines(MEASURED))
    for words in (
        "75 % of 200 ticks inside; s1 beyond in 25 % by 10° (at most 25°); too fast in 10 %",
        "3 changes of side, 2 of them the person's own; clamping alone: 7",
        "filter 50 ms, end to end 50 ms",
        "4.0 mm before, 1.0 mm after, over 4 quiet ticks",
    ):
        assert words in text


def test_an_arm_that_is_never_seen() -> None:
    nothing = replace(
        MEASURED,
        ticks=0,
        quiet=0,
        correlation=dict.fromkeys(MEASURED.correlation, np.zeros(101)),
    )
    assert "nothing to measure" in motion_lines(nothing)[0]
    told = motion_dict(nothing)
    assert told["inside_limits"] is None
    assert set(told["lag_ms"].values()) == {None}
    still = "\n".join(motion_lines(replace(nothing, ticks=10)))
    assert "filter unknown" in still


def test_only_the_beginning_of_a_long_stream_is_measured() -> None:
    take = list(demonstrate(0, 1))
    end = [replace(each, time=each.time + 2 * LONGEST_MEASURED) for each in take]
    (long,) = measure(from_skeletons([*take, *end], "x", "x"), "left", "exact")
    short = measure_arm(from_skeletons(take, "x", "x"), "left", "exact")
    assert motion_dict(long) == motion_dict(short)
    assert measure(from_skeletons([], "x", "x"), "left", "exact") == ()
