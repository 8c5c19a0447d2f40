"""What is exported arrives, whole; what cannot be is not asked for."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
import viser

from studio.engine import commands, uploads
from studio.engine.export_status import ExportStatus
from studio.engine.uploads import Uploads
from studio.panels import recordings
from studio.panels.exports import _TOO_LARGE, ExportPanel


@pytest.fixture
def server():
    made = viser.ViserServer("127.0.0.1", 0, verbose=False)
    yield made
    made.stop()


class Shown:
    """The panel, what it posts, and what it delivers."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self.posted: list[commands.Command] = []
        self.sent: list[tuple[Path, ...]] = []
        self.uploads = Uploads()
        self.panel = ExportPanel(gui, self.posted.append, self.uploads, self.sent.append)

    def press(self, handle: viser.GuiButtonHandle) -> None:
        for act in handle._impl.update_cb:
            act(SimpleNamespace(client=object(), client_id=1, target=handle))


@pytest.fixture
def shown(server):
    made = Shown(server.gui)
    yield made
    made.uploads.close()


def test_nothing_taught_nothing_to_export(shown: Shown, lesson) -> None:
    shown.panel.draw(lesson["start"])
    assert shown.panel._export.disabled
    assert all(box.disabled for box in shown.panel._boxes.values())
    assert "record one in 2 Teach" in shown.panel._notes.content


def test_what_tells_of_learning_waits_for_it(shown: Shown, lesson) -> None:
    shown.panel.draw(lesson["recorded"])
    off = {name for name, box in shown.panel._boxes.items() if box.disabled}
    assert off == {"replay", "video", "csv", "npz", "model"}
    assert "Network (JSON): Nothing is learned yet: press Train" in shown.panel._notes.content
    assert not shown.panel._export.disabled


def test_what_is_ticked_is_asked_for(shown: Shown, lesson) -> None:
    shown.panel.draw(lesson["trained"])
    assert "✖" not in shown.panel._notes.content
    shown.panel._boxes["csv"].value = True
    shown.panel._anonymous.value = True
    shown.press(shown.panel._export)
    (asked,) = shown.posted
    assert asked == commands.Export(("csv", "zip"), anonymous=True)
    for box in shown.panel._boxes.values():
        box.value = False
    shown.panel.draw(lesson["trained"])
    assert shown.panel._export.disabled
    assert "Choose at least one" in shown.panel._notes.content


def test_progress_is_shown_and_can_be_given_up(shown: Shown, lesson) -> None:
    running = replace(lesson["trained"], export=ExportStatus(("video",), 0.42))
    shown.panel.draw(running)
    assert shown.panel._progress.visible
    assert shown.panel._progress.value == 42
    assert shown.panel._export.disabled
    shown.press(shown.panel._cancel)
    assert shown.posted == [commands.CancelExport()]
    shown.panel.draw(lesson["trained"])
    assert not shown.panel._progress.visible


def test_files_are_sent_once(shown: Shown, lesson, tmp_path: Path) -> None:
    path = tmp_path / "model.json"
    path.write_text("{}")
    done = replace(lesson["trained"], export=ExportStatus(number=1, files=(path,)))
    shown.panel.send(done)
    shown.panel.send(done)
    assert shown.sent == [(path,)]


def test_an_archive_is_opened_under_its_own_name(shown: Shown) -> None:
    upload = SimpleNamespace(name="../lab.zip", content=b"PK\x03\x04")
    shown.panel._receive(SimpleNamespace(target=SimpleNamespace(value=upload)))
    (asked,) = shown.posted
    assert isinstance(asked, commands.OpenSession)
    assert (asked.name, asked.path.read_bytes()) == ("lab.zip", b"PK\x03\x04")


@pytest.mark.parametrize(
    ("content", "why"),
    [
        (b"", "mine.zip: the file is empty"),
        (b"too much", r"mine.zip: 0 MB; up to 0 MB are taken: lay it on the machine that runs"),
    ],
)
def test_why_an_upload_is_refused_stays_until_another_is_opened(
    shown: Shown, lesson, monkeypatch: pytest.MonkeyPatch, content: bytes, why: str
) -> None:
    monkeypatch.setattr(uploads, "LARGEST", 4)
    problem = shown.panel._problem
    refused = SimpleNamespace(name="../mine.zip", content=content)
    shown.panel._receive(SimpleNamespace(target=SimpleNamespace(value=refused)))
    for _ in range(30):  # three seconds
        shown.panel.draw(lesson["trained"])
    assert shown.posted == []
    assert problem.visible
    assert why in problem.content
    assert "studio teach" not in problem.content  # which reads no session
    opening = replace(lesson["trained"], export=ExportStatus(opening="yours.zip"))
    shown.panel.draw(opening)
    assert not problem.visible
    assert "Opening yours.zip" in shown.panel._opening.content


def test_the_cure_for_a_large_session_is_on_the_page() -> None:
    panels = Path(recordings.__file__).read_text()
    for label in ("Other path", "Recordings folder"):
        assert label in _TOO_LARGE
        assert f'"{label}"' in panels


def test_another_upload_takes_the_refusal_away(shown: Shown) -> None:
    for name, content in (("empty.zip", b""), ("good.zip", b"PK\x03\x04")):
        upload = SimpleNamespace(name=name, content=content)
        shown.panel._receive(SimpleNamespace(target=SimpleNamespace(value=upload)))
    assert not shown.panel._problem.visible
    assert len(shown.posted) == 1


def test_the_palette_exports_what_is_ticked(shown: Shown, lesson) -> None:
    """Whichever step is open: it goes by the snapshot, not by what was drawn last."""
    order = shown.panel.order
    shown.panel.draw(lesson["start"])
    shown.panel._boxes["csv"].value = True
    assert "Choose at least one" in order.why_not(lesson["start"])
    assert order.why_not(lesson["trained"]) == ""
    assert order.asks(lesson["trained"]) == commands.Export(("csv", "zip"), anonymous=False)
    running = replace(lesson["trained"], export=ExportStatus(("video",), 0.42))
    assert "is being written" in order.why_not(running)
