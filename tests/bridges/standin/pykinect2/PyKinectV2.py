"""The SDK's structures and numbers that a program for bodies meets, by the SDK's own names."""

import ctypes

FrameSourceTypes_Body = 32
JointType_Count = 25


class _CameraSpacePoint(ctypes.Structure):
    _fields_ = [("x", ctypes.c_float), ("y", ctypes.c_float), ("z", ctypes.c_float)]


class _Joint(ctypes.Structure):
    _fields_ = [
        ("JointType", ctypes.c_uint),
        ("Position", _CameraSpacePoint),
        ("TrackingState", ctypes.c_uint),
    ]
