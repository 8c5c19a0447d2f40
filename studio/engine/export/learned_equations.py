"""The equations behind what the network learned: errors, floor, and between the samples."""

from collections.abc import Iterator

import numpy as np

from studio.engine.demonstration import SAMPLES
from studio.engine.export.equation import Equation, listed, short
from studio.engine.skeleton import FloatArray
from studio.engine.teaching import Lesson
from studio.rbf import largest_error, leave_one_demonstration_out, smoothness

_OF_JOINT = "q: demonstrations, f: the network, K demonstrations of T = 142 samples"


def learned_equations(lesson: Lesson) -> Iterator[tuple[str, Equation]]:
    """Yield the equations by key; ``mse left_s0`` is that of a joint."""
    taught = lesson.taught
    largest = largest_error(taught.rows.reshape(-1, len(taught.joints)), _repeated(lesson))
    for column, joint in enumerate(taught.joints):
        yield f"mse {joint}", _mse(lesson, column)
        yield f"largest {joint}", _largest(joint, float(largest[column]))
        if lesson.floor is not None:
            yield f"floor {joint}", _floor(lesson, column, float(lesson.floor[column]))
            if lesson.floor[column] > 0.0:
                yield f"ratio {joint}", _ratio(lesson, [joint], lesson.floor, column)
    yield "mse", _mse_of_all(lesson)
    if lesson.floor is not None and lesson.floor.any():
        yield "ratio", _ratio(lesson, list(taught.joints), lesson.floor, slice(None))
    if len(taught.rows) > 1:
        yield from _held_out(lesson)
    yield "acceleration", _acceleration(lesson)


def _mse(lesson: Lesson, column: int) -> Equation:
    joint, count = lesson.taught.joints[column], len(lesson.taught.rows)
    value = float(lesson.mse[column])
    return Equation(
        name=f"mean square error of {joint}",
        unit="rad²",
        value=value,
        formula=f"MSE = 1/(K·T) · Σₖ Σᵢ (qₖ(i) − f(i))²   ({_OF_JOINT})",
        filled=f"MSE = {short(value * count * SAMPLES)} / ({count}·{SAMPLES}) "
        f"= {short(value)} rad²",
        source="Table I",
        lines=_taught(joint) + "print(np.mean((q - f) ** 2))\n",
    )


def _mse_of_all(lesson: Lesson) -> Equation:
    value, count = float(lesson.mse.mean()), len(lesson.mse)
    errors = " + ".join(short(float(each)) for each in lesson.mse)
    return Equation(
        name="mean square error, mean of the joints",
        unit="rad²",
        value=value,
        formula="MSE = 1/D · Σ MSE of a joint   (over D joints; each 1/(K·T) · Σₖ Σᵢ "
        f"(qₖ(i) − f(i))², {_OF_JOINT})",
        filled=f"MSE = ({errors}) / {count} = {short(value)} rad²",
        source="Table I",
        lines=_taught(*lesson.taught.joints) + "print(np.mean((q - f) ** 2))\n",
    )


def _largest(joint: str, value: float) -> Equation:
    return Equation(
        name=f"largest error of {joint}, ε*",
        unit="rad",
        value=value,
        formula=f"ε* = max over k, i of |qₖ(i) − f(i)|   ({_OF_JOINT})",
        filled=f"ε* = {short(value)} rad = {short(float(np.degrees(value)))}°",
        source="Eq. 12, over the samples",
        lines=_taught(joint) + "print(np.max(np.abs(q - f)))\n",
    )


def _floor(lesson: Lesson, column: int, value: float) -> Equation:
    joint, count = lesson.taught.joints[column], len(lesson.taught.rows)
    return Equation(
        name=f"floor under the error of {joint}",
        unit="rad²",
        value=value,
        formula="floor = 1/(K·T) · Σₖ Σᵢ (qₖ(i) − q̄(i))²   (q̄: the demonstrations' mean; no "
        "function of time gets below it)",
        filled=f"floor = {short(value * count * SAMPLES)} / ({count}·{SAMPLES}) = "
        f"{short(value)} rad²",
        source="pooled variance within each stamp",
        lines=_taught(joint) + "print(np.mean((q - q.mean(axis=1, keepdims=True)) ** 2))\n",
    )


def _ratio(lesson: Lesson, joints: list[str], floor: FloatArray, columns: int | slice) -> Equation:
    mse, under = float(np.sum(lesson.mse[columns])), float(np.sum(floor[columns]))
    single = len(joints) == 1
    parts = ("MSE", "floor") if single else ("Σ MSE", "Σ floor")
    return Equation(
        name=f"error over its floor, {joints[0] if single else 'all joints'}",
        unit="",
        value=mse / under,
        formula=f"ratio = {parts[0]} / {parts[1]}"
        + ("" if single else "   (sums over the joints)"),
        filled=f"ratio = {mse:.6g} / {under:.6g} = {mse / under:.6g}",
        source="Table I over its floor",
        lines=_taught(*joints)
        + "mse = np.mean((q - f) ** 2, axis=(1, 2))\n"
        + "floor = np.mean((q - q.mean(axis=1, keepdims=True)) ** 2, axis=(1, 2))\n"
        + "print(mse.sum() / floor.sum())\n",
    )


def _held_out(lesson: Lesson) -> Iterator[tuple[str, Equation]]:
    taught = lesson.taught
    found = leave_one_demonstration_out(lesson.model, taught.rows)
    columns = listed([f"{joint} [rad]" for joint in taught.joints])
    read = (
        f'q = columns("demonstrations.csv", {columns}).reshape(-1, {len(taught.rows)}, {SAMPLES})\n'
        f'h = columns("held-out.csv", {columns}).reshape(q.shape)\n'
    )
    errors = " + ".join(short(float(each)) for each in found.mse.mean(axis=1))
    value = float(found.mse.mean())
    yield (
        "held-out",
        Equation(
            name="error on a demonstration that was not learned from",
            unit="rad²",
            value=value,
            formula="held-out = 1/(D·K·T) · Σ (qₖ(i) − f₋ₖ(i))²   (f₋ₖ learned from all "
            "demonstrations but k; sum over D joints, too)",
            filled=f"held-out = ({errors}) / {len(taught.rows)} = {short(value)} rad²",
            source="leaving out one demonstration at a time",
            lines=read + "print(np.mean((q - h) ** 2))\n",
        ),
    )
    if found.ratio is None or found.of_means is None:
        return
    yield (
        "held-out ratio",
        Equation(
            name="held-out error over that of the others' mean curve",
            unit="",
            value=found.ratio,
            formula="ratio = Σ (qₖ(i) − f₋ₖ(i))² / Σ (qₖ(i) − q̄₋ₖ(i))²   (q̄₋ₖ: mean of all "
            "demonstrations but k)",
            filled=f"ratio = {short(value)} / {short(float(found.of_means.mean()))} "
            f"= {found.ratio:.6g}",
            source="leaving out one demonstration at a time",
            lines=read
            + "others = (q.sum(axis=1, keepdims=True) - q) / (q.shape[1] - 1)\n"
            + "print(np.sum((q - h) ** 2) / np.sum((q - others) ** 2))\n",
        ),
    )


def _acceleration(lesson: Lesson) -> Equation:
    found = smoothness(lesson.model.predict, lesson.taught.rows)
    own, spline = (float(np.linalg.norm(each)) for each in (found.acceleration, found.of_spline))
    joints = lesson.taught.joints
    names = [listed([f"{of} {joint} [rad]" for joint in joints]) for of in ("network", "spline")]
    return Equation(
        name="acceleration between the samples, over a smoothing spline's",
        unit="",
        value=found.ratio,
        formula="ratio = √(Σ f″²) / √(Σ s″²)   (f″, s″: second differences of network and "
        "smoothing spline on a grid 14 times finer, all joints)",
        filled=f"ratio = {short(own)} / {short(spline)} = {found.ratio:.6g}",
        source="Craven and Wahba 1979 for the spline",
        lines=f'f = np.diff(columns("between.csv", {names[0]}), 2)\n'
        f's = np.diff(columns("between.csv", {names[1]}), 2)\n'
        "print(np.sqrt(np.sum(f**2)) / np.sqrt(np.sum(s**2)))\n",
    )


def _taught(*joints: str) -> str:
    """Return lines that read q (D, K, 142) and f (D, 1, 142)."""
    taught = listed([f"{joint} [rad]" for joint in joints])
    learned = listed([f"network {joint} [rad]" for joint in joints])
    count = len(joints)
    return (
        f'q = columns("demonstrations.csv", {taught}).reshape({count}, -1, {SAMPLES})\n'
        f'f = columns("network.csv", {learned}).reshape({count}, 1, {SAMPLES})\n'
    )


def _repeated(lesson: Lesson) -> FloatArray:
    rows = lesson.taught.rows
    return np.broadcast_to(lesson.curve, rows.shape).reshape(-1, rows.shape[2])
