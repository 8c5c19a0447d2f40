"""The newest frame wins, every message is accounted for, and another stream is another person."""

import threading

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.errors import StudioError
from studio.engine.live.source import RESTARTED, LiveSource
from studio.engine.skeleton import Hand, HandState
from studio.engine.sources.family import Frame
from studio.engine.sources.following import PATIENCE
from tests.engine.live.streaming import Clock
from tests.engine.people import person

SETTINGS = settings(deadline=None, derandomize=True)


def frame(time: float, *ids: str) -> Frame:
    return Frame(time, tuple(person(time, body_id=body_id) for body_id in ids or ("7",)))


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def live(clock: Clock) -> LiveSource:
    source = LiveSource(clock)
    source.drive("publisher 1", "studio jsonl")
    return source


def accounted(live: LiveSource) -> tuple[int, int]:
    counts = live.status().counts
    parts = [getattr(counts, name) for name in counts.__dataclass_fields__ if name != "received"]
    return counts.received, sum(parts)


def test_the_newest_frame_wins_and_is_taken_once(live: LiveSource) -> None:
    assert live.take() is None
    for n in range(5):
        assert live.put(frame(n / 30), 100.0 + n / 30, True) == ""
    taken = live.take()
    assert taken is not None
    assert taken.skeleton.time == 4 / 30
    assert live.take() is None
    counts = live.status().counts
    assert (counts.received, counts.used, counts.dropped) == (5, 1, 4)


def test_late_and_out_of_order_frames_are_told_and_dropped(live: LiveSource) -> None:
    live.put(frame(1.0), 100.0, True)
    for stamp in (1.0, 0.9, 1.0 - RESTARTED):
        assert "late" in live.put(frame(stamp), 100.1, True)
    assert live.take().skeleton.time == 1.0
    assert live.status().counts.late == 3
    assert live.put(frame(1.1), 100.2, True) == ""


def test_a_clock_set_back_is_another_stream(live: LiveSource) -> None:
    live.put(frame(1e6), 100.0, True)
    before = live.take()
    assert live.put(frame(0.0), 100.1, True) == ""
    after = live.take()
    assert after.stream == before.stream + 1
    assert after.skeleton.body_id != before.skeleton.body_id


def test_another_driver_is_another_person(live: LiveSource) -> None:
    live.put(frame(1.0), 100.0, True)
    first = live.take()
    live.put(frame(1.1), 100.1, True)
    live.leave()
    assert live.take() is None
    live.drive("publisher 2", "node-kinect2")
    assert live.take() is None  # what the last driver left is nobody's
    live.put(frame(0.5), 100.2, False)
    assert live.take().skeleton.body_id != first.skeleton.body_id


def test_a_long_id_stays_readable(live: LiveSource) -> None:
    live.put(frame(1.0, "x" * 100), 100.0, True)
    assert len(live.take().skeleton.body_id) <= 100


def test_a_frame_with_nobody_is_news_too(live: LiveSource) -> None:
    live.put(frame(1.0), 100.0, True)
    live.put(Frame(1.1), 100.1, True)
    assert live.take().skeleton is None


def test_the_followed_person_is_waited_for_by_our_clock(live: LiveSource) -> None:
    """Whatever the stamps say: a passer-by takes over only after the wait, as in a file."""
    live.put(frame(0.0, "a"), 100.0, True)
    for n in range(1, 10):
        live.put(frame(1000.0 * n, "b"), 100.0 + n / 30, True)
    assert live.take().skeleton.body_id.endswith("a")
    assert live.status().counts.others == 9
    live.put(frame(1e5, "b"), 100.0 + PATIENCE + 0.1, True)
    assert live.take().skeleton.body_id.endswith("b")


@SETTINGS
@given(
    st.lists(
        st.one_of(
            st.tuples(st.just("put"), st.floats(-3, 3), st.sampled_from(["", "a", "b", "ab"])),
            st.tuples(st.sampled_from(["take", "drive", "leave", "late", "unreadable", "waiting"])),
        ),
        max_size=40,
    )
)
def test_every_message_is_accounted_for(events) -> None:
    clock = Clock()
    live = LiveSource(clock)
    live.drive("publisher 1", "studio jsonl")
    for kind, *rest in events:
        clock.time += 0.1
        match kind:
            case "put":
                bodies = tuple(person(rest[0], body_id=name) for name in rest[1])
                live.put(Frame(rest[0], bodies), clock.time, True)
            case "take":
                live.take()
            case "drive":
                live.drive("another", "node-kinect2")
            case "leave":
                live.leave()
            case _:
                live.count(kind)
    live.take()  # nothing is pending any more
    received, parts = accounted(live)
    assert received == parts


def test_whoever_is_chosen_is_followed_while_there(live: LiveSource, clock: Clock) -> None:
    def sees(at: float, *ids: str) -> str | None:
        clock.time = at
        live.put(frame(at, *ids), at, True)
        taken = live.take()
        return None if taken is None or taken.skeleton is None else taken.skeleton.body_id

    assert sees(100.0, "7", "9") == "1:7"
    assert live.status().bodies == ("7", "9")
    live.follow("9")
    assert live.status().followed == "9"
    assert sees(100.1, "7", "9") == "1:9"
    assert sees(100.1 + PATIENCE, "7") is None  # waited for
    assert sees(100.2 + PATIENCE, "7") == "1:7"  # who is there goes on
    live.follow("9")  # out of sight for less than a second
    assert sees(100.3 + PATIENCE, "7", "9") == "1:9"
    live.follow(None)
    assert sees(100.4 + PATIENCE, "7", "9") == "1:7"
    sees(102.0, "7")
    assert live.status().bodies == ("7",)
    with pytest.raises(StudioError, match="not in sight"):
        live.follow("9")


def test_rate_and_age_tell_whether_frames_come(live: LiveSource, clock: Clock) -> None:
    assert (live.status().rate, live.status().age) == (0.0, None)
    for _ in range(40):
        clock.time += 1 / 30
        live.put(frame(clock.time), clock.time, True)
    assert live.status().rate == pytest.approx(30.0)
    assert live.status().is_flowing
    clock.time += 5.0
    assert (live.status().rate, live.status().age) == (0.0, 5.0)


def test_the_latency_chain_adds_up(live: LiveSource, clock: Clock) -> None:
    for n in range(20):
        clock.time = 200.0 + n
        live.put(frame(float(n)), clock.time, True)
        clock.time += 0.020
        live.take()
        clock.time += 0.003
        live.command_given(0.5)
        live.command_given(None)  # of a tick without a frame: nothing to measure
    chain = live.status().latency
    assert chain.transit.p99 == pytest.approx(0.0)
    assert chain.waiting.p50 == pytest.approx(0.020)
    assert chain.computing.p50 == pytest.approx(0.003)
    assert chain.total.p50 == pytest.approx(0.023)
    assert chain.limiting.p99 == 0.5


def test_without_stamps_the_way_from_the_sensor_is_unknown(live: LiveSource) -> None:
    live.put(frame(1.0), 100.0, False)
    assert live.status().latency.transit is None


def test_hands_are_believed_to_be_told_until_many_frames_tell_none(live: LiveSource) -> None:
    for n in range(100):
        assert live.status().tells_hands is (n < 90)
        live.put(frame(n / 30), 100.0 + n / 30, True)
    open_handed = person(99.0, body_id="7", hand=HandState.OPEN)
    assert open_handed.left_hand == Hand(HandState.OPEN)
    live.put(Frame(99.0, (open_handed,)), 110.0, True)
    assert live.status().tells_hands


def test_threads_neither_lose_nor_invent_frames() -> None:
    clock = Clock()
    live = LiveSource(clock)
    live.drive("publisher 1", "studio jsonl")
    sent = [frame(float(n)) for n in range(2000)]
    taken: list[float] = []
    done = threading.Event()

    def take() -> None:
        while not done.is_set():
            if (newest := live.take()) is not None:
                taken.append(newest.skeleton.time)

    thread = threading.Thread(target=take)
    thread.start()
    for each in sent:
        live.put(each, 100.0, True)
    done.set()
    thread.join()
    live.take()
    received, parts = accounted(live)
    assert (received, parts) == (2000, 2000)
    assert taken == sorted(set(taken))
