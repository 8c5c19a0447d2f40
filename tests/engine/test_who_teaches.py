"""Whoever was chosen last teaches; without anybody the cure is said."""

import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from studio.engine import commands
from studio.engine.activity import Hold
from studio.engine.choices import Choices
from studio.engine.errors import FileError, StudioError
from studio.engine.live.source import LiveSource
from studio.engine.skeleton import SIDES, HandState, Joint
from studio.engine.sources import write_skeletons
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.sources.family import Frame
from studio.engine.sources.recording import from_skeletons
from studio.engine.who_teaches import NamedRecording, WhoTeaches
from tests.engine.people import person, stand
from tests.engine.sessions import PATIENCE

SAMPLES = Path(__file__).resolve().parents[2] / "recordings" / "samples"


@pytest.fixture(scope="module")
def holding() -> Iterator[Hold]:
    held = Hold(Choices().start_world())
    yield held
    held.world.close()


@pytest.fixture
def who() -> Iterator[WhoTeaches]:
    made = WhoTeaches(0, None)
    yield made
    made.close()


def came_of_it(who: WhoTeaches, holding: Hold) -> str | NamedRecording:
    """Tick until a file has been read."""
    end = time.monotonic() + PATIENCE
    while not (found := who.tick(holding)):
        assert time.monotonic() < end, "still reading"
        time.sleep(0.01)
    return found


def test_nobody_is_chosen_at_first() -> None:
    who = WhoTeaches(0, None)
    assert (who.chosen, who.status(), who.live(None)) == (None, None, None)
    with pytest.raises(StudioError, match="Choose a source first"):
        who.required()


def test_the_demonstrator_shows_another_take_each_time() -> None:
    who = WhoTeaches(3, None)
    for take in (1, 2):
        assert who.use_demonstrator().startswith(f"Source: demonstrator:{take}")
        expected = demonstrate(3, take)
        assert who.required().skeleton.positions.tobytes() == expected[0].positions.tobytes()


def test_a_file_is_known_by_the_users_name_and_says_if_it_has_no_signs(
    who, holding, tmp_path: Path
) -> None:
    path = tmp_path / "x81231"
    write_skeletons(path, from_skeletons(stand(), "made up", "test"))
    assert who.take(commands.UseFile(path, "my take.json")) == "Reading my take.json."
    who.tick(holding)
    assert who.shown(holding).reading.name == "my take.json"
    words = came_of_it(who, holding)
    assert who.shown(holding).reading is None
    assert words == "Source: my take.json, 60 frames: it tells no hand states, so open the gate"
    assert who.status().name == "my take.json"


def test_whom_to_follow_is_chosen_in_a_live_stream_too(holding: Hold) -> None:
    live = LiveSource(lambda: 0.0)
    who = WhoTeaches(0, live)
    with pytest.raises(StudioError, match="Take a file or a live stream first"):
        who.take(commands.FollowBody("9"))
    live.drive("publisher 1", "studio jsonl")
    live.put(Frame(0.0, (person(body_id="7"), person(body_id="9"))), 0.0, True)
    who.take(commands.UseLive())
    shown = who.shown(holding)
    assert (shown.bodies, shown.body) == ((("7", None), ("9", None)), "7")
    who.take(commands.FollowBody("9"))
    assert who.shown(holding).body == "9"
    with pytest.raises(StudioError, match="Body 12 is not in sight"):
        who.take(commands.FollowBody("12"))


def test_live_streams_can_be_chosen_where_there_are_any() -> None:
    with pytest.raises(StudioError, match="listener"):
        WhoTeaches(0, None).use_live()
    who = WhoTeaches(0, LiveSource(lambda: 0.0))
    assert "Nobody sends yet" in who.use_live()
    assert who.status().is_live
    assert who.live(who.chosen) is not None


def two_people(path: Path) -> None:
    """Write a file in which the second body comes nearer than the first."""
    near = [replace(each, body_id="near") for each in stand()]
    step = np.array([0.0, 0.0, 1.0])
    far = [replace(each, body_id="far", positions=each.positions + step) for each in stand()]
    write_skeletons(path, [each for pair in zip(near, far, strict=True) for each in pair])


def test_of_several_bodies_the_nearest_is_followed_until_another_is_chosen(
    who, holding, tmp_path: Path
) -> None:
    path = tmp_path / "two.jsonl"
    two_people(path)
    who.take(commands.UseFile(path))
    assert "of 2 bodies in it the nearest is followed" in came_of_it(who, holding)
    assert who.chosen.skeleton.body_id == "near"
    shown = who.shown(holding)
    assert (shown.bodies, shown.body) == ((("near", 60), ("far", 60)), None)

    who.take(commands.FollowBody("far"))
    came_of_it(who, holding)
    assert (who.chosen.skeleton.body_id, who.shown(holding).body) == ("far", "far")
    who.take(commands.FollowBody(None))
    came_of_it(who, holding)
    assert who.chosen.skeleton.body_id == "near"

    who.take(commands.FollowBody("nobody"))
    with pytest.raises(FileError, match="seen: far, near"):
        came_of_it(who, holding)
    assert who.chosen.skeleton.body_id == "near"
    who.use_demonstrator()
    assert who.shown(holding).bodies == ()
    with pytest.raises(StudioError, match="Take a file or a live stream first"):
        who.take(commands.FollowBody("near"))


def test_a_recording_is_handed_on_whole(who, holding) -> None:
    path = SAMPLES / "demonstration-1.mcap"
    who.take(commands.UseFile(path))
    found = came_of_it(who, holding)
    assert isinstance(found, NamedRecording)
    assert (found.name, who.chosen) == ("demonstration-1.mcap", None)


def test_what_is_chosen_later_is_not_replaced_by_a_file_that_takes_long(
    who, holding, tmp_path: Path
) -> None:
    path = tmp_path / "long.jsonl"
    two_people(path)
    who.take(commands.UseFile(path))
    who.take(commands.UseDemonstrator())
    assert "something else was chosen meanwhile" in came_of_it(who, holding)
    assert who.status().name.startswith("demonstrator")


def test_reading_can_be_given_up(who, holding, tmp_path: Path) -> None:
    path = tmp_path / "two.jsonl"
    two_people(path)
    who.take(commands.UseFile(path))
    who.take(commands.UseFile(path))
    who.tick(holding)
    assert who.shown(holding).reading.waiting == 1
    assert who.take(commands.CancelReading()) == "Gave up reading two.jsonl."
    assert who.shown(holding).reading is None
    assert who.tick(holding) == ""
    assert who.take(commands.CancelReading()) == ""


def test_the_puppet_obeys_while_nobody_is_watched(who, holding) -> None:
    drag = commands.DragHand("left", (-0.3, 0.3, 1.9))
    with pytest.raises(StudioError, match="Take the puppet first"):
        who.take(drag)
    assert who.shown(holding).puppet is None
    assert "puppet" in who.take(commands.UsePuppet())
    start = who.chosen.skeleton
    who.take(drag)
    who.take(commands.Sign("left", HandState.LASSO))
    for _ in range(90):
        who.tick(holding)
    now, shown = who.chosen.skeleton, who.shown(holding).puppet
    moved = np.linalg.norm(now.positions - start.positions, axis=1)
    assert moved[Joint.HAND_LEFT] > 0.1 > moved[Joint.HAND_RIGHT]
    assert now.positions[Joint.HAND_LEFT] == pytest.approx(shown.goals[Joint.HAND_LEFT], abs=1e-3)
    assert [shown.sign(side) for side in SIDES] == [HandState.LASSO, HandState.UNKNOWN]

    elbow = now.positions[Joint.ELBOW_LEFT]
    who.take(commands.DragElbow("left", (elbow[0], elbow[1] - 1.0, elbow[2])))
    for _ in range(90):
        who.tick(holding)
    assert who.chosen.skeleton.positions[Joint.ELBOW_LEFT, 1] < elbow[1] - 0.05
    who.take(commands.ReleaseElbow("left"))
    for _ in range(90):
        who.tick(holding)
    assert who.chosen.skeleton.positions[Joint.ELBOW_LEFT] == pytest.approx(elbow, abs=1e-3)
    who.take(commands.PuppetHome())
    for _ in range(120):
        who.tick(holding)
    assert who.chosen.skeleton.positions == pytest.approx(start.positions, abs=1e-3)
    assert who.shown(holding).puppet.sign("left") is HandState.UNKNOWN
