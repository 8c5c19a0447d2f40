"""The table and the arcs tell the same angles, of the arm that is followed."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
import viser

from studio.engine.arm_arcs import NAMES, STEPS, arm_arcs
from studio.engine.choices import Choices
from studio.engine.skeleton import Joint
from studio.panels.arcs import NUMBERS, ArcsView, number
from studio.panels.arm_angles import ArmAnglesPanel, described
from studio.panels.placing import Placing
from studio.panels.settings import forearm


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    made = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    yield made
    made.stop()


def test_all_six_stand_in_the_table_with_baxters_joints(lesson) -> None:
    now = lesson["armed"]
    words = described(now)
    for arc in arm_arcs(now.skeleton, "left"):
        assert f">{NUMBERS[arc.name]}</b> {arc.name.replace('_', ' ')}<" in words
        assert f">{math.degrees(arc.angle):.0f}°<" in words
    for joint in ("s0", "s1", "e0", "e1", "w0", "w1"):
        assert f">{joint}<" in words
    assert "your left arm" in words
    assert "Choose a source" in described(lesson["start"])


def test_both_arms_have_a_table_each(lesson) -> None:
    both = replace(lesson["armed"], choices=Choices(arms="both", mirrored=True))
    assert described(both).count("<table") == 2
    assert "your right arm" in described(both)


def test_arcs_are_drawn_where_the_person_stands_and_on_request(lesson, server) -> None:
    now = lesson["armed"]
    view = ArcsView(server.scene)
    view.draw(now)
    assert not view._root.visible
    view.wanted = True
    view.draw(now)
    assert view._root.visible
    arcs = arm_arcs(now.skeleton, "left")
    points = np.asarray(view._lines.points).reshape(len(NAMES), STEPS - 1, 2, 3)
    expected = Placing().of(now).place(arcs[3].points)
    # As float32, as it is sent; `Placing` puts the same person to the same place.
    assert points[3][:, 0] == pytest.approx(expected[:-1], abs=1e-5)
    assert [label.text for label in view._labels.values()] == [number(arc) for arc in arcs]


def test_a_degenerate_arm_leaves_its_arcs_out(lesson, server) -> None:
    now, view = lesson["armed"], ArcsView(server.scene)
    positions = now.skeleton.positions.copy()
    positions[Joint.THUMB_LEFT] = positions[Joint.WRIST_LEFT]
    view.wanted = True
    view.draw(replace(now, skeleton=replace(now.skeleton, positions=positions)))
    shown = [name for name, label in view._labels.items() if label.visible]
    assert shown == list(NAMES[:4])


def test_the_checkbox_asks_for_the_arcs(lesson, server) -> None:
    view = ArcsView(server.scene)
    panel = ArmAnglesPanel(server.gui, view)
    panel._wanted.value = True
    panel._switch()
    assert view.wanted
    panel.draw(lesson["armed"])


def test_the_mapping_says_how_far_off_the_forearm_is_in_this_pose(lesson) -> None:
    now = lesson["armed"]
    exact, paper = forearm("exact", now), forearm("paper", now)
    assert "In this pose: 0° off" in exact
    assert "48° off in the median" in paper
    assert "In this pose" in paper
    assert "In this pose: 0° off" not in paper
    assert "In this pose" not in forearm("paper", lesson["start"])
