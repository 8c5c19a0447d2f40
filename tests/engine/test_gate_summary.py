"""Frames armed and frames not armed add up, whatever the gate thought."""

import json

from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.gate import Gate, GateStatus
from studio.engine.gate_summary import gate_statuses, summarize
from studio.engine.skeleton import HandState
from tests.engine.people import hand_stream, held


def status(armed: bool, reason: str = "") -> GateStatus:
    return GateStatus(armed, 0, reason, reason, HandState.UNKNOWN, 0.0, 0.3)


def test_when_and_why_not() -> None:
    found = summarize(
        [status(False, "a"), status(True), status(True), *[status(False, "b")] * 2, status(True)]
    )
    assert found.armed == ((1, 2), (5, 5))
    assert found.reasons == (("b", 2), ("a", 1))
    assert str(found) == "armed in 3 of 6 (1-2, 5-5); b (2), a (1)"
    assert found.to_dict()["armed"] == [{"first": 1, "last": 2}, {"first": 5, "last": 5}]


def test_of_a_stream_it_is_what_the_gate_says() -> None:
    signs = (HandState.LASSO, HandState.OPEN, HandState.CLOSED)
    stream = hand_stream(held(*((sign, 15) for sign in signs)))
    found = summarize(gate_statuses(Gate(), stream))
    assert found.armed == ((39, 44),)
    assert dict(found.reasons)["waiting for Open of the left hand"] == 15
    assert "never armed" in str(summarize(gate_statuses(Gate(), hand_stream([HandState.OPEN]))))


@settings(deadline=None, derandomize=True)
@given(st.lists(st.tuples(st.booleans(), st.sampled_from("xyz"))))
def test_every_frame_is_counted_once(frames: list[tuple[bool, str]]) -> None:
    found = summarize(status(armed, "" if armed else reason) for armed, reason in frames)
    assert found.frames == len(frames)
    assert found.armed_frames + sum(count for _, count in found.reasons) == len(frames)
    assert json.dumps(found.to_dict())
