import json

import pytest

from studio.engine.errors import StudioError
from studio.engine.skeleton import HandState
from studio.engine.sources.kinect2_socket import read


@pytest.fixture
def document(made):
    return json.loads(made.socket_text([[made.socket_body(frame)] for frame in range(3)]))


def test_numbers_and_words_say_the_same(made):
    numbers = [[made.socket_body(n, states=(n, 4 - n))] for n in range(5)]
    spoken = ("unknown", "nottracked", "open", "closed", "lasso")
    words = [[made.socket_body(n, states=(spoken[n], spoken[4 - n]))] for n in range(5)]
    old, new = read(made.socket_text(numbers, "0.1")), read(made.socket_text(words, "0.3"))
    assert (old.format, new.format) == ("kinect2-socket 0.1", "kinect2-socket 0.3")
    for first, second, state in zip(old.frames, new.frames, HandState, strict=True):
        (a,), (b,) = first.bodies, second.bodies
        assert a.left_hand == b.left_hand
        assert a.right_hand == b.right_hand
        assert a.left_hand.state is state


def test_a_frame_is_what_was_written(made):
    frames = [[], [made.socket_body(1)], [made.socket_body(2, "a"), made.socket_body(2, "b")]]
    parsed = read(made.socket_text(frames))
    assert [frame.time for frame in parsed.frames] == [0, 1 / 30, 2 / 30]
    assert [[body.body_id for body in frame.bodies] for frame in parsed.frames] == [
        [],
        ["7"],
        ["a", "b"],
    ]
    assert (parsed.frames[1].bodies[0].positions == made.standing(1)).all()
    assert (parsed.frames[1].bodies[0].tracking == 2).all()
    assert (parsed.has_hand_states, parsed.has_tracking, parsed.has_stamps) == (True, False, False)


def test_an_untracked_entry_is_no_body(made):
    empty = {"id": 0, "tracked": False, "joints": []}
    parsed = read(made.socket_text([[empty, made.socket_body(0)], [empty | {"tracked": 0}]]))
    assert [len(frame.bodies) for frame in parsed.frames] == [1, 0]


def test_bodies_without_hand_states_are_a_file_without(document):
    for frame in document["frames"]:
        del frame["bodies"][0]["leftHandState"], frame["bodies"][0]["rightHandState"]
    parsed = read(json.dumps(document))
    assert not parsed.has_hand_states
    assert parsed.frames[0].bodies[0].left_hand.state is HandState.UNKNOWN


def set_in(value, *keys):
    """Return a change of a document: the entry under these keys is replaced by the value."""

    def change(document):
        for key in keys[:-1]:
            document = document[key]
        document[keys[-1]] = value

    return change


BODY = ("frames", 1, "bodies", 0)
NUMBERS = "as a finite number"


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (set_in("1.0", "version"), "expected \"version\" 0.1 or 0.3, found '1.0'"),
        (set_in(0.3, "version"), "found 0.3"),
        (set_in([], "frames"), "at least one frame"),
        (set_in({}, "frames"), '"frames" as a list, found an object'),
        (set_in(5, "frames", 1), "frame 1: expected a frame as an object, found 5"),
        (set_in(None, "frames", 1, "bodies"), 'frame 1: expected "bodies" as a list'),
        (set_in("x", *BODY), "frame 1: expected a body as an object"),
        (set_in(1.5, *BODY, "id"), 'frame 1, body 0: expected "id" as a whole number or text'),
        (set_in(True, *BODY, "id"), "whole number or text, found True"),
        (set_in("\ud800", *BODY, "id"), "printable"),
        (set_in("", *BODY, "id"), "1 to 100 printable"),
        (set_in(5, *BODY, "leftHandState"), 'frame 1, body 0: expected "leftHandState" as 0 to 4'),
        (set_in(-1, *BODY, "leftHandState"), "found -1"),
        (set_in(True, *BODY, "leftHandState"), "found True"),
        (set_in("Open", *BODY, "rightHandState"), "unknown, nottracked, open, closed, lasso"),
        (set_in(None, *BODY, "rightHandState"), "found None"),
        (set_in([], *BODY, "joints"), "frame 1, body 0: expected 25 joints, found 0"),
        (set_in([0, 0, 0], *BODY, "joints", 6), r"joint 6 \(wrist_left\): expected an object"),
        (set_in({"x": 0, "y": 0}, *BODY, "joints", 24), r"joint 24 \(thumb_right\).*x, y and z"),
        (set_in(float("nan"), *BODY, "joints", 5, "y"), rf"joint 5 \(elbow_left\).* y {NUMBERS}"),
        (set_in("1.5", *BODY, "joints", 5, "z"), f"z {NUMBERS}, found '1.5'"),
        (set_in(True, *BODY, "joints", 5, "x"), f"x {NUMBERS}, found True"),
        (set_in(10**400, *BODY, "joints", 5, "x"), f"x {NUMBERS}, found 10000"),
    ],
)
def test_whatever_is_wrong_is_named_with_its_place(document, change, words):
    change(document)
    with pytest.raises(StudioError, match=words):
        read(json.dumps(document))


def test_one_id_twice_in_a_frame_is_an_error(made):
    with pytest.raises(StudioError, match="frame 0, body 1: expected each id once"):
        read(made.socket_text([[made.socket_body(0), made.socket_body(0)]]))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('{"version": "0.3", "frames": [1e999]}', "found inf"),
        ('{"version": "0.3", "frames": ' + "[" * 100_000, "nested too deeply"),
        ('{"version": "0.3", "frames": ' + "9" * 5000 + "}", "numbers of usual length"),
        ('{"version": "0.3",\n "frames": [}', "line 2, column 13: expected valid JSON, found '}'"),
        ('{"version": "0.3", "frames": [', "cut off"),
        ('{"version": "0.3", "frames": [{"bod', "cut off"),
    ],
)
def test_broken_json_is_named_with_its_place(text, words):
    with pytest.raises(StudioError, match=words):
        read(text)


def test_numbers_too_large_for_a_float_are_refused(made):
    text = made.socket_text([[made.socket_body(0)]]).replace("0.06,", "1e999,")
    assert "1e999" in text
    with pytest.raises(StudioError, match="finite number, found inf"):
        read(text)
