"""One step is open, in all browsers, and after a reload: it is the server's, not the browser's."""

from types import SimpleNamespace

import pytest
import viser

from studio.panels.steps import Steps

NAMES = ("1 Source", "2 Teach", "3 Learn")


@pytest.fixture
def server():
    made = viser.ViserServer("127.0.0.1", 0, verbose=False)
    yield made
    made.stop()


def click(steps: Steps, name: str) -> None:
    steps._bar._impl.value = name
    for act in steps._bar._impl.update_cb:
        act(SimpleNamespace(client=object(), client_id=1, target=steps._bar))


def visible(steps: Steps) -> list[str]:
    return [name for name in NAMES if steps[name].visible]


def test_one_is_open_and_clicks_change_it(server) -> None:
    steps = Steps(server.gui, NAMES, lambda: True)
    assert visible(steps) == ["1 Source"]
    click(steps, "3 Learn")
    assert visible(steps) == ["3 Learn"]
    assert steps.is_open("3 Learn")
    assert "nth-child(3)" in steps._style.content
    steps.open("3 Learn")
    assert visible(steps) == ["3 Learn"]


def test_who_only_watches_opens_nothing(server) -> None:
    steps = Steps(server.gui, NAMES, lambda: False)
    click(steps, "2 Teach")
    assert visible(steps) == ["1 Source"]
