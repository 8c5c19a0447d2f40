"""The tour in the page: its captions are seen, its commands sent, and it is left as people wish."""

import pytest
import viser

from studio.engine import commands
from studio.engine.tour import STAGES
from studio.panels.tour import LEFT, TOOK_OVER, Guide, TourCaption, TourInvitation, shown


@pytest.fixture
def server():
    made = viser.ViserServer("127.0.0.1", 0, verbose=False)
    yield made
    made.stop()


def test_the_guide_asks_and_tells(lesson) -> None:
    posted: list[commands.Command] = []
    guide = Guide(posted.append, lambda: 0.0)
    assert guide.look(lesson["start"]) is None
    guide.begin()
    assert guide.is_on
    caption = guide.look(lesson["start"])
    assert (caption.number, caption.of, caption.step) == (1, len(STAGES), "source")
    assert commands.UseDemonstrator() in posted
    guide.interrupt()
    assert guide.look(lesson["start"]) is None
    assert guide.farewell == TOOK_OVER
    guide.interrupt()
    assert guide.farewell == ""  # whoever does more has read it
    guide.begin()
    guide.leave()
    assert guide.farewell == LEFT
    guide.leave()
    assert guide.farewell == ""


def test_the_caption_is_escaped_and_goes(server) -> None:
    left: list[str] = []
    panel = TourCaption(server.gui, lambda: left.append("left"))
    panel.draw(None, "")
    assert not panel.panel.visible
    panel.draw(None, "<b>over</b>")
    assert panel.panel.visible
    assert "&lt;b&gt;over" in panel._words.content
    assert panel._leave.label == "Close"


def test_the_number_of_the_stage_is_told(lesson) -> None:
    guide = Guide(lambda _: None, lambda: 0.0)
    guide.begin()
    assert f"Tour 1/{len(STAGES)}" in shown(guide.look(lesson["start"]), "")


def test_nobody_is_invited_twice(server) -> None:
    invitation = TourInvitation(server.gui, lambda: None)
    invitation.draw(True)
    assert not invitation._begin.visible
    invitation.draw(False)
    assert invitation._begin.visible
