"""Baxter as the studio knows it: names, limits, kinematics and looks, all from urdf/baxter.urdf."""

import difflib
import logging
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache, cached_property
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import ArrayLike

from studio.engine.errors import StudioError
from studio.engine.fingers import FINGER_JOINTS, mount_fingers
from studio.engine.kinematics import Kinematics
from studio.engine.resources import resource_root
from studio.engine.skeleton import SIDES, FloatArray, Side
from studio.engine.urdf import Color, Link, Mesh, PlacedShape, Shape, parse_xml, urdf_of

ARM_JOINTS = ("s0", "s1", "e0", "e1", "w0", "w1", "w2")  # from the shoulder to the hand
JOINT_NAMES: tuple[str, ...] = (
    *(f"{side}_{joint}" for side in SIDES for joint in ARM_JOINTS),
    "head_pan",
)
CONTROL_RATE = 30  # [Hz] at which the robot takes commands
CONTROL_PERIOD = 1.0 / CONTROL_RATE  # [s]
BASE_HEIGHT = 0.924  # [m] of the link base over the floor that the pedestal stands on

_MESH_WHEEL = "example-robot-data"
_PACKAGE = f"package://{_MESH_WHEEL}/"
_logger = logging.getLogger(__name__)


@dataclass(frozen=True, eq=False)
class JointLimits:
    """What the robot's description allows each joint."""

    lower: FloatArray  # (N,) [rad]
    upper: FloatArray  # (N,) [rad]
    velocity: FloatArray  # (N,) [rad/s]
    effort: FloatArray  # (N,) [N m]


@dataclass(frozen=True, eq=False)
class Visual:
    """Something of the robot to draw."""

    link: str
    shape: Shape  # a Mesh has the path of a file that exists
    T_link_visual: FloatArray  # (4, 4)
    color: Color


@dataclass(frozen=True, eq=False)
class Robot:
    """Baxter. Arrays of joints are always in the order of `JOINT_NAMES`.

    A robot with fingers has 19 joints, not 15: `FINGER_JOINTS` follow, in m for rad.
    """

    joint_names: tuple[str, ...]  # (15,)
    limits: JointLimits
    links: tuple[Link, ...]
    kinematics: Kinematics

    @cached_property
    def visuals(self) -> tuple[Visual, ...]:
        """All that is to draw; a link whose meshes are missing shows its collision shapes."""
        return tuple(visual for link in self.links for visual in _visuals(link))

    def arm_joints(self, side: Side) -> tuple[str, ...]:
        """Return the names of an arm's seven joints, from the shoulder to the hand."""
        return tuple(f"{side}_{joint}" for joint in ARM_JOINTS)

    def joint_index(self, name: str) -> int:
        """Return where a joint stands in the robot's order; raise StudioError if it has none."""
        if name not in self.joint_names:
            near = difflib.get_close_matches(name, self.joint_names, n=1, cutoff=0.0)[0]
            raise StudioError(f"Baxter has no joint {name!r} that moves; did you mean {near!r}?")
        return self.joint_names.index(name)

    def limits_of(self, names: Iterable[str]) -> JointLimits:
        """Return the limits of these joints, in their order; raise StudioError for unknown ones."""
        indices = [self.joint_index(name) for name in names]
        all_of_them = self.limits
        return JointLimits(
            lower=all_of_them.lower[indices],
            upper=all_of_them.upper[indices],
            velocity=all_of_them.velocity[indices],
            effort=all_of_them.effort[indices],
        )

    def retargeted(self, before: FloatArray, targets: Mapping[str, float]) -> FloatArray:
        """Return targets of all joints [rad] with some of them set anew.

        Raises
        ------
        StudioError
            For a joint that does not exist, and an angle not finite or outside the limits.
        """
        changed = before.copy()
        for name, angle in targets.items():
            index = self.joint_index(name)
            lower, upper = self.limits.lower[index], self.limits.upper[index]
            if not lower <= angle <= upper:  # nor is NaN
                raise StudioError(
                    f"{name} goes from {lower:.4f} to {upper:.4f} rad and cannot be told {angle!r}"
                )
            changed[index] = angle
        return changed

    def forward_kinematics(self, link: str, joint_positions: ArrayLike) -> FloatArray:
        """Return T_base_link (..., 4, 4) for joint positions (..., 15) [rad].

        Raises
        ------
        StudioError
            Where there is no such link, or not 15 positions.
        """
        return self.kinematics.forward(link, joint_positions)

    def link_poses(self, joint_positions: ArrayLike) -> dict[str, FloatArray]:
        """Return T_base_link (4, 4) of every link for joint positions (15,) [rad].

        Raises
        ------
        StudioError
            Where the positions are not (15,).
        """
        return self.kinematics.all_links(joint_positions)


def urdf_path() -> Path:
    """Return the file that describes the robot."""
    return resource_root() / "urdf" / "baxter.urdf"


def urdf_without_visuals(fingers: bool = False) -> bytes:
    """Return the robot's description without its looks, for programs that need only the rest.

    Raises
    ------
    FileError
        Where the file cannot be used.
    """
    tree = _description(fingers)
    for link in tree.findall("link"):
        for visual in link.findall("visual"):
            link.remove(visual)
    return ElementTree.tostring(tree)


def urdf_with_meshes(fingers: bool = False) -> bytes:
    """Return the robot's description with the paths of its meshes; without looks if there are none.

    Raises
    ------
    FileError
        Where the file cannot be used.
    """
    folder = description_folder()
    if folder is None:
        return urdf_without_visuals(fingers)
    tree = _description(fingers)
    for mesh in tree.iterfind("link/visual/geometry/mesh"):
        mesh.set("filename", str(_mesh_path(folder, mesh.get("filename", ""))))
    return ElementTree.tostring(tree)


@cache
def load_robot(fingers: bool = False) -> Robot:
    """Return Baxter, read once from `urdf_path`; raise FileError where that file is broken."""
    urdf = urdf_of(_description(fingers), urdf_path())
    by_name = {joint.name: joint for joint in urdf.joints}
    names = (*JOINT_NAMES, *FINGER_JOINTS) if fingers else JOINT_NAMES
    table = np.array([by_name[name].limits for name in names])
    table.setflags(write=False)
    root = urdf.links[0].name
    return Robot(
        joint_names=names,
        limits=JointLimits(*table.T),
        links=urdf.links,
        kinematics=Kinematics.of(root, urdf.joints, names),
    )


def _description(fingers: bool) -> Element:
    tree = parse_xml(urdf_path())
    if fingers:
        mount_fingers(tree)
    return tree


@cache
def description_folder() -> Path | None:
    """Return Rethink Robotics' baxter_description in the wheel of meshes, or None without it."""
    try:
        wheel = distribution(_MESH_WHEEL)
    except PackageNotFoundError:
        return None
    for file in wheel.files or ():
        if file.parts[-3:] == ("baxter_description", "urdf", "baxter.urdf"):
            path = Path(str(wheel.locate_file(file))).resolve()
            return path.parent.parent if path.is_file() else None
    return None


def _visuals(link: Link) -> Iterator[Visual]:
    """Yield a link's visuals, or its collision shapes where a mesh is missing."""
    resolved = [_resolved(placed) for placed in link.visuals]
    found = [placed for placed in resolved if placed is not None]
    if len(found) < len(resolved):
        _logger.warning("no meshes of %s: install %s to see them", link.name, _MESH_WHEEL)
        found = [replace(shape, color=link.visuals[0].color) for shape in link.collisions]
    for placed in found:
        yield Visual(link.name, placed.shape, placed.T_link_shape, placed.color)


def _resolved(placed: PlacedShape) -> PlacedShape | None:
    """Return a visual whose mesh is a file that exists, or None."""
    if not isinstance(placed.shape, Mesh):
        return placed
    folder = description_folder()
    if folder is None:
        return None
    path = _mesh_path(folder, placed.shape.file)
    return replace(placed, shape=Mesh(str(path))) if path.is_file() else None


def _mesh_path(folder: Path, file: str) -> Path:
    """Return where a mesh is that the description names by its package."""
    share = folder.parents[2]  # holds example-robot-data/robots/baxter_description
    return share / _MESH_WHEEL / file.removeprefix(_PACKAGE)
