"""A recording's ticks as JSON messages: what each channel holds, and the way there and back."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from studio.engine.errors import StudioError
from studio.engine.gate import GateStatus
from studio.engine.recording import Sample
from studio.engine.retarget import DRIVEN_JOINTS, Angles
from studio.engine.robot import JOINT_NAMES
from studio.engine.skeleton import FloatArray, HandState
from studio.engine.sources.jsonl import skeleton_from_dict, skeleton_to_dict
from studio.engine.world import WorldState

CHANNELS = ("/skeleton", "/gate", "/command", "/joint_states", "/world")


def messages_of(sample: Sample) -> Iterator[tuple[str, dict[str, Any]]]:
    """Return one tick's messages as (channel, JSON object), /world last."""
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
        },
    )
    yield (
        "/command",
        {
            "names": list(DRIVEN_JOINTS),
            "wanted": None if sample.wanted is None else list(sample.wanted),
            "sent": sample.sent.tolist(),
            "limited": sample.limited,
            "held": sample.held,
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
    yield (
        "/world",
        {
            "time": sample.time,
            "world_time": world.time,
            "blocks": world.block_poses.tolist(),
            "touched": world.touched,
            "tilt": world.tilt,
            "block_down": world.block_down,
        },
    )


def sample_of(tick: Mapping[str, Mapping[str, Any]]) -> Sample:
    """Return the tick that these messages, keyed by channel, amount to.

    Raises StudioError, KeyError, TypeError or ValueError where they are not the studio's.
    """
    gate, command, world = tick["/gate"], tick["/command"], tick["/world"]
    joints = tick["/joint_states"]
    if tuple(joints["name"]) != JOINT_NAMES:
        raise StudioError("the joints are not Baxter's")
    seen = tick.get("/skeleton")
    sent, wanted = _angles(command["sent"]), command["wanted"]
    return Sample(
        time=float(_numbers([world["time"]], 1)[0]),
        skeleton=None if seen is None else skeleton_from_dict(dict(seen)),
        gate=GateStatus(
            armed=bool(gate["armed"]),
            lit=int(gate["lit"]),
            reason=str(gate["reason"]),
            detail=str(gate["detail"]),
            state=HandState(gate["state"]),
            held=float(gate["held"]),
            needed=float(gate["needed"]),
        ),
        held=str(command["held"]),
        wanted=None if wanted is None else _four(_angles(wanted)),
        sent=sent,
        limited=bool(command["limited"]),
        world=WorldState(
            time=float(world["world_time"]),
            joint_positions=_numbers(joints["position"], len(JOINT_NAMES)),
            joint_velocities=_numbers(joints["velocity"], len(JOINT_NAMES)),
            block_poses=_numbers(np.ravel(world["blocks"]).tolist()).reshape(-1, 7),
            touched=bool(world["touched"]),
            tilt=float(world["tilt"]),
            block_down=bool(world["block_down"]),
        ),
    )


def _numbers(values: Sequence[float], count: int | None = None) -> FloatArray:
    array = np.array(values, dtype=float)
    if array.ndim != 1 or not np.isfinite(array).all() or count not in (None, len(array)):
        raise StudioError(f"expected {count or 'some'} finite numbers, found {values!r:.60}")
    return array


def _angles(values: Sequence[float]) -> FloatArray:
    angles = _numbers(values, len(DRIVEN_JOINTS))
    if np.abs(angles).max() > 2.0 * math.pi:  # no joint turns that far
        raise StudioError(f"expected angles in radians, found {values!r:.60}")
    return angles


def _four(values: FloatArray) -> Angles:
    s0, s1, e0, e1 = values.tolist()
    return (s0, s1, e0, e1)


def _object(properties: Mapping[str, Any], *required: str) -> dict[str, Any]:
    return {"type": "object", "properties": dict(properties), "required": list(required)}


_NUMBERS = {"type": "array", "items": {"type": "number"}}
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
        },
        "sent",
    ),
    "/joint_states": _object(
        {"name": _STRINGS, "position": _NUMBERS, "velocity": _NUMBERS}, "name", "position"
    ),
    "/world": _object(
        {
            "time": {"type": "number", "description": "s since the recording began"},
            "world_time": {"type": "number", "description": "s since the world began"},
            "blocks": {"type": "array", "items": _NUMBERS, "description": "x y z qx qy qz qw"},
            "touched": {"type": "boolean"},
            "tilt": {"type": "number", "description": "rad"},
            "block_down": {"type": "boolean"},
        },
        "time",
    ),
}
