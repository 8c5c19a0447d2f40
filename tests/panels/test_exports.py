"""What is exported arrives, whole; what cannot be is not asked for."""

import io
import zipfile
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
import viser

from studio.engine import commands
from studio.engine.export_status import ExportStatus
from studio.engine.uploads import Uploads
from studio.panels.exports import ARCHIVE, ExportPanel, packages


@pytest.fixture
def server():
    made = viser.ViserServer("127.0.0.1", 0, verbose=False)
    yield made
    made.stop()


class Shown:
    """The panel, what it posts, and what it delivers."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self.posted: list[commands.Command] = []
        self.sent: dict[str, bytes] = {}
        self.uploads = Uploads()
        self.panel = ExportPanel(gui, self.posted.append, self.uploads, self.sent.__setitem__)

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
    assert shown.sent == {"model.json": b"{}"}
    shown.sent.clear()
    shown.panel.send(done)
    assert shown.sent == {}


def test_a_session_stays_a_file_of_its_own(tmp_path: Path) -> None:
    for name in ("session.zip", "a.csv", "b.csv"):
        (tmp_path / name).write_bytes(name.encode())
    sent = dict(packages(tuple(sorted(tmp_path.iterdir()))))
    assert sent.keys() == {"session.zip", ARCHIVE}
    assert sent["session.zip"] == b"session.zip"
    with zipfile.ZipFile(io.BytesIO(sent[ARCHIVE])) as archive:
        assert {name: archive.read(name) for name in archive.namelist()} == {
            "a.csv": b"a.csv",
            "b.csv": b"b.csv",
        }
    assert packages(()) == []


def test_an_archive_is_opened_under_its_own_name(shown: Shown) -> None:
    upload = SimpleNamespace(name="../lab.zip", content=b"PK\x03\x04")
    shown.panel._receive(SimpleNamespace(target=SimpleNamespace(value=upload)))
    (asked,) = shown.posted
    assert isinstance(asked, commands.OpenSession)
    assert (asked.name, asked.path.read_bytes()) == ("lab.zip", b"PK\x03\x04")
    empty = SimpleNamespace(name="empty.zip", content=b"")
    shown.panel._receive(SimpleNamespace(target=SimpleNamespace(value=empty)))
    assert "empty.zip: the file is empty" in shown.panel._opening.content
