"""How a person of 1.75 m is built and stands before the sensor: the demonstrator's, the puppet's.

Torso's frame: x forward, y to the person's left, z up, from the middle of the hips.
"""

from studio.engine.skeleton import Joint

TRUNK: dict[Joint, tuple[float, float, float]] = {  # [m] all joints but those of the arms
    Joint.SPINE_BASE: (0.0, 0.0, 0.0),
    Joint.SPINE_MID: (0.0, 0.0, 0.29),
    Joint.SPINE_SHOULDER: (0.0, 0.0, 0.50),
    Joint.NECK: (0.0, 0.0, 0.57),
    Joint.HEAD: (0.02, 0.0, 0.72),
    Joint.SHOULDER_LEFT: (0.0, 0.18, 0.46),
    Joint.SHOULDER_RIGHT: (0.0, -0.18, 0.46),
    Joint.HIP_LEFT: (0.0, 0.08, -0.03),
    Joint.HIP_RIGHT: (0.0, -0.08, -0.03),
    Joint.KNEE_LEFT: (0.03, 0.10, -0.43),
    Joint.KNEE_RIGHT: (0.03, -0.10, -0.43),
    Joint.ANKLE_LEFT: (0.0, 0.11, -0.82),
    Joint.ANKLE_RIGHT: (0.0, -0.11, -0.82),
    Joint.FOOT_LEFT: (0.11, 0.12, -0.88),
    Joint.FOOT_RIGHT: (0.11, -0.12, -0.88),
}
UPPER_ARM, FOREARM = 0.27, 0.24  # [m] shoulder to elbow, elbow to wrist
TO_HAND, TO_TIP = 0.07, 0.15  # [m] from the wrist, on along the forearm
SENSOR_TO_HIP = -0.25  # [m] the hips' height relative to the sensor
DISTANCE = 2.2  # [m] of the hips from the sensor
