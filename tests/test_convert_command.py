"""``studio convert``, as it is typed."""

import json

import pytest

from studio.cli import main
from studio.engine.resources import samples_folder

SAMPLE = samples_folder() / "teaches-the-push.jsonl"


def run(*arguments: object) -> int:
    with pytest.raises(SystemExit) as done:
        main([str(argument) for argument in arguments])
    return done.value.code


def test_a_file_is_converted_and_back(tmp_path, capsys):
    assert run("convert", SAMPLE, tmp_path / "a.mcap") == 0
    assert "frames" in capsys.readouterr().out
    assert run("convert", tmp_path / "a.mcap", tmp_path / "b.jsonl") == 0
    assert (tmp_path / "b.jsonl").read_bytes() == SAMPLE.read_bytes()


def test_one_object_tells_what_was_done(tmp_path, capsys):
    assert run("convert", SAMPLE, tmp_path / "a.jsonl.gz", "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert set(found) == {"source", "target", "format", "frames", "bodies", "notes"}
    assert found["frames"] == found["bodies"] > 100


def test_refusals_are_words_and_an_exit_status(tmp_path, capsys):
    (tmp_path / "a.jsonl").write_text("precious")
    for target, words in (("a.jsonl", "--force"), ("a.txt", ".jsonl.gz, .mcap")):
        assert run("convert", SAMPLE, tmp_path / target, "--json") == 1
        printed = capsys.readouterr()
        assert words in printed.err
        assert set(json.loads(printed.out)) == {"error"}
    assert (tmp_path / "a.jsonl").read_text() == "precious"
    assert run("convert", SAMPLE, tmp_path / "a.jsonl", "--force") == 0
