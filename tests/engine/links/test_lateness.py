"""Late states are told late by their stamps alone, whatever the two clocks are apart."""

import pytest

from studio.engine.links.lateness import Lateness, lateness


def run(delays: list[float], apart: float = 1e9, drift: float = 0.0) -> list[float]:
    """How late messages are said to be that were sent every 20 ms and took ``delays`` [s]."""
    memory: Lateness | None = None
    found = []
    for number, delay in enumerate(delays):
        sent = 0.02 * number
        memory = lateness(memory, apart + sent * (1.0 + drift), sent + delay)
        found.append(memory.late)
    return found


@pytest.mark.parametrize("apart", [0.0, 1e9, -1e9])
def test_a_queue_shows(apart: float) -> None:
    late = run([0.01] * 50 + [0.5] * 50, apart)
    assert max(late[:50]) < 1e-6
    assert min(late[50:]) > 0.48


def test_the_first_may_be_the_slowest() -> None:
    late = run([0.3, 0.01, 0.01])
    assert late == pytest.approx([0.0, 0.0, 0.0], abs=1e-6)


@pytest.mark.parametrize("drift", [1e-4, -1e-4])
def test_clocks_that_run_apart_are_not_late(drift: float) -> None:
    assert max(run([0.01] * 20000, drift=drift)) < 0.005


def test_without_stamps_nothing_is_known() -> None:
    assert lateness(None, None, 1.0) is None


def test_a_message_without_a_stamp_makes_nothing_forgotten() -> None:
    before = lateness(lateness(None, 0.0, 0.01), 1.0, 1.5)
    assert before.late > 0.48
    assert lateness(before, None, 1.6) is before
