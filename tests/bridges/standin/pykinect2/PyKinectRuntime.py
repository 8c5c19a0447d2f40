"""PyKinect2's runtime as programs see it, in its two generations.

- "repository": what its repository holds today.
- "packaged": 0.1.0, what pip installs. It calls a frame new for ever, and tells no relative time.

A script of frames takes the sensor's place. Each entry is None where the sensor sends nothing in
that thirtieth of a second, else (relative time [100 ns], people); a person is a dictionary with
the attributes of a tracked body, joints as 25 x (x, y, z, tracking state).
"""

import ctypes
import json
import os
import time

import numpy as np

from pykinect2 import PyKinectV2

SEATS = 6
_POINTER = ctypes.POINTER(PyKinectV2._Joint)


class KinectBody:
    """A seat; who sits in it has further attributes."""

    def __init__(self, person=None):
        self.is_restricted, self.tracking_id, self.is_tracked = False, -1, False
        if person is None:
            return
        self.is_tracked = True
        joints = (PyKinectV2._Joint * PyKinectV2.JointType_Count)()
        for index, (x, y, z, tracking) in enumerate(person["joints"]):
            joints[index] = PyKinectV2._Joint(
                index, PyKinectV2._CameraSpacePoint(x, y, z), tracking
            )
        for name, value in person.items():
            setattr(self, name, value)
        self.joints = ctypes.cast(joints, _POINTER)  # not an array: it has no length


class KinectBodyFrameData:
    """A frame of all seats."""

    def __init__(self, bodies, relative_time):
        self.floor_clip_plane = None
        if relative_time is not None:
            self.relative_time = relative_time
        self.bodies = bodies

    def copy(self):
        """Copy the list of seats, not the seats."""
        return KinectBodyFrameData(np.copy(self.bodies), getattr(self, "relative_time", None))


class PyKinectRuntime:
    """Without a script it plays the file that PYKINECT2_SCRIPT names, at 30 Hz."""

    def __init__(self, frame_source_types, script=None, generation="repository"):
        if frame_source_types != PyKinectV2.FrameSourceTypes_Body:
            raise ValueError("only bodies are wanted")
        self.max_body_count = SEATS
        self.closed = False
        self._packaged = generation == "packaged"
        self._script = script
        self._began = None
        if script is None:
            with open(os.environ["PYKINECT2_SCRIPT"]) as stream:
                self._script = json.load(stream)
            self._began = time.perf_counter()
        self._arrived = self._read = self._entry = 0
        self._newest = None

    def tick(self):
        """Let a thirtieth of a second pass."""
        entry = self._script[self._entry] if self._entry < len(self._script) else None
        self._entry += 1
        if entry is None:
            return
        ticks, people = entry
        bodies = np.empty(SEATS, dtype=object)
        for seat in range(SEATS):
            bodies[seat] = KinectBody(people[seat] if seat < len(people) else None)
        self._newest = KinectBodyFrameData(bodies, None if self._packaged else ticks)
        self._arrived += 1

    def has_new_body_frame(self):
        """Tell whether a frame came since the last one was taken."""
        while self._began is not None and time.perf_counter() - self._began > self._entry / 30:
            self.tick()
        return self._arrived > self._read

    def get_last_body_frame(self):
        """Return the newest frame, None before the first."""
        if not self._packaged:
            self._read = self._arrived
        return None if self._newest is None else self._newest.copy()

    def close(self):
        """Let go of the sensor."""
        self.closed = True
