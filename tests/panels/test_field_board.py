"""The field's board: what is seen on it, and what a dragged start point asks for."""

import warnings
from dataclasses import replace

import numpy as np
import pytest

from studio.engine.field_picture import FieldView
from studio.panels.compare import field_words
from studio.panels.field_board import MIDDLE, SIZE, FieldBoard, arrows, inside, placed, taken
from tests.engine.lessons_at_hand import lesson as learned
from tests.panels.nodes import Scene


@pytest.fixture(scope="module")
def view() -> FieldView:
    found = FieldView()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        assert found.look_at(learned(5, "field")) is not None
    return found


@pytest.fixture
def now(lesson, view: FieldView):
    played = lesson["played"]
    return replace(played, compare=replace(played.compare, field=view.picture))


def test_without_a_field_there_is_no_board(lesson) -> None:
    scene = Scene()
    FieldBoard(scene, lambda _: None).draw(lesson["played"])
    assert set(scene.nodes) == {"/field"}
    assert not scene.nodes["/field"].visible


def test_a_place_comes_back_from_the_board(view: FieldView) -> None:
    plane = view.picture.plane
    places = np.random.default_rng(1).uniform(plane.low, plane.high, (30, 2))
    points = placed(plane, places)
    np.testing.assert_allclose(taken(plane, points), places)
    assert (np.abs(points - MIDDLE)[:, 1:] <= SIZE / 2).all()
    corners = placed(plane, np.array([plane.low, plane.high]))
    np.testing.assert_allclose(corners[1, 1:] - corners[0, 1:], SIZE)


def test_all_of_it_is_drawn_on_the_board(now) -> None:
    scene, picture = Scene(), now.compare.field
    FieldBoard(scene, lambda _: None).draw(now)
    for name in ("shown", "stable", "plain", "stable_arrows", "plain_arrows"):
        points = scene.nodes[f"/field/{name}"].points.reshape(-1, 3)
        room = 0.1 if name.endswith("arrows") else 1e-9
        assert (np.abs(points - MIDDLE)[:, 1:] <= SIZE / 2 + room).all(), name
    for number, rollout in enumerate(picture.rollouts):
        node = scene.nodes[f"/field/start_{number}"]
        np.testing.assert_allclose(node.position, placed(picture.plane, rollout.start))


def test_stable_paths_are_told_from_plain_ones_without_color(now) -> None:
    scene = Scene()
    FieldBoard(scene, lambda _: None).draw(now)
    stable, plain = (scene.nodes[f"/field/{kind}"] for kind in ("stable", "plain"))
    assert stable.thickness > plain.thickness
    assert "thick = stable" in scene.nodes["/field/title"].points


def test_a_plain_field_alone_leaves_no_stable_one_behind(now) -> None:
    scene, found = Scene(), FieldView()
    board = FieldBoard(scene, lambda _: None)
    board.draw(now)
    plain = found.look_at(learned(20, "plain-field"))
    board.draw(replace(now, compare=replace(now.compare, field=plain)))
    assert not {"/field/stable", "/field/stable_arrows"} & set(scene.nodes)
    assert {"/field/plain", "/field/plain_arrows"} <= set(scene.nodes)
    assert "one plain field" in scene.nodes["/field/title"].points
    assert "one plain field" in field_words(plain)
    assert "stable" not in field_words(plain)
    board.draw(now)
    assert "/field/stable" in scene.nodes


def test_of_a_moved_start_only_the_paths_are_drawn_anew(now, view: FieldView) -> None:
    scene, asked = Scene(), []
    board = FieldBoard(scene, asked.append)
    board.draw(now)
    added, picture = scene.added, now.compare.field
    board.draw(now)
    assert scene.added == added
    moved = replace(picture, rollouts=(*picture.rollouts[1:], picture.rollouts[0]))
    board.draw(replace(now, compare=replace(now.compare, field=moved)))
    assert scene.added == added + 2


def test_a_dragged_start_keeps_to_the_board_and_asks_for_its_place_when_let_go(now) -> None:
    scene, asked, picture = Scene(), [], now.compare.field
    board = FieldBoard(scene, asked.append)
    board.draw(now)
    node = scene.nodes["/field/start_1"]
    eye = MIDDLE + np.array([5.0, 0.4, 0.3])
    node.drag("start", node.position, eye)
    node.drag("update", node.position + np.array([0.0, 9.0, 0.0]), eye)
    board.draw(now)
    assert node.position[1] == pytest.approx(MIDDLE[1] + SIZE[0] / 2)
    assert asked == []
    aim = (picture.plane.low + picture.plane.high) / 2
    node.drag("end", placed(picture.plane, aim), eye)
    assert [(order.index, order.u, order.v) for order in asked] == [(1, *map(pytest.approx, aim))]


def test_a_path_is_cut_where_it_leaves_the_board(view: FieldView) -> None:
    plane = view.picture.plane
    middle = (plane.low + plane.high) / 2
    out = middle + np.linspace(0.0, 2.0, 21)[:, None] * (plane.high - middle)
    kept = inside(plane, out)
    assert len(kept) == 11
    assert len(inside(plane, out[:5])) == 5
    assert len(inside(plane, out[15:])) == 2


def test_arrows_point_where_the_field_does_and_slow_ones_are_seen(view: FieldView) -> None:
    picture = view.picture
    shown = arrows(picture.plane, picture.places, picture.stable)
    ways = (shown[:, 1] - shown[:, 0])[:, 1:]
    flow = picture.stable / (picture.plane.high - picture.plane.low) * SIZE
    cosines = np.sum(ways * flow, axis=1) / (
        np.linalg.norm(ways, axis=1) * np.linalg.norm(flow, axis=1)
    )
    np.testing.assert_allclose(cosines, 1.0)
    assert np.linalg.norm(ways, axis=1).max() == pytest.approx(0.1)
