from pathlib import Path

import numpy as np
import pytest

from studio.engine.clearance import Clearance
from studio.engine.follow import follow
from studio.engine.guard import SOFTNESS, Guard, Guarded
from studio.engine.limits import Command
from studio.engine.performance import perform, rows_as_trajectory
from studio.engine.pipeline import Pipeline, ready_pose
from studio.engine.robot import CONTROL_PERIOD, load_robot
from studio.engine.scene import Scene
from studio.engine.skeleton import FloatArray
from studio.engine.sources import read_skeletons

KINECT = Path(__file__).resolve().parents[2].parent / "shared" / "data" / "kinect"

ROBOT = load_robot()
REST = np.zeros(15)
REST[7:11] = (-0.35, 1.0, 0.0, 0.5)  # the right arm hangs beside the desk
LEFT = [f"left_{joint}" for joint in ("s0", "s1", "e0", "e1")]
RIGHT = [name.replace("left", "right") for name in LEFT]
GUARD = Guard.of(ROBOT, Scene(), REST, LEFT)
BOTH = Guard.of(ROBOT, Scene(arms="both"), REST, LEFT + RIGHT)
OVER_THE_DESK = np.array([-0.5, 0.0, 0.0, 0.4])
DOWN = np.array([0.0, 1.0, 0.0, 0.0])  # by s1, one radian
STEP = 0.05  # [rad] the way of one tick at 1.5 rad/s


def distances(guard: Guard, driven: FloatArray) -> FloatArray:
    body = guard.rest.copy()
    body[guard.columns] = driven
    clearance = guard.clearance
    return clearance.distances(clearance.lines(body), clearance.pairs)


def go(guard: Guard, start: FloatArray, goal: FloatArray, ticks: int = 200) -> list[Guarded]:
    """Send a robot towards a goal, at 1.5 rad/s where the guard lets it."""
    found, sent = [], start
    for _ in range(ticks):
        command = sent + np.clip(goal - sent, -STEP, STEP)
        found.append(guard.step(sent, command, CONTROL_PERIOD))
        sent = found[-1].sent
    return found


def random_pose(guard: Guard, random: np.random.Generator) -> FloatArray:
    names = [ROBOT.joint_names[column] for column in guard.columns]
    limits = ROBOT.limits_of(names)
    return random.uniform(limits.lower, limits.upper)


def test_far_from_everything_a_command_passes_as_it_is() -> None:
    command = OVER_THE_DESK - 0.03
    guarded = GUARD.step(OVER_THE_DESK, command, CONTROL_PERIOD)
    assert guarded.sent is command
    assert guarded.reason == ""
    assert guarded.pair is None


def test_an_arm_that_is_sent_into_the_desk_slows_and_stops_at_the_margin_and_says_so() -> None:
    ticks = go(GUARD, OVER_THE_DESK, OVER_THE_DESK + DOWN)
    told = [each.reason for each in ticks if each.reason]
    assert told[0].endswith("cm from the desk: slowed")
    assert told[-1] in (
        "left hand is 2 cm from the desk: stopped",
        "left wrist is 2 cm from the desk: stopped",
    )
    assert ticks[-1].pair is not None
    assert ticks[-1].pair[1] == "desk"
    assert 0.02 - 1e-9 < ticks[-1].distance < 0.0205
    apart = [each.distance for each in ticks if each.reason]
    steps = -np.diff(apart)
    assert (steps >= -1e-9).all()
    assert (steps <= (np.array(apart[:-1]) - 0.02) * CONTROL_PERIOD / SOFTNESS + 1e-6).all()


def test_what_leads_away_is_sent_at_once() -> None:
    stopped = go(GUARD, OVER_THE_DESK, OVER_THE_DESK + DOWN)[-1].sent
    up = stopped - STEP * DOWN
    guarded = GUARD.step(stopped, up, CONTROL_PERIOD)
    assert guarded.sent is up
    assert guarded.reason == ""


def test_an_arm_slides_along_the_desk() -> None:
    """Where s1 may go no further down, s0 goes on, sideways."""
    start = go(GUARD, OVER_THE_DESK, OVER_THE_DESK + DOWN)[-1].sent
    ticks = go(GUARD, start, start + np.array([0.3, 0.5, 0.0, 0.0]), 10)
    np.testing.assert_allclose(ticks[-1].sent[0], start[0] + 0.3)
    assert ticks[-1].sent[1] < start[1] + 0.1
    assert "the desk" in ticks[-1].reason


def test_two_hands_do_not_meet() -> None:
    apart = np.array([-0.5, -0.3, 0.0, 1.2, 0.5, -0.3, 0.0, 1.2])
    inward = np.array([-1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    assert distances(BOTH, apart).min() > 0.02
    last = go(BOTH, apart, apart + inward)[-1]
    assert last.pair is not None
    assert {name.split()[0] for name in last.pair} == {"left", "right"}
    assert last.reason.endswith("stopped")
    assert distances(BOTH, last.sent).min() >= 0.01


@pytest.mark.parametrize("guard", [GUARD, BOTH], ids=["one arm", "both"])
def test_no_command_brings_any_pair_nearer_than_its_margin(guard: Guard) -> None:
    """From anywhere, even from where things overlap, towards anywhere."""
    random = np.random.default_rng(0)
    stop = guard.clearance.pairs.stop
    bitten = 0
    for _ in range(60):
        before = random_pose(guard, random)
        command = before + random.uniform(-STEP, STEP, len(before))
        guarded = guard.step(before, command, CONTROL_PERIOD)
        was, now = distances(guard, before), distances(guard, guarded.sent)
        assert (now >= np.minimum(was, stop) - 1e-8).all()
        low, high = np.minimum(before, command), np.maximum(before, command)
        assert ((low - 1e-12 <= guarded.sent) & (guarded.sent <= high + 1e-12)).all()
        bitten += bool(guarded.reason)
        assert bool(guarded.reason) == (guarded.pair is not None)
    assert bitten > 5


@pytest.mark.parametrize("guard", [GUARD, BOTH], ids=["one arm", "both"])
def test_looking_at_near_pairs_only_changes_no_bit(
    guard: Guard, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two roads: the pairs that the broad phase leaves, and all of them."""
    random = np.random.default_rng(3)
    steps = []
    for _ in range(150):
        before = random_pose(guard, random)
        steps.append((before, before + random.uniform(-STEP, STEP, len(before))))
    near = [guard.step(*step, CONTROL_PERIOD) for step in steps]
    every = np.arange(len(guard.clearance.pairs))
    monkeypatch.setattr(Clearance, "within", lambda *_: every)
    monkeypatch.setattr(Clearance, "may_travel", lambda *_: np.full(len(every), np.inf))
    whole = [guard.step(*step, CONTROL_PERIOD) for step in steps]
    for one, other in zip(near, whole, strict=True):
        np.testing.assert_array_equal(one.sent, other.sent)
        assert (one.reason, one.pair, one.stopped) == (other.reason, other.pair, other.stopped)
        assert one.distance == other.distance
    assert sum(bool(each.reason) for each in near) > 20


def test_a_command_that_brings_nothing_nearer_is_never_held() -> None:
    """The guard never traps, wherever the arm has got to."""
    random = np.random.default_rng(1)
    tried = 0
    for _ in range(400):
        before = random_pose(GUARD, random)
        command = before + random.uniform(-STEP, STEP, 4)
        now = distances(GUARD, command)
        near = now < GUARD.clearance.pairs.slow
        if (now >= distances(GUARD, before))[near].all():
            tried += bool(near.any())
            assert GUARD.step(before, command, CONTROL_PERIOD).sent is command
    assert tried > 0


def test_a_whole_way_through_random_poses_stays_clear() -> None:
    random = np.random.default_rng(2)
    sent = OVER_THE_DESK
    for _ in range(8):
        ticks = go(GUARD, sent, random_pose(GUARD, random), 40)
        for each in ticks:
            assert (distances(GUARD, each.sent) >= GUARD.clearance.pairs.stop - 1e-6).all()
        sent = ticks[-1].sent


def test_standing_still_is_nothing_to_speak_of() -> None:
    stopped = go(GUARD, OVER_THE_DESK, OVER_THE_DESK + DOWN)[-1].sent
    assert GUARD.step(stopped, stopped, CONTROL_PERIOD).reason == ""


def test_the_same_steps_give_the_same_bits() -> None:
    goal = OVER_THE_DESK + np.array([0.4, 1.0, 0.5, -0.3])
    one, other = (go(GUARD, OVER_THE_DESK, goal, 60) for _ in range(2))
    for a, b in zip(one, other, strict=True):
        np.testing.assert_array_equal(a.sent, b.sent)
        assert (a.reason, a.distance) == (b.reason, b.distance)


def test_a_command_keeps_what_the_limits_said_of_it() -> None:
    stopped = go(GUARD, OVER_THE_DESK, OVER_THE_DESK + DOWN)[-1].sent
    bit = np.array([False, True, False, False])
    down = Command(stopped + STEP * DOWN, bit, ~bit)
    kept = GUARD.keep(stopped, down, CONTROL_PERIOD)
    np.testing.assert_allclose(kept.sent, stopped, atol=1e-6)
    assert kept.position_limited is bit
    assert kept.stopped
    assert kept.guarded.endswith("the desk: stopped")
    up = Command(stopped - STEP * DOWN, bit, bit)
    assert GUARD.keep(stopped, up, CONTROL_PERIOD) is up


def test_playback_cannot_bypass_it() -> None:
    """A motion through the desk, played as a reproduction is: the measured arm stays clear."""
    ready = ready_pose("left", "exact")
    low = ready + np.array([0.3, 1.2, 0.0, -0.5])
    played = perform(rows_as_trajectory(np.array([ready, low, ready]), 3.0), 3.0, "left", "exact")
    told = {tick.command.guarded for tick in played.ticks} - {""}
    assert any("the desk" in words for words in told)
    guard = Guard.for_robot(ROBOT, "left")
    measured = np.array([tick.world.joint_positions[guard.columns] for tick in played.ticks])
    assert min(distances(guard, each).min() for each in measured) > 0.005
    sent = np.array([tick.command.sent for tick in played.ticks])
    assert np.abs(sent - measured)[-1].max() < 0.02  # at rest, and where it was sent
    np.testing.assert_allclose(sent[-1], ready, atol=1e-6)  # it got away again


def test_arms_that_hang_do_not_push_into_the_desk() -> None:
    path = KINECT / "kinect2-socket" / "hands_gestures.json.gz"
    if not path.is_file():
        pytest.skip(f"no {path}")
    pipeline = Pipeline.for_robot(ROBOT, "left", "exact", "open")
    recording = follow(read_skeletons(path), pipeline)
    guard = pipeline.guard
    sent = np.array([sample.sent for sample in recording.samples])
    measured = np.array([s.world.joint_positions[guard.columns] for s in recording.samples])
    assert any("the desk" in sample.guarded for sample in recording.samples)
    assert min(distances(guard, each).min() for each in measured) > 0.0
    assert np.abs(sent - measured).mean() < 0.02  # it was 0.1 and more
    rests = [sample for sample in recording.samples if "rests beside" in sample.guarded]
    assert rests
    assert not any("torso" in sample.held for sample in rests)  # to hang is no hold
