"""The commands as a shell sees them: exit status, one JSON object, errors in words.

Each is a process at least once, here or in the tests of its own; all else is asked of `main` in
this process, which has started already.
"""

import gzip
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from studio.cli import COMMANDS, main
from studio.engine.resources import samples_folder
from studio.engine.skeleton import HandState
from studio.engine.sources import write_skeletons
from studio.engine.sources.demonstrator import demonstrate

ROOT = Path(__file__).resolve().parent.parent
REAL = ROOT.parent / "shared" / "data" / "kinect"


def studio(*arguments: str | Path, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run ``python -m studio`` from any folder; an unexpected traceback fails the test."""
    done = subprocess.run(
        [sys.executable, "-m", "studio", *map(str, arguments)],
        capture_output=True,
        text=True,
        cwd=cwd,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        check=False,
        timeout=120,
    )
    assert "Traceback" not in done.stderr, done.stderr
    return done


@pytest.fixture
def here(capfd):
    """Run a command in this process, which is quicker; any exception but an exit fails the test."""

    def run(*arguments: str | Path) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as ended:
            main([str(argument) for argument in arguments])
        printed, said = capfd.readouterr()
        return int(ended.value.code or 0), printed, said

    return run


def test_the_headless_demo_prints_one_object_and_the_same_one(
    tmp_path: Path, here, monkeypatch
) -> None:
    """In a process of its own and in this one, which has done other things before."""
    command = ("demo", "--headless", "--json", "--demonstrations", "2", "--mapping", "paper")
    monkeypatch.chdir(tmp_path)
    first, second = studio(*command, cwd=tmp_path), here(*command)
    assert first.returncode == second[0] == 0
    assert first.stdout == second[1]
    found = json.loads(first.stdout)
    assert found["joints"] == ["left_s0", "left_s1", "left_e1"]
    assert found["reproduction"]["block_down"] is True
    assert [d["block_down"] for d in found["demonstrations"]] == [True, True]
    assert [f["path"] for f in found["files"]] == ["demonstrator:1", "demonstrator:2"]
    assert list(tmp_path.iterdir()) == []


def test_another_scene_is_asked_for_by_its_name(here) -> None:
    command = ("demo", "--headless", "--json", "--demonstrations", "1", "--scene")
    found = json.loads(here(*command, "two-in-order")[1])
    assert found["scene"] == "two-in-order"
    assert found["reproduction"]["task_done"] is True
    assert found["reproduction"]["missing"] == ""
    status, printed, _ = here(*command, "two-in-a-row")
    assert status == 1
    assert "two-in-order" in json.loads(printed)["error"]


def test_teaching_from_the_samples(tmp_path: Path, here) -> None:
    samples = sorted(samples_folder().glob("*.mcap"))
    assert len(samples) == 4
    done = studio("teach", *samples, "--json", cwd=tmp_path)
    assert done.returncode == 0
    found = json.loads(done.stdout)
    assert found["reproduction"]["block_down"] is True
    assert all(each["block_down"] for each in found["demonstrations"])
    status, printed, _ = here(
        "teach", samples_folder() / "teaches-the-push.jsonl", "--save", tmp_path / "kept"
    )
    assert status == 0
    assert "Block down: alone yes" in printed
    _, printed, _ = here("teach", tmp_path / "kept" / "demonstration-001.mcap", "--json")
    assert json.loads(printed)["files"][0]["armed_frames"] > 150


def test_both_arms_are_taught_in_a_mirror_and_calibrated_in_words(here) -> None:
    sample = samples_folder() / "demonstration-1.mcap"
    status, printed, _ = here("teach", sample, "--arm", "both", "--mirror", "--json")
    found = json.loads(printed)
    assert status == 0
    assert found["arm"] == "both"
    assert found["joints"] == [
        f"{side}_{joint}" for side in ("left", "right") for joint in ("s0", "s1", "e0", "e1")
    ]
    assert "followed anew" in found["files"][0]["format"]
    for start, words in (("0", "you moved"), ("-1", "0 s or more into the file, not at -1.0 s")):
        status, _, said = here("teach", sample, "--calibrate-at", start)
        assert status == 1
        assert f"{sample}, {start} s into it: " in said
        assert words in said


def test_where_nothing_arms(here) -> None:
    status, printed, said = here("teach", samples_folder() / "never-arms.jsonl", "--json")
    assert status == 1
    found = json.loads(printed)
    assert found["files"][0]["armed"] == []
    assert "waiting for Lasso" in found["error"]
    assert "waiting for Lasso" in said


def test_a_file_without_hand_states_moves_only_on_request(tmp_path: Path, here) -> None:
    path = tmp_path / "table.csv"
    rows = [",".join(f"{x:.5f}" for x in s.positions.ravel()) for s in demonstrate(0, 1)]
    path.write_text("\n".join(rows))
    status, printed, _ = here("teach", path, "--json")
    assert status == 1
    assert "--gate open" in json.loads(printed)["error"]
    moved = json.loads(here("teach", path, "--gate", "open", "--json")[1])
    assert moved["files"][0]["armed_frames"] == moved["files"][0]["frames"]


def test_inspect_tells_what_is_in_a_file(here) -> None:
    found = json.loads(studio("inspect", samples_folder() / "never-arms.jsonl", "--json").stdout)
    assert set(found) == {
        *("format", "frames", "seconds", "bodies", "left_hand", "right_hand", "tracking"),
        *("duplicate_frames", "dropped_frames", "gate", "mirrored", "lean_deg"),
        *("motion", "person", "problems", "recorded"),
    }
    assert found["left_hand"]["closed"] > 0
    assert found["gate"]["armed"] == []
    asked = ("--arm", "both", "--mapping", "paper", "--json")
    told = json.loads(here("inspect", samples_folder() / "demonstration-1.mcap", *asked)[1])
    assert told["format"] == "studio mcap 1"
    assert told["recorded"]["gate"]["armed_frames"] > 100
    assert [(arm["arm"], arm["mapping"]) for arm in told["motion"]] == [
        ("left", "paper"),
        ("right", "paper"),
    ]


def broken_files(folder: Path) -> list[Path]:
    take = demonstrate(0, 1, (HandState.LASSO,))
    write_skeletons(folder / "good.jsonl", take)
    text = (folder / "good.jsonl").read_bytes()
    sample = (samples_folder() / "demonstration-1.mcap").read_bytes()
    contents = {
        "empty": b"",
        "binary": bytes(range(256)) * 4,
        "cut.jsonl": text[:5000],
        "cut.gz": gzip.compress(text)[:300],
        "nan.csv": b",".join([b"nan"] * 75),
        "head.mcap": sample[:100],
        "deep.json": b"[" * 100_000,
    }
    for name, content in contents.items():
        (folder / name).write_bytes(content)
    return [folder / name for name in contents] + [folder / "missing", folder]


def test_broken_files_give_words_and_no_traceback(tmp_path: Path, here) -> None:
    for path in broken_files(tmp_path):
        for command in (("teach", path, "--json"), ("inspect", path)):
            status, printed, said = here(*command)
            assert status == 1, command
            assert str(path) in said
            assert command[0] == "inspect" or json.loads(printed)["files"] == []
    ended = studio("teach", tmp_path / "empty")  # as a process: nothing follows the words
    assert (ended.returncode, ended.stdout) == (1, "")


@pytest.mark.parametrize(
    ("command", "status", "told"),
    [
        (("convert", samples_folder() / "never-arms.jsonl", "people.mcap"), 0, "frames"),
        (("export", "missing.zip", "--to", "results"), 1, "missing.zip"),
        (("link", "check", "nowhere"), 1, "nowhere"),
        (("webcam", "--help"), 0, "usage: studio webcam"),
    ],
    ids=lambda each: each[0] if isinstance(each, tuple) else "",
)
def test_commands_that_no_other_test_starts_as_processes(command, status, told, tmp_path) -> None:
    done = studio(*command, cwd=tmp_path)
    assert done.returncode == status, done.stderr
    assert told in (done.stderr if status else done.stdout)


@pytest.mark.parametrize(
    "command", [(), *((name,) for name in COMMANDS)], ids=lambda each: " ".join(each) or "none"
)
def test_help_reads(command: tuple[str, ...], here) -> None:
    status, printed, _ = here(*command, "--help")
    assert status == 0
    assert "usage: studio" in printed


def test_no_command_waits_for_what_only_some_need() -> None:
    """Half of what a process of ours waited for was loading filters that measuring needs."""
    loaded = "import sys, studio.cli; print('scipy.signal' in sys.modules, 'viser' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", loaded], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert done.stdout == "False False\n"


def test_the_help_of_a_switch_says_what_it_switches(here) -> None:
    words = " ".join(here("serve", "--help")[1].replace("│", " ").split())
    assert "--no-browser Only print the page's address, open no browser. --" in words


def test_a_reader_that_leaves_gives_no_traceback() -> None:
    """As ``studio inspect FILE | head`` does, here with a reader that leaves at once."""
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "w") as pipe:
        done = subprocess.run(
            [sys.executable, "-m", "studio", "inspect", samples_folder() / "never-arms.jsonl"],
            stdout=pipe,
            stderr=subprocess.PIPE,
            text=True,
            cwd=ROOT,
            check=False,
        )
    assert done.stderr == ""


def test_teaching_from_no_file_says_what_is_missing(here) -> None:
    status, _, said = here("teach")
    assert status == 1
    assert "studio teach FILE" in said


def test_an_open_gate_is_not_what_is_missing_where_nobody_is_seen(tmp_path: Path, here) -> None:
    (tmp_path / "empty.json").write_text('{"version": "0.3", "frames": [{"bodies": []}]}')
    status, _, said = here("teach", tmp_path / "empty.json", "--gate", "open")
    assert status == 1
    assert "nobody in sight" in said
    assert "--gate open" not in said


def test_a_sweep_prints_one_object_and_writes_a_page_that_needs_no_network(tmp_path: Path) -> None:
    command = ("sweep", "--neurons", "15", "5", "--learner", "rbf", "--json")
    done = studio(*command, "--html", tmp_path / "report.html", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert [(row["learner"], row["neurons"]) for row in found["rows"]] == [("rbf", 5), ("rbf", 15)]
    assert found["rows"][1]["floor_ratio"] < found["rows"][0]["floor_ratio"]
    assert found["alone"]["rbf"]["block_down"] is True
    page = (tmp_path / "report.html").read_text()
    assert not re.findall(r"(?:src|href|url)\W{1,3}(?:https?:)?//", page)
    assert page.count("<svg") > 10


def test_a_sweep_says_what_it_cannot_do(tmp_path: Path, here) -> None:
    one = samples_folder() / "demonstration-1.mcap"
    for options, words in (
        (("--learner", "magic"), "unknown learner 'magic'; there are newrb, rbf"),
        (("--neurons", "0"), "neurons: 1 to 1000, not 0"),
        ((one, "--neurons", "5", "--learner", "spline"), "give two or more"),
        ((samples_folder() / "never-arms.jsonl",), "waiting for Lasso"),
        (("--neurons", "5", "--learner", "rbf", "--html", tmp_path), "cannot be written"),
    ):
        status, _, said = here("sweep", *options)
        assert status == 1
        assert words in said


def test_impossible_options_are_refused_in_words(here) -> None:
    for command in (
        ("demo", "--headless", "--neurons", "0"),
        ("demo", "--demonstrations", "0"),
        ("demo", "--headless", "--seed", "-1"),
    ):
        status, _, said = here(*command)
        assert status == 1
        assert command[-2].lstrip("-") in said
    assert here("demo", "--mapping", "guess")[0] == 2


needs_real_data = pytest.mark.skipif(not REAL.is_dir(), reason=f"needs real recordings at {REAL}")


@needs_real_data
def test_the_one_true_sequence_in_a_real_recording_arms_and_teaches(here) -> None:
    _, printed, _ = here("teach", REAL / "kinect2-socket" / "hands_gestures.json.gz", "--json")
    (file,) = json.loads(printed)["files"]
    ((first, last),) = file["armed"]
    assert abs(first - 485) <= 3
    assert last == file["frames"] - 1 == 534


@needs_real_data
@pytest.mark.parametrize("name", ["test_record.json", "hand_flap.json.gz"])
def test_real_recordings_without_the_sequence_never_arm(name: str, here) -> None:
    status, printed, _ = here("teach", REAL / "kinect2-socket" / name, "--json")
    assert status == 1
    assert json.loads(printed)["files"][0]["armed"] == []


@needs_real_data
def test_a_real_recording_without_hand_states_stays_still_until_the_gate_is_opened(here) -> None:
    path = REAL / "labanotation" / "Ges01_wavehand.csv"
    assert here("teach", path, "--json")[0] == 1
    _, printed, _ = here("teach", path, "--gate", "open", "--json")
    assert json.loads(printed)["files"][0]["armed_frames"] == 154


@needs_real_data
def test_every_real_file_is_inspected_or_refused_in_words(here) -> None:
    for path in sorted(p for p in REAL.glob("*/*") if p.is_file()):
        status, printed, said = here("inspect", path, "--json")
        if status == 0:
            assert json.loads(printed)["frames"] > 0
        else:
            assert str(path) in said
