"""Trials that are over are kept through a kill; those of something else are refused in words."""

import itertools
import json
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from io import FileIO
from stat import S_ISDIR

import pytest

from studio.engine.errors import FileError
from studio.engine.evaluate.journal import FILE, Journal, digest_of, header_of
from studio.engine.evaluate.runs import Trial, run_trials
from studio.engine.evaluate.trial import Outcome
from studio.engine.evaluate.variation import Variations
from tests.engine.evaluate.swings import WIDTHS, conditions, scene, swing

if sys.platform != "win32":
    import resource

DONE, NOT = Outcome(True, ""), Outcome(False, "the block still stands")


def header(motions=None, widths=WIDTHS, seed=0, **changes):
    return header_of(motions or [swing()], scene(), widths, seed) | changes


def kept(folder, outcomes) -> bytes:
    with Journal(folder, header()) as journal:
        for trial, outcome in enumerate(outcomes):
            journal.add(("swing", trial), outcome)
    return (folder / FILE).read_bytes()


def test_what_was_kept_is_known_again(tmp_path) -> None:
    content = kept(tmp_path / "new", [DONE, NOT])
    lines = [json.loads(line) for line in content.splitlines()]
    assert lines[1:] == [
        {"motion": "swing", "trial": 0, "done": True, "why": ""},
        {"motion": "swing", "trial": 1, "done": False, "why": "the block still stands"},
    ]
    with Journal(tmp_path / "new", header()) as journal:
        assert journal.known == {("swing", 0): DONE, ("swing", 1): NOT}


def test_wherever_a_kill_cuts_the_file_no_whole_line_is_lost(tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(os, "fsync", lambda _: None)  # some hundred times
    content = kept(tmp_path, [DONE, NOT, DONE])
    outcomes = {0: DONE, 1: NOT, 2: DONE}
    begins = [i + 1 for i, byte in enumerate(content) if byte == ord("\n")]
    for cut in (0, 1, begins[0] - 1, *range(begins[0], len(content) + 1)):
        (tmp_path / FILE).write_bytes(content[:cut])
        whole = sum(begin <= cut for begin in begins) - 1  # without the first line
        with Journal(tmp_path, header()) as journal:
            known = {trial: outcomes[trial] for trial in range(max(whole, 0))}
            assert journal.known == {("swing", trial): o for trial, o in known.items()}
            for trial in set(outcomes) - set(known):
                journal.add(("swing", trial), outcomes[trial])
        assert (tmp_path / FILE).read_bytes() == content


@contextmanager
def no_file_above(size: int) -> Iterator[None]:
    """As on a disk that is nearly full: what fits is written, then nothing more."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such limits")
@pytest.mark.parametrize("room", [0, 1, 30])
def test_where_the_disk_is_full_nothing_of_a_line_stays(tmp_path, room: int) -> None:
    with Journal(tmp_path, header()) as journal:
        journal.add(("swing", 0), DONE)
        before = (tmp_path / FILE).read_bytes()
        with no_file_above(len(before) + room):
            with pytest.raises(FileError, match=f"{FILE}: cannot be written: File too large"):
                journal.add(("swing", 1), NOT)
            assert (tmp_path / FILE).read_bytes() == before
        assert ("swing", 1) not in journal.known
        journal.add(("swing", 1), NOT)  # there is room again
        journal.add(("swing", 2), DONE)
    with Journal(tmp_path, header()) as journal:
        assert journal.known == {("swing", 0): DONE, ("swing", 1): NOT, ("swing", 2): DONE}


class Dripping(FileIO):
    """Takes few bytes at a time, and may not be cut."""

    is_stuck = False

    def write(self, content) -> int:
        if self.is_stuck and len(content) < 20:
            raise OSError(28, "No space left on device")
        return super().write(bytes(content[:7]))

    def truncate(self, size=None) -> int:
        if self.is_stuck:
            raise OSError(5, "Input/output error")
        return super().truncate(size)


def test_a_line_that_is_written_in_parts_is_whole_and_a_torn_one_is_cut_later(tmp_path) -> None:
    with Journal(tmp_path, header()) as journal:
        journal._file.close()
        journal._file = Dripping(journal.path, "ab")
        journal.add(("swing", 0), DONE)
        journal._file.is_stuck = True
        with pytest.raises(FileError, match="No space left"):
            journal.add(("swing", 1), NOT)
        assert not journal.path.read_bytes().endswith(b"\n")  # nothing could be done about it
        journal._file.is_stuck = False
        journal.add(("swing", 2), DONE)
    with Journal(tmp_path, header()) as journal:
        assert journal.known == {("swing", 0): DONE, ("swing", 2): DONE}


@pytest.mark.parametrize(
    ("clock", "syncs"), [(True, 3), (False, 10)], ids=["once a second", "each trial"]
)
def test_what_is_kept_is_brought_to_the_disk(tmp_path, monkeypatch, clock, syncs) -> None:
    times = itertools.count(100.0, 0.25)  # [s]
    synced: list[int] = []
    kept(tmp_path, [])  # the header, and the folder
    monkeypatch.setattr(os, "fsync", lambda file: synced.append(os.fstat(file).st_size))
    with Journal(tmp_path, header(), (lambda: next(times)) if clock else None) as journal:
        for trial in range(10):
            journal.add(("swing", trial), DONE)
        assert len(synced) == syncs
    assert synced[-1] == (tmp_path / FILE).stat().st_size  # by its end, all of it


def test_a_new_file_and_its_name_are_brought_to_the_disk(tmp_path, monkeypatch) -> None:
    synced: list[bool] = []
    real = os.fsync

    def sync(file: int) -> None:
        synced.append(S_ISDIR(os.fstat(file).st_mode))
        real(file)

    monkeypatch.setattr(os, "fsync", sync)
    kept(tmp_path / "new", [])
    assert synced == [False, True, False]


def test_a_disk_that_fails_is_told(tmp_path, monkeypatch) -> None:
    def fail(_: int) -> None:
        raise OSError(5, "Input/output error")

    journal = Journal(tmp_path, header())
    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(FileError, match=f"{FILE}: cannot be written: Input/output error"):
        journal.close()
    assert journal._file.closed


def test_known_trials_are_not_done_again(tmp_path) -> None:
    asked = [Trial(swing(), trial, conditions()) for trial in range(3)]
    told = []
    with Journal(tmp_path, header()) as journal:
        journal.add(("swing", 1), Outcome(False, "made up"))
        found = run_trials(asked, 1, journal, lambda over, of: told.append(over))
    assert found["swing", 1].why == "made up"
    assert told == [1, 2, 3]
    with Journal(tmp_path, header()) as journal:
        assert journal.known == found


@pytest.mark.parametrize(
    ("other", "words"),
    [
        (header(seed=1), "another seed"),
        (header(widths=Variations()), "other variations"),
        (header([swing("swing", -0.5)]), "another model, or other demonstrations"),
        (header(scene={}), "another scene"),
        (header(versions={"studio": "0"}), "another version of the studio or its libraries"),
        (header(format="a poem"), "no trials as this studio keeps them"),
    ],
)
def test_trials_of_something_else_are_refused(tmp_path, other, words: str) -> None:
    before = kept(tmp_path, [DONE])
    (tmp_path / FILE).write_bytes(
        before.replace(before.splitlines()[0], json.dumps(other).encode())
    )
    with pytest.raises(FileError, match=rf"{FILE}: holds .*{words}.*; choose another folder"):
        Journal(tmp_path, header())


def test_a_line_that_is_no_trial_is_named(tmp_path) -> None:
    content = kept(tmp_path, [DONE, NOT])
    (tmp_path / FILE).write_bytes(content.replace(b'"done": true', b'"done": "yes"'))
    with pytest.raises(FileError, match=f"{FILE}: line 2: expected motion, trial, done and why"):
        Journal(tmp_path, header())
    (tmp_path / FILE).write_bytes(b"\xff\xfe\n")
    with pytest.raises(FileError, match=f"{FILE}: line 1: "):
        Journal(tmp_path, header())


def test_one_evaluation_at_a_time_has_the_file(tmp_path) -> None:
    content = kept(tmp_path, [DONE])
    with Journal(tmp_path, header()) as journal:
        with pytest.raises(FileError, match=f"{FILE}: another evaluation is at work there; wait"):
            Journal(tmp_path, header())
        journal.add(("swing", 1), NOT)
    assert (tmp_path / FILE).read_bytes().startswith(content)
    with Journal(tmp_path, header()) as journal:
        assert journal.known == {("swing", 0): DONE, ("swing", 1): NOT}


def test_a_folder_that_cannot_be_used_is_named(tmp_path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match=r"file.*: cannot be used"):
        Journal(tmp_path / "file", header())


def test_a_digest_sees_every_bit_of_a_motion() -> None:
    motion = swing()
    assert digest_of(motion) == digest_of(replace(motion, wanted=motion.wanted.copy()))
    nudged = motion.wanted.copy()
    nudged[-1, -1] += 2e-16
    assert nudged[-1, -1] != motion.wanted[-1, -1]
    assert digest_of(replace(motion, wanted=nudged)) != digest_of(motion)
    assert digest_of(replace(motion, duration=0.6)) != digest_of(motion)
    assert digest_of(replace(motion, mapping="paper")) != digest_of(motion)
