import io
import json
import math
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.errors import FileError, StudioError
from studio.engine.skeleton import Hand, HandState, Skeleton
from studio.engine.sources import (
    frame_from_json,
    frame_to_json,
    jsonl,
    read_skeletons,
    skeleton_from_dict,
    skeleton_to_dict,
    write_skeletons,
)
from studio.engine.sources.family import TELLS, Frame, ParsedFile

numbers = st.floats(allow_nan=False, allow_infinity=False)
hands = st.builds(Hand, st.sampled_from(HandState), st.floats(0, 1))
names = st.text(st.characters(codec="utf-8"), min_size=1, max_size=9).filter(str.isprintable)


@st.composite
def skeletons(draw):
    seed = draw(st.integers(0, 2**32 - 1))
    rng = np.random.default_rng(seed)
    positions = rng.normal(size=(25, 3)) * 10.0 ** rng.integers(-300, 300, size=(25, 3))
    positions[0] = draw(st.tuples(numbers, numbers, numbers))
    return Skeleton(
        draw(st.floats(-1e12, 1e12)),
        positions,
        rng.integers(0, 3, 25),
        draw(hands),
        draw(hands),
        draw(names),
    )


def read(text: str) -> ParsedFile:
    return jsonl.read(text.split("\n"))


def same(a: Skeleton, b: Skeleton) -> bool:
    """Equal to the last bit, the sign of zero included."""
    return (
        np.float64(a.time).tobytes() == np.float64(b.time).tobytes()
        and a.positions.tobytes() == b.positions.tobytes()
        and a.tracking.tobytes() == b.tracking.tobytes()
        and (a.left_hand, a.right_hand, a.body_id) == (b.left_hand, b.right_hand, b.body_id)
    )


@settings(deadline=None, derandomize=True, max_examples=60)
@given(skeletons())
def test_a_frame_comes_back_to_the_last_bit(skeleton):
    line = frame_to_json(skeleton)
    assert "\n" not in line
    assert line.isascii()
    assert same(frame_from_json(line), skeleton)
    assert same(skeleton_from_dict(skeleton_to_dict(skeleton)), skeleton)


@settings(deadline=None, derandomize=True, max_examples=30)
@given(st.lists(skeletons(), min_size=1, max_size=6))
def test_a_file_comes_back_to_the_last_bit(frames):
    frames.sort(key=lambda skeleton: skeleton.time)
    stream = io.StringIO()
    write_skeletons(stream, frames)
    back = [body for frame in read(stream.getvalue()).frames for body in frame.bodies]
    assert len(back) == len(frames)
    assert all(map(same, back, frames))


def test_frames_with_nobody_and_the_stamps_survive(tmp_path, made):
    bodies = [made.skeleton(0), made.skeleton(3)]
    lines = [frame_to_json(bodies[0]), "", '{"skeleton": 1, "time": 100.05}\r']
    text = "\n".join([*lines, frame_to_json(bodies[1])])
    source, copy = tmp_path / "a.txt", tmp_path / "b.txt"
    source.write_text(text)
    recording = read_skeletons(source)
    write_skeletons(copy, recording)
    for each in (recording, read_skeletons(copy)):
        assert each.frame_times.tolist() == [100.0, 100.05, 100.1]
        assert each.frame_indices.tolist() == [0, 2]
        assert all(map(same, each, bodies))
    assert [path.name for path in tmp_path.iterdir() if "unfinished" in path.name] == []


def test_equal_times_are_one_frame_unless_a_body_comes_again(made):
    a, b = made.skeleton(0, "a"), made.skeleton(0, "b")
    nobody = '{"skeleton": 1, "time": 100.0}'
    lines = [*map(frame_to_json, (a, b, b, a, a)), nobody, frame_to_json(a)]
    frames = read("\n".join(lines)).frames
    assert [[body.body_id for body in frame.bodies] for frame in frames] == [
        ["a", "b"],
        ["b", "a"],
        ["a"],
        [],
        ["a"],
    ]


def test_all_bodies_of_all_frames_come_back(made):
    a, b, later = made.skeleton(0, "a"), made.skeleton(0, "b"), made.skeleton(2, "a")
    frames = [Frame(100.0, (a, b)), Frame(100.05), Frame(later.time, (later,))]
    back = read("".join(jsonl.frames_to_lines(frames))).frames
    assert [frame.time for frame in back] == [frame.time for frame in frames]
    for before, after in zip(frames, back, strict=True):
        assert len(before.bodies) == len(after.bodies)
        assert all(map(same, before.bodies, after.bodies))


def test_one_message_is_one_frame(made):
    body = made.skeleton(0)
    frame = jsonl.frame_from_message(skeleton_to_dict(body))
    assert (frame.time, len(frame.bodies)) == (body.time, 1)
    assert same(frame.bodies[0], body)
    assert jsonl.frame_from_message({"skeleton": 1, "time": 2.5}) == Frame(2.5)
    with pytest.raises(StudioError, match='"positions"'):
        jsonl.frame_from_message({"skeleton": 1, "time": 2.5, "body": "a"})


def test_hands_that_are_never_known_mean_no_hand_states(made):
    plain = Skeleton(0.0, made.standing(0), [2] * 25)
    assert not read(frame_to_json(plain)).has_hand_states
    assert read(frame_to_json(made.skeleton(1))).has_hand_states


@pytest.mark.parametrize("count", range(4))
def test_what_a_file_tells_is_said_in_its_first_line(made, count):
    bodies = tuple(made.skeleton(frame) for frame in range(3))
    frames = [Frame(body.time, (body,)) for body in bodies]
    for tells in combinations(TELLS, count):
        flags = [name in tells for name in TELLS]
        text = list(jsonl.file_to_lines(ParsedFile("x", frames, *flags)))
        assert read("".join(text)).tells == tells
        assert ["tells" in line for line in text] == [tells != TELLS, False, False]
        for line, body in zip(text, bodies, strict=True):  # what reads lines alone passes it over
            assert same(frame_from_json(line), body)
    empty = ParsedFile("x", [Frame(1.0)], True, True, True)
    assert read("".join(jsonl.file_to_lines(empty))).has_hand_states


def test_what_a_skeleton_file_does_not_tell_is_written_with_its_skeletons(tmp_path, made):
    source, copy = tmp_path / "a", tmp_path / "b"
    source.write_text(made.table_text(made.table_rows(75)))
    write_skeletons(copy, read_skeletons(source))
    found = read_skeletons(copy)
    assert not (found.has_hand_states)
    assert not (found.has_tracking)
    assert not (found.has_stamps)


@pytest.mark.parametrize("tells", [None, "tracking", ["faces"], [["tracking"]], [1], {}])
def test_what_is_no_list_of_what_is_told_is_refused(made, tells):
    first = json.dumps(skeleton_to_dict(made.skeleton(0)) | {"tells": tells})
    with pytest.raises(StudioError, match='line 1: expected "tells" as a list out of hand_states'):
        read(first)


def test_keys_that_a_later_layout_may_add_are_passed_over(made):
    frame = skeleton_to_dict(made.skeleton(0)) | {"lean": [0, 1]}
    assert same(skeleton_from_dict(frame), made.skeleton(0))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"skeleton": 2}, 'expected "skeleton": 1, found 2'),
        ({"skeleton": True}, "found True"),
        ({"skeleton": None}, "found None"),
        ({"time": "1"}, "\"time\" as a finite number, found '1'"),
        ({"time": math.nan}, "found nan"),
        ({"time": math.inf}, "found inf"),
        ({"time": 1e13}, "expected a time in seconds"),
        ({"body": 0}, '"body" as text, found 0'),
        ({"body": None}, '"body" as text, found None'),
        ({"body": "a\nb"}, "printable"),
        ({"positions": None}, '"positions" as a list'),
        ({"positions": [[0, 0, 0]] * 24}, '25 "positions", found 24'),
        ({"positions": [[0, 0, 0]] * 24 + [[0, 0]]}, "3 coordinates, found 2"),
        ({"positions": [[0, 0, 0]] * 24 + [[0, 0, "0"]]}, r"joint 24 \(thumb_right\): expected z"),
        ({"positions": [[0, 0, 0]] * 24 + [0]}, "coordinates as a list"),
        ({"tracking": [2] * 24}, '25 "tracking" states, found 24'),
        ({"tracking": [2] * 24 + [3]}, r"joint 24 \(thumb_right\): expected tracking 0, 1 or 2"),
        ({"tracking": [2] * 24 + [1.0]}, "found 1.0"),
        ({"tracking": [2] * 24 + [True]}, "found True"),
        ({"left_hand": None}, '"left_hand" as an object'),
        ({"left_hand": {"state": "fist", "confidence": 1}}, "unknown, not_tracked, open"),
        ({"right_hand": {"state": [], "confidence": 1}}, '"right_hand"\'s state'),
        ({"right_hand": {"state": "open"}}, '"right_hand"\'s confidence as a finite number'),
        ({"right_hand": {"state": "open", "confidence": 1.1}}, "between 0 and 1"),
    ],
)
def test_whatever_is_wrong_is_named_with_its_line(made, change, words):
    good = frame_to_json(made.skeleton(0))
    bad = json.dumps(skeleton_to_dict(made.skeleton(1)) | change)
    with pytest.raises(StudioError, match=words):
        frame_from_json(bad)
    with pytest.raises(StudioError, match=f"line 3: .*{words}"):
        read(f"{good}\n\n{bad}\n")


@pytest.mark.parametrize(
    "key", ["time", "body", "positions", "tracking", "left_hand", "right_hand"]
)
def test_no_key_may_miss(made, key):
    frame = skeleton_to_dict(made.skeleton(0))
    del frame[key]
    with pytest.raises(StudioError, match=f'"{key}"'):
        skeleton_from_dict(frame)


def test_a_file_cut_off_names_its_last_line(made):
    text = "\n".join(frame_to_json(made.skeleton(frame)) for frame in range(3))
    with pytest.raises(StudioError, match=r"line 3: column \d+: .*cut off"):
        read(text[:-5])


def test_time_never_runs_backwards_in_or_out(tmp_path, made):
    frames = [made.skeleton(1), made.skeleton(0)]
    with pytest.raises(StudioError, match=r"line 2: the time goes backwards, from 100\.0333"):
        read("\n".join(map(frame_to_json, frames)))
    path = tmp_path / "a.jsonl"
    path.write_text("what was here before")
    with pytest.raises(StudioError, match="backwards"):
        write_skeletons(path, frames)
    assert [each.read_text() for each in tmp_path.iterdir()] == ["what was here before"]


def test_a_place_that_cannot_be_written_is_named(tmp_path, made):
    with pytest.raises(FileError, match=r"a\.jsonl: cannot be written: No such file"):
        write_skeletons(tmp_path / "missing" / "a.jsonl", [made.skeleton(0)])
