"""4 Compare: Baxter alone beside a demonstration, and how far the two are apart."""

import numpy as np
import viser

from studio.engine import commands
from studio.engine.performance import in_guards_words
from studio.engine.report import joint_names
from studio.engine.snapshot import Mode, Snapshot
from studio.engine.teaching import Lesson, Reproduction
from studio.panels import markup
from studio.panels.chooser import DemonstrationChooser
from studio.panels.inputs import Post
from studio.panels.readiness import why_not_play, why_not_replay


class ComparePanel:
    """The fourth step."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._play = gui.add_button(
            "Let Baxter do it alone",
            hint="Plays what was learned; the chosen demonstration goes along as a ghost",
            icon=viser.Icon.PLAYER_PLAY,
        )
        self._play.on_click(lambda _: post(commands.PlayReproduction()))
        self._result = gui.add_html("")
        gui.add_divider()
        self._chooser = DemonstrationChooser(gui, "Ghost", post)
        self._replay = gui.add_button(
            "Replay this demonstration",
            hint="Baxter does the chosen demonstration again, as it was sent",
            color="gray",
            icon=viser.Icon.HISTORY,
        )
        self._replay.on_click(lambda _: post(commands.PlayDemonstration()))
        self._notes = gui.add_html("")

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        play, replay = why_not_play(now), why_not_replay(now)
        self._play.disabled, self._replay.disabled = bool(play), bool(replay)
        self._notes.content = markup.reasons([play, replay])
        self._chooser.draw(now)
        self._result.content = _outcome(now)


def compared(lesson: Lesson, reproduction: Reproduction) -> str:
    """Return how well the robot did alone, as HTML."""
    down, error = reproduction.performance.block_down, reproduction.deviation
    guarded = in_guards_words(reproduction.performance)
    verdict = "✔ The block is down." if down else "✖ The block still stands."
    size = "font-size:max(22px,2.8vh);font-weight:700;line-height:1.25"
    degrees = np.degrees(error.joint_rmse)
    joints = [(j, f"{d:.2f}") for j, d in zip(joint_names(lesson), degrees, strict=True)]
    hand = [
        ("mean", f"{1000.0 * error.hand_mean:.1f}"),
        ("largest", f"{1000.0 * error.hand_max:.1f}"),
        ("time-warped (DTW)", f"{1000.0 * error.hand_dtw:.1f}"),
    ]
    return (
        markup.block(markup.text(verdict), size)
        + markup.table(("joint", "RMSE [deg]"), joints)
        + markup.table(("hand", "error [mm]"), hand)
        + markup.note("What was measured alone, against the mean demonstration as it was sent.")
        + (markup.note(guarded) if guarded else "")
    )


def _outcome(now: Snapshot) -> str:
    if now.lesson is not None and now.reproduction is not None:
        return compared(now.lesson, now.reproduction)
    if now.mode is Mode.PLAYING and now.alone:
        so_far = f" The collision guard has changed {now.guarded_ticks} ticks so far."
        waiting = "The numbers come when Baxter is through."
        return markup.note(waiting + (so_far if now.guarded_ticks else ""))
    return ""
