"""Recordings as sensors: due when their stamps say, rising for ever in a loop."""

from itertools import islice, pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.errors import StudioError
from studio.engine.live.player import schedule
from studio.engine.sources.family import Frame


@settings(deadline=None, derandomize=True)
@given(
    st.lists(st.floats(0, 10), min_size=1, max_size=30).map(sorted),
    st.floats(0.1, 10),
    st.integers(1, 3),
)
def test_laps_are_alike_and_stamps_rise(times: list[float], speed: float, laps: int) -> None:
    frames = [Frame(time) for time in times]
    played = [f.time for f in islice(schedule(frames, speed, loop=True), laps * len(times))]
    assert played[0] == 0.0
    assert all(a <= b for a, b in pairwise(played))
    each = np.array(played).reshape(laps, -1)
    assert np.allclose(each - each[:, :1], (np.array(times) - times[0]) / speed, atol=1e-9)
    assert (np.diff(each[:, 0]) > (times[-1] - times[0]) / speed).all()


def test_without_a_loop_it_ends() -> None:
    assert [f.time for f in schedule([Frame(5.0), Frame(6.0)], speed=2.0)] == [0.0, 0.5]


@pytest.mark.parametrize("speed", [0.0, -1.0, float("nan"), float("inf")])
def test_speeds_that_are_none(speed: float) -> None:
    with pytest.raises(StudioError, match="--speed"):
        next(schedule([Frame(0.0)], speed))


def test_nothing_to_play() -> None:
    with pytest.raises(StudioError, match="no frame"):
        next(schedule([]))
