"""The gate for the last row: LASSO, OPEN, CLOSED, each lit, and why the robot does not follow."""

from dataclasses import dataclass
from typing import Literal

import viser

from studio.engine.engage import COMING
from studio.engine.gate import SEQUENCE, GateStatus
from studio.engine.skeleton import HandState
from studio.engine.snapshot import Snapshot
from studio.panels import markup
from studio.panels.palette import HAND, css

Light = Literal["lit", "awaited", "dark", "unused"]
_SIGNS: dict[Light, str] = {"lit": "✔", "awaited": "▸", "dark": "○", "unused": "–"}


@dataclass(frozen=True)
class Step:
    """One of the gate's three signs."""

    state: HandState
    light: Light
    share: float  # of the time for which it has to be held, 0 to 1


@dataclass(frozen=True)
class GateView:
    """What the panel says."""

    steps: tuple[Step, ...]
    headline: str
    reason: str
    seen: str = ""  # what the hand shows, and how sure the source is of it
    is_steady: bool = True  # it keeps its height, so that what stands below does not jump


class GatePanel:
    """Shows the gate; nothing is asked of people here but their hands."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._html = gui.add_html("")

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        self._html.content = drawn(view(now))


def view(now: Snapshot) -> GateView:
    """Return what to say of a snapshot."""
    gate = now.gate
    unused = tuple(Step(state, "unused", 0.0) for state in SEQUENCE)
    if gate is None:
        return _unwatched(now, unused)
    if now.choices.gate == "open":
        headline, reason = _armed(now) if gate.armed else ("Not armed", gate.detail)
        return GateView(unused, headline.replace("Armed", "Armed without signs"), reason)
    steps = tuple(_step(gate, number) for number in range(len(SEQUENCE)))
    if not gate.armed:
        return GateView(steps, "Not armed", gate.detail, _seen(gate))
    headline, reason = _armed(now)
    if headline == "Armed" and gate.left is not None:
        reason = gate.detail  # it will let go soon
    return GateView(steps, headline, reason, _seen(gate))


def _unwatched(now: Snapshot, unused: tuple[Step, ...]) -> GateView:
    if now.calibrating is not None:
        return GateView(unused, "Calibrating", now.calibrating.words)
    if now.guarded:
        return GateView(unused, "Too near", now.guarded)
    return GateView(unused, "Nobody is watched", "2 Teach: Record, or Watch", is_steady=False)


def _armed(now: Snapshot) -> tuple[str, str]:
    """Return what an armed robot does, and why it does not simply follow."""
    if now.held == COMING:
        return "Armed", now.guarded or "Baxter comes to you, slowly at first"
    if now.held:
        return "Armed, but held", now.held
    if now.guarded:  # an arm that just rests beside the torso is not slowed
        return "Armed, slowed" if ": " in now.guarded else "Armed", now.guarded
    signs = "; hold Lasso to disarm" if now.choices.gate == "sequence" else ""
    return "Armed", f"Baxter follows{signs}"


def drawn(view: GateView) -> str:
    """Return a view as HTML."""
    boxes = "".join(_box(step) for step in view.steps)
    row = f'<div style="display:flex;gap:.3em">{boxes}</div>'
    big = "font-weight:700;font-size:max(24px,3vh);line-height:1.2;margin-top:.25em"
    two_lines, one_line = ("min-height:2.4em", "min-height:1.35em") if view.is_steady else ("", "")
    reason = (
        f"font-size:max(20px,2.6vh);line-height:1.2;{two_lines};font-variant-numeric:tabular-nums"
    )
    lines = (
        f'<div style="{big}">{markup.text(view.headline)}</div>'
        f'<div style="{reason}">{markup.text(view.reason)}</div>'
        f'<div style="font-size:.9em;{one_line}">{markup.text(view.seen)}</div>'
    )
    return markup.block(row + lines)


def _seen(gate: GateStatus) -> str:
    """Return what the hand shows; a confidence of 1 is what a source has that tells none."""
    state = gate.state.value.replace("_", " ")
    sure = "" if gate.confidence == 1.0 else f", confidence {gate.confidence:.2f}"
    held = f", seen for {gate.held:.1f} of {gate.needed:.1f} s" if gate.held else ""
    return f"The hand: {state}{sure}{held}"


def _step(gate: GateStatus, number: int) -> Step:
    state = SEQUENCE[number]
    if number < gate.lit:
        return Step(state, "lit", 1.0)
    if number > gate.lit:
        return Step(state, "dark", 0.0)
    return Step(state, "awaited", min(gate.held / gate.needed, 1.0))


def _box(step: Step) -> str:
    color = css(HAND[step.state])
    filled = step.light == "lit"
    border = "solid" if step.light in ("lit", "awaited") else "dashed"
    frame = color if step.light != "unused" else "var(--mantine-color-default-border)"
    style = (
        f"flex:1;text-align:center;border:3px {border} {frame};border-radius:.4em;"
        f"background:{color if filled else 'transparent'};"
        f"color:{'#111' if filled else 'inherit'};"
        f"font-weight:{800 if filled else 500};font-size:22px;letter-spacing:-.5px;line-height:1.25"
    )
    bar = f"height:6px;width:{100 * step.share:.0f}%;background:{color}"
    word = f"<div>{_SIGNS[step.light]}</div><div>{step.state.value.upper()}</div>"
    return f'<div style="{style}">{word}<div style="{bar}"></div></div>'
