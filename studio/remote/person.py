"""Parts of a snapshot: who teaches, and what is seen of it."""

from studio.remote.message import Part


class Progress(Part, frozen=True):
    """How far a calibration has come."""

    share: float
    words: str


class Source(Part, frozen=True):
    """The source of skeletons."""

    name: str
    frames: int
    seconds: float
    has_hand_states: bool
    is_live: bool


class Reading(Part, frozen=True):
    """A file that is being read."""

    name: str
    share: float | None
    waiting: int  # files after this one


class Puppet(Part, frozen=True):
    """The puppet: where hands and elbows are going [m], in camera space, and its signs."""

    goals: dict[str, tuple[float, float, float]]
    left_sign: str
    right_sign: str


class HandRun(Part, frozen=True):
    """What the hand has shown, from when to when [s]."""

    state: str
    armed: bool
    start: float
    end: float


class Who(Part, frozen=True):
    """Who teaches."""

    reading: Reading | None
    puppet: Puppet | None
    strip: list[HandRun]
    bodies: list[tuple[str, int | None]]  # and in how many frames; null for a live stream
    body: str | None  # that is followed; null: whoever is nearest


class Counts(Part, frozen=True):
    """Where the messages of live streams have gone."""

    received: int
    used: int
    dropped: int
    late: int
    others: int
    waiting: int
    too_fast: int
    unreadable: int


class Live(Part, frozen=True):
    """Live streams of skeletons."""

    address: str
    publishers: int
    driver: str
    protocol: str
    rate: float  # [Hz]
    age: float | None  # [s] of the newest frame
    tells_hands: bool
    counts: Counts


class Hand(Part, frozen=True):
    """What a hand shows, and how sure the sensor is of it, 0 to 1."""

    state: str
    confidence: float


class Skeleton(Part, frozen=True):
    """A person: 25 joints in the Kinect SDK's order, in camera space."""

    time: float  # [s]
    positions: list[tuple[float, float, float]]  # [m]
    tracking: list[int]  # 0 not tracked, 1 inferred, 2 tracked
    left_hand: Hand
    right_hand: Hand
    body_id: str


class GateState(Part, frozen=True):
    """The gate: whether the robot follows, or in words why not."""

    armed: bool
    lit: int  # signs that are believed, 0 to 3
    reason: str
    detail: str
    state: str  # the hand's
    held: float  # [s] for which the awaited sign was seen
    needed: float  # [s]
    confidence: float
    left: float | None  # [s] until it falls back


class Lag(Part, frozen=True):
    """By how much what is sent is behind the person."""

    angle: float  # [rad]
    seconds: float
