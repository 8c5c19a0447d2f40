"""The list of demonstrations, and which of them is chosen."""

from collections import Counter

from studio.engine.arms import Arms, in_words
from studio.engine.demonstration import Demonstration, DemonstrationSet, demonstrations_of
from studio.engine.errors import NothingTaughtError, StudioError
from studio.engine.recording import Recording
from studio.engine.retarget import Mapping
from studio.engine.snapshot import Entry


class Listed:
    """See the module; ``chosen`` is an index, -1 while nothing is listed."""

    def __init__(self) -> None:
        self.entries: list[Entry] = []
        self.chosen = -1

    def add(self, recording: Recording, name: str) -> list[Demonstration]:
        """List a recording's demonstrations, and return them."""
        found = demonstrations_of(recording, name)
        down = recording.samples[-1].world.block_down
        self.entries += [Entry(each, down) for each in found]
        if found and self.chosen < 0:
            self.chosen = 0
        return found

    def remove(self, index: int) -> Demonstration:
        """Take a demonstration off the list, and return it; raise StudioError as `at` does."""
        removed = self.at(index)
        del self.entries[index]
        self.chosen = min(self.chosen, len(self.entries) - 1)
        return removed

    def choose(self, index: int) -> None:
        """Choose a demonstration; raise StudioError as `at` does."""
        self.at(index)
        self.chosen = index

    def at(self, index: int) -> Demonstration:
        """Return a listed demonstration; raise StudioError where there is none of that index."""
        if not 0 <= index < len(self.entries):
            raise StudioError("There is no such demonstration on the list")
        return self.entries[index].demonstration

    def taught(self, arms: Arms, mapping: Mapping) -> DemonstrationSet:
        """Return the listed demonstrations of these arms and mapping.

        Raises
        ------
        NothingTaughtError
            Where none is listed, or they can't be learned from together.
        """
        listed = [entry.demonstration for entry in self.entries]
        fitting = [each for each in listed if (each.arms, each.mapping) == (arms, mapping)]
        if not fitting:
            raise NothingTaughtError(
                f"No demonstration by {in_words(arms)} with the {mapping} mapping: record one first"
            )
        return DemonstrationSet.of(fitting)


def why_nothing_armed(recording: Recording, name: str) -> str:
    """Return why a recording teaches nothing: what held the robot most of the time."""
    held = Counter(sample.held for sample in recording.samples if sample.held)
    why = held.most_common(1)[0][0] if held else "it ended too soon"
    return f"{name}: nothing armed for a second or more: {why}"
