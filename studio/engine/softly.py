"""One tick of a robot that goes where it is told: soft engagement, then limits, then guard."""

from studio.engine.engage import EngageMemory, Joints, Move, Passed
from studio.engine.limits import Command
from studio.engine.pipeline import Pipeline
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.skeleton import FloatArray


def softly(
    pipeline: Pipeline,
    memory: EngageMemory | None,
    sent: FloatArray,
    wanted: FloatArray,
    time: float,
) -> tuple[EngageMemory | None, Command]:
    """Return what is sent after ``sent`` (D,) [rad], and how far the engagement has come."""
    engage, goal = pipeline.engage, as_joints(wanted)
    memory, target = engage.step(memory, as_joints(sent), goal, time, CONTROL_PERIOD)
    limited = pipeline.limits.step(sent, target, CONTROL_PERIOD)
    command = pipeline.guard.keep(sent, limited, CONTROL_PERIOD)
    passed = Passed(*map(as_joints, (sent, limited.sent, command.sent)))
    memory = engage.after(Move(memory, goal, target), passed, time, CONTROL_PERIOD)
    return memory, command


def as_joints(row: FloatArray) -> Joints:
    """Return a row (D,) [rad] as the engagement knows it."""
    return tuple(row.tolist())
