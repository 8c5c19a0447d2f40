"""A control shows the session's value, and never overwrites what a person is doing."""

from collections.abc import Iterator

import pytest
import viser

from studio.panels.synced import Synced
from tests.panels.people import use


@pytest.fixture
def gui() -> Iterator[viser.GuiApi]:
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    yield server.gui
    server.stop()


def test_what_is_shown_is_no_persons_change_and_what_a_person_does_is(gui) -> None:
    changes = []
    text = gui.add_text("name", "")
    synced = Synced(text, lambda: changes.append(text.value))
    synced.show("from the session")
    assert (text.value, changes) == ("from the session", [])
    use(text, "typed")
    assert changes == ["typed"]


def test_typing_stands_for_a_while_and_a_refusal_takes_it_back(gui) -> None:
    text = gui.add_text("name", "old")
    synced = Synced(text, lambda: None, patience=3)
    for letters in ("n", "ne", "new"):
        use(text, letters)
        for _ in range(3):
            synced.show("old")  # the session has not heard yet
            assert text.value == letters
    synced.show("new")  # taken
    use(text, "refused")
    for _ in range(3):
        synced.show("new")
    assert text.value == "refused"
    synced.show("new")
    assert text.value == "new"


def test_about_something_else_it_shows_that_at_once(gui) -> None:
    text = gui.add_text("name", "")
    synced = Synced(text, lambda: None)
    use(text, "typed")
    synced.forget()
    synced.show("another one's name")
    assert text.value == "another one's name"


def test_nearly_the_same_is_the_same(gui) -> None:
    slider = gui.add_slider("t", 0.0, 10.0, 0.1, 2.0)
    synced = Synced(slider, lambda: None)
    synced.show(2.04, lambda shown: abs(shown - 2.04) < 0.1)
    assert slider.value == 2.0
    synced.show(3.0, lambda shown: abs(shown - 3.0) < 0.1)
    assert slider.value == 3.0
