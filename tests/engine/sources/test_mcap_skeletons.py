import io
import json

import numpy as np
import pytest
from mcap.reader import make_reader

from studio.engine.errors import FileError
from studio.engine.mcap_log import LogWriter
from studio.engine.sources import mcap_skeletons, read_skeletons
from studio.engine.sources.family import Frame, ParsedFile
from studio.engine.sources.jsonl import frames_to_lines
from tests.engine.corruption import corrupted


@pytest.fixture
def parsed(made):
    a, b, later = made.skeleton(0, "a"), made.skeleton(0, "b", z=3.0), made.skeleton(2, "a")
    frames = [Frame(100.0, (a, b)), Frame(100.05), Frame(later.time, (later,))]
    return ParsedFile("test", frames, has_hand_states=True, has_tracking=False, has_stamps=True)


@pytest.fixture
def path(tmp_path, parsed):
    mcap_skeletons.write(tmp_path / "a.mcap", parsed)
    return tmp_path / "a.mcap"


def test_a_file_comes_back_to_the_last_bit(path, parsed):
    back = mcap_skeletons.read(path)
    assert list(frames_to_lines(back.frames)) == list(frames_to_lines(parsed.frames))
    assert (back.has_hand_states, back.has_tracking, back.has_stamps) == (True, False, True)
    assert [len(frame.bodies) for frame in back.frames] == [2, 0, 1]
    assert mcap_skeletons.holds_skeletons(path)
    assert len(read_skeletons(path, body="b")) == 1


def test_nobody_at_all_comes_back_too(tmp_path):
    for frames in ([], [Frame(1.0), Frame(2.0)]):
        mcap_skeletons.write(tmp_path / "a", ParsedFile("test", frames, False, True, True))
        assert mcap_skeletons.read(tmp_path / "a").frames == frames
        assert mcap_skeletons.holds_skeletons(tmp_path / "a")


def test_the_same_frames_give_the_same_bytes(tmp_path, path, parsed):
    mcap_skeletons.write(tmp_path / "b", parsed)
    assert (tmp_path / "b").read_bytes() == path.read_bytes()


def test_the_files_own_library_reads_it_with_its_schema(path):
    reader = make_reader(io.BytesIO(path.read_bytes()))
    found = [
        (schema.name, channel.topic, message.log_time, json.loads(message.data)["time"])
        for schema, channel, message in reader.iter_messages()
    ]
    stamps = [0, 0, 50_000_000, 66_666_667]
    assert [each[2] for each in found] == pytest.approx(stamps, abs=1)
    assert {each[:2] for each in found} == {("skeleton", "/skeleton")}


def test_damage_anywhere_is_a_file_error_or_costs_nothing(path, parsed):
    whole, lines = path.read_bytes(), list(frames_to_lines(parsed.frames))
    rng = np.random.default_rng(11)
    found = []
    for _ in range(150):
        path.write_bytes(corrupted(whole, rng))
        found.append(read_or_refused(path))
    assert found.count(None) > 50
    assert all(each in (None, [], lines) for each in found)  # a chunk comes whole or not at all


def read_or_refused(path) -> list[str] | None:
    """Return a file's lines, or None where it is refused by its name."""
    try:
        return list(frames_to_lines(mcap_skeletons.read(path).frames))
    except FileError as error:
        if str(path) not in str(error):
            raise
        return None


def test_a_file_cut_off_says_so(path):
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(FileError, match=r"a\.mcap: after [\d,]+ of [\d,]+ bytes.*cut off"):
        mcap_skeletons.read(path)


@pytest.mark.parametrize(
    ("topic", "message", "words"),
    [
        ("/gate", {}, "expected messages of /skeleton only, found one of '/gate'"),
        ("/skeleton", {"skeleton": 1}, r'message 0: expected "time"'),
        ("/skeleton", [], "message 0: expected a frame as an object"),
    ],
)
def test_other_messages_are_refused(tmp_path, topic, message, words):
    path = tmp_path / "odd.mcap"
    with path.open("wb") as file:
        log = LogWriter(file, {"holds": "skeletons"}, {topic: {"type": "object"}}, 1000)
        log.write(topic, 0, message, 0)
        log.finish()
    with pytest.raises(FileError, match=rf"odd\.mcap: {words}"):
        mcap_skeletons.read(path)


def test_what_is_no_such_file_is_told_apart(tmp_path):
    assert not mcap_skeletons.holds_skeletons(tmp_path / "missing")
    (tmp_path / "text").write_text("hello")
    assert not mcap_skeletons.holds_skeletons(tmp_path / "text")
    with pytest.raises(FileError, match="missing: cannot be read"):
        mcap_skeletons.read(tmp_path / "missing")
