"""4 Compare: Baxter alone beside a demonstration or a second robot, and how far they are apart."""

from collections.abc import Sequence

import numpy as np
import viser

from studio.engine import commands
from studio.engine.compare_status import named
from studio.engine.entry import Entry
from studio.engine.field_picture import LEGS, FieldPicture
from studio.engine.measured import Measured
from studio.engine.snapshot import Snapshot
from studio.panels import markup
from studio.panels.chooser import DemonstrationChooser
from studio.panels.inputs import Post
from studio.panels.measured_table import measured
from studio.panels.readiness import why_not_keep, why_not_play, why_not_put_back, why_not_replay
from studio.panels.tryout import TryoutPart


class ComparePanel:
    """The fourth step."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._told: object = None  # what the outcome was drawn from
        self._play = gui.add_button(
            "Let Baxter do it alone",
            hint="Plays what was learned; the chosen demonstration goes along as a ghost",
            icon=viser.Icon.PLAYER_PLAY,
        )
        self._play.on_click(lambda _: post(commands.PlayReproduction()))
        self._result = gui.add_html("")
        self._chooser = DemonstrationChooser(gui, "Ghost", post)
        self._replay = gui.add_button(
            "Replay this demonstration",
            hint="Shows the person and the robot as they were recorded",
            color="gray",
            icon=viser.Icon.HISTORY,
        )
        self._replay.on_click(lambda _: post(commands.PlayDemonstration()))
        self._notes = gui.add_html("")
        gui.add_divider()
        self._tryout = TryoutPart(gui, post)
        gui.add_divider()
        self._block = BlockPart(gui, post)
        gui.add_divider()
        self._second = SecondPart(gui, post)
        self._field = FieldPart(gui, post)

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        play, replay = why_not_play(now), why_not_replay(now)
        self._play.disabled, self._replay.disabled = bool(play), bool(replay)
        self._notes.content = markup.reasons([play, replay])
        self._chooser.draw(now)
        self._draw_outcome(now)
        self._tryout.draw(now)
        self._block.draw(now)
        self._second.draw(now)
        self._field.draw(now)

    def _draw_outcome(self, now: Snapshot) -> None:
        """Draw what came of it anew if that has changed: with all its equations it is long."""
        is_played, known = bool(now.compare.playing), now.learning.equations
        state = (now.compare.table, is_played, now.reproduction, now.lesson, now.entries, known)
        if state != self._told:
            self._told = state
            self._result.content = outcome(now)


class BlockPart:
    """Where the block stands: dragged in the 3D view, put back here."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._words = gui.add_html("")
        self._back = gui.add_button("Put the block back", color="gray", icon=viser.Icon.ARROW_BACK)
        self._back.on_click(lambda _: post(commands.PutBlockBack()))

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        moved, why_not = now.compare.moved, why_not_put_back(now)
        self._back.disabled = bool(why_not)
        words = (
            "<b>The block was moved.</b> A network that sees only time cannot know: play and see."
            if moved
            else "<b>Drag the yellow block</b> over the desk, then let Baxter do it alone: will it "
            "hit?"
        )
        self._words.content = markup.block(words) + markup.note(why_not)


class SecondPart:
    """What is kept as B, to stand beside what is learned next."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._words = gui.add_html("")
        self._keep = gui.add_button(
            "Keep this one to compare",
            hint="Then learn something else: a second robot does this one beside it",
            color="gray",
            icon=viser.Icon.USERS,
        )
        self._keep.on_click(lambda _: post(commands.KeepToCompare()))
        self._forget = gui.add_button("Send B away", color="gray", visible=False)
        self._forget.on_click(lambda _: post(commands.ForgetKept()))

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        self._forget.visible = now.compare.kept is not None
        self._keep.disabled = bool(why_not_keep(now))
        self._words.content = second_words(now)


class FieldPart:
    """What is to be seen on the board of a learned field; nothing for learners without one."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._words = gui.add_html("")
        self._leg = gui.add_button_group("Field", LEGS, visible=False)
        self._leg.on_click(lambda _: post(commands.ShowLeg(LEGS.index(self._leg.value))))

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        picture = now.compare.field
        self._leg.visible = picture is not None and picture.legs > 1
        self._words.content = "" if picture is None else field_words(picture)


def second_words(now: Snapshot) -> str:
    """Return what is kept as B, and what to do with it, as HTML."""
    lesson, kept, why_not = now.lesson, now.compare.kept, why_not_keep(now)
    if kept is None:
        return markup.note(why_not)
    name = f"<b>B: {markup.text(named(kept))}.</b> "
    if lesson is None or why_not:
        return markup.block(name + markup.text(why_not))
    return markup.block(f"{name}A: {markup.text(named(lesson))}. Both play on one timeline.")


def field_words(picture: FieldPicture) -> str:
    """Return what the board shows, as HTML."""
    missed = np.degrees(picture.missed)
    if picture.stable is None:
        return markup.block(
            "<b>The field on the board</b>: one plain field (Eq. 5) for both ways. Drag the "
            "blue balls: its paths stop on the way or pass the goal, and end up to "
            f"{missed:.0f}° from it."
        )
    return markup.block(
        f"<b>The field on the board</b>, the way {LEGS[picture.leg]}. Drag the blue balls: thick "
        f"green paths of the stable field all end in the goal; thin orange ones of the plain field "
        f"(Eq. 5) end up to {missed:.0f}° from it."
    )


def outcome(now: Snapshot) -> str:
    """Return what became of the block, and the table of all measures, as HTML."""
    table = now.compare.table
    if now.compare.playing and now.reproduction is None:
        return markup.note("The numbers come when Baxter is through.")
    if now.lesson is None or not any(is_robot(column) for column in table):
        return ""
    is_known = now.reproduction is not None  # and exported: its equations read the exported tables
    robots = [column for column in table if is_robot(column)]
    verdicts = [verdict(robot, len(robots) > 1) for robot in robots]
    size = "font-size:max(22px,2.8vh);font-weight:700;line-height:1.25"
    return (
        markup.block("<br>".join(markup.text(words) for words in verdicts), size)
        + "".join(markup.note(guarded(robot, len(robots) > 1)) for robot in robots if robot.guarded)
        + measured(table, now.lesson.taught.joints, now.learning.equations if is_known else {})
        + "".join(markup.note(words) for words in [blocks_shown(now.entries)] if words)
        + markup.note("Errors of what was measured, against the mean demonstration as it was sent.")
    )


def is_robot(column: Measured) -> bool:
    """Tell whether a column is a robot's, not a demonstration's."""
    return column.letter != ""


def verdict(column: Measured, is_one_of_two: bool) -> str:
    """Return what a robot made of the block."""
    words = column.task.judged(column.done, column.missing)
    return f"{column.letter}: {words}" if is_one_of_two else words


def guarded(column: Measured, is_one_of_two: bool) -> str:
    """Return what kept a robot from doing what was asked."""
    return f"{column.letter}: {column.guarded}" if is_one_of_two else column.guarded


def blocks_shown(entries: Sequence[Entry]) -> str:
    """Return what became of the block in each demonstration that is learned from."""
    included = [entry for entry in entries if entry.included]
    shown = [
        f"{entry.number} {entry.task.marked(entry.done)}".replace(" ", "\u00a0")
        for entry in included
    ]
    what = included[0].task.what if included else ""
    return f"The {what} in the demonstrations: {', '.join(shown)}." if shown else ""
