"""Each number has a program that prints it from the exported tables: all of them are run."""

import contextlib
import io
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from studio.engine.export import Job, tables
from studio.engine.export.equations import equations_of
from studio.engine.export.material import Material
from studio.engine.measured import measure_performance
from studio.engine.teaching import Lesson, learn
from tests.engine.export.materials import done

CASES = {
    "50 neurons": ("rbf", 50, 4),
    "few neurons": ("rbf", 8, 4),
    "one neuron": ("rbf", 1, 2),
    "newrb": ("newrb", 20, 4),
    "one demonstration": ("rbf", 20, 1),
}


def printed(program: str) -> float:
    """Run a program in a namespace of its own."""
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        exec(compile(program, "program", "exec"), {})
    return float(said.getvalue())


@pytest.mark.parametrize("case", CASES)
def test_every_program_prints_its_number(case: str, tmp_path: Path) -> None:
    material = done(*CASES[case])
    tables.write(material, Job(tmp_path))
    found = equations_of(material.lesson, material.reproduction)
    for key, equation in found.items():
        assert printed(equation.program(tmp_path)) == pytest.approx(
            equation.value, rel=1e-9, abs=1e-9
        ), key


def test_a_changed_table_changes_the_number(tmp_path: Path) -> None:
    material = done()
    tables.write(material, Job(tmp_path))
    path = tmp_path / "network.csv"
    header, first, *rest = path.read_text().splitlines()
    numbers = [float(number) + 0.5 for number in first.split(",")]
    path.write_text("\n".join([header, ",".join(map(str, numbers)), *rest]))
    equation = equations_of(material.lesson)["mse left_s0"]
    assert abs(printed(equation.program(tmp_path)) - equation.value) > 1e-6


def test_numbers_are_those_that_the_studio_shows() -> None:
    material = done()
    lesson, error = material.lesson, material.reproduction.deviation
    found = equations_of(lesson, material.reproduction)
    for i, joint in enumerate(lesson.taught.joints):
        assert found[f"mse {joint}"].value == lesson.mse[i]
        assert found[f"floor {joint}"].value == lesson.floor[i]
        assert found[f"rmse {joint}"].value == np.degrees(error.joint_rmse[i])
    assert found["rank"].value == lesson.model.rank_
    assert found["width"].value == lesson.model.width_
    assert found["hand mean"].value == 1000.0 * error.hand_mean
    assert found["hand dtw"].value == 1000.0 * error.hand_dtw
    assert found["mse"].value == lesson.mse.mean()
    column = measure_performance("", "A", material.reproduction.performance, lesson.taught)
    assert found["hand acceleration"].value == column.acceleration


def test_values_stand_in_the_equations() -> None:
    material = done()
    for key, equation in equations_of(material.lesson, material.reproduction).items():
        shown = "more than 1e+15" if math.isinf(equation.value) else f"{equation.value:.3g}"[:3]
        assert shown in equation.filled, key
        assert equation.formula.count("=") >= 1
        assert equation.name
        assert equation.source


def test_what_makes_no_sense_is_not_there() -> None:
    single = equations_of(done("rbf", 20, 1).lesson)
    assert not {"ratio", "held-out", "held-out ratio", "floor left_s0", "hand mean"} & set(single)
    assert {"rank", "condition", "width", "acceleration"} <= set(single)
    assert "rank" not in equations_of(done("newrb", 20, 4).lesson)


def test_demonstrations_that_agree_have_no_ratio() -> None:
    """Where the floor is zero nothing is divided by it."""
    found = equations_of(agreeing(done()))
    assert not {key for key in found if key.startswith("ratio") or key == "held-out ratio"}


def agreeing(material: Material) -> Lesson:
    taught = material.taught
    rows = np.repeat(taught.rows[:1], 2, axis=0)
    same = replace(taught, rows=rows, demonstrations=taught.demonstrations[:2])
    return learn(same, material.lesson.settings)
