import pytest

from studio.engine.errors import StudioError
from studio.engine.skeleton import HandState
from studio.engine.sources.kinect2_fields import body_id_of, check_new, hand_of, is_person

WORDS = ("unknown", "nottracked", "open", "closed", "lasso")


@pytest.mark.parametrize(("number", "state"), list(enumerate(HandState)))
def test_numbers_and_words_are_the_same_states(number, state):
    for value in (number, WORDS[number]):
        hand = hand_of({"leftHandState": value}, "leftHandState")
        assert (hand.state, hand.confidence) == (state, 1.0)
    assert hand_of({}, "leftHandState").state is HandState.UNKNOWN


@pytest.mark.parametrize("value", [5, -1, True, 1.0, None, [], "Open", "not_tracked"])
def test_other_states_are_refused_by_their_key(value):
    with pytest.raises(StudioError, match='"rightHandState" as 0 to 4 or one of unknown, nottr'):
        hand_of({"rightHandState": value}, "rightHandState")


@pytest.mark.parametrize("told", [False, 0])
def test_a_seat_is_empty_only_where_that_is_said(told):
    assert not is_person({"tracked": told})
    assert all(map(is_person, ({}, {"tracked": True}, {"tracked": 1})))


def test_ids_are_whole_numbers_or_words():
    assert body_id_of(72057594037928243, "id") == "72057594037928243"
    assert body_id_of("a b", "id") == "a b"
    for value in (True, 1.5, None, [], "", "x" * 101, "a\n"):
        with pytest.raises(StudioError, match="id"):
            body_id_of(value, "id")
    check_new("a", {"b"})
    with pytest.raises(StudioError, match="each id once in a frame, found a twice"):
        check_new("a", {"a": 1})
