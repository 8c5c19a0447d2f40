"""Demonstrations to list: the samples that ship, and takes in which something was planted."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache

import numpy as np

from studio.engine.demonstration import demonstrations_of
from studio.engine.export.material import Take
from studio.engine.listed import Listed
from studio.engine.mcap_file import read_recording
from studio.engine.recording import Recording, Sample
from studio.engine.resources import samples_folder


@cache
def sample(number: int = 1) -> Recording:
    """Return one of the four recordings that ship."""
    return read_recording(samples_folder() / f"demonstration-{number}.mcap")


def take(number: int = 1, name: str = "") -> Take:
    """Return its demonstration."""
    (shown,) = demonstrations_of(sample(number), name or f"take {number}")
    return Take(shown, sample(number))


def takes(count: int = 4) -> list[Take]:
    """Return the first ones."""
    return [take(number) for number in range(1, count + 1)]


def listed(*given: Take) -> Listed:
    """Return a list of takes, all of them looked at."""
    made = Listed()
    made.add(given or takes())
    settle(made)
    return made


def settle(made: Listed) -> None:
    """Look until nothing is stale."""
    while made.look():
        pass


def names_of(made: Listed, number: int) -> list[str]:
    """Return the names of a demonstration's flags."""
    flags = made.entry(number).flags
    assert flags is not None, "not looked at yet"
    return [flag.name for flag in flags]


def changed(
    number: int, change: Callable[[Sample, int], Sample], ticks: Sequence[int] | None = None
) -> Recording:
    """Return a recording some of whose demonstration's samples are changed, all by default."""
    shown = take(number).demonstration
    samples = list(sample(number).samples)
    length = shown.last_sample + 1 - shown.first_sample
    for tick in range(length) if ticks is None else ticks:
        place = shown.first_sample + tick
        samples[place] = change(samples[place], tick)
    return replace(sample(number), samples=tuple(samples))


MIDDLE = range(40, 70)  # ticks: a second in which something goes wrong


def dropout(number: int) -> Recording:
    """Return a recording in which the sensor lost the arm for a second."""
    return changed(number, lambda s, _: replace(s, held="left wrist not tracked"), MIDDLE)


def at_the_limits(number: int) -> Recording:
    """Return a recording in which Baxter's limits bit for a second."""
    return changed(number, lambda s, _: replace(s, limited=True), MIDDLE)


def hardly_moving(number: int) -> Recording:
    """Return a recording in which the arm stays where it began."""
    shown = take(number).demonstration
    first = sample(number).samples[shown.first_sample]
    return changed(number, lambda s, _: replace(s, sent=first.sent, wanted=first.wanted))


def shaking(number: int) -> Recording:
    """Return a recording in which the arm trembles for a second."""

    def shake(s: Sample, tick: int) -> Sample:
        assert s.wanted is not None
        return replace(s, wanted=tuple(a + np.radians(4.0) * np.sin(1.2 * tick) for a in s.wanted))

    return changed(number, shake, MIDDLE)


def elsewhere(number: int) -> Recording:
    """Return a recording of another motion."""
    return changed(number, lambda s, _: replace(s, sent=s.sent + np.radians(25.0)))


DEFECTS: dict[str, Callable[[int], Recording]] = {
    "dropout": dropout,
    "limits hit": at_the_limits,
    "too little motion": hardly_moving,
    "jerk": shaking,
    "outlier": elsewhere,
}
