"""What a learner is to a sweep: a way to build it, and the settings that are tried.

Each brings a list of `BUDGET` settings, as many as every other, among which
leave-one-demonstration-out chooses: a comparison in which one learner was tuned and the next was
not would be rigged.
"""

import importlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import product
from typing import Any

from studio.engine.errors import StudioError
from studio.engine.teaching import Model

BUDGET = 12  # settings tried for each learner
Settings = Mapping[str, Any]


@dataclass(frozen=True)
class LearnerKind:
    """A learner, how it is made from settings, and the settings worth trying."""

    name: str  # on the command line
    label: str  # in words
    build: Callable[..., Model]
    settings: tuple[Settings, ...]  # `BUDGET` of them
    network: bool = False  # whether it has a number of neurons, and so a row in Table I
    needs: tuple[str, ...] = ()  # modules of the extra "compare"

    def model(self, settings: Settings) -> Model:
        """Return an untaught learner.

        Raises
        ------
        StudioError
            Where a package that it needs is not installed.

        """
        require(self)
        return self.build(**settings)


def grid(**choices: tuple[Any, ...]) -> tuple[Settings, ...]:
    """Return every combination of some settings' choices."""
    names = tuple(choices)
    return tuple(dict(zip(names, values, strict=True)) for values in product(*choices.values()))


def require(kind: LearnerKind) -> None:
    """Raise StudioError, with the cure, where a package that a learner needs is missing."""
    missing = [module for module in kind.needs if find_spec(module.partition(".")[0]) is None]
    if missing:
        raise StudioError(
            f"the learner {kind.name} needs {', '.join(missing)}, not installed here: "
            "pip install 'teaching-studio[compare]'"
        )


def part(module: str, name: str) -> Any:
    """Return a class of an optional package, imported where it is used and not before."""
    return getattr(importlib.import_module(module), name)
