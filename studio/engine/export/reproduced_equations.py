"""The equations behind what Baxter did alone: errors of joints and of the hand."""

from collections.abc import Iterator

import numpy as np

from studio.engine.arms import sides_of
from studio.engine.demonstration import SAMPLES
from studio.engine.export.equation import Equation, listed, short
from studio.engine.measures import acceleration_alone, motion_ticks
from studio.engine.performance import Performance
from studio.engine.robot import CONTROL_RATE
from studio.engine.teaching import Lesson, Reproduction

_MEANT = "p: where the hand was, m: where the mean demonstration would have it, at equal times"


def reproduced_equations(
    lesson: Lesson, reproduction: Reproduction
) -> Iterator[tuple[str, Equation]]:
    """Yield the equations by key; ``rmse left_s0`` is that of a joint."""
    error = reproduction.deviation
    for joint, rmse in zip(lesson.taught.joints, error.joint_rmse.tolist(), strict=True):
        yield f"rmse {joint}", _rmse(joint, rmse)
    read = "".join(_hand_lines(side) for side in sides_of(reproduction.performance.arms))
    count = f"{SAMPLES}" if reproduction.performance.arms != "both" else f"(2·{SAMPLES})"
    mean, largest, warped = (
        1000.0 * value for value in (error.hand_mean, error.hand_max, error.hand_dtw)
    )
    yield (
        "hand mean",
        Equation(
            name="mean error of the hand",
            unit="mm",
            value=mean,
            formula=f"mean = 1/T · Σᵢ ‖p(i) − m(i)‖   ({_MEANT}, T = {SAMPLES})",
            filled=f"mean = {short(mean * SAMPLES)} / {count} = {short(mean)} mm"
            if count == f"{SAMPLES}"
            else f"mean = {short(2 * mean * SAMPLES)} / {count} = {short(mean)} mm",
            source="after Fig. 10",
            lines=_HANDS + read + "print(1000 * np.mean([distance(*hand) for hand in hands]))\n",
        ),
    )
    yield (
        "hand largest",
        Equation(
            name="largest error of the hand",
            unit="mm",
            value=largest,
            formula=f"largest = maxᵢ ‖p(i) − m(i)‖   ({_MEANT})",
            filled=f"largest = {short(largest)} mm",
            source="after Fig. 10",
            lines=_HANDS + read + "print(1000 * np.max([distance(*hand) for hand in hands]))\n",
        ),
    )
    yield (
        "hand dtw",
        Equation(
            name="error of the hand after time warping",
            unit="mm",
            value=warped,
            formula="DTW = min over warpings w of 1/|w| · Σ ‖p(i) − m(j)‖, (i, j) in w",
            filled=f"DTW = {short(warped)} mm, {short(warped / mean)} of the mean error"
            if mean > 0.0
            else f"DTW = {short(warped)} mm",
            source="Sakoe and Chiba 1978, symmetric steps of weight 1",
            lines=_HANDS
            + _WARPED
            + read
            + "print(1000 * np.mean([warped(*hand) for hand in hands]))\n",
        ),
    )
    yield "hand acceleration", _acceleration(reproduction.performance)


def _acceleration(performance: Performance) -> Equation:
    value, count = acceleration_alone(performance), motion_ticks(performance) + 1
    sides = sides_of(performance.arms)
    points = len(sides) * (count - 2)
    hands = ", ".join(
        f'columns("reproduction.csv", {listed([f"{side} hand {axis} [m]" for axis in "xyz"])})'
        for side in sides
    )
    return Equation(
        name="acceleration of the hand, alone",
        unit="m/s²",
        value=value,
        formula="a = √(1/N · Σₙ ‖p(n+1) − 2p(n) + p(n−1)‖²) · f²   (p: where the hand was at "
        f"tick n of the motion, f = {CONTROL_RATE}/s)",
        filled=f"a = √({short((value / CONTROL_RATE**2) ** 2 * points)} / {points}) · "
        f"{CONTROL_RATE}² = {short(value)} m/s²",
        source="second differences at the control rate",
        lines=f"hands = np.array([{hands}])[:, :, :{count}]  # the motion, without settling\n"
        "bends = np.diff(hands, 2)\n"
        f"print(np.sqrt(np.mean(np.sum(bends**2, axis=1))) * {CONTROL_RATE}**2)\n",
    )


def _rmse(joint: str, rmse: float) -> Equation:
    value = float(np.degrees(rmse))
    names = listed([f"mean {joint} [rad]", f"measured {joint} [rad]"])
    return Equation(
        name=f"error of {joint}, alone",
        unit="deg",
        value=value,
        formula=f"RMSE = √(1/T · Σᵢ (measured(i) − mean(i))²)   (T = {SAMPLES} equal times)",
        filled=f"RMSE = √({short(value**2 * SAMPLES)} / {SAMPLES}) = {short(value)}°",
        source="the mean demonstration as it was sent",
        lines=f'mean, measured = columns("comparison.csv", {names})\n'
        "print(np.degrees(np.sqrt(np.mean((measured - mean) ** 2))))\n",
    )


_HANDS = """\
hands = []


def distance(measured, mean):
    return np.linalg.norm(measured - mean, axis=1)


"""
_WARPED = """\
def warped(a, b):
    best = [(0.0, 0)] + [(np.inf, 0)] * len(b)
    for row in np.linalg.norm(a[:, None] - b, axis=2).tolist():
        previous, best = best, [(np.inf, 0)]
        for j, distance in enumerate(row):
            total, matches = min(previous[j], previous[j + 1], best[j])
            best.append((total + distance, matches + 1))
    total, matches = best[-1]
    return total / matches


"""


def _hand_lines(side: str) -> str:
    """Return lines that read a hand's measured and mean path, (142, 3) each."""
    names = [
        listed([f"{of} {side} hand {axis} [m]" for axis in "xyz"]) for of in ("measured", "mean")
    ]
    reads = ", ".join(f'columns("comparison.csv", {name}).T' for name in names)
    return f"hands.append(({reads}))\n"
