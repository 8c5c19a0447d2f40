"""Test many times: how often what was learned does its task, beside the demonstrations' replays."""

import viser

from studio.engine import commands
from studio.engine.evaluate.interval import Rate
from studio.engine.evaluate.tryout import TryoutStatus
from studio.engine.snapshot import Snapshot
from studio.panels import markup
from studio.panels.inputs import Post

TRIALS = 100


class TryoutPart:
    """A part of the fourth step."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._words = gui.add_html("")
        self._test = gui.add_button(
            f"Test {TRIALS} times",
            hint="Behind the scenes, each time with the block and the joints a little off",
            color="gray",
            icon=viser.Icon.REPEAT,
        )
        self._test.on_click(lambda _: post(commands.TryOut(TRIALS)))
        self._why = gui.add_html("")
        self._bar = gui.add_progress_bar(0.0, visible=False, animated=True)
        self._cancel = gui.add_button(
            "Cancel the test", visible=False, color="gray", icon=viser.Icon.X
        )
        self._cancel.on_click(lambda _: post(commands.CancelWork()))

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        tryout = now.tryout
        refusal = why_not_test(now)
        self._test.disabled = bool(refusal) or tryout.goes_on
        self._why.content = markup.reasons([refusal])
        self._bar.visible = self._cancel.visible = tryout.goes_on
        if tryout.goes_on:
            over = 0 if tryout.rate is None else tryout.rate.trials
            # Of mypy see `inputs.show_value`.
            self._bar.value = round(100.0 * over / tryout.asked)  # type: ignore[misc]
        self._words.content = told(tryout) if tryout.lesson is now.lesson else ""


def why_not_test(now: Snapshot) -> str:
    """Return why nothing can be tested; nothing while a test goes on, which is seen."""
    if now.lesson is None:
        return "Nothing is learned yet: press Train in 3 Learn."
    underway = now.learning.underway
    if underway is not None and not now.tryout.goes_on:
        return f"Wait, or press Cancel in 3 Learn: {underway.words} goes on."
    return ""


def told(tryout: TryoutStatus) -> str:
    """Return what is known of a test, as HTML."""
    if tryout.lesson is None:
        return ""
    if tryout.rate is None or tryout.replayed is None:
        return markup.note("The first trials are on their way.") if tryout.goes_on else ""
    over, is_whole = tryout.rate.trials, tryout.rate.trials == tryout.asked
    head = "" if is_whole else f" ({over} of {tryout.asked} trials)"
    rows = [_row("alone", tryout.rate), _row("demonstrations' replays", tryout.replayed)]
    whys = "; ".join(f"{count} × {why}" for why, count in tryout.failures)
    return (
        markup.block(f"<b>Does it do the task?</b>{markup.text(head)}")
        + markup.table(("", "done", "95 % interval"), rows)
        + (markup.note(f"When it failed: {whys}.") if whys else "")
    )


def _row(name: str, rate: Rate) -> tuple[str, str, str]:
    interval = f"{100 * rate.low:.0f} to {100 * rate.high:.0f} %"
    return name, f"{100 * rate.value:.0f} %", interval
