"""A sweep on a cluster: the backend alone changes, and not a number with it."""

import re
from pathlib import Path

import pytest

from studio.engine.sweep import sweep
from tests.engine.sweeps import Ticking, samples


@pytest.mark.cluster
@pytest.mark.filterwarnings("ignore")  # what dask warns of is not ours
def test_dask_gives_the_same_numbers():
    joblib = pytest.importorskip("joblib", reason="joblib comes with the extra cluster")
    distributed = pytest.importorskip("distributed", reason="dask comes with the extra cluster")
    here = sweep(samples(), Ticking(), ("rbf",), (5, 15))
    local = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with (
        distributed.LocalCluster(**local, processes=False) as cluster,
        distributed.Client(cluster),
        joblib.parallel_config(backend="dask"),
    ):
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
