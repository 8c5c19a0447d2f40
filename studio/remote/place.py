"""Parts of a snapshot: the robot, and what stands around it."""

from studio.remote.message import Part


class World(Part, frozen=True):
    """The world: joints in the order that `Welcome` tells, blocks as x y z [m] qx qy qz qw."""

    time: float  # [s] since it began
    joint_positions: list[float]  # [rad]
    joint_velocities: list[float]  # [rad/s]
    block_poses: list[list[float]]
    touched: bool
    tilt: float  # [rad] of the task's block
    block_down: bool
    done: bool  # the scene's task
    missing: str  # for that, in words
    fingers: list[float]  # [m] how far out


class Desk(Part, frozen=True):
    """A desk's top."""

    size: tuple[float, float, float]  # along x, y, z [m]
    position: tuple[float, float, float]  # of the middle of the top [m]


class Box(Part, frozen=True):
    """A block, as it stands at the beginning."""

    name: str
    size: tuple[float, float, float]  # along x, y, z [m]
    position: tuple[float, float, float]  # of its center [m]
    mass: float  # [kg]
    friction: float


class Zone(Part, frozen=True):
    """A rectangle on the desk."""

    name: str
    center: tuple[float, float]  # x, y [m]
    size: tuple[float, float]  # along x, y [m]


class Scene(Part, frozen=True):
    """What stands around the robot, and what is to be done with it."""

    name: str
    words: str
    both_arms: bool
    gripper: bool
    desk: Desk
    blocks: list[Box]
    zones: list[Zone]


class Driven(Part, frozen=True):
    """A robot that a program drives."""

    joints: list[str]
    follows: bool  # it came to where the program began, and keeps up
    arrived: bool
    holds: bool  # the program was silent for too long


class LinkedRobot(Part, frozen=True):
    """A robot beyond the simulator."""

    url: str  # empty where none is to be linked
    is_connected: bool
    words: str
    phase: str
    ratio: float  # of its top speed
    is_enabled: bool
    stop: str  # which emergency stop holds it
    resets: bool
    is_moving: bool
    lag: float  # [rad]
    guarded: str
    measured: list[float | None] | None  # [rad]; null where it does not tell
