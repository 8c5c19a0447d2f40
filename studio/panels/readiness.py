"""What can be done now, and in words why not; what to do next. Pure functions of a snapshot.

Each ``why_not_...`` returns nothing where the thing can be done.
"""

from collections.abc import Sequence

from studio.engine.skeleton import Side
from studio.engine.snapshot import Entry, Mode, Snapshot

FOLLOWING = (Mode.WATCHING, Mode.ARMED, Mode.RECORDING)


def fitting(now: Snapshot) -> list[Entry]:
    """Return the listed demonstrations of the chosen arm and mapping: what Train learns from."""
    return [each for each in now.entries if _kind(each) == (now.side, now.mapping)]


def why_not_configure(now: Snapshot) -> str:
    """Return why arm, mapping and gate cannot be changed."""
    return "Stop first: they stay as they are while somebody teaches." if _follows(now) else ""


def why_not_teach(now: Snapshot) -> str:
    """Return why nothing can be watched or recorded."""
    if now.source is None:
        return "Choose a source first, in 1 Source."
    if now.mode is Mode.PLAYING:
        return "Baxter is playing: press Stop first."
    return "Somebody teaches already: press Stop first." if _follows(now) else ""


def why_not_train(now: Snapshot) -> str:
    """Return why there is nothing to learn from."""
    if not fitting(now):
        return f"No demonstration by {_wanted(now)}: record one in 2 Teach."
    return ""


def why_not_play(now: Snapshot) -> str:
    """Return why Baxter cannot do it alone."""
    if now.lesson is None:
        return "Nothing is learned yet: press Train in 3 Learn."
    return "Somebody teaches: press Stop first." if _follows(now) else ""


def why_not_replay(now: Snapshot) -> str:
    """Return why no demonstration can be replayed."""
    if not now.entries:
        return "No demonstration is listed: record one in 2 Teach."
    return "Somebody teaches: press Stop first." if _follows(now) else ""


def next_step(now: Snapshot) -> str:
    """Return what a newcomer should do next."""
    learned, done = now.lesson is not None, now.reproduction is not None
    return next(
        words
        for applies, words in (
            (_follows(now), "watch the gate; Stop ends it and keeps what was recorded."),
            (now.mode is Mode.PLAYING, "watch the block."),
            (learned and not done, "4 Compare: let Baxter do it alone."),
            (learned, "3 Learn: try fewer neurons, train again, and compare."),
            (bool(fitting(now)), "3 Learn: press Train."),
            (now.source is not None, "2 Teach: press Record."),
            (True, "1 Source: choose who teaches, for example the demonstrator."),
        )
        if applies
    )


def described(demonstrations: Sequence[Entry], index: int) -> str:
    """Return a listed demonstration's number and name, which tells equal names apart."""
    return f"{index + 1}: {demonstrations[index].demonstration.name}"


def _follows(now: Snapshot) -> bool:
    return now.mode in FOLLOWING


def _kind(entry: Entry) -> tuple[Side, str]:
    return entry.demonstration.side, entry.demonstration.mapping


def _wanted(now: Snapshot) -> str:
    return f"the {now.side} arm with the {now.mapping} mapping"
