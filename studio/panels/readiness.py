"""What can be done now, and in words why not; what to do next. Pure functions of a snapshot.

Each ``why_not_...`` returns nothing where the thing can be done.
"""

from collections.abc import Sequence

from studio.engine.arms import Arms, in_words
from studio.engine.snapshot import Entry, Mode, Snapshot

CALIBRATING = "Baxter waits while you calibrate: press Stop first."
FOLLOWING = (Mode.WATCHING, Mode.ARMED, Mode.RECORDING)


def fitting(now: Snapshot) -> list[Entry]:
    """Return the listed demonstrations of the chosen arm and mapping: what Train learns from."""
    return [each for each in now.entries if _kind(each) == (now.choices.arms, now.choices.mapping)]


def why_not_configure(now: Snapshot) -> str:
    """Return why arms, mapping, gate and hands cannot be changed."""
    if now.mode is Mode.CALIBRATING:
        return CALIBRATING
    return "Stop first: this stays as it is while somebody teaches." if _follows(now) else ""


def why_not_calibrate(now: Snapshot) -> str:
    """Return why nobody can calibrate."""
    if now.source is None:
        return "Choose a source first, to stand before it."
    if now.mode is Mode.PLAYING:
        return "Baxter is playing: press Stop first."
    if now.mode is Mode.CALIBRATING:
        return ""  # the progress says enough; pressed again, it begins anew
    return "Somebody teaches: press Stop first." if _follows(now) else ""


def why_not_teach(now: Snapshot) -> str:
    """Return why nothing can be watched or recorded."""
    if now.source is None:
        return "Choose a source first, in 1 Source."
    if now.mode is Mode.PLAYING:
        return "Baxter is playing: press Stop first."
    if now.mode is Mode.CALIBRATING:
        return CALIBRATING
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
            (now.mode is Mode.CALIBRATING, "stand as it says; Stop gives up."),
            (learned and not done, "4 Compare: let Baxter do it alone."),
            (learned, "3 Learn: try fewer neurons, train again, and compare."),
            (bool(fitting(now)), "3 Learn: press Train."),
            (_waits_for_stream(now), "1 Source: let a sensor send, as it says there."),
            (now.source is not None, "2 Teach: press Record."),
            (_can_take_stream(now), "1 Source: take the live stream."),
            (True, "1 Source: choose who teaches, for example the demonstrator."),
        )
        if applies
    )


def described(demonstrations: Sequence[Entry], index: int) -> str:
    """Return a listed demonstration's number and name, which tells equal names apart."""
    return f"{index + 1}: {demonstrations[index].demonstration.name}"


def _follows(now: Snapshot) -> bool:
    return now.mode in FOLLOWING


def _waits_for_stream(now: Snapshot) -> bool:
    is_live = now.source is not None and now.source.is_live
    return is_live and now.live is not None and not now.live.is_flowing


def _can_take_stream(now: Snapshot) -> bool:
    return now.live is not None and now.live.is_flowing


def _kind(entry: Entry) -> tuple[Arms, str]:
    return entry.demonstration.arms, entry.demonstration.mapping


def _wanted(now: Snapshot) -> str:
    return f"{in_words(now.choices.arms)} with the {now.choices.mapping} mapping"
