"""Uploaded files: sizes are capped, names are never paths."""

from pathlib import Path

import pytest
from hypothesis import given, settings, strategies

from studio.engine import uploads
from studio.engine.errors import FileError
from studio.engine.uploads import Uploads, shown_name


@pytest.fixture
def kept():
    made = Uploads()
    yield made
    made.close()


@pytest.mark.parametrize("name", ["../../etc/passwd", "/etc/passwd", "C:\\x\\y.json", "", "a\0b"])
def test_a_name_chooses_no_place(kept: Uploads, name: str) -> None:
    first, second = kept.keep(name, b"one"), kept.keep(name, b"two")
    assert first.parent == second.parent
    assert first != second
    assert (first.read_bytes(), second.read_bytes()) == (b"one", b"two")
    assert "passwd" not in str(first)


def test_large_and_empty_files_are_refused_by_name(
    kept: Uploads, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(uploads, "LARGEST", 10)
    with pytest.raises(FileError, match=r"big\.json: .* MB are taken"):
        kept.keep("big.json", bytes(11))
    with pytest.raises(FileError, match=r"MB are taken: .*studio teach FILE"):
        kept.keep("big.json", bytes(11))
    with pytest.raises(FileError, match=r"MB are taken: carry it over$"):
        kept.keep("big.zip", bytes(11), "carry it over")
    with pytest.raises(FileError, match=r"nothing\.json: the file is empty"):
        kept.keep("nothing.json", b"")
    assert kept.keep("fits.json", bytes(10)).stat().st_size == 10


def test_closing_deletes_them() -> None:
    kept = Uploads()
    path = kept.keep("a.json", b"x")
    kept.close()
    assert not path.parent.exists()


@given(strategies.text(max_size=300))
@settings(deadline=None, derandomize=True)
def test_shown_names_are_short_lines_without_folders(name: str) -> None:
    shown = shown_name(name)
    assert 0 < len(shown) <= 60
    assert shown.isprintable()
    assert "/" not in shown.removeprefix("unnamed file")
    assert Path(shown).name == shown or shown in (".", "..")


def test_an_ordinary_name_stays() -> None:
    assert shown_name("C:\\data\\wave hand (2).json.gz") == "wave hand (2).json.gz"
