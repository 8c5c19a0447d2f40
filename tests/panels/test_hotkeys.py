"""Every key does one thing, is named, and says why where it does nothing."""

from collections.abc import Callable
from pathlib import Path

import pytest
import viser

from studio.engine import commands
from studio.engine.resources import samples_folder
from studio.engine.session import Session
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.teaching import LearnerSettings
from studio.panels.actions import JUMP, ORDERS
from studio.panels.hotkeys import Hotkeys, keys_as_html
from tests.engine.sessions import do, read

KEYS = {
    "Esc": commands.Stop(),
    "Space": commands.TogglePlay(),
    "→": commands.StepBy(1),
    "←": commands.StepBy(-1),
    "Shift →": commands.StepBy(JUMP),
    "Shift ←": commands.StepBy(-JUMP),
    "R": commands.RecordAgain(),
    "B": commands.PlayReproduction(),
    "Ctrl Z": commands.Restore(),
}


@pytest.fixture
def server():
    made = viser.ViserServer("127.0.0.1", 0, verbose=False)
    yield made
    made.stop()


class Pressed:
    """Hotkeys, and what they did."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self.posted: list[commands.Command] = []
        self.opened: list[str] = []
        page = {
            name: lambda name=name: self.opened.append(name)
            for name in ("Take the tour", "3 Learn")
        }
        self.hotkeys = Hotkeys(gui, self.posted.append, page)
        self.handles = dict(zip(self.hotkeys.actions, self.hotkeys._handles, strict=True))

    def press(self, key: str) -> None:
        for action, handle in self.handles.items():
            if action.key is not None and action.key.shown == key:
                for act in handle._impl.trigger_cb:
                    act(None)


@pytest.fixture
def pressed(server) -> Pressed:
    return Pressed(server.gui)


@pytest.mark.parametrize("key", KEYS)
def test_keys_do_what_the_table_says(pressed: Pressed, key: str) -> None:
    pressed.press(key)
    assert pressed.posted == [KEYS[key]]
    assert f">{key}</td>" in keys_as_html(pressed.hotkeys.actions)


def test_the_page_has_keys_too(pressed: Pressed) -> None:
    pressed.press("T")
    pressed.press("3")
    assert pressed.opened == ["Take the tour", "3 Learn"]


def test_no_key_means_two_things(pressed: Pressed) -> None:
    keys = [(a.key.name, a.key.modifier) for a in pressed.hotkeys.actions if a.key is not None]
    assert len(set(keys)) == len(keys)
    labels = [action.label for action in pressed.hotkeys.actions]
    assert len(set(labels)) == len(labels)


def test_what_is_off_says_why(pressed: Pressed, lesson) -> None:
    pressed.hotkeys.draw(lesson["start"])
    off = {
        action.label: handle.description
        for action, handle in pressed.handles.items()
        if handle.disabled
    }
    assert all(off.values())
    assert "Choose a source first" in off["Record"]
    assert "Nothing is learned yet" in off["Let Baxter do it alone"]
    assert {"Play or pause", "One tick on", "Undo the last deletion"} <= off.keys()
    assert "Stop and disarm" not in off
    assert off["Begin the take"] == off["Record"]  # the first of what is missing
    assert off["End the take"] == "Nothing is being recorded: begin a take first."
    assert off["Train the chosen network"].startswith("No demonstration by left arm")
    assert off["Send B away"] == "Nothing is kept as B."
    assert "without taking live streams" in off["Take the live stream"]
    pressed.hotkeys.draw(lesson["trained"])
    on = [action.label for action, handle in pressed.handles.items() if not handle.disabled]
    assert {"Let Baxter do it alone", "Play or pause", "Record"} <= set(on)
    assert all(h.description is None for h in pressed.handles.values() if not h.disabled)


LISTED = {  # what a lecturer looks for by name, and what is asked for then
    "Play or pause": commands.TogglePlay(),
    "Loop on or off": commands.SetLoop(True),
    "Take the live stream": commands.UseLive(),
    "Give up reading": commands.CancelReading(),
    "Calibrate (stand with arms hanging)": commands.Calibrate(),
    "Begin the take": commands.BeginTake(),
    "End the take": commands.EndTake(),
    "Learn from the chosen one, or leave it out": commands.Include(2, False),
    "Delete the chosen demonstration": commands.Remove(2),
    "Train the chosen network": commands.Train(LearnerSettings("rbf", 20)),
    "Cancel what is being computed": commands.CancelWork(),
    "Replay the chosen demonstration": commands.PlayDemonstration(),
    "Test 100 times": commands.TryOut(100),
    "Put the block back": commands.PutBlockBack(),
    "Keep this one to compare, as B": commands.KeepToCompare(),
    "Send B away": commands.ForgetKept(),
    "Cancel the export": commands.CancelExport(),
}


@pytest.mark.parametrize("label", LISTED)
def test_what_is_looked_for_is_there(pressed: Pressed, lesson, label: str) -> None:
    (order,) = [each for each in ORDERS if each.label == label]
    now = lesson["trained"]
    asked = order.asks(now) if callable(order.asks) else order.asks
    assert asked == LISTED[label]
    (action,) = [each for each in pressed.hotkeys.actions if each.label == label]
    pressed.hotkeys.draw(now)
    action.act()
    posted = pressed.posted
    assert posted == ([] if callable(order.asks) and order.why_not(now) else [asked])


def test_a_take_is_begun_or_ended_but_never_both(lesson) -> None:
    begin, end = (
        next(each.why_not for each in ORDERS if each.label == label)
        for label in ("Begin the take", "End the take")
    )
    for name, now in lesson.items():
        assert begin(now) or end(now), name
    assert begin(lesson["recording"]) == "It is being recorded already: end that take first."
    assert end(lesson["recording"]) == ""
    assert begin(lesson["open"]) == ""  # somebody is watched
    assert begin(lesson["sourced"]) == "Press Watch first: then begin a take."


def test_nothing_is_asked_before_there_is_anything_to_ask_about(pressed: Pressed, lesson) -> None:
    """A press that comes too early, or too late, is not a fault."""
    by_snapshot = {each.label for each in ORDERS if callable(each.asks)} - {"Loop on or off"}
    assert len(by_snapshot) >= 4
    for now in (None, lesson["start"]):
        if now is not None:
            pressed.hotkeys.draw(now)
        for action in pressed.hotkeys.actions:
            if action.label in by_snapshot:
                action.act()
    assert pressed.posted == []


def idle(session: Session) -> Snapshot:
    return do(session, commands.Stop(), commands.UseDemonstrator())


def watching(session: Session) -> Snapshot:
    return do(session, commands.Stop(), commands.UseDemonstrator(), commands.Watch())


def recording(session: Session) -> Snapshot:
    watching(session)
    return do(session, commands.BeginTake())


def learned(session: Session) -> Snapshot:
    """Two takes on the list, learned from, and the block somewhere else."""
    idle(session)
    if not session.snapshot.entries:
        for number in (1, 2):
            read(session, commands.UseFile(samples_folder() / f"demonstration-{number}.mcap"))
    do(session, commands.Restore(), *(commands.Include(each, True) for each in (1, 2)))
    if session.snapshot.lesson is None:
        do(session, commands.Train(LearnerSettings("rbf", 20)))
    return do(session, commands.PlaceBlock(0.7, 0.2))


STATES: dict[str, tuple[Callable[[Session], Snapshot], Mode, int]] = {  # and how many are on
    "start": (lambda session: session.tick(), Mode.IDLE, 1),
    "idle": (idle, Mode.IDLE, 2),
    "watching": (watching, Mode.WATCHING, 2),
    "recording": (recording, Mode.RECORDING, 2),
    "learned": (learned, Mode.IDLE, 9),
}


@pytest.mark.parametrize("state", STATES)
def test_what_is_on_is_not_refused(state: str, tmp_path: Path) -> None:
    """The palette's reasons and the session's own agree: two roads to one answer."""
    reach, mode, least = STATES[state]
    session, tried = Session(tmp_path), 0
    try:
        for order in (each for each in ORDERS if each.label in LISTED):
            reach(session)
            now = session.tick()
            assert now.mode is mode
            if not order.why_not(now):
                tried += 1
                told = do(session, order.asks(now) if callable(order.asks) else order.asks).message
                is_refused = told.is_error and told.number != now.message.number
                # Of a take that is ended before anything armed, it is said that it is empty.
                assert not is_refused or "nothing armed" in told.text, (order, told)
    finally:
        session.close()
    assert tried >= least
