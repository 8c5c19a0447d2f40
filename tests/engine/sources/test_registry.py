import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.errors import FileError
from studio.engine.sources.registry import FAMILIES, KNOWN_FORMATS, SUPPORTED, parse

NTU = "2\n1\n72057594037931101 0 1 1 1 1 0 0.02 -0.1 2\n25\n" + "0.2 " * 12 + "\n"


def plain(made):
    return {name: data for name, data in made.sample_files().items() if "gzip" not in name}


def test_each_text_belongs_to_one_family(made):
    for name, data in plain(made).items():
        assert parse("x", data).format == name
        head = data.decode()
        assert sum(family.recognizes(head) for family in FAMILIES) == 1
        assert not any(known.recognizes(head) for known in KNOWN_FORMATS)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (NTU, "NTU RGB"),
        ("3\n0\n0\n" + NTU[2:], "NTU RGB"),
        (json.dumps([{"bodyIndex": 0, "tracked": True, "record_startime": 1}]), "Kinectron"),
        (json.dumps({"bodies": [{"bodyIndex": 0, "joints": []}]}), "node-kinect2"),
    ],
)
def test_formats_of_a_later_version_are_called_by_name(text, words):
    with pytest.raises(FileError, match=f"x.skeleton: this is .*{words}.*does not read yet"):
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


@settings(deadline=None, derandomize=True, max_examples=400)
@given(st.data())
def test_bytes_flipped_anywhere(made, data):
    mangled = bytearray(data.draw(st.sampled_from(list(plain(made).values()))))
    for _ in range(data.draw(st.integers(1, 4))):
        mangled[data.draw(st.integers(0, len(mangled) - 1))] = data.draw(
            st.integers(0, 255) | st.sampled_from(b'0123456789eE-.,;"{}[]\n ')
        )
    check_mangled(bytes(mangled))


@settings(deadline=None, derandomize=True, max_examples=200)
@given(
    st.sampled_from([b"", b'{"skeleton": 1, ', b'{"version": "0.3", "frames": [', b"1 2 3\n"]),
    st.binary(max_size=200) | st.text(max_size=200).map(lambda text: text.encode(errors="replace")),
)
def test_any_bytes_at_all(start, rest):
    check_mangled(start + rest)
