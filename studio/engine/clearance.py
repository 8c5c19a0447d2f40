"""How far what moves is from all that it must not touch, for any joint angles.

A broad phase by bounding spheres finds the few pairs that are near; only those are measured.
"""

from collections.abc import Collection
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from studio.engine.body import Boxes, Capsules, boxes_of, capsules_of, margin_of
from studio.engine.distance import point_to_box, segment_to_box, segment_to_segment
from studio.engine.kinematics import Kinematics
from studio.engine.robot import Robot
from studio.engine.scene import Scene
from studio.engine.skeleton import FloatArray

Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Pairs:
    """P pairs: first ``rounded`` ones of two capsules, then those of a capsule and a box."""

    first: Indices  # (P,) capsules
    second: Indices  # (P,) capsules, then boxes
    rounded: int
    stop: FloatArray  # (P,) [m], see body.Margin
    slow: FloatArray  # (P,) [m]

    def __len__(self) -> int:
        return len(self.first)

    def chosen(self, which: Indices) -> "Pairs":
        """Return some of the pairs, by their indices in rising order."""
        rounded = int(np.searchsorted(which, self.rounded))
        first, second = self.first[which], self.second[which]
        return Pairs(first, second, rounded, self.stop[which], self.slow[which])


@dataclass(frozen=True, eq=False)
class Clearance:
    """Distances of the links that some joints move; build it by `of`."""

    kinematics: Kinematics
    capsules: Capsules
    boxes: Boxes
    pairs: Pairs  # all that are watched
    bounds: FloatArray  # (P,) [m] by how much less than its centers' a pair's distance can be
    joints: list[int]  # of the kinematics, whose links move
    moving: Indices  # capsules that move
    still_poses: FloatArray  # (1 + J, 4, 4) of all links at rest
    still_lines: FloatArray  # (C, 4, 2) of all capsules at rest

    @classmethod
    def of(
        cls, robot: Robot, scene: Scene, rest: FloatArray, columns: Collection[int]
    ) -> "Clearance":
        """Return the distances in ``scene`` while all joints but ``columns`` stay at ``rest``."""
        capsules, boxes = capsules_of(robot), boxes_of(robot, scene, rest)
        joints = robot.kinematics.below(columns)
        moving = np.flatnonzero(np.isin(capsules.links, [1 + joint for joint in joints]))
        pairs = _watched(capsules, boxes, moving.tolist())
        spheres = np.linalg.norm(capsules.lines[:, :3, 1], axis=1) / 2 + capsules.radii
        bounds = spheres[pairs.first]
        bounds[: pairs.rounded] += spheres[pairs.second[: pairs.rounded]]
        poses = robot.kinematics.stacked(rest)
        return cls(
            kinematics=robot.kinematics,
            capsules=capsules,
            boxes=boxes,
            pairs=pairs,
            bounds=bounds,
            joints=joints,
            moving=moving,
            still_poses=poses,
            still_lines=poses[capsules.links] @ capsules.lines,
        )

    def names(self, pairs: Pairs, index: int) -> tuple[str, str]:
        """Return the two parts of a pair as one says them: the arm's first."""
        one, other = pairs.first[index], pairs.second[index]
        second = self.capsules.parts if index < pairs.rounded else self.boxes.parts
        first, last = self.capsules.parts[one], second[other]
        return (str(first), str(last)) if first.place >= last.place else (str(last), str(first))

    def within(self, lines: FloatArray, reach: FloatArray) -> Pairs:
        """Return all pairs that may be nearer than ``reach`` (P,) [m], and some that are not.

        ``lines`` (C, 4, 2) are the capsules, see `lines`.
        """
        centers = lines[:, :, 0] + 0.5 * lines[:, :, 1]  # (C, 4)
        pairs, count = self.pairs, self.pairs.rounded
        apart = centers[pairs.first[:count]] - centers[pairs.second[:count]]
        turned = self.boxes.T_box_base @ centers.T  # (B, 4, C)
        in_boxes = turned[pairs.second[count:], :3, pairs.first[count:]]
        least = np.empty(len(pairs))
        least[:count] = np.sqrt(np.einsum("pi,pi->p", apart, apart))
        least[count:] = point_to_box(in_boxes, self.boxes.half[pairs.second[count:]])
        return pairs.chosen(np.flatnonzero(least - self.bounds < reach))

    def travels(self, before: FloatArray, after: FloatArray) -> FloatArray:
        """Return by how much (..., P) [m] all pairs may come nearer between two sets of lines.

        A point between a capsule's two ends moves no further than the one that moves more.
        """
        starts = after[..., :3, 0] - before[..., :3, 0]
        ends = starts + after[..., :3, 1] - before[..., :3, 1]
        squares = [np.einsum("...i,...i->...", way, way) for way in (starts, ends)]
        moved = np.sqrt(np.maximum(*squares))
        found: FloatArray = moved[..., self.pairs.first]
        found[..., : self.pairs.rounded] += moved[..., self.pairs.second[: self.pairs.rounded]]
        return found

    def distances(self, lines: FloatArray, pairs: Pairs) -> FloatArray:
        """Return the distances (..., P) [m] of ``pairs`` where the capsules are ``lines``.

        Negative where two overlap, but by no more than their radii.
        """
        count = pairs.rounded
        found = np.empty((*lines.shape[:-3], len(pairs)))
        if count:
            one = lines[..., pairs.first[:count], :3, :]
            other = lines[..., pairs.second[:count], :3, :]
            apart = segment_to_segment(one[..., 0], one[..., 1], other[..., 0], other[..., 1])
            found[..., :count] = apart - self.capsules.radii[pairs.second[:count]]
        if count < len(pairs):
            boxes = pairs.second[count:]
            inside = self.boxes.T_box_base[boxes] @ lines[..., pairs.first[count:], :, :]
            found[..., count:] = segment_to_box(
                inside[..., :3, 0], inside[..., :3, 1], self.boxes.half[boxes]
            )
        return found - self.capsules.radii[pairs.first]

    def lines(self, angles: FloatArray) -> FloatArray:
        """Return all capsules (..., C, 4, 2), start and way, for angles (..., 15) [rad]."""
        leading = angles.shape[:-1]
        poses = np.empty((*leading, *self.still_poses.shape))
        poses[...] = self.still_poses
        self.kinematics.restack(poses, angles, self.joints)
        lines = np.empty((*leading, *self.still_lines.shape))
        lines[...] = self.still_lines
        moved = poses[..., self.capsules.links[self.moving], :, :]
        lines[..., self.moving, :, :] = moved @ self.capsules.lines[self.moving]
        return lines


def _watched(capsules: Capsules, boxes: Boxes, moving: Collection[int]) -> Pairs:
    """Return the pairs of which at least one moves, and that must not touch."""
    count = len(capsules.parts)
    rounded = [(i, j) for i, j in combinations(range(count), 2) if i in moving or j in moving]
    boxed = list(product(moving, range(len(boxes.parts))))
    round_margins = [margin_of(capsules.parts[i], capsules.parts[j]) for i, j in rounded]
    box_margins = [margin_of(capsules.parts[i], boxes.parts[j]) for i, j in boxed]
    rows = [
        (*pair, margin.stop, margin.slow)
        for pair, margin in zip(rounded + boxed, round_margins + box_margins, strict=True)
        if margin is not None
    ]
    first, second, stop, slow = (np.array(column) for column in zip(*rows, strict=True))
    return Pairs(first, second, sum(m is not None for m in round_margins), stop, slow)
