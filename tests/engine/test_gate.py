"""The gate arms after Lasso, Open, Closed and after nothing else, at any frame rate."""

import random
from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from pathlib import Path

import pytest

from studio.engine import commands
from studio.engine.errors import StudioError
from studio.engine.gate import Gate, GateMemory, GateStatus
from studio.engine.session import Session
from studio.engine.skeleton import Hand, HandState
from studio.engine.snapshot import Mode
from studio.engine.sources import read_skeletons
from tests.engine.people import held, person

LASSO, OPEN, CLOSED = HandState.LASSO, HandState.OPEN, HandState.CLOSED
UNKNOWN, NOT_TRACKED = HandState.UNKNOWN, HandState.NOT_TRACKED
LONG = 12  # frames; believed after 10, that is 0.3 s


def run(
    states: Sequence[HandState], rate: float = 30.0, gate: Gate | None = None
) -> list[GateStatus]:
    """Return the status after every frame."""
    gate, memory, found = gate or Gate(), None, []
    for i, state in enumerate(states):
        memory, status = gate.step(memory, person(i / rate, hand=state), i / rate)
        found.append(status)
    return found


def first_armed(states: Sequence[HandState], rate: float = 30.0) -> int | None:
    """Return the first frame that is armed."""
    return next((i for i, status in enumerate(run(states, rate)) if status.armed), None)


def test_arms_when_closed_has_been_seen_for_its_time() -> None:
    states = held((LASSO, LONG), (OPEN, LONG), (CLOSED, LONG))
    assert first_armed(states) == 2 * LONG + 9


@pytest.mark.parametrize("rate", [15, 30, 60])
def test_time_decides_and_not_frames(rate: int) -> None:
    """The end of a real recording, at three frame rates: armed at the same moment, once."""
    at_30 = held(
        *((LASSO, 35), (UNKNOWN, 2), (CLOSED, 7), (UNKNOWN, 2)),
        *((NOT_TRACKED, 14), (OPEN, 19), (CLOSED, 33)),
    )
    states = [at_30[int(i * 30 / rate)] for i in range(int(len(at_30) * rate / 30))]
    armed = [i for i, status in enumerate(run(states, rate)) if status.armed]
    assert armed == list(range(armed[0], len(states)))
    assert armed[0] / rate == pytest.approx(88 / 30, abs=0.1)


@pytest.mark.parametrize("order", list(product((LASSO, OPEN, CLOSED), repeat=3)))
def test_only_the_one_order_arms(order: tuple[HandState, ...]) -> None:
    armed = first_armed(held(*((state, LONG) for state in order)))
    assert (armed is not None) == (order == (LASSO, OPEN, CLOSED))


@pytest.mark.parametrize("skipped", [0, 1, 2])
def test_a_sign_too_short_is_no_sign(skipped: int) -> None:
    lengths = [LONG] * 3
    lengths[skipped] = 8  # frames, that is 0.27 s
    signs = zip((LASSO, OPEN, CLOSED), lengths, strict=True)
    assert first_armed(held(*signs)) is None


@pytest.mark.parametrize("unseen", [UNKNOWN, NOT_TRACKED])
@pytest.mark.parametrize(
    ("gap", "arms"), [(2, True), (12, True), (23, True), (26, False), (60, False)]
)
def test_gaps_are_bridged_for_a_bounded_time(unseen: HandState, gap: int, arms: bool) -> None:
    for where in (1, 2):
        runs = [(LASSO, LONG), (OPEN, LONG), (CLOSED, LONG)]
        runs.insert(where, (unseen, gap))
        assert (first_armed(held(*runs)) is not None) == arms


def test_an_unseen_hand_is_never_open() -> None:
    assert first_armed(held((LASSO, LONG), (UNKNOWN, LONG), (CLOSED, LONG))) is None


def test_the_next_sign_must_come_in_time() -> None:
    flicker = [(CLOSED, 4), (LASSO, 4)]
    patient = held((LASSO, LONG), *flicker, *flicker, (OPEN, LONG), (CLOSED, LONG))
    assert first_armed(patient) is not None
    slow = held((LASSO, LONG), *[(CLOSED, 4), (OPEN, 4)] * 9, (OPEN, LONG), (CLOSED, LONG))
    assert first_armed(slow) is None


def test_time_without_sight_does_not_count_as_holding() -> None:
    """Eight frames of Lasso, then a stalled sensor: 0.23 + 0.1 s of sight, not 5.23 s."""
    gate, memory = Gate(believe_after=0.5), None
    for i in range(8):
        memory, status = gate.step(memory, person(i / 30, hand=LASSO), i / 30)
    memory, status = gate.step(memory, person(8 / 30 + 0.4, hand=LASSO), 8 / 30 + 0.4)
    assert status.lit == 0
    assert status.held == pytest.approx(7 / 30 + 0.1)


ARMING = held((LASSO, LONG), (OPEN, LONG), (CLOSED, LONG))


def armed() -> GateMemory:
    """Return the memory of a gate that has just armed, one frame before ``len(ARMING) / 30``."""
    memory = None
    for i, state in enumerate(ARMING):
        memory, status = Gate().step(memory, person(hand=state), i / 30)
    assert status.armed
    return memory


def test_lasso_held_disarms_and_does_not_arm_again_by_itself() -> None:
    statuses = run([*ARMING, *held((LASSO, 40), (OPEN, LONG), (CLOSED, LONG))])
    after = [status.armed for status in statuses[len(ARMING) :]]
    assert after[:15] == [True] * 15
    assert not any(after[15:])


def test_a_flicker_of_lasso_does_not_disarm() -> None:
    statuses = run([*ARMING, *held((LASSO, 10), (CLOSED, 10))])
    assert all(status.armed for status in statuses[len(ARMING) :])


def test_a_hand_lost_while_armed_disarms_after_two_seconds() -> None:
    after = [status.armed for status in run([*ARMING, *held((UNKNOWN, 80))])][len(ARMING) :]
    assert after == [True] * 61 + [False] * 19


def test_a_lost_body_disarms_after_half_a_second() -> None:
    gate, memory, armed = Gate(), None, []
    for i, state in enumerate(ARMING):
        memory, _ = gate.step(memory, person(i / 30, hand=state), i / 30)
    for i in range(len(ARMING), len(ARMING) + 20):
        memory, status = gate.step(memory, None, i / 30)
        armed.append(status.armed)
    assert armed == [True] * 15 + [False] * 5
    assert status.reason == "nobody in sight"


def test_a_body_that_a_stream_leaves_out_is_lost_too() -> None:
    """Stamps that jump by more than half a second, without frames that show nobody."""
    gate, memory = Gate(), None
    for i, state in enumerate(ARMING):
        memory, status = gate.step(memory, person(i / 30, hand=state), i / 30)
    assert status.armed
    later = len(ARMING) / 30 + 0.5
    _, status = gate.step(memory, person(later, hand=CLOSED), later)
    assert not status.armed
    assert "nobody was in sight" in status.detail


def test_another_person_does_not_inherit_the_gate() -> None:
    memory, later = armed(), len(ARMING) / 30
    gate = Gate()
    for i in range(20):
        time = later + i / 30
        memory, status = gate.step(memory, person(hand=CLOSED, body_id="other"), time)
        assert not status.armed
        assert "another person took over" in status.detail
    assert status.reason == "waiting for Lasso of the left hand"


def test_an_open_gate_lets_go_of_the_robot_when_another_person_takes_over() -> None:
    gate, memory = Gate(mode="open"), None
    seen = []
    for i in range(4):
        memory, status = gate.step(memory, person(body_id="a" if i < 2 else "b"), i / 30)
        seen.append((status.armed, status.reason))
    assert seen == [(True, ""), (True, ""), (False, "another person took over"), (True, "")]


def test_stop_disarms(tmp_path: Path) -> None:
    """Whoever goes on has to sign anew: nothing of the gate outlives an activity."""
    session = Session(tmp_path)
    try:
        session.post(commands.UseDemonstrator())
        session.post(commands.Watch())
        while session.tick().mode is not Mode.ARMED:
            assert session.snapshot.mode is Mode.WATCHING
        session.post(commands.Stop())
        assert session.tick().mode is Mode.IDLE
        session.post(commands.Watch())
        again = session.tick()
        assert again.gate is not None
        assert (again.mode, again.gate.lit) == (Mode.WATCHING, 0)
    finally:
        session.close()


def test_an_open_gate_follows_whoever_is_in_sight() -> None:
    gate = Gate(mode="open")
    assert all(status.armed for status in run(held((UNKNOWN, 5)), gate=gate))
    _, status = gate.step(None, None, 0.0)
    assert not status.armed


def test_every_refusal_has_words() -> None:
    for status in run(held((UNKNOWN, 5), (LASSO, LONG), (UNKNOWN, 30), (OPEN, LONG), (CLOSED, 40))):
        assert status.armed or (status.reason and status.detail)


def details(after: Sequence[HandState | None]) -> list[str]:
    """Return what the screen says frame by frame after the gate has armed."""
    gate, memory, found = Gate(), armed(), []
    for i, state in enumerate(after, start=len(ARMING)):
        skeleton = None if state is None else person(hand=state)
        memory, status = gate.step(memory, skeleton, i / 30)
        found.append(status.detail)
    return found


def test_words_say_how_much_is_left_to_hold() -> None:
    said = [status.detail for status in run(held((LASSO, 8), (OPEN, 3)))]
    assert said[0] == "waiting for Lasso of the left hand"
    assert said[6] == "hold LASSO 0.1 s more"
    said = [status.detail for status in run(held((LASSO, 12), (OPEN, 4)))]
    assert said[11] == "waiting for Open of the left hand"
    assert said[-1] == "hold OPEN 0.2 s more; 1.9 s left"


def test_words_say_how_long_a_gap_is_bridged_yet() -> None:
    statuses = run(held((LASSO, LONG), (UNKNOWN, 16)))
    assert statuses[-1].detail == "left hand unseen for 0.5 s; waiting for Open; 0.3 s left"
    assert statuses[-1].left == pytest.approx(0.3)


def test_words_say_how_long_the_next_sign_may_take() -> None:
    flicker = [(CLOSED, 4), (OPEN, 4)] * 6
    assert "; 0.4 s left" in run(held((LASSO, LONG), *flicker))[-1].detail
    late = run(held((LASSO, LONG), *flicker, *flicker))[-1].detail
    assert late == "the next sign came too late; waiting for Lasso"


def test_words_say_how_long_until_it_disarms() -> None:
    assert details([CLOSED])[-1] == "armed: hold Lasso to disarm"
    unseen = details(held((UNKNOWN, 46)))
    assert unseen[-1] == "armed: left hand unseen for 1.5 s; disarms in 0.5 s"
    assert details(held((LASSO, 10)))[-1] == "armed: Lasso is held; disarms in 0.2 s"
    assert details([None] * 9)[-1] == "armed: nobody in sight for 0.3 s; disarms in 0.2 s"
    assert details([None] * 2)[-1] == "armed: hold Lasso to disarm"  # a sensor slower than ticks


@pytest.mark.parametrize("after", [held((UNKNOWN, 70)), held((LASSO, 20)), [None] * 20])
def test_the_time_left_runs_out_when_it_says_so(after: list[HandState | None]) -> None:
    """A count-down keeps its promise: the gate falls back within a frame of its zero."""
    gate, memory, statuses = Gate(), armed(), []
    for i, state in enumerate(after, start=len(ARMING)):
        memory, status = gate.step(memory, None if state is None else person(hand=state), i / 30)
        statuses.append(status)
    end = [status.armed for status in statuses].index(False)
    promised = [(i, status.left) for i, status in enumerate(statuses[:end]) if status.left]
    assert len(promised) > 5
    for i, left in promised:
        assert left - 1e-6 <= (end - i) / 30 <= left + 1 / 30 + 1e-6


def test_a_sign_out_of_order_is_named() -> None:
    said = run(held((LASSO, LONG), (CLOSED, LONG)))[-1].detail
    assert said == "Closed came instead of Open; waiting for Lasso"


def test_a_state_that_the_source_is_not_sure_of_counts_as_unknown() -> None:
    def shown(confidence: float, state: HandState, gate: Gate) -> GateStatus:
        memory = None
        for i in range(LONG):
            one = replace(person(), left_hand=Hand(state, confidence))
            memory, status = gate.step(memory, one, i / 30)
        return status

    assert shown(0.5, LASSO, Gate()).lit == 1
    unsure = shown(0.49, LASSO, Gate())
    assert (unsure.lit, unsure.state, unsure.confidence) == (0, UNKNOWN, 0.49)
    assert "left hand uncertain for 0.4 s" in unsure.detail
    assert shown(0.0, LASSO, Gate(minimum_confidence=0.0)).lit == 1


@pytest.mark.parametrize(
    "wrong", [{"believe_after": 0.0}, {"body_lost_after": float("nan")}, {"longest_gap": 2.0}]
)
def test_settings_that_make_no_sense_are_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(StudioError, match="gate's"):
        Gate(**wrong)


REAL = Path(__file__).resolve().parents[3] / "shared" / "data" / "kinect"
needs_real = pytest.mark.skipif(not REAL.is_dir(), reason=f"no real recordings at {REAL}")


def armings(name: str, rate: float, offset: float = 0.0, jitter: float = 0.0) -> list[int]:
    """Return the frames of a real recording at which it arms, sampled at some rate."""
    frames = [skeleton for _, skeleton in read_skeletons(REAL / name).by_frame()]
    rng, gate, memory, before, found = random.Random(1), Gate(), None, False, []
    for index in range(int((len(frames) / 30 - offset) * rate)):
        time = offset + index / rate
        frame = int(time * 30 + 1e-6)
        late = rng.uniform(-jitter, jitter)
        memory, status = gate.step(memory, frames[frame], time + late)
        found += [frame] if status.armed and not before else []
        before = status.armed
    return found


@needs_real
@pytest.mark.parametrize("rate", [15, 30, 60])
@pytest.mark.parametrize(("offset", "jitter"), [(0.0, 0.0), (1 / 30, 0.004), (0.01, 0.0)])
def test_the_one_true_sequence_of_the_real_recordings_arms_once(
    rate: int, offset: float, jitter: float
) -> None:
    (frame,) = armings("kinect2-socket/hands_gestures.json.gz", rate, offset, jitter)
    assert abs(frame - 485) <= 3


@needs_real
@pytest.mark.parametrize("rate", [15, 30, 60])
@pytest.mark.parametrize(
    "name",
    [
        "kinect2-socket/test_record.json",
        "kinect2-socket/hand_flap.json.gz",
        "kinectron/recorded_skeleton.json.gz",
    ],
)
def test_the_other_real_recordings_never_arm(name: str, rate: int) -> None:
    assert armings(name, rate) == []
    assert armings(name, rate, 1 / 30, 0.004) == []
