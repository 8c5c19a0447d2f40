"""The equations behind the network itself: its width, and how well its weights are determined."""

import math
from collections.abc import Iterator

import numpy as np

from studio.engine.demonstration import SAMPLES
from studio.engine.export.equation import Equation, short
from studio.engine.teaching import INDEX_TIME, Lesson
from studio.rbf import NewrbRegressor, RBFRegressor

# Beyond it the smallest singular value is rounding, and the quotient's digits mean nothing.
LARGEST_CONDITION = 1e15
_CENTERS = 'c, width = columns("centers.csv", "center [index]", "width [index]")\n'


def network_equations(lesson: Lesson) -> Iterator[tuple[str, Equation]]:
    """Yield the equations by key: width, and rank and condition where Eq. 14 was solved."""
    model = lesson.model
    if isinstance(model, NewrbRegressor):
        yield "width", _width_of_spread(model)
    if isinstance(model, RBFRegressor):
        if model.width == "dmax":
            yield "width", _width(model)
        yield "rank", _rank(lesson, model)
        yield "condition", _condition(lesson, model)


def shown_condition(condition: float) -> float:
    """Return a condition number as it is shown: infinite where its digits are rounding."""
    return condition if condition < LARGEST_CONDITION else math.inf


def _width(model: RBFRegressor) -> Equation:
    count = len(model.centers_)
    distance = float(np.ptp(model.centers_)) or float(np.ptp(INDEX_TIME))
    return Equation(
        name="width of the Gaussians",
        unit="samples",
        value=model.width_,
        formula="σ = d_max / √(2M)   (d_max: the farthest centers' distance, M: their number)",
        filled=f"σ = {short(distance)} / √(2·{count}) = {model.width_:.6g} samples",
        source="Eq. 13",
        lines=_CENTERS
        + f"distance = np.ptp(c) or {SAMPLES - 1}.0  # of a single center: the samples' extent\n"
        + "print(distance / np.sqrt(2 * len(c)))\n",
    )


def _width_of_spread(model: NewrbRegressor) -> Equation:
    return Equation(
        name="width of the Gaussians",
        unit="samples",
        value=model.width_,
        formula="σ = spread / √(2 ln 2)   (at a distance of the spread a neuron answers one half)",
        filled=f"σ = {short(model.spread)} / √(2 ln 2) = {model.width_:.6g} samples",
        source="newrb's definition of its spread",
        lines=f"print({model.spread!r} / np.sqrt(2 * np.log(2)))\n",
    )


def _rank(lesson: Lesson, model: RBFRegressor) -> Equation:
    count = len(model.centers_)
    return Equation(
        name="rank: directions that the samples tell apart",
        unit="",
        value=float(model.rank_),
        formula="rank = number of singular values of Φ above rcond times the largest   "
        "(Φᵢⱼ = √K · exp(−(i − cⱼ)² / 2σ²))",
        filled=f"rank = {model.rank_} of {count} neurons, rcond = {model.rcond:g}",
        source="Eq. 9 and 14, by a truncated singular value decomposition",
        lines=_design(lesson) + f"print(np.sum(s > {model.rcond!r} * max(s[0], 1.0)))\n",
    )


def _condition(lesson: Lesson, model: RBFRegressor) -> Equation:
    value = shown_condition(model.condition_)
    told = f"more than {LARGEST_CONDITION:g}" if math.isinf(value) else short(value)
    return Equation(
        name="condition: how much an error of the samples may grow in the weights",
        unit="",
        value=value,
        formula="cond Φ = largest / smallest singular value   (Eq. 15 would square it; told as "
        f"infinite beyond {LARGEST_CONDITION:g}, where float64 has no digits left)",
        filled=f"cond Φ = {told}; its square in Eq. 15",
        source="Eq. 14 and 15",
        lines=_design(lesson)
        + "condition = s[0] / s[-1] if s[-1] > 0 else np.inf\n"
        + f"print(condition if condition < {LARGEST_CONDITION!r} else np.inf)\n",
    )


def _design(lesson: Lesson) -> str:
    """Return lines that read the singular values s of the matrix of Eq. 14.

    With the centers' middle as origin, as `rbf.gaussian_design` has it: to the last digit.
    """
    return (
        _CENTERS
        + "middle = 0.5 * c.min() + 0.5 * c.max()\n"
        + f"i = (np.arange(1.0, {SAMPLES + 1}.0) - middle) / width[0]\n"
        + "phi = np.exp(-0.5 * (i[:, None] - (c - middle) / width[0]) ** 2)\n"
        + f"s = np.linalg.svd(np.sqrt({len(lesson.taught.rows)}.0) * phi, full_matrices=False)[1]\n"
    )
