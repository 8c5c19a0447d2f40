"""Nothing leaves unless people consent, the robot is well, and gate or playing say so."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.clearance import Clearance
from studio.engine.errors import StudioError
from studio.engine.links import consent
from studio.engine.links.driver import STALE
from studio.engine.links.gatekeeper import NEAR
from studio.engine.links.status import Phase
from studio.engine.links.tracking import ASIDE
from studio.engine.links.way import START_SPEED
from studio.engine.robot import CONTROL_PERIOD, JOINT_NAMES
from tests.engine.links.rig import LEFT, ROBOT, SCENES, Model, Rig, hanging, posed, ready


def column(name: str) -> int:
    return JOINT_NAMES.index(name)


def moved(rig: Rig, joint: str, by: float) -> None:
    rig.wanted = rig.wanted.copy()
    rig.wanted[column(joint)] += by


def test_from_enabling_to_following() -> None:
    rig = Rig()
    assert rig.tick().targets is None
    assert rig.memory.phase is Phase.OFF
    rig.enable()
    assert rig.tick().targets is None
    assert rig.memory.phase is Phase.WAITING
    rig.permitted = True  # an armed gate alone moves nothing
    assert all(outcome.targets is None for outcome in rig.ticks(30))
    rig.permitted = False
    rig.confirm()
    rig.started()
    assert np.abs(rig.model.positions - ready())[[column(j) for j in LEFT]].max() < 0.01
    assert all(outcome.targets is None for outcome in rig.ticks(30))
    rig.permitted = True
    moved(rig, "left_s0", 0.05)
    sent = [outcome.targets for outcome in rig.ticks(30)]
    assert all(targets is not None for targets in sent)
    assert sent[-1]["left_s0"] == pytest.approx(rig.wanted[column("left_s0")])
    assert set(sent[-1]) == set(LEFT)  # the whole limb, and no other


def test_the_first_move_is_slow_and_ends_where_the_page_shows_it() -> None:
    rig = Rig(Model(posed({}))).started()
    path = np.array(
        [[posed({})[column(j)] for j in LEFT]]
        + [[targets[joint] for joint in LEFT] for targets in rig.model.commands]
    )
    speeds = np.abs(np.diff(path, axis=0)).max(axis=1) / CONTROL_PERIOD
    assert speeds.max() <= 0.15 + 1e-9  # what the guide says
    assert np.allclose(path[-1], [ready()[column(joint)] for joint in LEFT])


@pytest.mark.parametrize("confirmed", [False, True])
def test_the_first_move_needs_enabling_and_confirming(confirmed: bool) -> None:
    rig = Rig()
    with pytest.raises(StudioError, match="Enable the robot first"):
        rig.confirm(confirmed)
    rig.enable()
    with pytest.raises(StudioError, match="Enable the robot first"):
        rig.confirm(confirmed)  # asked, but it has not said that it is
    rig.tick()
    if confirmed:
        rig.confirm()
        assert rig.memory.phase is Phase.STARTING
    else:
        with pytest.raises(StudioError, match="emergency stop"):
            rig.confirm(confirmed=False)
        assert all(outcome.targets is None for outcome in rig.ticks(10))


def lose(rig: Rig) -> None:
    rig.lost = True


def delay(rig: Rig) -> None:
    rig.age = STALE + 0.01


def press(rig: Rig) -> None:
    rig.model.stop = "The e-stop is pressed."


def disable(rig: Rig) -> None:
    rig.model.enabled = False


def forget_joint(rig: Rig) -> None:
    rig.model.positions[column("left_w2")] = math.nan


def forget_other_arm(rig: Rig) -> None:
    rig.model.positions[column("right_s1")] = math.nan


def stop(rig: Rig) -> None:
    rig.memory = consent.stop(rig.memory, "Stopped.")


FAULTS = {
    lose: "connection is lost: gone",
    delay: "0.2 s late",
    press: "e-stop is pressed",
    disable: "was disabled",
    forget_joint: "does not tell left_w2",
    forget_other_arm: "does not tell right_s1",
    stop: "Stopped",
}


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
@pytest.mark.parametrize("following", [False, True])
def test_a_fault_in_mid_motion_ends_it_and_asks_for_both_anew(fault, following: bool) -> None:
    rig = Rig().started()
    if following:
        rig.permitted = True
        rig.ticks(5)
    else:
        moved(rig, "left_s0", 0.5)
        rig.confirm()
        rig.ticks(5)
    sent = len(rig.model.commands)
    assert rig.memory.sent is not None
    fault(rig)
    rig.ticks(3)
    assert len(rig.model.commands) == sent
    assert rig.memory.phase is Phase.OFF
    assert FAULTS[fault] in rig.memory.why
    # All is well again, and yet nothing moves by itself.
    rig.lost, rig.age, rig.model.stop, rig.model.enabled = False, 0.0, "", True
    rig.model.positions = np.where(np.isnan(rig.model.positions), 0.0, rig.model.positions)
    rig.permitted = True
    rig.ticks(20)
    assert len(rig.model.commands) == sent
    with pytest.raises(StudioError, match="Enable the robot first"):
        rig.confirm()


def test_a_pressed_stop_cannot_be_enabled_away() -> None:
    rig = Rig()
    press(rig)
    with pytest.raises(StudioError, match="e-stop is pressed"):
        rig.enable()
    rig.model.resets = True  # it is released by now
    rig.enable()
    assert rig.tick().targets is None
    assert rig.memory.phase is Phase.ENABLING  # until the robot itself says so
    rig.model.stop = ""
    rig.tick()
    assert rig.memory.phase is Phase.WAITING


def test_a_robot_that_never_powers_its_motors() -> None:
    rig = Rig()
    rig.enable()
    rig.model.enabled = False
    rig.ticks(200)
    assert rig.memory.phase is Phase.OFF
    assert "did not power its motors" in rig.memory.why


def test_a_jump_is_not_followed() -> None:
    rig = Rig().started()
    rig.permitted = True
    rig.ticks(3)
    moved(rig, "left_s1", -0.4)
    assert rig.tick().targets is None
    assert rig.memory.phase is Phase.WAITING
    assert "jumped" in rig.memory.why
    rig.confirm()  # enabled it still is
    assert rig.tick().targets is not None


def test_after_a_pause_it_goes_on_only_from_near() -> None:
    rig = Rig().started()
    rig.permitted = True
    rig.ticks(3)
    rig.permitted = False
    assert all(outcome.targets is None for outcome in rig.ticks(3))
    moved(rig, "left_s1", 0.9 * NEAR)
    rig.permitted = True
    assert rig.tick().targets is not None
    rig.permitted = False
    rig.tick()
    moved(rig, "left_s1", -2 * NEAR)
    rig.permitted = True
    assert rig.tick().targets is None
    assert "off what is shown" in rig.memory.why


@pytest.mark.parametrize("joint", ["left_s0", "left_s1", "left_e0", "left_e1"])
def test_a_joint_that_turns_the_other_way_is_stopped_soon(joint: str) -> None:
    model = Model(posed({"left_s0": 0.3, "left_s1": 0.1, "left_e0": 0.1, "left_e1": 0.6}))
    model.signs[column(joint)] = -1.0
    begun = model.positions.copy()
    rig = Rig(model)
    way = ready()[column(joint)] - begun[column(joint)]
    if abs(way) < 3 * ASIDE:
        moved(rig, joint, 3 * ASIDE * math.copysign(1.0, way))
    rig.enable()
    rig.tick()
    rig.confirm()
    rig.ticks(600)
    assert rig.memory.phase is Phase.OFF
    assert joint in rig.memory.why
    wrong = (begun - model.positions)[column(joint)] * math.copysign(1.0, way)
    assert 0.0 < wrong < ASIDE + 2 * START_SPEED * CONTROL_PERIOD


def test_joints_in_a_wrong_order_are_stopped_soon() -> None:
    rig = Rig(Model(posed({})))
    begun = rig.model.positions.copy()
    order = rig.model.order
    order[column("left_s1")], order[column("left_e1")] = column("left_e1"), column("left_s1")
    rig.enable()
    rig.tick()
    rig.confirm()
    rig.ticks(600)
    assert rig.memory.phase is Phase.OFF
    assert np.abs(rig.model.positions - begun).max() < 0.6


def test_a_robot_that_is_stuck_is_not_pushed() -> None:
    rig = Rig(Model(posed({})))
    rig.model.stuck = True
    rig.enable()
    rig.tick()
    rig.confirm()
    rig.ticks(600)
    assert rig.memory.phase is Phase.OFF
    assert "does not come along" in rig.memory.why


def test_the_guard_holds_what_the_page_would_let_through() -> None:
    """The desk is not passed, whatever is wanted."""
    rig = Rig().started()
    rig.permitted = True
    way = rig.memory.way
    clearance = Clearance.of(ROBOT, SCENES["left"], rig.model.positions, way.columns)
    least = np.inf
    for _ in range(300):
        rig.wanted = rig.wanted.copy()
        rig.wanted[column("left_s1")] += 0.01  # down, through the desk
        outcome = rig.tick()
        if rig.memory.phase is not Phase.READY:
            break
        lines = clearance.lines(rig.model.positions)
        pairs = clearance.pairs
        least = min(least, float(np.min(clearance.distances(lines, pairs) - pairs.stop)))
        guarded = outcome.guarded
    assert "desk" in guarded
    assert least > -1e-6


def test_a_start_that_the_guard_forbids_is_given_up_in_words() -> None:
    rig = Rig(Model(hanging()))  # below the desk
    rig.enable()
    rig.tick()
    rig.confirm()
    rig.ticks(900)
    assert rig.memory.phase is Phase.WAITING
    assert "desk" in rig.memory.why
    assert "by hand" in rig.memory.why
    assert rig.tick().targets is None


def test_limits_of_robot_and_studio_both_hold() -> None:
    rig = Rig()
    rig.enable()
    rig.tick()
    own = {"left_e1": (0.2, 1.5)}
    rig.memory = consent.confirm(rig.memory, rig.seen, rig.asked, own, True)
    way = rig.memory.way
    at = way.joints.index("left_e1")
    assert (way.limits.lower[at], way.limits.upper[at]) == (0.2, 1.5)
    ours = ROBOT.limits_of(way.joints)
    others = [i for i in range(7) if i != at]
    assert (way.limits.lower[others] == ours.lower[others]).all()


def test_a_robot_outside_its_limits_is_not_started() -> None:
    rig = Rig(Model(posed({"left_e1": -0.3})))
    rig.enable()
    rig.tick()
    with pytest.raises(StudioError, match=r"left_e1 is at -0\.30 rad, beyond its limit"):
        rig.confirm()


@pytest.mark.parametrize("ratio", [0.0, 0.01, 1.1, math.nan])
def test_impossible_speeds(ratio: float) -> None:
    with pytest.raises(StudioError, match="speed ratio"):
        consent.at_ratio(Rig().memory, ratio)


def test_other_arms_have_to_be_confirmed() -> None:
    rig = Rig().started()
    rig.permitted, rig.arms = True, "both"
    assert rig.tick().targets is None
    assert rig.memory.phase is Phase.WAITING


EVENTS = ("enable", "confirm", "permit", "forbid", "lose", "find", "press", "release", "power_off")
EVENTS += ("stop", "wander", "jump", "slow", "tick", "tick", "ticks", "late", "in_time", "faster")


@settings(deadline=None, derandomize=True, max_examples=60)
@given(st.lists(st.sampled_from(EVENTS), min_size=5, max_size=60), st.randoms())
def test_no_command_without_every_permission(events: list[str], random) -> None:
    """Against a witness that keeps its own, much simpler, record of who permitted what."""
    rig = Rig(Model(ready()))
    may_move = False  # enabled and confirmed since the last fault
    for event in ("enable", "tick", "confirm", "ticks", "permit", *events):
        consented = _happen(rig, event, random)
        for _ in range(20 if event == "ticks" else 1):
            model, before = rig.model, rig.memory
            well = not (rig.lost or rig.age > STALE or model.stop or not model.enabled)
            may_move = (may_move or consented) and well and event != "stop"
            outcome = rig.tick()
            if outcome.targets is None:
                continue
            assert may_move
            assert rig.permitted or before.phase is Phase.STARTING
            limits = ROBOT.limits_of(outcome.targets)
            angles = np.array(list(outcome.targets.values()))
            assert ((limits.lower <= angles) & (angles <= limits.upper)).all()
            if before.sent is not None:
                fastest = before.ratio * limits.velocity * CONTROL_PERIOD
                assert (np.abs(angles - before.sent) <= fastest).all()


def _happen(rig: Rig, event: str, random) -> bool:  # noqa: C901 - a table of events
    """Let an event happen; return whether a person has consented by it."""
    model = rig.model
    try:
        match event:
            case "enable":
                rig.enable()
            case "confirm":
                rig.confirm(confirmed := random.random() < 0.8)
                return confirmed
            case "permit" | "forbid":
                rig.permitted = event == "permit"
            case "lose" | "find":
                rig.lost = event == "lose"
            case "press" | "release":
                model.stop = "pressed" if event == "press" else ""
            case "power_off":
                model.enabled = False
            case "stop":
                stop(rig)
            case "wander" | "jump":
                moved(
                    rig, random.choice(LEFT[:4]), random.uniform(-1, 1) * (0.03, 1)[event == "jump"]
                )
            case "late" | "in_time":
                rig.age = 1.0 if event == "late" else 0.0
            case "slow" | "faster":
                ratio = 0.1 if event == "slow" else 1.0
                rig.memory = consent.at_ratio(rig.memory, ratio)
    except StudioError:
        pass
    return False
