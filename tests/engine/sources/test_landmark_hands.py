import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from studio.engine.skeleton import HandState
from studio.engine.sources.landmark_hands import hand_state, in_meters, joints_of

FINGERS = {"index": 0.025, "middle": 0.0, "ring": -0.02, "little": -0.04}  # [m] aside the palm
OPEN, CLOSED, LASSO = (0, 0, 0, 0), (100, 100, 100, 100), (0, 0, 100, 100)


def hand(flexions, thumb=30.0, turn=None, size=1.0) -> np.ndarray:
    """A hand (21, 3) with its fingers bent by so many degrees at the first and the second joint.

    The palm points along y; a finger bends toward -z, half as much at its last joint.
    """
    points = np.zeros((21, 3))
    roots = [np.array([aside, 0.09 - abs(aside) / 4, 0.0]) for aside in FINGERS.values()]
    for finger, (root, flexion) in enumerate(zip(roots, flexions, strict=True)):
        at, angle = root, np.radians(flexion) * 0.8
        points[5 + 4 * finger] = at
        for bone, length in enumerate((0.04, 0.025, 0.02)):
            at = at + length * np.array([0.0, np.cos(angle), -np.sin(angle)])
            points[6 + 4 * finger + bone] = at
            angle += np.radians(flexion) * (1.0, 0.5, 0.0)[bone]
    spread = np.radians(thumb)
    for bone in range(4):
        points[1 + bone] = (bone + 1) * 0.025 * np.array([np.sin(spread), np.cos(spread), 0.0])
    turned = points if turn is None else turn.apply(points)
    return size * turned


turns = st.integers(0, 2**32 - 1).map(lambda seed: Rotation.random(random_state=seed))


@settings(deadline=None, derandomize=True, max_examples=60)
@given(turns, st.floats(1e-3, 1e3), st.sampled_from([OPEN, CLOSED, LASSO]), st.floats(0, 90))
def test_states_do_not_depend_on_turn_size_place_and_thumb(turn, size, flexions, thumb):
    points = hand(flexions, thumb, turn, size) + 3.0 * size
    expected = {OPEN: HandState.OPEN, CLOSED: HandState.CLOSED, LASSO: HandState.LASSO}
    found = hand_state(points)
    assert found.state is expected[flexions]
    assert found.confidence > 0.9


@pytest.mark.parametrize(
    "flexions", [(0, 100, 100, 100), (0, 0, 0, 100), (100, 0, 0, 0), (0, 100, 100, 0)]
)
def test_other_shapes_are_unknown(flexions):
    found = hand_state(hand(flexions))
    assert found.state is HandState.UNKNOWN
    assert found.confidence > 0.9


def test_confidence_falls_to_a_half_on_the_way_from_one_state_to_the_next():
    """Half bent, a hand is nothing for sure."""
    states = [hand_state(hand((bend,) * 4)) for bend in np.linspace(0, 100, 60)]
    names = [each.state for each in states]
    assert names == sorted(names, key=[HandState.OPEN, HandState.CLOSED].index)
    sure = [each.confidence for each in states]
    turn = int(np.argmin(sure))
    assert sure[0] == sure[-1] == 1.0
    assert 0.5 < sure[turn] < 0.56
    assert np.all(np.diff(sure[: turn + 1]) <= 1e-12)
    assert np.all(np.diff(sure[turn:]) >= -1e-12)


def test_a_noisy_hand_keeps_its_state():
    """Landmarks are off by a few millimeters, in depth by more."""
    rng = np.random.default_rng(5)
    kept = 0
    for flexions in (OPEN, CLOSED, LASSO) * 100:
        points = hand(flexions, turn=Rotation.random(random_state=rng))
        noisy = points + rng.normal(size=(21, 3)) * [0.003, 0.003, 0.005]
        kept += hand_state(noisy).state is hand_state(points).state
    assert kept > 0.97 * 300


@pytest.mark.parametrize("points", [np.zeros((21, 3)), np.full((21, 3), 0.5)])
def test_a_hand_without_size_tells_nothing(points):
    found = hand_state(points)
    assert (found.state, found.confidence) == (HandState.UNKNOWN, 0.5)
    assert in_meters(points) is None


@settings(deadline=None, derandomize=True, max_examples=40)
@given(turns, st.floats(1e-2, 1e4))
def test_any_hand_is_brought_to_a_grown_ups_size(turn, size):
    shape = in_meters(hand(OPEN, turn=turn, size=size) + 7.0 * size)
    assert np.allclose(shape, turn.apply(hand(OPEN)), atol=1e-9)
    joints = joints_of(shape)
    assert np.linalg.norm(joints["hand_tip"]) == pytest.approx(0.175)
    assert np.linalg.norm(joints["thumb"]) == pytest.approx(0.1)
    assert 0.04 < np.linalg.norm(joints["hand"]) < 0.07
