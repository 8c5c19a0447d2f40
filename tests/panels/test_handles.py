"""A handle stays under the pointer while it is dragged, and at its joint while it is not."""

import asyncio
from collections.abc import Iterator
from types import SimpleNamespace

import numpy as np
import pytest
import viser

from studio.engine import commands
from studio.engine.placement import Placement
from studio.engine.skeleton import Joint
from studio.panels.dragging import SETTLING
from studio.panels.handles import Handles, near
from tests.panels.puppets import lived_through

EYE = (3.6, 0.75, 1.95)


@pytest.fixture(scope="module")
def now(tmp_path_factory: pytest.TempPathFactory):
    return dict(lived_through(tmp_path_factory.mktemp("recordings")))


@pytest.fixture(scope="module")
def scene() -> Iterator[viser.SceneApi]:
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    yield server.scene
    server.stop()


class Page:
    """A page whose pointer is moved by script."""

    def __init__(self, scene: viser.SceneApi, snapshot) -> None:
        self.posted: list[commands.Command] = []
        self.handles = Handles(scene, self.posted.append)
        self.snapshot = snapshot
        self.handles.draw(snapshot)

    def node(self, joint: Joint):
        return self.handles._handles[joint]._node

    def drag(self, joint: Joint, phase: str, pointer, level: bool = False) -> None:
        client = SimpleNamespace(camera=SimpleNamespace(position=EYE))
        event = SimpleNamespace(
            phase=phase, end_position=tuple(pointer), client=client, client_id=1
        )
        callbacks = self.node(joint)._impl.drag_cb
        (callback,) = (c.callback for c in callbacks if (c.modifier == "shift") is level)
        asyncio.run(callback(event))
        self.handles.draw(self.snapshot)


def test_handles_stand_at_their_joints_while_the_puppet_is_the_source(scene, now, lesson) -> None:
    page = Page(scene, now["taken"])
    points = Placement.of(page.snapshot.skeleton).place(page.snapshot.skeleton.positions)
    for joint in (Joint.HAND_LEFT, Joint.HAND_RIGHT, Joint.ELBOW_LEFT, Joint.ELBOW_RIGHT):
        assert page.node(joint).position == pytest.approx(points[joint])
    assert page.handles._root.visible
    page.handles.draw(lesson["sourced"])
    assert not page.handles._root.visible


def test_a_dragged_handle_keeps_to_the_pointer_and_the_page_does_not_pull_it_back(scene, now):
    page = Page(scene, now["taken"])
    node, grip = page.node(Joint.HAND_LEFT), np.array([0.02, -0.03, 0.01])
    start = np.array(node.position)
    page.drag(Joint.HAND_LEFT, "start", start - grip)
    for step in range(1, 6):
        shift = step * np.array([0.0, 0.02, 0.01])
        page.drag(Joint.HAND_LEFT, "update", start - grip + shift)
        assert node.position == pytest.approx(start + shift)
    asked = page.posted[-1]
    camera = Placement.of(page.snapshot.skeleton).to_camera(start + shift)
    assert (asked.side, asked.point) == ("left", pytest.approx(tuple(camera)))
    page.drag(Joint.HAND_LEFT, "end", start - grip + shift)
    for _ in range(SETTLING):
        page.handles.draw(page.snapshot)
    assert node.position == pytest.approx(start)


def test_where_it_was_dragged_is_where_the_camera_space_says(scene, now) -> None:
    """The handle's place, the command's point and the joint's own are one: nothing jumps."""
    page = Page(scene, now["taken"])
    page.drag(Joint.HAND_LEFT, "start", page.node(Joint.HAND_LEFT).position)
    point = page.snapshot.skeleton.positions[Joint.HAND_LEFT]
    assert page.posted == [commands.DragHand("left", pytest.approx(tuple(point)))]
    page.drag(Joint.ELBOW_RIGHT, "start", page.node(Joint.ELBOW_RIGHT).position)
    assert isinstance(page.posted[-1], commands.DragElbow)
    assert page.posted[-1].side == "right"


def test_with_shift_a_handle_keeps_its_height_along_the_line_of_sight(scene, now) -> None:
    page = Page(scene, now["taken"])
    start = np.array(page.node(Joint.HAND_LEFT).position)
    page.drag(Joint.HAND_LEFT, "start", start, level=True)
    pointer = start + np.array([0.05, 0.1, 0.05])
    page.drag(Joint.HAND_LEFT, "update", pointer, level=True)
    moved = np.array(page.node(Joint.HAND_LEFT).position)
    assert moved[2] == pytest.approx(start[2])
    sight, line = pointer - EYE, moved - EYE
    assert np.cross(sight, line) == pytest.approx(np.zeros(3), abs=1e-9)


def test_who_holds_a_handle_still_keeps_it(scene, now) -> None:
    page = Page(scene, now["taken"])
    node = page.node(Joint.HAND_LEFT)
    start, shift = np.array(node.position), np.array([0.0, 0.3, 0.0])
    page.drag(Joint.HAND_LEFT, "start", start)
    page.drag(Joint.HAND_LEFT, "update", start + shift)
    for _ in range(5 * SETTLING):
        page.handles.draw(page.snapshot)
    assert node.position == pytest.approx(start + shift)
    page.drag(Joint.HAND_LEFT, "update", start + 1.1 * shift)
    assert node.position == pytest.approx(start + 1.1 * shift)


def test_no_handle_goes_out_of_sight() -> None:
    joint = np.array([1.0, 2.0, 3.0])
    assert near(joint, joint) == pytest.approx(joint)
    far = near(joint + np.array([100.0, 0.0, 0.0]), joint)
    assert far == pytest.approx(joint + np.array([1.5, 0.0, 0.0]))
