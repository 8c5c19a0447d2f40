"""The person's arm: its directions, and the paper's six angles of it (Fig. 5, Eq. 1-4)."""

from dataclasses import dataclass

from studio.engine.skeleton import (
    SIDES,
    FloatArray,
    Joint,
    Side,
    Skeleton,
    Tracking,
    other_side,
)
from studio.engine.vectors import Vector, angle_between, cross, dot, norm, subtract, unit

SHORTEST_BONE = 0.02  # [m]; a shorter one is a sensor's fault and has no direction worth following
LONGEST_BONE = 1.0  # [m]; nobody's is half as long: another unit, or two people taken for one


# What an arm's directions need: the arm itself, then the torso.
_NEEDED: dict[Side, list[int]] = {
    side: [
        *(Joint.of(part, side) for part in ("shoulder", "elbow", "wrist")),
        Joint.of("shoulder", other_side(side)),
        Joint.SPINE_BASE,
        Joint.SPINE_SHOULDER,
    ]
    for side in SIDES
}


@dataclass(frozen=True)
class Held:
    """A refusal: why the robot stays where it is, in words."""

    reason: str


@dataclass(frozen=True)
class TorsoFrame:
    """The torso's axes in camera space: x forward, y to the person's left, z up (as in ROS)."""

    x: Vector
    y: Vector
    z: Vector

    def from_camera(self, vector: Vector) -> Vector:
        """Return a camera-space vector in the torso's frame."""
        return (dot(self.x, vector), dot(self.y, vector), dot(self.z, vector))


@dataclass(frozen=True)
class ArmVectors:
    """One arm in camera space: the torso's frame and unit vectors along upper arm and forearm."""

    torso: TorsoFrame
    upper_arm: Vector
    forearm: Vector
    upper_arm_inferred: bool = False  # one of its ends the sensor has guessed, not seen
    forearm_inferred: bool = False


@dataclass(frozen=True)
class HumanArmAngles:
    """The paper's six angles [rad] (Fig. 5), each from 0 to π; NaN where a bone has no length."""

    shoulder_yaw: float
    shoulder_pitch: float
    shoulder_roll: float
    elbow_pitch: float
    elbow_roll: float
    hand_yaw: float


def torso_frame(left: Vector, up: Vector) -> TorsoFrame | None:
    """Return the frame with y along ``left`` and ``up`` in its xz plane.

    With l = unit(left): x = unit(l × up), z = x × l. None where the two are parallel.
    """
    y = unit(left)
    if y is None:
        return None
    x = unit(cross(y, up))
    return None if x is None else TorsoFrame(x, y, cross(x, y))


def arm_vectors(skeleton: Skeleton, side: Side) -> ArmVectors | Held:
    """Return the directions of one arm and of the torso, or why there are none."""
    needed = _NEEDED[side]
    tracking = skeleton.tracking[needed].tolist()
    if Tracking.NOT_TRACKED in tracking:
        lost = Joint(needed[tracking.index(Tracking.NOT_TRACKED)])
        return Held(f"{_spoken(lost)} not tracked")
    points = _points(skeleton.positions[needed])
    shoulder, elbow, wrist, other_shoulder, spine_base, spine_shoulder = points
    left, right = (shoulder, other_shoulder) if side == "left" else (other_shoulder, shoulder)
    torso = torso_frame(subtract(left, right), subtract(spine_shoulder, spine_base))
    if torso is None:
        return Held("shoulders and spine span no torso")
    upper_arm, forearm = subtract(elbow, shoulder), subtract(wrist, elbow)
    for name, bone in (("upper arm", upper_arm), ("forearm", forearm)):
        if norm(bone) < SHORTEST_BONE:
            return Held(f"{side} {name} shorter than {SHORTEST_BONE * 100:.0f} cm")
        if not norm(bone) <= LONGEST_BONE:
            return Held(f"{side} {name} longer than {LONGEST_BONE:g} m: are these meters?")
    upper_arm_direction, forearm_direction = unit(upper_arm), unit(forearm)
    if upper_arm_direction is None or forearm_direction is None:
        return Held(f"{side} arm has no direction")
    at_shoulder, at_elbow, at_wrist = (state == Tracking.INFERRED for state in tracking[:3])
    return ArmVectors(
        torso,
        upper_arm_direction,
        forearm_direction,
        upper_arm_inferred=at_shoulder or at_elbow,
        forearm_inferred=at_elbow or at_wrist,
    )


def human_arm_angles(skeleton: Skeleton, side: Side) -> HumanArmAngles:
    """Return all six angles of the paper's Fig. 5, by the space vector approach of its Eq. 1-4.

    The figure's letters are not in the paper's text; this is our reading of them: O the hip of the
    same side, D the other shoulder, E the shoulder, F the elbow, G the wrist, N the thumb, Q the
    hand's tip; J and K are the projections of F and D on the camera's XOZ plane, and the vertex
    of ∠KOJ is O projected on it too.

    - shoulder yaw ∠KOJ, shoulder pitch ∠OEF, elbow pitch ∠EFG (0 when folded, π when straight)
    - shoulder roll ∠LEM, between the normals LE = EF × FG and ME = EF × DE
    - elbow roll, between LE and GN; hand yaw, between GN and GQ

    Deviations from the paper: each angle is taken by atan2 of the cross and the dot product rather
    than by the arccos of Eq. 3 (equal, but exact near 0 and π). Like the paper's they carry no
    sign. The robot is not driven by these: see `studio.engine.retarget`, which works in the
    torso's frame and so does not care how the person stands before the sensor.
    """
    at = _points(skeleton.positions)
    o, e, f, g, n, q = (
        at[Joint.of(part, side)]
        for part in ("hip", "shoulder", "elbow", "wrist", "thumb", "hand_tip")
    )
    d = at[Joint.of("shoulder", other_side(side))]
    ef, fg = subtract(f, e), subtract(g, f)
    normal_le, normal_me = cross(ef, fg), cross(ef, subtract(e, d))
    gn = subtract(n, g)
    return HumanArmAngles(
        shoulder_yaw=angle_between(_on_floor(subtract(d, o)), _on_floor(subtract(f, o))),
        shoulder_pitch=angle_between(subtract(o, e), ef),
        shoulder_roll=angle_between(normal_le, normal_me),
        elbow_pitch=angle_between(subtract(e, f), fg),
        elbow_roll=angle_between(normal_le, gn),
        hand_yaw=angle_between(gn, subtract(q, g)),
    )


def _points(positions: FloatArray) -> list[Vector]:
    return [(x, y, z) for x, y, z in positions.tolist()]


def _on_floor(vector: Vector) -> Vector:
    return (vector[0], 0.0, vector[2])


def _spoken(joint: Joint) -> str:
    """Return a joint's name as one says it: ``left wrist``."""
    *part, side = joint.name.lower().split("_")
    return " ".join([side, *part]) if side in SIDES else " ".join([*part, side])
