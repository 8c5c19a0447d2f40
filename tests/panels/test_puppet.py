"""The puppet's panels say what comes next, and ask for what is pressed."""

from collections.abc import Iterator
from dataclasses import replace

import pytest
import viser

from studio.engine import commands
from studio.engine.choices import Choices
from studio.engine.hands import HandOptions
from studio.engine.skeleton import HandState
from studio.panels.gate import view
from studio.panels.puppet import KEYS, SIGNS, PuppetPanel, SignsPanel, next_move
from tests.panels.puppets import lived_through


@pytest.fixture(scope="module")
def now(tmp_path_factory: pytest.TempPathFactory):
    return dict(lived_through(tmp_path_factory.mktemp("recordings")))


@pytest.fixture
def gui() -> Iterator[viser.GuiApi]:
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    yield server.gui
    server.stop()


@pytest.mark.parametrize(
    ("state", "words"),
    [
        ("taken", "2 Teach: Record"),
        ("watched", "Sign LASSO: press L"),
        ("signing", "Keep LASSO a moment"),
        ("lasso", "Sign OPEN: press O"),
        ("open", "Sign CLOSED: press C"),
        ("closed", "Wait: Baxter comes to its left hand"),
        ("followed", "Drag its left hand: push the block; LASSO (L) disarms"),
    ],
)
def test_the_next_move_is_said_where_the_reason_stands(now, state: str, words: str) -> None:
    assert words in next_move(now[state])
    assert view(now[state]).reason == f"☞ {next_move(now[state])}"


def test_why_the_gate_fell_back_is_said(now) -> None:
    detail = "the next sign came too late; waiting for Lasso"
    late = replace(now["watched"], gate=replace(now["watched"].gate, detail=detail))
    assert next_move(late) == "the next sign came too late; sign LASSO: press L"


def test_what_holds_baxter_goes_before(now, lesson) -> None:
    held = replace(now["followed"], held="left wrist not tracked")
    assert view(held).reason == "left wrist not tracked"
    unsigned = replace(now["followed"], gate=replace(now["followed"].gate, left=0.7, detail="why"))
    assert (view(unsigned).reason, view(unsigned).left) == ("why", "0.7 s left")
    assert "☞" not in view(lesson["lasso"]).reason


def test_where_the_gate_stands_open_nobody_is_asked_to_sign(now) -> None:
    opened = replace(now["followed"], choices=Choices(gate="open"))
    assert "Stop ends it" in next_move(opened)
    assert next_move(replace(opened, gate=replace(opened.gate, armed=False, lit=0))) == ""


def test_the_hand_to_drag_is_the_one_that_is_followed(now) -> None:
    mirrored = replace(now["followed"], choices=Choices(mirrored=True))
    assert "right hand" in next_move(mirrored)
    both = replace(now["followed"], choices=Choices("both"))
    assert next_move(both).startswith("Drag its hands: ")


def test_signs_are_there_while_the_puppet_is(now, lesson, gui) -> None:
    panel = SignsPanel(gui, lambda _: None)
    left, right = panel._hands["left"], panel._hands["right"]
    panel.draw(lesson["sourced"])
    assert (left._bar.visible, all(each.disabled for each in left._commands)) == (False, True)
    panel.draw(now["open"])
    assert (left._bar.visible, any(each.disabled for each in left._commands)) == (True, False)
    assert not right._bar.visible
    gripping = Choices(hands=HandOptions(gripper=True))
    panel.draw(replace(now["open"], choices=gripping))
    assert right._bar.visible


def test_what_is_signed_stands_out_by_more_than_a_color(now, gui) -> None:
    panel = SignsPanel(gui, lambda _: None)
    for state in ("lasso", "open", "closed"):
        panel.draw(now[state])
        place = list(SIGNS).index(state.upper()) + 1
        style = panel._hands["left"]._style.content
        assert f":nth-child({place})" in style
        assert "underline" in style


def test_keys_sign(now, gui) -> None:
    asked: list[commands.Command] = []
    panel = SignsPanel(gui, asked.append)
    panel.draw(now["taken"])
    assert len(KEYS) == 3
    for state in KEYS:
        panel._hands["left"]._sign(state, None)
    assert asked == [commands.Sign("left", state) for state in KEYS]
    keys = [(each.hotkey, each.modifier) for each in panel._hands["left"]._commands]
    assert keys == [("L", None), ("O", None), ("C", None)]
    assert {each.modifier for each in panel._hands["right"]._commands} == {"shift"}
    assert HandState.UNKNOWN in SIGNS.values()


def test_it_can_be_taken_once_and_its_use_is_told(now, lesson, gui) -> None:
    panel = PuppetPanel(gui, lambda _: None)
    panel.draw(lesson["start"])
    assert (panel._take.visible, panel._home.visible) == (True, False)
    panel.draw(now["taken"])
    assert (panel._take.visible, panel._home.visible) == (False, True)
    assert "Drag the blue balls" in panel._how.content
