"""Baxter in the scene, and the transparent arm of the demonstration that goes along as a ghost.

A frame costs the forward kinematics and the poses of what moved; meshes travel once.
"""

from collections.abc import Sequence

import numpy as np
import viser

from studio.engine.robot import BASE_HEIGHT, load_robot
from studio.engine.skeleton import FloatArray
from studio.panels.glb import glb
from studio.panels.mesh_cache import light_surface
from studio.panels.meshes import COARSE, Look, looks
from studio.panels.palette import GHOST
from studio.panels.poses import quaternions

STILL = 1e-4  # [rad], [m] what moved less is not drawn anew


class RobotView:
    """Draws the robot, true to ``detail`` [m]; ``name`` is its place in the scene's tree."""

    def __init__(self, scene: viser.SceneApi, detail: float, name: str = "/robot") -> None:
        scene.add_frame(name, show_axes=False, position=(0.0, 0.0, BASE_HEIGHT))
        self._scene, self._detail, self._name = scene, detail, name
        found = looks(load_robot())
        self.has_meshes = any(look.has_meshes for look in found)
        self._body = _Surfaces(scene, name, found, detail)
        self._fingers: _Surfaces | None = None  # of hands that once had some

    def draw(self, joints: FloatArray, fingers: FloatArray) -> None:
        """Bring what moved to where joints (15,) [rad] and fingers, (4,) [m] or none, put it."""
        if not len(fingers):
            self._body.draw(load_robot().link_poses(joints))
            if self._fingers is not None:
                self._fingers.show(False)
            return
        robot = load_robot(fingers=True)
        if self._fingers is None:
            found = [look for look in looks(robot) if "_finger_" in look.links[0]]
            self._fingers = _Surfaces(self._scene, self._name, found, self._detail)
        poses = robot.link_poses(np.concatenate([joints, fingers]))
        self._body.draw(poses)
        self._fingers.draw(poses)
        self._fingers.show(True)


class _Surfaces:
    """Surfaces in the scene, each added once for all links that look like it."""

    def __init__(
        self, scene: viser.SceneApi, name: str, found: Sequence[Look], detail: float
    ) -> None:
        robot = load_robot(fingers=True)
        poses = robot.link_poses(np.zeros(len(robot.joint_names)))
        self._nodes = [
            _add(scene, f"{name}/{look.links[0]}", look, detail, poses) for look in found
        ]
        counts = [len(look.links) for look in found]
        self._links = [link for look in found for link in look.links]
        self._starts = np.cumsum([0, *counts[:-1]])  # of each node's links among all
        self._drawn = _stacked(poses, self._links)  # (L, 4, 4)

    def draw(self, poses: dict[str, FloatArray]) -> None:
        """Bring the links that moved to their poses."""
        transforms = _stacked(poses, self._links)
        moved = np.abs(transforms - self._drawn).max(axis=(1, 2)) > STILL
        if not moved.any():
            return
        places = transforms[:, :3, 3].astype(np.float32)
        turns = quaternions(transforms).astype(np.float32)
        stops = [*self._starts[1:], len(self._links)]
        for node, start, stop in zip(self._nodes, self._starts, stops, strict=True):
            if moved[start:stop].any():
                node.batched_positions = places[start:stop]
                node.batched_wxyzs = turns[start:stop]
                self._drawn[start:stop] = transforms[start:stop]

    def show(self, shown: bool) -> None:
        """Show them, or hide them."""
        for node in self._nodes:
            node.visible = shown


class GhostView:
    """Draws one arm, transparent; either arm, as the two are alike."""

    def __init__(self, scene: viser.SceneApi, name: str = "/ghost") -> None:
        self._root = scene.add_frame(
            name, show_axes=False, position=(0.0, 0.0, BASE_HEIGHT), visible=False
        )
        self._robot = load_robot()
        self._drawn: FloatArray | None = None
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
        transforms = _stacked(poses, [f"{side}_{part}" for part in self._nodes])
        if self._drawn is not None and np.abs(transforms - self._drawn).max() <= STILL:
            return
        self._drawn = transforms
        turns = quaternions(transforms)
        for node, transform, turn in zip(self._nodes.values(), transforms, turns, strict=True):
            node.position, node.wxyz = transform[:3, 3], turn


def _stacked(poses: dict[str, FloatArray], links: Sequence[str]) -> FloatArray:
    return np.stack([poses[link] for link in links])


def _add(
    scene: viser.SceneApi, name: str, look: Look, detail: float, poses: dict[str, FloatArray]
) -> viser.BatchedGlbHandle:
    """Add a surface once for all links that look like it."""
    transforms = _stacked(poses, look.links)
    return scene.add_batched_glb(
        name,
        glb(light_surface(look, detail)),
        batched_wxyzs=quaternions(transforms),
        batched_positions=transforms[:, :3, 3],
        lod="off",
    )


def _ghost_node(scene: viser.SceneApi, name: str, look: Look) -> viser.MeshHandle:
    surface = light_surface(look, COARSE)
    return scene.add_mesh_simple(
        name,
        surface.vertices,
        surface.faces,
        color=GHOST,
        opacity=0.35,
        cast_shadow=False,
        receive_shadow=False,
    )
