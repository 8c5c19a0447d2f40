"""Always in sight: what goes on, Stop, the newest message, and what to do next."""

import viser

from studio.engine import commands
from studio.engine.snapshot import Mode, Snapshot
from studio.panels import markup
from studio.panels.inputs import Post
from studio.panels.palette import Color
from studio.panels.readiness import next_step

# A word, a shape and a color for each; errors never wear recording's red.
_PILLS: dict[Mode, tuple[str, str, Color]] = {
    Mode.IDLE: ("■", "IDLE", (95, 105, 115)),
    Mode.WATCHING: ("◆", "WATCHING", (90, 80, 160)),
    Mode.ARMED: ("▲", "ARMED", (0, 120, 88)),
    Mode.RECORDING: ("●", "RECORDING", (200, 30, 40)),
    Mode.PLAYING: ("▶", "PLAYING", (28, 100, 180)),
}


class StatusPanel:
    """The strip above all others."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._strip = gui.add_html("")
        self._stop = gui.add_button(
            "Stop",
            hint="Stops whatever goes on; what was recorded is kept",
            color="dark",
            icon=viser.Icon.PLAYER_STOP,
        )
        self._stop.on_click(lambda _: post(commands.Stop()))
        self._words = gui.add_html("")
        self._notice = gui.add_html("", visible=False)

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        self._strip.content = strip(now)
        self._words.content = words(now)

    def notify(self, text: str) -> None:
        """Show something that stays true, beside the session's messages."""
        self._notice.content, self._notice.visible = markup.note(text), True

    def fail(self, reason: str) -> None:
        """Show that the engine has ended, which only a new start cures."""
        self._strip.content = markup.block(markup.pill("✖", "ENDED", (60, 60, 60)))
        self._words.content = markup.problem(f"{reason}. Start the studio again.")


def strip(now: Snapshot) -> str:
    """Return the state pill with the time beside it."""
    sign, word, color = _PILLS[now.mode]
    style = "margin-left:.5em;font-variant-numeric:tabular-nums"
    clock = f'<span style="{style}">{markup.text(_clock(now))}</span>'
    return markup.block(markup.pill(sign, word, color) + clock, "margin-top:.5em")


def words(now: Snapshot) -> str:
    """Return the newest message, told apart where it is an error, and the next step."""
    message = now.message
    shown = markup.problem if message.is_error else _message
    return shown(message.text) + markup.note(f"Next: {next_step(now)}")


def _message(words: str) -> str:
    return markup.block(markup.text(words))


def _clock(now: Snapshot) -> str:
    if now.mode is Mode.IDLE:
        return ""
    what = {Mode.PLAYING: "alone" if now.alone else "a demonstration"}.get(now.mode, "")
    if now.mode is Mode.RECORDING and now.gate is not None:
        what = "Baxter follows" if now.gate.armed else "gate closed"
    return f"{what} {now.time:.0f} / {now.duration:.0f} s".strip()
