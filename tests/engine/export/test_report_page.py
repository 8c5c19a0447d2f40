from dataclasses import replace
from pathlib import Path

import pytest

from studio.engine.export import Job, report_page
from studio.engine.sweep import sweep
from tests.engine.export.materials import listed


def test_the_report_is_the_sweeps(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With fewer numbers of neurons than the paper's, which take 10 s."""
    monkeypatch.setattr(
        report_page, "sweep", lambda *given, jobs: sweep(*given, neurons=(5, 10), jobs=jobs)
    )
    take = listed(2).takes[0]
    named = replace(take, demonstration=replace(take.demonstration, name="<b>née</b>"))
    material = replace(listed(2), takes=(named, listed(2).takes[1]))
    shares: list[float] = []
    job = Job(tmp_path, lambda share: shares.append(share) or True)
    (path,) = report_page.write(material, job)
    page = path.read_text("utf-8")
    assert page.lstrip().lower().startswith("<!doctype html>")
    assert "<b>née</b>" not in page
    assert "http" not in page.replace("http://www.w3.org/2000/svg", "")
    assert shares == [0.0, 0.9, 1.0]
