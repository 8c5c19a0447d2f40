"""The paper's task over the wire, by a Python program of its own: taught, learned, replayed."""

import json
from pathlib import Path

import pytest

from tests.remote.house import ROOT, House, open_house

DOWN = "the block is down\n"


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    with open_house(tmp_path_factory.mktemp("house")) as opened:
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


def test_without_waiting_it_replays_in_real_time(house: House, taught: tuple[Path, str]) -> None:
    model = json.loads(taught[0].read_text())
    model["time"]["duration_s"] *= 0.6
    quick = taught[0].with_name("quick.json")
    quick.write_text(json.dumps(model))
    assert replay(house, quick, tries=3) == DOWN
    assert "subscribe" in house.overheard.types("asked")
    assert "block" in house.overheard.types("told")
