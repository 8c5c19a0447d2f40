"""The calibration: a person stands with both arms hanging, and the lean of the torso goes."""

import viser

from studio.engine import commands
from studio.engine.calibration import in_words
from studio.engine.snapshot import Snapshot
from studio.panels import markup
from studio.panels.inputs import Post
from studio.panels.palette import BRAND, css
from studio.panels.readiness import why_not_calibrate, why_not_forget_calibration


class CalibrationPanel:
    """A part of the first step."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._calibrate = gui.add_button(
            "Calibrate (stand with arms hanging)",
            hint="Takes two seconds; corrects how your torso seems to lean. Baxter holds still",
            icon=viser.Icon.RULER_MEASURE,
        )
        self._calibrate.on_click(lambda _: post(commands.Calibrate()))
        self._state = gui.add_html("")
        self._forget = gui.add_button("Forget the calibration", color="gray", visible=False)
        self._forget.on_click(lambda _: post(commands.ForgetCalibration()))

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        refusal = why_not_calibrate(now)
        self._calibrate.disabled = bool(refusal)
        is_calibrated = now.choices.calibration is not None
        why_not_forget = why_not_forget_calibration(now) if is_calibrated else ""
        self._state.content = described(now) + markup.reasons([refusal, why_not_forget])
        self._forget.visible, self._forget.disabled = is_calibrated, bool(why_not_forget)


def described(now: Snapshot) -> str:
    """Return the calibration's progress, or its state, as HTML."""
    if now.calibrating is not None:
        words = f"<b>{markup.text(now.calibrating.words)}</b>"
        return markup.block(words + bar(now.calibrating.share))
    calibration = now.choices.calibration
    if calibration is None:
        return markup.note("Not calibrated: the sensor's spine line is trusted.")
    state = markup.block(f"✔ Calibrated: <b>{markup.text(in_words(calibration))}</b>")
    if now.source is not None and now.source.name != now.calibrated_with:
        state += markup.note(
            f"Taken with {now.calibrated_with}: for another person or sensor, calibrate again."
        )
    return state


def bar(share: float) -> str:
    """Return a progress bar as HTML."""
    frame = "border:1px solid var(--mantine-color-default-border);border-radius:.3em"
    return (
        f'<div style="{frame};margin-top:.3em;overflow:hidden">'
        f'<div style="height:10px;width:{100 * share:.0f}%;background:{css(BRAND)}"></div></div>'
    )
