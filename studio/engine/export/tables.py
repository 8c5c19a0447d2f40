"""Tables for spreadsheets and programs: comma-separated, units in the header, every digit kept.

demonstrations.csv  what was taught, resampled: K x 142 rows
network.csv         what was learned, beside the mean demonstration: 142 rows
between.csv         the same between the samples, beside a smoothing spline: 1975 rows
held-out.csv        for each demonstration, what a network learned from the others alone
centers.csv         the network's Gaussians
reproduction.csv    what the robot did alone, as measured, tick by tick
comparison.csv      the same at the 142 stamps, beside the mean demonstration; joints and hands
"""

import csv
import io
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import make_smoothing_spline

from studio.engine.arms import sides_of
from studio.engine.demonstration import SAMPLES, DemonstrationSet
from studio.engine.export.files import write_text
from studio.engine.export.kind import Job
from studio.engine.export.material import Material
from studio.engine.measures import body_as_meant, hand_path
from studio.engine.performance import joint_columns
from studio.engine.robot import CONTROL_PERIOD, JOINT_NAMES
from studio.engine.skeleton import FloatArray
from studio.engine.teaching import INDEX_TIME, Lesson, Reproduction
from studio.rbf import LeaveOneDemonstrationOut, NewrbRegressor, RBFRegressor
from studio.rbf.offgrid import FINER

FILES = (
    "demonstrations.csv",
    "network.csv",
    "between.csv",
    "centers.csv",
    "held-out.csv",
    "reproduction.csv",
    "comparison.csv",
)
_FORMULA = ("=", "+", "-", "@", "\t", "\r")  # what a spreadsheet would take for a formula


@dataclass(frozen=True, eq=False)
class Table:
    """Columns of numbers by name, and perhaps one of words at the end."""

    columns: dict[str, FloatArray]  # (n,) each
    words: tuple[str, list[str]] | None = None

    def text(self) -> str:
        """Return the table as CSV; each number has the digits that bring it back exactly."""
        columns: dict[str, list[Any]] = {
            name: _counted(name, column) for name, column in self.columns.items()
        }
        if self.words is not None:
            columns[self.words[0]] = [_plain(word) for word in self.words[1]]
        stream = io.StringIO()
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*columns.values(), strict=True))
        return stream.getvalue()


def write(material: Material, job: Job) -> tuple[Path, ...]:
    """Write all tables that there is something for."""
    tables = tables_of(material)
    paths = []
    for name, table in tables.items():
        paths.append(job.folder / name)
        write_text(paths[-1], table.text())
        job.done(len(paths) / len(tables))
    return tuple(paths)


def tables_of(material: Material) -> dict[str, Table]:
    """Return all tables by the names of their files."""
    lesson, reproduction = material.lesson, material.reproduction
    tables = {"demonstrations.csv": demonstrations(material.taught)}
    if lesson is not None:
        tables |= {"network.csv": network(lesson), "between.csv": between(lesson)}
        if isinstance(lesson.model, RBFRegressor | NewrbRegressor):
            tables["centers.csv"] = centers(lesson.model)
        if len(lesson.taught.rows) > 1:
            tables["held-out.csv"] = held_out(lesson)
        if reproduction is not None:
            tables["reproduction.csv"] = measured(reproduction)
            tables["comparison.csv"] = comparison(lesson.taught, reproduction)
    return tables


def demonstrations(taught: DemonstrationSet) -> Table:
    """Return the demonstrations, one below the other."""
    shares = (INDEX_TIME - 1.0) / (SAMPLES - 1)
    times = np.concatenate([shares * each.duration for each in taught.demonstrations])
    names = [each.name for each in taught.demonstrations for _ in range(SAMPLES)]
    return Table(_numbered(taught, taught.rows, times), ("name", names))


def network(lesson: Lesson) -> Table:
    """Return the network's output at the demonstrations' stamps, beside their mean."""
    taught = lesson.taught
    return Table(
        {
            "index": INDEX_TIME,
            "time [s]": (INDEX_TIME - 1.0) / (SAMPLES - 1) * taught.duration,
            **_joints(taught, taught.mean, "mean "),
            **_joints(taught, lesson.curve, "network "),
        }
    )


def between(lesson: Lesson) -> Table:
    """Return the network on a grid 14 times finer, beside the spline of `rbf.smoothness`."""
    taught = lesson.taught
    fine = np.linspace(INDEX_TIME[0], INDEX_TIME[-1], FINER * (SAMPLES - 1) + 1)
    splines = [
        make_smoothing_spline(INDEX_TIME - 1.0, column - column[0])(fine - 1.0) + column[0]
        for column in taught.mean.T
    ]
    return Table(
        {
            "index": fine,
            **_joints(taught, lesson.model.predict(fine[:, np.newaxis]), "network "),
            **_joints(taught, np.column_stack(splines), "spline "),
        }
    )


def held_out(lesson: Lesson) -> Table:
    """Return for each demonstration what a network answers that learned from all others."""
    rows = lesson.taught.rows
    inputs = np.tile(INDEX_TIME, len(rows))[:, np.newaxis]
    targets = rows.reshape(len(inputs), -1)
    splits = LeaveOneDemonstrationOut([SAMPLES] * len(rows)).split(inputs)
    curves = [
        deepcopy(lesson.model).fit(inputs[train], targets[train]).predict(inputs[test])
        for train, test in splits
    ]
    return Table(_numbered(lesson.taught, np.array(curves)))


def centers(model: RBFRegressor | NewrbRegressor) -> Table:
    """Return where the Gaussians are, how wide, and with which weights."""
    count = len(model.centers_)
    weights = np.reshape(model.weights_, (count, -1)).T
    return Table(
        {
            "neuron": np.arange(1.0, count + 1.0),
            "center [index]": model.centers_[:, 0],
            "width [index]": np.full(count, model.width_),
            **{f"weight {i + 1} [rad]": column for i, column in enumerate(weights)},
        }
    )


def measured(reproduction: Reproduction) -> Table:
    """Return all joints, the hands and the task's block, as they were at every tick."""
    performance = reproduction.performance
    times = CONTROL_PERIOD * np.arange(len(performance.ticks) + 1)
    joints = np.vstack([performance.start, *(t.world.joint_positions for t in performance.ticks)])
    tilts = np.array([tick.world.tilt for tick in performance.ticks])
    tilts = np.concatenate([tilts[:1], tilts])  # before the first tick nothing has touched it
    columns = {"time [s]": times}
    columns |= {f"{n} [rad]": column for n, column in zip(JOINT_NAMES, joints.T, strict=True)}
    for side in sides_of(performance.arms):
        columns |= _axes(f"{side} hand", hand_path(joints, side))
    return Table(columns | {"block tilt [rad]": tilts})


def comparison(taught: DemonstrationSet, reproduction: Reproduction) -> Table:
    """Return what was meant and what was measured, at equal times."""
    performance = reproduction.performance
    stamps = np.linspace(0.0, performance.duration, SAMPLES)
    body = performance.measured_at(stamps)
    meant = body_as_meant(
        taught.mean, taught.joints, performance.arms, performance.duration, taught.hands
    )
    columns = {
        "index": INDEX_TIME,
        "time [s]": stamps,
        **_joints(taught, taught.mean, "mean "),
        **_joints(taught, body[:, joint_columns(taught.joints)], "measured "),
    }
    for side in sides_of(performance.arms):
        columns |= _axes(f"mean {side} hand", hand_path(meant, side))
        columns |= _axes(f"measured {side} hand", hand_path(body, side))
    return Table(columns)


def _numbered(
    taught: DemonstrationSet, rows: FloatArray, times: FloatArray | None = None
) -> dict[str, FloatArray]:
    """Return columns of rows (K, 142, D), with the demonstration's number and the index."""
    count = len(rows)
    return {
        "demonstration": np.repeat(np.arange(1.0, count + 1.0), SAMPLES),
        "index": np.tile(INDEX_TIME, count),
        **({} if times is None else {"time [s]": times}),
        **_joints(taught, rows.reshape(count * SAMPLES, -1)),
    }


def _joints(taught: DemonstrationSet, rows: FloatArray, of: str = "") -> dict[str, FloatArray]:
    return {f"{of}{n} [rad]": column for n, column in zip(taught.joints, rows.T, strict=True)}


def _axes(what: str, points: FloatArray) -> Iterator[tuple[str, FloatArray]]:
    return ((f"{what} {axis} [m]", column) for axis, column in zip("xyz", points.T, strict=True))


def _counted(name: str, column: FloatArray) -> list[Any]:
    """Return a column's numbers, as whole ones where it has no unit and counts."""
    whole = "[" not in name and bool((column == np.round(column)).all())
    numbers: list[Any] = (column.astype(int) if whole else column).tolist()
    return numbers


def _plain(word: str) -> str:
    """Return a word that no spreadsheet computes with: names come with files of others."""
    return f"'{word}" if word.startswith(_FORMULA) else word
