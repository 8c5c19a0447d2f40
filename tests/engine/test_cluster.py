"""A sweep on a cluster: the backend alone changes, and not a number with it."""

import re
from pathlib import Path

import pytest

from studio.engine.sweep import sweep
from tests.engine import dask_here
from tests.engine.dask_here import two_workers
from tests.engine.sweeps import Ticking, samples


@pytest.mark.cluster
@pytest.mark.filterwarnings("ignore")  # what dask warns of is not ours
def test_dask_gives_the_same_numbers():
    here = sweep(samples(), Ticking(), ("rbf",), (5, 15))
    with two_workers(processes=False):
        there = sweep(samples(), Ticking(), ("rbf",), (5, 15))
    for row, other in zip(here.rows, there.rows, strict=True):
        assert (row.quality.curve == other.quality.curve).all()
        assert row.quality.held_out == other.quality.held_out
    assert here.suggestions["rbf"].words == there.suggestions["rbf"].words
    assert here.played["rbf"].performance.block_down
    assert there.played["rbf"].performance.block_down


def test_the_guides_page_names_what_exists():
    text = (Path(__file__).resolve().parents[2] / "docs" / "cluster.md").read_text()
    (code,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    compile(code, "cluster.md", "exec")
    names = {}
    for line in re.findall(r"^from studio.*$", code, re.MULTILINE):
        exec(line, names)
    for call in ("teach", "sweep", "compare", "sweep_page"):
        assert callable(names[call])


def test_without_dask_it_is_said_and_in_ci_it_fails(monkeypatch):
    monkeypatch.setattr(dask_here, "find_spec", lambda _: None)
    monkeypatch.delenv("CI", raising=False)
    with pytest.raises(pytest.skip.Exception, match="extra cluster"), two_workers(processes=False):
        pass
    monkeypatch.setenv("CI", "true")
    with pytest.raises(AssertionError, match="extra cluster"), two_workers(processes=False):
        pass
