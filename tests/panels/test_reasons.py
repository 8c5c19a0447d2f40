"""Every control that is switched off says why, in every state of a lesson, on the whole page."""

import html
import re
from dataclasses import replace

import pytest
import viser

from studio.engine.calibration import Calibration
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.uploads import Uploads
from studio.panels import readiness, robot_link
from studio.panels.arcs import ArcsView
from studio.panels.exports import LABELS
from studio.panels.guessing import score
from studio.panels.learn import why_not_suggest
from studio.panels.page import Page
from studio.panels.timeline import title
from studio.panels.tour import Guide
from studio.panels.tryout import why_not_test


def plain(words: str) -> str:
    """Return what people read of HTML."""
    return re.sub("<[^>]*>", "", html.unescape(words))


STEPS = ("1 Source", "2 Teach", "3 Learn", "4 Compare", "5 Export")
WHY_NOT = {  # for a control's label, what its reason is by the snapshot
    "Calibrate (stand with arms hanging)": readiness.why_not_calibrate,
    "Forget the calibration": readiness.why_not_forget_calibration,
    "Record": readiness.why_not_teach,
    "Watch only": readiness.why_not_teach,
    "Train": readiness.why_not_train,
    "Suggest": why_not_suggest,
    "Gaussians": lambda _: "Numbers come with the first training.",
    "Let Baxter do it alone": readiness.why_not_play,
    "Replay this demonstration": readiness.why_not_replay,
    "Ghost": lambda _: "No demonstration is listed: record one in 2 Teach.",
    "Test 100 times": why_not_test,
    "Connect": lambda now: robot_link.why_not_connect(now.link),
    "Let it alone": lambda now: robot_link.why_not_leave(now.link),
    "Enable its motors": lambda now: robot_link.why_not_enable(now.link),
    "Go to the pose on the page, slowly": lambda now: robot_link.why_not_start(now.link, False),
    robot_link.SAFE: lambda now: robot_link.why_not_start(now.link, True),
    "Disable: take its power": lambda now: robot_link.why_not_leave(now.link),
    "Put the block back": readiness.why_not_put_back,
    "Keep this one to compare": readiness.why_not_keep,
    "Export": lambda _: "Choose at least one that is ready.",
    "Show all counts": lambda now: readiness.why_not_train(now) or plain(score(now.learning)),
    "File": lambda _: "nothing to open",
    "Open it": lambda _: "nothing to open",
    "Time [s]": lambda now: plain(title(now)),
}


@pytest.fixture(scope="module")
def page():
    server = viser.ViserServer("127.0.0.1", 0, verbose=False)
    guide, uploads = Guide(lambda _: None, lambda: 0.0), Uploads()
    arcs = ArcsView(server.scene)
    made = Page(server.gui, lambda _: None, lambda: True, guide, uploads, arcs, lambda *_: None)
    made.gui = server.gui
    yield made
    uploads.close()
    server.stop()


def shown(gui: viser.GuiApi) -> list:
    """Return all that is visible, folders' contents included."""
    found, waiting = (
        [],
        [
            child
            for container in gui._container_handle_from_uuid.values()
            if not hasattr(container, "visible")  # the page's panels and their tabs
            for child in container._children.values()
        ],
    )
    while waiting:
        handle = waiting.pop()
        if getattr(handle, "visible", True):
            found.append(handle)
            waiting += getattr(handle, "_children", {}).values()
    return found


def reason(handle: object, now: Snapshot) -> str:
    if handle.label in WHY_NOT:
        return WHY_NOT[handle.label](now)
    if handle.label in LABELS.values():
        kind = next(name for name, label in LABELS.items() if label == handle.label)
        return readiness.why_not_export(now, kind)
    return readiness.why_not_configure(now)  # a setting of 1 Source


def all_states(lesson: dict[str, Snapshot]) -> dict[str, Snapshot]:
    calibrated = replace(lesson["trained"].choices, calibration=Calibration((0.0, 0.0, -1.0)))
    more = {
        f"{name}, calibrated": replace(lesson[name], choices=calibrated)
        for name in ("sourced", "trained", "armed", "playing")
    }
    waiting = replace(lesson["trained"], mode=Mode.TRAINING, choices=calibrated)
    return {**lesson, **more, "training, calibrated": waiting}


@pytest.mark.parametrize("step", STEPS)
def test_whatever_is_switched_off_says_why(step: str, lesson, page) -> None:
    page.steps.open(step)
    silent, seen = [], set()
    for name, now in all_states(lesson).items():
        page.draw(now)
        handles = shown(page.gui)
        words = plain(" ".join(getattr(each, "content", "") for each in handles))
        words += " ".join(str(each.value) for each in handles if hasattr(each, "options"))
        for handle in handles:
            if getattr(handle, "disabled", False):
                why = reason(handle, now)
                seen.add(handle.label)
                if not why or why not in words:
                    silent.append((name, handle.label, why))
    assert silent == []
    assert seen, "a step in which nothing is ever switched off is not looked at"


def test_so_does_the_palette(lesson, page) -> None:
    commands = page.gui._command_handle_from_uuid.values()
    for now in lesson.values():
        page.draw(now)
        assert all(each.description for each in commands if each.disabled)
        assert not any(each.description for each in commands if not each.disabled)


def test_the_reasons_end_in_a_cure(lesson) -> None:
    for now in lesson.values():
        for why_not in (readiness.why_not_teach, readiness.why_not_train, readiness.why_not_play):
            cure = why_not(now)
            assert not cure or re.search(r"press|record|Choose|include|Wait", cure)
