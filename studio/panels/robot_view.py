"""Baxter in the scene, and the transparent arm of the demonstration that goes along as a ghost.

A frame costs the forward kinematics and the poses of what moved; meshes travel once.
"""

import numpy as np
import viser

from studio.engine.robot import BASE_HEIGHT, load_robot
from studio.engine.skeleton import FloatArray
from studio.panels.meshes import COARSE, Look, looks
from studio.panels.palette import GHOST
from studio.panels.poses import quaternions

STILL = 1e-4  # [rad] a joint that moved less is not drawn anew


class RobotView:
    """Draws the robot, down to ``detail`` [m]; ``name`` is its place in the scene's tree."""

    def __init__(self, scene: viser.SceneApi, detail: float, name: str = "/robot") -> None:
        scene.add_frame(name, show_axes=False, position=(0.0, 0.0, BASE_HEIGHT))
        self._robot = load_robot()
        self._drawn: FloatArray | None = None
        poses = self._robot.link_poses(np.zeros(len(self._robot.joint_names)))
        found = looks(self._robot)
        self.has_meshes = any(look.has_meshes for look in found)
        self._nodes = [
            (look.links, _add(scene, f"{name}/{look.links[0]}", look, detail, poses))
            for look in found
        ]

    def draw(self, joints: FloatArray) -> None:
        """Bring the links to where the joints (15,) [rad] put them."""
        if self._drawn is not None and np.abs(joints - self._drawn).max() < STILL:
            return
        self._drawn = joints
        poses = self._robot.link_poses(joints)
        for links, node in self._nodes:
            transforms = np.stack([poses[link] for link in links])
            node.batched_positions = transforms[:, :3, 3].astype(np.float32)
            node.batched_wxyzs = quaternions(transforms).astype(np.float32)


class GhostView:
    """Draws one arm, transparent; either arm, as the two are alike."""

    def __init__(self, scene: viser.SceneApi, name: str = "/ghost") -> None:
        self._root = scene.add_frame(
            name, show_axes=False, position=(0.0, 0.0, BASE_HEIGHT), visible=False
        )
        self._robot = load_robot()
        self._nodes = {
            link.removeprefix("left_"): _ghost_node(scene, f"{name}/{link}", look)
            for look in looks(self._robot)
            for link in look.links
            if link.startswith("left_")
        }

    def draw(self, joints: FloatArray | None, side: str) -> None:
        """Bring the ghost to where the joints (15,) [rad] put it, or take it away."""
        self._root.visible = joints is not None
        if joints is None:
            return
        poses = self._robot.link_poses(joints)
        transforms = np.stack([poses[f"{side}_{part}"] for part in self._nodes])
        turns = quaternions(transforms)
        for node, transform, turn in zip(self._nodes.values(), transforms, turns, strict=True):
            node.position, node.wxyz = transform[:3, 3], turn


def _add(
    scene: viser.SceneApi, name: str, look: Look, detail: float, poses: dict[str, FloatArray]
) -> viser.BatchedGlbHandle:
    """Add a surface once for all links that look like it."""
    transforms = np.stack([poses[link] for link in look.links])
    return scene.add_batched_glb(
        name,
        look.surface(detail).as_glb(),
        batched_wxyzs=quaternions(transforms),
        batched_positions=transforms[:, :3, 3],
        lod="off",
    )


def _ghost_node(scene: viser.SceneApi, name: str, look: Look) -> viser.MeshHandle:
    surface = look.surface(COARSE)
    return scene.add_mesh_simple(
        name,
        surface.vertices,
        surface.faces,
        color=GHOST,
        opacity=0.35,
        cast_shadow=False,
        receive_shadow=False,
    )
