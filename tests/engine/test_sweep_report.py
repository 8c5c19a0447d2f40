import json
import re

import pytest

from studio.engine.comparison import compare
from studio.engine.sweep import sweep
from studio.engine.sweep_charts import path_charts
from studio.engine.sweep_page import sweep_page
from studio.engine.sweep_report import as_number, sweep_as_json, sweep_as_text
from tests.engine.lessons_at_hand import with_wrists
from tests.engine.sweeps import Ticking, samples


@pytest.fixture(scope="module")
def table():
    return sweep(samples(), Ticking(), ("newrb", "rbf"), (5, 20))


@pytest.fixture(scope="module")
def contestants():
    return compare(samples(), Ticking(), ("rbf", "spline"))


def test_the_object_holds_the_table_and_the_papers(table, contestants):
    shown = json.loads(json.dumps(sweep_as_json(table, contestants), allow_nan=False))
    assert shown["joints"] == ["left_s0", "left_s1", "left_e0", "left_e1"]
    assert len(shown["rows"]) == 4
    row = shown["rows"][-1]
    assert list(row["mse"].values()) == pytest.approx(table.rows[-1].quality.mse.tolist())
    assert row["floor_ratio"] > 1.0
    assert shown["paper"][0]["mse"]["s1"] == 0.0391
    assert shown["suggestions"]["rbf"]["neurons"] == shown["alone"]["rbf"]["neurons"] == 20
    assert [each["learner"] for each in shown["comparison"]] == ["rbf", "spline"]
    assert "comparison" not in sweep_as_json(table)


def test_the_text_says_the_same(table, contestants):
    text = sweep_as_text(table, contestants)
    assert f"4 demonstrations of {table.taught.duration:.1f} s" in text
    assert f"{table.rows[-1].quality.floor_ratio:.4f}" in text
    assert "rbf: 20 neurons: the smallest of the 2 counts tried" in text
    assert "rbf, 20 neurons, alone: the block falls" in text
    assert "spline" in text


def test_the_page_has_both_tables_all_figures_and_no_network(table, contestants):
    page = sweep_page(table, contestants)
    for words in ("0.0391", "Fig. 9", "Fig. 10", "Which learner?", "smoothing spline", "floor"):
        assert words in page
    assert f"{table.rows[0].quality.mse[0]:.5f}" in page
    assert "http" not in page
    assert "<script" not in page
    assert page.count('role="img"') == 4 + 4 + 4 + 3
    assert not re.search(r"\b(nan|inf)\b", page)


def test_a_single_demonstration_makes_a_page_too():
    alone = sweep(samples(1), Ticking(), ("rbf",), (5,))
    assert "no floor" in sweep_as_text(alone)
    page = sweep_page(alone)
    assert "There is no floor to compare with" in page
    assert "How the error falls" not in page
    assert json.loads(json.dumps(sweep_as_json(alone)))["floor"] is None


def test_names_that_are_markup_are_shown_as_they_are(table):
    from dataclasses import replace  # noqa: PLC0415

    first = replace(table.taught.demonstrations[0], name="<b>&mine</b>")
    taught = replace(table.taught, demonstrations=(first, *table.taught.demonstrations[1:]))
    assert "<b>&mine" not in sweep_page(replace(table, taught=taught))


def test_a_wrist_that_turned_is_on_the_path_that_was_meant(table):
    from dataclasses import replace  # noqa: PLC0415

    turned = replace(table, taught=with_wrists(table.taught))
    assert path_charts(turned) != path_charts(table)
    assert path_charts(turned).count("<svg") == path_charts(table).count("<svg")


def test_missing_numbers_are_dashes():
    assert as_number(None, "8.3f") == "       –"
    assert as_number(1.23456, ".2f") == "1.23"
