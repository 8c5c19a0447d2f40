"""What the sweep's tests share: demonstrations recorded through the pipeline, and a false clock."""

from functools import cache

from studio.engine.demonstration import DemonstrationSet
from studio.engine.experiment import Setup, teach
from studio.engine.resources import samples_folder


@cache
def samples(count: int = 4) -> DemonstrationSet:
    """Return the shipped demonstrations."""
    paths = sorted(samples_folder().glob("*.mcap"))[:count]
    return DemonstrationSet.of(teach(paths, Setup()).demonstrations)


class Ticking:
    """A clock that a second passes on at every look."""

    def __init__(self) -> None:
        self.time = 0.0

    def __call__(self) -> float:
        self.time += 1.0
        return self.time
