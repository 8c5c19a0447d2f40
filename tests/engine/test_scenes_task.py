"""Each scene that ships, done in the world: by the demonstrator, and by Baxter alone."""

from dataclasses import replace
from functools import cache

import pytest

from studio.engine.demonstration import DemonstrationSet, demonstrations_of
from studio.engine.errors import StudioError
from studio.engine.experiment import Setup, teach
from studio.engine.follow import follow
from studio.engine.hands import HandOptions
from studio.engine.mcap_file import read_recording, write_recording
from studio.engine.pipeline import Pipeline
from studio.engine.recording import Recording
from studio.engine.resources import samples_folder
from studio.engine.robot import load_robot
from studio.engine.scene import Scene
from studio.engine.scene_file import read_scene, scene_names
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.success import Success
from studio.engine.teaching import LearnerSettings, learn, reproduce


def shown(scene: Scene, seed: int, take: int = 1) -> Recording:
    hands = HandOptions(scene.gripper, scene.wrist)
    pipeline = Pipeline.for_robot(load_robot(), scene.arms, hands=hands, scene=scene)
    return follow(demonstrate(seed, take, scene=scene), pipeline, scene)


(SAMPLE, *_) = sorted(samples_folder().glob("*.mcap"))


@cache
def recorded(name: str) -> Recording:
    return shown(read_scene(name), seed=1)


@pytest.mark.parametrize("name", scene_names())
def test_the_demonstrator_does_it_and_so_does_baxter_alone(name: str) -> None:
    recording = recorded(name)
    assert not recording.samples[0].world.done
    assert recording.samples[0].world.missing
    last = recording.samples[-1].world
    assert (last.done, last.missing) == (True, "")
    taught = DemonstrationSet.of(demonstrations_of(recording, name))
    assert taught.scene == read_scene(name)
    alone = reproduce(learn(taught, LearnerSettings())).performance
    assert (alone.done, alone.missing) == (True, "")


@pytest.mark.parametrize("name", scene_names())
def test_a_recording_keeps_its_scene_and_what_came_of_it(name: str, tmp_path) -> None:
    whole = recorded(name)
    first = next(i for i, sample in enumerate(whole.samples) if sample.world.done)
    samples = whole.samples[first - 20 : first + 20]
    write_recording(tmp_path / "one.mcap", replace(whole, samples=samples))
    read = read_recording(tmp_path / "one.mcap")
    assert read.info.scene == read_scene(name)
    for mine, theirs in zip(samples, read.samples, strict=True):
        assert (mine.world.done, mine.world.missing) == (theirs.world.done, theirs.world.missing)


def test_the_wrong_order_is_not_the_task() -> None:
    scene = read_scene("two-in-order")
    first, second = scene.success.conditions
    turned = replace(scene, success=Success((second, first), in_order=True))
    usual = recorded("two-in-order").samples[-1].world
    assert usual.done
    # The same motion where the far block is asked for first; strokes do not depend on the order.
    hands = Pipeline.for_robot(load_robot(), "left", scene=turned)
    other = follow(demonstrate(1, 1, scene=scene), hands, turned)
    last = other.samples[-1].world
    assert (last.block_poses == usual.block_poses).all()
    assert not last.done
    assert last.missing.startswith("too early: push the near block down only after that")


def test_a_recording_of_another_scene_is_followed_anew_also_where_both_have_one_name() -> None:
    usual = Scene()
    other = replace(usual, desk=replace(usual.desk, friction=0.5))
    as_it_is, anew = teach([SAMPLE], Setup()), teach([SAMPLE], Setup(scene=other))
    assert "anew" not in as_it_is.files[0].format
    assert "followed anew" in anew.files[0].format
    assert [found.demonstrations[0].scene for found in (as_it_is, anew)] == [usual, other]
    with pytest.raises(StudioError, match=r"push-down, .* in push-down \(another one\): learn"):
        DemonstrationSet.of([*as_it_is.demonstrations, *anew.demonstrations])
    named = replace(as_it_is.demonstrations[0], scene=read_scene("two-in-order"))
    with pytest.raises(StudioError, match=r"two-in-order, .* in push-down: learn from one scene"):
        DemonstrationSet.of([*as_it_is.demonstrations, named])
    right = teach([SAMPLE], Setup(scene=usual.taught_by("right")))
    assert "anew" not in right.files[0].format  # it is told for the left arm in any case


def test_a_setup_takes_arms_and_hands_from_its_scene() -> None:
    assert Setup().in_scene(read_scene("both-arms")).arms == "both"
    assert Setup("right").in_scene(read_scene("push-into-zone")).arms == "right"
    hands = Setup().in_scene(read_scene("pick-and-place")).hands
    assert hands == HandOptions(gripper=True, wrist="level")
