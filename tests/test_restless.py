"""A minute of the soak in `tests/bench/bench_soak.py`: a session that is asked for anything."""

import logging
import threading
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

from studio.engine import commands
from studio.engine.pace import Pace
from studio.engine.resources import samples_folder
from studio.engine.snapshot import Mode
from studio.panels import app as app_module
from studio.panels.app import App
from tests.browser.opened import NoScene
from tests.restless import Kept, Restless, Watched

MINUTE = 60 * 30  # ticks, as fast as they go
SEED = 2
TURN = 0.01  # [s] for the other process to get its turn


def test_a_minute_of_anything(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Nothing that is asked for is a fault, and no recording is lost; the page draws all of it."""
    monkeypatch.setattr(app_module, "SceneView", NoScene)
    folder, safe = tmp_path / "recordings", tmp_path / "safe"
    folder.mkdir()
    safe.mkdir()
    before = threading.active_count()
    kept, seen, told = Kept(folder, safe), set(), set()
    session = Watched(kept)
    files = [path for path in samples_folder().iterdir() if path.suffix in (".mcap", ".jsonl")]
    asks = Restless(SEED, lambda: session.snapshot, sorted(files), patient=False).asks()
    ticks = 0
    with App(SimpleNamespace(session=session, pace=Pace()), port=0):
        while ticks < MINUTE:
            orders, seconds = next(asks)
            for order in orders:
                session.post(order)
            for _ in range(max(1, round(seconds * 30))):
                now = session.tick()
                ticks += 1
                kept.look(now)
                seen |= {now.mode, "learned" if now.lesson else ""}
                told.add(now.message.text)
                time.sleep(TURN if now.who.reading is not None else 0.0)
    session.close()
    kept.look(session.snapshot)
    assert not [words for words in told if "fault" in words]
    assert not [record for record in caplog.records if record.levelno >= logging.ERROR]
    assert kept.lost() == []
    assert kept.made >= 3
    assert {Mode.RECORDING, Mode.PLAYING, Mode.WATCHING, "learned"} <= seen
    assert threading.active_count() <= before + 1  # pools of the library end when they will


def test_what_is_lost_is_noticed(tmp_path: Path) -> None:
    """The soak can fail: a recording that is cut off is named, and one that is gone."""
    folder, safe = tmp_path / "recordings", tmp_path / "safe"
    folder.mkdir()
    safe.mkdir()
    sample = (samples_folder() / "demonstration-1.mcap").read_bytes()
    for number, content in enumerate((sample, sample[: len(sample) // 2], sample)):
        (folder / f"{number}.mcap").write_bytes(content)
    kept = Kept(folder, safe)
    for _ in range(2):
        kept.look(SimpleNamespace(mode=Mode.IDLE))
    (folder / "2.mcap").unlink()
    lost = kept.lost()
    assert kept.made == 3
    assert len(lost) == 2
    assert any("1.mcap" in words for words in lost)
    assert "2.mcap: gone" in lost


def test_a_take_that_replaces_another_is_not_taken_for_a_loss(tmp_path: Path) -> None:
    """The old file goes with the next deletion, by a tick and not by a command."""
    folder, safe = tmp_path / "recordings", tmp_path / "safe"
    folder.mkdir()
    safe.mkdir()
    kept = Kept(folder, safe)
    session = Watched(kept)

    def ask(*orders: commands.Command) -> None:
        for order in orders:
            session.post(order)
        kept.look(session.tick())
        kept.look(session.tick())
        while session.snapshot.mode is not Mode.IDLE:
            kept.look(session.tick())
        kept.look(session.tick())

    for again in (commands.Record(), commands.Record(), commands.RecordAgain(1)):
        ask(commands.UseDemonstrator(), again)
    first = sorted(folder.iterdir())[0]
    ask(commands.Remove(session.snapshot.entries[-1].number))
    session.close()
    assert not first.exists()
    assert kept.made == 3
    assert kept.lost() == []
