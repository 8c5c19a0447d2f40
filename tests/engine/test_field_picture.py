"""A field's picture: true to the field on its plane, and honest about where the plain one ends."""

import warnings
from functools import cache

import numpy as np
import pytest

from studio.engine.errors import StudioError
from studio.engine.field_picture import ACROSS, ALONG, STEPS, FieldPicture, FieldView, Plane
from studio.engine.teaching import Lesson
from tests.engine.lessons_at_hand import lesson


@cache
def taught() -> Lesson:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # few translations: quick, and less true
        return lesson(5, "field")


def pictured() -> tuple[FieldView, FieldPicture]:
    view = FieldView()
    picture = view.look_at(taught())
    assert picture is not None
    return view, picture


def test_learners_without_a_field_have_no_picture() -> None:
    view = FieldView()
    assert view.look_at(None) is None
    assert view.look_at(lesson()) is None
    with pytest.raises(StudioError, match="train a field"):
        view.place_start(0, 0.0, 0.0)


def test_a_plane_takes_places_up_and_down_again() -> None:
    plane = pictured()[1].plane
    np.testing.assert_allclose(plane.axes @ plane.axes.T, np.eye(2), atol=1e-12)
    places = np.random.default_rng(3).uniform(-1.0, 1.0, (20, 2))
    np.testing.assert_allclose(plane.drop(plane.lift(places)), places, atol=1e-12)
    np.testing.assert_allclose(plane.drop(plane.goal), 0.0)


def test_of_one_joint_there_is_a_plane_too() -> None:
    plane = Plane.through(np.array([0.5]), np.linspace(0.0, 0.5, 9)[:, None])
    assert plane.drop(np.array([[0.0], [0.5]])).shape == (2, 2)
    assert (plane.high > plane.low).all()


def test_arrows_are_the_fields_own_and_lie_where_the_demonstrations_do() -> None:
    _, picture = pictured()
    plane, field = picture.plane, taught().model.fields[0]
    assert picture.places.shape == (ACROSS * ALONG, 2)
    for number in (0, 40, 90):
        exact = field.velocity(plane.lift(picture.places[number])) @ plane.axes.T
        np.testing.assert_allclose(picture.stable[number], exact)
    for shown in picture.demonstrations:
        assert ((shown >= plane.low) & (shown <= plane.high)).all()
    assert not np.allclose(picture.stable, picture.plain)


def test_stable_rollouts_arrive_and_plain_ones_do_not() -> None:
    _, picture = pictured()
    reach = np.linalg.norm(picture.demonstrations[0][0])
    for rollout in picture.rollouts:
        assert rollout.stable.shape == rollout.plain.shape == (STEPS + 1, 2)
        np.testing.assert_allclose(rollout.stable[0], rollout.start, atol=1e-9)
        np.testing.assert_allclose(rollout.plain[0], rollout.start, atol=1e-9)
        assert np.linalg.norm(rollout.stable[-1]) < 0.02 * reach
    assert picture.missed > 0.1 * reach


def test_a_dragged_start_moves_its_own_rollout_only_and_stays_on_the_board() -> None:
    view, before = pictured()
    view.place_start(1, -0.5, 0.1)
    after = view.look_at(taught())
    np.testing.assert_allclose(after.rollouts[1].start, (-0.5, 0.1))
    np.testing.assert_allclose(after.rollouts[1].stable[0], (-0.5, 0.1), atol=1e-9)
    assert after.rollouts[0] is before.rollouts[0]
    assert after.plane is before.plane
    view.place_start(1, 99.0, -99.0)
    far = view.look_at(taught()).rollouts[1].start
    np.testing.assert_array_equal(far, (after.plane.high[0], after.plane.low[1]))


def test_the_plain_field_alone_is_seen_to_fail_by_itself() -> None:
    known, view = lesson(20, "plain-field"), FieldView()
    picture = view.look_at(known)
    assert (picture.legs, picture.stable) == (1, None)
    plane, field = picture.plane, known.model.field
    np.testing.assert_allclose(plane.goal, known.taught.rows[:, -1].mean(axis=0))
    np.testing.assert_allclose(
        picture.plain, field.velocity(plane.lift(picture.places)) @ plane.axes.T
    )
    reach = max(np.linalg.norm(shown, axis=1).max() for shown in picture.demonstrations)
    assert [rollout.stable for rollout in picture.rollouts] == [None] * 3
    assert picture.missed > 0.1 * reach
    view.place_start(0, *plane.high)
    np.testing.assert_allclose(view.look_at(known).rollouts[0].plain[0], plane.high)
    assert view.look_at(taught()).stable is not None
    assert view.look_at(known).stable is None


def test_both_legs_can_be_seen_and_no_third() -> None:
    view, there = pictured()
    assert (there.leg, there.legs) == (0, 2)
    view.show_leg(1)
    back = view.look_at(taught())
    assert back.leg == 1
    assert not np.allclose(back.plane.goal, there.plane.goal)
    for wrong in (-1, 2):
        with pytest.raises(StudioError, match="no such leg"):
            view.show_leg(wrong)


@pytest.mark.parametrize(("index", "u"), [(9, 0.0), (-1, 0.0), (0, float("nan"))])
def test_a_start_that_is_none_is_refused(index: int, u: float) -> None:
    view, _ = pictured()
    with pytest.raises(StudioError, match="no such start"):
        view.place_start(index, u, 0.0)
