"""The gate for the last row: LASSO, OPEN, CLOSED, each lit, and why the robot does not follow.

All that has to be read from afar is at least 24 pixels high, and says in a word or a shape what its
color says.
"""

from dataclasses import dataclass, replace
from typing import Literal

import viser

from studio.engine.engage import COMING
from studio.engine.gate import SEQUENCE, GateStatus
from studio.engine.hand_strip import HandRun
from studio.engine.skeleton import HandState
from studio.engine.snapshot import Snapshot
from studio.panels import gate_strip, markup
from studio.panels.inputs import Post
from studio.panels.palette import HAND, css
from studio.panels.puppet import SignsPanel, next_move

Light = Literal["lit", "awaited", "dark", "unused"]
_HEADLINES = {"Armed": "▲", "Not armed": "□", "Calibrating": "◎", "Too near": "⚠"}
_HEADLINE = (
    "font-weight:700;font-size:max(24px,3vh);line-height:1.2;margin-top:.25em;"
    "display:flex;justify-content:space-between;gap:.5em"
)
_LEFT = "white-space:nowrap;font-variant-numeric:tabular-nums"
_REASON = (
    "font-size:max(24px,3vh);line-height:1.2;letter-spacing:-.3px;font-variant-numeric:tabular-nums"
)
_SIGNS: dict[Light, str] = {"lit": "✔", "awaited": "▸", "dark": "○", "unused": "–"}


@dataclass(frozen=True)
class Step:
    """One of the gate's three signs."""

    state: HandState
    light: Light
    share: float  # of the time for which it has to be held, 0 to 1
    hold: str = ""  # the same in words


@dataclass(frozen=True)
class GateView:
    """What the panel says."""

    steps: tuple[Step, ...]
    headline: str
    reason: str
    seen: str = ""  # what the hand shows, and how sure the source is of it
    left: str = ""  # until the gate falls back
    runs: tuple[HandRun, ...] | None = None  # of the strip; None for no strip
    is_steady: bool = True  # it keeps its height, so that what stands below does not jump


class GatePanel:
    """Shows the gate; nothing is asked of people here but their hands, or the puppet's."""

    def __init__(self, gui: viser.GuiApi, post: Post) -> None:
        self._steps = gui.add_html("")
        self._signs = SignsPanel(gui, post)
        self._words = gui.add_html("")

    def draw(self, now: Snapshot) -> None:
        """Show a snapshot."""
        shown = view(now)
        self._steps.content, self._words.content = steps_drawn(shown), words_drawn(shown)
        self._signs.draw(now)


def view(now: Snapshot) -> GateView:
    """Return what to say of a snapshot; to who has the puppet, what to do about it."""
    shown = _view(now)
    move = next_move(now) if now.who.puppet is not None and now.calibrating is None else ""
    return replace(shown, reason=f"☞ {move}") if move else shown


def _view(now: Snapshot) -> GateView:
    gate = now.gate
    unused = tuple(Step(state, "unused", 0.0) for state in SEQUENCE)
    if gate is None:
        return _unwatched(now, unused)
    if now.choices.gate == "open":
        headline, reason = _armed(now) if gate.armed else ("Not armed", gate.detail)
        return GateView(unused, headline.replace("Armed", "Armed without signs"), reason)
    steps = tuple(_step(gate, number) for number in range(len(SEQUENCE)))
    left, runs = "" if gate.left is None else f"{gate.left:.1f} s left", now.who.strip
    if not gate.armed:
        reason = gate.detail.removesuffix(f"; {left}")  # which stands beside the headline
        return GateView(steps, "Not armed", reason, _seen(gate), left, runs)
    headline, reason = _armed(now)
    if headline == "Armed" and gate.left is not None:
        reason = gate.detail  # it will let go soon
    return GateView(steps, headline, reason, _seen(gate), left, runs)


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


def steps_drawn(view: GateView) -> str:
    """Return the three signs as HTML."""
    boxes = "".join(_box(step) for step in view.steps)
    return markup.block(f'<div style="display:flex;gap:.3em">{boxes}</div>', "margin-bottom:.2em")


def words_drawn(view: GateView) -> str:
    """Return as HTML what the gate thinks, and what it has seen."""
    two_lines = "min-height:2.4em" if view.is_steady else ""
    sign = _HEADLINES.get(view.headline.partition(",")[0].partition(" without")[0], "□")
    left = f'<span style="{_LEFT}">⏳ {markup.text(view.left)}</span>' if view.left else ""
    lines = (
        f'<div style="{_HEADLINE}"><span>{sign} {markup.text(view.headline)}</span>{left}</div>'
        f'<div style="{_REASON};{two_lines}">{markup.text(view.reason)}</div>'
    )
    strip = "" if view.runs is None else gate_strip.drawn(view.runs, view.seen)
    return markup.block(lines + strip)


def _seen(gate: GateStatus) -> str:
    """Return what the hand shows; a confidence of 1 is what a source has that tells none."""
    state = gate.state.value.replace("_", " ")
    # Before arming, the sign that is awaited tells this itself.
    held = f" {gate.held:.1f} of {gate.needed:.1f} s" if gate.armed and gate.held else ""
    return f"hand: {state}{held}, confidence {gate.confidence:.2f}"


def _step(gate: GateStatus, number: int) -> Step:
    state = SEQUENCE[number]
    if number < gate.lit:
        return Step(state, "lit", 1.0, "seen")
    if number > gate.lit:
        return Step(state, "dark", 0.0, "later")
    return Step(
        state,
        "awaited",
        min(gate.held / gate.needed, 1.0),
        f"{gate.held:.1f} of {gate.needed:.1f} s",
    )


def _box(step: Step) -> str:
    color = css(HAND[step.state])
    filled = step.light == "lit"
    border = "solid" if step.light in ("lit", "awaited") else "dashed"
    frame = color if step.light != "unused" else "var(--mantine-color-default-border)"
    style = (
        f"flex:1;min-width:0;text-align:center;border:3px {border} {frame};border-radius:.4em;"
        f"background:{color if filled else 'transparent'};"
        f"color:{'#111' if filled else 'inherit'};"
        f"font-weight:{800 if filled else 500};font-size:clamp(24px,3vh,27px);"
        "letter-spacing:-1.5px;line-height:1.15;overflow:hidden"
    )
    bar = f"height:6px;width:{100 * step.share:.0f}%;background:{color}"
    hold = f"{_SIGNS[step.light]} {step.hold}".strip()
    word = (
        f"<div>{step.state.value.upper()}</div>"
        f'<div style="font-size:14px;letter-spacing:0;font-weight:600">{hold}</div>'
    )
    return f'<div style="{style}">{word}<div style="{bar}"></div></div>'
