"""``studio export``, as it is typed."""

import json
from pathlib import Path

import numpy as np
import pytest

from studio.cli import main
from studio.engine.export.session_reader import open_session
from studio.engine.resources import samples_folder
from studio.rbf import load_model

SAMPLES = sorted(samples_folder().glob("*.mcap"))[:2]


def run(*arguments: object) -> int:
    with pytest.raises(SystemExit) as done:
        main(["export", *(str(argument) for argument in arguments)])
    return done.value.code


def test_a_folder_of_kinds(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = (*SAMPLES, "--to", tmp_path / "out", "--neurons", 12, "--json")
    assert run(*given, "--kinds", "csv", "npz", "mcap", "model", "zip") == 0
    found = json.loads(capsys.readouterr().out)
    names = {Path(file["path"]).name for file in found["files"]}
    assert {"demonstrations.csv", "comparison.csv", "data.npz", "recording-002.mcap"} <= names
    assert names == {path.name for path in (tmp_path / "out").iterdir()}
    assert len(load_model(tmp_path / "out" / "model.json").estimator.centers_) == 12


def test_a_session_is_exported_and_taken_up_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    session = tmp_path / "mine.zip"
    assert run(*SAMPLES, "--to", session, "--learner", "newrb", "--neurons", 9) == 0
    assert "mine.zip: " in capsys.readouterr().out
    assert [path.name for path in tmp_path.iterdir()] == ["mine.zip"]
    assert run(session, "--to", tmp_path / "model.json") == 0
    model = load_model(tmp_path / "model.json").estimator
    opened = open_session(session).lesson
    index = np.linspace(1.0, 142.0, 300)
    assert opened.settings.name == "newrb"
    assert model.predict(index).tobytes() == opened.model.predict(index).tobytes()


def test_a_session_without_names(tmp_path: Path) -> None:
    session = tmp_path / "mine.zip"
    assert run(SAMPLES[0], "--to", session, "--anonymous") == 0
    opened = open_session(session)
    assert [take.demonstration.name for take in opened.takes] == ["demonstration 1"]
    assert opened.recordings[0].info.source == "recording 1"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "--to: a folder"),
        (("--to", "a.webm", "--kinds", "csv"), "one .webm file is not csv"),
        (("--to", "a.zip", "--kinds", "zip", "npz"), "give a folder"),
        (("nowhere.mcap", "--to", "out"), "nowhere.mcap"),
        (("--to", "a.zip", "--neurons", "0"), "neurons: 1 to"),
    ],
)
def test_refusals_are_words_and_an_exit_status(
    arguments: tuple[str, ...],
    words: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(*arguments, "--json") == 1
    printed = capsys.readouterr()
    assert words in printed.err
    assert words in json.loads(printed.out)["error"]
    assert not list(tmp_path.iterdir())
