"""Every key does one thing, is named, and says why where it does nothing."""

import pytest
import viser

from studio.engine import commands
from studio.panels.hotkeys import JUMP, Hotkeys, keys_as_html

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
    pressed.hotkeys.draw(lesson["trained"])
    on = [action.label for action, handle in pressed.handles.items() if not handle.disabled]
    assert {"Let Baxter do it alone", "Play or pause", "Record"} <= set(on)
    assert all(h.description is None for h in pressed.handles.values() if not h.disabled)
