"""The calibration says how far it is, what it found and with whom; its button when it helps."""

from collections.abc import Iterator
from dataclasses import replace

import pytest
import viser

from studio.engine.calibration import Calibration
from studio.engine.choices import Choices
from studio.engine.snapshot import Mode, Progress, Snapshot
from studio.panels.calibration import CalibrationPanel, bar, described
from studio.panels.gate import view
from studio.panels.readiness import next_step, why_not_calibrate, why_not_configure, why_not_teach
from studio.panels.status import strip


@pytest.fixture
def calibrating(lesson) -> Snapshot:
    progress = Progress(0.4, "Keep still: <1.2> s")
    return replace(lesson["sourced"], mode=Mode.CALIBRATING, calibrating=progress, duration=20.0)


@pytest.fixture
def calibrated(lesson) -> Snapshot:
    chosen = Choices(calibration=Calibration((0.1045, 0.0, -0.9945)))
    return replace(lesson["sourced"], choices=chosen, calibrated_with="demonstrator:1")


@pytest.fixture
def panel() -> Iterator[CalibrationPanel]:
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    yield CalibrationPanel(server.gui, lambda _: None)
    server.stop()


def test_progress_is_shown_everywhere_and_escaped(calibrating: Snapshot) -> None:
    assert "Keep still: &lt;1.2&gt; s" in described(calibrating)
    assert bar(0.4) in described(calibrating)
    assert "width:40%" in bar(0.4)
    assert "CALIBRATING" in strip(calibrating)
    assert "40 %" in strip(calibrating)
    assert (view(calibrating).headline, view(calibrating).reason) == (
        "Calibrating",
        "Keep still: <1.2> s",
    )
    assert "Stop gives up" in next_step(calibrating)


def test_while_it_goes_on_nothing_else_begins(calibrating: Snapshot) -> None:
    assert "calibrate" in why_not_teach(calibrating)
    assert "calibrate" in why_not_configure(calibrating)
    assert why_not_calibrate(calibrating) == ""


def test_the_result_and_its_source_are_told(lesson, calibrated: Snapshot) -> None:
    assert "Not calibrated" in described(lesson["start"])
    assert "torso leans 6°: corrected" in described(calibrated)
    assert "calibrate again" not in described(calibrated)
    assert "Taken with &lt;me&gt;" in described(replace(calibrated, calibrated_with="<me>"))


@pytest.mark.parametrize(
    ("state", "cure"),
    [("start", "Choose a source"), ("sourced", ""), ("armed", "Stop"), ("playing", "Stop")],
)
def test_the_button_says_why_it_does_nothing(lesson, panel, state: str, cure: str) -> None:
    panel.draw(lesson[state])
    assert panel._calibrate.disabled is bool(cure)
    assert cure in panel._state.content


def test_what_was_calibrated_can_be_forgotten(lesson, panel, calibrated: Snapshot) -> None:
    panel.draw(lesson["start"])
    assert not panel._forget.visible
    panel.draw(calibrated)
    assert panel._forget.visible
    assert not panel._forget.disabled
    panel.draw(replace(calibrated, mode=Mode.RECORDING))
    assert panel._forget.disabled
