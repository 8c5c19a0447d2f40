"""Always in sight: what goes on, Stop, the newest message, and what to do next."""

import math

import viser

from studio.engine import commands
from studio.engine.engage import COMING
from studio.engine.snapshot import Mode, Snapshot
from studio.panels import markup
from studio.panels.inputs import Post
from studio.panels.palette import STOP, Color
from studio.panels.readiness import next_step

# A word, a shape and a color for each; errors never wear recording's red.
_PILLS: dict[Mode, tuple[str, str, Color]] = {
    Mode.IDLE: ("■", "IDLE", (95, 105, 115)),
    Mode.WATCHING: ("◆", "WATCHING", (90, 80, 160)),
    Mode.ARMED: ("▲", "ARMED", (0, 120, 88)),
    Mode.RECORDING: ("●", "RECORDING", (200, 30, 40)),
    Mode.PLAYING: ("▶", "PLAYING", (28, 100, 180)),
    Mode.CALIBRATING: ("◎", "CALIBRATING", (140, 85, 20)),
    Mode.TRAINING: ("◐", "TRAINING", (125, 60, 130)),
    Mode.DRIVEN: ("⬢", "DRIVEN", (20, 105, 115)),
}


TOP = -20.0  # above whatever each browser has of its own, which is above all else


class StatusPanel:
    """State and Stop, above all others."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._strip = gui.add_html("", order=TOP)
        self._stop = gui.add_button(
            "Stop",
            hint="Stops whatever goes on; what was recorded is kept",
            color=STOP,
            icon=viser.Icon.PLAYER_STOP,
            order=TOP + 1.0,
        )
        self._stop.on_click(lambda _: post(commands.Stop()))

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        self._strip.content = strip(now)


class MessagePanel:
    """The newest message and the next step."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._words = gui.add_html("")
        self._notice = gui.add_html("", visible=False)

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        self._words.content = words(now)

    def notify(self, text: str) -> None:
        """Show something that stays true, beside the session's messages."""
        self._notice.content, self._notice.visible = markup.note(text), True

    def fail(self, reason: str) -> None:
        """Show that the engine has ended, which only a new start cures."""
        self._words.content = markup.problem(f"{reason}. Start the studio again.")


def strip(now: Snapshot) -> str:
    """Return the state pill with what it is about and the time beside it."""
    sign, word, color = _PILLS[now.mode]
    beside = "".join(f"<div>{markup.text(line)}</div>" for line in _beside(now))
    style = "font-size:.9em;line-height:1.2;font-variant-numeric:tabular-nums"
    return markup.block(
        f'{markup.pill(sign, word, color)}<div style="{style}">{beside}</div>',
        "display:flex;gap:.6em;align-items:center;margin-top:.5em;min-height:max(36px,4.2vh)",
    )


def words(now: Snapshot) -> str:
    """Return the newest message, told apart where it is an error, and the next step."""
    message = now.message
    shown = markup.problem if message.is_error else _message
    return shown(message.text) + markup.note(f"Next: {next_step(now)}")


def _message(words: str) -> str:
    return markup.block(markup.text(words))


def _beside(now: Snapshot) -> tuple[str, ...]:
    if now.mode in (Mode.IDLE, Mode.TRAINING):
        return _computed(now)
    # A live stream has no end to tell of.
    clock = f"{now.time:.0f} of {now.duration:.0f} s" if now.duration else f"{now.time:.0f} s"
    if now.mode in (Mode.PLAYING, Mode.DRIVEN):
        by_itself = "Baxter alone" if now.alone else "a demonstration"
        return "by a program" if now.mode is Mode.DRIVEN else by_itself, clock
    if now.calibrating is not None:
        return f"{100 * now.calibrating.share:.0f} %", clock
    if now.held == COMING:
        return "Baxter comes to you", clock
    if not _followed(now):
        return "Baxter waits", clock
    behind = f"{math.degrees(now.lag.angle):.0f}°, {now.lag.seconds:.1f} s behind"
    return "Baxter follows", behind, clock + _latency(now)


def _computed(now: Snapshot) -> tuple[str, ...]:
    """Return what somebody waits for, if anything, and how far it is."""
    underway = now.learning.underway
    if underway is None:
        return (f"exporting, {now.export.share:.0%}",) if now.export.running else ()
    return underway.words, *(() if underway.share is None else (f"{100 * underway.share:.0f} %",))


def _latency(now: Snapshot) -> str:
    """Return how long the newest frames were on their way to a command, where they come live."""
    total = None if now.live is None else now.live.latency.total
    is_live = now.source is not None and now.source.is_live
    return f", {1000 * total.p50:.0f} ms to command" if is_live and total else ""


def _followed(now: Snapshot) -> bool:
    return now.gate is not None and now.gate.armed and not now.held
