"""Every number that the studio shows, with the equation behind it."""

from studio.engine.export.equation import Equation
from studio.engine.export.learned_equations import learned_equations
from studio.engine.export.network_equations import network_equations
from studio.engine.export.reproduced_equations import reproduced_equations
from studio.engine.teaching import Lesson, Reproduction

__all__ = ["Equation", "equations_of", "learned_numbers", "reproduced_numbers"]


def equations_of(lesson: Lesson, reproduction: Reproduction | None = None) -> dict[str, Equation]:
    """Return the equations by key.

    Of each learned joint ``mse JOINT``, ``largest JOINT``, ``floor JOINT``, ``ratio JOINT``, and
    ``rmse JOINT`` once Baxter did it alone; of all together ``mse``, ``ratio``, ``held-out``,
    ``held-out ratio``, ``acceleration``, ``width``, ``rank``, ``condition``, ``hand mean``,
    ``hand largest``, ``hand dtw``, ``hand acceleration``. Those that make no sense for a lesson are
    not there. It trains the network anew for each demonstration that is left out, so ask once for
    each lesson.
    """
    found = learned_numbers(lesson)
    if reproduction is not None:
        found |= reproduced_numbers(lesson, reproduction)
    return found


def learned_numbers(lesson: Lesson) -> dict[str, Equation]:
    """Return those of what was learned, which takes a while."""
    return dict(learned_equations(lesson)) | dict(network_equations(lesson))


def reproduced_numbers(lesson: Lesson, reproduction: Reproduction) -> dict[str, Equation]:
    """Return those of what Baxter did alone, which are there at once."""
    return dict(reproduced_equations(lesson, reproduction))
