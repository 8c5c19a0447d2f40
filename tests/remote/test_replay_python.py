"""The paper's task over the wire, by a Python program of its own: taught, learned, replayed."""

import json
from pathlib import Path

import pytest

from tests.remote.house import ROOT, House, open_house

DOWN = "the block is down\n"
SPEED = 3.0  # of the session's time: the example goes by that, and so takes a third


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    with open_house(tmp_path_factory.mktemp("house"), SPEED) as opened:
        yield opened


@pytest.fixture(scope="module")
def taught(house: House, tmp_path_factory) -> tuple[Path, str]:
    """The model that the example learned, step by step, and what it printed then."""
    model = tmp_path_factory.mktemp("model") / "model.json"
    return model, replay(house, model, "--teach", "--synchronous")


def replay(house: House, *arguments: str | Path, tries: int = 1) -> str:
    example = ROOT / "docs" / "examples" / "replay_from_outside.py"
    return house.run_python(example, *arguments, tries=tries)


def test_synchronous_it_teaches_and_replays(house: House, taught: tuple[Path, str]) -> None:
    model, printed = taught
    assert printed == DOWN
    assert json.loads(model.read_text())["learner"] == "RBFRegressor"
    types = house.overheard.types("asked")
    assert {"take_clock", "step", "set_joint_target", "do", "fetch", "control"} <= types


def test_without_waiting_it_teaches_and_replays_in_real_time(house: House, tmp_path: Path) -> None:
    model = tmp_path / "model.json"
    before = len(house.now.entries)
    assert replay(house, model, "--teach", tries=3) == DOWN
    assert len(house.now.entries) > before
    assert json.loads(model.read_text())["learner"] == "RBFRegressor"
    assert "subscribe" in house.overheard.types("asked")
    assert "block" in house.overheard.types("told")


def test_by_blocking_calls_it_replays(house: House, taught: tuple[Path, str]) -> None:
    answered = house.overheard.count("told", "done")
    assert replay(house, taught[0], "--blocking", tries=3) == DOWN
    assert house.overheard.count("told", "done") > answered + 100  # each target's
