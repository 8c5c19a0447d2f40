"""The transition function: what arms, what disarms, and that nothing else does."""

from itertools import product

import pytest

from studio.engine import gate_machine
from studio.engine.gate_machine import GATE_MODES, TRANSITIONS, Event, Phase, transition
from studio.engine.gate_words import WHY

BODY_GONE = {Event.BODY_LOST, Event.OTHER_BODY}


def test_one_way_arms() -> None:
    ways = {way for way, after in TRANSITIONS["sequence"].items() if after is Phase.ARMED}
    assert ways == {(Phase.OPEN_SEEN, Event.CLOSED)}
    ways = {way for way, after in TRANSITIONS["open"].items() if after is Phase.ARMED}
    assert ways == {(Phase.NOBODY, Event.BODY_SEEN)}


def test_what_disarms() -> None:
    ends = {event for phase, event in TRANSITIONS["sequence"] if phase is Phase.ARMED}
    assert ends == {Event.HAND_LOST, Event.LASSO_HELD, *BODY_GONE}
    assert {event for phase, event in TRANSITIONS["open"] if phase is Phase.ARMED} == BODY_GONE


@pytest.mark.parametrize("mode", GATE_MODES)
def test_every_pair_leads_somewhere_and_a_lost_body_to_the_beginning(mode) -> None:
    for phase, event in product(Phase, Event):
        after = transition(mode, phase, event)
        assert after is TRANSITIONS[mode].get((phase, event), phase)
        if event in BODY_GONE and phase in {p for p, _ in TRANSITIONS[mode]}:
            assert after is Phase.NOBODY
        assert after.lit <= phase.lit + (1 if mode == "sequence" else 3)  # one step at a time


def test_every_way_back_has_words() -> None:
    back = {event for way in TRANSITIONS.values() for (p, event), q in way.items() if q.lit < p.lit}
    assert back - {Event.LASSO} <= set(WHY)  # Lasso, shown again, is a way forward


def test_the_diagram_shows_every_state() -> None:
    diagram = str(gate_machine.__doc__)
    assert all(phase.name in diagram for phase in Phase)
