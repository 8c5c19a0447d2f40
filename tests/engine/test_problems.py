from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.problems import dropped_frames, duplicate_frames, find_problems, runs_of
from studio.engine.skeleton import Hand, HandState, Joint, Skeleton, Tracking, all_tracked
from studio.engine.sources.family import Frame, ParsedFile, any_hand_state
from studio.engine.sources.recording import follow

LASSO, OPEN, CLOSED = HandState.LASSO, HandState.OPEN, HandState.CLOSED
UNKNOWN = HandState.UNKNOWN
ARMING = [LASSO] * 15 + [OPEN] * 15 + [CLOSED] * 15
PLACES = {  # [m] in camera space: a person 2 m away with both arms level and forward
    Joint.SPINE_BASE: (0.0, 0.0, 2.0),
    Joint.SPINE_MID: (0.0, 0.3, 2.0),
    Joint.SPINE_SHOULDER: (0.0, 0.5, 2.0),
    Joint.SHOULDER_LEFT: (-0.2, 0.45, 2.0),
    Joint.ELBOW_LEFT: (-0.2, 0.45, 1.7),
    Joint.WRIST_LEFT: (-0.2, 0.50, 1.5),
    Joint.SHOULDER_RIGHT: (0.2, 0.45, 2.0),
    Joint.ELBOW_RIGHT: (0.2, 0.45, 1.7),
    Joint.WRIST_RIGHT: (0.2, 0.50, 1.5),
}


def frame(
    index: int,
    state: HandState = OPEN,
    body_id: str = "0",
    moved: dict[Joint, tuple[float, float, float]] | None = None,
    states: dict[Joint, Tracking] | None = None,
) -> Skeleton:
    positions = np.zeros((25, 3))
    for joint, place in (PLACES | (moved or {})).items():
        positions[joint] = place
    tracking = all_tracked().copy()
    for joint, mark in (states or {}).items():
        tracking[joint] = mark
    shifted = positions + np.array([0.0, 0.0, 1e-4 * index])  # no two frames alike
    return Skeleton(index / 30, shifted, tracking, Hand(state), Hand(), body_id)


def problems(*skeletons: Skeleton | None, times=None, **told: bool) -> list[str]:
    """Problems of frames that come 30 a second; None is a frame with nobody."""
    frames = [
        Frame(index / 30 if times is None else times[index], () if each is None else (each,))
        for index, each in enumerate(skeletons)
    ]
    known = {"has_hand_states": any_hand_state(frames), "has_tracking": True, "has_stamps": True}
    return list(find_problems(follow(ParsedFile("made up", frames, **(known | told)), "x")))


def arming(**details) -> list[Skeleton]:
    return [frame(index, state, **details) for index, state in enumerate(ARMING)]


def test_a_good_recording_has_none():
    assert problems(*arming()) == []


def test_nobody_at_all():
    assert problems(None, None) == ["nobody is seen in this file"]


def test_what_a_format_does_not_tell():
    found = problems(*arming(), has_hand_states=False, has_tracking=False, has_stamps=False)
    assert len(found) == 3
    assert "can never arm" in found[0]
    assert "--gate open" in found[0]
    assert "tracking" in found[1]
    assert "30 frames a second" in found[2]


def test_frames_without_a_body_are_counted_and_placed():
    frames = arming()
    found = problems(*frames[:1], None, *frames[2:5], None, None, *frames[7:])
    assert found == ["nobody to follow in 3 of 45 frames (2 runs, 5-6 longest)"]


def test_several_bodies_and_who_is_followed():
    frames = arming()
    frames += [frame(index, CLOSED, "1") for index in range(45, 65)]
    assert problems(*frames) == [
        "2 bodies are seen: 0 (45 frames), 1 (20 frames)",
        "the body that is followed changes: 1 from frame 60 on",
        "nobody to follow in 15 of 65 frames (45-59)",  # the first one is waited for
    ]


def test_duplicates_are_counted_and_placed():
    frames = arming()
    frames[7] = frames[6]
    frames[20] = frames[19]
    assert problems(*frames) == [
        "duplicate frames, which tell nothing new: 2 of 45 frames (the first is 7)"
    ]


def test_the_same_picture_after_a_gap_or_of_another_body_is_no_duplicate():
    still = frame(0), frame(0), None, frame(0), frame(0, body_id="1")
    frames = [Frame(i / 30, () if each is None else (each,)) for i, each in enumerate(still)]
    frames.append(Frame(1.0, (frame(0, body_id="1"),)))
    recording = follow(ParsedFile("made up", frames, True, True, True), "x")
    assert [skeleton.body_id for skeleton in recording] == ["0", "0", "0", "1"]
    assert duplicate_frames(recording).tolist() == [False, True, False, False]


def test_dropped_frames_are_those_that_the_stamps_miss():
    def dropped(times, has_stamps=True):
        frames = [Frame(time, (frame(0),)) for time in times]
        return dropped_frames(follow(ParsedFile("made up", frames, True, True, has_stamps), "x"))

    assert dropped([0, 1, 2, 3, 4]) == 0
    assert dropped([0, 1, 2, 4, 5, 6, 9, 10]) == 3
    assert dropped([0, 1.2, 2, 2.9, 4.1]) == 0  # jitter is no loss
    assert dropped([0, 1, 1, 2, 3]) == 0
    assert dropped([0, 0, 0]) == dropped([0]) == 0
    assert dropped([0, 1, 2, 4], has_stamps=False) == 0


def test_gaps_rate_and_equal_stamps():
    times = [index / 15 + 0.2 * (index >= 31) for index in range(45)]
    times[3] = times[2]
    frames = arming()
    found = problems(*frames, times=times)
    assert found[0] == "frames with the stamp of the frame before: 1 of 45 frames (3)"
    assert "every 66.7 ms in the median; a Kinect sends one every 33.3 ms" in found[1]
    assert "2 of 44 intervals" in found[2]
    assert "the longest, 267 ms, ends at frame 31" in found[2]


@pytest.mark.parametrize(
    ("states", "words"),
    [
        ([OPEN] * 45, "left hand: Lasso is never seen"),
        ([OPEN] * 20 + [LASSO] * 20, "left hand: Open is never seen after Lasso"),
        ([CLOSED, *[LASSO] * 20, *[OPEN] * 20], "Closed is never seen after Lasso and Open"),
    ],
)
def test_a_sign_that_never_comes_in_its_turn(states, words):
    found = problems(*[frame(index, state) for index, state in enumerate(states)])
    assert words in found[0]
    assert "the gate never arms: waiting for" in found[1]


def test_the_gate_itself_is_asked_and_its_reasons_counted():
    too_short = [LASSO] * 5 + [OPEN] * 15 + [CLOSED] * 15
    (found,) = problems(*[frame(index, state) for index, state in enumerate(too_short)])
    assert found == "the gate never arms: waiting for Lasso of the left hand (35 frames)"


@pytest.mark.parametrize("start", [45, 52, 53, 57])  # n/30 s are rounded now up, now down
@pytest.mark.parametrize(("count", "told"), [(24, False), (25, True)])
def test_only_losses_that_the_gate_does_not_bridge_are_told(start, count, told):
    states = ARMING + [CLOSED] * (start - 45) + [UNKNOWN] * count + [CLOSED] * 2
    found = problems(*[frame(index, state) for index, state in enumerate(states)])
    place = f"the longest {count / 30:.2f} s in frames {start}-{start + count - 1}"
    assert [f"(0.8 s); runs: 1, {place}" in each for each in found] == [True] * told


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("part", ["shoulder", "elbow", "wrist"])
def test_arm_joints_inferred_or_lost(side, part):
    joint = Joint.of(part, side)
    frames = arming()
    frames[4] = frame(4, LASSO, states={joint: Tracking.INFERRED})
    assert problems(*frames) == [f"{side} {part} inferred in 1 of 45 frames (4)"]
    frames[4] = frame(4, LASSO, states={joint: Tracking.NOT_TRACKED})
    lost = f"{side} arm held, {side} {part} not tracked: 1 of 45 frames (4)"
    assert lost in problems(*frames)


def test_bones_without_direction():
    frames = arming()
    frames[:3] = [
        frame(index, LASSO, moved={Joint.WRIST_LEFT: PLACES[Joint.ELBOW_LEFT]})
        for index in range(3)
    ]
    assert any(
        "left arm held, left forearm" in each and "(0-2)" in each for each in problems(*frames)
    )
    flat = arming(moved={Joint.SPINE_SHOULDER: PLACES[Joint.SPINE_BASE]})
    found = problems(*flat)
    assert [each.split(",")[0] for each in found] == ["left arm held", "right arm held"]
    assert all("45 of 45 frames" in each for each in found)


def test_an_arm_that_hangs_is_below_the_robots_reach():
    hanging = {Joint.ELBOW_RIGHT: (0.2, 0.15, 2.0), Joint.WRIST_RIGHT: (0.2, 0.0, 1.8)}
    frames = arming()
    frames[:9] = [frame(index, LASSO, moved=hanging) for index in range(9)]
    assert problems(*frames) == [
        "right upper arm hangs below Baxter's reach (s1 above 1.047 rad) in 9 of 45 frames: "
        "the robot's stays at that limit",
    ]


def test_a_forearm_that_changes_its_length():
    frames = arming()
    short = {Joint.WRIST_LEFT: (-0.2, 0.45, 1.6)}
    frames[20:] = [frame(20 + index, state, moved=short) for index, state in enumerate(ARMING[20:])]
    (found,) = problems(*frames)
    assert "left forearm measures 0.10 to 0.21 m" in found


@pytest.mark.parametrize("scale", [1000.0, 1e200, 1e308])
def test_positions_that_are_no_meters(scale):
    frames = [
        Skeleton(
            each.time, each.positions / 3 * scale, each.tracking, each.left_hand, each.right_hand
        )
        for each in arming()
    ]
    assert "are they in meters?" in problems(*frames)[0]


@settings(deadline=None, derandomize=True, max_examples=60)
@given(
    st.lists(
        st.none()
        | st.builds(
            frame,
            st.just(0) | st.integers(0, 10**9),
            st.sampled_from(HandState),
            st.sampled_from("ab"),
            st.dictionaries(
                st.sampled_from(Joint),
                st.tuples(*[st.floats(-1e308, 1e308)] * 3),
            ),
            st.dictionaries(st.sampled_from(Joint), st.sampled_from(Tracking)),
        ),
        min_size=1,
        max_size=8,
    ),
    st.lists(st.floats(0.0, 1e12), min_size=8, max_size=8),
)
def test_any_recording_has_problems_in_words(skeletons, times):
    found = problems(*skeletons, times=sorted(times))
    assert all(each.isprintable() and len(each) < 1000 for each in found)


@settings(deadline=None, derandomize=True)
@given(st.lists(st.booleans()))
def test_runs_cover_exactly_what_is_marked(marks):
    runs = runs_of(np.array(marks, dtype=bool))
    covered = [index for first, last in runs for index in range(first, last + 1)]
    assert covered == [index for index, mark in enumerate(marks) if mark]
    assert all(after[0] > before[1] + 1 for before, after in pairwise(runs))
