"""``studio evaluate``, as it is typed: what it prints and keeps, and a kill in the middle of it."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from studio import evaluate_command
from studio.cli import main
from studio.engine.resources import samples_folder
from studio.rbf import RBFRegressor, save_model
from tests.engine.evaluate.swings import SECONDS, scene, swing

ROOT = Path(__file__).resolve().parents[1]
SAMPLES = sorted(samples_folder().glob("*.mcap"))[:2]
# The scene of the swing, as a user would write it.
SCENE = f"""
words = "Hit the block."

[desk]
size = {list(scene().desk.size)}
position = {list(scene().desk.position)}
friction = {scene().desk.friction}

[[block]]
name = "block"
size = {list(scene().blocks[0].size)}
position = {list(scene().blocks[0].position)}
mass = {scene().blocks[0].mass}
friction = {scene().blocks[0].friction}

[[success]]
is = "down"
block = "block"
"""


def run(*arguments: object) -> int:
    with pytest.raises(SystemExit) as done:
        main(["evaluate", *(str(argument) for argument in arguments)])
    return done.value.code


@pytest.fixture(scope="module")
def swinging(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, ...]:
    """Return the arguments for a model that swings for half a second, and its scene."""
    folder = tmp_path_factory.mktemp("swing")
    times = np.linspace(0.0, SECONDS, 16)
    rows = swing().wanted[:16]
    network = RBFRegressor(8).fit(times[:, np.newaxis], rows)
    save_model(folder / "model.json", network, time_unit="s", duration=SECONDS)
    (folder / "swing.toml").write_text(SCENE)
    return str(folder / "model.json"), "--scene", str(folder / "swing.toml"), "--block", "6"


def test_a_model_is_told_as_json_and_as_words(swinging, capsys) -> None:
    assert run(*swinging, "--trials", 3, "--jobs", 1, "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert found["scene"] == "swing"
    assert found["widths"]["block"] == 0.06
    assert found["model"]["trials"] == 3
    assert found["demonstrations"] == []
    assert run(*swinging, "--trials", 3, "--jobs", 1) == 0
    printed = capsys.readouterr()
    assert f"{found['model']['successes']} of 3" in printed.out
    assert "studio: 3 of 3" in printed.err
    assert "not resumable: --out FOLDER would keep each trial" in printed.err


# The command, in a process that ends itself and its workers without any farewell, as a kill
# would end it, as soon as so many trials are kept: no clock, no chance.
KILLED = """
import os, signal, sys
from studio.cli import main
from studio.engine.evaluate.journal import Journal
keep = Journal.add
def add(journal, key, outcome):
    keep(journal, key, outcome)
    if len(journal.known) == {trials}:
        os.killpg(0, signal.SIGKILL)
Journal.add = add
main(sys.argv[1:])
"""


def killed_after(trials: int, arguments: tuple[str, ...]) -> None:
    """Start the command, and have it killed with its workers once so many trials are over."""
    process = subprocess.run(
        [sys.executable, "-c", KILLED.format(trials=trials), "evaluate", *arguments],
        cwd=ROOT,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        start_new_session=True,
        check=False,
    )
    assert process.returncode == -signal.SIGKILL, "it ended by itself"


LONG = ("--trials", "7", "--seed", "7")


@pytest.fixture(scope="module")
def whole(swinging, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return what comes of it in one go, in one process."""
    folder = tmp_path_factory.mktemp("whole")
    assert run(*swinging, *LONG, "--jobs", 1, "--out", folder) == 0
    return folder


@pytest.mark.parametrize("jobs", ["1", "2"])
def test_killed_half_way_and_started_again_it_gives_the_same_bytes(
    swinging, whole: Path, tmp_path: Path, jobs: str
) -> None:
    if jobs == "2":
        pytest.importorskip("joblib", reason="joblib comes with the extra compare")
    broken, given = tmp_path / "broken", (*swinging, *LONG)
    killed_after(3, (*given, "--jobs", jobs, "--out", str(broken)))
    before = (broken / "trials.jsonl").read_bytes()
    assert before.count(b"\n") == 1 + 3
    assert not (broken / "evaluation.json").exists()
    assert run(*given, "--jobs", 1, "--out", broken) == 0
    assert (broken / "trials.jsonl").read_bytes().startswith(before)
    for name in ("trials.jsonl", "evaluation.json", "evaluation.md", "evaluation.html"):
        assert (broken / name).read_bytes() == (whole / name).read_bytes(), name


def test_another_setting_under_the_same_folder_is_refused(swinging, tmp_path, capsys) -> None:
    kept = (*swinging, "--trials", 2, "--jobs", 1, "--out", tmp_path)
    assert run(*kept) == 0
    assert run(*kept, "--seed", 1) == 1
    assert "trials.jsonl: holds trials of another seed; choose another" in capsys.readouterr().err
    assert run(*kept, "--mass", 10) == 1
    assert "other variations" in capsys.readouterr().err
    assert run(*kept[:-4], "--trials", 3, "--jobs", 1, "--out", tmp_path) == 0  # more of the same
    said = capsys.readouterr().err
    assert "going on after 2 trials" in said
    assert "not resumable" not in said


def test_a_models_scene_is_not_known_and_that_is_said(tmp_path, swinging, capsys) -> None:
    words = "a model's file does not know its scene: judged in push-down; --scene says another"
    assert run(swinging[0], "--trials", 1, "--jobs", 1) == 0
    assert words in capsys.readouterr().err
    assert run(*swinging, "--trials", 1, "--jobs", 1) == 0
    assert words not in capsys.readouterr().err


def test_recordings_are_learned_and_stand_beside_what_they_taught(tmp_path, capsys) -> None:
    given = (*SAMPLES, "--trials", 2, "--replays", 1, "--jobs", 1, "--only", "mass")
    assert run(*given, "--neurons", 12, "--json", "--out", tmp_path) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["scene"], found["model"]["name"]) == ("push-down", "rbf 12")
    assert [each["trials"] for each in found["demonstrations"]] == [1, 1]
    assert found["widths"]["block"] == 0
    assert found["widths"]["mass"] > 0
    assert json.loads((tmp_path / "evaluation.json").read_text()) == found
    assert not (tmp_path / "evaluation.svg").exists()


def test_several_networks_give_the_picture(tmp_path, capsys) -> None:
    given = (*SAMPLES, "--neurons", 4, 1, "--learner", "rbf", "--trials", 1, "--jobs", 1)
    assert run(*given, "--only", "latency", "--out", tmp_path, "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert [cell["neurons"] for cell in found["cells"]] == [1, 4]
    assert found["needed"]["rbf"]["neurons"] in (1, 4)
    assert (tmp_path / "evaluation.svg").read_text().startswith("<svg")


def test_without_joblib_it_says_how_it_would_be_faster(swinging, capsys, monkeypatch) -> None:
    monkeypatch.setattr(evaluate_command, "has_joblib", lambda: False)
    assert run(*swinging, "--trials", 1, "--jobs", 1) == 0
    assert "one trial at a time; several at once need pip install" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("MODEL", SAMPLES[0]), "one model at a time; recordings beside it by --demonstrations"),
        (("MODEL", "--neurons", 5), "was learned already"),
        (("MODEL", "--neurons", 5, 6), "several networks are taught from recordings"),
        (("MODEL", "--arm", "both"), "a network of 4 joints; both arms"),
        (("MODEL", "--trials", 0), "trials: 1 to"),
        (("MODEL", "--jobs", 0), "jobs: how many at once"),
        (("MODEL", "--noise", 90), "noise: a variation of 0 to 10 degrees"),
        (("MODEL", "--block", 25), "block: a variation of 0 to 20 cm is possible, not 25"),
        (("MODEL", "--only"), "--only: one variation or more of block"),
        (("nowhere.mcap", "--replays", -1), "replays: 0 to"),
        (("nowhere.mcap", "--learner", "spline"), "--learner: one of rbf"),
        (("nowhere.mcap", "--learner", "spline", "rbf"), "spline has no neurons"),
        (("MODEL", "--scene", "nowhere"), "there is no scene 'nowhere'"),
        ((SAMPLES[0], "--demonstrations", SAMPLES[1]), "beside a model's file"),
        ((SAMPLES[0], "--learner", "spline"), "--learner: one of rbf"),
        ((SAMPLES[0], "--learner", "spline", "rbf"), "spline has no neurons"),
        (("nowhere.mcap",), "nowhere.mcap"),
    ],
)
def test_what_cannot_be_done_is_said(swinging, arguments, words: str, capsys) -> None:
    given = [swinging[0] if argument == "MODEL" else argument for argument in arguments]
    assert run(*given) == 1
    assert words in capsys.readouterr().err
