"""The paper's task over the wire in plain JavaScript, by a program of its own."""

import os
import shutil
import subprocess
from functools import cache
from pathlib import Path

import pytest

from tests.remote.house import ROOT, House, open_house

DEBIANS_MODULES = "/usr/share/nodejs"
DOWN = "the block is down\n"
SPEED = 3.0  # of the session's time: the example goes by that, and so takes a third


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    with open_house(tmp_path_factory.mktemp("house"), SPEED) as opened:
        yield opened


@cache
def node() -> tuple[str, ...]:
    """The command that runs JavaScript with a WebSocket; nothing where there is none."""
    path = shutil.which("node")
    if path is None:
        return ()
    look = "process.exit(typeof WebSocket === 'function' ? 0 : 1)"
    for command in ((path,), (path, "--experimental-websocket")):
        if subprocess.run([*command, "-e", look], capture_output=True, check=False).returncode == 0:
            return command
    return (path,) if (Path(DEBIANS_MODULES) / "ws").exists() else ()


def replay(house: House, *arguments: str, tries: int = 1) -> str:
    if not node():
        words = "no Node with a WebSocket: install Node 22, or Debian's nodejs and node-ws"
        assert not os.environ.get("CI"), words
        pytest.skip(words)
    script = ROOT / "docs" / "examples" / "replay.mjs"
    command = (*node(), script, *arguments, "--url", house.url)
    return house.run(*command, tries=tries, NODE_PATH=DEBIANS_MODULES)


@pytest.fixture(scope="module")
def taught(house: House) -> str:
    return replay(house, "--teach", "--synchronous")


def test_synchronous_it_teaches_and_replays(taught: str) -> None:
    assert taught == DOWN


def test_without_waiting_it_teaches_and_replays_in_real_time(house: House) -> None:
    before = len(house.now.entries)
    assert replay(house, "--teach", tries=3) == DOWN
    assert len(house.now.entries) > before
    assert "subscribe" in house.overheard.types("asked")
    assert "joint_states" in house.overheard.types("told")


def test_by_blocking_calls_it_replays(house: House, taught: str) -> None:
    answered = house.overheard.count("told", "done")
    assert replay(house, "--blocking", tries=3) == DOWN
    assert house.overheard.count("told", "done") > answered + 100  # each target's
