"""What was chosen is what is shown, and what is shown is what is asked for."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import product

import pytest
import viser

from studio.engine.arms import ARMS
from studio.engine.calibration import Calibration
from studio.engine.choices import Choices
from studio.engine.gate import GATE_MODES
from studio.engine.hands import HandOptions
from studio.engine.retarget import MAPPINGS
from studio.engine.wrist import WRIST_MODES
from studio.panels.settings import SettingsPanel, fingers, whose_arm

EVERYTHING = [
    Choices(arms, mapping, gate, mirrored, HandOptions(gripper, wrist))
    for arms, mapping, gate, mirrored, gripper, wrist in product(
        ARMS, MAPPINGS, GATE_MODES, (False, True), (False, True), WRIST_MODES
    )
]


@pytest.fixture(scope="module")
def gui() -> Iterator[viser.GuiApi]:
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    yield server.gui
    server.stop()


def test_every_choice_is_shown_and_asked_for_as_it_is(lesson, gui: viser.GuiApi) -> None:
    asked = []
    panel = SettingsPanel(gui, asked.append)
    for chosen in EVERYTHING:
        panel.draw(replace(lesson["start"], choices=chosen))
        assert panel._chosen() == chosen
    assert asked == []  # what a panel shows is no person's choice


def test_while_somebody_teaches_nothing_can_be_chosen_and_why_is_said(lesson, gui) -> None:
    panel = SettingsPanel(gui, lambda _: None)
    for state, is_refused in (("start", False), ("armed", True), ("played", False)):
        panel.draw(lesson[state])
        assert {control.disabled for control in panel._controls} == {is_refused}
        assert ("Stop first" in panel._refusal.content) is is_refused
        assert panel._refusal.visible is is_refused


def test_a_choice_on_its_way_is_not_taken_back(lesson, gui) -> None:
    panel = SettingsPanel(gui, lambda _: None)
    now = lesson["start"]
    panel.draw(now)
    panel._arms.value = "right"  # as a person's browser does
    panel.draw(now)
    assert panel._arms.value == "right"
    panel.draw(replace(now, message=replace(now.message, number=99)))  # it was refused
    assert panel._arms.value == now.choices.arms


@pytest.mark.parametrize(
    ("chosen", "words"),
    [
        (Choices("left"), "left arm does what your left arm does"),
        (Choices("left", mirrored=True), "left arm does what your right arm does"),
        (Choices("right", mirrored=True), "right arm does what your left arm does"),
        (Choices("both"), "each as yours"),
        (Choices("both", mirrored=True), "mirror"),
    ],
)
def test_whose_arm_moves_which_is_said(chosen: Choices, words: str) -> None:
    assert words in whose_arm(chosen)


def test_fingers_are_said_to_be_there_or_not() -> None:
    assert "no fingers" in fingers(Choices())
    assert "right hand" in fingers(Choices(hands=HandOptions(gripper=True)))


def test_a_calibration_is_no_choice_of_the_settings(lesson, gui) -> None:
    panel = SettingsPanel(gui, lambda _: None)
    chosen = Choices(calibration=Calibration((0.1, 0.0, -1.0)))
    panel.draw(replace(lesson["start"], choices=chosen))
    assert panel._chosen().calibration is None  # the session keeps its own
