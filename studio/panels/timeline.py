"""The timeline, always in sight: one playhead for robot, ghost, person, trails and plots."""

import viser

from studio.engine import commands
from studio.engine.snapshot import Snapshot
from studio.panels import markup
from studio.panels.inputs import Post, on_choice, show_value
from studio.panels.readiness import FOLLOWING, why_not_play

SPEEDS = {"0.25x": 0.25, "0.5x": 0.5, "1x": 1.0, "1.5x": 1.5, "2x": 2.0}
START, BACK, PLAY, PAUSE, ON, END = "|◀", "◀ step", "▶ Play", "❚❚ Pause", "step ▶", "▶|"
PLACES = 2  # digits of the playhead's seconds
_DRAGGED = 4  # updates of the panel, 0.4 s, in which the slider is its user's own


class TimelinePanel:
    """See the module."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._post = post
        self._own = 0  # updates for which the slider is still its user's
        self._end = 1.0  # [s] where the slider ends
        self._drawn: object = None
        self._title = gui.add_html("")
        self._slider = gui.add_slider("Time [s]", min=0.0, max=1.0, step=0.01, initial_value=0.0)
        on_choice(self._slider, self._scrub)
        self._buttons = gui.add_button_group("Go", (START, BACK, PLAY, ON, END))
        self._buttons.on_click(lambda _: self._press(self._buttons.value))
        self._speed = gui.add_dropdown("Speed", tuple(SPEEDS), initial_value="1x")
        on_choice(self._speed, lambda: post(commands.SetSpeed(SPEEDS[self._speed.value])))
        self._loop = gui.add_checkbox("Loop", False, hint="Begin anew at the end")
        on_choice(self._loop, lambda: post(commands.SetLoop(self._loop.value)))

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        timeline = now.compare.timeline
        self._title.content = title(now)
        self._slider.disabled = not timeline.title
        self._draw_slider(now)
        state = (timeline, now.message.number)
        if state == self._drawn:
            return
        self._drawn = state
        wanted = (START, BACK, PAUSE if timeline.is_playing else PLAY, ON, END)
        if self._buttons.options != wanted:
            self._buttons.options = wanted
        show_value(self._speed, nearest(timeline.speed))
        show_value(self._loop, timeline.loops)

    def _draw_slider(self, now: Snapshot) -> None:
        """Bring the slider to the playhead, unless somebody has it in hand."""
        if not now.compare.timeline.title:
            return
        end = max(round(now.duration, PLACES), 0.01)
        if end != self._end:
            self._end = self._slider.max = end
        self._own = max(self._own - 1, 0)
        at = min(round(now.time, PLACES), end)
        if not self._own and self._slider.value != at:
            show_value(self._slider, at)

    def _scrub(self) -> None:
        self._own = _DRAGGED
        self._post(commands.Scrub(self._slider.value))

    def _press(self, button: str) -> None:
        order: dict[str, commands.Command] = {
            START: commands.Scrub(0.0),
            BACK: commands.StepBy(-1),
            ON: commands.StepBy(1),
            END: commands.Scrub(self._end),
        }
        self._post(order.get(button, commands.TogglePlay()))


def title(now: Snapshot) -> str:
    """Return as HTML what is on the timeline and where the playhead is, or why nothing is."""
    timeline = now.compare.timeline
    if timeline.title:
        sign = "▶" if timeline.is_playing else "❚❚"
        clock = f"{now.time:.2f} of {now.duration:.2f} s"
        style = "float:right;font-variant-numeric:tabular-nums"
        return markup.block(
            f'<span style="{style}">{clock}</span><b>{sign} {markup.text(timeline.title)}</b>'
        )
    if now.mode in FOLLOWING:
        return markup.note("Somebody teaches: what is recorded can be played afterwards.")
    if not why_not_play(now):
        return markup.note("Play lets Baxter do alone what it learned.")
    if now.entries:
        return markup.note("Play shows the chosen demonstration again.")
    return markup.note("Nothing to play yet: record a demonstration in 2 Teach.")


def nearest(speed: float) -> str:
    """Return the offered speed that is nearest."""
    return min(SPEEDS, key=lambda name: abs(SPEEDS[name] - speed))
