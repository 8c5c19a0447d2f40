import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from studio.engine.export import Job, tables
from studio.engine.export.tables import Table
from studio.engine.measures import deviation
from tests.engine.export.materials import done, listed
from tests.engine.lessons_at_hand import with_wrists


def read(path: Path) -> dict[str, list[str]]:
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {column: [row[column] for row in rows] for column in rows[0]}


def numbers(table: dict[str, list[str]], names: list[str]) -> np.ndarray:
    return np.array([[float(number) for number in table[name]] for name in names]).T


def test_tables_hold_the_very_numbers(tmp_path: Path) -> None:
    material = done()
    lesson, taught = material.lesson, material.taught
    written = tables.write(material, Job(tmp_path))
    assert {path.name for path in written} == set(tables.FILES)
    joints = [f"{joint} [rad]" for joint in taught.joints]
    shown = read(tmp_path / "demonstrations.csv")
    assert numbers(shown, joints).tobytes() == taught.rows.reshape(-1, 4).tobytes()
    assert shown["demonstration"][::142] == ["1", "2", "3", "4"]
    assert shown["index"][:3] == ["1", "2", "3"]
    assert shown["name"][::142] == [each.name for each in taught.demonstrations]
    assert [float(t) for t in shown["time [s]"][141::142]] == [
        each.duration for each in taught.demonstrations
    ]
    network = numbers(read(tmp_path / "network.csv"), [f"network {name}" for name in joints])
    np.testing.assert_array_equal(network, lesson.curve)


def test_the_comparison_leads_to_the_same_measures(tmp_path: Path) -> None:
    material = done()
    tables.write(material, Job(tmp_path))
    shown = read(tmp_path / "comparison.csv")
    measured = numbers(shown, [f"measured left hand {axis} [m]" for axis in "xyz"])
    mean = numbers(shown, [f"mean left hand {axis} [m]" for axis in "xyz"])
    taught = material.taught
    expected = deviation(material.reproduction.performance, taught.mean, taught.joints)
    assert np.linalg.norm(measured - mean, axis=1).max() == expected.hand_max


def test_the_hand_is_meant_to_be_where_the_turned_wrist_brings_it() -> None:
    """What the page's equation reads from the table is the number that the page shows."""
    material = done()
    played, taught = material.reproduction.performance, with_wrists(material.lesson.taught)
    columns = tables.comparison(taught, material.reproduction).columns
    measured, mean = (
        np.array([columns[f"{of} left hand {axis} [m]"] for axis in "xyz"]).T
        for of in ("measured", "mean")
    )
    expected = deviation(played, taught.mean, taught.joints, taught.hands)
    assert np.linalg.norm(measured - mean, axis=1).mean() == pytest.approx(expected.hand_mean)
    assert expected.hand_mean > material.reproduction.deviation.hand_mean + 0.01


def test_the_reproduction_is_there_tick_by_tick(tmp_path: Path) -> None:
    material = done()
    tables.write(material, Job(tmp_path))
    shown = read(tmp_path / "reproduction.csv")
    ticks = material.reproduction.performance.ticks
    last = [shown[name][-1] for name in list(shown)[1:16]]
    assert [float(angle) for angle in last] == ticks[-1].world.joint_positions.tolist()
    assert len(shown["time [s]"]) == len(ticks) + 1


def test_without_a_lesson_there_are_the_demonstrations(tmp_path: Path) -> None:
    assert [path.name for path in tables.write(listed(), Job(tmp_path))] == ["demonstrations.csv"]
    without = replace(done(), reproduction=None)
    assert not {"comparison.csv", "reproduction.csv"} & set(tables.tables_of(without))


def test_words_are_quoted_and_never_formulas() -> None:
    table = Table({"a": np.array([1.0, 2.5, 3.0])}, ("name", ["=1+1", 'say "no", no', "plain"]))
    assert table.text().splitlines()[1:] == ["1.0,'=1+1", '2.5,"say ""no"", no"', "3.0,plain"]
