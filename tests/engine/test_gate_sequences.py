"""The gate against an independent reference, over every sequence of hand states up to a length.

The reference writes down what a hand showed as text, and says by one regular expression where in it
the gate arms and by another where it disarms. A cell of 1/15 s is one of

    l o c   Lasso, Open, Closed shown
    .       unknown or not tracked
    _       no body

and between two cells may stand what has just become true:

    L O C   the sign is believed: seen for 0.3 s since another sign or a long loss
    H       Lasso has been seen for 0.5 s
    !       the sign is forgotten: the hand was lost for more than 0.8 s
    x       nothing is left: no body for more than 0.5 s, or another one
"""

import random
import re
from collections.abc import Iterator, Sequence
from itertools import product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine import gate as gate_module
from studio.engine.gate import Gate, GateMemory
from studio.engine.gate_machine import TRANSITIONS, Event, Phase, transition
from studio.engine.signs import NANOSECONDS
from studio.engine.skeleton import HandState, Skeleton
from tests.engine.people import person

CELLS = 15  # a second
FRAMES: dict[str, Skeleton | None] = {
    "L": person(hand=HandState.LASSO),
    "O": person(hand=HandState.OPEN),
    "C": person(hand=HandState.CLOSED),
    "U": person(hand=HandState.UNKNOWN),
    "N": person(hand=HandState.NOT_TRACKED),
    "_": None,
    "X": person(hand=HandState.OPEN, body_id="another"),
}
# Each sign too short and long enough to be believed, and a Lasso that disarms; losses that are
# bridged, too long before arming, and too long while armed; hands that fidget until it is too late.
HAND_SEGMENTS = (
    *(sign * cells for sign, cells in product("LOC", (3, 6))),
    *("L" * 9, "U" * 11, "U" * 13, "U" * 33),
    *("CCOO" * 8, "CCLL" * 8),
)
BODY_SEGMENTS = ("_" * 4, "_" * 9, "XX")
STARTS = {
    Phase.WAITING: "U",
    Phase.LASSO_SEEN: "LLLLLL",
    Phase.OPEN_SEEN: "LLLLLLOOOOOO",
    Phase.ARMED: "LLLLLLOOOOOOCCCCCC",
}
GATE = Gate()
JITTER = 0.005  # [s] by which a stamp may be off where nothing is closer than that to a threshold

# Never more than 2 s, that is 30 cells, since the last sight of the newest believed sign.
ARMS = re.compile(
    r"L(?:(?:[co._][LH]?){0,30}l[LH]?)*(?:[co._][LH]?){0,30}"
    r"O(?:(?:[lc._]O?){0,30}oO?)*(?:[lc._]O?){0,30}C"
)
DISARMS = re.compile(r"H|x|\.(?:!?[._]){30}(?=[!LOC]*.)")


def debounced(shown: str) -> str:
    """Return what was shown as the module describes it."""
    text, body, seen, sign, held, lost, last = [], "", 0, "", 0, None, ""
    for now, cell in enumerate(shown):
        if body and 2 * (now - seen) > CELLS:
            text.append("x")
            body, sign, held, lost = "", "", 0, None
        if sign and lost is not None and now - lost > 12:
            text.append("!")
            sign, held = "", 0
        whose = "another" if cell == "X" else "0"
        if cell == "_":
            text.append("_")
            continue
        if body not in ("", whose):
            text.append("x_")
            body, sign, held, lost = "", "", 0, None
            continue
        if body and sign and last == sign:
            more = held + min(2 * (now - seen), 3)  # half cells; a sight lasts 0.1 s at most
            text.append(sign.upper() if held < 9 <= more else "")
            text.append("H" if sign == "l" and held < 15 <= more else "")
            held = more
        body, seen, last = whose, now, {"U": ".", "N": ".", "X": "o"}.get(cell, cell.lower())
        text.append(last)
        if last == ".":
            lost = now if lost is None else lost
        else:
            sign, held, lost = last, held if last == sign else 0, None
    return "".join(text)


def expected(shown: str) -> list[bool]:
    """Return whether the gate is armed at each cell."""
    text, turns, place = debounced(shown), [], 0
    while (turn := (DISARMS if len(turns) % 2 else ARMS).search(text, place)) is not None:
        place = turn.end()
        turns.append(sum(mark in "loc._" for mark in text[:place]))
    return [sum(turn <= cell for turn in turns) % 2 == 1 for cell in range(len(shown))]


def walk(
    memory: GateMemory | None, trace: list[bool], shown: str, alphabet: Sequence[str], length: int
) -> Iterator[tuple[str, list[bool]]]:
    """Yield every sequence of ``length`` segments, beginnings shared, and where it was armed."""
    if not length:
        yield shown, trace
        return
    for segment in alphabet:
        if shown[-1:] == segment[0]:
            continue  # the same as one longer segment
        after, armed = memory, list(trace)
        for cell, what in enumerate(segment, start=len(shown)):
            after = GATE.remember(after, FRAMES[what], round(cell * NANOSECONDS / CELLS))
            armed.append(after.phase is Phase.ARMED)
        yield from walk(after, armed, shown + segment, alphabet, length - 1)


def begun(shown: str) -> tuple[GateMemory | None, list[bool], str]:
    """Return what `walk` goes on from after something was shown."""
    memory: GateMemory | None = None
    trace = []
    for cell, what in enumerate(shown):
        memory = GATE.remember(memory, FRAMES[what], round(cell * NANOSECONDS / CELLS))
        trace.append(memory.phase is Phase.ARMED)
    return memory, trace, shown


def armed_at(shown: str, rate: int = CELLS, jitter: random.Random | None = None) -> list[bool]:
    """Return whether the gate is armed at the beginning of each cell, at some frame rate."""
    memory, armed, repeat = None, [], rate // CELLS
    for index in range(len(shown) * repeat):
        late = jitter.uniform(-JITTER, JITTER) if jitter else 0.0
        stamp = round((index / rate + late) * NANOSECONDS)
        memory = GATE.remember(memory, FRAMES[shown[index // repeat]], stamp)
        if index % repeat == 0:
            armed.append(memory.phase is Phase.ARMED)
    return armed


def test_the_reference_knows_the_plain_cases() -> None:
    assert debounced("LLLLLLO") == "lllllLlo"
    assert debounced("LLLLUUUULLL") == "llll....lLll"
    assert expected("LLLLLLOOOOOOCCCCCC") == [False] * 17 + [True]
    assert not any(expected("LLLLLLCCCCCCOOOOOO" + "L" * 9))
    assert expected("LLLLLLOOOOOOCCCCCC" + "L" * 10) == [False] * 17 + [True] * 9 + [False] * 2


def test_every_sequence_arms_and_disarms_where_the_reference_says(monkeypatch) -> None:
    """All of four segments, and all of three more from every state, on every way through."""
    taken: set[tuple[Phase, Event]] = set()

    def recorded(mode: str, phase: Phase, event: Event) -> Phase:
        after = transition(mode, phase, event)
        if after is not phase:
            taken.add((phase, event))
        return after

    monkeypatch.setattr(gate_module, "transition", recorded)
    count, armed = 0, 0
    for start, length in (("", 4), *((shown, 3) for shown in STARTS.values())):
        for shown, trace in walk(*begun(start), (*HAND_SEGMENTS, *BODY_SEGMENTS), length):
            assert trace == expected(shown), (shown, debounced(shown))
            count, armed = count + 1, armed + any(trace)
    assert count > 25_000
    assert 1_000 < armed < count
    assert taken == set(TRANSITIONS["sequence"])


@pytest.mark.parametrize("start", STARTS.values(), ids=[phase.name for phase in STARTS])
def test_the_frame_rate_does_not_matter(start: str) -> None:
    """Hands that change on a grid of 1/15 s are armed at the same cells at 15, 30 and 60 Hz."""
    for shown, trace in walk(*begun(start), HAND_SEGMENTS, 2):
        assert armed_at(shown, 30) == trace, shown
        assert armed_at(shown, 60) == trace, shown


@pytest.mark.parametrize("rate", [15, 30, 60])
def test_stamps_that_are_a_little_off_do_not_matter(rate: int) -> None:
    """The same turns, each within a cell, with every stamp up to 5 ms off."""
    jitter = random.Random(rate)
    for start in STARTS.values():
        for shown, trace in walk(*begun(start), HAND_SEGMENTS, 2):
            wanted, found = turns(trace), turns(armed_at(shown, rate, jitter))
            assert len(found) == len(wanted), shown
            assert all(abs(a - b) <= 1 for a, b in zip(found, wanted, strict=True)), shown


def turns(armed: list[bool]) -> list[int]:
    return [i for i, (a, b) in enumerate(zip([False, *armed], armed, strict=False)) if a is not b]


@settings(deadline=None, derandomize=True, max_examples=150)
@given(st.lists(st.tuples(st.sampled_from("LOCUN"), st.integers(1, 33)), max_size=25))
def test_long_sequences_too(segments: list[tuple[str, int]]) -> None:
    shown = "".join(sign * cells for sign, cells in segments)
    wanted = expected(shown)
    assert armed_at(shown) == wanted, debounced(shown)
    assert armed_at(shown, 60) == wanted
    assert armed_at(shown.replace("N", "U"), 30) == wanted


@settings(deadline=None, derandomize=True, max_examples=150)
@given(
    st.lists(
        st.sampled_from(["LLLLLL", "OOOOOO", "CCCCCC", "LLL", "UUUU", "C", "O", "U", "L" * 9]),
        max_size=20,
    )
)
def test_long_sequences_of_likely_segments_too(segments: list[str]) -> None:
    shown = "L" * 6 + "O" * 6 + "".join(segments)
    assert armed_at(shown, 30) == expected(shown), debounced(shown)
