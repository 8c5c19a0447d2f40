"""The gate's panel says what the gate thinks, in words and shapes, not by colors alone."""

import re
from dataclasses import replace

import pytest

from studio.engine.gate import SEQUENCE, GateStatus
from studio.engine.skeleton import HandState
from studio.panels.gate import GateView, Light, steps_drawn, view, words_drawn


def drawn(shown: GateView) -> str:
    return steps_drawn(shown) + words_drawn(shown)


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
    status = GateStatus(False, 1, "", "", HandState.OPEN, 0.15, 0.3)
    shown = view(replace(lesson["lasso"], gate=status))
    assert [step.share for step in shown.steps] == [1.0, 0.5, 0.0]
    assert [step.hold for step in shown.steps] == ["seen", "0.1 of 0.3 s", "later"]
    assert "0.1 of 0.3 s" in drawn(shown)


def test_the_confidence_is_shown_where_a_source_tells_one(lesson) -> None:
    status = GateStatus(False, 0, "", "", HandState.NOT_TRACKED, 0.0, 0.3, confidence=0.42)
    shown = view(replace(lesson["lasso"], gate=status))
    assert shown.seen == "hand: not tracked, confidence 0.42"
    assert shown.seen in drawn(shown)


@pytest.mark.parametrize(("left", "shown"), [(None, "Baxter follows"), (0.5, "disarms in 0.5 s")])
def test_an_armed_gate_says_how_long_it_stays_so(lesson, left: float | None, shown: str) -> None:
    detail = "armed: left hand unseen for 1.5 s; disarms in 0.5 s"
    status = GateStatus(True, 3, "", detail, HandState.UNKNOWN, 0.0, 0.5, left=left)
    assert shown in view(replace(lesson["armed"], gate=status, held="")).reason


def test_an_armed_robot_that_does_not_follow_says_why(lesson) -> None:
    shown = view(replace(lesson["armed"], held="left wrist not tracked"))
    assert (shown.headline, shown.reason) == ("Armed, but held", "left wrist not tracked")


def test_a_robot_on_its_way_and_one_that_is_slowed_say_so(lesson) -> None:
    coming = view(lesson["coming"])
    assert (coming.headline, coming.reason) == ("Armed", "Baxter comes to you, slowly at first")
    near = "left forearm is 4 cm from the desk: slowed"
    slowed = view(replace(lesson["armed"], guarded=near))
    assert (slowed.headline, slowed.reason) == ("Armed, slowed", near)
    stopped = near.replace("slowed", "stopped")
    held = view(replace(lesson["armed"], held=stopped, guarded=stopped))
    assert (held.headline, held.reason) == ("Armed, but held", stopped)
    alone = view(replace(lesson["playing"], guarded=near))
    assert (alone.headline, alone.reason) == ("Too near", near)
    opened = view(replace(lesson["open"], held="", guarded=near))
    assert (opened.headline, opened.reason) == ("Armed without signs, slowed", near)


def test_only_what_changes_often_keeps_its_height(lesson) -> None:
    assert "min-height" not in drawn(view(lesson["start"]))
    assert "min-height" in drawn(view(lesson["lasso"]))


def test_an_open_gate_asks_for_no_signs(lesson) -> None:
    assert lights(lesson["open"]) == ["unused"] * 3
    assert "without signs" in view(lesson["open"]).headline


def test_each_light_differs_by_its_sign_and_frame(lesson) -> None:
    """What is left in greyscale: every light has a sign of its own, and every step its word."""
    boxes = re.split(r"<div>", steps_drawn(view(lesson["lasso"])))
    assert [sum(sign in box for box in boxes) for sign in "✔▸○"] == [1, 1, 1]
    for state in SEQUENCE:
        assert f">{state.value.upper()}<" in drawn(view(lesson["lasso"]))


def test_reasons_are_escaped(lesson) -> None:
    status = replace(lesson["lasso"].gate, detail="<script>")
    assert "<script>" not in drawn(view(replace(lesson["lasso"], gate=status)))


def test_the_time_left_stands_beside_the_headline_and_is_said_once(lesson) -> None:
    detail = "left hand unseen for 0.3 s; waiting for Open; 0.5 s left"
    status = GateStatus(False, 1, "", detail, HandState.UNKNOWN, 0.0, 0.3, left=0.5)
    shown = view(replace(lesson["lasso"], gate=status))
    assert (shown.left, shown.reason) == (
        "0.5 s left",
        "left hand unseen for 0.3 s; waiting for Open",
    )
    assert drawn(shown).count("0.5 s left") == 1


def test_what_is_read_from_afar_is_large_enough_on_a_small_screen(lesson) -> None:
    """Words of gate, state and reason; what hangs on a screen's height is more on a larger one."""
    shown = drawn(view(lesson["lasso"]))
    sizes = re.findall(r"font-size:(?:max|clamp)\((\d+)px,3vh", shown)
    assert sizes == ["24"] * (len(SEQUENCE) + 2)


def test_an_armed_hand_that_signs_off_is_timed(lesson) -> None:
    status = GateStatus(True, 3, "", "armed", HandState.LASSO, 0.2, 0.5, left=0.3)
    shown = view(replace(lesson["armed"], gate=status, held=""))
    assert shown.seen == "hand: lasso 0.2 of 0.5 s, confidence 1.00"
