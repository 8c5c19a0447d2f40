"""The person, standing beside the robot and facing the way it faces."""

import numpy as np
import trimesh
import viser
from numpy.typing import NDArray

from studio.engine.skeleton import (
    BONES,
    JOINT_COUNT,
    FloatArray,
    HandState,
    Joint,
    Skeleton,
    Tracking,
)
from studio.engine.snapshot import Snapshot
from studio.panels.palette import HAND, UNSEEN_HAND
from studio.panels.placing import Placing

ABOVE = np.array([0.0, 0.0, 0.09])  # [m] from the hand to its label
_UNSURE = (165, 175, 185)
_BONE, _JOINT = (60, 75, 95), (45, 60, 80)
_BONE_IN_THE_DARK, _JOINT_IN_THE_DARK, _UNSURE_IN_THE_DARK = (
    (150, 160, 172),
    (185, 196, 208),
    (95, 104, 114),
)


class PersonView:
    """Draws the skeleton: all joints as one node, all bones as another, the signing hand."""

    def __init__(self, scene: viser.SceneApi, name: str = "/person") -> None:
        self._placing = Placing()
        self._drawn: object = None
        self._is_dark = False
        self._root = scene.add_frame(name, show_axes=False, visible=False)
        ball = trimesh.creation.icosphere(subdivisions=2, radius=1.0)
        self._joints = scene.add_batched_meshes_simple(
            f"{name}/joints",
            ball.vertices,
            ball.faces,
            batched_wxyzs=np.tile((1.0, 0.0, 0.0, 0.0), (JOINT_COUNT, 1)),
            batched_positions=np.zeros((JOINT_COUNT, 3)),
            batched_scales=_sizes(),
            batched_colors=np.tile(np.array(_JOINT, np.uint8), (JOINT_COUNT, 1)),
            lod="off",
        )
        self._bones = scene.add_line_segments(
            f"{name}/bones",
            np.zeros((len(BONES), 2, 3)),
            colors=_BONE,
            thickness=0.028,
            thickness_units="world",
        )
        self._hand = scene.add_icosphere(f"{name}/left_hand", radius=0.06)
        self._label = scene.add_label(
            f"{name}/left_hand_state", "", anchor="bottom-center", font_screen_scale=1.3
        )

    def draw(self, now: Snapshot) -> None:
        """Show a person, or nobody; the hand speaks only while somebody listens."""
        skeleton, placement = now.skeleton, self._placing.of(now)
        watched = now.gate is not None or now.who.puppet is not None
        self._root.visible = skeleton is not None
        self._label.visible = watched
        if skeleton is None or placement is None:
            return
        state = shown_state(now)
        if (skeleton, watched, state) != self._drawn:
            self._drawn = skeleton, watched, state
            self._show(placement.place(skeleton.positions), skeleton, state if watched else None)

    def shade(self, is_dark: bool) -> None:
        """Be pale before a dark backdrop, or dark before a light one."""
        self._is_dark, self._drawn = is_dark, None
        self._bones.colors = np.array(_BONE_IN_THE_DARK if is_dark else _BONE, np.uint8)

    def _show(self, points: FloatArray, skeleton: Skeleton, state: HandState | None) -> None:
        self._joints.batched_positions = points.astype(np.float32)
        self._joints.batched_colors = joint_colors(skeleton, self._is_dark)
        self._bones.points = points[np.array(BONES)]
        hand = points[Joint.HAND_LEFT]
        self._hand.position = hand
        self._hand.color = UNSEEN_HAND if state is None else HAND[state]
        self._label.position = hand + ABOVE
        self._label.text = "" if state is None else hand_words(state)


def shown_state(now: Snapshot) -> HandState:
    """Return what the left hand shows: as the gate takes it, where somebody is watched."""
    if now.gate is not None:
        return now.gate.state
    return HandState.UNKNOWN if now.skeleton is None else now.skeleton.left_hand.state


def hand_words(state: HandState) -> str:
    """Return what the left hand is seen to do."""
    return f"left hand: {state.value.replace('_', ' ').upper()}"


def joint_colors(skeleton: Skeleton, is_dark: bool = False) -> NDArray[np.uint8]:
    """Return the joints' colors (25, 3): nearer the backdrop's where the sensor only guesses."""
    known = (skeleton.tracking == Tracking.TRACKED)[:, None]
    sure, unsure = (_JOINT_IN_THE_DARK, _UNSURE_IN_THE_DARK) if is_dark else (_JOINT, _UNSURE)
    return np.where(known, sure, unsure).astype(np.uint8)


def _sizes() -> FloatArray:
    """Return the joints' radii (25,) [m]."""
    sizes = np.full(JOINT_COUNT, 0.026)
    sizes[Joint.HEAD] = 0.10
    return sizes
