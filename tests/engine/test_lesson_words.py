"""Only what matters is said, and where it does."""

from dataclasses import replace

import pytest

from studio.engine.export.equations import learned_numbers
from studio.engine.lesson_words import REMEMBERS, RIPPLES, worth_knowing
from studio.engine.teaching import LearnerSettings, learn
from tests.engine.sweeps import samples


def words(name: str, neurons: int, **values: float) -> str:
    """What is said of a network, with some of its numbers set."""
    lesson = learn(samples(), LearnerSettings(name, neurons))
    equations = learned_numbers(lesson)
    for key, value in values.items():
        key = key.replace("_", " ").replace("held out", "held-out")  # noqa: PLW2901
        equations[key] = replace(equations[key], value=value)
    return " ".join(worth_knowing(lesson, equations))


def test_a_good_network_needs_no_words() -> None:
    assert words("rbf", 10) == ""


def test_overlapping_gaussians_are_told_with_rank_and_condition() -> None:
    lesson = learn(samples(), LearnerSettings("rbf", 50))
    said = words("rbf", 50)
    assert f"Only {lesson.model.rank_} of the 50 neurons" in said
    assert "condition over 1e+15" in said
    assert "Eq. 15 as printed squares that number" in said


def test_too_few_neurons_have_not_learned_enough() -> None:
    assert "too little" in words("rbf", 2)
    assert "Eq. 15" not in words("rbf", 2)


@pytest.mark.parametrize(
    ("key", "limit", "piece"),
    [("acceleration", RIPPLES, "it ripples"), ("held_out_ratio", REMEMBERS, "it has not seen")],
)
def test_a_threshold_is_one(key: str, limit: float, piece: str) -> None:
    assert piece not in words("rbf", 10, **{key: limit})
    assert piece in words("rbf", 10, **{key: limit + 1e-6})


def test_what_is_not_known_yet_is_not_said() -> None:
    lesson = learn(samples(), LearnerSettings("rbf", 50))
    (rank, condition) = worth_knowing(lesson, {})
    assert "rank" in rank
    assert "condition" in condition


def test_a_field_keeps_no_time_so_nothing_at_equal_times_is_said() -> None:
    assert words("plain-field", 5, held_out_ratio=15.0) == ""
