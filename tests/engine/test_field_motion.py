import numpy as np
import pytest

from studio.engine import field_motion
from studio.engine.errors import StudioError
from studio.engine.field_motion import (
    OnePlainField,
    PushAndReturn,
    legs_of,
    split_where_time_restarts,
)
from studio.engine.sweep import stacked
from studio.engine.teaching import INDEX_TIME, LearnerSettings, learn, reproduce
from studio.rbf import StableField
from tests.engine.sweeps import samples


@pytest.fixture(scope="module")
def taught():
    return samples()


@pytest.fixture(scope="module")
def push_and_return(taught):
    return PushAndReturn(15).fit(*stacked(taught.rows))


def from_start(rows):
    return np.linalg.norm(rows - rows[0], axis=1)


def test_demonstrations_are_taken_apart_where_time_restarts(taught):
    for one, rows in zip(
        split_where_time_restarts(*stacked(taught.rows)), taught.rows, strict=True
    ):
        np.testing.assert_array_equal(one[0], INDEX_TIME)
        np.testing.assert_array_equal(one[1], rows)


def test_the_arm_passes_every_posture_twice_in_opposite_directions(taught):
    """Why no single field can do it: Eq. 5 has one velocity for each posture."""
    (there, back) = legs_of(split_where_time_restarts(*stacked(taught.rows)))
    angles = []
    for (_, out), (_, home) in zip(there, back, strict=True):
        leaving, returning = np.gradient(out, axis=0), np.gradient(home, axis=0)
        moving = np.linalg.norm(leaving, axis=1) > 0.2 * np.linalg.norm(leaving, axis=1).max()
        for posture, velocity in zip(out[moving], leaving[moving], strict=True):
            other = returning[np.linalg.norm(home - posture, axis=1).argmin()]
            speeds = np.linalg.norm(velocity) * np.linalg.norm(other)
            if speeds > 0.0:
                angles.append(np.degrees(np.arccos(np.clip(velocity @ other / speeds, -1, 1))))
    assert np.median(angles) > 150.0


def test_a_stable_field_for_both_ways_stands_still_where_it_starts(taught):
    """Shifted to one start, which is the goal too, demonstrations cannot even be taken."""
    closed = [(INDEX_TIME, rows - rows[0] + taught.mean[0]) for rows in taught.rows]
    with pytest.raises(ValueError, match="starts at its goal"):
        StableField(goal=taught.mean[0]).fit(closed)
    field = StableField(goal=taught.mean[0], n_translations=5, max_iterations=30)
    with pytest.warns(UserWarning, match="misses its demonstrations"):  # hundredths of a rad away
        field.fit([(INDEX_TIME, rows) for rows in taught.rows])
    path = field.rollout(taught.mean[0], 1.0, 142)
    assert from_start(path).max() < 0.01 * from_start(taught.mean).max()


@pytest.mark.parametrize(
    ("neurons", "iterations"), [(1, 300), (60, 300), (61, 295), (300, 60), (1000, 18)]
)
def test_more_neurons_are_refined_less_as_somebody_waits(taught, monkeypatch, neurons, iterations):
    asked = []

    def enough(**settings):
        asked.append((settings["n_translations"], settings["max_iterations"]))
        raise ValueError("enough")

    monkeypatch.setattr(field_motion, "StableField", enough)
    with pytest.raises(StudioError, match="enough"):
        PushAndReturn(neurons).fit(*stacked(taught.rows))
    assert asked == [(neurons, iterations)]


@pytest.mark.parametrize("neurons", [20, 50, 142])
def test_one_plain_field_does_not_push_and_come_back(taught, neurons):
    plain = OnePlainField(neurons).fit(*stacked(taught.rows))
    path = plain.predict(INDEX_TIME)
    reach = max(from_start(rows).max() for rows in taught.rows)
    there = from_start(path).max() > 0.9 * reach
    back = np.linalg.norm(path[-1] - taught.mean[-1]) < 0.1 * reach
    assert not (there and back)
    assert "nothing certified" in plain.remark


def test_two_fields_go_there_and_come_back(taught, push_and_return):
    path = push_and_return.predict(INDEX_TIME)
    (there, back) = (field.goal_ for field in push_and_return.fields)
    assert np.linalg.norm(path - there, axis=1).min() < 0.05
    np.testing.assert_allclose(path[-1], back, atol=0.05)
    np.testing.assert_allclose(path[-1], taught.mean[-1], atol=0.05)
    assert all(field.certificate_.holds for field in push_and_return.fields)
    assert push_and_return.remark.count("convergence holds") == 2


def test_it_follows_its_fields(push_and_return):
    times = np.linspace(5.0, 20.0, 31)
    path = push_and_return.predict(times)
    velocity = (
        push_and_return.predict(times + 1e-3) - push_and_return.predict(times - 1e-3)
    ) / 2e-3
    np.testing.assert_allclose(push_and_return.fields[0].velocity(path), velocity, atol=2e-3)


def test_a_motion_that_does_not_come_back_is_one_field(taught):
    turn = from_start(taught.mean).argmax()
    rows = taught.rows[:, : turn - 5]
    times = np.tile(INDEX_TIME[: turn - 5], len(rows))
    motion = PushAndReturn(8).fit(times, rows.reshape(len(times), -1))
    assert len(motion.fields) == 1


def test_demonstrations_that_end_in_different_places_are_refused_in_words(taught):
    elsewhere = taught.rows[0] + np.linspace(0.0, 0.3, len(taught.rows[0]))[:, np.newaxis]
    mixed = np.stack([taught.rows[1], elsewhere])
    with pytest.raises(StudioError, match=r"from the goal.*leave out the demonstration"):
        PushAndReturn(5).fit(*stacked(mixed))


def test_demonstrations_of_two_kinds_are_told_apart(taught):
    stays = taught.rows[0].copy()
    turn = from_start(stays).argmax()
    stays[turn:] = stays[turn]
    mixed = np.concatenate([taught.rows[1:], stays[np.newaxis]])
    with pytest.raises(StudioError, match="number 4 differs"):
        PushAndReturn(5).fit(*stacked(mixed))
    with pytest.raises(StudioError, match="nothing moves"):
        OnePlainField(5).fit(*stacked(np.zeros((2, 142, 4))))


@pytest.mark.parametrize("unit", [0.005, 1.0])
def test_the_unit_of_time_changes_nothing(taught, push_and_return, unit):
    inputs, rows = stacked(taught.rows)
    motion = PushAndReturn(15).fit(unit * inputs, rows)
    path = motion.predict(unit * INDEX_TIME)
    np.testing.assert_allclose(path, push_and_return.predict(INDEX_TIME), atol=1e-3)


def test_baxter_pushes_the_block_down_by_two_fields_within_its_limits(taught):
    lesson = learn(taught, LearnerSettings("field", 15))
    alone = reproduce(lesson)
    assert alone.performance.block_down
    assert alone.deviation.hand_dtw < 0.03
    assert "global convergence holds" in lesson.remark
