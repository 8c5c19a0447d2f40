"""Baxter's messages: built as its definitions say, and believed only as far as they make sense."""

import json
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.links.baxter_messages import (
    MOST_JOINTS,
    assembly,
    command_topic,
    joint_command,
    joint_reading,
    speed_topic,
)
from studio.engine.robot import JOINT_NAMES
from tests.engine.links.rig import LEFT

# What `rosmsg show baxter_core_msgs/AssemblyState` has when all is well.
WELL = {"enabled": True, "stopped": False, "error": False, "estop_button": 0, "estop_source": 0}
TARGETS = {name: 0.1 * number for number, name in enumerate(LEFT)}


def states(told: dict[str, object], **header: object) -> dict[str, object]:
    return {"header": header, "name": [*told], "position": [*told.values()]}


def test_a_command_names_every_joint_of_one_limb() -> None:
    command = joint_command("left", {**TARGETS, "right_s0": 1.0, "head_pan": 0.5})
    assert command == {"mode": 1, "names": list(LEFT), "command": [0.1 * i for i in range(7)]}
    assert joint_command("right", TARGETS) is None  # half a limb is none
    assert joint_command("left", {**TARGETS, "left_w2": math.nan}) is None
    json.dumps(command, allow_nan=False)


def test_topics_of_limbs() -> None:
    assert command_topic("left")[0] == "/robot/limb/left/joint_command"
    assert speed_topic("right") == ("/robot/limb/right/set_speed_ratio", "std_msgs/Float64")


@settings(deadline=None, derandomize=True, max_examples=30)
@given(st.permutations([*TARGETS.items(), ("torso_t0", 9.0), ("l_gripper_l_finger_joint", 0.0)]))
def test_joints_are_read_by_name_whatever_their_order(told) -> None:
    reading = joint_reading(states(dict(told)))
    assert reading is not None
    assert reading.positions == TARGETS
    assert reading.stamp is None


@pytest.mark.parametrize("angle", [None, "0.1", True, math.nan, math.inf, 1e9, [0.1]])
def test_what_is_no_angle_is_not_known(angle: object) -> None:
    reading = joint_reading(states({"left_s0": angle, "left_s1": 0.2}))
    assert reading is not None
    assert math.isnan(reading.positions["left_s0"])
    assert reading.positions["left_s1"] == 0.2


@pytest.mark.parametrize(
    "message",
    [
        None,
        [],
        "left_s0",
        {},
        {"name": ["left_s0"], "position": [0.1, 0.2]},
        {"name": "left_s0", "position": [0.1] * 7},
        {"name": ["left_s0", "left_s0"], "position": [0.1, 0.2]},
        {"name": [f"j{i}" for i in range(MOST_JOINTS + 1)], "position": [0.0] * (MOST_JOINTS + 1)},
        {"name": ["left_s0"], "position": None},
    ],
)
def test_what_makes_no_sense_is_nothing(message: object) -> None:
    assert joint_reading(message) is None


def test_stamps() -> None:
    told = {"left_s0": 0.1}
    assert joint_reading(states(told, stamp={"secs": 5, "nsecs": 250000000})).stamp == 5.25
    assert joint_reading(states(told, stamp={"sec": 5, "nanosec": 0})).stamp == 5.0
    for stamp in ({"secs": 0, "nsecs": 0}, {"secs": "5"}, 5, None, {"secs": True}):
        assert joint_reading(states(told, stamp=stamp)).stamp is None


@pytest.mark.parametrize(
    ("told", "stop", "resets"),
    [
        ({}, "", False),
        ({"enabled": False}, "", False),
        ({"stopped": True, "estop_button": 1, "estop_source": 1}, "e-stop is pressed", False),
        ({"stopped": True, "estop_button": 3, "estop_source": 1}, "released, and not reset", True),
        ({"stopped": True, "estop_button": 2, "estop_source": 3}, "a joint's fault", True),
        ({"stopped": True, "estop_button": 2, "estop_source": 2}, "by a program", True),
        ({"estop_button": 1}, "e-stop is pressed", False),
    ],
)
def test_stops_in_words(told: dict[str, object], stop: str, resets: bool) -> None:
    found = assembly(WELL | told)
    assert found is not None
    assert stop in found.stop
    assert bool(found.stop) is bool(stop)
    assert found.resets is resets
    assert found.enabled is told.get("enabled", True)


def test_an_error_is_told_and_holds_nothing() -> None:
    """The SDK: errors need not be fatal, so that it may be enabled all the same."""
    found = assembly(WELL | {"error": True})
    assert (found.stop, found.enabled) == ("", True)
    assert "error" in found.fault


JSON = st.recursive(
    st.none() | st.booleans() | st.floats() | st.text(max_size=8) | st.sampled_from(JOINT_NAMES),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner),
    max_leaves=8,
)


@settings(deadline=None, derandomize=True, max_examples=60)
@given(
    st.fixed_dictionaries({}, optional=dict.fromkeys(("header", "name", "position"), JSON)) | JSON,
    st.fixed_dictionaries({}, optional=dict.fromkeys(WELL, JSON)) | JSON,
)
def test_garbage_raises_nothing(joints: object, whole: object) -> None:
    reading = joint_reading(joints)
    assert reading is None or all(not abs(a) > 6.3 for a in reading.positions.values())
    found = assembly(whole)
    assert found is None or isinstance(found.enabled, bool)
