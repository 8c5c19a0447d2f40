"""Hands' paths in the 3D view: thin for what was shown, bold up to the playhead for the robot's."""

from dataclasses import replace

import numpy as np
import pytest

from studio.engine.compare_status import Alone, CompareStatus
from studio.engine.films import DemonstrationFilm
from studio.engine.measures import hand_path
from studio.engine.robot import CONTROL_RATE
from studio.panels.palette import ROBOT
from studio.panels.trails import BOLD, EVERY, THIN, Trails, segments, tube
from tests.panels.nodes import Scene

ROOTS = ("/trails", "/b/trails")


def drawn(now, scene: Scene | None = None) -> Scene:
    scene = scene or Scene()
    Trails(scene, ROOTS).draw(now)
    return scene


def test_nothing_is_drawn_while_nothing_is_played(lesson) -> None:
    for state in ("start", "recording", "trained"):
        nodes = drawn(lesson[state]).nodes
        assert set(nodes) == {"/trails/alone", "/b/trails/alone"}
        assert not any(node.visible for node in nodes.values())


def test_each_demonstration_is_a_thin_line_and_all_lie_in_the_tube(lesson) -> None:
    nodes = drawn(lesson["played"]).nodes
    shown, envelope = nodes["/trails/shown_left"], nodes["/trails/envelope_left"]
    assert shown.points.shape == (2 * 141, 2, 3)
    assert shown.thickness == THIN < BOLD
    assert envelope.opacity < 0.5
    assert "/trails/shown_right" not in nodes
    lowest, highest = envelope.vertices.min(axis=0), envelope.vertices.max(axis=0)
    ends = shown.points.reshape(-1, 3)
    assert (ends >= lowest - 0.01).all()
    assert (ends <= highest + 0.01).all()


def test_the_bold_line_ends_where_the_hand_is(lesson) -> None:
    trails, scene = None, Scene()
    trails = Trails(scene, ROOTS)
    now = lesson["played"]
    line = scene.nodes["/trails/alone"]
    performance = now.reproduction.performance
    for time in (4.0, 1.0, 2.5):  # scrubbed to and fro
        trails.draw(replace(now, time=time))
        measured = performance.measured_at(np.array([time]))
        hand = hand_path(measured, "left")[0]
        assert np.linalg.norm(line.points[-1, 1] - hand) < 0.03
        count = EVERY * int(time * CONTROL_RATE / EVERY)
        assert len(line.points) == count
    assert line.visible
    trails.draw(replace(now, time=0.0))
    assert not line.visible


def test_a_replay_leaves_the_robots_trail_alone(lesson) -> None:
    """Where the line ends the robot's hand is, by the replay itself."""
    now, scene = lesson["replaying"], Scene()
    trails, line = Trails(scene, ROOTS), scene.nodes["/trails/alone"]
    film = DemonstrationFilm(now.compare.replayed)
    for time in (4.0, 1.0, 2.5):  # scrubbed to and fro
        trails.draw(replace(now, time=time))
        hand = hand_path(film.at(time).world.joint_positions[None], "left")[0]
        assert np.linalg.norm(line.points[-1, 1] - hand) < 0.03
        assert len(line.points) == EVERY * int(time * CONTROL_RATE / EVERY)
    assert line.visible
    assert line.thickness == BOLD
    assert line.colors == ROBOT
    assert set(scene.nodes) == {"/trails/alone", "/b/trails/alone"}
    assert not scene.nodes["/b/trails/alone"].visible


def test_a_replays_trail_ends_with_the_demonstration_and_goes_with_the_replay(lesson) -> None:
    now, scene = lesson["replaying"], Scene()
    trails, line = Trails(scene, ROOTS), scene.nodes["/trails/alone"]
    ends = []
    for time in (now.compare.timeline.motion, now.duration):  # the block falls meanwhile
        trails.draw(replace(now, time=time))
        ends.append(line.points)
    assert ends[0] is ends[1]
    trails.draw(lesson["trained"])
    assert not line.visible
    trails.draw(replace(now, time=now.duration))
    assert line.visible  # the same again, as far as before
    trails.draw(lesson["played"])
    assert line.points is not ends[1]
    assert "/trails/shown_left" in scene.nodes


@pytest.mark.parametrize("state", ["played", "replaying"])
def test_a_still_playhead_sends_nothing_and_another_one_ten_times_a_second(lesson, state) -> None:
    scene = Scene()
    trails, line = Trails(scene, ROOTS), scene.nodes["/trails/alone"]
    sent = []
    for tick in range(60):
        trails.draw(replace(lesson[state], time=2.0 + tick / CONTROL_RATE))
        sent.append(line.points)
    assert len({id(points) for points in sent}) <= 60 / EVERY + 1
    added = scene.added
    for _ in range(3):
        trails.draw(lesson[state])
    still = line.points
    trails.draw(lesson[state])
    assert line.points is still
    assert scene.added == added


def test_a_trail_grows_with_what_is_simulated(lesson) -> None:
    """While it is simulated each snapshot has a longer performance: a new object every tick."""
    now = lesson["played"]
    (alone,) = now.compare.playing
    whole = alone.performance
    scene = Scene()
    trails, line = Trails(scene, ROOTS), scene.nodes["/trails/alone"]
    for ticks in (20, 60, 100, len(whole.ticks)):
        part = replace(whole, ticks=whole.ticks[:ticks])
        playing = (Alone(alone.lesson, part),)
        trails.draw(replace(now, time=0.5, compare=replace(now.compare, playing=playing)))
        hand = hand_path(whole.measured_at(np.array([0.5])), "left")[0]
        assert np.linalg.norm(line.points[-1, 1] - hand) < 0.03


def test_bs_trail_is_drawn_where_b_stands_and_goes_with_it(lesson) -> None:
    scene = Scene()
    trails, now = Trails(scene, ROOTS), lesson["played"]
    two = replace(now.compare, playing=now.compare.playing * 2)
    trails.draw(replace(now, time=2.0, compare=two))
    a, b = (scene.nodes[f"{root}/alone"] for root in ROOTS)
    assert a.visible
    assert b.visible
    np.testing.assert_array_equal(a.points, b.points)
    assert a.colors != b.colors
    trails.draw(replace(now, compare=CompareStatus()))
    assert not a.visible
    assert not b.visible
    assert "/trails/shown_left" not in scene.nodes


def test_a_tube_is_closed_around_its_path_and_as_wide_as_told() -> None:
    path = np.column_stack([np.linspace(0.0, 1.0, 21), np.zeros(21), np.zeros(21)])
    radius = np.linspace(0.05, 0.1, 21)
    vertices, faces = tube(path, radius)
    assert faces.min() == 0
    assert faces.max() == len(vertices) - 1
    around = np.linalg.norm(vertices[:, 1:], axis=1)
    expected = np.interp(vertices[:, 0], path[:, 0], radius)
    np.testing.assert_allclose(around, expected)
    edges = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    uses = np.unique(edges, axis=0, return_counts=True)[1]
    assert set(uses) == {1, 2}  # once at both open ends only
    assert (uses == 1).sum() == 2 * 12


def test_a_hand_that_stands_still_gives_a_tube_too() -> None:
    vertices, _ = tube(np.zeros((9, 3)), np.zeros(9))
    assert np.isfinite(vertices).all()
    assert segments(np.zeros((4, 3))).shape == (3, 2, 3)
