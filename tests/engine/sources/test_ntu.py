import numpy as np
import pytest

from studio.engine.errors import StudioError
from studio.engine.sources import ntu


@pytest.fixture
def people(made):
    """Frames of two, no and one body."""
    return [
        [made.skeleton(0, "72057594037931101"), made.skeleton(3, "72057594037931102", z=3.0)],
        [],
        [made.skeleton(2, "72057594037931102", z=3.0)],
    ]


def read(text):
    return ntu.read(text.split("\n"))


def test_a_file_is_what_was_written(made, people):
    parsed = read(made.ntu_text(people))
    assert [frame.time for frame in parsed.frames] == [0, 1 / 30, 2 / 30]
    assert (parsed.has_hand_states, parsed.has_tracking, parsed.has_stamps) == (True, True, False)
    for frame, bodies in zip(parsed.frames, people, strict=True):
        assert len(frame.bodies) == len(bodies)
        for found, written in zip(frame.bodies, bodies, strict=True):
            assert found.body_id == written.body_id
            assert np.array_equal(found.positions, written.positions)
            assert np.array_equal(found.tracking, written.tracking)
            for side in ("left", "right"):
                assert found.hand(side).state is written.hand(side).state
                assert found.hand(side).confidence == 1.0


def test_the_two_hands_confidences_are_their_own(made, people):
    text = made.ntu_text(people[2:]).replace(" 0 1 2 1 4 0 ", " 0 0 2 1 4 0 ")
    (body,) = read(text).frames[0].bodies
    assert (body.left_hand.confidence, body.right_hand.confidence) == (0.0, 1.0)


def test_what_is_not_used_may_be_anything(made, people):
    text = made.ntu_text(people).replace("278.4 214.1", "-nan inf")
    assert len(read(text).frames) == 3


@pytest.mark.parametrize("text", ["3\n0\n0\n0\n", "2\r\n0\r\n0\r\n"])
def test_a_file_in_which_nobody_is_seen(text):
    assert ntu.recognizes(text)
    parsed = ntu.read(text.splitlines())
    assert {frame.bodies for frame in parsed.frames} == {()}
    assert not parsed.has_hand_states


def test_a_file_cut_off_after_any_line_is_an_error(made, people):
    lines = made.ntu_text(people).splitlines()
    for count in range(len(lines)):
        with pytest.raises(StudioError, match="cut off"):
            ntu.read(lines[:count])


@pytest.mark.parametrize(
    ("line", "new", "words"),
    [
        (1, "three", "line 1: expected the number of frames, found 'three'"),
        (1, "9" * 12, "line 1: expected the number of frames"),
        (1, "2", "line 58: expected the end after 2 frames"),
        (2, "2 2", "line 2: expected the number of bodies in frame 0, found '2 2'"),
        (3, "1 2 3", "line 3: expected 10 fields of a body, found 3.*HoloLens"),
        (3, "1 0 1 5 1 4 0 0 0 2", "line 3: expected a hand's state from 0 to 4, found '5'"),
        (3, "1 0 2 4 1 4 0 0 0 2", "line 3: expected a hand's confidence from 0 to 1, found '2'"),
        (4, "26", "line 4: expected 25 as the number of joints, found '26': 26 joints.*HoloLens"),
        (4, "24", "line 4: expected 25 as the number of joints, found '24'$"),
        (8, "1 2 3", r"line 8, joint 3 \(head\): expected 12 values, found 3.*HoloLens"),
        (8, "x 2 3 4 5 6 7 8 9 10 11 2", r"line 8, joint 3 \(head\): .*meters, found 'x'"),
        (8, "nan 2 3 4 5 6 7 8 9 10 11 2", "meters, found 'nan'"),
        (8, "1_0 2 3 4 5 6 7 8 9 10 11 2", "meters, found '1_0'"),
        (8, "1 2 3 4 5 6 7 8 9 10 11 3", "a tracking state from 0 to 2, found '3'"),
        (30, "72057594037931101 0 1 1 1 4 0 0 0 2", "line 30: expected each id once"),
    ],
)
def test_whatever_is_wrong_is_named_with_its_line(made, people, line, new, words):
    lines = made.ntu_text(people).splitlines()
    lines[line - 1] = new
    with pytest.raises(StudioError, match=words):
        ntu.read(lines)
