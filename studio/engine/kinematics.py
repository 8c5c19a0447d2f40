"""Where every link is for given joint angles: forward kinematics of a tree of joints.

A joint's transform is affine in the sine and cosine of its angle (Rodrigues' formula),

    T(q) = T_parent_joint · rotation(axis, q) = constant + sine · sin q + cosine · cos q,

so the transforms of all joints come from three tables at once, and the links from products of them.
A joint that slides has a fourth, slide · q; only fingers do.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from studio.engine.errors import StudioError
from studio.engine.skeleton import FloatArray
from studio.engine.urdf import UrdfJoint


@dataclass(frozen=True, eq=False)
class Moving:
    """The M links that some angles move while all others rest; build it by `Kinematics.moving`.

    Its poses are those of `Kinematics.stacked` to the last bit, for less than half of the time.
    """

    joints: list[int]  # (M,) of the kinematics, rising; each carries one of the links
    carriers: list[int]  # (M,) which of the links each hangs on; after them come those at rest
    still: FloatArray  # (M, 4, 4) T_root_carrier where all angles rest
    steps: FloatArray  # (M, 4, 4) T_parent_child of all, where all angles rest
    turning: list[int]  # (S,) which of them the angles turn
    columns: list[int]  # (S,) by which of the angles given to `poses`
    tables: FloatArray  # (4, S, 4, 4) constant, sine, cosine and slide parts of those
    slides: bool  # whether any of those does

    def poses(self, angles: FloatArray) -> FloatArray:
        """Return T_root_link (M, ..., 4, 4) for the angles that move them (..., D) [rad]."""
        turned = angles[..., self.columns, None, None]
        constant, sine, cosine, slide = self.tables
        swing = sine * np.sin(turned) + cosine * np.cos(turned)
        if self.slides:
            swing = swing + slide * turned
        swing += constant
        steps = list(self.steps)
        for place, link in enumerate(self.turning):
            steps[link] = swing[..., place, :, :]
        poses = np.empty((len(steps), *angles.shape[:-1], 4, 4))
        on = [*poses, *self.still]
        for link, carrier in enumerate(self.carriers):
            np.matmul(on[carrier], steps[link], out=on[link])
        return poses


@dataclass(frozen=True, eq=False)
class Kinematics:
    """The joints in an order in which each parent link comes before its children."""

    root: str
    children: tuple[str, ...]  # (J,) the link that each joint carries
    parents: Mapping[str, int]  # link -> the joint that carries its parent; -1 is the root
    columns: tuple[int, ...]  # (J,) which given angle turns each joint; any for a fixed one
    constant: FloatArray  # (J, 4, 4)
    sine: FloatArray  # (J, 4, 4), zero for a fixed joint
    cosine: FloatArray  # (J, 4, 4), zero for a fixed joint
    angle_count: int
    slide: FloatArray | None = None  # (J, 4, 4), zero for a joint that turns; None if all turn

    @classmethod
    def of(cls, root: str, joints: Sequence[UrdfJoint], names: Sequence[str]) -> "Kinematics":
        """Return the kinematics of ``joints``, whose angles will come in the order of ``names``."""
        ordered = _from_the_root(root, joints)
        children = tuple(joint.child for joint in ordered)
        carrier = {root: -1} | {child: index for index, child in enumerate(children)}
        tables = np.array([_coefficients(joint) for joint in ordered])
        return cls(
            root=root,
            children=children,
            parents=MappingProxyType({joint.child: carrier[joint.parent] for joint in ordered}),
            columns=tuple(names.index(j.name) if j.movable else 0 for j in ordered),
            constant=tables[:, 0],
            sine=tables[:, 1],
            cosine=tables[:, 2],
            angle_count=len(names),
            slide=tables[:, 3] if any(joint.slides for joint in ordered) else None,
        )

    def forward(self, link: str, angles: ArrayLike) -> FloatArray:
        """Return T_root_link (..., 4, 4) for angles (..., N) [rad]."""
        values = self._checked(angles)
        path = self._path(link)
        if not path:
            return np.broadcast_to(np.eye(4), (*values.shape[:-1], 4, 4)).copy()
        steps = self._transforms(values, path)
        T = steps[..., 0, :, :]
        for step in range(1, len(path)):
            T = T @ steps[..., step, :, :]
        return T

    def all_links(self, angles: ArrayLike) -> dict[str, FloatArray]:
        """Return T_root_link (4, 4) of every link for angles (N,) [rad]."""
        values = self._checked(angles)
        if values.ndim != 1:
            raise StudioError(f"expected one row of {self.angle_count} angles, not {values.shape}")
        steps = self._transforms(values, list(range(len(self.children))))
        poses = {self.root: np.eye(4)}
        carried: list[FloatArray] = []
        for child, step in zip(self.children, steps, strict=True):
            parent = self.parents[child]
            carried.append(step if parent < 0 else carried[parent] @ step)
            poses[child] = carried[-1]
        return poses

    def stacked(self, angles: ArrayLike) -> FloatArray:
        """Return T_root_link (..., 1 + J, 4, 4) of the root and of `children`, in their order."""
        values = self._checked(angles)
        poses = np.empty((*values.shape[:-1], 1 + len(self.children), 4, 4))
        poses[..., 0, :, :] = np.eye(4)
        steps = self._transforms(values, list(range(len(self.children))))
        for joint, child in enumerate(self.children):
            carrier = poses[..., 1 + self.parents[child], :, :]
            np.matmul(carrier, steps[..., joint, :, :], out=poses[..., 1 + joint, :, :])
        return poses

    def moving(self, rest: FloatArray, columns: Sequence[int]) -> Moving:
        """Return the links that the angles in ``columns`` (D,) move while all rest (N,) [rad]."""
        joints = self.below(columns)
        at_rest, parents = self.stacked(rest), [self.parents[self.children[j]] for j in joints]
        turning = [j for j in joints if self.columns[j] in columns and self._turns(j)]
        slide = np.zeros_like(self.sine) if self.slide is None else self.slide
        return Moving(
            joints=joints,
            carriers=[
                joints.index(parent) if parent in joints else len(joints) + link
                for link, parent in enumerate(parents)
            ],
            still=at_rest[[1 + parent for parent in parents]],
            steps=self._transforms(rest, joints),
            turning=[joints.index(joint) for joint in turning],
            columns=[list(columns).index(self.columns[joint]) for joint in turning],
            tables=np.array([self.constant, self.sine, self.cosine, slide])[:, turning],
            slides=bool(slide[turning].any()),
        )

    def below(self, moved: Collection[int]) -> list[int]:
        """Return the joints (rising) whose links the angles in the columns ``moved`` move."""
        found: list[int] = []
        for joint, child in enumerate(self.children):
            turns = self.columns[joint] in moved and bool(self.sine[joint].any())
            if turns or self.parents[child] in found:
                found.append(joint)
        return found

    def _turns(self, joint: int) -> bool:
        slides = self.slide is not None and bool(self.slide[joint].any())
        return slides or bool(self.sine[joint].any())

    def _transforms(self, angles: FloatArray, joints: list[int]) -> FloatArray:
        """Return T_parent_child (..., len(joints), 4, 4) of these joints."""
        turned = angles[..., [self.columns[joint] for joint in joints], None, None]
        swing = self.sine[joints] * np.sin(turned) + self.cosine[joints] * np.cos(turned)
        if self.slide is not None:
            swing = swing + self.slide[joints] * turned
        transforms: FloatArray = self.constant[joints] + swing
        return transforms

    def _path(self, link: str) -> list[int]:
        """Return the joints from the root to a link."""
        if link != self.root and link not in self.parents:
            raise StudioError(f"no link {link!r}; there are {', '.join(self.children)}")
        path: list[int] = []
        while link != self.root:
            path.append(self.children.index(link))
            parent = self.parents[link]
            link = self.root if parent < 0 else self.children[parent]
        return path[::-1]

    def _checked(self, angles: ArrayLike) -> FloatArray:
        values = np.asarray(angles, dtype=np.float64)
        if values.ndim == 0 or values.shape[-1] != self.angle_count:
            raise StudioError(f"expected (..., {self.angle_count}) angles, not {values.shape}")
        return values


def _from_the_root(root: str, joints: Sequence[UrdfJoint]) -> list[UrdfJoint]:
    """Return the joints so that each follows the one that carries its parent link."""
    ordered: list[UrdfJoint] = []
    links = [root]
    for link in links:  # grows while it is walked
        below = [joint for joint in joints if joint.parent == link]
        ordered += below
        links += [joint.child for joint in below]
    return ordered


def _coefficients(joint: UrdfJoint) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return the constant, sine, cosine and slide parts (4, 4) of a joint's transform."""
    T, zero = joint.T_parent_joint, np.zeros((4, 4))
    if not joint.movable:
        return T, zero, zero, zero
    if joint.slides:
        way = np.zeros((4, 4))
        way[:3, 3] = T[:3, :3] @ joint.axis
        return T, zero, zero, way
    x, y, z = joint.axis
    along = np.outer(joint.axis, joint.axis)  # what the turn leaves alone
    crossed = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    parts = []
    for turned, corner in ((along, 1.0), (crossed, 0.0), (np.eye(3) - along, 0.0)):
        part = np.zeros((4, 4))
        part[:3, :3], part[3, 3] = turned, corner
        parts.append(T @ part)
    return parts[0], parts[1], parts[2], zero
