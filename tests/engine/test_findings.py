"""What is known of a set of demonstrations: nothing is lost, nothing is told twice or too early."""

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.curves import COUNTS, BlockPoint, ErrorPoint
from studio.engine.findings import Curve, Findings
from studio.engine.teaching import LearnerSettings
from studio.rbf import suggest_from

FLOOR = 0.004  # [rad²]


def point(neurons: int) -> ErrorPoint:
    """Errors that fall to the floor as more neurons do."""
    ratio = 1.0 + 2.0 / neurons**2
    return ErrorPoint(neurons, ratio * FLOOR, ratio, 0.006 + 0.01 / neurons**2, 1.0)


def block(neurons: int) -> BlockPoint:
    return BlockPoint(neurons, neurons > 2, 0.01, 0.02, done=neurons > 2)


@given(st.permutations(COUNTS), st.integers(0, len(COUNTS)))
@settings(deadline=None, derandomize=True)
def test_points_come_in_any_order_and_stay(order: list[int], some: int) -> None:
    findings = Findings()
    findings.add_errors("rbf", map(point, order[:some]))
    curve = findings.curve("rbf")
    assert [each.neurons for each in curve.points] == sorted(order[:some])
    assert set(curve.missing) == set(order[some:])
    findings.add_errors("rbf", map(point, order))
    whole = findings.curve("rbf")
    assert (whole.missing, len(whole.points)) == ((), len(COUNTS))
    assert findings.curve("newrb").points == ()


def test_a_curve_stays_the_same_object_until_it_changes() -> None:
    findings = Findings()
    findings.add_errors("rbf", [point(3)])
    before = findings.curve("rbf")
    findings.add_errors("rbf", [point(3)])
    assert findings.curve("rbf") is before
    findings.add_errors("rbf", [point(4)])
    assert findings.curve("rbf") is not before


def test_the_suggestion_is_that_of_all_counts_and_waits_for_them() -> None:
    findings = Findings()
    findings.add_errors("rbf", map(point, COUNTS[:-1]))
    assert findings.curve("rbf").suggestion is None
    findings.add_errors("rbf", [point(COUNTS[-1])])
    errors = [point(count) for count in COUNTS]
    expected = suggest_from(
        COUNTS, [each.floor_ratio for each in errors], [each.held_out for each in errors]
    )
    found = findings.curve("rbf").suggestion
    assert found.words == expected.words
    assert found.neurons == 15


@pytest.mark.parametrize("lacking", [{"held_out": None}, {"held_out": float("nan")}])
def test_nothing_is_suggested_from_nothing(lacking: dict) -> None:
    points = [replace(point(count), **lacking) for count in COUNTS]
    assert Curve("rbf", tuple(points)).suggestion is None


def test_the_floor_is_under_every_point() -> None:
    curve = Curve("rbf", (point(2), point(9)))
    assert curve.floor == pytest.approx(FLOOR)
    assert Curve("rbf", (replace(point(2), floor_ratio=None),)).floor is None


def test_an_outcome_keeps_its_guess() -> None:
    findings = Findings()
    findings.add_outcomes("rbf", [block(2)], guess=True)
    findings.add_outcomes("rbf", map(block, (1, 2, 3)))
    assert [(each.point.neurons, each.guess) for each in findings.tried] == [
        (2, True),
        (1, None),
        (3, None),
    ]
    assert [each.right for each in findings.tried] == [False, False, False]
    assert findings.outcome(LearnerSettings("rbf", 2)).guess is True
    assert findings.outcome(LearnerSettings("newrb", 2)) is None
    assert findings.untried("rbf") == COUNTS[3:]
    assert 2 in findings.untried("newrb")
