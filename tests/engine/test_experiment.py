"""The whole paper: taught, learned, reproduced, and measured; and where nothing can be taught."""

import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from studio.engine.demonstration import DemonstrationSet, demonstrations_of
from studio.engine.engage import COMING
from studio.engine.errors import FileError, StudioError
from studio.engine.experiment import Experiment, Setup, Teachers, run_experiment, teach
from studio.engine.follow import follow
from studio.engine.mcap_file import write_recording
from studio.engine.performance import perform
from studio.engine.pipeline import Pipeline
from studio.engine.report import as_json, as_text
from studio.engine.retarget import Mapping
from studio.engine.robot import load_robot
from studio.engine.skeleton import HandState, Joint, Skeleton, Tracking, all_tracked
from studio.engine.sources import write_skeletons
from studio.engine.sources.demonstrator import demonstrate
from studio.engine.sources.recording import from_skeletons
from studio.engine.teaching import LearnerSettings, learn, reproduce
from tests.engine.people import person

TAKES = [demonstrate(0, take) for take in (1, 2)]


@cache
def of_one_take() -> Experiment:
    return run_experiment(TAKES[:1], Setup())


@cache
def of_two_takes(mapping: Mapping) -> Experiment:
    return run_experiment(TAKES, Setup(mapping=mapping))


@pytest.fixture(params=["exact", "paper"])
def experiment(request):
    return of_two_takes(request.param)


def test_baxter_pushes_the_block_down_as_it_was_taught(experiment) -> None:
    assert experiment.reproduction.performance.block_down
    assert all(replay.performance.block_down for replay in experiment.replays)
    assert experiment.reproduction.deviation.hand_mean < 0.040


def test_the_numbers_keep_their_law(experiment) -> None:
    """With shared stamps: MSE = floor + error of the mean curve, to rounding."""
    lesson = experiment.lesson
    of_mean = np.mean((lesson.taught.mean - lesson.curve) ** 2, axis=0)
    assert np.allclose(lesson.mse, lesson.floor + of_mean, rtol=1e-9)
    assert (lesson.mse >= lesson.floor).all()


def test_what_is_printed_is_what_was_measured(experiment) -> None:
    shown = json.loads(json.dumps(as_json(experiment), allow_nan=False))
    assert shown["samples"] == 142
    assert len(shown["joints"]) == (4 if shown["mapping"] == "exact" else 3)
    assert list(shown["mse"]) == list(shown["floor"]) == shown["joints"]
    assert shown["reproduction"]["hand_error_mm"]["mean"] == pytest.approx(
        1000 * experiment.reproduction.deviation.hand_mean
    )
    played = [experiment.reproduction, *experiment.replays]
    for told, each in zip([shown["reproduction"], *shown["demonstrations"]], played, strict=True):
        ticks = each.performance.ticks
        assert told["guarded_ticks"] == sum(bool(tick.command.guarded) for tick in ticks)
        assert told["refusal"] == ""
    for file in shown["files"]:
        following = sum(last - first + 1 for first, last in file["armed"])
        assert following == file["armed_frames"]
        coming = file["held"].pop(COMING, 0)  # armed, but not yet where the person is
        assert file["armed_frames"] + sum(file["held"].values()) == file["frames"]
        assert coming < 30
    ticks = experiment.reproduction.performance.ticks
    near = replace(ticks[0], command=replace(ticks[0].command, guarded="hand is near: slowed"))
    alone = replace(experiment.reproduction.performance, ticks=(near, *ticks[1:]))
    changed = replace(experiment, reproduction=replace(experiment.reproduction, performance=alone))
    assert f"Alone: The collision guard changed 1 of {len(ticks)} ticks" in as_text(changed)
    text = as_text(experiment)
    assert "floor" in text
    assert "Block down: alone yes" in text


def test_the_same_seed_gives_the_same_numbers(experiment) -> None:
    again = run_experiment([demonstrate(0, take) for take in (1, 2)], experiment.setup)
    assert as_json(again) == as_json(experiment)


def test_a_still_arm_and_the_mean_posture_leave_the_block_standing(experiment) -> None:
    taught = experiment.lesson.taught
    start, posture = taught.mean[0], taught.mean.mean(axis=0)
    for constant in (start, posture):
        stands = perform(lambda _, q=constant: q, 3.0, taught.arms, taught.mapping)
        assert not stands.block_down


def test_one_demonstration_has_no_floor_and_says_why() -> None:
    alone = as_json(of_one_take())
    assert alone["floor"] is None
    assert "single" in alone["floor_note"]


def test_newrb_learns_it_too() -> None:
    lesson = learn(of_two_takes("exact").lesson.taught, LearnerSettings("newrb", 50))
    assert reproduce(lesson).performance.block_down
    ratio = lesson.mse / lesson.floor
    assert (ratio > 1.0).all()


def test_files_and_recordings_teach_the_same(tmp_path: Path) -> None:
    """Two roads: a skeleton file followed now, and the recording of it made then."""
    write_skeletons(tmp_path / "take.jsonl", TAKES[0])
    kept = []
    from_file = teach([tmp_path / "take.jsonl"], Setup(), keep=kept.append)
    write_recording(tmp_path / "take.mcap", kept[0])
    from_recording = teach([tmp_path / "take.mcap"], Setup())
    assert np.array_equal(rows(from_file), rows(from_recording))
    paper = Setup(mapping="paper", gate="open")
    anew = teach([tmp_path / "take.mcap"], paper)
    assert "followed anew" in anew.files[0].format
    again = teach([tmp_path / "take.jsonl"], paper)
    assert np.array_equal(rows(anew), rows(again))


def rows(taught: Teachers) -> np.ndarray:
    return DemonstrationSet.of(taught.demonstrations).rows


def test_where_nothing_arms_the_files_and_the_reason_are_told() -> None:
    stays = demonstrate(0, 1, (HandState.OPEN, HandState.CLOSED))
    found = as_json(run_experiment([stays], Setup()))
    taught = as_json(of_one_take())
    assert set(found) == {*taught, "error"}  # the same object, null for what there is not
    assert found["joints"] == taught["joints"]
    assert found["mse"] is found["reproduction"] is None
    assert found["files"][0]["armed_frames"] == 0
    assert "waiting for Lasso" in found["error"]
    followed = teach([stays], Setup(gate="open"))
    assert followed.files[0].armed_frames == followed.files[0].frames
    assert followed.demonstrations


def test_an_arm_that_is_never_seen_teaches_nothing() -> None:
    """An open gate alone moves nothing: 40 frames of a person whose wrist is lost."""
    lost = all_tracked()
    lost[Joint.WRIST_LEFT] = Tracking.NOT_TRACKED
    unseen = [replace(skeleton, tracking=lost) for skeleton in TAKES[0][:40]]
    found = run_experiment([from_skeletons(unseen, "unseen", "test")], Setup(gate="open"))
    assert "left wrist not tracked" in found.error


def test_the_right_arm_mirrors_the_scene() -> None:
    recording = follow(TAKES[0], Pipeline.for_robot(load_robot(), "right", gate_mode="open"))
    taught = DemonstrationSet.of(demonstrations_of(recording, "right"))
    assert learn(taught, LearnerSettings()).taught.arms == "right"
    assert recording.samples[0].world.block_poses[0, 1] < 0.0


@pytest.mark.parametrize(("mapping", "columns"), [("exact", 8), ("paper", 6)])
def test_both_arms_are_taught_and_do_it_again(mapping, columns: int) -> None:
    found = run_experiment(TAKES[:1], Setup(arms="both", mapping=mapping))
    taught = found.lesson.taught
    assert taught.rows.shape == (1, 142, columns)
    assert as_json(found)["joints"] == list(taught.joints)
    assert {joint.partition("_")[0] for joint in taught.joints} == {"left", "right"}
    assert found.reproduction.performance.block_down
    assert found.reproduction.deviation.joint_rmse.shape == (columns,)


def test_in_a_mirror_the_left_hand_teaches_the_right_arm() -> None:
    """Two roads: the reflected world of the left arm, to the last joint."""
    left = of_one_take()
    right = run_experiment(TAKES[:1], Setup(arms="right", mirrored=True))
    assert right.reproduction.performance.block_down
    assert np.allclose(
        right.lesson.taught.rows, left.lesson.taught.rows * [-1, 1, -1, 1], atol=1e-6
    )


def test_a_recording_made_in_another_way_is_followed_anew(tmp_path: Path) -> None:
    kept = []
    teach([from_skeletons(TAKES[0][:30], "short", "test")], Setup(), keep=kept.append)
    write_recording(tmp_path / "take.mcap", kept[0])
    for setup, anew in ((Setup(), False), (Setup(mirrored=True), True), (Setup(arms="both"), True)):
        (file,) = teach([tmp_path / "take.mcap"], setup).files
        assert ("followed anew" in file.format) == anew


def test_a_calibration_is_taken_from_the_file_kept_and_used_again(tmp_path: Path) -> None:
    hanging = [person(i / 30, ((0.1, 0.0, -1.0),) * 2) for i in range(75)]  # one arm; both below
    hanging = [both_arms_as_left(each) for each in hanging]
    rest = [replace(each, time=each.time + 2.5) for each in TAKES[0]]
    stream = from_skeletons([*hanging, *rest], "calibrated", "test")
    kept = []
    plain = teach([stream], Setup(), keep=kept.append)
    found = teach([stream], Setup(calibrate_at=0.2), keep=kept.append)
    lean = kept[1].info.calibration.lean
    assert lean == pytest.approx(np.arctan(0.1), abs=1e-6)
    assert kept[0].info.calibration is None
    assert not np.allclose(sent(found), sent(plain), atol=0.02)
    write_recording(tmp_path / "take.mcap", kept[1])
    again = teach([tmp_path / "take.mcap"], Setup())
    assert np.array_equal(sent(again), sent(found))
    with pytest.raises(FileError, match=r"calibrated, 6 s into it: calibration: "):
        teach([stream], Setup(calibrate_at=6.0))


def sent(taught: Teachers) -> np.ndarray:
    (only,) = taught.demonstrations
    return only.at(np.linspace(0.0, 5.0, 50))


def both_arms_as_left(skeleton: Skeleton) -> Skeleton:
    """Return the person with the right arm parallel to the left one."""
    positions = skeleton.positions.copy()
    aside = positions[Joint.SHOULDER_RIGHT] - positions[Joint.SHOULDER_LEFT]
    for part in ("elbow", "wrist"):
        positions[Joint.of(part, "right")] = positions[Joint.of(part, "left")] + aside
    return replace(skeleton, positions=positions, body_id="1")


@pytest.mark.parametrize("neurons", [0, -1, 1001])
def test_impossible_networks_are_refused(neurons: int) -> None:
    with pytest.raises(StudioError, match="neurons"):
        LearnerSettings("rbf", neurons)
    with pytest.raises(StudioError, match="unknown learner"):
        LearnerSettings("magic", 5)
