"""Exports are packed and sent beside whoever asks for it, one after the other."""

import io
import threading
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from studio.panels.delivery import ARCHIVE, Delivery, packages
from studio.panels.trouble import TroubleLine
from tests.panels.controls import Gui

PATIENCE = 30.0  # [s]


class Receiver:
    """A browser that takes a file only when it is let."""

    def __init__(self) -> None:
        self.gui, self.got = Gui(), []
        self.let, self.begun = threading.Event(), threading.Event()
        self.trouble = TroubleLine(self.gui)
        self.delivery = Delivery(self.take, self.trouble.attempt)

    def take(self, name: str, content: bytes) -> None:
        self.begun.set()
        assert self.let.wait(PATIENCE)
        self.got.append((threading.current_thread().name, name, content))

    @property
    def words(self) -> str:
        self.trouble.draw()
        return self.gui.words


@pytest.fixture
def receiver() -> Iterator[Receiver]:
    made = Receiver()
    yield made
    made.let.set()
    made.delivery.close()


def written(folder: Path, *names: str) -> tuple[Path, ...]:
    folder.mkdir(exist_ok=True)
    for name in names:
        (folder / name).write_bytes(name.encode())
    return tuple(folder / name for name in names)


def through(receiver: Receiver) -> None:
    """Wait until all that was asked for is sent."""
    done = threading.Event()
    receiver.let.set()
    receiver.delivery._thread.submit(done.set)
    assert done.wait(PATIENCE)


def test_a_session_stays_a_file_of_its_own(tmp_path: Path) -> None:
    sent = dict(packages(written(tmp_path, "a.csv", "b.csv", "session.zip")))
    assert sent.keys() == {"session.zip", ARCHIVE}
    assert sent["session.zip"] == b"session.zip"
    with zipfile.ZipFile(io.BytesIO(sent[ARCHIVE])) as archive:
        assert {name: archive.read(name) for name in archive.namelist()} == {
            "a.csv": b"a.csv",
            "b.csv": b"b.csv",
        }
    assert list(packages(())) == []
    (alone,) = packages(written(tmp_path, "a.csv"))
    assert alone == ("a.csv", b"a.csv")


def test_nobody_waits_and_one_comes_after_the_other(receiver: Receiver, tmp_path: Path) -> None:
    files = [written(tmp_path, name) for name in ("a.csv", "session.zip", "b.csv")]
    for each in files:
        receiver.delivery.take(each)  # would wait for ever, did it send
    assert receiver.begun.wait(PATIENCE)
    assert receiver.got == []
    through(receiver)
    assert [name for _, name, _ in receiver.got] == ["a.csv", "session.zip", "b.csv"]
    (thread,) = {thread for thread, _, _ in receiver.got}
    assert thread.startswith("delivery")
    assert receiver.words == ""


def test_a_file_that_has_gone_meanwhile_is_told_in_words(
    receiver: Receiver, tmp_path: Path, caplog
) -> None:
    """The session removes an export's folder when the next one begins."""
    first, second, third = (
        written(tmp_path / folder, "a.csv", "b.csv") for folder in ("first", "second", "third")
    )
    for each in (first, second, third):
        receiver.delivery.take(each)
    assert receiver.begun.wait(PATIENCE)
    second[1].unlink()
    through(receiver)
    assert [name for _, name, _ in receiver.got] == [ARCHIVE, ARCHIVE]  # the others came
    assert "b.csv of the last export was not sent: a newer export took its place" in receiver.words
    assert caplog.records == []


def test_a_file_that_cannot_be_read_is_told_in_words(receiver: Receiver, tmp_path: Path) -> None:
    (tmp_path / "a.csv").mkdir()
    receiver.delivery.take((tmp_path / "a.csv",))
    through(receiver)
    assert "a.csv: cannot be sent" in receiver.words


def test_closing_ends_it(receiver: Receiver, tmp_path: Path) -> None:
    files = written(tmp_path, "one.zip", "two.zip", "a.csv", "b.csv")
    receiver.delivery.take(files)
    receiver.delivery.take(files)
    assert receiver.begun.wait(PATIENCE)
    closing = threading.Thread(target=receiver.delivery.close)
    closing.start()
    assert receiver.delivery._closing.wait(PATIENCE)
    receiver.let.set()
    closing.join(PATIENCE)
    assert not closing.is_alive()
    assert [name for _, name, _ in receiver.got] == ["one.zip"]  # which was on its way
    assert not [each for each in threading.enumerate() if each.name.startswith("delivery")]
