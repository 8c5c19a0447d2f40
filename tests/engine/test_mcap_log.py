"""Logs of JSON messages: what is written comes back, and damage ends the reading, nothing else."""

import io

import pytest
import zstandard
from mcap.writer import CompressionType, Writer

from studio.engine import mcap_log
from studio.engine.mcap_log import LogReader, LogWriter, is_mcap

MOST = 1 << 20


def written(count: int, chunk_bytes: int = 500) -> bytes:
    file = io.BytesIO()
    log = LogWriter(file, {"name": "test"}, {"/a": {}, "/b": {"type": "object"}}, chunk_bytes)
    for number in range(count):
        log.write("/a", number, {"n": number, "text": "é" * 20}, number)
        log.write("/b", number, {"n": -number}, number)
    log.finish()
    return file.getvalue()


def read(data: bytes, most: int = MOST) -> tuple[list, LogReader]:
    reader = LogReader(io.BytesIO(data), len(data), most)
    return [(topic, message["n"]) for topic, message in reader], reader


def test_messages_come_back_in_order():
    found, reader = read(written(40))
    assert found == [each for n in range(40) for each in (("/a", n), ("/b", -n))]
    assert (reader.problem, reader.metadata["name"]) == ("", "test")
    assert reader.whole > 0.9 * len(written(40))  # all but the last magic bytes, at most


def test_metadata_are_there_with_the_first_message():
    data = written(40)
    reader = LogReader(io.BytesIO(data), len(data), MOST)
    next(iter(reader))
    assert reader.metadata["name"] == "test"


def test_a_cut_keeps_the_chunks_before_it():
    data, (whole, _) = written(40), read(written(40))
    counts = []
    for end in range(0, len(data), 50):
        found, reader = read(data[:end])
        assert found == whole[: len(found)]
        assert reader.whole <= end
        counts.append(len(found))
    assert counts == sorted(counts)
    assert 0 < counts[len(counts) // 3] < len(whole)


def test_what_unpacks_to_too_much_is_broken_off():
    found, reader = read(written(40), most=2000)
    assert 0 < len(found) < 80
    assert "unpacks to more" in reader.problem


def chunked(compression: CompressionType, size: int) -> bytes:
    file = io.BytesIO()
    writer = Writer(file, chunk_size=size, compression=compression)
    writer.start()
    channel = writer.register_channel("/a", "json", writer.register_schema("a", "", b""))
    writer.add_message(channel, 0, b'{"n": 1, "x": "' + b"a" * size + b'"}', 0, 0)
    writer.finish()
    return file.getvalue()


def test_chunks_of_others_are_not_unpacked(monkeypatch):
    assert read(chunked(CompressionType.ZSTD, 1000))[0] == [("/a", 1)]
    found, reader = read(chunked(CompressionType.LZ4, 1000))
    assert (found, "lz4 bytes is not the studio's" in reader.problem) == ([], True)
    monkeypatch.setattr(mcap_log, "LARGEST_CHUNK", 900)
    found, reader = read(chunked(CompressionType.ZSTD, 1000))
    assert (found, "is not the studio's" in reader.problem) == ([], True)


def test_what_is_wrong_is_told_in_printable_letters():
    _, reader = read(chunked(CompressionType.ZSTD, 1000).replace(b"zstd", b"z\x01t\n"))
    assert "z\\x01t\\n" in reader.problem
    assert reader.problem.isprintable()


def test_a_chunk_that_unpacks_to_more_than_it_says_is_refused():
    data = chunked(CompressionType.ZSTD, 1000)
    start = data.index(zstandard.FRAME_HEADER)
    told = zstandard.get_frame_parameters(data[start:]).content_size
    huge = data[:start] + data[start:].replace((told - 256).to_bytes(2, "little"), b"\xff\xff", 1)
    assert zstandard.get_frame_parameters(huge[start:]).content_size == 65535 + 256
    found, reader = read(huge)
    assert (found, reader.problem) == ([], "a chunk tells two sizes")


@pytest.mark.parametrize("name", ["missing", "text", "a\0b"])
def test_what_is_no_mcap(tmp_path, name):
    (tmp_path / "text").write_text("hello")
    assert not is_mcap(tmp_path / name)
    (tmp_path / "log").write_bytes(written(1))
    assert is_mcap(tmp_path / "log")
