"""Whatever a publisher says of time, filters see it pass tick by tick; and replays see the same."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.follow import ticks_of
from studio.engine.live.stamps import Rebased, rebase
from studio.engine.robot import CONTROL_PERIOD

SETTINGS = settings(deadline=None, derandomize=True)
stamps = st.floats(-1e12, 1e12)
frames = st.lists(
    st.tuples(st.integers(1, 40), st.integers(0, 1), stamps), min_size=2, max_size=40
)  # ticks since the frame before, stream, stamp


def rebased(frames) -> tuple[list[int], list[float]]:
    """The ticks at which frames were taken, and the times that they were given."""
    last: Rebased | None = None
    tick, ticks, times = 7, [], []
    for gap, stream, stamp in frames:
        tick += gap
        last = rebase(last, stream, stamp, tick * CONTROL_PERIOD)
        ticks.append(tick)
        times.append(last.time)
    return ticks, times


@SETTINGS
@given(frames)
def test_no_stamp_leaves_its_tick(frames) -> None:
    ticks, times = rebased(frames)
    now = np.array(ticks) * CONTROL_PERIOD
    assert (np.array(times) <= now).all()
    assert (np.array(times) > now - CONTROL_PERIOD).all()
    assert np.diff(times).min() >= CONTROL_PERIOD / 4 * (1 - 1e-9)


@SETTINGS
@given(frames)
def test_a_recording_is_followed_at_the_same_ticks_again(frames) -> None:
    ticks, times = rebased(frames)
    again = ticks_of(np.array(times))
    assert (again - again[0]).tolist() == [tick - ticks[0] for tick in ticks]


@SETTINGS
@given(st.floats(0, 1e9), st.lists(st.floats(0.02, 0.045), min_size=3, max_size=60))
def test_intervals_of_an_honest_sensor_are_kept(origin: float, intervals: list[float]) -> None:
    """Where each frame is taken in the tick after its stamp, the times differ as the stamps do."""
    seen = np.concatenate(([0.0], np.cumsum(intervals)))
    last: Rebased | None = None
    before: tuple[float, float] | None = None
    for stamp in seen.tolist():
        tick = np.ceil(stamp / CONTROL_PERIOD - 1e-9) * CONTROL_PERIOD
        if before is not None and tick - before[1] < CONTROL_PERIOD / 2:
            continue  # two frames in one tick: the newest wins, and this one was taken
        last = rebase(last, 1, origin + stamp, float(tick))
        if before is None:
            assert last.time == tick
        before = (stamp, float(tick))
        assert abs(last.time - stamp) <= CONTROL_PERIOD


def test_a_sensor_at_thirty_hertz_is_not_touched() -> None:
    last: Rebased | None = None
    for n in range(100):
        last = rebase(last, 1, 1e6 + n / 30, (n + 3) * CONTROL_PERIOD)
        assert abs(last.time - (n + 3) / 30) < 1e-6


def test_a_restarted_clock_begins_anew() -> None:
    last = rebase(None, 1, 5000.0, 1.0)
    assert rebase(last, 2, 3.0, 2.0).time == 2.0
