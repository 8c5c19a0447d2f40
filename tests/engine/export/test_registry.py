from dataclasses import replace
from pathlib import Path

import pytest

from studio.engine.errors import FileError, StudioError
from studio.engine.export import KINDS, Job, Material, StoppedError, export
from tests.engine.export.materials import done, listed


def test_kinds_write_what_they_say(tmp_path: Path) -> None:
    for name in ("csv", "npz", "mcap", "model", "zip"):
        folder = tmp_path / name / "deeper"
        written = export(done("rbf", 10, 2), (name,), Job(folder))
        assert sorted(written) == sorted(folder.iterdir())
        for path in written:
            assert any(path.match(pattern) for pattern in KINDS[name].files)


def test_progress_rises_to_one_over_all_kinds(tmp_path: Path) -> None:
    shares: list[float] = []
    job = Job(tmp_path, lambda share: shares.append(share) or True)
    export(done("rbf", 10, 2), ("csv", "npz", "zip"), job)
    assert shares == sorted(shares)
    assert shares[0] < 0.1
    assert shares[-1] == 1.0


@pytest.mark.parametrize("name", ["npz", "mcap", "zip"])
def test_a_stopped_export_leaves_no_half_file(name: str, tmp_path: Path) -> None:
    with pytest.raises(StoppedError, match="stopped"):
        export(done("rbf", 10, 2), (name,), Job(tmp_path, lambda _: False))
    assert not [path for path in tmp_path.iterdir() if "unfinished" in path.name]
    assert not (tmp_path / "session.zip").exists()


def test_what_is_missing_is_said_before_anything_is_written(tmp_path: Path) -> None:
    with pytest.raises(StudioError, match="video: Train first"):
        export(listed(), ("csv", "video"), Job(tmp_path / "new"))
    with pytest.raises(StudioError, match="video: Let Baxter do it alone first"):
        export(replace(done(), reproduction=None), ("video",), Job(tmp_path / "new"))
    with pytest.raises(StudioError, match="record a demonstration first"):
        export(Material(listed().setup, ()), ("csv",), Job(tmp_path / "new"))
    with pytest.raises(StudioError, match="there are csv, npz, mcap, model, html, video, zip"):
        export(listed(), ("docx",), Job(tmp_path / "new"))
    assert not (tmp_path / "new").exists()


def test_a_folder_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="file: cannot be made a folder"):
        export(listed(), ("csv",), Job(tmp_path / "file"))
