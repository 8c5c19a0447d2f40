"""A Kinect's 25 joints out of MediaPipe's 33 landmarks of a body, in meters before the camera.

MediaPipe's world landmarks are in meters from the middle of the hips, x to the right in the
picture, y down, z away from the camera; "left" is the person's own left. Camera space is that
turned by half a turn about z, so that it stays right-handed: x to the right of a person who faces
the camera, y up, z away.

**Where the person stands** is not in the world landmarks. It is the shift t that brings their
projection nearest to the landmarks in the picture, through a pinhole in the picture's middle with
`FIELD_OF_VIEW` across its longer side: u = f (x + t_x) / (z + t_z), linear in t, so solved by
least squares over what is visible in the picture. The field of view is assumed: a camera with a
wider one sees people stand farther off than they are. Directions do not depend on it. Where the
fit is degenerate or farther than a room, the person is put `USUAL_DISTANCE` away.

**Tracking** is from each landmark's visibility: tracked from `TRACKED_FROM`, inferred from
`INFERRED_FROM`, and never tracked outside of the picture. What lies between landmarks is tracked
as its parts are, with one exception: while both shoulders are seen the spine is at least
inferred, so that somebody at a desk, whose hips the camera does not see, can drive an arm.
"""

import math

import numpy as np
from numpy.typing import NDArray

from studio.engine.skeleton import SIDES, FloatArray, Joint, Side, Tracking

LANDMARK_COUNT = 33
FIELD_OF_VIEW = math.radians(60.0)  # across the picture's longer side; webcams have 55 to 78
USUAL_DISTANCE = 2.0  # [m]
NEAREST, FARTHEST = 0.3, 10.0  # [m] where a person can stand
TRACKED_FROM, INFERRED_FROM = 0.5, 0.1  # of visibility
_FEWEST_POINTS = 4  # in the picture, for a fit
_SMALLEST_SPREAD = 0.02  # of the picture's longer side; less is noise

_LEFT_EAR, _RIGHT_EAR = 7, 8
_LEFT = {
    **{"shoulder": 11, "elbow": 13, "wrist": 15, "hip": 23, "knee": 25, "ankle": 27, "foot": 31},
    **{"little_knuckle": 17, "index_knuckle": 19, "thumb": 21},
}
_SAME = ("shoulder", "elbow", "wrist", "hip", "knee", "ankle", "foot", "thumb")
_NECK = 0.36  # of the way from the shoulders to the head, as on a Kinect


def landmark(part: str, side: Side) -> int:
    """Return the number of a body's landmark: ``landmark("wrist", "left")``."""
    return _LEFT[part] + SIDES.index(side)


def joints_of(points: FloatArray) -> FloatArray:
    """Return the joints (25, 3) among or between the landmarks (33, 3), in any axes and unit."""
    joints = np.empty((len(Joint), 3))
    for side in SIDES:
        for part in _SAME:
            joints[Joint.of(part, side)] = points[landmark(part, side)]
        wrist, index, little = (
            points[landmark(part, side)] for part in ("wrist", "index_knuckle", "little_knuckle")
        )
        joints[Joint.of("hand", side)] = (wrist + index + little) / 3.0
        joints[Joint.of("hand_tip", side)] = (index + little) / 2.0
    base = (joints[Joint.HIP_LEFT] + joints[Joint.HIP_RIGHT]) / 2.0
    top = (joints[Joint.SHOULDER_LEFT] + joints[Joint.SHOULDER_RIGHT]) / 2.0
    head = (points[_LEFT_EAR] + points[_RIGHT_EAR]) / 2.0
    joints[Joint.SPINE_BASE], joints[Joint.SPINE_SHOULDER], joints[Joint.HEAD] = base, top, head
    joints[Joint.SPINE_MID] = (base + top) / 2.0
    joints[Joint.NECK] = top + _NECK * (head - top)
    return joints


def tracking_of(visibility: FloatArray, picture: FloatArray | None) -> NDArray[np.int8]:
    """Return the joints' tracking (25,) for the landmarks' visibility (33,) and places (33, 2)."""
    states = np.where(visibility >= INFERRED_FROM, Tracking.INFERRED, Tracking.NOT_TRACKED)
    seen = (visibility >= TRACKED_FROM) & _inside(picture)
    states = np.where(seen, Tracking.TRACKED, states)
    joints = np.empty(len(Joint), dtype=np.int8)
    for side in SIDES:
        for part in _SAME:
            joints[Joint.of(part, side)] = states[landmark(part, side)]
        knuckles = states[[landmark(f"{finger}_knuckle", side) for finger in ("index", "little")]]
        wrist = states[landmark("wrist", side)]
        joints[Joint.of("hand", side)] = min(wrist, *knuckles)
        # Knuckles stand in for the hand's tip, so it is inferred at best.
        joints[Joint.of("hand_tip", side)] = min(Tracking.INFERRED, *knuckles)
    top = min(joints[Joint.SHOULDER_LEFT], joints[Joint.SHOULDER_RIGHT])
    hips = min(joints[Joint.HIP_LEFT], joints[Joint.HIP_RIGHT])
    base = max(hips, min(top, Tracking.INFERRED))
    joints[[Joint.SPINE_SHOULDER, Joint.NECK]] = top
    joints[[Joint.SPINE_BASE, Joint.SPINE_MID]] = base
    joints[Joint.HEAD] = max(states[_LEFT_EAR], states[_RIGHT_EAR])
    return joints


def place_of(
    points: FloatArray, visibility: FloatArray, picture: FloatArray | None, size: FloatArray
) -> FloatArray:
    """Return where the middle of the hips is (3,) [m], in MediaPipe's axes, from the camera on.

    Parameters
    ----------
    points : array (33, 3)
        World landmarks [m], in MediaPipe's axes.
    visibility : array (33,)
    picture : array (33, 2) or None
        The landmarks in the picture, from 0 to 1 across its width and height.
    size : array (2,)
        The picture's width and height, in any one unit.
    """
    straight_ahead = np.array([0.0, 0.0, USUAL_DISTANCE])
    if picture is None:
        return straight_ahead
    focal = 0.5 * float(size.max()) / math.tan(FIELD_OF_VIEW / 2.0)
    rays = (picture - 0.5) * size / focal  # (33, 2): x / z and y / z of what is seen there
    seen = (visibility >= TRACKED_FROM) & _inside(picture)
    if not seen.any():
        return straight_ahead
    shift = _fit(points[seen], rays[seen])
    if shift is not None and NEAREST <= shift[2] <= FARTHEST:
        return shift
    depth = points[seen, 2:] + USUAL_DISTANCE
    aside = (rays[seen] * depth - points[seen, :2]).mean(axis=0)
    return np.array([*aside, USUAL_DISTANCE])


def to_camera_space(points: FloatArray) -> FloatArray:
    """Return points (n, 3) in MediaPipe's axes as the Kinect has them: half a turn about z."""
    turned: FloatArray = points * (-1.0, -1.0, 1.0)
    return turned


def _inside(picture: FloatArray | None) -> NDArray[np.bool_]:
    if picture is None:
        return np.ones(LANDMARK_COUNT, dtype=bool)
    inside = (picture >= 0.0) & (picture <= 1.0)
    return np.asarray(inside.all(axis=1), dtype=np.bool_)


def _fit(points: FloatArray, rays: FloatArray) -> FloatArray | None:
    """Return the shift (3,) [m] by which points (n, 3) are seen along rays (n, 2), if it shows.

    For each point and both axes: t_axis - ray t_z = ray z - point_axis.
    """
    if len(points) < _FEWEST_POINTS or np.ptp(rays, axis=0).max() < _SMALLEST_SPREAD:
        return None
    count = len(points)
    left = np.zeros((count, 2, 3))
    left[:, 0, 0] = left[:, 1, 1] = 1.0
    left[:, :, 2] = -rays
    right = rays * points[:, 2:] - points[:, :2]
    solved, _, rank, _ = np.linalg.lstsq(left.reshape(-1, 3), right.reshape(-1), rcond=None)
    shift: FloatArray = solved.astype(float)
    return shift if rank == 3 and np.isfinite(shift).all() else None
