"""Which of Baxter's arms are driven, and the joints that this means, by their full names."""

from collections.abc import Sequence
from typing import Literal

import numpy as np

from studio.engine.retarget import DRIVEN_JOINTS, LEARNED_JOINTS, Angles, Mapping
from studio.engine.robot import JOINT_NAMES
from studio.engine.skeleton import SIDES, FloatArray, Side

Arms = Literal["left", "right", "both"]
ARMS: tuple[Arms, ...] = ("left", "right", "both")


# An arm that is not taught hangs beside the desk, out of everybody's way: s0, s1, e0, e1 [rad].
HANGING: dict[Side, Angles] = {"left": (0.35, 1.0, 0.0, 0.5), "right": (-0.35, 1.0, 0.0, 0.5)}


def sides_of(arms: Arms) -> tuple[Side, ...]:
    """Return the sides of the arms that are driven, in the order of their joints."""
    return SIDES if arms == "both" else (arms,)


def driven_joints(arms: Arms) -> tuple[str, ...]:
    """Return the joints that take commands: s0, s1, e0 and e1 of each arm, as ``left_s0``."""
    return tuple(f"{side}_{joint}" for side in sides_of(arms) for joint in DRIVEN_JOINTS)


def learned_joints(arms: Arms, mapping: Mapping) -> tuple[str, ...]:
    """Return the joints that a learner sees: those driven, in the paper's mapping without e0."""
    return tuple(f"{side}_{joint}" for side in sides_of(arms) for joint in LEARNED_JOINTS[mapping])


def learned_columns(arms: Arms, mapping: Mapping) -> list[int]:
    """Return where the learned joints stand among the driven ones."""
    driven = driven_joints(arms)
    return [driven.index(joint) for joint in learned_joints(arms, mapping)]


def resting_body(arms: Arms) -> FloatArray:
    """Return all joints (15,) [rad] while the arms that are not taught hang, the others at zero."""
    body = np.zeros(len(JOINT_NAMES))
    for side in set(SIDES) - set(sides_of(arms)):
        body[[JOINT_NAMES.index(joint) for joint in driven_joints(side)]] = HANGING[side]
    return body


def short_names(joints: Sequence[str]) -> tuple[str, ...]:
    """Return joints' names for columns and charts: without the side where all have the same."""
    sides = {joint.partition("_")[0] for joint in joints}
    return tuple(joint.partition("_")[2] if len(sides) == 1 else joint for joint in joints)


def in_words(arms: Arms) -> str:
    """Return how one says it: ``left arm``, ``both arms``."""
    return "both arms" if arms == "both" else f"{arms} arm"
