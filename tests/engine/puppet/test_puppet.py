"""The puppet's laws: rigid bones, hands where they are dragged, and a human speed."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies

from studio.engine.errors import StudioError
from studio.engine.human import ArmVectors, arm_vectors
from studio.engine.placement import Placement
from studio.engine.puppet.arm import allowed
from studio.engine.puppet.puppet import SIGNS, Puppet, PuppetMemory
from studio.engine.skeleton import BONES, SIDES, HandState, Joint
from studio.engine.sources.demonstrator import demonstrate
from tests.engine.puppet.dragging import from_shoulder

PUPPET = Puppet()
lawful = settings(deadline=None, derandomize=True, max_examples=40)
near = strategies.tuples(
    strategies.floats(0.16, 0.35), strategies.floats(-0.2, 0.3), strategies.floats(-0.3, 0.2)
)
far = strategies.tuples(*[strategies.floats(-3.0, 3.0)] * 3)
sides = strategies.sampled_from(SIDES)


def after(memory: PuppetMemory, ticks: int) -> PuppetMemory:
    for _ in range(ticks):
        memory = PUPPET.tick(memory)
    return memory


def points(memory: PuppetMemory) -> np.ndarray:
    return PUPPET.skeleton(memory, 0.0).positions


def bone_lengths(positions: np.ndarray) -> np.ndarray:
    ends = positions[np.array(BONES)]
    return np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)


@given(strategies.lists(strategies.tuples(sides, far, far), max_size=4))
@lawful
def test_bones_keep_their_lengths_whatever_is_dragged(drags) -> None:
    memory = PUPPET.start()
    lengths = bone_lengths(points(memory))
    for side, hand, elbow in drags:
        memory = PUPPET.drag_hand(memory, side, np.array(hand))
        memory = after(PUPPET.drag_elbow(memory, side, np.array(elbow)), 5)
        assert bone_lengths(points(memory)) == pytest.approx(lengths, abs=1e-12)


@given(sides, near)
@lawful
def test_a_hand_within_reach_comes_to_where_it_is_dragged(side, offset) -> None:
    target = from_shoulder(side, *offset)
    memory = PUPPET.drag_hand(PUPPET.start(), side, target)
    assert PUPPET.goals(memory)[Joint.of("hand", side)] == pytest.approx(target, abs=1e-9)
    settled = points(after(memory, 90))[Joint.of("hand", side)]
    assert settled == pytest.approx(target, abs=1e-6)


@given(strategies.lists(strategies.tuples(sides, far, strategies.integers(1, 12)), max_size=8))
@lawful
def test_a_drag_that_jumps_becomes_a_reach_at_a_human_speed(drags) -> None:
    memory = PUPPET.start()
    for side, target, ticks in drags:
        memory = PUPPET.drag_hand(memory, side, np.array(target))
        for _ in range(ticks):
            before, memory = memory, PUPPET.tick(memory)
            speed = np.linalg.norm(points(memory) - points(before), axis=1) * 30.0
            hands = [Joint.of("hand", each) for each in SIDES]
            assert speed[hands].max() <= PUPPET.hand_speed + 1e-9
            elbows = [Joint.of("elbow", each) for each in SIDES]
            assert speed[elbows].max() <= 1.5 * PUPPET.hand_speed + 1e-9


@given(strategies.lists(strategies.tuples(far, far, strategies.integers(1, 12)), max_size=8))
@lawful
def test_no_arm_leaves_what_is_allowed(drags) -> None:
    """Though nothing but the spring keeps it there, goals being allowed ones."""
    memory = PUPPET.start()
    for hand, elbow, ticks in drags:
        memory = PUPPET.drag_hand(memory, "left", np.array(hand))
        memory = PUPPET.drag_elbow(memory, "left", np.array(elbow))
        for _ in range(ticks):
            memory = PUPPET.tick(memory)
            assert memory.left.angles == pytest.approx(allowed(memory.left.angles), abs=1e-9)


@given(sides, near, strategies.tuples(*[strategies.floats(-1e-4, 1e-4)] * 3))
@lawful
def test_small_drags_move_it_little(side, offset, nudge) -> None:
    target = from_shoulder(side, *offset)
    runs = [
        points(after(PUPPET.drag_hand(PUPPET.start(), side, at), 12))
        for at in (target, target + nudge)
    ]
    assert np.abs(runs[1] - runs[0]).max() <= 30.0 * np.abs(nudge).max() + 1e-12


def test_a_steadily_dragged_hand_follows_closely() -> None:
    memory, speed = PUPPET.start(), 0.4
    for k in range(30):
        target = from_shoulder("left", 0.4, 0.2 - speed * k / 30.0, -0.2)
        memory = PUPPET.tick(PUPPET.drag_hand(memory, "left", target))
    behind = np.linalg.norm(points(memory)[Joint.HAND_LEFT] - target)
    assert behind <= 1.1 * speed * 2.0 / PUPPET.quickness
    assert behind > 0.0


def test_it_is_built_as_the_demonstrator_is() -> None:
    """The demonstrator varies in size: every bone by the same factor, but for a moved thumb."""
    ours = bone_lengths(points(PUPPET.start()))
    theirs = np.median([bone_lengths(each.positions) for each in demonstrate(seed=0)], axis=0)
    left_out = [
        BONES.index((Joint.WRIST_LEFT, Joint.THUMB_LEFT)),
        BONES.index((Joint.WRIST_RIGHT, Joint.THUMB_RIGHT)),
        # The demonstrator's idle right arm hangs, a little bent.
        *(i for i, (_, end) in enumerate(BONES) if end.name.endswith("_RIGHT") and 7 < end < 12),
        BONES.index((Joint.HAND_RIGHT, Joint.HAND_TIP_RIGHT)),
    ]
    ratio = np.delete(theirs / ours, left_out)
    assert ratio == pytest.approx(np.full(len(ratio), np.median(ratio)), rel=0.08)


def test_both_sides_are_mirror_images() -> None:
    memory = PUPPET.start()
    for side in SIDES:
        memory = PUPPET.drag_hand(memory, side, from_shoulder(side, 0.3, -0.1, 0.2))
    at = points(after(memory, 10))
    for part in ("shoulder", "elbow", "wrist", "hand", "hand_tip", "thumb", "hip", "foot"):
        left, right = at[Joint.of(part, "left")], at[Joint.of(part, "right")]
        assert left * [-1, 1, 1] == pytest.approx(right, abs=1e-12)


def test_a_drag_goes_through_the_world_and_back() -> None:
    """A handle at a drawn joint is that joint: dragging it to where it is changes nothing."""
    memory = PUPPET.drag_hand(PUPPET.start(), "left", from_shoulder("left", 0.3, 0.0, 0.1))
    memory = after(memory, 300)
    skeleton = PUPPET.skeleton(memory, 0.0)
    placement = Placement.of(skeleton)
    drawn = placement.place(skeleton.positions)
    dragged = PUPPET.drag_hand(memory, "left", placement.to_camera(drawn[Joint.HAND_LEFT]))
    dragged = PUPPET.drag_elbow(dragged, "left", placement.to_camera(drawn[Joint.ELBOW_LEFT]))
    assert points(after(dragged, 30)) == pytest.approx(skeleton.positions, abs=1e-6)


def test_elbow_and_home() -> None:
    start = PUPPET.start()
    raised = after(PUPPET.drag_elbow(start, "left", from_shoulder("left", 0.2, 0.2, 0.3)), 90)
    assert points(raised)[Joint.ELBOW_LEFT, 1] > points(start)[Joint.ELBOW_LEFT, 1] + 0.05
    assert points(raised)[Joint.HAND_LEFT] == pytest.approx(points(start)[Joint.HAND_LEFT])
    eased = after(PUPPET.release_elbow(raised, "left"), 120)
    assert points(eased) == pytest.approx(points(start), abs=1e-6)
    away = PUPPET.drag_hand(raised, "right", from_shoulder("right", 0.2, 0.4, 0.2))
    assert points(after(PUPPET.go_home(after(away, 30)), 120)) == pytest.approx(
        points(start), abs=1e-6
    )


def test_each_hand_signs_for_itself() -> None:
    memory = PUPPET.start()
    assert PUPPET.skeleton(memory, 0.0).left_hand.state is HandState.UNKNOWN
    for sign in SIGNS:
        memory = PUPPET.sign(memory, "left", sign)
        seen = PUPPET.skeleton(PUPPET.tick(memory), 0.0)
        assert (seen.left_hand.state, seen.right_hand.state) == (sign, HandState.UNKNOWN)
    both = PUPPET.sign(memory, "right", HandState.OPEN)
    assert both.sign("right") is HandState.OPEN


def test_the_pipeline_sees_its_arms() -> None:
    skeleton = PUPPET.skeleton(PUPPET.start(), 1.5)
    assert skeleton.time == 1.5
    assert all(isinstance(arm_vectors(skeleton, side), ArmVectors) for side in SIDES)


@pytest.mark.parametrize("wrong", [(0.0, 0.0), (np.nan, 0.0, 0.0), (np.inf, 0.0, 0.0)])
def test_it_is_dragged_to_points_only(wrong) -> None:
    with pytest.raises(StudioError, match="three finite numbers"):
        PUPPET.drag_hand(PUPPET.start(), "left", np.array(wrong))
    with pytest.raises(StudioError, match="three finite numbers"):
        PUPPET.drag_elbow(PUPPET.start(), "left", np.array(wrong))


@pytest.mark.parametrize("settings", [{"hand_speed": 0.0}, {"quickness": 31.0}, {"quickness": 0}])
def test_impossible_settings_are_refused(settings) -> None:
    with pytest.raises(StudioError, match="hand speed"):
        Puppet(**settings)
    with pytest.raises(StudioError, match="shows lasso, open, closed, unknown"):
        PUPPET.sign(PUPPET.start(), "left", HandState.NOT_TRACKED)
