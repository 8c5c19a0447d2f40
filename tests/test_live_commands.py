"""`studio listen` and `studio play`, as processes: the whole way over the wire, and their words."""

import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from studio.cli import main
from studio.engine import clock, commands
from studio.engine.clock import BADLY_LATE, LiveLoop
from studio.engine.live.access import Address
from studio.engine.live.listener import MOST_CONNECTIONS, Listener
from studio.engine.live.reception import FASTEST, LARGEST_MESSAGE, SILENCE
from studio.engine.live.source import LiveSource
from studio.engine.resources import samples_folder
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.session import Session
from studio.engine.skeleton import HandState
from studio.engine.snapshot import Mode
from studio.engine.sources import read_skeletons, write_skeletons
from tests.engine.live.streaming import eventually, publisher, signing
from tests.engine.people import hand_stream, held

ROOT = Path(__file__).resolve().parent.parent
SIGNS = held((HandState.LASSO, 14), (HandState.OPEN, 14), (HandState.CLOSED, 300))
ANY_PORT = Address("127.0.0.1", 0)


@pytest.fixture
def here(capfd):
    """Run a command in this process; any exception but an exit fails the test."""

    def run(*arguments: str | Path) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as ended:
            main([str(argument) for argument in arguments])
        printed, said = capfd.readouterr()
        return int(ended.value.code or 0), printed, said

    return run


@contextmanager
def process(*arguments: str | Path) -> Iterator[subprocess.Popen[str]]:
    """A ``python -m studio`` of its own, which never outlives the test."""
    started = subprocess.Popen(
        [sys.executable, "-m", "studio", *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    try:
        yield started
    finally:
        if started.poll() is None:
            started.kill()
        started.communicate()


@pytest.fixture
def live() -> LiveSource:
    return LiveSource(clock.now)


@pytest.fixture
def signs(tmp_path: Path) -> Path:
    path = tmp_path / "signs.jsonl"
    write_skeletons(path, hand_stream(SIGNS))
    return path


@pytest.mark.parametrize("kind", ["jsonl", "node-kinect2", "kinectron"])
def test_play_sends_every_frame_when_it_is_due(here, live, tmp_path, monkeypatch, kind) -> None:
    """Each is planned from the beginning, not from the one before: so nothing drifts."""
    path = tmp_path / "short.jsonl"
    write_skeletons(path, hand_stream(SIGNS[:30]))
    dues: list[float] = []
    told: list[str] = []

    def noted(due: float, _) -> None:
        dues.append(due)
        if len(dues) == 30:  # all but the last are on their way, which takes no time here
            eventually(lambda: any("driving" in words for words in told))

    monkeypatch.setattr("studio.live_commands.wait_until", noted)
    monkeypatch.setattr("studio.live_commands.log", told.append)
    with Listener(live, ANY_PORT) as listener:
        url = listener.address.url
        code, printed, _ = here("play", path, "--to", url, "--speed", "2", "--format", kind)
        eventually(lambda: live.status().publishers == 0)
    assert code == 0
    assert "sent 30 frames" in printed
    assert "status: driving" in " ".join(told)
    assert live.status().counts.received == 30
    assert np.allclose(np.array(dues) - dues[0], np.arange(30) / 60, atol=1e-6)


def test_play_takes_recordings_too(here, live) -> None:
    recording = samples_folder() / "demonstration-1.mcap"
    with Listener(live, ANY_PORT) as listener:
        code, printed, said = here(
            "play", recording, "--to", listener.address.url, "--speed", "40", "--json"
        )
    assert code == 0
    assert json.loads(printed)["sent"] > 300
    assert "skeletons alone" in said
    assert live.status().counts.received > 0


def test_play_loops_with_rising_stamps_and_ends_by_interruption(live, tmp_path: Path) -> None:
    path = tmp_path / "short.jsonl"
    write_skeletons(path, hand_stream(SIGNS[:5]))
    with Listener(live, ANY_PORT) as listener:
        with process("play", path, "--to", listener.address.url, "--loop", "--json") as playing:
            eventually(lambda: live.status().counts.received > 12, seconds=30.0)
            playing.send_signal(signal.SIGINT)
            printed, _ = playing.communicate(timeout=20.0)
        assert playing.returncode == 0
        assert json.loads(printed)["sent"] > 12
        assert live.status().counts.late == 0
        assert live.status().stream == 1


def test_play_repeats_what_the_studio_answers(here, live, signs: Path) -> None:
    with (
        Listener(live, ANY_PORT) as listener,
        publisher(listener.address.url) as first,
    ):
        first.send(signing(0.0, HandState.OPEN))
        eventually(lambda: live.status().driver != "")
        code, _, said = here("play", signs, "--to", listener.address.url, "--speed", "40")
    assert code == 0
    assert "status: waiting, reason: Publisher 1" in said


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--to", "ws://127.0.0.1:9"), "start the studio, or studio listen"),
        (("--to", "http://127.0.0.1:9"), "expected an address such as ws://127.0.0.1:8765"),
        (("--to", "nonsense"), "expected an address such as ws://127.0.0.1:8765"),
        (("--to", "ws://127.0.0.1:port"), "expected an address such as ws://127.0.0.1:8765"),
        (("--speed", "0"), "--speed: a number above 0"),
    ],
)
def test_play_says_what_is_wrong(here, signs: Path, arguments, words: str) -> None:
    code, printed, said = here("play", signs, *arguments, "--json")
    assert code == 1
    assert words in said
    assert words in json.loads(printed)["error"]


def test_play_needs_the_token_and_says_so(here, live, signs: Path) -> None:
    with Listener(live, ANY_PORT, token="open sesame") as listener:
        url = listener.address.url
        code, _, said = here("play", signs, "--to", url)
        assert (code, "this studio wants its token" in said) == (1, True)
        code, _, _ = here("play", signs, "--to", url, "--token", "open sesame", "--speed", "40")
        assert code == 0
        code, _, _ = here("play", signs, "--to", f"{url}/?token=open%20sesame", "--speed", "40")
        assert code == 0


def test_the_environment_holds_the_token_where_nobody_reads_it(here, live, signs, monkeypatch):
    monkeypatch.setenv("STUDIO_TOKEN", "öffne dich")
    with Listener(live, ANY_PORT, token="öffne dich") as listener:
        url = listener.address.url
        assert here("play", signs, "--to", url, "--speed", "40")[0] == 0
        assert here("play", signs, "--to", url, "--token", "another one")[0] == 1
    monkeypatch.setenv("STUDIO_TOKEN", "short")
    for command in ("listen", "serve"):
        code, _, said = here(command, "--listen", "127.0.0.1:0")
        assert (code, "8 characters" in said) == (1, True)
    monkeypatch.setenv("STUDIO_TOKEN", "")
    assert "add --token" in here("listen", "--listen", "0.0.0.0:0")[2]


def test_play_says_why_the_studio_hung_up(here, live, signs: Path) -> None:
    with Listener(live, ANY_PORT) as listener:

        def hang_up() -> None:
            eventually(lambda: live.status().counts.received > 5)
            listener.__exit__(None, None, None)

        closing = threading.Thread(target=hang_up)
        closing.start()
        code, _, said = here("play", signs, "--to", listener.address.url)
        closing.join()
    assert code == 1
    assert re.search(r"ended the connection after \d+ frames", said)


def test_listen_tells_counts_and_keeps_what_arrives(here, tmp_path: Path) -> None:
    kept, signs = tmp_path / "kept.jsonl", tmp_path / "signs.jsonl"
    write_skeletons(signs, hand_stream(SIGNS[:120]))
    with process("listen", "--listen", "127.0.0.1:0", "--record", kept, "--json") as listening:
        url = re.search(r"ws://\S+", listening.stderr.readline())[0]
        code, played, _ = here("play", signs, "--to", url, "--speed", "3")
        assert code == 0
        assert "sent 120 frames" in played
        listening.send_signal(signal.SIGINT)
        printed, said = listening.communicate(timeout=20.0)
    assert listening.returncode == 0
    found = json.loads(printed)
    counts = found["counts"]
    assert counts["received"] == 120
    waiting = 120 - counts["used"] - counts["dropped"]
    assert waiting in (0, 1)  # the newest one, where the end came before the next tick
    assert found["recorded"] == {"file": str(kept), "frames": 120}
    assert "drives with studio jsonl" in said
    before, after = read_skeletons(signs), read_skeletons(kept)
    assert len(after) == len(before)
    assert all(
        np.array_equal(a.positions, b.positions) and a.left_hand == b.left_hand
        for a, b in zip(before, after, strict=True)
    )
    assert np.allclose(np.diff(after.frame_times), 1 / 90, atol=1e-6)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("listen", "--listen", "0.0.0.0:0"), "add --token"),
        (("listen", "--listen", "8765"), "HOST:PORT"),
        (("listen", "--token", "short"), "8 characters"),
        (("listen", "--record", "/nowhere/at/all.jsonl"), "cannot be written"),
        (("serve", "--listen", "0.0.0.0:0"), "add --token"),
        (("--listen", "0.0.0.0"), "HOST:PORT"),
        (("listen", "--listen", "::1"), "IPv6 in brackets: [::1]:8765"),
    ],
)
def test_what_cannot_be_listened_to_is_said(here, arguments, words: str) -> None:
    code, _, said = here(*arguments)
    assert code == 1
    assert words in said


def test_a_killed_process_leaves_the_studio_running_and_disarmed(tmp_path, live, signs) -> None:
    """In real time: armed, killed without a word, disarmed; started again, signed, armed."""
    with (
        Listener(live, ANY_PORT) as listener,
        LiveLoop(lambda: Session(tmp_path, live=live)) as loop,
    ):
        session = loop.session
        session.post(commands.UseLive())
        session.post(commands.Watch())
        for _ in range(2):
            with process("play", signs, "--to", listener.address.url) as playing:
                eventually(lambda: session.snapshot.mode is Mode.ARMED, seconds=30.0)
                os.kill(playing.pid, signal.SIGKILL)
                eventually(lambda: session.snapshot.mode is Mode.WATCHING)
            assert session.snapshot.live.driver == ""
        begun, before = time.monotonic(), session.snapshot.time
        eventually(lambda: session.snapshot.time > before + 0.5)
        ticked = session.snapshot.time - before  # it ticks on, and no faster than the clock
        assert ticked < time.monotonic() - begun + BADLY_LATE + CONTROL_PERIOD


def test_the_page_on_live_streams_tells_the_limits() -> None:
    """And the port that all of our publishers send to."""
    told = " ".join((ROOT / "docs" / "live.md").read_text().split())
    for words in (
        f"up to {LARGEST_MESSAGE // 1024} KiB",
        f"{FASTEST:.0f} a second are read",
        f"{MOST_CONNECTIONS} publishers",
        f"nothing for {SILENCE:.0f} s",
        Address().url,
    ):
        assert words in told
