"""The gate for the last row: LASSO, OPEN, CLOSED, each lit, and why the robot does not follow."""

from dataclasses import dataclass
from typing import Literal

import viser

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
        return GateView(unused, "Nobody is watched", "2 Teach: Record, or Watch")
    if now.gate_mode == "open":
        headline = "Armed without signs" if gate.armed else "Not armed"
        return GateView(unused, headline, now.held or "the gate stands open")
    steps = tuple(_step(gate, number) for number in range(len(SEQUENCE)))
    if not gate.armed:
        return GateView(steps, "Not armed", gate.detail)
    if now.held:
        return GateView(steps, "Armed, but held", now.held)
    return GateView(steps, "Armed", "Baxter follows; hold Lasso to disarm")


def drawn(view: GateView) -> str:
    """Return a view as HTML."""
    boxes = "".join(_box(step) for step in view.steps)
    row = f'<div style="display:flex;gap:.3em">{boxes}</div>'
    big = "font-weight:700;font-size:max(24px,3vh);line-height:1.2;margin-top:.25em"
    reason = "font-size:max(20px,2.6vh);line-height:1.2"
    lines = (
        f'<div style="{big}">{markup.text(view.headline)}</div>'
        f'<div style="{reason}">{markup.text(view.reason)}</div>'
    )
    return markup.block(row + lines)


def _step(gate: GateStatus, number: int) -> Step:
    state = SEQUENCE[number]
    if number < gate.lit:
        return Step(state, "lit", 1.0)
    if number > gate.lit:
        return Step(state, "dark", 0.0)
    share = min(gate.held / gate.needed, 1.0) if gate.state is state and gate.needed > 0 else 0.0
    return Step(state, "awaited", share)


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
