"""Choosing a scene in a session: the world, the demonstrator, what is learned, what is listed."""

import numpy as np
import pytest

from studio.engine import commands
from studio.engine.choices import Choices
from studio.engine.hands import PLAIN, HandOptions
from studio.engine.resources import resource_root, samples_folder
from studio.engine.scene import Scene
from studio.engine.scene_file import read_scene, scene_names
from studio.engine.session import Session
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.teaching import LearnerSettings
from tests.engine.sessions import read


@pytest.fixture
def session(tmp_path):
    session = Session(tmp_path)
    yield session
    session.close()


def do(session: Session, *orders: commands.Command) -> Snapshot:
    for order in orders:
        session.post(order)
    return session.tick()


def until(session: Session, reached) -> Snapshot:
    for _ in range(1500):
        if reached(now := session.tick()):
            return now
    raise AssertionError(session.snapshot.message.text)


def taught(session: Session, name: str) -> Snapshot:
    do(session, commands.ChooseScene(name), commands.UseDemonstrator(), commands.Record())
    return until(session, lambda now: now.mode is Mode.IDLE)


@pytest.mark.parametrize("name", scene_names())
def test_the_world_is_the_chosen_scenes_with_the_arms_and_hands_that_it_takes(session, name):
    scene = read_scene(name)
    now = do(session, commands.ChooseScene(name))
    assert not now.message.is_error
    assert now.choices.scene == now.scene == scene
    assert now.choices.arms == ("both" if scene.both_arms else "left")
    assert now.choices.hands == HandOptions(scene.gripper, scene.wrist)
    assert len(now.world.block_poses) == len(scene.blocks)
    assert bool(len(now.world.fingers)) == scene.gripper
    places = [block.position for block in scene.blocks]
    np.testing.assert_allclose(now.world.block_poses[:, :3], places, atol=2e-3)
    back = do(session, commands.ChooseScene("push-down"))
    assert back.choices == Choices()


def test_a_scene_of_ones_own_is_chosen_by_its_path_and_a_missing_one_refused(session, tmp_path):
    path = tmp_path / "mine.toml"
    shipped = read_scene("push-into-zone")
    now = do(session, commands.ChooseScene(str(path)))
    assert now.message.is_error
    assert str(path) in now.message.text
    assert now.choices == Choices()
    now = do(session, commands.ChooseScene(shipped))
    assert now.choices.scene is shipped


def test_configure_keeps_the_scene_and_does_not_take_away_what_it_takes(session):
    do(session, commands.ChooseScene("push-into-zone"))
    now = do(session, commands.Configure(Choices("right")))
    assert (now.choices.arms, now.choices.scene.name) == ("right", "push-into-zone")
    (zone,) = now.scene.placed_zones
    assert zone.center[1] == -read_scene("push-into-zone").zones[0].center[1]
    do(session, commands.ChooseScene("both-arms"))
    now = do(session, commands.Configure(Choices("left")))
    assert "takes both arms" in now.message.text
    do(session, commands.ChooseScene("pick-and-place"))
    now = do(session, commands.Configure(Choices(hands=PLAIN)))
    assert "takes a gripper" in now.message.text


def test_the_demonstrator_does_the_chosen_scene_and_only_that_is_learned_from(session):
    before = taught(session, "push-down")
    assert [entry.done for entry in before.entries] == [True]
    trained = do(session, commands.Train(LearnerSettings("rbf", 30)))
    trained = until(session, lambda now: now.lesson is not None)
    assert trained.lesson.taught.scene == Scene()
    now = taught(session, "push-into-zone")
    assert now.lesson is None  # of another scene
    assert [entry.demonstration.scene.name for entry in now.entries] == [
        "push-down",
        "push-into-zone",
    ]
    assert now.entries[1].done
    assert not now.entries[1].flags
    do(session, commands.Train(LearnerSettings("rbf", 50)))
    learned = until(session, lambda now: now.lesson is not None)
    assert [each.name for each in learned.lesson.taught.demonstrations] == [now.entries[1].name]
    do(session, commands.PlayReproduction())
    played = until(session, lambda now: now.reproduction is not None)
    assert played.reproduction.performance.done
    assert "The task is done." in played.message.text
    assert played.compare.table[-1].done
    shown = do(session, commands.PlayDemonstration(before.entries[0].number))
    assert shown.scene == Scene()  # a film stands in its own scene
    assert len(shown.world.block_poses) == 3


def test_each_block_of_the_task_can_be_moved_and_all_are_put_back(session):
    do(session, commands.ChooseScene("two-in-order"))
    do(session, commands.PlaceBlock(0.70, 0.35, 0), commands.PlaceBlock(0.78, 0.08, 1))
    now = session.tick()
    np.testing.assert_allclose(
        now.world.block_poses[:, :2], [(0.70, 0.35), (0.78, 0.08)], atol=2e-3
    )
    assert now.compare.moved
    refused = do(session, commands.PlaceBlock(0.70, 0.35, 1))
    assert "Another block" in refused.message.text
    back = do(session, commands.PutBlockBack())
    places = [block.position[:2] for block in read_scene("two-in-order").blocks]
    np.testing.assert_allclose(back.world.block_poses[:, :2], places, atol=2e-3)
    assert not back.compare.moved


def test_a_chosen_demonstrator_shows_the_new_scene(session):
    do(session, commands.UseDemonstrator())
    now = do(session, commands.ChooseScene("two-in-order"))
    assert now.source.name == "demonstrator:2"
    assert now.source.seconds > 18.0  # two blocks take longer than one


def test_while_somebody_teaches_the_scene_stays(session):
    do(session, commands.UseDemonstrator(), commands.Watch())
    refused = do(session, commands.ChooseScene("two-in-order"))
    assert refused.message.is_error
    assert refused.choices.scene == Scene()


def test_a_file_of_the_same_name_is_another_scene(session, tmp_path):
    """A user's push-down.toml, on a smoother desk: nothing of the shipped one is learned for it."""
    path = tmp_path / "push-down.toml"
    shipped = (resource_root() / "urdf" / "scenes" / path.name).read_text()
    path.write_text(shipped.replace("friction = 0.8", "friction = 0.7"))
    (sample, *_) = sorted(samples_folder().glob("*.mcap"))
    read(session, commands.UseFile(sample))
    now = do(session, commands.ChooseScene(str(path)))
    (entry,) = now.entries
    assert (now.choices.scene.name, now.choices.scene.desk.friction) == ("push-down", 0.7)
    assert entry.is_of("left", "exact")
    assert not entry.is_of("left", "exact", now.choices.scene)
    refused = do(session, commands.Train(LearnerSettings("rbf", 12)))
    assert refused.message.text.startswith(
        "No demonstration by left arm with the exact mapping in the scene push-down (another one)"
    )
    back = do(session, commands.ChooseScene("push-down"), commands.Train(LearnerSettings("rbf", 9)))
    assert not back.message.is_error
