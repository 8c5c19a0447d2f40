"""Hanging arms are a plumb line: a lean that is put in is found and taken out, or refused."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.calibration import (
    LARGEST_LEAN,
    SECONDS,
    Calibration,
    calibrate,
    calibrate_at,
    calibrate_file,
)
from studio.engine.errors import FileError, StudioError
from studio.engine.human import arm_vectors
from studio.engine.skeleton import SIDES, Joint, Skeleton, Tracking, all_tracked
from studio.engine.sources.recording import from_skeletons
from tests.engine.people import DOWN, hanging, stand


@pytest.mark.parametrize("lean", [-0.3, -0.1, 0.0, 0.05, 0.2])
def test_a_lean_of_the_spine_line_is_found_and_taken_out(lean: float) -> None:
    found = calibrate(stand(lean))
    assert found.lean == pytest.approx(abs(lean), abs=1e-9)
    for side in SIDES:
        seen = arm_vectors(hanging(0.0, lean), side)
        assert found.correct(seen.torso.from_camera(seen.upper_arm)) == pytest.approx(DOWN)
    # Somebody who points forward, level: the robot does it as if the spine line did not lean.
    level = arm_vectors(hanging(0.0, lean, swing=math.pi / 2), "left")
    assert found.correct(level.torso.from_camera(level.forearm)) == pytest.approx((1.0, 0.0, 0.0))


TILTS = st.tuples(st.floats(0.0, LARGEST_LEAN * 0.999), st.floats(0.0, 2 * math.pi))
DIRECTIONS = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: math.hypot(*v) > 1e-3)


@settings(deadline=None, derandomize=True)
@given(tilt=TILTS, a=DIRECTIONS, b=DIRECTIONS)
def test_the_correction_is_the_smallest_rotation_that_turns_down_down(tilt, a, b) -> None:
    lean, to = tilt
    across = (math.cos(to), math.sin(to))
    down = (math.sin(lean) * across[0], math.sin(lean) * across[1], -math.cos(lean))
    calibration = Calibration(down)
    assert calibration.correct(down) == pytest.approx(DOWN, abs=1e-12)
    axis = (-across[1], across[0], 0.0)  # the smallest rotation keeps it
    assert calibration.correct(axis) == pytest.approx(axis, abs=1e-12)
    turned = [np.array(calibration.correct(v)) for v in (a, b)]
    assert turned[0] @ turned[1] == pytest.approx(np.dot(a, b), abs=1e-12)
    assert np.linalg.det(np.array([calibration.correct(v) for v in np.eye(3)])) > 0.0


def test_who_moves_is_told_so() -> None:
    swings = [0.5 * math.sin(i / 10) for i in range(60)]
    moving = [hanging(i / 30, swing=swing) for i, swing in enumerate(swings)]
    with pytest.raises(StudioError, match="you moved"):
        calibrate(moving)


def test_a_few_bad_frames_do_no_harm() -> None:
    frames = stand(0.1)
    frames[20:24] = [hanging(i / 30, swing=1.2) for i in range(20, 24)]
    assert calibrate(frames).lean == pytest.approx(0.1, abs=1e-9)


def test_arms_that_do_not_hang_and_arms_unseen_are_refused_in_words() -> None:
    with pytest.raises(StudioError, match="pointed 90° away"):
        calibrate(stand(swing=math.pi / 2))
    lost = all_tracked()
    lost[Joint.WRIST_RIGHT] = Tracking.NOT_TRACKED
    unseen = [Skeleton(each.time, each.positions, lost) for each in stand()]
    with pytest.raises(StudioError, match=r"seen for 0\.0 s, in 0 of 60 frames"):
        calibrate(unseen)
    with pytest.raises(StudioError, match="in 0 of 0 frames"):
        calibrate([])


def test_a_file_is_calibrated_by_the_two_seconds_asked_for() -> None:
    first = [hanging(7.0 + i / 30, swing=1.0) for i in range(90)]
    then = [hanging(10.0 + i / 30, 0.15) for i in range(90)]
    assert calibrate_at(first + then, 3.0).lean == pytest.approx(0.15, abs=1e-9)
    with pytest.raises(StudioError, match="pointed"):
        calibrate_at(first + then, 0.0)
    with pytest.raises(StudioError, match="in 0 of 0"):
        calibrate_at(first + then, 100.0)
    for bad in (-1.0, math.nan, math.inf):
        with pytest.raises(StudioError, match="0 s or more"):
            calibrate_at(first, bad)
    with pytest.raises(StudioError, match="nobody"):
        calibrate_at([], 0.0)
    assert SECONDS == 2.0


@pytest.mark.parametrize("rate", [5.0, 10.0, 12.5, 15.0, 30.0, 60.0])
def test_time_decides_and_not_how_many_frames_a_sensor_sends(rate: float) -> None:
    """Half of the two seconds is enough, at every rate; less is not."""
    lost = all_tracked()
    lost[Joint.WRIST_LEFT] = Tracking.NOT_TRACKED
    frames = [hanging(7.0 + i / rate, 0.15) for i in range(int(2.0 * rate) + 1)]
    assert calibrate_at(frames, 0.0).lean == pytest.approx(0.15, abs=1e-9)

    def hidden(share: float) -> list[Skeleton]:
        until = share * len(frames)
        return [
            Skeleton(each.time, each.positions, lost) if i < until else each
            for i, each in enumerate(frames)
        ]

    assert calibrate(hidden(0.3)).lean == pytest.approx(0.15, abs=1e-9)
    with pytest.raises(StudioError, match=r"and 1 s are needed: stand in full view"):
        calibrate(hidden(0.7))


def test_frames_that_are_too_far_apart_do_not_stand_for_what_is_between() -> None:
    rare = [hanging(float(i), 0.1) for i in range(3)]
    with pytest.raises(StudioError, match=r"for 0\.5 s, in 3 of 3.* 5 frames a second or more"):
        calibrate(rare)


def test_a_files_calibration_names_the_file_and_the_place() -> None:
    stream = from_skeletons(stand(0.1, 90), "a.jsonl", "test")
    assert calibrate_file(stream, 0.5) == calibrate_at(stream, 0.5)
    with pytest.raises(FileError, match=r"^a\.jsonl, 2\.5 s into it: calibration: both arms"):
        calibrate_file(stream, 2.5)


@pytest.mark.parametrize("down", [(0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0),
                                  (math.nan, 0.0, -1.0), (0.6, 0.0, -0.8)])  # fmt: skip
def test_what_is_no_plausible_down_is_refused(down) -> None:
    with pytest.raises(StudioError, match="straight down"):
        Calibration(down)
