import gzip
import os

import pytest

from studio.engine.errors import FileError
from studio.engine.sources import content
from studio.engine.sources.content import decode, read_content


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


@pytest.mark.parametrize("data", [b"", gzip.compress(b"")])
def test_an_empty_file_is_named(tmp_path, data):
    path = tmp_path / "void.csv"
    path.write_bytes(data)
    with pytest.raises(FileError, match=r"void\.csv: the file is empty"):
        read_content(path)


def test_gzip_cut_off_or_damaged_anywhere_is_an_error(tmp_path):
    path = tmp_path / "cut.gz"
    whole = gzip.compress(bytes(range(256)) * 8)
    for count in range(2, len(whole)):
        path.write_bytes(whole[:count])
        with pytest.raises(FileError, match="damaged or cut off"):
            read_content(path)
    path.write_bytes(whole[:-8] + b"\0\0\0\0" + whole[-4:])  # a wrong checksum
    with pytest.raises(FileError, match="damaged or cut off"):
        read_content(path)


@pytest.mark.parametrize("pack", [bytes, gzip.compress])
def test_what_is_too_big_is_refused_by_its_unpacked_size(tmp_path, monkeypatch, pack):
    monkeypatch.setattr(content, "MAXIMUM_BYTES", 3 * 2**20)
    path = tmp_path / "bomb"
    path.write_bytes(pack(bytes(3 * 2**20)))
    assert len(read_content(path)) == 3 * 2**20
    path.write_bytes(pack(bytes(3 * 2**20 + 1)))
    with pytest.raises(FileError, match="more than 3 MiB"):
        read_content(path)


def test_text_that_is_not_utf8_names_the_byte():
    with pytest.raises(FileError, match=r"x\.csv: byte 3: expected text in UTF-8, found .* 0xff"):
        decode("x.csv", b"abc\xff")


def test_a_byte_order_mark_is_no_part_of_the_text():
    assert decode("x", "\ufeffabc".encode()) == "abc"
