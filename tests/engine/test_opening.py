"""A session's archive comes over from another process in small parts, and is whole again."""

import pickle
from pathlib import Path

import numpy as np
import pytest

from studio.engine.commands import OpenSession
from studio.engine.errors import StudioError
from studio.engine.export import Job, session_file
from studio.engine.export.session_reader import open_session
from studio.engine.opening import Opening, Part, ReadSession, whole
from tests.engine.export.materials import done


@pytest.fixture
def archive(tmp_path: Path) -> Path:
    (path,) = session_file.write(done(neurons=20, count=2), Job(tmp_path))
    return path


def test_parts_make_the_whole_again(archive: Path) -> None:
    points = [pickle.loads(pickle.dumps(p)) for p in ReadSession(OpenSession(archive)).points()]
    there, here = open_session(archive), whole(tuple(points))
    assert here.setup == there.setup
    for ours, theirs in zip(here.takes, there.takes, strict=True):
        assert ours.included == theirs.included
        assert np.array_equal(ours.demonstration.sent, theirs.demonstration.sent)
        assert ours.recording.info == theirs.recording.info
        pairs = zip(ours.recording.samples, theirs.recording.samples, strict=True)
        assert all(np.array_equal(a.sent, b.sent) and a.time == b.time for a, b in pairs)
    assert here.learned_from == there.learned_from
    assert len(here.recordings) == len(there.recordings)


def test_no_part_is_long(archive: Path) -> None:
    parts = [p for p in ReadSession(OpenSession(archive)).points() if isinstance(p, Part)]
    assert max(len(part.samples) for part in parts) <= 100


def test_what_is_not_whole_is_refused() -> None:
    with pytest.raises(TypeError, match="ends with"):
        whole(())


def test_one_at_a_time(tmp_path: Path) -> None:
    opening = Opening()
    try:
        assert opening.poll() is None
        opening.open(OpenSession(tmp_path / "a.zip", "a.zip"))
        assert opening.name == "a.zip"
        with pytest.raises(StudioError, match=r"Cancel opening a\.zip first"):
            opening.open(OpenSession(tmp_path / "b.zip"))
        assert opening.cancel() == "Gave up opening a.zip."
        assert (opening.cancel(), opening.name, opening.poll()) == ("", "", None)
    finally:
        opening.close()
