"""The gate's panel says what the gate thinks, in words and shapes, not by colors alone."""

import re
from dataclasses import replace

import pytest

from studio.engine.gate import SEQUENCE, GateStatus
from studio.engine.skeleton import HandState
from studio.panels.gate import Light, drawn, view


def lights(now) -> list[Light]:
    return [step.light for step in view(now).steps]


def test_nobody_is_watched(lesson) -> None:
    shown = view(lesson["start"])
    assert lights(lesson["start"]) == ["unused"] * 3
    assert shown.headline == "Nobody is watched"


@pytest.mark.parametrize(
    ("lit", "expected"),
    [
        (0, ["awaited", "dark", "dark"]),
        (1, ["lit", "awaited", "dark"]),
        (2, ["lit", "lit", "awaited"]),
        (3, ["lit", "lit", "lit"]),
    ],
)
def test_as_many_steps_are_lit_as_the_gate_believes(lesson, lit: int, expected) -> None:
    status = GateStatus(lit == 3, lit, "why", "why, in words", HandState.UNKNOWN, 0.0, 0.3)
    now = replace(lesson["lasso"], gate=status, held="")
    assert lights(now) == expected
    assert view(now).headline == ("Armed" if lit == 3 else "Not armed")
    assert (view(now).reason == "why, in words") is (lit < 3)


def test_the_time_held_counts_for_the_awaited_sign_only(lesson) -> None:
    def shares(seen: HandState) -> list[float]:
        status = GateStatus(False, 1, "", "", seen, 0.15, 0.3)
        return [step.share for step in view(replace(lesson["lasso"], gate=status)).steps]

    assert shares(HandState.OPEN) == [1.0, 0.5, 0.0]
    assert shares(HandState.LASSO) == [1.0, 0.0, 0.0]


def test_an_armed_robot_that_does_not_follow_says_why(lesson) -> None:
    shown = view(replace(lesson["armed"], held="left wrist not tracked"))
    assert (shown.headline, shown.reason) == ("Armed, but held", "left wrist not tracked")


def test_an_open_gate_asks_for_no_signs(lesson) -> None:
    assert lights(lesson["open"]) == ["unused"] * 3
    assert "without signs" in view(lesson["open"]).headline


def test_each_light_differs_by_its_sign_and_frame(lesson) -> None:
    """What is left in greyscale: every light has a sign of its own, and every step its word."""
    boxes = re.split(r"<div>", drawn(view(lesson["lasso"])))
    assert [sum(sign in box for box in boxes) for sign in "✔▸○"] == [1, 1, 1]
    for state in SEQUENCE:
        assert f">{state.value.upper()}<" in drawn(view(lesson["lasso"]))


def test_reasons_are_escaped(lesson) -> None:
    status = replace(lesson["lasso"].gate, detail="<script>")
    assert "<script>" not in drawn(view(replace(lesson["lasso"], gate=status)))
