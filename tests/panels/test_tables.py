"""Numbers as people see them: beside their floor, with units, and with words where one lacks."""

import re

from studio.panels.compare import outcome
from studio.panels.numbers import learned
from studio.panels.settings import GATES, MAPPINGS, WRISTS
from studio.panels.source import described, sample_files


def cells(html: str) -> list[list[str]]:
    rows = re.findall(r"<tr>(.*?)</tr>", html)
    return [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row) for row in rows]


def test_learning_is_shown_beside_its_floor(lesson) -> None:
    made = lesson["trained"].lesson
    head, *rows = cells(learned(made, {}))
    assert head == ["joint", "MSE [rad²]", "floor [rad²]", "ratio"]
    assert [row[0] for row in rows] == ["left_s0", "left_s1", "left_e0", "left_e1"]
    for row, mse, floor in zip(rows, made.mse, made.floor, strict=True):
        assert row[1:] == [f"{mse:.2e}", f"{floor:.2e}", f"{mse / floor:.4f}"]
    assert "20 neurons" in learned(made, {})


def test_without_a_floor_there_are_words(lesson) -> None:
    made = lesson["trained on one"].lesson
    assert made.floor is None
    assert all(row[2:] == ["none", "–"] for row in cells(learned(made, {}))[1:])
    assert made.floor_note in learned(made, {})


def test_comparison_has_units_and_a_verdict(lesson) -> None:
    now = lesson["played"]
    html = outcome(now)
    table = {row[0]: row[1:] for row in cells(html)}
    error = now.reproduction.deviation
    assert table[""] == ["shown", "A"]
    assert table["hand, mean [mm]"][1] == f"{1000.0 * error.hand_mean:.1f}"
    assert table["s0 [deg]"][1] == f"{error.joint_rmse[0] * 180.0 / 3.14159265:.2f}"
    assert "The block is down." in html


def test_the_source_tells_its_size_and_its_hands(lesson) -> None:
    assert "No source yet" in described(lesson["start"])
    source = lesson["sourced"].source
    html = described(lesson["sourced"])
    assert f"{source.frames} frames" in html
    assert "with hand states" in html


def test_choices_have_names_of_their_own() -> None:
    for labels in (MAPPINGS, GATES, WRISTS):
        assert len(set(labels.values())) == len(labels)


def test_samples_are_offered_by_what_they_do() -> None:
    samples = sample_files()
    assert any("recording" in name for name in samples)
    assert any("skeletons" in name for name in samples)
    assert all(path.is_file() for path in samples.values())
