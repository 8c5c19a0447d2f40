"""What can be done now, and in words why not; what to do next. Pure functions of a snapshot.

Each ``why_not_...`` returns nothing where the thing can be done.
"""

from studio.engine.arms import in_words
from studio.engine.entry import Entry
from studio.engine.export.kind import WITHOUT_LESSON
from studio.engine.scene import USUAL
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.task_words import task_words

CALIBRATING = "Baxter waits while you calibrate: press Stop first."
DRIVEN = "A program drives Baxter: press Stop first."
_NONE_LISTED = "No demonstration is listed: record one in 2 Teach."
FOLLOWING = (Mode.WATCHING, Mode.ARMED, Mode.RECORDING)


def fitting(now: Snapshot) -> list[Entry]:
    """Return the included demonstrations of the chosen arm and mapping: what Train learns from."""
    return [each for each in _of_kind(now) if each.included]


def why_not_configure(now: Snapshot) -> str:
    """Return why arms, mapping, gate and hands cannot be changed."""
    if now.mode is Mode.CALIBRATING:
        return CALIBRATING
    if now.mode is Mode.DRIVEN:
        return DRIVEN
    return "Stop first: this stays as it is while somebody teaches." if _follows(now) else ""


def why_not_calibrate(now: Snapshot) -> str:
    """Return why nobody can calibrate."""
    if now.source is None:
        return "Choose a source first, to stand before it."
    if now.mode is Mode.PLAYING:
        return "Baxter is playing: press Stop first."
    if now.mode is Mode.DRIVEN:
        return DRIVEN
    if now.mode is Mode.CALIBRATING:
        return ""  # the progress says enough; pressed again, it begins anew
    return _why_not_while_taught(now)


def why_not_forget_calibration(now: Snapshot) -> str:
    """Return why the calibration has to stay."""
    return CALIBRATING if now.mode is Mode.CALIBRATING else _why_not_while_taught(now)


def why_not_teach(now: Snapshot) -> str:
    """Return why nothing can be watched or recorded."""
    if now.source is None:
        return "Choose a source first, in 1 Source."
    if now.mode is Mode.PLAYING:
        return "Baxter is playing: press Stop first."
    if now.mode is Mode.CALIBRATING:
        return CALIBRATING
    if now.mode is Mode.DRIVEN:
        return DRIVEN
    return "Somebody teaches already: press Stop first." if _follows(now) else ""


def why_not_take_stream(now: Snapshot) -> str:
    """Return why no live stream can be the source."""
    return "" if now.live is not None else "This studio was started without taking live streams."


def why_not_give_up_reading(now: Snapshot) -> str:
    """Return why there is no reading to be given up."""
    return "" if now.who.reading is not None else "No file is being read."


def why_not_begin_take(now: Snapshot) -> str:
    """Return why no take can be begun by hand."""
    if now.mode is Mode.RECORDING:
        return "It is being recorded already: end that take first."
    return "" if _follows(now) else why_not_teach(now) or "Press Watch first: then begin a take."


def why_not_end_take(now: Snapshot) -> str:
    """Return why there is no take to be ended."""
    return "" if now.mode is Mode.RECORDING else "Nothing is being recorded: begin a take first."


def why_not_choose(now: Snapshot) -> str:
    """Return why nothing can be done with the chosen demonstration."""
    return "" if now.entries else _NONE_LISTED


def why_not_train(now: Snapshot) -> str:
    """Return why nothing can be learned."""
    if now.learning.underway is not None:
        return f"Wait, or press Cancel: {now.learning.underway.words} goes on."
    if _of_kind(now) and not fitting(now):
        return f"All demonstrations by {_wanted(now)} are left out: include one in 2 Teach."
    if not fitting(now):
        return f"No demonstration by {_wanted(now)}: record one in 2 Teach."
    return ""


def why_not_cancel(now: Snapshot) -> str:
    """Return why there is nothing to give up of what is computed."""
    goes_on = now.learning.underway is not None or now.learning.is_drawing
    return "" if goes_on else "Nothing is being computed."


def why_not_play(now: Snapshot) -> str:
    """Return why Baxter cannot do it alone."""
    if now.lesson is None:
        return "Nothing is learned yet: press Train in 3 Learn."
    return _why_not_while_taught(now)


def why_not_replay(now: Snapshot) -> str:
    """Return why no demonstration can be replayed."""
    if not now.entries:
        return _NONE_LISTED
    return _why_not_while_taught(now)


def why_not_put_back(now: Snapshot) -> str:
    """Return why the block cannot be put back."""
    return _why_not_while_taught(now) if now.compare.moved else "The block stands in its place."


def why_not_keep(now: Snapshot) -> str:
    """Return why what is learned cannot be kept to stand beside something else."""
    if now.lesson is None:
        return "Two robots: train first, in 3 Learn, then keep it as B."
    is_kept = now.lesson is now.compare.kept
    return "Learn something else in 3 Learn: that is A." if is_kept else ""


def why_not_send_away(now: Snapshot) -> str:
    """Return why there is no second robot to be sent away."""
    return "" if now.compare.kept is not None else "Nothing is kept as B."


def why_not_record_again(now: Snapshot) -> str:
    """Return why no take can be recorded once more."""
    return "" if _follows(now) else why_not_teach(now)


def why_not_restore(now: Snapshot) -> str:
    """Return why nothing comes back."""
    return "" if now.collection.removed else "Nothing was deleted."


def why_not_toggle(now: Snapshot) -> str:
    """Return why there is nothing to play or to pause."""
    if now.compare.timeline.title:
        return ""
    return why_not_play(now) and why_not_replay(now)


def why_not_step(now: Snapshot) -> str:
    """Return why the playhead cannot be moved."""
    return "" if now.compare.timeline.title else "Nothing is on the timeline: press Play first."


def why_not_export(now: Snapshot, kind: str) -> str:
    """Return why a kind of file cannot be written."""
    if not now.entries:
        return _NONE_LISTED
    if kind in WITHOUT_LESSON or now.lesson is not None:
        return ""
    return "Nothing is learned yet: press Train in 3 Learn."


def why_not_cancel_export(now: Snapshot) -> str:
    """Return why there is no export to be given up, nor a session that is being opened."""
    goes_on = now.export.running or now.export.opening
    return "" if goes_on else "Nothing is being exported or opened."


def next_step(now: Snapshot) -> str:
    """Return what a newcomer should do next."""
    learned, done = now.lesson is not None, now.reproduction is not None
    return next(
        words
        for applies, words in (
            (_follows(now), "watch the gate; Stop ends it and keeps what was recorded."),
            (now.mode is Mode.PLAYING, f"watch the {task_words(now.scene).watched}."),
            (now.mode is Mode.DRIVEN, "a program drives Baxter; Stop ends it."),
            (now.mode is Mode.CALIBRATING, "stand as it says; Stop gives up."),
            (now.mode is Mode.TRAINING, "wait until it has learned; Stop gives up."),
            (learned and not done, "4 Compare: let Baxter do it alone."),
            (learned, "3 Learn: try fewer neurons, train again, and compare."),
            (bool(fitting(now)), "3 Learn: press Train."),
            (_waits_for_stream(now), "1 Source: let a sensor send, as it says there."),
            (now.source is not None, "2 Teach: press Record."),
            (_can_take_stream(now), "1 Source: take the live stream."),
            (True, "1 Source: choose who teaches, yourself with the puppet for example."),
        )
        if applies
    )


def described(entry: Entry) -> str:
    """Return a listed demonstration's number and name, which tells equal names apart."""
    return f"{entry.number}: {entry.name}"


def _follows(now: Snapshot) -> bool:
    return now.mode in FOLLOWING


def _why_not_while_taught(now: Snapshot) -> str:
    return "Somebody teaches: press Stop first." if _follows(now) else ""


def _waits_for_stream(now: Snapshot) -> bool:
    is_live = now.source is not None and now.source.is_live
    return is_live and now.live is not None and not now.live.is_flowing


def _can_take_stream(now: Snapshot) -> bool:
    return now.live is not None and now.live.is_flowing


def _of_kind(now: Snapshot) -> list[Entry]:
    kind = now.choices.arms, now.choices.mapping, now.choices.scene
    return [entry for entry in now.entries if entry.is_of(*kind)]


def _wanted(now: Snapshot) -> str:
    scene = now.choices.scene
    where = "" if scene.is_same_as(USUAL) else f" in the scene {scene.name_beside(USUAL)}"
    return f"{in_words(now.choices.arms)} with the {now.choices.mapping} mapping{where}"
