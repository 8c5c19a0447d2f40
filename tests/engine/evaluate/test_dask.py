"""Trials on Dask: the backend alone changes, and not a byte of the table with it."""

import json

import pytest

from studio.engine.evaluate.evaluation import evaluate
from studio.engine.evaluate.found import shown_evaluation
from tests.engine.evaluate.swings import conditions, swing


@pytest.mark.cluster
@pytest.mark.filterwarnings("ignore")  # what dask warns of is not ours
def test_two_workers_on_dask_give_the_identical_table():
    joblib = pytest.importorskip("joblib", reason="joblib comes with the extra cluster")
    distributed = pytest.importorskip("distributed", reason="dask comes with the extra cluster")

    def table() -> str:
        found = evaluate(swing(), [swing("other", -0.3)], conditions(), 3, 2)
        return json.dumps(shown_evaluation(found).json)

    here = table()
    local = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with (
        distributed.LocalCluster(**local, processes=True) as cluster,
        distributed.Client(cluster),
        joblib.parallel_config(backend="dask"),
    ):
        assert table() == here
