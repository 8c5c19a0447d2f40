"""What differs between trials: six variations, each a distribution with its reason.

Trial i draws each of them from a generator of its own, seeded by (seed, i, variation). So a trial
is the same whichever process does it, whoever does the motion in it, and whatever else varies: all
that is compared meets the same trials (common random numbers), and a variation that is switched off
leaves the others as they were.

How wide each of them is, is our choice, and no measurement of any robot or workshop:

block      uniform in a square around where the blocks were taught: somebody sets them up by eye.
           All blocks are shifted alike, as if it were the robot that stands elsewhere. Where they
           would stand beside the desk, in Baxter or in their zone already, the trial would be
           decided before it begins: then it is drawn again from the same generator, up to `TRIES`
           times, and after that they stand where they were taught.
friction   uniform factor of the blocks' friction: a desk is wiped or it is not. Multiplied
           with the desk's, that of the shipped scenes is 0.3 to 0.6; tables have 0.25 to 0.5 for
           dry and clean wood on wood
           (https://mech.subwiki.org/wiki/Table_of_friction_coefficients).
mass       uniform factor of the blocks' mass: another block of the same size is of another wood.
start      uniform offset of each driven joint where the robot waits: it was left there by hand.
noise      normal: a constant offset of each driven joint for the whole trial, and a fifth of that
           anew in each tick. A shoulder that is off by 0.25° leads a hand 4 mm off, a meter away.
latency    whole control ticks: a trial has a largest latency, uniform from 0 to the width; each
           command takes a uniform one up to that, and the newest that is there holds, as with
           V-REP's non-blocking calls. A latency that stays the same would only delay the motion.
"""

from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from studio.engine.errors import StudioError
from studio.engine.scene import Scene
from studio.engine.scene_check import can_begin
from studio.engine.skeleton import FloatArray

TRIES = 100  # draws of where blocks stand, before they stay where they were taught
JITTER = 0.2  # of the constant offset's standard deviation: that of a tick's
_DRAWS = ("block", "friction", "mass", "start", "noise", "latency")
# Their units as people are told, and how many of these one of ours is.
_UNITS = {
    "block": ("cm", 100.0),
    "friction": ("%", 100.0),
    "mass": ("%", 100.0),
    "start": ("degrees", 1.0),
    "noise": ("degrees", 1.0),
    "latency": ("ticks", 1.0),
}
_MOST = {"block": 0.2, "friction": 0.95, "mass": 0.95, "start": 30.0, "noise": 10.0, "latency": 30}


@dataclass(frozen=True)
class Variations:
    """How wide each variation is; 0 switches it off.

    Raises
    ------
    StudioError
        Where a width is negative, not finite, or far beyond what its name means.
    """

    block: float = 0.03  # [m] to each side
    friction: float = 0.3  # of the usual one, to each side
    mass: float = 0.3  # of the usual one, to each side
    start: float = 5.0  # [deg] to each side
    noise: float = 0.25  # [deg] standard deviation
    latency: int = 3  # [ticks] at most

    def __post_init__(self) -> None:
        for name, most in _MOST.items():
            width = getattr(self, name)
            if not 0.0 <= width <= most:
                unit, scale = _UNITS[name]
                raise StudioError(
                    f"{name}: a variation of 0 to {scale * most:g} {unit} is possible, not "
                    f"{scale * width:g}"
                )

    def only(self, names: tuple[str, ...]) -> "Variations":
        """Return these, all others than the named ones switched off.

        Raises
        ------
        StudioError
            Where there is no variation of such a name.
        """
        for name in names:
            if name not in _DRAWS:
                raise StudioError(f"no variation {name!r}; there are {', '.join(_DRAWS)}")
        return replace(self, **{name: 0 for name in _DRAWS if name not in names})

    @property
    def words(self) -> str:
        """What varies, in words and units."""
        told = {
            "block": f"blocks ±{100 * self.block:g} cm in x and y",
            "friction": f"friction ±{100 * self.friction:g} %",
            "mass": f"mass ±{100 * self.mass:g} %",
            "start": f"start pose ±{self.start:g}° a joint",
            "noise": f"joints' offset {self.noise:g}° (standard deviation)",
            "latency": f"latency up to {self.latency} ticks",
        }
        shown = [words for name, words in told.items() if getattr(self, name)]
        return ", ".join(shown) or "nothing varies"


@dataclass(frozen=True, eq=False)
class Variation:
    """One trial's draws, for D driven joints."""

    block: FloatArray  # (2,) [m] x, y by which all blocks are shifted, as the scene tells places
    friction: float  # factor
    mass: float  # factor
    start: FloatArray  # (D,) [rad]
    offset: FloatArray  # (D,) [rad]
    jitter: float  # [rad] standard deviation of what comes anew in each tick
    latency: int  # [ticks] the largest
    seed: tuple[int, int]  # the evaluation's, and the trial's number

    def scene(self, usual: Scene) -> Scene:
        """Return a scene as it is in this trial."""
        moved = _shifted(usual, self.block)
        blocks = tuple(
            replace(block, mass=block.mass * self.mass, friction=block.friction * self.friction)
            for block in moved.blocks
        )
        return replace(moved, blocks=blocks)

    def offsets(self, ticks: int) -> FloatArray:
        """Return by how much the joints miss what they are told (T, D) [rad]."""
        each = _generator(*self.seed, "noise", 1).normal(size=(ticks, len(self.offset)))
        return self.offset + self.jitter * each

    def arrived(self, ticks: int) -> NDArray[np.int64]:
        """Return which command is the newest that is there in each tick (T,); -1 for none yet."""
        share = _generator(*self.seed, "latency", 1).random(ticks)
        sent = np.arange(ticks)
        arrival = sent + np.floor(share * (self.latency + 1)).astype(int)
        newest = np.full(ticks + self.latency, -1)
        np.maximum.at(newest, arrival, sent)
        found: NDArray[np.int64] = np.maximum.accumulate(newest)[:ticks]
        return found

    @property
    def measures(self) -> dict[str, float]:
        """What was drawn, as one number each, in the units that people read."""
        return {
            "block x [cm]": 100.0 * float(self.block[0]),
            "block y [cm]": 100.0 * float(self.block[1]),
            "friction [%]": 100.0 * self.friction,
            "mass [%]": 100.0 * self.mass,
            "start, largest [deg]": float(np.degrees(np.abs(self.start).max())),
            "noise, largest [deg]": float(np.degrees(np.abs(self.offset).max())),
            "latency [ticks]": float(self.latency),
        }


def draw(widths: Variations, seed: int, trial: int, joints: int, scene: Scene) -> Variation:
    """Return what differs in trial number ``trial`` of a scene for that many driven joints."""

    def uniform(name: str, count: int) -> FloatArray:
        found: FloatArray = _generator(seed, trial, name).uniform(-1.0, 1.0, count)
        return found

    offsets = _generator(seed, trial, "noise").normal(size=joints)
    noise = np.radians(widths.noise)
    share = float(_generator(seed, trial, "latency").random())
    return Variation(
        block=_shift(widths.block, seed, trial, scene),
        friction=1.0 + widths.friction * float(uniform("friction", 1)[0]),
        mass=1.0 + widths.mass * float(uniform("mass", 1)[0]),
        start=np.radians(widths.start) * uniform("start", joints),
        offset=noise * offsets,
        jitter=float(JITTER * noise),
        latency=int(share * (widths.latency + 1)),
        seed=(seed, trial),
    )


def _shift(width: float, seed: int, trial: int, scene: Scene) -> FloatArray:
    """Return by how much all blocks are shifted (2,) [m], so that the task can begin."""
    generator = _generator(seed, trial, "block")
    for _ in range(TRIES if width else 0):
        shift: FloatArray = width * generator.uniform(-1.0, 1.0, 2)
        if can_begin(_shifted(scene, shift)):
            return shift
    return np.zeros(2)


def _shifted(scene: Scene, shift: FloatArray) -> Scene:
    dx, dy = shift.tolist()
    blocks = tuple(
        replace(block, position=(block.position[0] + dx, block.position[1] + dy, block.position[2]))
        for block in scene.blocks
    )
    return replace(scene, blocks=blocks)


def widths_of(variations: Variations) -> dict[str, float]:
    """Return the widths by name, as they are written down."""
    return {field.name: getattr(variations, field.name) for field in fields(variations)}


def _generator(seed: int, trial: int, name: str, part: int = 0) -> np.random.Generator:
    return np.random.default_rng([seed, trial, _DRAWS.index(name), part])
