"""A dragged node stays under the pointer, on its plane, and lands where it is let go."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.panels.dragging import SETTLING, Drag, in_the_picture, on_plane, over
from studio.panels.hearing import speaker
from tests.panels.nodes import Node

UP = np.array([0.0, 0.0, 1.0])
EYE = np.array([3.0, 1.0, 2.0])


class Block(Node):
    """A block on its desk, at the root of a scene."""

    def __init__(self) -> None:
        super().__init__(position=np.array([0.8, 0.2, 0.87]), drags={})

    def pull(self, phase: str, pointer: np.ndarray) -> None:
        self.drag(phase, pointer, EYE)


def dragged(node: Block, keep=np.array) -> tuple[Drag, list[np.ndarray]]:
    """Return what drags a node over its plane, and the places where it was let go."""
    dropped: list[np.ndarray] = []

    def moved(place: np.ndarray, is_let_go: bool) -> None:
        if is_let_go:
            dropped.append(place)

    return Drag(node, {None: over(UP)}, moved, keep), dropped


def seen_at(point: np.ndarray, nearer: float = 0.6) -> np.ndarray:
    """Return a point on the line of sight to another one."""
    return EYE + nearer * (point - EYE)


@given(st.tuples(*[st.floats(-2.0, 2.0)] * 2), st.floats(0.05, 3.0))
@settings(deadline=None, derandomize=True)
def test_what_is_seen_on_a_plane_lies_on_it_and_on_the_line_of_sight(place, share) -> None:
    point = np.array([*place, 0.87])
    found = on_plane(EYE, seen_at(point, share), np.array([9.0, 9.0, 0.87]), UP)
    np.testing.assert_allclose(found, point, atol=1e-9)


def test_what_is_seen_too_flat_or_behind_is_nowhere() -> None:
    flat = EYE + np.array([-1.0, 0.0, -0.01])
    assert on_plane(EYE, flat, np.zeros(3), UP) is None
    behind = EYE + np.array([-1.0, 0.0, 1.0])
    assert on_plane(EYE, behind, np.zeros(3), UP) is None
    assert on_plane(EYE, EYE, np.zeros(3), UP) is None


def test_it_follows_without_a_jump_and_lands_where_it_is_let_go() -> None:
    node = Block()
    drag, dropped = dragged(node)
    home = node.position.copy()
    grabbed = home + np.array([0.02, 0.01, 0.1])  # its edge, not its middle
    node.pull("start", seen_at(grabbed))
    drag.draw(home)
    np.testing.assert_allclose(node.position, home)
    on_it = on_plane(EYE, seen_at(grabbed), home, UP)
    moved = on_it + np.array([-0.1, 0.15, 0.0])
    node.pull("update", seen_at(moved))
    drag.draw(home)
    np.testing.assert_allclose(node.position, home + np.array([-0.1, 0.15, 0.0]))
    assert dropped == []
    node.pull("end", seen_at(moved))
    np.testing.assert_allclose(dropped[0], home + np.array([-0.1, 0.15, 0.0]))


@given(st.lists(st.tuples(*[st.floats(-0.2, 0.2)] * 2), min_size=1, max_size=8), st.data())
@settings(deadline=None, derandomize=True, max_examples=50)
def test_how_long_the_pointer_pauses_changes_nothing(steps, data) -> None:
    """A browser without a graphics card draws a picture in two seconds; a person holds still."""
    node = Block()
    drag, dropped = dragged(node)
    home = node.position.copy()
    node.pull("start", seen_at(home))
    for step in steps:
        node.pull("update", seen_at(home + np.array([*step, 0.0])))
        for _ in range(data.draw(st.integers(0, 5 * SETTLING))):
            drag.draw(home)
            np.testing.assert_allclose(node.position, home + np.array([*step, 0.0]), atol=2e-4)
    node.pull("end", seen_at(home + np.array([*steps[-1], 0.0])))
    np.testing.assert_allclose(dropped, [home + np.array([*steps[-1], 0.0])])


def test_after_it_was_let_go_it_stands_where_the_engine_has_it() -> None:
    node = Block()
    drag, _ = dragged(node)
    home, aside = node.position.copy(), np.array([0.1, 0.0, 0.0])
    node.pull("start", seen_at(home))
    node.pull("end", seen_at(home + aside))
    for _ in range(SETTLING):
        drag.draw(home)  # the engine has yet to hear of it
        np.testing.assert_allclose(node.position, home + aside)
    drag.draw(home)  # refused, say
    np.testing.assert_allclose(node.position, home)
    node.pull("start", seen_at(home))
    node.pull("end", seen_at(home + aside))
    drag.draw(home)
    drag.draw(home + 0.9 * aside)  # as near as it may come
    np.testing.assert_allclose(node.position, home + 0.9 * aside)


def test_a_second_drag_begins_where_the_first_one_ended() -> None:
    node = Block()
    drag, dropped = dragged(node)
    home, aside = node.position.copy(), np.array([0.1, 0.0, 0.0])
    node.pull("start", seen_at(home))
    node.pull("end", seen_at(home + aside))
    drag.draw(home)
    node.pull("start", seen_at(home + aside))
    node.pull("end", seen_at(home + 2 * aside))
    np.testing.assert_allclose(dropped[1], home + 2 * aside)


def test_a_pointer_over_the_horizon_moves_nothing_and_a_click_drops_nothing() -> None:
    node = Block()
    drag, dropped = dragged(node)
    home = node.position.copy()
    sky = EYE + np.array([-1.0, 0.0, 1.0])
    node.pull("start", sky)
    node.pull("end", sky)
    assert dropped == []
    node.pull("start", seen_at(home))
    node.pull("update", sky)
    drag.draw(home)
    np.testing.assert_allclose(node.position, home)


def test_it_keeps_where_it_may_be() -> None:
    node = Block()
    drag, dropped = dragged(node, lambda place: np.minimum(place, 0.85))
    home = node.position.copy()
    node.pull("start", seen_at(home))
    node.pull("update", seen_at(home + np.array([0.3, 0.0, 0.0])))
    drag.draw(home)
    assert node.position[0] == pytest.approx(0.85)
    node.pull("end", seen_at(home + np.array([0.02, 0.0, 0.0])))
    assert dropped[0][0] == pytest.approx(0.82)  # the grip was not lost at the edge


def test_who_drags_is_heard() -> None:
    node, heard = Block(), []
    Drag(node, {None: over(UP)}, lambda *_: heard.append(speaker()))
    node.pull("start", seen_at(node.position))
    assert (heard, speaker()) == ([1], None)


def test_keys_that_are_held_lead_other_ways() -> None:
    node = Block()
    Drag(node, {None: in_the_picture, "shift": over(UP)}, lambda *_: None)
    assert set(node.drags) == {None, "shift"}
    home, nearer = node.position.copy(), seen_at(node.position)
    places: list[np.ndarray] = []
    drag = Drag(node, {None: in_the_picture, "shift": over(UP)}, lambda at, _: places.append(at))
    up = np.array([0.0, 0.05, 0.05])
    node.drag("start", nearer, EYE)
    node.drag("update", nearer + up, EYE)
    np.testing.assert_allclose(places[-1], home + up)
    node.drag("end", nearer + up, EYE)
    drag.draw(home)
    node.drag("start", nearer, EYE, "shift")
    node.drag("update", nearer + up, EYE, "shift")
    assert places[-1][2] == pytest.approx(places[-2][2])
    assert places[-1][1] > places[-2][1]


def test_a_still_node_costs_nothing() -> None:
    node = Block()
    drag, _ = dragged(node)
    before = node.position
    drag.draw(before + 1e-6)
    assert node.position is before
    drag.draw(before + 0.1)
    assert node.position == pytest.approx(before + 0.1)
