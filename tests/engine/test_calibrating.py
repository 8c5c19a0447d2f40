"""Two still seconds calibrate, whenever they come; until then it says what is missing."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.calibrating import INVITATION, PATIENCE, Calibrating
from studio.engine.calibration import calibrate
from studio.engine.choices import Choices
from studio.engine.skeleton import Skeleton
from studio.engine.sources.recording import from_skeletons
from studio.engine.teachers import FileTeacher
from studio.engine.world import World
from tests.engine.people import hanging, person


@pytest.fixture(scope="module")
def world() -> Iterator[World]:
    with Choices().start_world() as made:
        yield made


def watched(world: World, people: Sequence[Skeleton]) -> Calibrating:
    made = Calibrating(FileTeacher(from_skeletons(people, "a person", "test")), world)
    while made.step():
        assert 0.0 <= made.progress.share <= 1.0
    return made


def standing(seconds: float, rate: float = 30.0, since: float = 0.0) -> list[Skeleton]:
    return [hanging(since + i / rate, 0.1) for i in range(round(seconds * rate))]


def walking(seconds: float) -> list[Skeleton]:
    """Arms that swing widely."""
    return [hanging(i / 30, 0.1, swing=math.sin(i / 5)) for i in range(round(seconds * 30))]


@settings(deadline=None, derandomize=True, max_examples=8)
@given(before=st.floats(0.0, 8.0))
def test_whoever_walks_to_the_sensor_first_is_waited_for(world: World, before: float) -> None:
    moving = walking(before)
    made = watched(world, [*moving, *standing(4.0, since=len(moving) / 30)])
    assert made.found is not None
    assert made.found.lean == pytest.approx(0.1, abs=1e-6)
    assert made.time == pytest.approx(before + 2.0, abs=0.5)


def test_it_takes_two_seconds_and_gives_what_they_give(world: World) -> None:
    people = standing(5.0)
    made = watched(world, people)
    assert made.time == pytest.approx(2.0, abs=0.1)
    assert made.found == calibrate(people[:61])


@pytest.mark.parametrize("rate", [60.0, 15.0, 12.5, 10.0, 5.0, 4.0])
def test_a_slow_sensor_takes_as_long(world: World, rate: float) -> None:
    made = watched(world, standing(6.0, rate))
    assert made.found is not None
    assert made.time == pytest.approx(2.0, abs=0.3)


def test_the_robot_holds_still(world: World) -> None:
    for _ in range(30):
        world.step()
    before = world.state.joint_positions
    watched(world, standing(3.0))
    assert np.abs(world.state.joint_positions - before).max() < 0.01


def test_a_pose_that_flickers_goes_on_and_one_that_is_left_begins_anew(world: World) -> None:
    people = standing(2.5)
    raised = person(0.0, ((1.0, 0.0, 0.0), (1.0, 0.0, 0.0)))

    def interrupted(frames: int) -> list[Skeleton]:
        changed = list(people)
        for i in range(30, 30 + frames):
            changed[i] = replace(raised, time=people[i].time)
        return changed

    assert watched(world, interrupted(3)).found is not None
    assert watched(world, interrupted(15)).found is None


def test_two_people_do_not_make_one_pose(world: World) -> None:
    people = standing(3.0)
    other = [replace(each, body_id="other") for each in people[45:]]
    made = Calibrating(FileTeacher(from_skeletons(people, "a person", "test")), world)
    made._frames = iter([*people[:45], *other])
    while made.step():
        pass
    assert made.found is None


@pytest.mark.parametrize(
    ("people", "words"),
    [
        ([], "nobody is seen"),
        ([person(i / 30) for i in range(90)], "the left arm does not hang"),
        (walking(4.0), "does not hang"),
        ([hanging(i / 30, swing=0.3 * math.sin(i / 5)) for i in range(90)], "you moved"),
        ([hanging(i / 30, lean=0.5) for i in range(90)], "25°"),
    ],
)
def test_every_refusal_says_what_to_do(world: World, people: list[Skeleton], words: str) -> None:
    made = watched(world, people)
    assert made.found is None
    assert made.refusal.startswith(("calibration: ", "a calibration's"))
    assert words in made.refusal


def test_patience_ends(world: World) -> None:
    made = watched(world, [person(i / 30) for i in range(1200)])
    assert made.time == pytest.approx(PATIENCE, abs=0.1)
    assert made.progress.words == INVITATION
