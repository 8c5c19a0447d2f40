import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.errors import FileError
from studio.engine.sources.registry import FAMILIES, SUPPORTED, parse
from tests.engine.corruption import corrupted

BEGINNINGS = (
    *(b'{"skeleton": 1, ', b'{"version": "0.3", "frames": [', b'{"bodies": [{"bodyIndex": 0, '),
    *(b'[{"record_timestamp": 1, ', b'{"pose_world": [[', b'[{"poseWorldLandmarks": [{"x": 1, '),
    *(b"1 2 3\n", b"2\n1\n7 0 1 1 1 1 0 0 0 2\n25\n"),
)


def plain(made):
    return made.skeleton_files()


def test_each_text_belongs_to_one_family(made):
    files = {**plain(made), **made.landmark_files()}
    for name, data in files.items():
        told = parse("x", data).format
        assert told == (name if name in plain(made) else "mediapipe-landmarks 1")
        assert sum(family.recognizes(data.decode()) for family in FAMILIES) == 1


def test_a_hololens_hand_is_called_by_name():
    """Sets of 26 joints x 3 share the extension of NTU RGB+D's."""
    rows = "0.1 0.2 0.3\n"
    both = f"2\n1\n26\n{rows * 26}2\n27\n{rows * 27}"  # two hands: their numbers, then joints
    right = f"1\n2\n27\n{rows * 27}"
    body = f"1\n72057594037931101 0 1 1 1 1 0 0.02 -0.1 2\n26\n{rows * 26}"
    for text in (f"2\n{both}{both}", f"1\n{right}", f"1\n{body}", 26 * "0.1 0.2 0.3 "):
        with pytest.raises(FileError, match=r"x.skeleton: line \d: .*HoloLens"):
            parse("x.skeleton", text.encode())


@pytest.mark.parametrize(
    "data",
    [
        b"hello",
        b"\x89PNG\r\n\x1a\n\0\0",
        b"\0" * 100,
        b"\n\n\n",
        b"[]",
        b"{}",
        b"[[[[",
        b"1\n2\n3\n",
        "0.1,0.2,0.3\n".encode("utf-16"),
        b'"frames"',
    ],
)
def test_anything_else_is_told_what_is_supported(data):
    with pytest.raises(FileError) as caught:
        parse("odd.bin", data)
    message = str(caught.value)
    assert message.startswith("odd.bin: line 1: expected a recording of skeletons, found ")
    assert SUPPORTED in message
    assert message.isprintable()


def test_errors_name_file_place_and_what_is_supported(made):
    data = plain(made)["table 101"].replace(b"-0.5,", b"zero,", 1)
    with pytest.raises(FileError, match=r"^a\.csv: line 1, column 3: .*'zero' \(read as tables"):
        parse("a.csv", data)


def check_mangled(data: bytes) -> None:
    """A recording or a FileError of one printable line: nothing else may come out."""
    try:
        parsed = parse("mangled", data)
    except FileError as error:
        message = str(error)
    else:
        message = "mangled: nothing"
        times = [frame.time for frame in parsed.frames]
        assert times
        assert times == sorted(times)
    assert message.startswith("mangled: ")
    assert message.isprintable()


def test_cut_off_anywhere(made):
    for data in plain(made).values():
        for count in range(1, len(data), 41):
            check_mangled(data[:count])


@settings(deadline=None, derandomize=True, max_examples=60)
@given(st.integers(0, 2**32 - 1))
def test_every_format_damaged_somehow(made, seed):
    """A small share of what tests/bench/bench_fuzz_readers.py does."""
    rng = np.random.default_rng(seed)
    for data in (*plain(made).values(), *made.landmark_files().values()):
        check_mangled(corrupted(data, rng))


@settings(deadline=None, derandomize=True, max_examples=200)
@given(
    st.sampled_from([b"", *BEGINNINGS]),
    st.binary(max_size=200) | st.text(max_size=200).map(lambda text: text.encode(errors="replace")),
)
def test_any_bytes_at_all(start, rest):
    check_mangled(start + rest)
