"""The strip keeps the last ten seconds, without gaps, and only those."""

from itertools import pairwise

from hypothesis import given, settings, strategies

from studio.engine.gate import GateStatus
from studio.engine.hand_strip import SPAN, HandStrip
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.skeleton import HandState

states = strategies.lists(
    strategies.tuples(strategies.sampled_from(HandState), strategies.integers(1, 200)),
    min_size=1,
    max_size=12,
)


def status(state: HandState, armed: bool = False) -> GateStatus:
    return GateStatus(armed, 3 if armed else 0, "", "", state, 0.0, 0.3)


@given(states)
@settings(deadline=None, derandomize=True, max_examples=60)
def test_runs_are_what_every_tick_showed(shown) -> None:
    """Two roads: the runs, and the list of all ticks."""
    strip, ticks = HandStrip(), []
    for state, count in shown:
        for _ in range(count):
            strip.note(status(state), len(ticks) * CONTROL_PERIOD, CONTROL_PERIOD)
            ticks.append(state)
    runs, end = strip.runs, len(ticks) * CONTROL_PERIOD
    assert abs(runs[-1].end - end) < 1e-9
    assert runs[0].start >= end - SPAN - 1e-9
    assert abs(runs[0].start - max(0.0, end - SPAN)) < 1e-9
    assert all(abs(a.end - b.start) < 1e-9 for a, b in pairwise(runs))
    for tick in range(max(0, len(ticks) - 299), len(ticks)):
        middle = (tick + 0.5) * CONTROL_PERIOD
        (at,) = [run for run in runs if run.start <= middle < run.end]
        assert at.state is ticks[tick]


def test_arming_begins_a_run_and_another_activity_begins_anew() -> None:
    strip = HandStrip()
    assert strip.runs == ()
    strip.note(status(HandState.CLOSED), 0.0, 0.1)
    strip.note(status(HandState.CLOSED, armed=True), 0.1, 0.1)
    assert [run.armed for run in strip.runs] == [False, True]
    strip.note(status(HandState.OPEN), 0.0, 0.1)
    assert [run.state for run in strip.runs] == [HandState.OPEN]
