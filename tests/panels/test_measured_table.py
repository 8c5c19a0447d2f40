"""The table that compares: what Baxter did alone opens its equations, and nothing else does."""

import html
import re
from dataclasses import replace

import numpy as np
import pytest

from studio.engine.arms import short_names
from studio.engine.export import Job, tables
from studio.engine.export.equations import reproduced_numbers
from studio.engine.measured import measure_demonstration, measure_performance
from studio.panels.measured_table import measured
from tests.engine.export.materials import done
from tests.engine.export.test_equations import printed
from tests.panels.test_tables import cells

BUTTON = re.compile(r'<button[^>]*popovertarget="([^"]+)"[^>]*>([^<]+)</button>')


@pytest.fixture(scope="module")
def material():
    return done("rbf", 20, 2)


@pytest.fixture(scope="module")
def columns(material):
    """A demonstration, A, and as B another network's run."""
    taught, other = material.taught, done("rbf", 3, 2)
    return (
        measure_demonstration(material.takes[0], taught),
        measure_performance("twenty", "A", material.reproduction.performance, taught),
        measure_performance("three", "B", other.reproduction.performance, taught),
    )


def keys_of(joints) -> list[str]:
    """Return the equations' keys in the order of the rows."""
    hand = [f"hand {what}" for what in ("mean", "largest", "dtw", "acceleration")]
    return [*(f"rmse {joint}" for joint in joints), *hand]


def test_each_number_of_a_opens_the_equation_whose_value_it_is_rounded(
    material, columns, tmp_path
) -> None:
    """From the page's own HTML to the number, by way of the exported tables."""
    tables.write(material, Job(tmp_path))
    joints = material.taught.joints
    equations = reproduced_numbers(material.lesson, material.reproduction)
    page = measured(columns, joints, equations)
    _, *rows, _ = cells(page)
    assert len(rows) == len(joints) + 4
    for key, row in zip(keys_of(joints), rows, strict=True):
        _, shown, first, second = row
        assert not BUTTON.search(shown)
        assert not BUTTON.search(second)
        target, number = BUTTON.fullmatch(first).groups()
        equation = equations[key]
        digits = len(number.partition(".")[2])
        assert number == f"{equation.value:.{digits}f}"
        assert f"[{equation.unit}]" in row[0]
        (card,) = re.findall(rf'<div popover id="{target}".*?</details></div>', page, re.DOTALL)
        assert html.escape(equation.filled) in card
        (program,) = re.findall(r"<pre[^>]*>(.*?)</pre>", card, re.DOTALL)
        program = html.unescape(program).replace("folder = '.'", f"folder = {str(tmp_path)!r}")
        assert printed(program) == pytest.approx(equation.value, rel=1e-9), key
    assert len(set(BUTTON.findall(page))) == len(rows)
    assert "Press a number of A" in page


def test_numbers_of_another_run_open_nothing(material, columns) -> None:
    """The equations may still be those of the run before; then the numbers are but numbers."""
    other = done("rbf", 3, 2)
    before = reproduced_numbers(other.lesson, other.reproduction)
    page = measured(columns, material.taught.joints, before)
    assert "popover" not in page
    assert "Press a number" not in page
    _, shown, first, _ = columns[0], *columns
    alike = (shown, replace(first, letter="B"))
    assert "popover" not in measured(
        alike, material.taught.joints, reproduced_numbers(material.lesson, material.reproduction)
    )


def test_without_equations_all_numbers_are_there(material, columns) -> None:
    table = {row[0]: row[1:] for row in cells(measured(columns, material.taught.joints, {}))}
    for i, joint in enumerate(short_names(material.taught.joints)):
        errors = [np.degrees(each.deviation.joint_rmse[i]) for each in columns]
        assert table[f"{joint} [deg]"] == [f"{error:.2f}" for error in errors]
    assert table[""] == ["shown", "A", "B"]
    warped = [1000.0 * each.deviation.hand_dtw for each in columns]
    assert table["hand, warped [mm]"] == [f"{each:.1f}" for each in warped]
