"""The table and the arcs tell the same angles, of each arm that is followed."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
import viser

from studio.engine.arm_arcs import NAMES, STEPS, arm_arcs
from studio.engine.choices import Choices
from studio.engine.placement import Placement
from studio.engine.skeleton import SIDES, Joint
from studio.panels.arcs import NUMBERS, ArcsView, letters_of, number
from studio.panels.arm_angles import ArmAnglesPanel, described
from studio.panels.palette import ARCS, css
from studio.panels.settings import forearm
from tests.panels.nodes import Scene


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
    words = described(both)
    assert words.count("<table") == 2
    first, second = words.split("</table>")[:2]
    for table, letter, yours, robots in (
        (first, "R", "right", "left"),
        (second, "L", "left", "right"),
    ):
        assert f"{letter}: your {yours} arm" in table
        assert f"Baxter&#x27;s {robots}" in table
        assert all(f">{letter}{each}</b>" in table for each in NUMBERS.values())


@pytest.fixture
def view() -> ArcsView:
    made = ArcsView(Scene())
    made.wanted = True
    return made


@pytest.mark.parametrize(
    ("choices", "followed"),
    [
        (Choices(), {"left"}),
        (Choices(mirrored=True), {"right"}),
        (Choices("right"), {"right"}),
        (Choices("both"), {"left", "right"}),
        (Choices("both", mirrored=True), {"left", "right"}),
    ],
)
def test_each_arm_that_is_followed_has_its_arcs_at_it(lesson, view, choices, followed) -> None:
    now = replace(lesson["armed"], choices=choices)
    view.draw(now)
    placement = Placement.of(now.skeleton)
    assert {side for side in SIDES if view._arms[side].root.visible} == followed
    for side in followed:
        arm, arcs = view._arms[side], arm_arcs(now.skeleton, side)
        expected = np.stack([placement.place(arc.points) for arc in arcs])
        points = arm._lines.points.reshape(len(NAMES), STEPS - 1, 2, 3)
        assert points[:, :, 0] == pytest.approx(expected[:, :-1], abs=1e-5)
        assert points[:, :, 1] == pytest.approx(expected[:, 1:], abs=1e-5)
        letter = letters_of(choices.persons_sides)[side]
        texts = [label.text for label in arm._labels.values()]
        assert texts == [letter + number(arc) for arc in arcs]
        assert bool(letter) is (len(followed) == 2)
        for arc, label in zip(expected, arm._labels.values(), strict=True):
            assert np.linalg.norm(arc - label.position, axis=1).min() < 0.35


def test_the_numbers_of_two_arms_stand_apart(lesson, view) -> None:
    """Seen from the front, where a number is 5 cm high and 15 cm wide."""
    view.draw(replace(lesson["armed"], choices=Choices("both")))
    labels = [label for arm in view._arms.values() for label in arm._labels.values()]
    places = [label.position[1:] for label in labels]
    for i, one in enumerate(places):
        for other in places[:i]:
            across, up = np.abs(one - other)
            assert across > 0.15 or up > 0.05


def test_arcs_are_sent_on_request_and_only_where_something_is_new(lesson, server, monkeypatch):
    view, sent, drawn = ArcsView(server.scene), [], []
    draw = type(view._arms["left"]).draw
    monkeypatch.setattr(
        type(view._arms["left"]), "draw", lambda *given: (drawn.append(given[0]), draw(*given))
    )
    for each in (type(view._root), type(view._arms["left"]._lines)):
        monkeypatch.setattr(each, "_queue_update", lambda node, name, _: sent.append(name))
    now = replace(lesson["armed"], choices=Choices("both"))
    view.draw(now)
    assert (view._root.visible, sent, drawn) == (False, [], [])
    view.wanted = True
    view.draw(now)
    assert sent.count("points") == 2
    assert len(drawn) == 2
    sent.clear()
    view.draw(now)
    view.draw(replace(now, time=now.time + 1.0, choices=replace(now.choices, gate="open")))
    assert (len(drawn), sent) == (2, [])
    one = replace(now, choices=Choices(), skeleton=replace(now.skeleton))
    view.draw(one)
    assert sent.count("points") == 0  # they are where they were: only the other arm's are gone
    moved = replace(now.skeleton, positions=now.skeleton.positions * 1.01)
    view.draw(replace(one, skeleton=moved))
    assert sent.count("points") == 1


def test_two_arms_are_as_many_bytes_as_one_was(view) -> None:
    """Of 24 points an arc, for one arm, as float32."""
    assert sum(arm._lines.points.size for arm in view._arms.values()) <= 1.05 * 6 * 23 * 2 * 3


def test_arcs_are_seen_in_the_colors_of_the_table(lesson, view) -> None:
    words = described(lesson["armed"])
    colors = view._arms["left"]._lines.colors.reshape(len(NAMES), -1, 3)
    for of_arc, color in zip(colors, ARCS, strict=True):
        (linear,) = np.unique(of_arc, axis=0)
        light = linear / 255.0  # back to what a screen shows
        shown = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
        assert 255.0 * shown == pytest.approx(color, abs=3.0)
        assert css(color) in words


def test_a_degenerate_arm_leaves_its_arcs_out(lesson, view) -> None:
    now = lesson["armed"]
    positions = now.skeleton.positions.copy()
    positions[Joint.THUMB_LEFT] = positions[Joint.WRIST_LEFT]
    view.draw(replace(now, skeleton=replace(now.skeleton, positions=positions)))
    shown = [name for name, label in view._arms["left"]._labels.items() if label.visible]
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
