from dataclasses import replace
from pathlib import Path

import pytest

from studio.engine.errors import StudioError
from studio.engine.export import Job, StoppedError, export
from studio.engine.export.apart import export_apart
from tests.engine.export.materials import done, listed


def test_another_process_writes_the_same_files(tmp_path: Path) -> None:
    """Here and there: the same bytes, though there all was learned from and played anew."""
    material = done("rbf", 10, 2)
    shares: list[float] = []
    job = Job(tmp_path / "apart", lambda share: shares.append(share) or True)
    written = export_apart(material, ("csv", "npz"), job, anonymous=True)
    export(material, ("csv", "npz"), Job(tmp_path / "here"), anonymous=True)
    assert {path.name for path in written} == {path.name for path in (tmp_path / "here").iterdir()}
    for path in written:
        assert path.read_bytes() == (tmp_path / "here" / path.name).read_bytes(), path.name
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


def test_it_can_be_stopped(tmp_path: Path) -> None:
    """The film takes long enough to say how far it is."""
    seen: list[float] = []

    def on(share: float) -> bool:
        seen.append(share)
        return share < 0.03

    with pytest.raises(StoppedError):
        export_apart(done("rbf", 10, 2), ("video",), Job(tmp_path, on))
    assert 0.03 <= seen[-1] < 0.9
    assert not list(tmp_path.iterdir())


def test_what_the_process_refuses_is_said(tmp_path: Path) -> None:
    with pytest.raises(StudioError, match=r"no export 'docx'; there are csv, .*replay"):
        export_apart(listed(1), ("docx",), Job(tmp_path))
    none = replace(listed(1), takes=(replace(listed(1).takes[0], included=False),))
    with pytest.raises(StudioError, match="there is no demonstration to learn from"):
        export_apart(none, ("model",), Job(tmp_path))
    assert not list(tmp_path.iterdir())
