"""Answers keep their order, streams their newest frame; slow readers are counted, never awaited."""

import msgspec
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.remote.outbox import MOST_ANSWERS, MOST_BYTES, Outbox
from studio.remote.told import Done, Gate, Told

STREAMS = ("joint_states", "gate", "block", "snapshot")


def following(outbox: Outbox) -> Told | None:
    """What is sent next, as whoever reads it understands it."""
    text = outbox.next()
    return None if text is None else msgspec.json.decode(text, type=Told)


@settings(deadline=None, derandomize=True)
@given(st.lists(st.sampled_from(("answer", "offer", "next", *STREAMS)), max_size=60))
def test_nothing_is_lost_but_frames_and_those_are_counted(steps: list[str]) -> None:
    woken: list[int] = []
    outbox = Outbox(lambda: woken.append(1))
    asked, heard, offered, told, missed = [], [], {}, {}, {}
    for number, step in enumerate(steps):
        if step == "answer":
            asked.append(number)
            outbox.answer(Done(number))
        elif step in STREAMS:
            offered[step] = [*offered.get(step, []), number]
            outbox.offer(step, Gate(tick=number, gate=None, held=step))
        elif step == "next" and (each := following(outbox)) is not None:
            _take(each, heard, told, missed)
    while (each := following(outbox)) is not None:
        _take(each, heard, told, missed)
    assert heard == asked
    for stream, ticks in offered.items():
        assert told[stream][-1] == ticks[-1]  # the newest is never lost
        assert missed[stream] + len(told[stream]) == len(ticks)
    assert len(woken) == len(asked) + sum(map(len, offered.values()))


def _take(each, heard, told, missed) -> None:
    if isinstance(each, Done):
        heard.append(each.id)
    else:
        told.setdefault(each.held, []).append(each.tick)
        missed[each.held] = each.missed


def test_answers_that_nobody_reads_fill_it() -> None:
    outbox = Outbox(lambda: None)
    for number in range(MOST_ANSWERS):
        outbox.answer(Done(number))
    assert not outbox.is_full
    outbox.answer(Done(0))
    assert outbox.is_full


def test_answers_are_weighed_as_they_are_sent_and_one_alone_may_be_of_any_size() -> None:
    outbox = Outbox(lambda: None)
    large = Done(1, "x" * (MOST_BYTES // 3))
    outbox.answer(Done(0, "x" * 2 * MOST_BYTES))
    for _ in range(2):
        outbox.answer(large)
    assert not outbox.is_full
    outbox.answer(large)
    assert outbox.is_full
    for _ in range(2):  # who reads them goes on
        outbox.next()
    assert not outbox.is_full
    while outbox.next() is not None:
        pass
    assert outbox._size == 0


def test_of_whoever_has_gone_nothing_is_kept() -> None:
    outbox = Outbox(lambda: None)
    outbox.answer(Done(0))
    outbox.offer("gate", Gate(tick=1, gate=None, held=""))
    outbox.clear()
    assert (outbox.next(), outbox._size) == (None, 0)


def test_what_is_not_wanted_any_more_is_not_sent() -> None:
    outbox = Outbox(lambda: None)
    outbox.offer("gate", Gate(tick=1, gate=None, held=""))
    outbox.offer("gate", Gate(tick=2, gate=None, held=""))
    outbox.forget("gate")
    assert outbox.next() is None
    outbox.offer("gate", Gate(tick=3, gate=None, held=""))
    assert following(outbox) == Gate(tick=3, gate=None, held="", missed=0)
