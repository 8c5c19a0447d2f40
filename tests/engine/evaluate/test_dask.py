"""Trials on Dask: the backend alone changes, and not a byte of the table with it."""

import json
import re
from pathlib import Path

import pytest

from studio.engine.evaluate.evaluation import evaluate
from studio.engine.evaluate.found import shown_evaluation
from studio.engine.evaluate.grid import replays_of
from studio.engine.evaluate.journal import FILE, Journal, header_of
from studio.engine.evaluate.runs import Conditions
from studio.engine.evaluate.subject import subject_of_lesson
from studio.engine.evaluate.variation import Variations
from studio.engine.teaching import LearnerSettings, learn
from tests.engine.dask_here import two_workers
from tests.engine.evaluate.swings import conditions, swing
from tests.engine.sweeps import samples

PAGE = Path(__file__).resolve().parents[3] / "docs" / "evaluate.md"


@pytest.mark.cluster
@pytest.mark.filterwarnings("ignore")  # what dask warns of is not ours
def test_two_workers_on_dask_give_the_identical_table(tmp_path: Path) -> None:
    """Of a swing that hits the block now and then, and of what two shipped samples teach."""
    taught = samples(2)
    varied = Conditions(taught.scene, Variations(), seed=0)
    learned = subject_of_lesson(learn(taught, LearnerSettings("rbf", 4)), taught.scene).motion
    own = replays_of(taught, taught.scene)

    def tables(folder: Path) -> tuple[str, bytes]:
        swung = evaluate(swing(), [swing("other", -0.3)], conditions(), 3, 2)
        header = header_of([learned, *own], varied.scene, varied.widths, varied.seed)
        with Journal(folder, header) as journal:
            shipped = evaluate(learned, own, varied, 3, 1, journal=journal)
        found = [shown_evaluation(each).json for each in (swung, shipped)]
        return json.dumps(found), (folder / FILE).read_bytes()

    here = tables(tmp_path / "here")
    with two_workers(processes=True):
        assert tables(tmp_path / "dask") == here


def test_the_pages_program_names_what_exists() -> None:
    programs = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)
    (code,) = [program for program in programs if "dask" in program]
    compile(code, PAGE.name, "exec")
    names: dict[str, object] = {}
    for line in re.findall(r"^from studio.*$", code, re.MULTILINE):
        exec(line, names)
    for call in ("teach", "networks", "replays_of", "header_of", "Journal", "evaluate_grid"):
        assert f"{call}(" in code
        assert callable(names[call])
