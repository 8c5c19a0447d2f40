"""Uploads: what goes wrong is said, how far it is is shown, and bodies are chosen by their ids."""

from collections.abc import Iterator
from dataclasses import replace
from types import SimpleNamespace

import pytest
import viser

from studio.engine import commands, uploads
from studio.engine.reading import ReadingStatus
from studio.engine.uploads import Uploads
from studio.panels.files import NEAREST, FilePanel, ReadingPanel, body_labels, described

BODIES = (("72057594037933964", 312), ("<b>", 40))


@pytest.fixture
def asked() -> list[commands.Command]:
    return []


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    made = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    yield made
    made.stop()


@pytest.fixture
def panel(asked, server) -> Iterator[FilePanel]:
    kept = Uploads()
    yield FilePanel(server.gui, asked.append, kept)
    kept.close()


def seen(lesson, **who):
    now = lesson["sourced"]
    return replace(now, who=replace(now.who, **who))


def upload(panel: FilePanel, name: str, content: bytes) -> None:
    file = SimpleNamespace(name=name, content=content)
    panel._receive(SimpleNamespace(target=SimpleNamespace(value=file)))


def test_a_file_is_handed_on_under_its_name(panel, asked) -> None:
    upload(panel, "../my take.json", b"{}")
    (command,) = asked
    assert command.shown == "my take.json"
    assert command.path.read_bytes() == b"{}"


def test_what_is_too_large_is_refused_before_anybody_reads_it(panel, asked, monkeypatch) -> None:
    monkeypatch.setattr(uploads, "LARGEST", 10)
    upload(panel, "<b>.json", b"x" * 11)
    assert asked == []
    assert panel._problem.visible
    assert "&lt;b&gt;.json" in panel._problem.content


def test_reading_shows_how_far_it_is_and_can_be_given_up(server, lesson) -> None:
    panel = ReadingPanel(server.gui, lambda _: None)
    panel.draw(seen(lesson, reading=ReadingStatus("take.json", 0.4, 2)))
    assert panel._bar.visible
    assert panel._cancel.visible
    assert (panel._bar.value, panel._bar.animated) == (40.0, False)
    assert "take.json</b>: 40%; 2 more to come" in panel._words.content
    panel.draw(seen(lesson, reading=ReadingStatus("take.json", None, 0)))
    assert panel._bar.animated
    panel.draw(seen(lesson, reading=None))
    assert not panel._bar.visible
    assert "&lt;b&gt;" in described(ReadingStatus("<b>", None, 0))


def test_whom_to_follow_is_asked_where_there_is_a_choice(panel, lesson) -> None:
    panel.draw(seen(lesson, bodies=BODIES[:1]))
    assert not panel._body.visible
    panel.draw(seen(lesson, bodies=BODIES))
    assert panel._body.visible
    assert panel._body.options == (
        NEAREST,
        "body 72057594037933964 (312 frames)",
        "body <b> (40 frames)",
    )
    assert panel._body.value == NEAREST
    panel.draw(seen(lesson, bodies=BODIES, body="<b>"))
    assert panel._body.value == "body <b> (40 frames)"


def test_labels_lead_back_to_ids() -> None:
    assert list(body_labels(BODIES).values()) == [None, *(body for body, _ in BODIES)]
