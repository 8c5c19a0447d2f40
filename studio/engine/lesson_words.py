"""What is worth knowing about what was learned, in plain words: only what matters."""

import math
from collections.abc import Mapping

from studio.engine.export.equation import Equation
from studio.engine.export.network_equations import LARGEST_CONDITION
from studio.engine.teaching import Lesson
from studio.rbf import NewrbRegressor, RBFRegressor

SQUARED_IS_TOO_MUCH = 1e8  # a condition whose square float64 has no digits for: Eq. 15 fails
RIPPLES = 1.2  # times the acceleration of a smoothing spline
REMEMBERS = 1.05  # times the error of the others' mean curve, on a demonstration left out


def worth_knowing(lesson: Lesson, equations: Mapping[str, Equation]) -> tuple[str, ...]:
    """Return sentences on rank, condition, ripple and what was not learned from.

    Those on ripple and on demonstrations left out wait for their ``equations``.
    """
    if not isinstance(lesson.model, RBFRegressor | NewrbRegressor):
        return ()  # a field keeps no time, and these numbers compare at equal times
    words = (*_network(lesson), _ripple(equations), _left_out(equations))
    return tuple(each for each in words if each)


def _network(lesson: Lesson) -> tuple[str, ...]:
    model = lesson.model
    if not isinstance(model, RBFRegressor):
        return ()
    return _rank(model), _condition(model.condition_)


def _rank(model: RBFRegressor) -> str:
    count = len(model.centers_)
    if model.rank_ >= count:
        return ""
    return (
        f"Only {model.rank_} of the {count} neurons say something of their own (the rank): the "
        "Gaussians overlap so much that the samples cannot tell the others apart. More neurons "
        "add nothing."
    )


def _condition(condition: float) -> str:
    if condition < SQUARED_IS_TOO_MUCH:
        return ""
    told = f"{condition:.0e}" if condition < LARGEST_CONDITION else f"over {LARGEST_CONDITION:.0e}"
    return (
        f"The weights are badly determined (condition {told}): many sets of weights give nearly "
        "the same curve. Eq. 15 as printed squares that number and would fail; the studio solves "
        "Eq. 14 by a singular value decomposition instead."
    )


def _ripple(equations: Mapping[str, Equation]) -> str:
    ratio = _value(equations, "acceleration")
    if not ratio > RIPPLES:
        return ""
    return (
        f"Between the samples it ripples: {ratio:.1f} times the acceleration of a smooth curve "
        "through the same points. The MSE does not see that; a robot feels it."
    )


def _left_out(equations: Mapping[str, Equation]) -> str:
    ratio = _value(equations, "held-out ratio")
    if not ratio > REMEMBERS:
        return ""
    return (
        f"On a demonstration that it has not seen it errs {ratio:.2f} times as much as the mean "
        "of the others would: it has learned too little, or too much by heart."
    )


def _value(equations: Mapping[str, Equation], key: str) -> float:
    return equations[key].value if key in equations else math.nan
