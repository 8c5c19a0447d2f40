"""What of a snapshot goes over the wire: streams, and the snapshot itself."""

from collections.abc import Callable
from typing import Any

from studio.engine.remote.wire import Adapters, as_message
from studio.engine.snapshot import Snapshot
from studio.remote import learned, person, place
from studio.remote.asked import Stream
from studio.remote.snapshot import Snapshot as SnapshotTold
from studio.remote.told import Block, Gate, JointStates

Frame = JointStates | Gate | Block | SnapshotTold


def frame_of(stream: Stream, now: Snapshot, tick: int) -> Frame:
    """Return what a stream tells of a snapshot."""
    return _FRAMES[stream](now, tick)


def joint_states(now: Snapshot, tick: int) -> JointStates:
    """Return where all joints are."""
    return JointStates(
        tick=tick,
        time=now.world.time,
        positions=now.world.joint_positions.tolist(),
        velocities=now.world.joint_velocities.tolist(),
        mode=now.mode.value,
        guarded=now.guarded,
        driven=None if now.driven is None else as_message(place.Driven, now.driven, {}),
        stopped=now.stopped,
    )


def block(now: Snapshot, tick: int) -> Block:
    """Return where the blocks are."""
    return Block(
        tick=tick,
        time=now.world.time,
        poses=now.world.block_poses.tolist(),
        touched=now.world.touched,
        tilt=now.world.tilt,
        down=now.world.block_down,
        done=now.world.done,
        missing=now.world.missing,
    )


def gate(now: Snapshot, tick: int) -> Gate:
    """Return what the gate thinks."""
    state = None if now.gate is None else as_message(person.GateState, now.gate, {})
    return Gate(tick=tick, gate=state, held=now.held)


def snapshot(now: Snapshot, tick: int) -> SnapshotTold:
    """Return all that a panel may draw."""
    return as_message(SnapshotTold, now, ADAPTERS, tick=tick)


_FRAMES: dict[Stream, Callable[[Snapshot, int], Frame]] = {
    "joint_states": joint_states,
    "gate": gate,
    "block": block,
    "snapshot": snapshot,
}


def _entry(entry: Any) -> dict[str, Any]:
    shown = entry.demonstration
    return {"arms": shown.arms, "mapping": shown.mapping, "duration": shown.duration}


def _lesson(lesson: Any) -> dict[str, Any]:
    return {"joints": lesson.taught.joints, "duration": lesson.taught.duration}


ADAPTERS: Adapters = {
    learned.Entry: _entry,
    learned.FolderFile: lambda file: {"name": file.path.name},
    learned.Collection: lambda status: {"listed": sorted(path.name for path in status.listed)},
    learned.LessonSummary: _lesson,
    place.Scene: lambda scene: {
        "desk": scene.placed_desk,
        "blocks": scene.placed_blocks,
        "zones": scene.placed_zones,
    },
    learned.ReproductionSummary: lambda alone: {
        "block_down": alone.performance.block_down,
        "done": alone.performance.done,
    },
}
