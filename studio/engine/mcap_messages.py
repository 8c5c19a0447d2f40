"""A recording's ticks as JSON messages: what each channel holds, and the way there and back."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from studio.engine.errors import StudioError
from studio.engine.gate import GateStatus
from studio.engine.hands import HandCommand
from studio.engine.live.latency import LINKS, LatencyChain
from studio.engine.pipeline import Lag
from studio.engine.recording import Sample
from studio.engine.robot import JOINT_NAMES
from studio.engine.skeleton import FloatArray, HandState
from studio.engine.sources.jsonl import skeleton_from_dict, skeleton_to_dict
from studio.engine.sources.strict_json import (
    as_flag,
    as_list,
    as_number,
    as_numbers,
    as_object,
    as_text,
)
from studio.engine.world import WorldState

CHANNELS = ("/skeleton", "/gate", "/command", "/joint_states", "/latency", "/world")


def messages_of(sample: Sample, joints: Sequence[str]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Return one tick's messages as (channel, JSON object), /world last; ``joints`` are driven."""
    if sample.skeleton is not None:
        yield "/skeleton", skeleton_to_dict(sample.skeleton)
    gate, world = sample.gate, sample.world
    yield (
        "/gate",
        {
            "armed": gate.armed,
            "lit": gate.lit,
            "reason": gate.reason,
            "detail": gate.detail,
            "state": gate.state.value,
            "held": gate.held,
            "needed": gate.needed,
            "confidence": gate.confidence,
            "left": gate.left,
        },
    )
    yield (
        "/command",
        {
            "names": list(joints),
            "wanted": None if sample.wanted is None else list(sample.wanted),
            "sent": sample.sent.tolist(),
            "limited": sample.limited,
            "held": sample.held,
            "guarded": sample.guarded,
            "lag": [sample.lag.angle, sample.lag.seconds],
            "wrist": list(sample.hands.wrist),
            "closed": sample.hands.closed,
        },
    )
    yield (
        "/joint_states",
        {
            "name": list(JOINT_NAMES),
            "position": world.joint_positions.tolist(),
            "velocity": world.joint_velocities.tolist(),
        },
    )
    if sample.latency is not None:
        yield "/latency", sample.latency.to_dict()
    yield (
        "/world",
        {
            "time": sample.time,
            "world_time": world.time,
            "blocks": world.block_poses.tolist(),
            "touched": world.touched,
            "tilt": world.tilt,
            "block_down": world.block_down,
            "fingers": world.fingers.tolist(),
            "done": world.done,
            "missing": world.missing,
        },
    )


def sample_of(tick: Mapping[str, Any]) -> Sample:
    """Return the tick that these messages, keyed by channel, amount to.

    Raises StudioError, KeyError, TypeError or ValueError where they are not the studio's.
    """
    tick = {topic: as_object(message, f"what {topic} tells") for topic, message in tick.items()}
    command, joints = tick["/command"], tick["/joint_states"]
    if tuple(joints["name"]) != JOINT_NAMES:
        raise StudioError("the joints are not Baxter's")
    seen = tick.get("/skeleton")
    sent, wanted = _angles(command["sent"], "sent"), command["wanted"]
    return Sample(
        time=as_number(tick["/world"]["time"], "the time"),
        skeleton=None if seen is None else skeleton_from_dict(seen),
        gate=_gate(tick["/gate"]),
        held=as_text(command["held"], "held"),
        wanted=None if wanted is None else tuple(_angles(wanted, "wanted", len(sent)).tolist()),
        sent=sent,
        limited=as_flag(command["limited"], "limited"),
        world=_world(tick["/world"], joints),
        # Older recordings had neither guard nor hands, and did not tell the lag.
        guarded=as_text(command.get("guarded", ""), "guarded"),
        hands=_hands(command.get("wrist", []), command.get("closed")),
        lag=Lag(*as_numbers(command.get("lag", [0.0, 0.0]), "the lag", 2).tolist()),
        latency=None if "/latency" not in tick else LatencyChain.of_dict(tick["/latency"]),
    )


def _gate(gate: Mapping[str, Any]) -> GateStatus:
    left = gate.get("left")
    return GateStatus(
        armed=as_flag(gate["armed"], "armed"),
        lit=int(as_number(gate["lit"], "lit")),
        reason=as_text(gate["reason"], "the reason"),
        detail=as_text(gate["detail"], "the detail"),
        state=HandState(gate["state"]),
        held=as_number(gate["held"], "held"),
        needed=as_number(gate["needed"], "needed"),
        confidence=as_number(gate.get("confidence", 1.0), "the confidence"),
        left=None if left is None else as_number(left, "what is left"),
    )


def _world(world: Mapping[str, Any], joints: Mapping[str, Any]) -> WorldState:
    blocks = [as_numbers(pose, "a block's pose", 7) for pose in as_list(world["blocks"], "blocks")]
    return WorldState(
        time=as_number(world["world_time"], "the world's time"),
        joint_positions=as_numbers(joints["position"], "positions", len(JOINT_NAMES)),
        joint_velocities=as_numbers(joints["velocity"], "velocities", len(JOINT_NAMES)),
        block_poses=np.array(blocks).reshape(-1, 7),
        touched=as_flag(world["touched"], "touched"),
        tilt=as_number(world["tilt"], "the tilt"),
        block_down=as_flag(world["block_down"], "block_down"),
        fingers=as_numbers(world.get("fingers", []), "fingers"),
        # Older recordings knew the paper's task only.
        done=as_flag(world.get("done", world["block_down"]), "done"),
        missing=as_text(world.get("missing", ""), "what is missing"),
    )


def _hands(wrist: object, closed: object) -> HandCommand:
    angles = tuple(_angles(wrist, "the wrist").tolist()) if wrist else ()
    return HandCommand(angles, None if closed is None else as_flag(closed, "closed"))


def _angles(values: object, what: str, count: int | None = None) -> FloatArray:
    angles = as_numbers(values, what, count)
    if np.abs(angles).max() > 2.0 * math.pi:  # no joint turns that far
        raise StudioError(f"expected {what} as angles in radians, found {values!r:.60}")
    return angles


def _object(properties: Mapping[str, Any], *required: str) -> dict[str, Any]:
    return {"type": "object", "properties": dict(properties), "required": list(required)}


_NUMBERS = {"type": "array", "items": {"type": "number"}}
_SPREAD = {**_NUMBERS, "type": ["array", "null"], "description": "s: percentiles 50 and 99"}
_STRINGS = {"type": "array", "items": {"type": "string"}}
_HAND = _object({"state": {"type": "string"}, "confidence": {"type": "number"}}, "state")

SCHEMAS: dict[str, dict[str, Any]] = {
    "/skeleton": _object(
        {
            "skeleton": {"type": "integer"},
            "time": {"type": "number", "description": "s, the sensor's own"},
            "body": {"type": "string"},
            "positions": {"type": "array", "items": _NUMBERS, "description": "25 x 3, m"},
            "tracking": {"type": "array", "items": {"type": "integer"}},
            "left_hand": _HAND,
            "right_hand": _HAND,
        },
        "time",
        "positions",
    ),
    "/gate": _object(
        {
            "armed": {"type": "boolean"},
            "lit": {"type": "integer", "description": "steps of Lasso, Open, Closed believed"},
            "reason": {"type": "string"},
            "detail": {"type": "string"},
            "state": {"type": "string"},
            "held": {"type": "number", "description": "s"},
            "needed": {"type": "number", "description": "s"},
            "confidence": {"type": "number", "description": "of the hand's state, 0 to 1"},
            "left": {"type": ["number", "null"], "description": "s until the gate falls back"},
        },
        "armed",
        "lit",
    ),
    "/command": _object(
        {
            "names": _STRINGS,
            "wanted": {**_NUMBERS, "type": ["array", "null"], "description": "rad"},
            "sent": {**_NUMBERS, "description": "rad"},
            "limited": {"type": "boolean"},
            "held": {"type": "string"},
            "guarded": {"type": "string"},
            "lag": {**_NUMBERS, "description": "of sent behind wanted: rad, s at top speed"},
            "wrist": {**_NUMBERS, "description": "rad: w0, w1, w2 of each arm, if driven"},
            "closed": {"type": ["boolean", "null"], "description": "the grippers, if any"},
        },
        "sent",
    ),
    "/joint_states": _object(
        {"name": _STRINGS, "position": _NUMBERS, "velocity": _NUMBERS}, "name", "position"
    ),
    "/latency": _object(dict.fromkeys(LINKS, _SPREAD)),
    "/world": _object(
        {
            "time": {"type": "number", "description": "s since the recording began"},
            "world_time": {"type": "number", "description": "s since the world began"},
            "blocks": {"type": "array", "items": _NUMBERS, "description": "x y z qx qy qz qw"},
            "touched": {"type": "boolean"},
            "tilt": {"type": "number", "description": "rad"},
            "block_down": {"type": "boolean"},
            "fingers": {**_NUMBERS, "description": "m: how far out each is, if there are any"},
            "done": {"type": "boolean", "description": "the scene's task"},
            "missing": {"type": "string", "description": "for the scene's task yet, in words"},
        },
        "time",
    ),
}
