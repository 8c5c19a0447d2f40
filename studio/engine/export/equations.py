"""Every number that the studio shows, with the equation behind it."""

from studio.engine.export.equation import Equation
from studio.engine.export.learned_equations import learned_equations
from studio.engine.export.network_equations import network_equations
from studio.engine.export.reproduced_equations import reproduced_equations
from studio.engine.teaching import Lesson, Reproduction

__all__ = ["Equation", "equations_of"]


def equations_of(lesson: Lesson, reproduction: Reproduction | None = None) -> dict[str, Equation]:
    """Return the equations by key.

    Of each learned joint ``mse JOINT``, ``largest JOINT``, ``floor JOINT``, ``ratio JOINT``, and
    ``rmse JOINT`` once Baxter did it alone; of all together ``ratio``, ``held-out``,
    ``held-out ratio``, ``acceleration``, ``width``, ``rank``, ``condition``, ``hand mean``,
    ``hand largest``, ``hand dtw``. Those that make no sense for a lesson are not there. It trains
    the network anew for each demonstration that is left out, so ask once for each lesson.
    """
    found = dict(learned_equations(lesson)) | dict(network_equations(lesson))
    if reproduction is not None:
        found |= dict(reproduced_equations(lesson, reproduction))
    return found
