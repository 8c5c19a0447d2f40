"""The table that compares: what each motion comes to, against slow versions and by laws."""

import numpy as np
import pytest

from studio.engine.films import DemonstrationFilm
from studio.engine.measured import (
    envelope,
    followed,
    hand_paths,
    hands_alone,
    hands_followed,
    measure_demonstration,
    measure_performance,
)
from studio.engine.measures import hand_acceleration, hand_path
from studio.engine.performance import in_guards_words, joint_columns, whole_body
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.teaching import reproduce
from tests.engine.cards_at_hand import sample, take
from tests.engine.lessons_at_hand import alone, held_off, lesson, with_wrists


def test_a_robot_is_measured_as_its_reproduction_is() -> None:
    taught = lesson().taught
    found = measure_performance("thirty", "A", alone(), taught)
    expected = reproduce(lesson()).deviation
    np.testing.assert_array_equal(found.deviation.joint_rmse, expected.joint_rmse)
    assert found.deviation.hand_dtw == expected.hand_dtw
    assert (found.name, found.letter, found.block_down) == ("thirty", "A", True)


def test_what_the_guard_changed_is_told_beside_the_numbers() -> None:
    taught, held = lesson().taught, held_off(alone(), 5)
    assert measure_performance("", "A", held, taught).guarded == in_guards_words(held)
    assert measure_performance("", "A", alone(), taught).guarded == ""


def test_hands_that_turned_have_their_wrists_in_the_trails_and_in_the_measures() -> None:
    taught = lesson().taught
    turned = with_wrists(taught)
    for number, path in enumerate(hand_paths(turned, "left")):
        shown = turned.demonstrations[number]
        wrists = [shown.hands.at(time).wrist for time in np.linspace(0.0, shown.duration, 142)]
        columns = (*taught.joints, *shown.hands.options.wrist_joints("left"))
        body = whole_body(np.hstack([taught.rows[number], wrists]), columns)
        np.testing.assert_allclose(path, hand_path(body, "left"))
    assert np.abs(hand_paths(turned, "left") - hand_paths(taught, "left")).max() > 0.03
    plain, wristed = (measure_demonstration(take(), each).deviation for each in (taught, turned))
    np.testing.assert_array_equal(plain.joint_rmse, wristed.joint_rmse)
    assert wristed.hand_mean > plain.hand_mean + 0.01  # this take's own wrist never turned


def test_a_demonstration_is_measured_by_what_the_robot_did_then() -> None:
    taught, shown = lesson().taught, take().demonstration
    found = measure_demonstration(take(), taught)
    rows = followed(take(), len(taught.mean))[:, joint_columns(taught.joints)]
    rmse = np.sqrt(np.mean((rows - taught.mean) ** 2, axis=0))
    np.testing.assert_allclose(found.deviation.joint_rmse, rmse)
    assert (found.name, found.letter, found.block_down) == (shown.name, "", True)
    assert found.deviation.hand_dtw <= found.deviation.hand_mean <= found.deviation.hand_max
    # People differ more from their mean than a robot that plays it.
    assert (
        found.deviation.hand_mean
        > measure_performance("", "A", alone(), taught).deviation.hand_mean
    )


def test_what_was_followed_is_what_was_measured_in_each_tick() -> None:
    shown = take().demonstration
    ticks = len(shown.times)
    joints = followed(take(), ticks)
    samples = sample().samples[shown.first_sample : shown.last_sample]
    measured = np.stack([tick.world.joint_positions for tick in samples])
    np.testing.assert_allclose(joints[1:], measured, atol=1e-9)


def test_acceleration_is_that_of_a_circle_that_a_turning_shoulder_draws() -> None:
    """s0 turns the whole arm about the upright: the acceleration is radius times speed squared."""
    speed = 1.2  # [rad/s]
    joints = np.zeros((60, 15))
    joints[:, joint_columns(["left_s0"])] = speed * CONTROL_PERIOD * np.arange(60)[:, None]
    path = hand_path(joints, "left")
    middle = np.mean(hand_path(whole_body(np.array([[0.0], [np.pi]]), ["left_s0"]), "left"), axis=0)
    radius = np.linalg.norm(path[0, :2] - middle[:2])
    assert hand_acceleration(joints, "left") == pytest.approx(radius * speed**2, rel=1e-3)
    assert hand_acceleration(joints, "right") == pytest.approx(0.0, abs=1e-9)
    both = hand_acceleration(joints, "both")
    assert both == pytest.approx(radius * speed**2 / np.sqrt(2.0), rel=1e-3)
    assert np.isnan(hand_acceleration(joints[:2], "left"))


def test_the_envelope_is_where_every_demonstration_passes_however_late() -> None:
    paths = hand_paths(lesson().taught, "left")
    middle, radius = envelope(paths)
    assert paths.shape == (2, 142, 3)
    for place in (0, 50, 71, 100, 141):
        nearest = [min(np.linalg.norm(point - middle[place]) for point in path) for path in paths]
        assert radius[place] == pytest.approx(max(nearest))
    assert (radius <= np.linalg.norm(paths - middle, axis=-1).max(axis=0) + 1e-12).all()


def test_a_hands_trail_begins_where_the_robot_does_and_ends_at_the_playhead() -> None:
    trail = hands_alone(alone(), 2.0, 61)
    assert list(trail) == ["left"]
    np.testing.assert_allclose(trail["left"][0], hand_path(alone().start[None], "left")[0])
    at_two = alone().ticks[59].world.joint_positions
    np.testing.assert_allclose(trail["left"][-1], hand_path(at_two[None], "left")[0], atol=1e-9)


def test_the_trail_of_a_replay_passes_where_the_replayed_robot_is() -> None:
    film = DemonstrationFilm(take())
    trail = hands_followed(take(), 2.0, 61)
    assert list(trail) == ["left"]
    for tick in (0, 17, 60):
        joints = film.at(tick * CONTROL_PERIOD).world.joint_positions
        expected = hand_path(joints[None], "left")[0]
        np.testing.assert_allclose(trail["left"][tick], expected, atol=1e-9)
