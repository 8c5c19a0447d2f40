"""What a program is answered, and what it may: decided without a socket."""

import itertools
import json
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from studio.engine import commands
from studio.engine.remote import outbox
from studio.engine.remote.guest import FLOOD, MOST_UNREADABLE, MOST_WAITING, Subscription
from studio.engine.remote.outbox import MOST_ANSWERS
from studio.engine.remote.reception import CLOSED, LeaveError
from studio.engine.robot import CONTROL_RATE, JOINT_NAMES
from studio.engine.seat import PATIENCE
from studio.engine.snapshot import Mode
from studio.engine.uploads import Uploads
from studio.remote.asked import SLOWEST
from tests.engine.remote.receiving import Hall, open_hall


@pytest.fixture
def hall(tmp_path: Path):
    with open_hall(tmp_path) as opened:
        yield opened


def test_it_says_first_what_there_is_to_drive(hall: Hall) -> None:
    (welcome,) = hall.told(hall.enter())
    assert welcome["type"] == "welcome"
    assert welcome["joints"][0] == "left_s0"
    assert len(welcome["joints"]) == 15


def test_a_request_is_answered_after_the_tick_in_which_it_took_effect(hall: Hall) -> None:
    guest = hall.enter()
    hall.told(guest)
    asked = {"type": "do", "id": 5, "command": {"type": "use_demonstrator"}}
    assert hall.ask(guest, asked) == []
    hall.tick()
    (answer,) = hall.told(guest)
    assert answer == {"type": "done", "id": 5, "words": hall.session.snapshot.message.text}
    assert hall.session.snapshot.source is not None


def test_without_an_id_nobody_answers_unless_it_is_wrong(hall: Hall) -> None:
    guest = hall.enter()
    hall.told(guest)
    for kind in ("use_demonstrator", "stop"):
        hall.ask(guest, {"type": "do", "command": {"type": kind}})
    hall.tick()
    assert hall.told(guest) == []
    hall.ask(guest, {"type": "do", "command": {"type": "choose", "number": 9}})
    hall.tick()
    (complaint,) = hall.told(guest)
    assert (complaint["type"], complaint["id"]) == ("error", None)


def test_complaints_about_targets_come_once_a_second(hall: Hall) -> None:
    guest = hall.enter()
    hall.told(guest)
    heard = []
    for _ in range(60):
        heard += hall.ask(guest, {"type": "set_joint_target", "targets": {"left_w9": 0.0}})
        hall.tick()
        heard += hall.told(guest)
    assert 2 <= len(heard) <= 3
    assert "cannot be driven" in heard[0]["words"]


def test_targets_are_refused_while_somebody_teaches_and_say_nothing_on_the_page(hall: Hall) -> None:
    guest = hall.enter()
    hall.do(guest, "use_demonstrator")
    hall.do(guest, "record")
    said = hall.session.snapshot.message
    (error,) = hall.ask(guest, {"type": "set_joint_target", "targets": {"left_s0": 0.0}})
    assert "send stop first" in error["words"]
    hall.tick()
    assert hall.session.snapshot.message is said
    assert hall.session.snapshot.mode is Mode.RECORDING


@pytest.mark.parametrize("what", ["joint_states", "gate", "block", "snapshot"])
def test_everybody_may_read(hall: Hall, what: str) -> None:
    first, second = hall.enter(), hall.enter()
    hall.do(first, "stop")
    hall.told(second)
    (read,) = hall.ask(second, {"type": "get", "id": 3, "what": what})
    assert (read["type"], read["id"]) == (what, 3)


def test_only_whoever_controls_acts(hall: Hall) -> None:
    page, guest = 4, hall.enter()
    hall.seat.join(page)
    assert hall.seat.act(page) == ""
    hall.told(guest)
    for message in (
        {"type": "do", "id": 1, "command": {"type": "use_demonstrator"}},
        {"type": "take_clock", "id": 1},
    ):
        (error,) = hall.ask(guest, message)
        assert "another page controls Baxter: ask for control first" in error["words"]
    assert hall.ask(guest, {"type": "set_joint_target", "targets": {}})
    hall.tick()
    assert hall.session.snapshot.mode is Mode.IDLE


def test_a_page_is_asked_keeps_and_loses_control_to_a_program(hall: Hall) -> None:
    page, guest = 4, hall.enter()
    hall.seat.join(page)
    hall.seat.act(page)
    hall.told(guest)
    (role,) = hall.ask(guest, {"type": "control", "id": 2, "action": "ask"})
    assert (role["controls"], role["holder"], role["left"]) == (False, "another page", PATIENCE)
    assert "A program at 127.0.0.1 asks for control" in hall.seat.role(page, hall.time)
    hall.seat.answer(page, yes=False)
    hall.reception.look()
    (kept,) = hall.told(guest)
    assert (kept["type"], kept["asking"], kept["id"]) == ("role", "", None)
    hall.ask(guest, {"type": "control", "id": 3, "action": "ask"})
    hall.time += PATIENCE
    hall.reception.look()
    assert hall.told(guest)[-1]["controls"]
    assert "A program at 127.0.0.1 controls Baxter: press" in hall.seat.act(page)
    assert "a program at 127.0.0.1 controls" in hall.seat.role(page, hall.time)


def test_who_leaves_lets_go_in_words(hall: Hall) -> None:
    guest = hall.enter()
    hall.do(guest, "use_demonstrator")
    hall.do(guest, "record")
    hall.reception.leave(guest)
    hall.tick()
    assert hall.session.snapshot.mode is Mode.IDLE
    assert hall.session.snapshot.message.text.startswith(CLOSED)
    assert hall.seat.holder is None


def test_who_leaves_lets_go_whatever_becomes_of_its_files(hall: Hall, monkeypatch, caplog) -> None:
    guest, next_one = hall.enter(), hall.enter()
    hall.do(guest, "use_demonstrator")
    hall.do(guest, "record")
    hall.ask(guest, {"type": "upload", "id": 3, "content": "AAEC", "name": "mine"})
    hall.ask(next_one, {"type": "control", "id": 1, "action": "ask"})

    def fail(*_: object) -> None:
        raise OSError("the disk is gone")

    with monkeypatch.context() as broken:
        broken.setattr(Uploads, "free", fail)
        hall.reception.leave(guest)
        hall.tick()
        assert hall.session.snapshot.mode is Mode.IDLE
        assert hall.session.snapshot.message.text.startswith(CLOSED)
        assert hall.seat.holder == next_one.name
        for _ in range(3):
            hall.reception.look()
    assert hall.told(next_one)[-1]["controls"]
    assert caplog.text.count("cannot be deleted: the disk is gone") == 1
    assert hall.reception._shelf.size > 0  # what lies there takes room
    hall.reception.look()  # the disk is back
    assert hall.reception._shelf.size == 0


def test_a_clock_that_cannot_be_given_back_leaves_no_ghost_in_the_seat(hall: Hall) -> None:
    guest = hall.enter()
    hall.ask(guest, {"type": "take_clock", "id": 1})

    def fail() -> None:
        raise RuntimeError("a fault of ours")

    give, hall.steps.give = hall.steps.give, fail
    with pytest.raises(RuntimeError):
        hall.reception.leave(guest)
    assert hall.seat.holder is None
    hall.steps.give = give


def test_who_only_reads_lets_nobody_go(hall: Hall) -> None:
    first, second = hall.enter(), hall.enter()
    hall.do(first, "use_demonstrator")
    hall.do(first, "record")
    hall.reception.leave(second)
    hall.tick()
    assert hall.session.snapshot.mode is Mode.RECORDING


def test_let_go_of_control_it_stays_to_read(hall: Hall) -> None:
    guest = hall.enter()
    hall.do(guest, "stop")
    (role,) = hall.ask(guest, {"type": "control", "id": 1, "action": "let_go"})
    assert (role["controls"], role["holder"]) == (False, "")
    assert hall.ask(guest, {"type": "get", "id": 3, "what": "gate"})


@pytest.mark.parametrize(("rate", "every"), [(30.0, 1), (15.0, 2), (10.0, 3), (1.0, 30)])
def test_a_stream_tells_every_so_many_ticks(hall: Hall, rate: float, every: int) -> None:
    guest = hall.enter()
    hall.ask(guest, {"type": "subscribe", "id": 1, "stream": "block", "rate": rate})
    seen = []
    for _ in range(2 * every):
        hall.tick()
        seen += [each["tick"] for each in hall.told(guest)]
    assert seen == [every, 2 * every]
    hall.ask(guest, {"type": "unsubscribe", "id": 2, "stream": "block"})
    hall.tick(2 * every)
    assert hall.told(guest) == []


@pytest.mark.parametrize("rate", [29.9, 25.0, 20.0, 12.0, 7.3, 0.25, SLOWEST])
def test_any_rate_is_kept_on_average_and_never_exceeded(rate: float) -> None:
    begun, ticks = 17, round(100 * CONTROL_RATE / rate)
    subscription = Subscription(rate, begun)
    due = [tick for tick in range(begun + 1, begun + ticks + 1) if subscription.is_due(tick)]
    assert len(due) == pytest.approx(ticks * rate / CONTROL_RATE, abs=1.0)
    for count, tick in enumerate(due, start=1):
        assert count <= (tick - begun) * rate / CONTROL_RATE * (1 + 1e-12)
    gaps = {after - before for before, after in itertools.pairwise(due)}
    assert max(gaps) - min(gaps) <= 1  # frames are spread evenly


def test_a_stream_that_does_not_divide_the_ticks_comes_as_often_as_asked(hall: Hall) -> None:
    guest = hall.enter()
    hall.tick(5)
    hall.ask(guest, {"type": "subscribe", "id": 1, "stream": "block", "rate": 25.0})
    seen = []
    for _ in range(60):
        hall.tick()
        seen += hall.told(guest)
    assert len(seen) == 50


@pytest.mark.parametrize("rate", [1e-308, 0.0, 0.009, 30.1])
def test_a_rate_that_cannot_be_is_refused_with_its_place(hall: Hall, rate: float) -> None:
    guest = hall.enter()
    hall.told(guest)
    asked = {"type": "subscribe", "id": 1, "stream": "block", "rate": rate}
    hall.overheard.garbage.add(json.dumps(asked))
    (error,) = hall.ask(guest, asked)
    assert (error["type"], error["id"], error["place"]) == ("error", 1, "$.rate")
    hall.tick(3)
    assert hall.told(guest) == []


def test_who_reads_slowly_loses_frames_that_are_counted_and_no_answer(hall: Hall) -> None:
    guest = hall.enter()
    hall.ask(guest, {"type": "subscribe", "id": 1, "stream": "gate"})
    hall.ask(guest, {"type": "subscribe", "id": 2, "stream": "block"})
    for _ in range(10):
        hall.send(guest, '{"type": "get", "id": 3, "what": "gate"}')
        hall.tick()
    told = hall.told(guest)
    assert [each["id"] for each in told[:-2]] == [3] * 10
    assert {(each["type"], each["tick"], each["missed"]) for each in told[-2:]} == {
        ("gate", 10, 9),
        ("block", 10, 9),
    }


def test_a_crowd_of_commands_is_refused(hall: Hall) -> None:
    guest = hall.enter()
    hall.told(guest)
    refused = []
    for number in range(2 * MOST_WAITING):
        asked = {"type": "do", "id": number, "command": {"type": "forget_kept"}}
        refused += hall.ask(guest, asked)
    assert [each["id"] for each in refused] == list(range(MOST_WAITING, 2 * MOST_WAITING))
    hall.tick()
    assert len(hall.told(guest)) == MOST_WAITING


def test_a_target_that_is_asked_for_is_answered_though_newer_ones_replace_it(hall: Hall) -> None:
    guest = hall.enter()
    hall.told(guest)
    for number in range(3 * MOST_WAITING):
        target = {"type": "set_joint_target", "targets": {"left_s0": 0.01 * number}}
        assert hall.ask(guest, {"type": "do", "id": number, "command": target}) == []
        assert hall.ask(guest, {**target, "targets": {"left_s1": 0.0}}) == []
        if number % MOST_WAITING == MOST_WAITING - 1:
            hall.tick()
            answered = [each["id"] for each in hall.told(guest)]
            assert answered == list(range(number - MOST_WAITING + 1, number + 1))


def test_floods_and_garbage_are_sent_away(hall: Hall) -> None:
    flooding, babbling, deaf = hall.enter(), hall.enter(), hall.enter()
    hall.overheard.garbage.add("?")
    for guest, message, enough, words in (
        (flooding, '{"type": "set_joint_target"}', round(FLOOD), "too fast: more than 5,000"),
        (babbling, "?", MOST_UNREADABLE, "cannot be read"),
        (deaf, '{"type": "get", "id": 1, "what": "gate"}', MOST_ANSWERS, "does not read"),
    ):
        for _ in range(enough):
            hall.send(guest, message)
        with pytest.raises(LeaveError, match=words):
            hall.send(guest, message)
    assert all(each["type"] == "error" for each in hall.told(babbling)[1:])


def test_who_asks_for_much_and_reads_nothing_is_sent_away_and_nobody_else(
    hall: Hall, monkeypatch
) -> None:
    """Far below the number of answers that may lie, by their size alone."""
    monkeypatch.setattr(outbox, "MOST_BYTES", 100_000)
    deaf, reading = hall.enter(), hall.enter()
    asked = {"type": "get", "id": 1, "what": "snapshot"}
    answers = 0
    while not deaf.outbox.is_full:
        hall.send(deaf, json.dumps(asked))
        answers += 1
        assert hall.ask(reading, asked)[-1]["type"] == "snapshot"
    with pytest.raises(LeaveError, match="does not read its answers"):
        hall.send(deaf, json.dumps(asked))
    assert 2 < answers < MOST_ANSWERS
    assert deaf.outbox._size < 2 * 100_000
    hall.reception.leave(deaf)
    hall.tick()
    assert hall.ask(reading, asked)[-1]["type"] == "snapshot"


def test_one_has_the_clock_at_a_time(hall: Hall) -> None:
    guest = hall.enter()
    hall.told(guest)
    hall.steps.take(5.0, lambda _: None, lambda: None)
    (error,) = hall.ask(guest, {"type": "take_clock", "id": 1})
    assert "has the clock already" in error["words"]


def test_the_clock_is_not_lent_while_a_robot_beyond_the_simulator_is_linked(hall: Hall) -> None:
    guest = hall.enter()
    assert hall.do(guest, "connect_link", url="simulated://")["type"] == "done"
    hall.tick()
    (error,) = hall.ask(guest, {"type": "take_clock", "id": 1})
    assert "goes by real time: disconnect it first" in error["words"]
    hall.do(guest, "disconnect_link")
    hall.tick()
    assert hall.ask(guest, {"type": "take_clock", "id": 1}) == []
    assert hall.steps.is_held
    command = {"type": "connect_link", "url": "simulated://"}
    (error,) = hall.ask(guest, {"type": "do", "id": 2, "command": command})
    assert "give the clock back first" in error["words"]


COMMANDS = [
    {"type": "do", "id": 1, "command": {"type": "use_demonstrator"}},
    {"type": "do", "id": 1, "command": {"type": "record"}},
    {"type": "do", "command": {"type": "watch"}},
    {"type": "do", "id": 1, "command": {"type": "stop"}},
    {"type": "do", "id": 1, "command": {"type": "calibrate"}},
    {"type": "do", "id": 1, "command": {"type": "step_by", "ticks": -(2**60)}},
    {"type": "do", "id": 1, "command": {"type": "scrub", "position": 1e300}},
    {"type": "do", "id": 1, "command": {"type": "place_block", "x": -1e300, "y": 1e300}},
    {"type": "do", "id": 1, "command": {"type": "put_block_back"}},
    {"type": "do", "id": 1, "command": {"type": "place_start", "index": 2**60, "u": 1, "v": 1}},
    {"type": "do", "id": 1, "command": {"type": "trim", "number": 1, "begin": 9.0, "end": -9.0}},
    {"type": "do", "id": 1, "command": {"type": "rename", "number": -5, "name": "\u0000"}},
    {"type": "do", "id": 1, "command": {"type": "train", "learner": {"neurons": -1}}},
    {"type": "do", "id": 1, "command": {"type": "use_puppet"}},
    {
        "type": "do",
        "id": 1,
        "command": {"type": "drag_hand", "side": "left", "point": [1e300, -1e300, 0.0]},
    },
    {"type": "do", "id": 1, "command": {"type": "choose_scene", "scene": "/etc/passwd"}},
    {"type": "do", "id": 1, "command": {"type": "show_leg", "leg": 2**60}},
    {"type": "do", "id": 1, "command": {"type": "let_go", "why": "<b>no</b>"}},
    {"type": "do", "id": 1, "command": {"type": "configure", "choices": {"arms": "both"}}},
    {
        "type": "do",
        "id": 1,
        "command": {"type": "configure", "choices": {"hands": {"gripper": True}}},
    },
    {"type": "set_joint_target", "targets": {"left_s0": 1e300, "left_s1": -1e300}},
    {"type": "set_joint_target", "targets": {}, "closed": True},
    {"type": "control", "id": 1, "action": "let_go"},
    {"type": "subscribe", "id": 1, "stream": "snapshot", "rate": 30},
    {"type": "fetch", "id": 1, "what": "lesson"},
]


@settings(
    deadline=None,
    derandomize=True,
    max_examples=6,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(st.lists(st.sampled_from(COMMANDS), min_size=5, max_size=25))
def test_whatever_is_asked_in_whatever_order_no_fault_of_ours_comes_of_it(
    tmp_path_factory, asked: list[dict]
) -> None:
    with open_hall(tmp_path_factory.mktemp("hall")) as hall:
        guest = hall.enter()
        for message in asked:
            hall.ask(guest, message)
            hall.tick(2)
            assert "fault" not in hall.session.snapshot.message.text.lower()
            told = hall.told(guest)
            assert all("fault" not in json.dumps(each).lower() for each in told)
        hall.ask(guest, {"type": "get", "id": 9, "what": "snapshot"})


def test_who_only_watches_may_stop_the_robot_all_the_same(hall: Hall) -> None:
    first, second = hall.enter(), hall.enter()
    hall.do(first, "use_demonstrator")
    hall.do(first, "record")
    assert "ask for control" not in hall.do(second, "stop")["words"]
    assert hall.session.snapshot.mode is Mode.IDLE
    hall.do(first, "connect_link", url="simulated://")
    for kind in ("stop_link", "disable_link"):
        assert "ask for control" not in hall.do(second, kind)["words"]
    assert hall.seat.holder == first.name


def test_the_clock_ends_where_a_robot_is_linked_after_it_was_taken(hall: Hall) -> None:
    guest = hall.enter()
    assert hall.ask(guest, {"type": "take_clock", "id": 1})[1:] == []
    hall.session.post(commands.ConnectLink("simulated://"))
    hall.session.hear()
    assert hall.session.snapshot.link.url == "simulated://"
    hall.told(guest)
    hall.reception.look()
    assert not hall.steps.is_held
    error = next(each for each in hall.told(guest) if each["type"] == "error")
    assert (error["id"], "goes by real time" in error["words"]) == (1, True)


def test_a_clock_given_back_before_the_world_stood_still_is_answered(hall: Hall) -> None:
    guest = hall.enter()
    hall.ask(guest, {"type": "take_clock", "id": 1})
    error, done = hall.ask(guest, {"type": "give_clock", "id": 2})
    assert (error["type"], error["id"]) == ("error", 1)
    assert (done["type"], done["id"]) == ("done", 2)


@pytest.mark.parametrize("count", [1, 16])
def test_names_of_no_joint_never_reach_the_engine(hall: Hall, count: int) -> None:
    guest = hall.enter()
    hall.told(guest)
    target = {"type": "set_joint_target", "targets": dict.fromkeys(map(str, range(count)), 0.0)}
    asked = {"type": "do", "id": 1, "command": target}
    if count > len(JOINT_NAMES):  # more than there can be: the schema says so, too
        hall.overheard.garbage |= {json.dumps(target), json.dumps(asked)}
    posted = []
    hall.session.post = lambda command, *_: posted.append(command)
    (error,) = hall.ask(guest, asked)
    assert error["id"] == 1
    assert hall.ask(guest, target)[0]["type"] == "error"
    assert posted == []


def test_words_that_are_no_characters_are_told_with_replacements(hall: Hall) -> None:
    guest = hall.enter()
    hall.told(guest)
    hall.reception._refuse(guest, 1, "no\udcff")
    assert hall.told(guest)[0]["words"] == "no?"
