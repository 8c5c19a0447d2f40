"""Who controls: always one browser at most, and nobody is locked out."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.seat import PATIENCE, WATCHING, Seat

BROWSERS = (1, 2, 3)


@pytest.fixture
def seat() -> Seat:
    made = Seat()
    for client in BROWSERS:
        made.join(client)
    return made


def test_a_free_seat_is_taken_by_the_first_act(seat: Seat) -> None:
    assert seat.holder is None
    assert seat.act(2) == ""
    assert seat.act(1) == WATCHING
    assert seat.act(2) == ""


def test_the_holder_hands_over_or_keeps(seat: Seat) -> None:
    seat.act(1)
    seat.ask(2, 0.0)
    assert "asks for control" in seat.role(1, 0.0)
    assert "gets it in 15 s" in seat.role(1, 0.0)
    seat.answer(2, True)  # not the holder: no answer
    assert seat.holder == 1
    seat.answer(1, False)
    assert (seat.holder, seat.asking) == (1, None)
    seat.ask(2, 0.0)
    seat.answer(1, True)
    assert (seat.holder, seat.asking) == (2, None)


def test_without_an_answer_it_goes_to_whoever_asks(seat: Seat) -> None:
    seat.act(1)
    seat.ask(2, 10.0)
    seat.ask(3, 11.0)  # the first goes first
    assert not seat.pass_on(10.0 + PATIENCE - 0.1)
    assert seat.pass_on(10.0 + PATIENCE)
    assert seat.holder == 2
    assert not seat.pass_on(1000.0)


def test_a_holder_who_leaves_makes_room(seat: Seat) -> None:
    seat.act(1)
    assert not seat.leave(3)
    assert seat.leave(1)
    assert seat.holder is None
    assert seat.act(2) == ""
    seat.join(4)
    seat.ask(4, 0.0)
    assert seat.leave(2)
    assert seat.holder == 4


def test_roles_are_told_where_there_are_others(seat: Seat) -> None:
    alone = Seat()
    alone.join(7)
    alone.act(7)
    assert alone.role(7, 0.0) == ""
    assert "whoever clicks first" in seat.role(1, 0.0)
    seat.act(1)
    assert seat.role(1, 0.0) == "You control Baxter; 2 others watch."
    assert seat.role(2, 0.0) == "You watch; another page controls Baxter."
    seat.ask(2, 0.0)
    assert "You asked" in seat.role(2, 0.0)
    seat.leave(3)
    seat.answer(1, False)
    assert seat.role(1, 0.0) == "You control Baxter; 1 other watches."


def test_whoever_is_gone_gets_nothing(seat: Seat) -> None:
    seat.leave(2)
    seat.ask(2, 0.0)
    assert seat.holder is None
    assert seat.act(2) == WATCHING


steps = st.lists(
    st.tuples(
        st.sampled_from(("join", "leave", "act", "ask", "yes", "no", "wait")),
        st.sampled_from(BROWSERS),
        st.floats(0.0, 2.0 * PATIENCE),
    ),
    max_size=40,
)


@settings(deadline=None, derandomize=True)
@given(steps)
def test_one_controls_at_most_and_is_there(taken: list[tuple[str, int, float]]) -> None:
    seat, there, now = Seat(), set(), 0.0
    for what, client, seconds in taken:
        now += seconds
        match what:
            case "join":
                seat.join(client)
                there.add(client)
            case "leave":
                seat.leave(client)
                there.discard(client)
            case "act":
                before = seat.holder
                allowed = seat.act(client) == ""
                assert allowed == (client == before or (before is None and client in there))
            case "ask":
                seat.ask(client, now)
            case "yes" | "no":
                seat.answer(client, what == "yes")
            case _:
                seat.pass_on(now)
        assert seat.holder is None or seat.holder in there
        assert seat.asking is None or (seat.asking in there and seat.asking != seat.holder)
        assert seat.present == len(there)


def test_a_program_is_named_as_one() -> None:
    seat = Seat()
    seat.join(1)
    seat.join("program 1", "a program at 127.0.0.1")
    seat.join(2)
    assert seat.act("program 1") == ""
    assert seat.act(1).startswith("A program at 127.0.0.1 controls Baxter: press")
    assert seat.role(1, 0.0) == "You watch; a program at 127.0.0.1 controls Baxter."
    seat.ask(1, 0.0)
    assert seat.role("program 1", 0.0).startswith("Another page asks for control")
    assert seat.let_go("program 1")
    assert (seat.holder, seat.present) == (1, 3)
    assert not seat.let_go("program 1")
    seat.ask("program 1", 0.0)
    assert seat.role(1, 0.0).startswith("A program at 127.0.0.1 asks for control")
    assert seat.called(None) == ""
