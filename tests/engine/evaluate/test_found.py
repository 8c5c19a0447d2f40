"""All forms in which an evaluation leaves the studio say the same, and none holds a time."""

import json
import re
from dataclasses import replace
from xml.etree import ElementTree as ET

import pytest

from studio.engine.evaluate.charts import grid_picture
from studio.engine.evaluate.found import Found, shown_evaluation, shown_grid
from studio.engine.evaluate.page import parts_rows
from studio.engine.evaluate.report import hurting_in_words, paired_in_words
from studio.engine.evaluate.variation import Variations
from tests.engine.evaluate.made_up import evaluation, grid, made_up

GRID = grid(rbf="0 8 17 20", newrb="0 0 1 2")
FOUND = {"one": shown_evaluation(evaluation()), "many": shown_grid(GRID)}


@pytest.mark.parametrize("found", FOUND.values(), ids=FOUND)
def test_it_is_one_object_of_json_without_times(found: Found) -> None:
    text = json.dumps(found.json, allow_nan=False)
    assert json.loads(text) == json.loads(json.dumps(found.json))
    assert not re.search(r"\b(seconds|date|elapsed|wall|jobs)\b", text)


def test_the_object_tells_rates_pairs_and_parts() -> None:
    found = FOUND["one"].json
    assert (found["scene"], found["seed"]) == ("push-down", 0)
    assert found["widths"]["block"] == 0.06
    assert found["model"]["successes"] == 9
    assert found["model"]["failures"] == {"the block still stands": 3}
    first, second = found["demonstrations"]
    assert (first["successes"], first["trials"]) == (3, 4)
    assert second["paired"] == {
        "both": 1,
        "only_model": 2,
        "only_this": 0,
        "neither": 1,
        "chance": 0.5,
    }
    assert found["demonstrations_rate"]["rate"] == 0.5
    assert sum(part["trials"] for part in found["by_variation"]["mass [%]"]) == 12


def test_the_object_of_a_grid_tells_each_cell_and_the_answer() -> None:
    found = FOUND["many"].json
    assert [cell["successes"] for cell in found["cells"]] == [0, 8, 17, 20, 0, 0, 1, 2]
    assert found["needed"]["rbf"]["neurons"] == 8
    assert found["needed"]["newrb"]["neurons"] is None


def test_people_read_the_same_numbers() -> None:
    words = FOUND["one"].text
    assert "9 of 12" in words
    assert "3 x the block still stands" in words
    assert "does the task in 2, this one alone in 0" in words
    many = FOUND["many"].text
    assert "rbf: 8 neurons do the task" in many
    assert "newrb: up to 8 neurons are not enough" in many


def test_where_no_trial_differs_no_test_is_quoted() -> None:
    words = paired_in_words(made_up("one", "+-"), made_up("other", "+-"))
    assert words == "the same outcome in all of the same 2 trials"


def test_what_hurts_most_comes_first() -> None:
    usual = evaluation()
    drawn = [usual.conditions.variation(usual.tested.motion, i).measures for i in range(60)]
    pattern = "".join("+" if each["mass [%]"] < 100.0 else "-" for each in drawn)
    lines = hurting_in_words(replace(usual, tested=made_up("model", pattern)))
    assert lines[0].startswith("By mass [%]: 100 % from ")
    assert len(lines) <= 2
    assert all(re.match(r"By .*: [\d.]+ % from ", line) for line in lines)


def test_what_chance_explains_is_not_said_to_hurt() -> None:
    found = evaluation()
    assert len({part.rate.value for parts in found.parts.values() for part in parts}) > 1
    assert hurting_in_words(found) == ["No variation stands out in 12 trials."]


def test_the_picture_is_svg_with_a_line_a_learner_and_the_band() -> None:
    picture = ET.fromstring(grid_picture(GRID))
    texts = " ".join(picture.itertext())
    for words in ("How many neurons does the task need?", "the demonstrations' own", "MSE / floor"):
        assert words in texts
    names = "{http://www.w3.org/2000/svg}"
    lines = [each for each in picture.iter(f"{names}polyline") if each.get("stroke") != "none"]
    curves = [each for each in lines if len(each.get("points", "").split()) == 4]
    intervals = [each for each in lines if len(each.get("points", "").split()) == 2]
    assert (len(curves), len(intervals)) == (4, 8)
    for rate, bar in zip(("0", "8"), intervals[:2], strict=True):
        xs = {point.split(",")[0] for point in bar.get("points", "").split()}
        assert len(xs) == 1, rate  # upright


def test_pages_need_no_network_and_hold_the_table() -> None:
    for found in FOUND.values():
        assert not re.search(r'(src|href)="', found.page)
        assert "95 %" in found.page
    assert "<svg" in FOUND["many"].page


def test_tables_in_markdown_hold_the_same_numbers() -> None:
    table, _, answers = FOUND["many"].tables.partition("\n\n")
    rows = table.splitlines()
    assert rows[0].startswith("| neurons | rbf: success")
    assert rows[4].startswith("| 4 | 85 % (64 to 94.8 %), 3 |")
    assert len(rows) == 2 + 4 + 1
    assert all(line.count("|") == 4 for line in rows)
    assert "- rbf: 8 neurons do the task" in answers
    assert "3 × the block still stands" in FOUND["one"].tables
    assert "| mass [%] |" in FOUND["one"].tables


def test_what_was_drawn_least_and_most_stands_under_its_heading() -> None:
    """Where equal draws leave two parts, as of a latency of one tick, there is no middle."""
    usual = evaluation()
    coarse = replace(usual.conditions, widths=Variations(latency=1))
    head, rows = parts_rows(replace(usual, conditions=coarse))
    assert head == ("drawn", "lowest", "middle", "highest")
    cells = {name: tuple(told) for name, *told in rows}
    lowest, middle, highest = cells["latency [ticks]"]
    assert (lowest[-8:], middle, highest[-8:]) == ("(0 to 0)", "", "(1 to 1)")
    assert all(cells["mass [%]"])
    assert {len(told) for told in cells.values()} == {3}
