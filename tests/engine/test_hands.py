from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from studio.engine.demonstration import DemonstrationSet, demonstrations_of
from studio.engine.export.material import Take
from studio.engine.films import LessonFilm, Solo
from studio.engine.fingers import CLOSED, OPEN
from studio.engine.follow import follow
from studio.engine.gripper import GripMemory
from studio.engine.hands import PLAIN, STILL, WRIST_SPEED, HandCommand, HandOptions, HandTrack
from studio.engine.mcap_file import read_recording, write_recording
from studio.engine.moment import demonstration_at
from studio.engine.performance import perform
from studio.engine.pipeline import Pipeline
from studio.engine.recording import Recording
from studio.engine.robot import CONTROL_PERIOD, load_robot
from studio.engine.scene import Scene
from studio.engine.signs import HandMemory
from studio.engine.skeleton import Hand, HandState, Joint, Skeleton, Tracking
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.sources.recording import SkeletonRecording, from_skeletons
from studio.engine.teaching import LearnerSettings, learn
from tests.engine.people import person

ROBOT = load_robot()
BOTH_OPTIONS = HandOptions(gripper=True, wrist="level")
FOLLOWING = HandOptions(wrist="follow")
RAISED = ((0.8, 0.5, 0.3), (0.7, 0.2, -0.7))
LOWERED = ((0.4, 0.9, 0.1), (0.9, 0.1, 0.6))


def pointing_person(time: float, up: bool, arm=RAISED) -> Skeleton:
    """Return somebody whose left hand points up or down, and forward."""
    seen = person(time, arm)
    positions = seen.positions.copy()
    way = [0.0, 0.12 if up else -0.12, -0.12]
    positions[Joint.HAND_TIP_LEFT] = positions[Joint.WRIST_LEFT] + way
    return replace(seen, positions=positions)


def gripping(closed_from: float, closed_until: float) -> SkeletonRecording:
    """Return a demonstrator who closes the right hand for a while, and points it up as well."""
    people = []
    for seen in demonstrate(0, 1):
        sign = HandState.CLOSED if closed_from <= seen.time < closed_until else HandState.OPEN
        positions = seen.positions.copy()
        positions[Joint.HAND_TIP_LEFT] = positions[Joint.WRIST_LEFT] + [0.0, 0.12, -0.12]
        people.append(replace(seen, right_hand=Hand(sign), positions=positions))
    return from_skeletons(people, path="made up", format="test")


@pytest.fixture(scope="module")
def recording() -> Recording:
    pipeline = Pipeline.for_robot(ROBOT, "left", hands=BOTH_OPTIONS)
    return follow(gripping(7.0, 9.0), pipeline)


def test_plain_hands_do_nothing() -> None:
    pipeline = Pipeline.for_robot(ROBOT, "left", hands=PLAIN)
    assert pipeline.hands.command(pipeline.start().hands) == STILL
    assert len(pipeline.limits.lower) == 4
    assert PLAIN.wrist_joints("both") == ()


def test_wrists_keep_to_their_limits_and_to_a_calm_speed(recording: Recording) -> None:
    wrist = np.array([sample.hands.wrist for sample in recording.samples])
    limits = ROBOT.limits_of([f"left_{joint}" for joint in ("w0", "w1", "w2")])
    assert ((wrist >= limits.lower) & (wrist <= limits.upper)).all()
    speeds = np.abs(np.diff(wrist, axis=0)) / CONTROL_PERIOD
    assert 0.1 < speeds.max() <= WRIST_SPEED + 1e-9


def test_a_level_hand_is_measured_level(recording: Recording) -> None:
    armed = [sample for sample in recording.samples if sample.gate.armed]
    later = np.array([sample.world.joint_positions for sample in armed[60:]])
    pointing = ROBOT.forward_kinematics("left_hand", later)[:, 2, 2]  # how steep its z axis is
    assert np.degrees(np.abs(pointing)).mean() < 6.0
    opening = ROBOT.forward_kinematics("left_hand", later)[:, 2, 1]  # how steep its fingers open
    assert np.percentile(np.degrees(np.arcsin(np.abs(pointing))), 95) < 6.0
    assert np.percentile(np.degrees(np.arcsin(np.abs(opening))), 95) < 6.0
    plain = later.copy()
    plain[:, 4:7] = 0.0
    assert np.degrees(np.abs(ROBOT.forward_kinematics("left_hand", plain)[:, 2, 2])).mean() > 20.0


def test_a_following_hand_points_where_the_persons_does() -> None:
    pipeline = Pipeline.for_robot(ROBOT, "left", hands=HandOptions(wrist="follow"))
    off = []
    for sample in follow(gripping(0.0, 0.0), pipeline).samples:
        seen = sample.skeleton and pipeline.stages[0].pointing(sample.skeleton)
        if seen and sample.gate.armed:
            body = np.array([*sample.sent, *sample.hands.wrist, *np.zeros(8)])
            pointing = ROBOT.forward_kinematics("left_hand", body)[:3, 2]
            assert seen[2] > 0.5  # up, as the tip was put
            off.append(np.degrees(np.arccos(pointing @ seen)))
    assert off[0] > 20.0
    assert np.median(off[60:]) < 5.0


@pytest.mark.parametrize("mode", ["level", "follow"])
def test_wrists_come_as_softly_as_arms(mode) -> None:
    """After arming, and after somebody else has come."""
    pipeline = Pipeline.for_robot(ROBOT, "left", gate_mode="open", hands=HandOptions(wrist=mode))
    memory, sent = pipeline.start(), [(0.0, 0.0, 0.0)]
    for k in range(300):
        seen = pointing_person(k / 30, k < 150, RAISED if k < 150 else LOWERED)
        seen = replace(seen, body_id="1" if k >= 150 else "0")
        memory, _ = pipeline.advance(memory, seen, k / 30)
        sent.append(memory.hands.wrist)
        engaged = memory.hands.wrists[0].engaged
        if k in (149, 299):
            assert engaged is not None
            assert engaged.released
    speeds = np.abs(np.diff(sent, axis=0)).max(axis=1) * 30
    for began in (0, 151):
        assert 0.1 < speeds[began : began + 29].max() <= 0.3 * (1 + 1e-9)


def test_a_hand_that_was_long_unseen_is_followed_softly_anew() -> None:
    pipeline = Pipeline.for_robot(ROBOT, "left", gate_mode="open", hands=FOLLOWING)
    memory, sent = pipeline.start(), []
    for k in range(240):
        seen = pointing_person(k / 30, up=k < 150)
        if 150 <= k < 180:
            tracking = seen.tracking.copy()
            tracking[Joint.HAND_TIP_LEFT] = Tracking.NOT_TRACKED
            seen = replace(seen, tracking=tracking)
        memory, _ = pipeline.advance(memory, seen, k / 30)
        sent.append(memory.hands.wrist)
    speeds = np.abs(np.diff(sent, axis=0)).max(axis=1) * 30
    assert 0.1 < speeds[179:208].max() <= 0.3 * (1 + 1e-9)


def test_somebody_elses_hand_is_not_smoothed_into_the_last_ones() -> None:
    pipeline = Pipeline.for_robot(ROBOT, "left", gate_mode="open", hands=FOLLOWING)
    memory = pipeline.start()
    for k in range(60):
        memory, _ = pipeline.advance(memory, pointing_person(k / 30, up=True), k / 30)
    other = replace(pointing_person(2.0, up=False), body_id="1")
    memory, _ = pipeline.advance(memory, other, 2.0)
    smoothed = memory.hands.wrists[0].pointing
    assert smoothed is not None
    assert smoothed.direction == pipeline.stages[0].pointing(other)
    grip = GripMemory(HandMemory(sign=HandState.CLOSED, held=10**8), closed=True)
    kept = pipeline.hands.of_another(replace(memory.hands, grip=grip))
    assert kept.wrist == memory.hands.wrist
    assert kept.grip == GripMemory(closed=True)


def test_a_repeated_picture_is_no_news_of_the_hand() -> None:
    pipeline = Pipeline.for_robot(ROBOT, "left", gate_mode="open", hands=FOLLOWING)
    memory = pipeline.start()
    seen = pointing_person(0.0, up=True)
    memory, _ = pipeline.advance(memory, seen, 0.0)
    before = memory.hands.wrists[0]
    memory, _ = pipeline.advance(memory, replace(seen, time=1 / 30), 1 / 30)
    assert memory.hands.wrists[0].pointing == before.pointing
    assert memory.hands.wrists[0].seen_at == 1 / 30


def test_a_level_hand_stays_level_while_the_guard_keeps_its_arm_from_the_persons() -> None:
    """The wrist turns with the arm as it gets there, not as the person would have it."""
    pipeline = Pipeline.for_robot(ROBOT, "left", gate_mode="open", hands=HandOptions(wrist="level"))
    memory, guarded, tilts = pipeline.start(), 0, []
    for k in range(300):
        arm = RAISED if k < 150 else ((0.7, 0.27, -0.64), (0.8, 0.08, -0.57))
        memory, outcome = pipeline.advance(memory, person(k / 30, arm), k / 30)
        if k > 200:
            guarded += bool(outcome.command.guarded) and outcome.lag.angle > 0.2
            body = np.array([*memory.sent, *memory.hands.wrist, *np.zeros(8)])
            hand = ROBOT.forward_kinematics("left_hand", body)
            tilts.append(np.degrees(np.arccos(min(abs(hand[2, 0]), 1.0))))
    assert guarded > 50
    arm, wrist = memory.engaged[0], memory.hands.wrists[0].engaged
    assert arm.since > 9.0  # both come anew once the guard lets them
    assert wrist.since > 9.0
    assert np.percentile(tilts, 95) < 4.0


def test_the_block_is_pushed_down_with_fingers_too() -> None:
    pipeline = Pipeline.for_robot(ROBOT, "left", hands=HandOptions(gripper=True))
    assert follow(demonstrate(0, 1), pipeline).samples[-1].world.block_down


def test_the_right_hand_closes_the_grippers_of_the_driven_arm(recording: Recording) -> None:
    closed = np.array([bool(sample.hands.closed) for sample in recording.samples])
    times = np.array([sample.time for sample in recording.samples])
    assert times[closed].min() == pytest.approx(7.3, abs=0.1)
    assert times[closed].max() == pytest.approx(9.3, abs=0.1)
    fingers = np.array([sample.world.fingers for sample in recording.samples])
    assert fingers[:, :2].min() == pytest.approx(CLOSED, abs=1e-3)
    np.testing.assert_allclose(fingers[:, 2:], OPEN, atol=1e-3)


def test_a_recording_keeps_its_hands(recording: Recording, tmp_path: Path) -> None:
    path = tmp_path / "hands.mcap"
    write_recording(path, recording)
    read = read_recording(path)
    assert read.info == recording.info
    assert read.info.hands == BOTH_OPTIONS
    assert [s.hands for s in read.samples] == [s.hands for s in recording.samples]
    for one, other in zip(read.samples, recording.samples, strict=True):
        np.testing.assert_array_equal(one.world.fingers, other.world.fingers)


def test_a_reproduction_brings_its_hands_along(recording: Recording) -> None:
    (shown,) = demonstrations_of(recording, "shown")
    taught = DemonstrationSet.of([shown])
    assert taught.hands is not None
    start = recording.samples[shown.first_sample].time
    played = perform(shown.trajectory(), shown.duration, "left", "exact", taught.hands)
    out = {round(tick.time, 2): tick.world.fingers[0] for tick in played.ticks}
    held = [out[t] for t in out if 8.0 - start < t < 9.0 - start]
    assert held
    np.testing.assert_allclose(held, CLOSED, atol=1e-3)
    assert played.ticks[-1].world.fingers[0] == pytest.approx(OPEN, abs=1e-3)
    middle = [tick for tick in played.ticks if 1.0 < tick.time < shown.duration]
    wrist = np.array([tick.world.joint_positions[4:7] for tick in middle])
    told = np.array([shown.hands.at(tick.time + CONTROL_PERIOD).wrist for tick in middle])
    assert np.abs(wrist - told).max() < 0.1


def test_the_ghost_of_a_demonstration_has_its_wrists(recording: Recording) -> None:
    (shown,) = demonstrations_of(recording, "shown")
    assert shown.hands is not None
    for time in (0.0, 1.23, shown.duration):
        joints = demonstration_at(shown, time).joints
        assert tuple(joints[4:7]) == shown.hands.at(time).wrist
    assert np.abs(shown.hands.wrist).max() > 0.3
    lesson = learn(DemonstrationSet.of([shown]), LearnerSettings("rbf", 20))
    film = LessonFilm([Solo(lesson, Scene())], Take(shown, recording))
    ghost = film.at(1.0).ghost
    film.world.close()
    np.testing.assert_allclose(ghost[4:7], shown.hands.at(1.0).wrist)


def track(closed: list[bool], duration: float = 3.0) -> HandTrack:
    times = np.linspace(0.0, duration, len(closed))
    commands = [HandCommand((float(i), 0.0, 0.0), each) for i, each in enumerate(closed)]
    return HandTrack.of(HandOptions(True, "level"), times, commands)


def test_the_mean_of_tracks_is_the_wrists_mean_and_the_majoritys_grip() -> None:
    tracks = [track([False, True, True, False]), track([False, True, False, False], 6.0)]
    mean = HandTrack.mean([*tracks, tracks[0]], 4.0, 4)
    np.testing.assert_allclose(mean.times, [0.0, 4 / 3, 8 / 3, 4.0])
    np.testing.assert_array_equal(mean.closed, [False, True, True, False])
    np.testing.assert_allclose(mean.wrist[:, 0], [0.0, 1.0, 2.0, 3.0])


def test_the_mean_of_wrists_is_taken_where_they_turn_the_hand_alike() -> None:
    """Two demonstrations of one hand's motion, told by different triples, have it as their mean."""
    times = np.linspace(0.0, 2.0, 5)
    shown = np.column_stack([2.9 + 0.03 * times, 0.5 + 0.2 * times, 0.3 * times - 2.0])
    alike = shown * (1, -1, 1) + (-np.pi, 0.0, np.pi)
    plain = np.zeros(5, dtype=bool)
    tracks = [HandTrack(HandOptions(wrist="level"), times, each, plain) for each in (shown, alike)]
    np.testing.assert_allclose(HandTrack.mean(tracks, 2.0, 5).wrist, shown, atol=1e-12)
    turned = [replace(tracks[0], wrist=shown * 0 + (w0, 0.5, 0.0)) for w0 in (3.0, -3.0)]
    mean = HandTrack.mean(turned, 2.0, 5).wrist
    np.testing.assert_allclose(np.cos(mean[:, 0]), -1.0)  # between the two, not opposite
    np.testing.assert_allclose(mean[:, 1:], [[0.5, 0.0]] * 5)
    both = replace(tracks[0], wrist=np.hstack([shown, alike]), options=HandOptions(wrist="level"))
    other = replace(both, wrist=np.hstack([alike, shown]))
    mean = HandTrack.mean([both, other], 2.0, 5).wrist
    np.testing.assert_allclose(mean, np.hstack([shown, alike]), atol=1e-12)


def test_a_grip_holds_until_the_next_one_and_a_wrist_moves_evenly() -> None:
    some = track([False, True, True, False])
    assert [some.at(time).closed for time in (0.0, 0.99, 1.0, 2.99, 3.0, 9.0)] == [
        *(False, False, True, True, False, False),
    ]
    assert some.at(0.5).wrist == (0.5, 0.0, 0.0)
