"""How far what moves is from all that it must not touch, for any joint angles.

A broad phase by boxes along the axes, one around each capsule and each box, finds the few pairs
that are near; only those are measured.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from studio.engine.body import Boxes, Capsules, boxes_of, capsules_of, margin_of
from studio.engine.distance import segment_to_box, segment_to_segment
from studio.engine.kinematics import Moving
from studio.engine.robot import Robot
from studio.engine.scene import Scene
from studio.engine.skeleton import FloatArray

Indices = NDArray[np.intp]
_ROUNDING = 1e-9  # [m] more than the last bits of any distance here


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

    capsules: Capsules
    boxes: Boxes
    pairs: Pairs  # all that are watched
    others: Indices  # (P,) as `pairs.second`, with the boxes counted after the capsules
    radii: FloatArray  # (P,) [m] by how much less than its lines' a pair's distance is, at most
    columns: list[int]  # of the angles that move something
    links: Moving
    moving: Indices  # capsules that move
    moving_lines: FloatArray  # of those in their links' frames, as `capsules.lines`
    carriers: Indices  # which of the links carries each of those
    levers: FloatArray  # (C + B, D) [m] no point of a capsule is further from a joint's axis
    still_lines: FloatArray  # (C, 4, 2) of all capsules at rest
    still_bounds: FloatArray  # (6, C + B) of all capsules and boxes at rest, see `_bounds`

    @classmethod
    def of(
        cls, robot: Robot, scene: Scene, rest: FloatArray, columns: Sequence[int]
    ) -> "Clearance":
        """Return the distances in ``scene`` while all joints but ``columns`` stay at ``rest``."""
        capsules, boxes = capsules_of(robot), boxes_of(robot, scene, rest)
        links = robot.kinematics.moving(rest, columns)
        carried = [1 + joint for joint in links.joints]
        moving = np.flatnonzero(np.isin(capsules.links, carried))
        pairs = _watched(capsules, boxes, moving.tolist())
        others = pairs.second.copy()
        others[pairs.rounded :] += len(capsules.parts)
        radii = capsules.radii[pairs.first]
        radii[: pairs.rounded] += capsules.radii[pairs.second[: pairs.rounded]]
        lines = robot.kinematics.stacked(rest)[capsules.links] @ capsules.lines
        carriers = np.array([carried.index(link) for link in capsules.links[moving]])
        levers = np.zeros((len(capsules.parts) + len(boxes.parts), len(columns)))
        levers[moving] = _levers(links, carriers, capsules.lines[moving], len(columns))
        return cls(
            capsules=capsules,
            boxes=boxes,
            pairs=pairs,
            others=others,
            radii=radii + _ROUNDING,
            columns=list(columns),
            links=links,
            moving=moving,
            moving_lines=capsules.lines[moving],
            carriers=carriers,
            levers=levers,
            still_lines=lines,
            still_bounds=np.concatenate([_bounds(lines), _around(boxes)], axis=1),
        )

    def names(self, pairs: Pairs, index: int) -> tuple[str, str]:
        """Return the two parts of a pair as one says them: the arm's first."""
        one, other = pairs.first[index], pairs.second[index]
        second = self.capsules.parts if index < pairs.rounded else self.boxes.parts
        first, last = self.capsules.parts[one], second[other]
        return (str(first), str(last)) if first.place >= last.place else (str(last), str(first))

    def within(self, lines: FloatArray, reach: FloatArray) -> Indices:
        """Return which pairs may be nearer than ``reach`` (P,) [m], and some that are not.

        ``lines`` (C, 4, 2) are the capsules, see `lines`. Two things are at least as far apart as
        the boxes around them.
        """
        bounds = self.still_bounds.copy()
        bounds[:, self.moving] = _bounds(lines[self.moving])
        # Lower ends of the one less upper ends of the other, and the other way round.
        one, other = bounds.take(self.pairs.first, axis=1), bounds.take(self.others, axis=1)
        gaps = np.maximum(one[:3] + other[3:], one[3:] + other[:3])
        x, y, z = np.maximum(gaps, 0.0) ** 2
        found: Indices = np.flatnonzero(np.sqrt(x + y + z) < reach + self.radii)
        return found

    def travels(self, before: FloatArray, after: FloatArray) -> FloatArray:
        """Return by how much (P,) [m] all pairs may come nearer between two sets of lines.

        A point between a capsule's two ends moves no further than the one that moves more.
        """
        way = after[self.moving, :3] - before[self.moving, :3]
        way[..., 1] += way[..., 0]  # of the ends: start and way move, added
        moved = np.zeros(len(self.levers))
        moved[self.moving] = np.sqrt(np.einsum("cij,cij->cj", way, way).max(axis=1))
        found: FloatArray = moved[self.pairs.first] + moved[self.others]
        return found

    def may_travel(self, turns: FloatArray) -> FloatArray:
        """Return by how much (P,) [m] pairs may come nearer while angles turn by ``turns`` (D,).

        That holds for all ways there, on which no angle turns by more: no point moves further than
        its levers times the turns.
        """
        moved = self.levers @ np.abs(turns)
        found: FloatArray = moved[self.pairs.first] + moved[self.others]
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
        """Return all capsules (..., C, 4, 2), start and way, for all angles (..., N) [rad].

        What is not in `columns` counts as where it rests.
        """
        return self.lines_of(angles[..., self.columns])

    def lines_of(self, driven: FloatArray) -> FloatArray:
        """Return the same for the angles (..., D) [rad] in `columns`."""
        rows = driven.reshape(-1, driven.shape[-1])
        lines = np.empty((len(rows), *self.still_lines.shape))
        lines[...] = self.still_lines
        moved = self.links.poses(rows)[self.carriers] @ self.moving_lines[:, None]
        lines[:, self.moving] = moved.transpose(1, 0, 2, 3)
        return lines.reshape(*driven.shape[:-1], *self.still_lines.shape)


def _levers(links: Moving, carriers: Indices, lines: FloatArray, count: int) -> FloatArray:
    """Return how far (C, D) [m] capsules' lines (C, 4, 2) can be from the axes that turn them.

    From joint to joint a way is never longer than in a stretched arm.
    """
    found = np.zeros((len(lines), count))
    column_of = dict(zip(links.turning, links.columns, strict=True))
    for levers, carrier, (start, end) in zip(found, carriers.tolist(), _ends(lines), strict=True):
        lever, link = max(np.linalg.norm(start), np.linalg.norm(end)), carrier
        while link < len(links.joints):  # what comes after them is at rest
            if link in column_of:
                levers[column_of[link]] = lever
            lever += np.linalg.norm(links.steps[link, :3, 3])
            link = links.carriers[link]
    return found


def _ends(lines: FloatArray) -> FloatArray:
    """Return both ends (C, 2, 3) of lines (C, 4, 2)."""
    return np.stack([lines[:, :3, 0], lines[:, :3, 0] + lines[:, :3, 1]], axis=1)


def _bounds(lines: FloatArray) -> FloatArray:
    """Return the boxes (6, C) around lines (C, 4, 2): lower ends, and the upper ones' negatives."""
    starts = lines[:, :3, 0].T
    ends = starts + lines[:, :3, 1].T
    return np.concatenate([np.minimum(starts, ends), -np.maximum(starts, ends)])


def _around(boxes: Boxes) -> FloatArray:
    """Return the same (6, B) around boxes."""
    T_base_box = np.linalg.inv(boxes.T_box_base)
    half = np.einsum("bij,bj->bi", np.abs(T_base_box[:, :3, :3]), boxes.half)
    middle = T_base_box[:, :3, 3]
    return np.concatenate([(middle - half).T, -(middle + half).T])


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
