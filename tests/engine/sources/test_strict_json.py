import pytest

from studio.engine.errors import StudioError
from studio.engine.sources.strict_json import (
    as_flag,
    as_numbers,
    as_text,
    json_entries,
    json_lines,
)


def test_lines_have_places_and_blank_ones_count():
    assert list(json_lines(['{"a": 1}', "", "  ", "[2]"])) == [
        ("line 1", {"a": 1}),
        ("line 4", [2]),
    ]


def test_a_line_that_is_not_json_is_named_after_those_before_it():
    lines = json_lines(["1", "", '{"a": ]'])
    assert next(lines) == ("line 1", 1)
    with pytest.raises(StudioError, match=r"^line 3: column 7: expected valid JSON, found ']'"):
        next(lines)


def test_entries_of_a_list_have_places():
    assert list(json_entries('[1, {"a": []}]')) == [("entry 0", 1), ("entry 1", {"a": []})]
    with pytest.raises(StudioError, match="expected the recording as a list"):
        list(json_entries("{}"))


def test_only_finite_numbers_that_a_float_can_hold_pass():
    assert as_numbers([1, 2.5, -(2**70)], "x").tolist() == [1.0, 2.5, -(2.0**70)]
    assert as_numbers([], "x").shape == (0,)
    for bad in ([10**400], [True], ["1"], [None], [[1]], [float("nan")], [float("inf")], "12", 1):
        with pytest.raises(StudioError, match="x"):
            as_numbers(bad, "x")
    with pytest.raises(StudioError, match="expected 2 x, found 1"):
        as_numbers([1], "x", 2)


def test_flags_are_true_or_false_and_texts_can_be_printed():
    assert [as_flag(flag, "it") for flag in (True, False)] == [True, False]
    assert as_text("ü \U0001f600", "it") == "ü \U0001f600"
    for bad in (0, 1, None, "true", []):
        with pytest.raises(StudioError, match="expected it as true or false"):
            as_flag(bad, "it")
    for bad in (1, None, [], "half \ud83d of one"):
        with pytest.raises(StudioError, match="expected it as a text"):
            as_text(bad, "it")
