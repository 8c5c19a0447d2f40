import gzip
import os
import tracemalloc
import zlib
from pathlib import Path
from unittest import mock

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.errors import FileError
from studio.engine.sources import content
from studio.engine.sources.content import content_of, open_content


def read_content(path) -> bytes:
    with open_content(path) as opened:
        return opened.text().encode()


def test_plain_and_gzip_hold_the_same_whatever_the_name(tmp_path):
    plain, packed = tmp_path / "a.gz", tmp_path / "a.json"
    plain.write_bytes(b"{} hello")
    packed.write_bytes(gzip.compress(b"{} hello"))
    assert read_content(plain) == read_content(str(packed)) == b"{} hello"


def test_members_of_gzip_are_joined(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(gzip.compress(b"one ") + gzip.compress(b"two"))
    assert read_content(path) == b"one two"


@pytest.mark.parametrize(
    ("name", "words"),
    [("missing.csv", "no such file"), (".", "folder"), ("a\0b", "cannot be read")],
)
def test_what_is_no_file_is_named(tmp_path, name, words):
    with pytest.raises(FileError, match=words):
        read_content(f"{tmp_path}/{name}")


def test_a_pipe_is_refused_before_it_blocks(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(FileError, match="not a regular file"):
        read_content(tmp_path / "pipe")


@pytest.mark.parametrize("data", [b"", gzip.compress(b"", mtime=0)])
def test_an_empty_file_is_named(tmp_path, data):
    path = tmp_path / "void.csv"
    path.write_bytes(data)
    with pytest.raises(FileError, match=r"void\.csv: the file is empty"):
        read_content(path)


def test_gzip_cut_off_or_damaged_anywhere_is_an_error(tmp_path):
    path = tmp_path / "cut.gz"
    whole = gzip.compress(bytes(range(128)) * 16)
    for count in range(2, len(whole)):
        path.write_bytes(whole[:count])
        with pytest.raises(FileError, match=r"\(decompressed\): .* found them cut off"):
            read_content(path)
    path.write_bytes(whole[:-8] + b"\0\0\0\0" + whole[-4:])  # a wrong checksum
    with pytest.raises(FileError, match=r"found them damaged \(CRC"):
        read_content(path)


def test_where_gzip_ends_too_early_is_told_to_the_byte(tmp_path):
    path = tmp_path / "cut.gz"
    path.write_bytes(gzip.compress(bytes(range(250)) * 1000)[:-20])
    could_be_read = len(zlib.decompressobj(31).decompress(path.read_bytes()))
    with pytest.raises(FileError, match=f"after {could_be_read:,} bytes \\("):
        read_content(path)
    assert could_be_read > 0


@pytest.mark.parametrize("pack", [bytes, gzip.compress])
def test_what_is_too_big_is_refused_by_its_unpacked_size(tmp_path, monkeypatch, pack):
    monkeypatch.setattr(content, "MAXIMUM_BYTES", 3 * 2**20)
    path = tmp_path / "bomb"
    path.write_bytes(pack(bytes(3 * 2**20)))
    assert len(read_content(path)) == 3 * 2**20
    path.write_bytes(pack(bytes(3 * 2**20 + 1)))
    with pytest.raises(FileError, match="more than 3 MiB"):
        read_content(path)


def test_a_stream_has_a_cap_of_its_own(tmp_path, monkeypatch):
    monkeypatch.setattr(content, "MAXIMUM_BYTES", 10)
    monkeypatch.setattr(content, "MAXIMUM_STREAM_BYTES", 2**20)
    line = b"a line of text\n"
    path = tmp_path / "long.gz"
    path.write_bytes(gzip.compress(line * 70_000))
    with open_content(path) as opened, pytest.raises(FileError, match="more than 1 MiB"):
        for _ in opened.lines():
            pass
    path.write_bytes(gzip.compress(line * 60_000))
    with open_content(path) as opened:
        assert sum(1 for _ in opened.lines()) == 60_000


def test_lines_need_little_memory(tmp_path):
    """A file that unpacks to 23 MB is gone through in a few."""
    path = tmp_path / "long.gz"
    path.write_bytes(gzip.compress((b"0.25 " * 15 + b"\n") * 300_000, 1))
    tracemalloc.start()
    with open_content(path) as opened:
        assert sum(map(len, opened.lines())) == 75 * 300_000
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 8e6


def test_the_page_on_files_states_the_caps():
    page = (Path(__file__).resolve().parents[3] / "docs" / "files.md").read_text()
    for cap in (content.MAXIMUM_BYTES, content.MAXIMUM_STREAM_BYTES):
        assert f"| {cap >> 20} MiB |" in page


def test_endless_lines_and_endlessly_many_are_refused(monkeypatch):
    monkeypatch.setattr(content, "MAXIMUM_LINE", 2**20)
    with pytest.raises(FileError, match="x: line 2: longer than 1,048,576"):
        list(content_of("x", b"a\n" + b"1 " * 2**21).lines())
    monkeypatch.setattr(content, "MAXIMUM_LINES", 99)
    assert len(list(content_of("x", b"\n" * 99).lines())) == 99
    with pytest.raises(FileError, match="x: more than 99 lines"):
        list(content_of("x", b"\n" * 100).lines())


@settings(deadline=None, derandomize=True, max_examples=200)
@given(st.text(st.sampled_from("a\r\né€\U0001f600"), max_size=40), st.integers(1, 5))
def test_lines_are_the_texts_lines_wherever_chunks_end(text, size):
    with mock.patch.multiple(content, HEAD_BYTES=size, _CHUNK_BYTES=size):
        lines = list(content_of("x", text.encode()).lines())
    expected = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    assert lines == (expected[:-1] if not expected[-1] else expected)


def test_text_that_is_not_utf8_names_the_place():
    with pytest.raises(FileError, match=r"x\.csv: byte 3: expected text in UTF-8, found .* 0xff"):
        content_of("x.csv", b"abc\xff").text()
    with pytest.raises(
        FileError, match=r"x\.csv: after line 0: expected text in UTF-8, found 0xff"
    ):
        list(content_of("x.csv", b"a\nb\xff").lines())
    with pytest.raises(FileError, match="found an end within a letter"):
        list(content_of("x.csv", "é".encode()[:1]).lines())


def test_a_byte_order_mark_is_no_part_of_the_text():
    data = "\ufeffabc".encode()
    assert content_of("x", data).text() == "abc"
    assert list(content_of("x", data).lines()) == ["abc"]
