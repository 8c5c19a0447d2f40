import pytest

from studio.engine.errors import FileError
from studio.engine.sources.whole_file import written_whole


def test_a_file_takes_its_name_when_it_is_whole(tmp_path):
    path = tmp_path / "a"
    with written_whole(path) as unfinished:
        unfinished.write_text("half")
        assert not path.exists()
        unfinished.write_text("whole")
    assert [(each.name, each.read_text()) for each in tmp_path.iterdir()] == [("a", "whole")]


def test_what_was_there_stays_where_writing_fails(tmp_path):
    path = tmp_path / "a"
    path.write_text("before")

    def fail():
        with written_whole(path) as unfinished:
            unfinished.write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail()
    assert [(each.name, each.read_text()) for each in tmp_path.iterdir()] == [("a", "before")]


def test_a_place_that_cannot_be_written_is_named(tmp_path):
    path = tmp_path / "missing" / "a"
    with pytest.raises(FileError, match="a: cannot be written: No such file"):  # noqa: SIM117
        with written_whole(path) as unfinished:
            unfinished.write_text("x")
