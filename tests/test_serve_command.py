"""`studio serve` for programs: with a page and without one, and what it says where it cannot."""

import os
import re
import signal
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from studio.cli import main
from studio.remote import UnreachableError, connect
from tests.remote.overheard import tapped

ROOT = Path(__file__).resolve().parent.parent
WITHOUT_VISER = "import sys; sys.modules['viser'] = None; from studio.cli import main; main()"
ANYWHERE = ("--listen", "127.0.0.1:0", "--remote", "127.0.0.1:0")


@contextmanager
def served(*command: str, **environment: str) -> Iterator[subprocess.Popen[str]]:
    """A studio of its own, which never outlives the test."""
    started = subprocess.Popen(
        [sys.executable, *command],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT), **environment},
    )
    try:
        yield started
    finally:
        if started.poll() is None:
            started.kill()
        started.communicate()


def printed(studio: subprocess.Popen[str], pattern: str) -> str:
    """The address on the first line that has one of the kind."""
    for line in studio.stdout or ():
        if found := re.search(pattern, line):
            return found[1]
    raise AssertionError(studio.stderr.read() if studio.stderr else "")


__all__ = ["tapped"]  # a fixture
REMOTE = r"Programs are let in at (ws://\S+)"


def test_without_a_page_it_needs_no_viser_and_ends_by_ctrl_c(tmp_path: Path, tapped) -> None:
    command = ("-c", WITHOUT_VISER, "serve", "--no-page", *ANYWHERE, "--recordings", str(tmp_path))
    with served(*command, STUDIO_TOKEN="eight-letters") as server:
        url = printed(server, REMOTE)
        with pytest.raises(UnreachableError, match="wants its token"):
            connect(url)
        with connect(url, "eight-letters", timeout=20.0) as studio:
            samples = studio.wait_for(lambda now: len(now.entries) == 4)
            assert samples.entries[0].name == "demonstration-1"
            server.send_signal(signal.SIGINT)
            assert server.wait(30.0) == 0


def test_beside_the_page(tmp_path: Path, tapped) -> None:
    command = ("serve", "--no-browser", "--port", "0", *ANYWHERE, "--recordings", str(tmp_path))
    with served("-m", "studio", *command) as server:
        url = printed(server, REMOTE)
        page = printed(server, r"is at (http://127\.0\.0\.1:\d+)")
        with urllib.request.urlopen(page, timeout=20.0) as answer:
            assert b"<html" in answer.read()
        with connect(url, timeout=20.0) as studio:
            assert studio.control("ask").controls


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--no-page",), "--no-page: then only programs reach the studio: add --remote"),
        (("--no-page", "--remote", "here"), "--remote: expected HOST:PORT, such as"),
        (("--no-page", "--remote", "0.0.0.0:0"), "--remote 0.0.0.0:0: beyond this machine a token"),
        (
            ("--no-page", "--remote", "192.0.2.1:80", "--token", "eight-letters"),
            "cannot listen for",
        ),
    ],
)
def test_what_cannot_be_is_said_in_words(capfd, tmp_path, arguments, words: str) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["serve", *arguments, "--listen", "127.0.0.1:0", "--recordings", str(tmp_path)])
    assert ended.value.code == 1
    assert words in capfd.readouterr().err
