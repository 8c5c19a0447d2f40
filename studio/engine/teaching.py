"""From demonstrations to a robot that does it alone, with the measures that say how well."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, Protocol

import numpy as np

from studio.engine.demonstration import SAMPLES, Demonstration, DemonstrationSet, resample
from studio.engine.errors import StudioError
from studio.engine.field_motion import OnePlainField, PushAndReturn
from studio.engine.hands import HandTrack
from studio.engine.learned_hands import learned_hands
from studio.engine.measures import Deviation, deviation
from studio.engine.performance import (
    Performance,
    Trajectory,
    joint_columns,
    perform,
    rows_as_trajectory,
)
from studio.engine.scene import Scene
from studio.engine.skeleton import FloatArray
from studio.rbf import NewrbRegressor, RBFRegressor, pooled_variance_floor

LearnerName = Literal["rbf", "newrb", "field", "plain-field"]
MOST_NEURONS = 1000


class Model(Protocol):
    """What the studio asks of a learner; scikit-learn's regressors have it too."""

    def fit(self, X: FloatArray, Y: FloatArray) -> "Model":
        """Learn Y (n, D) from X (n,)."""
        ...

    def predict(self, X: FloatArray) -> FloatArray:
        """Return (n, D) for X (n,)."""
        ...


LEARNERS: dict[LearnerName, Callable[[int], Model]] = {
    "rbf": lambda neurons: RBFRegressor(neurons, centers="grid", width="dmax", solver="svd"),
    "newrb": lambda neurons: NewrbRegressor(max_neurons=neurons),
    "field": PushAndReturn,
    "plain-field": OnePlainField,
}
# The paper's t is the sample's index, and newrb's spread is defined in its unit.
INDEX_TIME = np.arange(1.0, SAMPLES + 1.0)


@dataclass(frozen=True)
class LearnerSettings:
    """Which network, and of how many neurons."""

    name: LearnerName = "rbf"
    neurons: int = 50

    def __post_init__(self) -> None:
        if self.name not in LEARNERS:
            raise StudioError(f"unknown learner {self.name!r}; there are {', '.join(LEARNERS)}")
        if not 1 <= self.neurons <= MOST_NEURONS:
            raise StudioError(f"neurons: 1 to {MOST_NEURONS}, not {self.neurons}")


@dataclass(frozen=True, eq=False)
class Lesson:
    """A trained network beside what it was trained on."""

    settings: LearnerSettings
    taught: DemonstrationSet
    model: Model
    curve: FloatArray  # (142, D) [rad], the network's output at the demonstrations' stamps
    mse: FloatArray  # (D,) [rad²] over all demonstrations
    floor: FloatArray | None  # (D,) [rad²], below which no network gets
    floor_note: str  # why there is no floor, or nothing
    remark: str = ""  # what the learner says of itself: a field's certificate

    def trajectory(self) -> Trajectory:
        """Return the network's output over the demonstrations' mean duration."""
        return model_as_trajectory(self.model, self.taught.duration)

    @cached_property
    def hands(self) -> HandTrack | None:
        """What the hands do meanwhile, the grip learned by as many neurons; None without hands."""
        return learned_hands(self.taught, LEARNERS["rbf"](self.settings.neurons), INDEX_TIME)


@dataclass(frozen=True, eq=False)
class Reproduction:
    """What the robot did alone, against the mean sent demonstration."""

    performance: Performance
    deviation: Deviation


@dataclass(frozen=True, eq=False)
class Replay:
    """A demonstration's own replay: as it was sent, and as resampled to 142 rows."""

    performance: Performance  # of the resampled one
    interpolation: Deviation  # of the raw one's measured motion from the resampled one's


def model_as_trajectory(model: Model, duration: float) -> Trajectory:
    """Return a model's output on index time as a trajectory over a duration [s]."""
    per_second = (SAMPLES - 1) / duration

    def at(time: float) -> FloatArray:
        output: FloatArray = model.predict(np.array([[1.0 + time * per_second]]))[0]
        return output

    return at


def remark_of(model: Model) -> str:
    """Return what a learner says of itself, such as a field's certificate, or nothing."""
    remark: str = getattr(model, "remark", "")
    return remark


def learn(taught: DemonstrationSet, settings: LearnerSettings) -> Lesson:
    """Train a network on index time; every demonstration's row i has the input i."""
    count = len(taught.rows)
    model = LEARNERS[settings.name](settings.neurons)
    model.fit(np.tile(INDEX_TIME, count), taught.rows.reshape(count * SAMPLES, -1))
    curve = model.predict(INDEX_TIME)
    mse = np.mean((taught.rows - curve) ** 2, axis=(0, 1))
    floor = pooled_variance_floor(taught.rows)
    return Lesson(settings, taught, model, curve, mse, floor.value, floor.reason, remark_of(model))


def reproduce(lesson: Lesson, scene: Scene | None = None) -> Reproduction:
    """Let the robot do alone what it learned, in a fresh world, in the scene where it was taught.

    ``scene`` is another one.
    """
    taught = lesson.taught
    trajectory, where = lesson.trajectory(), scene or taught.scene
    how = (taught.duration, taught.arms, taught.mapping, lesson.hands)
    performance = perform(trajectory, *how, where)
    error = deviation(performance, taught.mean, taught.joints, lesson.hands)
    return Reproduction(performance, error)


def replay(
    demonstration: Demonstration, rows: FloatArray | None = None, scene: Scene | None = None
) -> Replay:
    """Play a demonstration back, raw and resampled, each in a fresh world.

    The difference of the two measures the paper's claim that its interpolation has no effect on the
    robot's trajectory. ``rows`` (142, D) [rad] are its resampled rows, even ones by default;
    ``scene`` is the one in which it was taught, unless given.
    """
    scene = scene or demonstration.scene
    rows = resample(demonstration) if rows is None else rows
    arms, mapping, duration = demonstration.arms, demonstration.mapping, demonstration.duration
    hands = demonstration.hands
    raw = perform(demonstration.trajectory(), duration, arms, mapping, hands, scene)
    resampled = perform(rows_as_trajectory(rows, duration), duration, arms, mapping, hands, scene)
    measured = resampled.measured_at(np.linspace(0.0, duration, SAMPLES))
    measured = measured[:, joint_columns(demonstration.joints)]
    return Replay(resampled, deviation(raw, measured, demonstration.joints, hands))
